"""The diagnosis of a reduced recording, and which of it the reader of the result is warned of."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.allan import allan_finding, diagnose_allan
from ahrs_lab.metrology.diagnosis.misalignment import diagnose_misalignment
from ahrs_lab.metrology.diagnosis.model import (
    AllanDiagnosis,
    Diagnosis,
    DiagnosisFinding,
    Harmonic,
    MisalignmentDiagnosis,
    ScaleFactorDiagnosis,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.diagnosis.scale_factor import diagnose_scale_factor
from ahrs_lab.metrology.diagnosis.zero_offset import (
    PositionEvidence,
    diagnose_harmonic,
    diagnose_positions,
    harmonic_findings,
    position_findings,
)
from ahrs_lab.metrology.result import (
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.gum_scale_factor import ScaleFactorEvidence
from ahrs_lab.metrology.uncertainty.noise import standard_error
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS
from ahrs_lab.procedures.reduction_evidence import Evidence, axis_batches
from ahrs_lab.procedures.reduction_output import degrees_factor
from ahrs_lab.procedures.reduction_scale_factor import samples_of
from ahrs_lab.procedures.reduction_selection import Take
from ahrs_lab.recording.orientation import AXES, Axis

Array = NDArray[np.float64]


class _Looked:
    """The evidence with each take's one-second means, made once."""

    def __init__(self, evidence: Evidence) -> None:
        self.evidence = evidence
        self.takes = {take.segment.name: take for take in evidence.selection.takes}
        self._batches: dict[tuple[str, Axis], tuple[Array, float]] = {}

    def used(self, item: str, names: Iterable[str]) -> list[Take]:
        """The takes of a result's segments, in their order; of one name each in turn."""
        named: dict[str, list[Take]] = {}
        for take in self.evidence.selection.takes:
            if take.segment.item == item:
                named.setdefault(take.segment.name, []).append(take)
        return [named[name].pop(0) if len(named[name]) > 1 else named[name][0] for name in names]

    def batches(self, take: Take, axis: Axis) -> tuple[Array, float]:
        """Means over about a second, the output's unit, and their length, s."""
        key = (take.segment.file, axis)
        if key not in self._batches:
            self._batches[key] = axis_batches(take.output, axis)
        return self._batches[key]

    def error(self, takes: Sequence[Take], axis: Axis) -> tuple[float, float]:
        """Standard error of the mean of the takes' means, and its degrees of freedom; the output's unit."""
        noise = self.evidence.noise[axis]
        errors = [
            standard_error(self.batches(take, axis)[0], noise.inflation(take.output.duration_s))
            for take in takes
        ]
        return math.sqrt(sum(error**2 for error, _ in errors)) / len(takes), sum(dof for _, dof in errors)


def diagnose(
    evidence: Evidence,
    scale_factors: Mapping[Axis, ScaleFactorResult],
    zero_offsets: Mapping[Axis, ZeroOffsetResult],
    misalignments: Mapping[str, MisalignmentResult],
) -> tuple[Diagnosis, list[ResultWarning]]:
    """Everything that the recording's results can be looked at for; warnings name quantity and segment."""
    looked = _Looked(evidence)
    found = Diagnosis(
        {axis: _scale_factor(looked, one) for axis, one in scale_factors.items()},
        {
            axis: _zero_offset(looked, one, scale_factors.get(axis), misalignments)
            for axis, one in zero_offsets.items()
        },
        {key: _misalignment(looked, one) for key, one in misalignments.items()},
    )
    warnings: list[ResultWarning] = []
    for axis, scale in found.scale_factor.items():
        warnings += _warnings(f"K_{axis}", scale.findings, looked.takes)
    for axis, offset in found.zero_offset.items():
        warnings += _warnings(f"B_{axis}", offset.findings, looked.takes)
    return found, warnings


def _warnings(
    quantity: str, findings: Iterable[DiagnosisFinding], takes: Mapping[str, Take]
) -> list[ResultWarning]:
    return [
        ResultWarning(
            Message("{quantity}: {what}", quantity=quantity, what=finding.what),
            takes[finding.segment].segment.file if finding.segment else "",
        )
        for finding in findings
        if finding.state == "warn"
    ]


# ── K ────────────────────────────────────────────────────────────────────────────────────────────────────


def _scale_factor(looked: _Looked, result: ScaleFactorResult) -> ScaleFactorDiagnosis:
    axis, evidence = result.axis, looked.evidence
    used = evidence.selection.of("scale_factor", axis)
    at_rates = [take for take in used if take.segment.role == "rate"]
    rests = [
        [take for take in used if take.segment.role == role] for role in ("static_before", "static_after")
    ]
    errors = [looked.error([take], axis) for take in at_rates]
    rest_errors = [looked.error(group, axis) for group in rests]
    fit = fit_scale_factor(result.rates_dps, result.means, result.static_before, result.static_after)
    return diagnose_scale_factor(
        fit,
        ScaleFactorEvidence(
            standard_errors=np.array([error for error, _ in errors]),
            dofs=np.array([dof for _, dof in errors]),
            durations_s=np.array([take.output.duration_s for take in at_rates]),
            starts_s=np.array([take.start_s for take in at_rates]),
            rest_standard_errors=(rest_errors[0][0], rest_errors[1][0]),
            rest_dofs=(rest_errors[0][1], rest_errors[1][1]),
            rest_durations_s=(_mean_duration(rests[0]), _mean_duration(rests[1])),
            rest_starts_s=(_mean_start(rests[0]), _mean_start(rests[1])),
            rest_samples=(samples_of(rests[0]), samples_of(rests[1])),
            samples=np.array([float(take.output.samples) for take in at_rates]),
            resolution=evidence.resolution[axis],
            noise=evidence.noise[axis],
            latitude_deg=evidence.site.latitude_deg,
        ),
        segments=tuple(take.segment.name for take in at_rates),
        statics=(result.static_before, result.static_after),
        unit=at_rates[0].output.unit,
        scatter_share=_scatter_share(result.uncertainty),
    )


def _scatter_share(budget: Uncertainty) -> float:
    scatter = math.hypot(*(row.contribution for row in budget.rows if row.symbol == "v"))
    return (scatter / budget.standard) ** 2 if scatter > 0.0 else 0.0


def _mean_duration(takes: Sequence[Take]) -> float:
    return sum(take.output.duration_s for take in takes) / len(takes)


def _mean_start(takes: Sequence[Take]) -> float:
    return sum(take.start_s for take in takes) / len(takes)


# ── B ────────────────────────────────────────────────────────────────────────────────────────────────────


def _zero_offset(
    looked: _Looked,
    result: ZeroOffsetResult,
    scale: ScaleFactorResult | None,
    misalignments: Mapping[str, MisalignmentResult],
) -> ZeroOffsetDiagnosis:
    axis = result.axis
    used = looked.used("zero_offset", result.segments)
    factor = degrees_factor(used[0].output.unit)
    gain = 1.0
    if factor is None:
        factor = 1.0 / scale.K if scale is not None else 1.0
    elif scale is not None:
        gain = factor * scale.K
    residuals = diagnose_positions(_position_evidence(looked, result, used, factor))
    harmonic = _harmonic(looked.evidence, result, residuals.standard_errors, gain, misalignments)
    allan = _allan(looked, axis, factor, result.duration_s)
    findings = [
        *position_findings(residuals),
        *(harmonic_findings(harmonic) if harmonic is not None else ()),
        *([allan_finding(allan)] if allan is not None else ()),
    ]
    return ZeroOffsetDiagnosis(residuals, harmonic, allan, tuple(findings))


def _position_evidence(
    looked: _Looked, result: ZeroOffsetResult, used: Sequence[Take], factor: float
) -> PositionEvidence:
    axis = result.axis
    headings = None
    if result.earth_rate_check is not None:
        at_zero = result.earth_rate_check["heading_at_zero_deg"]
        headings = np.array([at_zero - (take.segment.azimuth_deg or 0.0) for take in used])
    column = AXES.index(axis)
    latitude = math.radians(looked.evidence.site.latitude_deg)
    earth = EARTH_RATE_DPS * np.array([0.0, math.cos(latitude), math.sin(latitude)])
    along = np.array([take.segment.orientation.matrix[:, column] for take in used]) @ earth
    return PositionEvidence(
        rates_dps=np.array(
            [factor * take.output.dwell_angle(axis) / take.output.duration_s for take in used]
        ),
        earth_dps=along,
        standard_errors_dps=np.array([abs(factor) * looked.error([take], axis)[0] for take in used]),
        starts_s=np.array([take.start_s for take in used]),
        durations_s=np.array([take.output.duration_s for take in used]),
        segments=tuple(take.segment.name for take in used),
        headings_deg=headings,
    )


def _harmonic(
    evidence: Evidence,
    result: ZeroOffsetResult,
    standard_errors: Sequence[float],
    gain: float,
    misalignments: Mapping[str, MisalignmentResult],
) -> Harmonic | None:
    check = result.earth_rate_check
    if check is None:
        return None
    azimuths = np.array(result.azimuths_deg)
    bench = evidence.capability
    seat = [one.L for key, one in misalignments.items() if key[0] == result.axis]
    pointing = math.hypot(bench.azimuth_arcsec, bench.position_arcsec, bench.fixture_perpendicularity_arcsec)
    return diagnose_harmonic(
        azimuths,
        check["heading_at_zero_deg"] - azimuths,
        np.array(result.angles_deg) / np.array(result.durations_s),
        latitude_deg=evidence.site.latitude_deg,
        gain=gain,
        noise_dps=math.sqrt(float(np.mean(np.square(standard_errors)))),
        latitude_standard_deg=0.5 * bench.latitude_deg,
        # how the sensitive axis lies in the case turns its north by as much
        azimuth_standard_deg=math.hypot(0.5 * pointing / 3600.0, *(math.degrees(L) for L in seat)),
    )


def _allan(looked: _Looked, axis: Axis, factor: float, duration_s: float) -> AllanDiagnosis | None:
    """From every position that was recorded: the output of this axis was recorded in all of them."""
    positions = [take for take in looked.evidence.selection.takes if take.segment.item == "zero_offset"]
    batches = [looked.batches(take, axis) for take in positions]
    longest = max(batch_s for _, batch_s in batches)
    dwells = [abs(factor) * means for means, batch_s in batches if batch_s == longest]
    return diagnose_allan(dwells, longest, looked.evidence.noise[axis].scaled(factor), duration_s)


# ── L ────────────────────────────────────────────────────────────────────────────────────────────────────


def _misalignment(looked: _Looked, result: MisalignmentResult) -> MisalignmentDiagnosis:
    used = looked.evidence.selection.of("misalignment", result.turned_axis)
    positive = [take for take in used if (take.segment.turns or 0) > 0]
    negative = [take for take in used if (take.segment.turns or 0) < 0]
    return diagnose_misalignment(
        result.angle_positive_deg,
        result.angle_negative_deg,
        (_mean_duration(positive), _mean_duration(negative)),
        used[0].output.step_s,
    )
