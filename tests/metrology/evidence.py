"""What a calibration may have recorded, for the tests of budgets and of their full models."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.metrology.scale_factor import ScaleFactorFit, fit_scale_factor
from ahrs_lab.metrology.uncertainty.gum_misalignment import MisalignmentEvidence
from ahrs_lab.metrology.uncertainty.gum_scale_factor import ScaleFactorEvidence, scale_factor_uncertainty
from ahrs_lab.metrology.uncertainty.gum_zero_offset import ZeroOffsetEvidence
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from ahrs_lab.metrology.uncertainty.resolution import Resolution

EARTH_DPS = math.degrees(7.292115e-5)
LATITUDE = 40.0
E, N, U = np.eye(3)
BENCH = BenchCapability()
RateSource = Literal["demanded", "table"]
RATES = np.array([-300.0, -200.0, -5.0, -0.5, 0.5, 5.0, 200.0, 310.0])


KNOWN_TO_6_DOF = ((0.0,) * 4, (0.0,) * 4, (0.0, 0.0, 1e-12 / 3.0, 0.0), (0.0,) * 4)
"""Covariance of a flicker of 1e-3 that six degrees of freedom tell of."""


def four_positions(directions: tuple[np.ndarray, ...] = (E, E, -E, -E)) -> ZeroOffsetEvidence:
    """Table 2: 1 and 3 on one mounting, 2 and 4 on the other."""
    return ZeroOffsetEvidence(
        directions=np.array(directions),
        turned_deg=np.array([0.0, 0.0, 180.0, 180.0]),
        mountings=("z+", "z-", "z+", "z-"),
        angles_deg=np.zeros(4),
        durations_s=np.full(4, 1800.0),
        repeats=np.ones(4),
        samples=np.full(4, 18000.0),
        resolution=Resolution(),
        noise=NoiseModel(white=2.5e-3, white_dof=100.0),
        latitude_deg=LATITUDE,
    )


def rates_evidence(noise: float = 1e-3) -> ScaleFactorEvidence:
    count = len(RATES)
    return ScaleFactorEvidence(
        standard_errors=np.full(count, noise),
        dofs=np.full(count, 19.0),
        durations_s=np.full(count, 30.0),
        starts_s=np.linspace(60.0, 30.0 + 30.0 * count, count),
        rest_standard_errors=(noise, noise),
        rest_dofs=(39.0, 39.0),
        rest_durations_s=(60.0, 60.0),
        rest_starts_s=(0.0, 300.0),
        rest_samples=(600.0, 600.0),
        samples=np.full(count, 300.0),
        resolution=Resolution(),
        noise=NoiseModel(),
        latitude_deg=LATITUDE,
    )


def budgets(
    fit: ScaleFactorFit,
    evidence: ScaleFactorEvidence,
    rate_source: RateSource = "demanded",
    time_scaled: bool = False,
    bench: BenchCapability = BENCH,
) -> tuple[Uncertainty, Uncertainty]:
    """Of K and F₀."""
    return scale_factor_uncertainty(
        fit, evidence, bench, device_unit="deg/s", rate_source=rate_source, time_scaled=time_scaled
    )


def scale_factor(noise: float = 1e-3, rate_source: RateSource = "demanded") -> Uncertainty:
    return budgets(fit_scale_factor(RATES, 1.01 * RATES, 0.0, 0.0), rates_evidence(noise), rate_source)[0]


def turns() -> MisalignmentEvidence:
    return MisalignmentEvidence(
        turns=10,
        angle_positive_deg=3.6,
        angle_negative_deg=-3.6,
        duration_positive_s=36.0,
        duration_negative_s=36.0,
        starts_s=(0.0, 40.0),
        repeats=1,
        samples=360,
        resolution=Resolution(),
        noise=NoiseModel(white=2.5e-3, white_dof=100.0),
        rest_rate_dps=0.0,
    )
