"""A report's numbers in meaningful digits, and its cells as they are set: true minus, raised powers, lowered
indices; which columns are numbers.

What an analysis writes (``f"{value:.3g}"``) is plain text for a terminal; a screen and a PDF set it better.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import floor, isfinite, log10

from ahrs_lab.analysis.report import Table, cell_text

_MINUS = "\N{MINUS SIGN}"
_SIGN = re.compile(r"(?<![\w.)\]-])-(?=[\d.])")
_POWER = re.compile(r"(?<![\w.])(\d+\.?\d*|\.\d+)[eE]([+-]?)0*(\d+)(?!\w)|(?<=\d\))[eE]([+-]?)0*(\d+)(?!\w)")
_INDEX = re.compile(r"(?<![A-Za-z0-9_./\\-])([^\W\d_]|∇)_(\w{1,3})(?!\w|\.\w)")
_NUMBER = re.compile(r"[+\-−±≤≥<>~≈]?\s?(\d|\.\d)")
_DASHES = ("–", "—", "-", "−")
_NOTHING = ("", *_DASHES, "∞", "nan")
_PLAIN_PLACES = 6
"""Decimals beyond which a number is written with a power of ten."""


def digits(value: float, count: int = 4) -> str:
    """``value`` in ``count`` significant digits, zeros at its end too: ``0.6100``, ``−188.7``."""
    if not isfinite(value) or value == 0.0:
        return f"{value:g}"
    mantissa = f"{value:.{count - 1}e}"
    places = count - 1 - int(mantissa.split("e")[1])
    return mantissa if places > _PLAIN_PLACES + count - 2 else f"{value:.{max(0, places)}f}"


def paired(value: float, uncertainty: float, *, unstated: int = 4) -> tuple[str, str]:
    """The uncertainty in two significant digits and the value to the same place; where there is none, the
    value to ``unstated`` decimals and "–"."""
    if not (isfinite(uncertainty) and uncertainty > 0.0):
        return f"{value:z.{unstated}f}", "–"
    places = 1 - int(f"{uncertainty:.1e}".split("e")[1])
    shown = max(0, places)
    return f"{round(value, min(places, 15)):z.{shown}f}", f"{round(uncertainty, places):.{shown}f}"


def column(values: Iterable[float], count: int = 3, sign: str = "") -> tuple[str, ...]:
    """One column of one unit: as many decimals for all as give the largest ``count`` digits."""
    listed = list(values)
    largest = max((abs(value) for value in listed if isfinite(value)), default=0.0)
    places = max(0, count - 1 - floor(log10(largest))) if largest > 0.0 else 0
    if places > _PLAIN_PLACES + count - 2:
        return tuple(f"{value:{sign}.{count - 1}e}" if isfinite(value) else "–" for value in listed)
    return tuple(f"{value:{sign}z.{places}f}" if isfinite(value) else "–" for value in listed)


def readable(text: str) -> str:
    """``-1.2e-05`` as ``−1.2×10^{−5}``, ``φ_E`` as ``φ_{E}``: ``^{…}`` is raised, ``_{…}`` lowered."""

    def power(found: re.Match[str]) -> str:
        mantissa, sign, digits = found[1] or "", found[2] or found[4], found[3] or found[5]
        return f"{mantissa}×10^{{{_MINUS if sign == '-' else ''}{digits}}}"

    return _INDEX.sub(r"\1_{\2}", _SIGN.sub(_MINUS, _POWER.sub(power, text)))


def number_columns(table: Table) -> tuple[bool, ...]:
    """Which columns hold numbers, and stand right: each of their cells is one, or empty; those of which all
    are unknown ("–") too.

    Columns in which somebody wrote words in any language are not.
    """
    return tuple(_is_numbers(table, place) for place in range(len(table.head)))


def _is_numbers(table: Table, place: int) -> bool:
    texts = [cell_text(row[place]).strip() for row in table.rows]
    if texts and all(text in _DASHES for text in texts):
        return True
    filled = [text for text in texts if text not in _NOTHING]
    return bool(filled) and all(_NUMBER.match(text) for text in filled)
