"""B of the axes from their positions: four of table 2, the combined schedule, or equal steps of azimuth
(7.2)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import (
    MisalignmentResult,
    ResultWarning,
    ScaleFactorResult,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.uncertainty.fitted_scale import UNSCALED, FittedScale
from ahrs_lab.metrology.uncertainty.full_model import check_by_monte_carlo
from ahrs_lab.metrology.uncertainty.full_zero_offset import zero_offset_model
from ahrs_lab.metrology.uncertainty.gum_zero_offset import (
    Repeatability,
    ZeroOffsetEvidence,
    zero_offset_uncertainty,
)
from ahrs_lab.metrology.zero_offset import azimuth_harmonic, zero_offset
from ahrs_lab.procedures.reduction_evidence import Evidence
from ahrs_lab.procedures.reduction_output import degrees_factor
from ahrs_lab.procedures.reduction_selection import Take, left_out, names
from ahrs_lab.recording.completeness import TABLE_2
from ahrs_lab.recording.orientation import AXES, Axis, Orientation

Array = NDArray[np.float64]
Schedule = Literal["standard", "combined", "multi-position"]

FEWEST_POWER_ONS = 3
"""Two results that happen to agree say nothing of how far the next may be off."""

SAME_DURATION = 1e-3
"""Relative difference of T between positions that is still one T."""


@dataclass(frozen=True)
class _Position:
    """One position with its repeats. ``direction``: where the axis points, east-north-up."""

    takes: tuple[Take, ...]
    direction: Array
    azimuth_deg: float

    @property
    def duration_s(self) -> float:
        return sum(take.output.duration_s for take in self.takes) / len(self.takes)

    @property
    def orientation(self) -> Orientation:
        return self.takes[0].segment.orientation


def reduce_zero_offsets(
    evidence: Evidence,
    scale_factors: Mapping[Axis, ScaleFactorResult],
    misalignments: Mapping[str, MisalignmentResult],
    *,
    combined: bool,
) -> tuple[dict[Axis, ZeroOffsetResult], list[ResultWarning]]:
    """B of every axis that was asked for. ``combined``: the four positions of one axis serve all three."""
    found: dict[Axis, ZeroOffsetResult] = {}
    warnings: list[ResultWarning] = []
    for source in AXES:
        takes = evidence.selection.of("zero_offset", source)
        targets: tuple[Axis, ...] = AXES if combined else (source,)
        if ("zero_offset", source) in evidence.selection.lacking:
            reason = Message("segments are missing, see the other warnings.")
            warnings += [left_out(Message("zero offset"), axis, reason) for axis in targets]
        elif takes:
            for axis in targets:
                result, said = _reduce(evidence, axis, source, takes, scale_factors, misalignments)
                warnings += said
                if result is not None:
                    found[axis] = result
    return {axis: found[axis] for axis in AXES if axis in found}, warnings


def _reduce(
    evidence: Evidence,
    axis: Axis,
    source: Axis,
    takes: Sequence[Take],
    scale_factors: Mapping[Axis, ScaleFactorResult],
    misalignments: Mapping[str, MisalignmentResult],
) -> tuple[ZeroOffsetResult | None, list[ResultWarning]]:
    item = Message("zero offset")
    factor = degrees_factor(takes[0].output.unit)
    fitted = UNSCALED
    if factor is None:
        if axis not in scale_factors or scale_factors[axis].K == 0.0:
            return None, [
                left_out(item, axis, Message("its counts need the fitted scale factor, which is not there."))
            ]
        K = scale_factors[axis]
        factor, fitted = 1.0 / K.K, FittedScale.of(K.K, K.uncertainty)
    try:
        schedule, positions = _positions(axis, source, takes)
    except InputError as error:
        return None, [left_out(item, axis, error.message)]
    warnings = _unequal_durations(axis, positions)
    leans = 0.0
    if schedule == "multi-position":
        known = misalignments.get(axis + _upright(positions))
        if known is None:
            warnings.append(_unknown_lean(axis, _upright(positions)))
        else:
            leans = abs(known.L)
    return _result(evidence, axis, schedule, positions, factor, fitted, leans), warnings


def _upright(positions: Sequence[_Position]) -> Axis:
    """The case axis that stands vertical."""
    return AXES[int(np.argmax(np.abs(positions[0].orientation.matrix[2])))]


def _unknown_lean(axis: Axis, upright: Axis) -> ResultWarning:
    return ResultWarning(
        Message(
            "zero offset {axis}: its misalignment about {upright} was not measured; what it lets in of the "
            "Earth's vertical rate does not cancel over the azimuths, and the uncertainty does not contain "
            "it.",
            axis=axis.upper(),
            upright=upright.upper(),
        )
    )


def _positions(axis: Axis, source: Axis, takes: Sequence[Take]) -> tuple[Schedule, list[_Position]]:
    """The positions in their order; raises InputError where the Earth's rate would not cancel."""
    expected = TABLE_2[source]
    by_letters: dict[str, list[Take]] = {}
    for take in takes:
        by_letters.setdefault(take.segment.orientation.letters, []).append(take)
    if set(by_letters) <= set(expected) and not _steps_between(takes):
        missing = [letters for letters in expected if letters not in by_letters]
        if missing:
            raise InputError(
                "no usable recording of the position {positions} is left.", positions=", ".join(missing)
            )
        positions = []
        for letters in expected:
            matrix = Orientation(letters).matrix
            group = tuple(by_letters[letters])
            positions.append(
                _Position(group, matrix[:, AXES.index(axis)], group[0].segment.azimuth_deg or 0.0)
            )
        return ("standard" if axis == source else "combined"), positions
    return "multi-position", _azimuth_positions(axis, takes)


def _steps_between(takes: Sequence[Take]) -> bool:
    """Whether some azimuth lies between the quarter turns."""
    azimuths = (take.segment.azimuth_deg for take in takes)
    return any(a is not None and abs(a - 90.0 * round(a / 90.0)) > 1.0 for a in azimuths)


def _azimuth_positions(axis: Axis, takes: Sequence[Take]) -> list[_Position]:
    """7.2.2: one mounting, the axis horizontal. Orientations name the nearest quarter turn; the first is
    exact."""
    if len({take.segment.orientation.face for take in takes}) != 1:
        raise InputError(
            "the positions are neither the four of table 2 nor steps of azimuth in one mounting."
        )
    if any(take.segment.azimuth_deg is None for take in takes):
        raise InputError("the azimuths of the positions are not given (azimuth_deg).")
    groups: dict[float, list[Take]] = {}
    for take in takes:
        groups.setdefault(round((take.segment.azimuth_deg or 0.0) % 360.0, 3), []).append(take)
    reference = takes[0].segment
    start = reference.azimuth_deg or 0.0
    initial = reference.orientation.matrix[:, AXES.index(axis)]
    if abs(initial[2]) > 0.5:
        raise InputError("the axis stands vertical; the multi-position method needs it horizontal.")
    positions = []
    for azimuth, group in sorted(groups.items()):
        turned = math.radians(azimuth - start)
        cosine, sine = math.cos(turned), math.sin(turned)
        east, north = float(initial[0]), float(initial[1])
        direction = np.array([cosine * east - sine * north, sine * east + cosine * north, 0.0])
        positions.append(_Position(tuple(group), direction, azimuth))
    balance = float(np.linalg.norm(sum(position.direction for position in positions))) / len(positions)
    if len(positions) == 1:
        raise InputError("1 usable azimuth is left; equal steps round the whole circle are needed.")
    if len(positions) < 3 or balance > 1e-3:
        raise InputError(
            "{count} usable azimuths are left; equal steps round the whole circle are needed.",
            count=len(positions),
        )
    return positions


def _unequal_durations(axis: Axis, positions: Sequence[_Position]) -> list[ResultWarning]:
    durations = [position.duration_s for position in positions]
    if max(durations) - min(durations) <= SAME_DURATION * max(durations):
        return []
    return [
        ResultWarning(
            Message(
                "zero offset {axis}: the positions lasted between {shortest} s and {longest} s; each angle "
                "was "
                "divided by its own time.",
                axis=axis,
                shortest=round(min(durations), 3),
                longest=round(max(durations), 3),
            )
        )
    ]


def _result(
    evidence: Evidence,
    axis: Axis,
    schedule: Schedule,
    positions: Sequence[_Position],
    factor: float,
    fitted: FittedScale,
    leans: float,
) -> ZeroOffsetResult:
    takes = [take for position in positions for take in position.takes]
    durations = np.array([position.duration_s for position in positions])
    angles = np.array(
        [
            factor * sum(take.output.dwell_angle(axis) for take in position.takes) / len(position.takes)
            for position in positions
        ]
    )
    B = zero_offset(angles, durations)
    duration = float(durations.mean())
    repeatability = _repeatability(evidence, axis, positions, factor, duration)
    included = repeatability if evidence.with_repeatability and evidence.method == "gum" else None
    recorded = replace(
        _budget_input(evidence, axis, positions, angles, durations, factor, fitted, leans),
        repeatability=included,
    )
    budget = zero_offset_uncertainty(B, recorded, evidence.capability)
    if evidence.method == "annex-a":
        repeated = [row.contribution for row in budget.rows if row.symbol.startswith("N_")]
        budget = evidence.annex_a(B, "deg/s", math.inf, evidence.acquisition_bits(axis), repeated)
    else:
        model = partial(zero_offset_model, B, recorded, budget)
        budget = check_by_monte_carlo(budget, B, model, evidence.monte_carlo, f"B_{axis}")
    return ZeroOffsetResult(
        axis=axis,
        B=B,
        unit="deg/s",
        duration_s=duration,
        angles_deg=tuple(angles.tolist()),
        uncertainty=budget,
        schedule=schedule,
        orientations=tuple(position.orientation.letters for position in positions),
        azimuths_deg=tuple(position.azimuth_deg for position in positions),
        durations_s=tuple(durations.tolist()),
        repeatability_dps=repeatability.deviation_dps if repeatability else None,
        repeatability_cycles=repeatability.cycles if repeatability else 0,
        repeatability_included=included is not None,
        earth_rate_check=_earth_rate_check(evidence, schedule, positions, angles / durations),
        segments=names(takes),
    )


def _repeatability(
    evidence: Evidence, axis: Axis, positions: Sequence[_Position], factor: float, duration_s: float
) -> Repeatability | None:
    """Experimental standard deviation of one B, where every position was repeated with power off between;
    else the Allan deviation at the dwell; None without noise."""
    repeats: dict[int, list[list[Take]]] = {}
    for position in positions:
        numbered: dict[int, list[Take]] = {}
        for take in position.takes:
            numbered.setdefault(int(take.segment.extra.get("repeat", 1)), []).append(take)
        for number, takes in numbered.items():
            repeats.setdefault(number, []).append(takes)
    whole = [groups for groups in repeats.values() if len(groups) == len(positions)]
    power_ons = [{_power_on(take) for takes in groups for take in takes} for groups in whole]
    apart = sum(len(known) for known in power_ons) == len(set().union(*power_ons))
    if len(whole) >= FEWEST_POWER_ONS and apart and None not in set().union(*power_ons):
        offsets = [
            zero_offset(
                [factor * sum(take.output.dwell_angle(axis) for take in takes) for takes in groups],
                [sum(take.output.duration_s for take in takes) for takes in groups],
            )
            for groups in whole
        ]
        return Repeatability(float(np.std(offsets, ddof=1)), len(whole))
    noise = evidence.noise[axis].scaled(factor)
    return Repeatability(noise.allan_deviation(duration_s), 0) if noise.white > 0.0 else None


def _power_on(take: Take) -> int | None:
    number = take.segment.extra.get("power_cycle")
    return number if isinstance(number, int) else None


def _budget_input(
    evidence: Evidence,
    axis: Axis,
    positions: Sequence[_Position],
    angles: Array,
    durations: Array,
    factor: float,
    fitted: FittedScale,
    leans: float,
) -> ZeroOffsetEvidence:
    directions = np.array([position.direction for position in positions])
    mountings = tuple(position.orientation.face for position in positions)
    return ZeroOffsetEvidence(
        directions=directions,
        turned_deg=_turned(positions),
        mountings=mountings,
        angles_deg=angles,
        durations_s=durations,
        repeats=np.array([float(len(position.takes)) for position in positions]),
        samples=np.array(
            [float(sum(take.output.samples for take in position.takes)) for position in positions]
        ),
        resolution=evidence.resolution[axis].scaled(factor),
        noise=evidence.noise[axis].scaled(factor),
        latitude_deg=evidence.site.latitude_deg,
        scale=fitted,
        leans=leans,
        time_scaled=positions[0].takes[0].output.source != "rate",
    )


def _turned(positions: Sequence[_Position]) -> Array:
    """The table's azimuth, degrees; where it was not recorded, from the mounting's first position on."""
    first: dict[str, _Position] = {}
    turned = []
    for position in positions:
        reference = first.setdefault(position.orientation.face, position)
        quarters = position.orientation.azimuth_from(reference.orientation)
        given = position.takes[0].segment.azimuth_deg is not None
        turned.append(position.azimuth_deg if given else quarters)
    return np.array(turned)


def _earth_rate_check(
    evidence: Evidence, schedule: Schedule, positions: Sequence[_Position], rates_dps: Array
) -> dict[str, float] | None:
    if schedule != "multi-position":
        return None
    headings = [
        math.degrees(math.atan2(float(position.direction[0]), float(position.direction[1])))
        for position in positions
    ]
    harmonic = azimuth_harmonic(rates_dps, headings, evidence.site.latitude_deg)
    return {
        "amplitude_dps": harmonic.amplitude_dps,
        "expected_dps": harmonic.expected_dps,
        "phase_deg": harmonic.phase_deg,
        # azimuth counts against the heading: the table turns anticlockwise
        "heading_at_zero_deg": (headings[0] + positions[0].azimuth_deg) % 360.0,
    }
