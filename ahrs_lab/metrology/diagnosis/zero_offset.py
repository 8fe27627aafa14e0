"""Diagnosis of B (7.2): recordings that stand apart, and the Earth's rate in the multi-position method."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import Change, DiagnosisFinding, Harmonic, Residuals, state_of
from ahrs_lab.metrology.diagnosis.outliers import chance_of_all, diagnose_residuals
from ahrs_lab.metrology.diagnosis.statistics import two_sided
from ahrs_lab.metrology.diagnosis.words import figures
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS, azimuth_harmonic

Array = NDArray[np.float64]

_DPH = 3600.0
_CURVE_STEP_DEG = 10.0


@dataclass(frozen=True)
class PositionEvidence:
    """The single recordings of one axis's positions; arrays of shape (n,), rates in °/s.

    ``headings_deg``: where the axis points, clockwise from north, for the multi-position method, else None;
    ``earth_dps``: the Earth's rate along the axis there.
    """

    rates_dps: Array
    earth_dps: Array
    standard_errors_dps: Array
    starts_s: Array
    durations_s: Array
    segments: tuple[str, ...]
    headings_deg: Array | None = None


def diagnose_positions(evidence: PositionEvidence) -> Residuals:
    """Against B and the Earth's rate; of the multi-position method against the harmonic, as fitted."""
    ones = np.ones_like(evidence.rates_dps)
    if evidence.headings_deg is None:
        design, values = ones[:, None], evidence.rates_dps - evidence.earth_dps
    else:
        heading = np.radians(evidence.headings_deg)
        design, values = np.column_stack([ones, np.cos(heading), np.sin(heading)]), evidence.rates_dps
    solution = np.linalg.lstsq(design, values, rcond=None)[0]
    return diagnose_residuals(
        design,
        values,
        values - design @ solution,
        evidence.standard_errors_dps,
        evidence.starts_s,
        evidence.durations_s,
        evidence.segments,
    )


def diagnose_harmonic(
    azimuths_deg: Array,
    headings_deg: Array,
    rates_dps: Array,
    *,
    latitude_deg: float,
    gain: float,
    noise_dps: float,
    latitude_standard_deg: float,
    azimuth_standard_deg: float,
) -> Harmonic | None:
    """Amplitude against ``gain``·ω_ie·cos φ, phase against north, each within its standard uncertainty.

    Arrays of shape (n,), equal steps. The scatter about the harmonic is the noise, from n − 3 degrees of
    freedom; with three positions ``noise_dps``, the standard error of one. ``gain`` is K where the output was
    not divided by it. ``azimuth_standard_deg``: north, table and how the axis lies in the case. None where
    there is no noise to judge by.
    """
    found = azimuth_harmonic(rates_dps, headings_deg, latitude_deg)
    heading = np.radians(headings_deg)
    fitted = rates_dps.mean() + found.amplitude_dps * np.cos(heading - math.radians(found.phase_deg))
    left, dof = rates_dps - fitted, float(len(rates_dps) - 3)
    standard = math.sqrt(float(left @ left) / dof) if dof > 0.0 else noise_dps
    expected = abs(gain) * found.expected_dps
    if standard <= 1e-12 * max(expected, abs(float(rates_dps.mean()))) or expected == 0.0:
        return None
    dof = dof if dof > 0.0 else math.inf
    noise = standard * math.sqrt(2.0 / len(rates_dps))
    slope = abs(gain) * EARTH_RATE_DPS * math.sin(math.radians(latitude_deg))
    amplitude = _change(
        found.amplitude_dps - expected, noise, slope * math.radians(latitude_standard_deg), dof
    )
    phase = _change(found.phase_deg, math.degrees(noise / expected), azimuth_standard_deg, dof)
    curve = np.arange(0.0, 360.0 + 0.5 * _CURVE_STEP_DEG, _CURVE_STEP_DEG)
    # azimuth counts anticlockwise, the heading of the axis clockwise
    along = np.radians(headings_deg[0] + azimuths_deg[0] - curve)
    wave = found.amplitude_dps * np.cos(along - math.radians(found.phase_deg))
    return Harmonic(
        amplitude_dps=found.amplitude_dps,
        expected_dps=expected,
        amplitude=amplitude,
        phase=phase,
        azimuths_deg=tuple(azimuths_deg.tolist()),
        rates_dps=tuple(rates_dps.tolist()),
        standard_error_dps=standard,
        curve_azimuths_deg=tuple(curve.tolist()),
        fitted_dps=tuple((rates_dps.mean() + wave).tolist()),
        expected_curve_dps=tuple((rates_dps.mean() + expected * np.cos(along)).tolist()),
    )


def _change(value: float, noise: float, bench: float, dof: float) -> Change:
    """``dof`` are the noise's; the bench's figure is taken as known."""
    variance = noise**2 + bench**2
    effective = dof * (variance / noise**2) ** 2 if math.isfinite(dof) else math.inf
    standard = math.sqrt(variance)
    return Change(value, standard, effective, two_sided(value / standard, effective))


# ── sentences ────────────────────────────────────────────────────────────────────────────────────────────


def position_findings(found: Residuals) -> list[DiagnosisFinding]:
    """Which recordings stand apart, and whether all together scatter more than their noise."""
    return [*_outlier_findings(found), *_scatter_finding(found)] if found.dof > 0 else []


def _scatter_finding(found: Residuals) -> list[DiagnosisFinding]:
    """By χ²; never a warning, because what the offset does from dwell to dwell belongs to B (7.2)."""
    noise = math.sqrt(math.fsum(e * e for e in found.standard_errors) / len(found.standard_errors))
    scatter = math.sqrt(math.fsum(v * v for v in found.residuals) / found.dof)
    if noise <= 1e-9 * EARTH_RATE_DPS:
        return []
    p = float(scipy.special.chdtrc(found.dof, found.dof * (scatter / noise) ** 2))
    numbers = {"scatter": figures(_DPH * scatter), "noise": figures(_DPH * noise)}
    if state_of(p) == "fine":
        what = Message(
            "The recordings scatter by {scatter} °/h, no more than the noise of one, {noise} °/h, explains.",
            **numbers,
        )
        return [DiagnosisFinding("fine", what, p)]
    what = Message(
        "The recordings scatter by {scatter} °/h, the noise of one is {noise} °/h: the zero offset changed "
        "from one to the next (drift, turn-on, temperature). U says how well its mean over these recordings "
        "is known; another day B may be off by as much as they scatter.",
        **numbers,
    )
    return [DiagnosisFinding("look", what, p)]


def _outlier_findings(found: Residuals) -> list[DiagnosisFinding]:
    if not found.outliers:
        what = Message(
            "None of the {count} recordings stands apart from the others, the Earth's rate taken out.",
            count=len(found.residuals),
        )
        return [DiagnosisFinding("fine", what, found.outlier_p)]
    findings = []
    for place in found.outliers:
        t = abs(found.studentised[place])
        p = chance_of_all(t, found.dof, len(found.studentised))
        what = Message(
            "Recording {number} of {count} lies {residual} °/h off, {times} times what the others "
            "scatter. It was not left out: check mounting and azimuth, look at its raw segment, and "
            "record it again if a cause is found.",
            number=place + 1,
            count=len(found.residuals),
            residual=figures(_DPH * found.residuals[place], plus=True),
            times=figures(t),
        )
        findings.append(DiagnosisFinding(state_of(p), what, p, found.segments[place]))
    return findings


def harmonic_findings(found: Harmonic) -> list[DiagnosisFinding]:
    """Whether the Earth's rate shows as large, and where, as it has to."""
    numbers = {
        "amplitude": figures(_DPH * found.amplitude_dps, 4),
        "expected": figures(_DPH * found.expected_dps, 4),
        "standard": figures(_DPH * found.amplitude.standard),
    }
    if state_of(found.amplitude.p) == "fine":
        what = Message(
            "The Earth's rate shows with {amplitude} °/h where ω_ie·cos φ is {expected} °/h: they agree "
            "within the uncertainty (u = {standard} °/h).",
            **numbers,
        )
    else:
        what = Message(
            "The Earth's rate shows with {amplitude} °/h where ω_ie·cos φ is {expected} °/h, further "
            "off than noise explains (u = {standard} °/h): check the latitude, the level of the axis, the "
            "steps of azimuth and the unit of the output.",
            **numbers,
        )
    north = {"phase": figures(found.phase.value, plus=True), "standard": figures(found.phase.standard)}
    if state_of(found.phase.p) == "fine":
        where = Message(
            "North by the gyro is {phase}° from north by the table, within the uncertainty "
            "(u = {standard}°).",
            **north,
        )
    else:
        where = Message(
            "North by the gyro is {phase}° from north by the table, more than noise explains (u = "
            "{standard}°): check the north reference, the table's zero and the seat of the case.",
            **north,
        )
    return [
        DiagnosisFinding(state_of(found.amplitude.p), what, found.amplitude.p),
        DiagnosisFinding(state_of(found.phase.p), where, found.phase.p),
    ]
