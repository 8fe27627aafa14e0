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


def tick_step(low: float, high: float, divisions: int) -> float:
    """:func:`nice_step`, or the next smaller one of which two multiples lie within the range: one number
    alone gives no scale."""
    while divisions < 64:
        step = nice_step(high - low, divisions)
        if math.floor(high / step + 1e-9) - math.ceil(low / step - 1e-9) >= 1:
            return step
        divisions *= 2
    return nice_step(high - low, divisions)


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
