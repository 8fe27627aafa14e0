"""Where a value, its uncertainty and its limits stand on a bar of length 1. No Qt here."""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.metrology.conformity import Statement

_MARGIN = 0.14
"""Part of the bar beyond each limit."""


@dataclass(frozen=True)
class LimitBar:
    """Places from 0 to 1; None: there is no such limit. ``value`` and the ends of ± U are kept on the bar."""

    low: float | None
    high: float | None
    accept_low: float | None
    accept_high: float | None
    value: float
    value_low: float
    value_high: float


def limit_bar(said: Statement) -> LimitBar:
    """The bar of one statement: limits near its ends; with one limit only, the value in its middle or so."""
    low, high = said.limit.low, said.limit.high
    if low is not None and high is not None:
        first, span = low, high - low
    else:
        edge = low if low is not None else high
        assert edge is not None
        span = max(2.0 * abs(said.value - edge), 8.0 * said.expanded)
        first = edge if low is not None else edge - span
    start, whole = first - _MARGIN * span, span * (1.0 + 2.0 * _MARGIN)

    def place(x: float | None) -> float | None:
        return None if x is None else (x - start) / whole

    def kept(x: float) -> float:
        return min(max((x - start) / whole, 0.0), 1.0)

    return LimitBar(
        place(low),
        place(high),
        place(said.acceptance[0]),
        place(said.acceptance[1]),
        kept(said.value),
        kept(said.value - said.expanded),
        kept(said.value + said.expanded),
    )
