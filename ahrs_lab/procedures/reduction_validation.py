"""What a Monte Carlo check that is not passed says to the reader of the result (JCGM 101, clause 8)."""

from __future__ import annotations

from collections.abc import Mapping

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import (
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.recording.orientation import Axis


def not_validated(
    scale_factors: Mapping[Axis, ScaleFactorResult],
    zero_offsets: Mapping[Axis, ZeroOffsetResult],
    misalignments: Mapping[str, MisalignmentResult],
) -> list[ResultWarning]:
    """A warning for each quantity whose GUM interval is not the one of the trials, with both intervals."""
    stated: list[tuple[str, float, Uncertainty | None]] = []
    for axis, K in scale_factors.items():
        stated += [(f"K_{axis}", K.K, K.uncertainty), (f"F0_{axis}", K.F0, K.F0_uncertainty)]
    stated += [(f"B_{axis}", B.B, B.uncertainty) for axis, B in zero_offsets.items()]
    stated += [(f"L_{key}", L.L, L.uncertainty) for key, L in misalignments.items()]
    return [
        ResultWarning(said)
        for symbol, value, uncertainty in stated
        if uncertainty is not None and (said := _said(symbol, value, uncertainty)) is not None
    ]


def _said(symbol: str, value: float, uncertainty: Uncertainty) -> Message | None:
    check = uncertainty.monte_carlo
    if check is None or check.validated:
        return None
    numbers = {
        "symbol": symbol,
        "gum_low": f"{-uncertainty.gum_expanded:+.3g}",
        "gum_high": f"{uncertainty.gum_expanded:+.3g}",
        "trials": check.trials,
        "low": f"{check.symmetric[0] - value:+.3g}",
        "high": f"{check.symmetric[1] - value:+.3g}",
        "tolerance": f"{check.tolerance:.1g}",
    }
    if uncertainty.from_monte_carlo:
        return Message(
            "{symbol}: the 95 % interval of the GUM budget, value {gum_low} to {gum_high}, is not that of "
            "{trials} Monte Carlo trials, value {low} to {high}, within {tolerance} (JCGM 101, clause 8): U "
            "was raised to {expanded}, which covers the trials' interval.",
            expanded=f"{uncertainty.expanded:.3g}",
            **numbers,
        )
    return Message(
        "{symbol}: the 95 % interval of the GUM budget, value {gum_low} to {gum_high}, is not that of "
        "{trials} Monte Carlo trials, value {low} to {high}, within {tolerance} (JCGM 101, clause 8): U "
        "stays the larger one of the GUM and holds more than 95 %.",
        **numbers,
    )
