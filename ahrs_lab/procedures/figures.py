"""Numbers in sentences: as many digits as a person reads."""

from __future__ import annotations


def figure(value: float, digits: int = 6) -> int | float:
    """``value`` with at most ``digits`` significant ones, without a fraction where it has none."""
    rounded = float(f"{value:.{digits}g}")
    return int(rounded) if rounded.is_integer() and abs(rounded) < 1e15 else rounded
