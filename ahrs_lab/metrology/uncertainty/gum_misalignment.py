"""Budget of L (JCGM 100): noise and drift of the two recordings, and how well the turned axis is the
case's."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import ARCSEC, BenchCapability
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.uncertainty.bench_figure import from_figure
from ahrs_lab.metrology.uncertainty.budget import combine, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.fitted_scale import UNSCALED, FittedScale
from ahrs_lab.metrology.uncertainty.noise import WHITE_NOISE, NoiseModel, drift_variance
from ahrs_lab.metrology.uncertainty.resolution import Resolution


@dataclass(frozen=True)
class MisalignmentEvidence:
    """The two recordings of n turns as output axis i shows them; rates in °/s.

    ``repeats`` pairs were averaged; ``starts_s`` of the + and the − recording. ``rest_rate_dps`` is what the
    output shows at rest: with recordings of different duration it does not cancel.
    """

    turns: int
    angle_positive_deg: float
    angle_negative_deg: float
    duration_positive_s: float
    duration_negative_s: float
    starts_s: tuple[float, float]
    repeats: int
    samples: int
    resolution: Resolution
    noise: NoiseModel
    rest_rate_dps: float
    scale: FittedScale = UNSCALED


def misalignment_uncertainty(
    L: float, evidence: MisalignmentEvidence, capability: BenchCapability
) -> Uncertainty:
    """u_c and U of L in rad, ∂L/∂N = ±1/(720·n)."""
    per_degree = 1.0 / (720.0 * evidence.turns)
    rows = [*_recording_rows(evidence, per_degree), *_axis_rows(evidence, L, capability)]
    rows.append(_resolution_row(evidence, per_degree))
    if evidence.scale.relative > 0.0:
        rows.append(evidence.scale.row(L))
    return combine(rows)


def _resolution_row(evidence: MisalignmentEvidence, per_degree: float) -> BudgetRow:
    """Of N⁺ and N⁻: means over their durations, of angles the difference of two readings each."""
    resolution = evidence.resolution
    durations = np.array([evidence.duration_positive_s, evidence.duration_negative_s])
    angles = durations * resolution.mean_factors(durations, np.full(2, float(evidence.samples)))
    return from_half_width(
        "q",
        Message("Resolution of the output"),
        "deg" if resolution.of_angle else "deg/s",
        0.5 * resolution.step,
        math.sqrt(float(angles @ angles)) * per_degree,
        "data",
    )


def _recording_rows(evidence: MisalignmentEvidence, per_degree: float) -> list[BudgetRow]:
    noise, repeats = evidence.noise, evidence.repeats
    duration = 0.5 * (evidence.duration_positive_s + evidence.duration_negative_s)
    drift, drift_dof = drift_variance(
        np.array([1.0, -1.0]),
        np.array(evidence.starts_s),
        np.array([evidence.duration_positive_s, evidence.duration_negative_s]),
        noise,
    )
    unequal = abs(evidence.duration_positive_s - evidence.duration_negative_s)
    return [
        type_a(
            "N⁺",
            Message("Sensor noise in the positive turns"),
            "deg",
            math.sqrt(noise.angle_variance(evidence.duration_positive_s) / repeats),
            per_degree,
            noise.white_dof,
            estimate=evidence.angle_positive_deg,
            shared=WHITE_NOISE,
        ),
        type_a(
            "N⁻",
            Message("Sensor noise in the negative turns"),
            "deg",
            math.sqrt(noise.angle_variance(evidence.duration_negative_s) / repeats),
            -per_degree,
            noise.white_dof,
            estimate=evidence.angle_negative_deg,
            shared=WHITE_NOISE,
        ),
        type_a(
            "D",
            Message("Drift of the zero between the recordings"),
            "deg",
            math.sqrt(drift / repeats) * duration,
            per_degree,
            drift_dof,
        ),
        from_half_width(
            "ΔT",
            Message("Different duration of the two recordings"),
            "s",
            unequal,
            evidence.rest_rate_dps * per_degree,
            "data",
        ),
    ]


def _axis_rows(evidence: MisalignmentEvidence, L: float, capability: BenchCapability) -> list[BudgetRow]:
    """What tilts the case's axis from the axis it is turned about is shown like a misalignment."""
    turned = math.radians(360.0 * evidence.turns)

    def row(symbol: str, source: Message, name: str, sensitivity: float) -> BudgetRow:
        return from_figure(symbol, source, "rad", capability.figure(name).times(ARCSEC), sensitivity)

    return [
        row("w", Message("Wobble of the table's axis"), "wobble_arcsec", 1.0),
        row("β", Message("Seat of the case against the table's axis"), "level_arcsec", 1.0),
        row("γ", Message("Perpendicularity of the fixture"), "fixture_perpendicularity_arcsec", 1.0),
        row("θ", Message("Angle turned by the table"), "position_arcsec", -L / turned),
    ]
