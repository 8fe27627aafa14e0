"""Limits as they are typed: from texts to limits and back. No Qt here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.limits import LIMIT_UNITS, Limit

_MINUS = "\N{MINUS SIGN}"
_SPACES = ("\N{THIN SPACE}", "\N{NO-BREAK SPACE}", " ")


@dataclass(frozen=True)
class LimitTexts:
    """A line of the form as it stands; ``quantity`` and ``unit`` are keys."""

    quantity: str
    low: str = ""
    high: str = ""
    unit: str = ""
    nominal: str = ""

    def takes_nominal(self) -> bool:
        """The unit is relative."""
        return relative(self.quantity, self.unit)


def relative(quantity: str, unit: str) -> bool:
    """Whether a limit in this unit is a deviation from a nominal value."""
    known = LIMIT_UNITS[quantity[0]]
    return unit in known and known[unit].relative


def usual_unit(quantity: str) -> str:
    """The unit that a new limit begins with."""
    return {"K": "ppm", "B": "deg/h", "L": "arcmin"}[quantity[0]]


def texts_of(limit: Limit) -> LimitTexts:
    """All digits, a true minus."""
    return LimitTexts(limit.quantity, _text(limit.low), _text(limit.high), limit.unit, _text(limit.nominal))


def limit_of_texts(texts: LimitTexts) -> Limit | Message:
    """The limit, or what is wrong with it."""
    numbers: list[float | None] = []
    for text in (texts.low, texts.high, texts.nominal if texts.takes_nominal() else ""):
        value = number_of(text) if text.strip() else None
        if value is not None and not math.isfinite(value):
            return Message("“{text}” is not a number.", text=text.strip())
        numbers.append(value)
    try:
        return Limit(texts.quantity, numbers[0], numbers[1], texts.unit, numbers[2])
    except AhrsLabError as error:
        return error.message


def number_of(text: str) -> float:
    """What is typed, with any minus and spaces between digits; NaN where that is no number."""
    for space in _SPACES:
        text = text.replace(space, "")
    try:
        return float(text.replace(_MINUS, "-"))
    except ValueError:
        return math.nan


def text_of_number(value: float) -> str:
    """All its digits, plain, with a true minus."""
    return format(Decimal(repr(value)).normalize(), "f").replace("-", _MINUS)


def _text(value: float | None) -> str:
    return "" if value is None else text_of_number(value)
