"""What a person types into the settings of an analysis, and the values that it takes. No Qt widgets here."""

from __future__ import annotations

import math

from PySide6.QtCore import QCoreApplication

from ahrs_lab.laboratory.analyses.kinds import Setting
from ahrs_lab.ui.formatting import MINUS, NO_BREAK_SPACE, THIN_SPACE

_PLAIN_DIGITS = 12


def titled(text: str) -> str:
    """An English name begins with a capital letter, wherever its author wrote it; a symbol stays as it is."""
    return text[:1].upper() + text[1:] if text[:2].isascii() and text[:2].isalpha() else text


def number_text(value: float) -> str:
    """As it is typed: no more digits than are meant, a true minus."""
    return f"{value:.{_PLAIN_DIGITS}g}".replace("-", MINUS)


def typed_number(text: str) -> float:
    """NaN for what is no finite number; a decimal comma is one."""
    plain = "".join(text.split()).replace(THIN_SPACE, "").replace(MINUS, "-").replace(",", ".")
    try:
        value = float(plain)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


def fault_of_number(setting: Setting, value: float) -> str:
    """Why the analysis does not take it, as a sentence for the field; empty where it does."""
    translate = QCoreApplication.translate
    if math.isnan(value):
        return translate("AnalysisSettings", "A number, please.")
    low, high = setting.low, setting.high
    below, above = low is not None and value < low, high is not None and value > high
    if not below and not above:
        return ""
    if low is not None and high is not None:
        return translate("AnalysisSettings", "From {low} to {high}.").format(
            low=_with_unit(low, ""), high=_with_unit(high, setting.unit)
        )
    if low is not None:
        return translate("AnalysisSettings", "At least {low}.").format(low=_with_unit(low, setting.unit))
    return translate("AnalysisSettings", "At most {high}.").format(
        high=_with_unit(high if high is not None else value, setting.unit)
    )


def _with_unit(value: float, unit: str) -> str:
    if not unit:
        return number_text(value)
    return number_text(value) + ("" if unit in ("°", "′", "″") else NO_BREAK_SPACE) + unit
