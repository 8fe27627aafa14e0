"""Ticks of an axis, linear or logarithmic, and how their numbers are written: the same on paper and screen.

``^{…}`` in a text is raised (:func:`~ahrs_lab.certificates.richtext.markup`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ahrs_lab.metrology.rounding import TRUE_MINUS, format_grouped

_LEAST_PLAIN, _MOST_PLAIN = -4, 5
"""Powers of ten between which numbers are written out."""
_FEW = 3
_NARROWEST = 2e-6
"""Part of its values that a linear axis spans at least: less would magnify how numbers are rounded."""
_FRACTIONS = ((1, 2, 3, 4, 5, 6, 7, 8, 9), (1, 2, 5), (1, 3), (1,))


@dataclass(frozen=True)
class Ticks:
    """``values`` carry ``texts``; ``minor`` are lines without a number."""

    values: tuple[float, ...]
    texts: tuple[str, ...]
    minor: tuple[float, ...] = ()


def air_around(low: float, high: float, margin: float, *, log: bool = False) -> float:
    """What an axis shows beyond ``low`` and ``high`` (their logarithms with ``log``) on either side."""
    if log:
        return margin * (high - low) or 0.5
    largest = max(abs(low), abs(high))
    if high == low:
        return 0.5 * (largest or 1.0)
    return max(margin * (high - low), 0.5 * (_NARROWEST * largest - (high - low)))


def axis_ticks(low: float, high: float, most: int, *, log: bool = False) -> Ticks:
    """At most about ``most`` numbers within ``low`` … ``high`` (both above zero with ``log``)."""
    if log:
        return _log_ticks(low, high, most)
    return linear_ticks(low, high, most)


def linear_ticks(low: float, high: float, most: int) -> Ticks:
    """Multiples of 1, 2 or 5 times a power of ten; two at least where there is room for them."""
    span = high - low
    if not span > 0.0 or not math.isfinite(span):
        return Ticks((low,), (number_text(low, abs(low) or 1.0),))
    for divisions in (most, 2 * most, 4 * most):
        step = _step(span / max(1, divisions))
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        if last > first:
            break
    values = tuple(place * step for place in range(first, last + 1))
    largest = max((abs(value) for value in values), default=1.0)
    return Ticks(values, tuple(number_text(value, step, largest) for value in values))


def _step(raw: float) -> float:
    power = 10.0 ** math.floor(math.log10(raw))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw * (1 - 1e-9))


def number_text(value: float, step: float, largest: float | None = None) -> str:
    """``value`` with the places that ``step`` has; with a power of ten where it would have too many."""
    if abs(value) < 1e-6 * step:
        return "0"
    fine = math.floor(math.log10(step) + 1e-9)
    coarse = math.floor(math.log10(max(abs(value), largest or 0.0)))
    if coarse < _MOST_PLAIN and (fine >= _LEAST_PLAIN or coarse >= 0):
        return format_grouped(f"{value:.{max(0, -fine)}f}")
    mantissa = format_grouped(f"{value / 10.0**coarse:.{max(0, coarse - fine)}f}")
    return f"{mantissa}×{power_text(coarse)}"


def power_text(power: int) -> str:
    """``10^{−5}``."""
    return f"10^{{{TRUE_MINUS if power < 0 else ''}{abs(power)}}}"


def _log_ticks(low: float, high: float, most: int) -> Ticks:
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    decades = [power for power in range(first, last + 1) if _within(10.0**power, low, high)]
    if len(decades) < _FEW:
        return _short_log_ticks(low, high, most, range(first - 1, last + 1))
    step = -(-len(decades) // max(1, most))
    shown = [power for power in decades if power % step == 0]
    if len(shown) < 2:  # one number alone gives no scale
        shown = decades[::step]
    minor: Sequence[float] = [10.0**power for power in decades if power not in shown]
    if step == 1:
        minor = [f * 10.0**power for power in range(first - 1, last + 1) for f in range(2, 10)]
    plain = all(_LEAST_PLAIN < power < _MOST_PLAIN for power in shown)
    return Ticks(
        tuple(10.0**power for power in shown),
        tuple(number_text(10.0**power, 10.0**power) if plain else power_text(power) for power in shown),
        tuple(value for value in minor if _within(value, low, high)),
    )


def _short_log_ticks(low: float, high: float, most: int, decades: Sequence[int]) -> Ticks:
    """A decade or two: numbers between the powers of ten too; much less: round steps."""
    if high < 4.0 * low:
        return linear_ticks(low, high, most)
    every = [(f, power) for power in decades for f in range(1, 10) if _within(f * 10.0**power, low, high)]
    chosen = every
    for fractions in _FRACTIONS:
        fewer = [(f, power) for f, power in every if f in fractions]
        if len(fewer) < 2:
            break
        chosen = fewer
        if len(chosen) <= most:
            break
    return Ticks(
        tuple(f * 10.0**power for f, power in chosen),
        tuple(number_text(f * 10.0**power, 10.0**power) for f, power in chosen),
        tuple(f * 10.0**power for f, power in every if (f, power) not in chosen),
    )


def _within(value: float, low: float, high: float) -> bool:
    return low * (1 - 1e-9) <= value <= high * (1 + 1e-9)
