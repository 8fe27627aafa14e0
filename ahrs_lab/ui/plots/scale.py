"""The range of a live axis: it grows at once and shrinks late, in steps of 1, 2, 5, so that the picture
stands still."""

from __future__ import annotations

import math

_SHRINK_AFTER = 45
"""Looks in a row in which half the range would have done, before it shrinks."""


def nice_step(span: float, divisions: int = 4) -> float:
    """The smallest 1, 2 or 5 × 10ⁿ of which ``divisions`` cover ``span``."""
    if not span > 0 or not math.isfinite(span):
        return 1.0
    raw = span / divisions
    power = 10.0 ** math.floor(math.log10(raw))
    for factor in (1.0, 2.0, 5.0):
        if factor * power >= raw * (1 - 1e-9):
            return factor * power
    return 10.0 * power


def ticks(low: float, high: float, apart: float, divisions: int = 4) -> tuple[float, list[float]]:
    """Step and values of the numbers at an axis from ``low`` to ``high``, at least ``apart`` from each other.

    All multiples of a nice step, at most ``divisions`` steps. Where only one of them has room, two of a finer
    step, as far from each other as they come (one number alone gives no scale), and where these have no room
    either the roundest one.
    """
    span = high - low
    step = nice_step(max(apart, span / divisions), 1)
    found = _multiples(low, high, step)
    if len(found) >= 2:
        return step, found
    # Finer ones would be odd numbers to read.
    finest = max(step, span) / 10.0
    one = step, found
    while step > finest or not one[1]:
        step = nice_step(step / 2.5, 1)
        found = _multiples(low, high, step)
        if found and found[-1] - found[0] >= max(apart, step):
            return step, [found[0], found[-1]]
        if not one[1]:
            one = step, sorted(found, key=lambda value: abs(value - (low + high) / 2))[:1]
    return one


def _multiples(low: float, high: float, step: float) -> list[float]:
    return [n * step for n in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def nice_range(low: float, high: float, smallest: float) -> tuple[float, float]:
    """Whole steps around the data, at least ``smallest`` wide."""
    if high - low < smallest:
        middle = (low + high) / 2
        low, high = middle - smallest / 2, middle + smallest / 2
    step = nice_step(high - low)
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step


class SteppedRange:
    """Call :meth:`follow` with every look at the data; ``low`` and ``high`` are what to show."""

    def __init__(self, smallest: float) -> None:
        self._smallest = smallest
        self._too_wide = 0
        self.low, self.high = nice_range(0.0, 0.0, smallest)

    def follow(self, low: float, high: float) -> bool:
        """True where the range changed."""
        wanted = nice_range(low, high, self._smallest)
        if low < self.low or high > self.high:
            return self._take(wanted)
        roomy = (wanted[1] - wanted[0]) <= 0.55 * (self.high - self.low)
        self._too_wide = self._too_wide + 1 if roomy else 0
        return self._too_wide > _SHRINK_AFTER and self._take(wanted)

    def _take(self, wanted: tuple[float, float]) -> bool:
        self.low, self.high = wanted
        self._too_wide = 0
        return True
