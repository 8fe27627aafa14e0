"""Misalignment (失准角, 7.3): what an output axis shows per unit rotation about another: (7) to (9), (17)."""

from __future__ import annotations


def misalignment(angle_positive_deg: float, angle_negative_deg: float, turns: int) -> float:
    """L in rad: ``(N⁺ − N⁻) / (2·360·n)`` from the angle outputs over n whole turns in each sense.

    ``turns`` counts without sign. The print leaves the brackets of the divisor out.
    """
    if turns < 1:
        raise ValueError(f"turns has to be at least 1, not {turns}")
    return (angle_positive_deg - angle_negative_deg) / (2.0 * 360.0 * turns)
