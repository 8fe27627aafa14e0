"""Diagnosis of K (7.1): residuals against rate, order and time, outliers, trend, lack of fit, drift between
the recordings at rest."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import (
    Change,
    DiagnosisFinding,
    LackOfFit,
    ScaleFactorDiagnosis,
    state_of,
)
from ahrs_lab.metrology.diagnosis.outliers import chance_of_all, diagnose_residuals
from ahrs_lab.metrology.diagnosis.statistics import (
    f_tail,
    residual_expectation,
    trend,
    two_sided,
    welch_satterthwaite,
)
from ahrs_lab.metrology.diagnosis.words import figures
from ahrs_lab.metrology.scale_factor import ScaleFactorFit
from ahrs_lab.metrology.uncertainty.gum_scale_factor import ScaleFactorEvidence
from ahrs_lab.metrology.uncertainty.noise import drift_covariances, drift_variance

Array = NDArray[np.float64]

MAIN_SHARE = 0.5
"""Of the variance of K from which scatter is what its uncertainty mainly consists of."""
_LEAST_RELATIVE = 1e-12
"""Noise that small beside the full scale is the arithmetic's."""


def diagnose_scale_factor(
    fit: ScaleFactorFit,
    evidence: ScaleFactorEvidence,
    *,
    segments: tuple[str, ...],
    statics: tuple[float, float],
    unit: str,
    scatter_share: float,
) -> ScaleFactorDiagnosis:
    """``evidence`` is the budget's; ``statics`` are F_s, F_e in ``unit``; ``scatter_share``: of the variance
    of K by scatter about a smooth curve, 0…1."""
    rates, starts = np.array(fit.rates_dps), evidence.starts_s
    design = np.column_stack([np.ones_like(rates), rates])
    full_scale = max(map(abs, fit.outputs), default=0.0)
    errors = _standard_errors(evidence)
    residuals = diagnose_residuals(
        design, np.array(fit.outputs), np.array(fit.residuals), errors, starts, evidence.durations_s, segments
    )
    middle = starts + 0.5 * evidence.durations_s
    order = np.argsort(np.argsort(starts, kind="stable"), kind="stable") + 1
    found = ScaleFactorDiagnosis(
        rates_dps=fit.rates_dps,
        order=tuple(int(place) for place in order),
        full_scale=full_scale,
        residuals=residuals,
        trend=trend(design, np.array(fit.outputs), middle - middle.mean()),
        lack_of_fit=_lack_of_fit(fit, evidence, design, errors, full_scale, scatter_share),
        drift=_drift(evidence, statics, full_scale),
    )
    findings = (
        *_outlier_findings(found),
        *_trend_finding(found),
        *_fit_finding(found),
        *_drift_finding(found, unit),
    )
    return ScaleFactorDiagnosis(**{**vars(found), "findings": findings})


def _standard_errors(evidence: ScaleFactorEvidence) -> Array:
    """Of the means; where the noise does not spread readings over steps, the resolution is their limit."""
    return np.sqrt(evidence.standard_errors**2 + evidence.unseen_variances[:-2])


def _lack_of_fit(
    fit: ScaleFactorFit,
    evidence: ScaleFactorEvidence,
    design: Array,
    errors: Array,
    full_scale: float,
    scatter_share: float,
) -> LackOfFit | None:
    """F of Σv² over what the recordings' own noise (pure error) and the drift between them explain."""
    if float(np.sqrt(np.mean(errors**2))) <= _LEAST_RELATIVE * full_scale:
        return None
    white, _ = residual_expectation(design, np.diag(errors**2))
    contrasts = np.linalg.qr(design, mode="complete")[0][:, design.shape[1] :].T
    drift, dof_drift = drift_variance(contrasts, evidence.starts_s, evidence.durations_s, evidence.noise)
    expected, dof_fit = residual_expectation(design, np.diag(errors**2) + _drift_covariance(evidence))
    leverage = 1.0 - (np.linalg.qr(design)[0] ** 2).sum(axis=1)
    dof_white = welch_satterthwaite(leverage * errors**2, evidence.dofs)
    dof_noise = welch_satterthwaite(np.array([white, drift]), np.array([dof_white, dof_drift]))
    F = math.fsum(v * v for v in fit.residuals) / expected
    return LackOfFit(F, dof_fit, dof_noise, f_tail(F, dof_fit, dof_noise), scatter_share)


def _drift_covariance(evidence: ScaleFactorEvidence) -> Array:
    """Of the means by flicker and random walk, shape (M, M); right beside a fitted constant."""
    flicker, walk = drift_covariances(evidence.starts_s, evidence.durations_s)
    return evidence.noise.flicker**2 * flicker + evidence.noise.walk**2 * walk


def _drift(evidence: ScaleFactorEvidence, statics: tuple[float, float], full_scale: float) -> Change | None:
    """F_e − F_s against the noise of the two means and the drift that the noise model expects."""
    white = np.array(evidence.rest_standard_errors) ** 2
    drift, dof_drift = drift_variance(
        np.array([-1.0, 1.0]),
        np.array(evidence.rest_starts_s),
        np.array(evidence.rest_durations_s),
        evidence.noise,
    )
    steps = float(evidence.unseen_variances[-2:].sum())
    standard = math.sqrt(float(white.sum()) + drift + steps)
    if standard <= _LEAST_RELATIVE * full_scale:
        return None
    variances = np.array([*white, drift, steps])
    dof = welch_satterthwaite(variances, np.array([*evidence.rest_dofs, dof_drift, math.inf]))
    value = statics[1] - statics[0]
    return Change(value, standard, dof, two_sided(value / standard, dof))


# ── sentences ────────────────────────────────────────────────────────────────────────────────────────────


def _ppm(found: ScaleFactorDiagnosis, value: float) -> float:
    return 1e6 * value / found.full_scale if found.full_scale > 0.0 else 0.0


def _outlier_findings(found: ScaleFactorDiagnosis) -> list[DiagnosisFinding]:
    residuals = found.residuals
    if residuals.dof < 1:
        return []
    if not residuals.outliers:
        what = Message("None of the {count} rates stands apart from the others.", count=len(found.rates_dps))
        return [DiagnosisFinding("fine", what, residuals.outlier_p)]
    findings = []
    for place in residuals.outliers:
        t = abs(residuals.studentised[place])
        p = chance_of_all(t, residuals.dof, len(residuals.studentised))
        what = Message(
            "At {rate} °/s the mean lies {residual} ppm off the line, {times} times what the other rates "
            "scatter. It was not left out: look at its raw segment, and record it again if a cause is "
            "found.",
            rate=f"{found.rates_dps[place]:g}".replace("-", "−"),
            residual=figures(_ppm(found, residuals.residuals[place]), plus=True),
            times=figures(t),
        )
        findings.append(DiagnosisFinding(state_of(p), what, p, residuals.segments[place]))
    return findings


def _trend_finding(found: ScaleFactorDiagnosis) -> list[DiagnosisFinding]:
    if found.trend is None:
        return []
    p = found.trend.p
    if state_of(p) == "fine":
        return [DiagnosisFinding("fine", Message("The residuals show no trend with time."), p)]
    what = Message(
        "The residuals change by {slope} ppm per minute: zero or scale factor drifted while the rates were "
        "recorded. Warm up longer, or run the rates in ± pairs.",
        slope=figures(60.0 * _ppm(found, found.trend.value), plus=True),
    )
    return [DiagnosisFinding(state_of(p), what, p)]


def _fit_finding(found: ScaleFactorDiagnosis) -> list[DiagnosisFinding]:
    fit = found.lack_of_fit
    if fit is None:
        return []
    if state_of(fit.p) == "fine":
        what = Message("The line fits as well as the noise of the recordings lets it.")
        return [DiagnosisFinding("fine", what, fit.p)]
    times, share = figures(math.sqrt(fit.F)), figures(100.0 * fit.share)
    if fit.share < MAIN_SHARE or state_of(fit.p) == "look":
        what = Message(
            "The residuals are {times} times what the noise of the recordings explains: the output is not "
            "quite linear, or the table's rate varied. Scatter about a smooth curve is {share} % of the "
            "variance of K.",
            times=times,
            share=share,
        )
        return [DiagnosisFinding("look", what, fit.p)]
    what = Message(
        "The residuals are {times} times what the noise of the recordings explains, and scatter about a "
        "smooth curve is {share} % of the variance of K: check the table and whether the rates stay within "
        "the range of the device.",
        times=times,
        share=share,
    )
    return [DiagnosisFinding("warn", what, fit.p)]


def _drift_finding(found: ScaleFactorDiagnosis, unit: str) -> list[DiagnosisFinding]:
    if found.drift is None:
        return []
    drift = found.drift
    factor, shown = (3600.0, "°/h") if unit == "deg/s" else (1.0, unit)
    numbers = {
        "drift": figures(factor * drift.value, plus=True),
        "standard": figures(factor * drift.standard),
        "unit": shown,
    }
    if state_of(drift.p) == "fine":
        what = Message(
            "From the rest before to the rest after the rates the zero moved by {drift} {unit}, no more than "
            "noise explains (u = {standard} {unit}).",
            **numbers,
        )
        return [DiagnosisFinding("fine", what, drift.p)]
    what = Message(
        "From the rest before to the rest after the rates the zero moved by {drift} {unit}, more than noise "
        "explains (u = {standard} {unit}): let the device warm up longer, or keep its temperature steadier.",
        **numbers,
    )
    return [DiagnosisFinding(state_of(drift.p), what, drift.p)]
