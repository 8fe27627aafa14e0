"""From a recording of the discrete IMU calibration to its result; the live run and ``evaluate`` both come
here, and the set is the one that ``imu-calibrate`` makes of the same recording."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.imu_calibration import calibrate_recording
from ahrs_lab.analysis.imu_report import calibration_report
from ahrs_lab.analysis.report import Report
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.attitude import rotation_about
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.figures_json import noted_capability, with_capability
from ahrs_lab.metrology.imu_calibration import PositionData, RotationData, case_to_enu
from ahrs_lab.metrology.imu_result import ImuDwell, ImuResult, ImuTurns
from ahrs_lab.metrology.result import ResultWarning
from ahrs_lab.procedures import course
from ahrs_lab.procedures.plan import plan_from_toml
from ahrs_lab.procedures.recorded_facts import (
    device_facts,
    noted_deviations,
    noted_environment,
    run_warnings,
    segment_starts,
    set_aside,
    site_facts,
)
from ahrs_lab.recording.read import Recording
from ahrs_lab.recording.segment import Segment


def evaluate_imu(recording: Recording, capability: BenchCapability | None, software: str) -> ImuResult:
    """The calibration set with what the recording says beside it.

    ``capability``: the bench's figures; None: those that the recording names, else clause 6's own. Raises
    InputError where turns or positions are missing.
    """
    header = recording.header
    figures = capability or noted_capability(header.notes) or BenchCapability()
    made = calibrate_recording(recording, capability=capability, software=software)
    used = {recorded.segment.name: recorded for recorded in recording.segments if recorded.usable}
    dwells = [_dwell(data, used[_segment(data.name)].segment) for data in made.positions]
    turns = [_turns(data, used[_segment(data.name)].segment) for data in made.rotations]
    said = [
        *run_warnings(recording),
        *_missing(recording, set(used)),
        *(ResultWarning(message) for message in made.calibration.warnings),
    ]
    return ImuResult(
        procedure=header.procedure,
        bundle_sha256=recording.sha256,
        software=software,
        calibration=made.calibration,
        dwells=tuple(dwells),
        turns=tuple(turns),
        warnings=tuple(said),
        deviations=noted_deviations(header.notes),
        environment=noted_environment(header.notes),
        device=device_facts(header),
        site=site_facts(header),
        notes=with_capability({**header.notes, **set_aside(recording), **segment_starts(recording)}, figures),
        simulated=header.notes.get("simulated") is True,
    )


def _missing(recording: Recording, used: set[str]) -> list[ResultWarning]:
    """What the plan has and the set was made without."""
    noted = recording.header.notes.get("plan")
    try:
        names = course.segment_names(plan_from_toml(noted)) if isinstance(noted, Mapping) else ()
    except InputError:  # a plan of another version: the recording is evaluated as it is
        return []
    left_out = [name for name in names if name not in used]
    if not left_out:
        return []
    return [
        ResultWarning(
            Message(
                "{count} of the plan's {all} segments are missing or cannot be used: {names}.",
                count=len(left_out),
                all=len(names),
                names=", ".join(left_out),
            )
        )
    ]


def _dwell(data: PositionData, segment: Segment) -> ImuDwell:
    azimuth = segment.azimuth_deg or 0.0
    return ImuDwell(
        name=data.name,
        orientation=segment.orientation.letters,
        beyond_deg=azimuth - 90.0 * round(azimuth / 90.0),
        duration_s=data.duration_s,
        gyro=tuple(data.gyro.tolist()),
        accel=tuple(data.accel.tolist()),
    )


def _turns(data: RotationData, segment: Segment) -> ImuTurns:
    return ImuTurns(
        name=data.name,
        orientation=segment.orientation.letters,
        turns=segment.turns or 0,
        rate_dps=segment.rate_dps,
        duration_s=data.duration_s,
        turned_deg=data.turned_deg,
        angle=tuple(data.angle.tolist()),
    )


def _segment(name: str) -> str:
    """The segment's own name, without the orientation that the reduction adds for its reader."""
    return name.split(" (", maxsplit=1)[0]


def imu_report(result: ImuResult) -> Report:
    """Tables, charts and sentences of a result, as ``imu-calibrate`` shows them, with the run's warnings."""
    positions = [
        PositionData(_stood(one), np.array(one.gyro), np.array(one.accel), one.duration_s, name=one.name)
        for one in result.dwells
    ]
    rotations = [
        RotationData(
            case_to_enu(one.orientation), one.turned_deg, one.duration_s, np.array(one.angle), name=one.name
        )
        for one in result.turns
    ]
    report = calibration_report(result.calibration, positions, rotations)
    said = [
        Message("{file}: {what}", file=warning.segment, what=warning.what)
        if warning.segment
        else warning.what
        for warning in result.warnings
    ]
    return replace(report, warnings=tuple(said))


def _stood(dwell: ImuDwell) -> NDArray[np.float64]:
    angle = np.radians(dwell.beyond_deg)
    return np.asarray(rotation_about(2, angle) @ case_to_enu(dwell.orientation), dtype=np.float64)
