"""Budgets of K and F₀ (JCGM 100): sensitivities of the regression itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import (
    ARCSEC,
    RATE_BAND_NAMES,
    BenchCapability,
    rate_band,
)
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.scale_factor import ScaleFactorFit
from ahrs_lab.metrology.uncertainty.bench_figure import BenchFigure, from_figure, root_sum
from ahrs_lab.metrology.uncertainty.budget import combine, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, drift_variance
from ahrs_lab.metrology.uncertainty.resolution import Resolution
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS

Array = NDArray[np.float64]

SIGNIFICANCE = 0.05
"""How often noise and drift alone may scatter so that it counts as something else."""


@dataclass(frozen=True)
class ScaleFactorEvidence:
    """What the data say about the M means of (10) and the two at rest; arrays of shape (M,), the device's
    unit.

    ``starts_s`` are on one time scale with ``rest_starts_s`` (F_s, F_e). ``samples`` and ``rest_samples`` are
    per mean.
    """

    standard_errors: Array
    dofs: Array
    durations_s: Array
    starts_s: Array
    rest_standard_errors: tuple[float, float]
    rest_dofs: tuple[float, float]
    rest_durations_s: tuple[float, float]
    rest_starts_s: tuple[float, float]
    rest_samples: tuple[float, float]
    samples: Array
    resolution: Resolution
    noise: NoiseModel
    latitude_deg: float

    @property
    def all_starts_s(self) -> Array:
        """Shape (M + 2,): of the rates, then of the two at rest."""
        return np.array([*self.starts_s, *self.rest_starts_s])

    @property
    def all_durations_s(self) -> Array:
        return np.array([*self.durations_s, *self.rest_durations_s])

    @property
    def unseen_variances(self) -> Array:
        """Shape (M + 2,): of the means by the resolution, beyond the scatter of their readings."""
        samples = np.array([*self.samples, *self.rest_samples])
        return self.resolution.unseen_variances(self.all_durations_s, samples)


def scale_factor_uncertainty(
    fit: ScaleFactorFit,
    evidence: ScaleFactorEvidence,
    capability: BenchCapability,
    *,
    device_unit: str,
    rate_source: Literal["demanded", "table"],
    time_scaled: bool = False,
) -> tuple[Uncertainty, Uncertainty]:
    """Budgets of K (in device unit per °/s) and F₀ (device unit).

    ``time_scaled``: the outputs were made of increments over the device's time, so its error enters.
    """
    K_weights, F0_weights = np.array(fit.K_weights), np.array(fit.F0_weights)
    mean_rate = float(np.mean(fit.rates_dps))
    table = _table_rows(fit, K_weights, 1.0 / fit.spread, evidence, capability, rate_source)
    table_F0 = _table_rows(fit, F0_weights, -mean_rate / fit.spread, evidence, capability, rate_source)
    scatter = unexplained_scatter(fit, evidence)
    data = _data_rows(K_weights, evidence, scatter, device_unit, 1.0 / math.sqrt(fit.spread))
    F0_scale = 1.0 / math.sqrt(len(F0_weights))
    data_F0 = _data_rows(F0_weights, evidence, scatter, device_unit, F0_scale)
    data_F0 += [_rest_row(evidence, device_unit), _level_row(fit, evidence, capability)]
    timing: list[BudgetRow] = []
    if time_scaled != (rate_source == "table"):  # on both sides it is one clock, which cancels in K
        timing.append(
            from_figure("t", Message("Time base"), "1", capability.figure("timing_relative"), fit.K)
        )
    return combine([*data, *table, *timing, _alignment_row(fit, capability)]), combine([*data_F0, *table_F0])


def _data_rows(
    weights: Array, evidence: ScaleFactorEvidence, scatter: tuple[float, float], unit: str, scale: float
) -> list[BudgetRow]:
    """Noise, scatter, drift, resolution, each as the equivalent uncertainty of one mean times ``scale``."""
    variances = (weights * evidence.standard_errors) ** 2
    noise = math.sqrt(float(variances.sum()))
    dof = _pooled_dof(variances, evidence.dofs)
    rows = [type_a("F̄", Message("Sensor noise in the means at the rates"), unit, noise / scale, scale, dof)]
    excess, freedom = scatter
    factor = math.sqrt(float(weights @ weights))
    rows.append(
        type_a(
            "v",
            Message("Scatter about a smooth curve beyond noise and drift"),
            unit,
            math.sqrt(excess),
            factor,
            freedom if excess > 0.0 else math.inf,
        )
    )
    rows.append(_drift_row(weights, evidence, unit))
    rows.append(_resolution_row(weights, evidence, unit))
    return rows


def _resolution_row(weights: Array, evidence: ScaleFactorEvidence, unit: str) -> BudgetRow:
    """Of the means at the rates and of F_r, whose weight is −Σw (0 for K). Undithered F_s and F_e show one
    code, so their error is one."""
    resolution = evidence.resolution
    per_mean = weights * resolution.mean_factors(evidence.durations_s, evidence.samples)
    rest = 0.5 * resolution.mean_factors(np.array(evidence.rest_durations_s), np.array(evidence.rest_samples))
    alike = not resolution.dithered and not resolution.of_angle
    of_rest = float(rest.sum()) ** 2 if alike else float(rest @ rest)
    return from_half_width(
        "q",
        Message("Resolution of the output"),
        "deg" if resolution.of_angle else unit,
        0.5 * resolution.step,
        math.sqrt(float(per_mean @ per_mean) + float(weights.sum()) ** 2 * of_rest),
        "data",
    )


def _drift_row(weights: Array, evidence: ScaleFactorEvidence, unit: str) -> BudgetRow:
    """Drift between the recordings; the weights of the two at rest make Σc = 0 (for K they are 0)."""
    rest = -0.5 * float(weights.sum())
    variance, dof = drift_variance(
        np.array([*weights, rest, rest]), evidence.all_starts_s, evidence.all_durations_s, evidence.noise
    )
    factor = math.sqrt(float(weights @ weights))
    return type_a(
        "D",
        Message("Drift of the zero between the recordings"),
        unit,
        math.sqrt(variance) / factor,
        factor,
        dof,
    )


def unexplained_scatter(fit: ScaleFactorFit, evidence: ScaleFactorEvidence) -> tuple[float, float]:
    """Variance of a mean beyond noise, drift and resolution, and its degrees of freedom.

    K is the slope of the least squares line through the response at the rates run, so what a smooth
    nonlinearity or asymmetry leaves beside the line is the unit's own (it is stated in ppm), not an error of
    K. Scatter is counted about a curve with Ω², |Ω| and Ω³ too, and only where noise, drift and resolution
    would exceed it in fewer than one case in twenty.
    """
    rates = np.array(fit.rates_dps) / max(abs(rate) for rate in fit.rates_dps)
    curve = np.column_stack([np.ones_like(rates), rates, rates**2, np.abs(rates), rates**3])
    left, singular, _ = np.linalg.svd(curve, full_matrices=True)
    smooth = int(np.sum(singular > 1e-6 * singular[0]))
    contrasts = left[:, smooth:].T
    freedom = len(contrasts)
    if freedom == 0:
        return 0.0, math.inf
    scatter = float(np.sum((contrasts @ np.array(fit.outputs)) ** 2))
    drift, _ = drift_variance(contrasts, evidence.starts_s, evidence.durations_s, evidence.noise)
    own = evidence.standard_errors**2 + evidence.unseen_variances[:-2]
    expected = float(np.sum(contrasts**2 @ own)) + drift
    if scatter <= expected * float(scipy.special.chdtri(freedom, SIGNIFICANCE)) / freedom:
        return 0.0, freedom
    return (scatter - expected) / freedom, freedom


def _level_row(fit: ScaleFactorFit, evidence: ScaleFactorEvidence, capability: BenchCapability) -> BudgetRow:
    """A case that leans feels the Earth's horizontal rate at rest; at the rates it turns away."""
    horizontal = EARTH_RATE_DPS * math.cos(math.radians(evidence.latitude_deg))
    source = Message("Level of the case, through the Earth's rate")
    return from_figure("β", source, "rad", _lean(capability), fit.K * horizontal)


def _lean(capability: BenchCapability) -> BenchFigure:
    """Case axis against table axis in one direction, rad: seat, fixture and wobble."""
    names = ("level_arcsec", "fixture_perpendicularity_arcsec", "wobble_arcsec")
    return root_sum([capability.figure(name) for name in names]).times(ARCSEC)


def _rest_row(evidence: ScaleFactorEvidence, unit: str) -> BudgetRow:
    variances = np.array(evidence.rest_standard_errors) ** 2 / 4.0
    return type_a(
        "F̄ᵣ",
        Message("Sensor noise in the mean at rest"),
        unit,
        math.sqrt(float(variances.sum())),
        1.0,
        _pooled_dof(variances, np.array(evidence.rest_dofs)),
    )


def bands_of(rates_dps: Array) -> NDArray[np.int_]:
    """The band of clause 6 of each rate, shape (M,)."""
    return np.array([rate_band(rate) for rate in rates_dps])


def _table_rows(
    fit: ScaleFactorFit,
    weights: Array,
    slope_residuals: float,
    evidence: ScaleFactorEvidence,
    capability: BenchCapability,
    rate_source: Literal["demanded", "table"],
) -> list[BudgetRow]:
    """∂/∂Ω_j is −K·weight_j for means on the line; off it a residual v_j turns the line by v_j/S, which
    ``slope_residuals`` counts: 1/S for K, −Ω̄/S for F₀."""
    rates = np.array(fit.rates_dps)
    if rate_source == "table":
        # angle turned over time: two readings of the angle, independent from rate to rate
        angle = capability.figure("position_arcsec").times(math.sqrt(2.0) * ARCSEC * math.degrees(1.0))
        factor = fit.K * math.sqrt(float(np.sum((weights / evidence.durations_s) ** 2)))
        return [from_figure("θ", Message("Angle read by the table"), "deg", angle, factor)]
    rows = []
    bands = bands_of(rates)
    moved = slope_residuals * np.array(fit.residuals) - fit.K * weights
    for band in np.unique(bands):
        inside = bands == band
        # one relative error for the whole band: its effects add with their signs
        factor = float(moved[inside] @ rates[inside])
        rows.append(
            from_figure(
                "Ω",
                Message("Table rate, {band}, common to the band", band=RATE_BAND_NAMES[band]),
                "1",
                capability.figure("rate_relative", int(band)),
                factor,
            )
        )
    return rows


def _alignment_row(fit: ScaleFactorFit, capability: BenchCapability) -> BudgetRow:
    """Case axis against table axis: a cosine, so of second order; level and fixture are seen through it."""
    lean = _lean(capability)
    return from_figure(
        "ε",
        Message("Case axis against the table's axis (cosine)"),
        "rad",
        lean,
        # K is too small by θ²/2; leaning both ways by u, θ²/2 has the root mean square √2·u²
        math.sqrt(2.0) * fit.K * lean.standard,
    )


def _pooled_dof(variances: Array, dofs: Array) -> float:
    """Welch–Satterthwaite inside a pooled row."""
    total = float(variances.sum())
    if total == 0.0:
        return math.inf
    weighted = float(np.sum((variances / total) ** 2 / dofs))
    return 1.0 / weighted if weighted > 0.0 else math.inf
