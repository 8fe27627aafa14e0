"""What a Monte Carlo check that is not passed says to the reader of the result (JCGM 101, clause 8)."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import (
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.rounding import format_grouped, round_to_place
from ahrs_lab.recording.orientation import Axis

_PER_HOUR = 3600.0
_MILLION = 1e6


def not_validated(
    scale_factors: Mapping[Axis, ScaleFactorResult],
    zero_offsets: Mapping[Axis, ZeroOffsetResult],
    misalignments: Mapping[str, MisalignmentResult],
) -> list[ResultWarning]:
    """A warning for each quantity whose GUM interval is not the one of the trials, with both intervals.

    None for F₀, which is stated without U; its verdict is in the result.
    """
    stated: list[tuple[str, float, Uncertainty, float, str]] = []
    for axis, K in scale_factors.items():
        ratio = K.unit in ("1", "(deg/s)/(deg/s)")
        factor, unit = (_MILLION, "10⁻⁶") if ratio else (1.0, K.unit.replace("deg", "°"))
        stated.append((f"K_{axis}", K.K, K.uncertainty, factor, unit))
    stated += [(f"B_{axis}", B.B, B.uncertainty, _PER_HOUR, "°/h") for axis, B in zero_offsets.items()]
    stated += [(f"L_{key}", L.L, L.uncertainty, _MILLION, "10⁻⁶ rad") for key, L in misalignments.items()]
    return [ResultWarning(said) for one in stated if (said := _said(*one)) is not None]


def _said(symbol: str, value: float, uncertainty: Uncertainty, factor: float, unit: str) -> Message | None:
    check = uncertainty.monte_carlo
    if check is None or check.validated:
        return None
    tolerance = check.tolerance * factor
    decimals = -math.floor(math.log10(tolerance)) if tolerance > 0.0 else 6

    def text(number: float, plus: bool = True) -> str:
        rounded = format_grouped(round_to_place(number * factor, decimals))
        return f"+{rounded}" if plus and number > 0.0 else rounded

    numbers = {
        "symbol": symbol,
        "gum_low": text(-uncertainty.gum_expanded),
        "gum_high": text(uncertainty.gum_expanded),
        "trials": format_grouped(str(check.trials)),
        "low": text(check.symmetric[0] - value),
        "high": text(check.symmetric[1] - value),
        "tolerance": text(check.tolerance, plus=False),
        "unit": unit,
    }
    if uncertainty.from_monte_carlo:
        return Message(
            "{symbol}: the 95 % interval of the GUM budget, value {gum_low} to {gum_high}, is not that of "
            "{trials} Monte Carlo trials, value {low} to {high}, within {tolerance} (all in {unit}; "
            "JCGM 101, clause 8): U was raised to {expanded}, which covers the trials' interval.",
            expanded=text(uncertainty.expanded, plus=False),
            **numbers,
        )
    return Message(
        "{symbol}: the 95 % interval of the GUM budget, value {gum_low} to {gum_high}, is not that of "
        "{trials} Monte Carlo trials, value {low} to {high}, within {tolerance} (all in {unit}; "
        "JCGM 101, clause 8): U stays the larger one of the GUM and holds more than 95 %.",
        **numbers,
    )
