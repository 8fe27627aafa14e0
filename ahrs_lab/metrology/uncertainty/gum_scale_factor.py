"""Budgets of K and F₀ (JCGM 100): sensitivities of the regression itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
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
from ahrs_lab.metrology.uncertainty.budget import combine, from_expanded, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, drift_variance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ScaleFactorEvidence:
    """What the data say about the M means of (10) and the two at rest; arrays of shape (M,), the device's
    unit.

    ``starts_s`` are on one time scale with ``rest_starts_s`` (F_s, F_e). ``resolution`` is the output's
    step, ``samples`` per mean; ``dithered`` where the noise spreads a reading over several steps.
    """

    standard_errors: Array
    dofs: Array
    durations_s: Array
    starts_s: Array
    rest_standard_errors: tuple[float, float]
    rest_dofs: tuple[float, float]
    rest_durations_s: tuple[float, float]
    rest_starts_s: tuple[float, float]
    samples: Array
    resolution: float
    dithered: bool
    noise: NoiseModel


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
    data = _data_rows(fit, K_weights, evidence, device_unit, 1.0 / math.sqrt(fit.spread))
    F0_scale = 1.0 / math.sqrt(len(F0_weights))
    data_F0 = _data_rows(fit, F0_weights, evidence, device_unit, F0_scale)
    data_F0.append(_rest_row(evidence, device_unit))
    timing: list[BudgetRow] = []
    if time_scaled or rate_source == "table":
        timing.append(
            from_expanded(
                "t",
                Message("Time base"),
                "1",
                capability.timing_relative,
                fit.K,
                capability.origin("timing_relative"),
            )
        )
    return combine([*data, *table, *timing, _alignment_row(fit, capability)]), combine([*data_F0, *table_F0])


def _data_rows(
    fit: ScaleFactorFit, weights: Array, evidence: ScaleFactorEvidence, unit: str, scale: float
) -> list[BudgetRow]:
    """Noise, lack of fit, drift, resolution, each as the equivalent uncertainty of one mean times
    ``scale``."""
    variances = (weights * evidence.standard_errors) ** 2
    noise = math.sqrt(float(variances.sum()))
    dof = _pooled_dof(variances, evidence.dofs)
    rows = [type_a("F̄", Message("Sensor noise in the means at the rates"), unit, noise / scale, scale, dof)]
    freedom = len(weights) - 2
    if freedom > 0:
        scatter = sum(v * v for v in fit.residuals) / freedom
        expected = float(np.mean(evidence.standard_errors**2))
        excess = math.sqrt(max(0.0, scatter - expected))
        factor = math.sqrt(float(weights @ weights))
        rows.append(
            type_a("v", Message("Lack of fit beyond the sensor noise"), unit, excess, factor, freedom)
        )
    rows.append(_drift_row(weights, evidence, unit))
    per_mean = weights / np.sqrt(evidence.samples) if evidence.dithered else weights
    rows.append(
        from_half_width(
            "q",
            Message("Resolution of the output"),
            unit,
            0.5 * evidence.resolution,
            math.sqrt(float(per_mean @ per_mean)),
            "data",
        )
    )
    return rows


def _drift_row(weights: Array, evidence: ScaleFactorEvidence, unit: str) -> BudgetRow:
    """Drift between the recordings; the weights of the two at rest make Σc = 0 (for K they are 0)."""
    rest = -0.5 * float(weights.sum())
    variance = drift_variance(
        np.array([*weights, rest, rest]),
        np.array([*evidence.starts_s, *evidence.rest_starts_s]),
        np.array([*evidence.durations_s, *evidence.rest_durations_s]),
        evidence.noise,
    )
    factor = math.sqrt(float(weights @ weights))
    return type_a(
        "D",
        Message("Drift of the zero between the recordings"),
        unit,
        math.sqrt(variance) / factor,
        factor,
        evidence.noise.drift_dof,
    )


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
        angle = math.sqrt(2.0) * capability.position_arcsec * ARCSEC * math.degrees(1.0)
        factor = fit.K * math.sqrt(float(np.sum((weights / evidence.durations_s) ** 2)))
        origin = capability.origin("position_arcsec")
        return [from_expanded("θ", Message("Angle read by the table"), "deg", angle, factor, origin)]
    rows = []
    bands = bands_of(rates)
    moved = slope_residuals * np.array(fit.residuals) - fit.K * weights
    for band in np.unique(bands):
        inside = bands == band
        # one relative error for the whole band: its effects add with their signs
        factor = float(moved[inside] @ rates[inside])
        rows.append(
            from_expanded(
                "Ω",
                Message("Table rate, {band}, common to the band", band=RATE_BAND_NAMES[band]),
                "1",
                capability.rate_relative[band],
                factor,
                capability.origin("rate_relative"),
            )
        )
    return rows


def _alignment_row(fit: ScaleFactorFit, capability: BenchCapability) -> BudgetRow:
    """Case axis against table axis: a cosine, so of second order; level and fixture are seen through it."""
    names = ("level_arcsec", "fixture_perpendicularity_arcsec", "wobble_arcsec")
    angle = math.sqrt(sum(getattr(capability, name) ** 2 for name in names)) * ARCSEC
    certified = all(capability.origin(name) == "certificate" for name in names)
    return from_expanded(
        "ε",
        Message("Case axis against the table's axis (cosine)"),
        "rad",
        angle,
        0.5 * fit.K * angle,
        "certificate" if certified else "assumption",
    )


def _pooled_dof(variances: Array, dofs: Array) -> float:
    """Welch–Satterthwaite inside a pooled row."""
    total = float(variances.sum())
    if total == 0.0:
        return math.inf
    weighted = float(np.sum((variances / total) ** 2 / dofs))
    return 1.0 / weighted if weighted > 0.0 else math.inf
