"""How a certificate writes numbers: U with two significant digits, the value to the same place.

Decimal arithmetic on the shortest decimal that is the float, so that a tie is a tie to the reader. Strings
without locale: ASCII digits, point and minus; :func:`format_grouped` makes them fit to be looked at.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, ROUND_UP, Context, Decimal
from typing import Literal

RoundingMode = Literal["half-even", "up"]

THIN_SPACE = "\u2009"
TRUE_MINUS = "\u2212"

_EXACT = Context(prec=400)
"""Wide enough to write any float as a plain decimal."""


@dataclass(frozen=True)
class RoundedPair:
    """Value and expanded uncertainty, both with ``decimals`` places (negative: tens, hundreds …)."""

    value: str
    expanded: str
    decimals: int


def round_to_uncertainty(value: float, expanded: float, mode: RoundingMode = "half-even") -> RoundedPair:
    """U (> 0) to two significant digits, half to even or up; the value to the same place, half to even.

    An uncertainty of exactly zero leaves the value as it is, with twelve decimals. Raises ValueError for
    what is not finite or negative.
    """
    if not math.isfinite(value) or not math.isfinite(expanded) or expanded < 0.0:
        raise ValueError(f"cannot round {value} ± {expanded}")
    if expanded == 0.0:
        return RoundedPair(_plain(_rounded(Decimal(repr(value)), -12, "half-even")), "0", 12)
    uncertainty = Decimal(repr(expanded))
    place = uncertainty.adjusted() - 1
    rounded = _rounded(uncertainty, place, mode)
    if rounded.adjusted() - 1 > place:  # 9.95 became 10.0: one digit too many
        place += 1
        rounded = _rounded(rounded, place, mode)
    return RoundedPair(
        _plain(_rounded(Decimal(repr(value)), place, "half-even")), _plain(rounded), decimals=-place
    )


def round_to_place(value: float, decimals: int, mode: RoundingMode = "half-even") -> str:
    """One number to ``decimals`` places (negative: tens …), plain notation."""
    return _plain(_rounded(Decimal(repr(value)), -decimals, mode))


def _rounded(number: Decimal, place: int, mode: RoundingMode) -> Decimal:
    rounding = ROUND_UP if mode == "up" else ROUND_HALF_EVEN
    return number.quantize(Decimal((0, (1,), place)), rounding=rounding, context=_EXACT)


def _plain(number: Decimal) -> str:
    text = format(number, "f")
    return text[1:] if number.is_zero() and text.startswith("-") else text


def format_grouped(text: str, separator: str = THIN_SPACE, minus: str = TRUE_MINUS) -> str:
    """A plain decimal number in groups of three either side of the point, with a true minus.

    Up to four digits on a side stay together (ISO 80000-1).
    """
    negative = text.startswith("-")
    whole, point, fraction = text.lstrip("-+").partition(".")
    if len(whole) > 4:
        head = len(whole) % 3
        groups = [whole[:head]] if head else []
        whole = separator.join(groups + [whole[i : i + 3] for i in range(head, len(whole), 3)])
    if len(fraction) > 4:
        fraction = separator.join(fraction[i : i + 3] for i in range(0, len(fraction), 3))
    return (minus if negative else "") + whole + point + fraction
