"""Numbers in the sentences of the diagnosis: as many digits as are meant, no exponents."""

from __future__ import annotations

import math

_LEAST_P = 1e-4


def figures(value: float, digits: int = 2, *, plus: bool = False) -> str:
    """``digits`` significant digits, decimals only: 0.0021, 12, −3.4."""
    if value == 0.0 or not math.isfinite(value):
        return "0" if value == 0.0 else "∞"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    text = f"{abs(value):.{min(decimals, 12)}f}"
    return ("−" if value < 0.0 else "+" if plus else "") + text


def probability(p: float) -> str:
    """``0.032``, ``< 0.0001``."""
    return f"< {_LEAST_P:.4f}" if p < _LEAST_P else figures(p)


def chance(p: float) -> str:
    """``p = 0.032``, ``p < 0.0001``."""
    return f"p {probability(p)}" if p < _LEAST_P else f"p = {probability(p)}"
