"""A calibration set from a recording on the table: procedure ``imu-discrete``, section 2.6.3.

Used are all whole turns (role ``turns``) and all dwells at rest (role ``position``) that count, whatever item
they were recorded for, so a recording by JJF 1536 gives a set too. The case stands as the segment's letters
say; ``azimuth_deg``, the table's angle in its mounting, adds what lies between the quarter turns (the letters
then name the nearest). ``turns`` are the table's: positive anticlockwise seen from above, also where the axis
points down.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.imu_report import calibration_report
from ahrs_lab.analysis.imu_segments import (
    Channels,
    at_rest,
    position_data,
    rotation_data,
    starts_and_mountings,
)
from ahrs_lab.analysis.inertial_record import InertialRecord, records, unit_doubts
from ahrs_lab.analysis.report import Report
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.earth import earth_rate_enu_dps, normal_gravity_mps2
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.figures_json import noted_capability
from ahrs_lab.metrology.imu_bench import ANOMALY_MPS2, MEASURED_GRAVITY_MPS2, bench_uncertainty
from ahrs_lab.metrology.imu_calibration import (
    AXES,
    SCHEMES,
    ImuCalibration,
    PositionData,
    RotationData,
)
from ahrs_lab.metrology.imu_calibration_json import to_json
from ahrs_lab.metrology.imu_estimation import ReferenceVectors, calibrate
from ahrs_lab.recording.read import Recording
from ahrs_lab.recording.samples import ACCEL, GYRO
from ahrs_lab.recording.segment import RecordingHeader

Array = NDArray[np.float64]

GRAVITY_NOTE = "gravity_mps2"
"""Key of ``[site]`` for the measured gravity of the place."""
NOMINAL_RATE_SCALE = {"deg/s": 1.0, "rad/s": radians(1.0)}
"""E1 of a perfect unit, by its rate_unit."""


@dataclass(frozen=True)
class RecordedCalibration:
    """The set, and what it was made of."""

    calibration: ImuCalibration
    positions: tuple[PositionData, ...]
    rotations: tuple[RotationData, ...]

    def to_json(self) -> dict[str, Any]:
        """The calibration set (``imu-calibrate --json``)."""
        return to_json(self.calibration)

    def report(self) -> Report:
        """Coefficients with both uncertainties, residuals of the positions, the formula."""
        return calibration_report(self.calibration, self.positions, self.rotations)


def calibrate_recording(
    recording: Recording,
    *,
    gravity_mps2: float | None = None,
    capability: BenchCapability | None = None,
    software: str = "",
) -> RecordedCalibration:
    """Reduce the recording.

    ``gravity_mps2``: measured at the site; None: what the recording's ``[site]`` says, else the normal
    formula. ``capability``: the bench's figures; None: those that the recording names, else clause 6's.
    Raises InputError where turns or positions are missing or do not separate the coefficients.
    """
    header = recording.header
    usable = records(recording)
    turning = [
        r for r in usable if r.segment.turns and (r.segment.role == "turns" or r.segment.item == "rotation")
    ]
    resting = [r for r in usable if r.segment.role == "position" and at_rest(r.segment)]
    _refuse_unfit(turning, resting)
    reference, measured = _reference(header, gravity_mps2)
    starts, mountings = starts_and_mountings(usable)
    gyro = Channels.of(resting, turning, GYRO)
    accel = Channels.of(resting, (), ACCEL)
    warnings = [finding.placed for finding in recording.findings]
    rotations = []
    for record in turning:
        found, doubt = rotation_data(
            record, gyro, starts[record.segment.file], mountings[record.segment.file]
        )
        warnings += doubt
        rotations += found
    positions = tuple(
        position_data(r, gyro, accel, starts[r.segment.file], mountings[r.segment.file]) for r in resting
    )
    try:
        found_set = calibrate(
            positions,
            rotations,
            reference,
            gyro_noise=gyro.noise,
            accel_noise=accel.noise,
            rate_unit=header.device.rate_unit,
            accel_unit=header.device.accel_unit,
        )
    except InputError as error:
        if not warnings:
            raise
        # what was left out is mostly why
        raise InputError(
            "{what} The recording's first finding: {why}", what=error.message, why=warnings[0]
        ) from error
    _refuse_unlikely_scale(found_set)
    stated = capability or noted_capability(header.notes)
    bench, figures = bench_uncertainty(
        positions,
        rotations,
        reference,
        stated or BenchCapability(),
        MEASURED_GRAVITY_MPS2 if measured else ANOMALY_MPS2,
    )
    assert found_set.quality is not None
    found_set = replace(
        found_set,
        quality=replace(found_set.quality, bench=bench, bench_figures=figures),
        warnings=(*warnings, *found_set.warnings),
        provenance={
            **_provenance(recording, reference, measured, resting, software),
            "bench_figures": "stated" if stated is not None else "clause 6",
        },
    )
    return RecordedCalibration(found_set, positions, tuple(rotations))


def site_gravity_mps2(header: RecordingHeader) -> tuple[float, bool]:
    """Of the recording's site, and whether it was measured there."""
    noted = header.notes.get("site", {}).get(GRAVITY_NOTE)
    if noted is None:
        return float(normal_gravity_mps2(header.site.latitude_deg, header.site.altitude_m)), False
    if isinstance(noted, bool) or not isinstance(noted, (int, float)) or not 9.7 <= noted <= 9.9:
        raise InputError(
            "[site] gravity_mps2 is {value}: gravity on the Earth's surface lies between 9.7 and 9.9 m/s². "
            "Correct recording.toml, or leave the key out for the normal formula.",
            value=noted,
        )
    return float(noted), True


def _reference(header: RecordingHeader, gravity_mps2: float | None) -> tuple[ReferenceVectors, bool]:
    gravity, measured = site_gravity_mps2(header)
    if gravity_mps2 is not None:
        if not 9.7 <= gravity_mps2 <= 9.9:
            raise InputError(
                "The gravity {value} m/s² is not that of a place on the Earth: 9.7 to 9.9 m/s².",
                value=gravity_mps2,
            )
        gravity, measured = gravity_mps2, True
    return ReferenceVectors(gravity, earth_rate_enu_dps(header.site.latitude_deg)), measured


def _refuse_unfit(turning: Sequence[InertialRecord], resting: Sequence[InertialRecord]) -> None:
    for record in resting:
        force = record.needed_force()
        empty = [name for name, column in zip(ACCEL, force.T, strict=True) if not np.isfinite(column).any()]
        if empty:
            raise InputError(
                "{file} has no number in the column {missing}: record the position again, or take it out of "
                "recording.toml.",
                file=record.segment.file,
                missing=", ".join(empty),
            )
        doubts = unit_doubts(record)
        if doubts:
            raise InputError("{file}: {what}", file=record.segment.file, what=doubts[0])
    if not resting:
        raise InputError(
            "The recording has no usable position at rest (item static, role position): drifts and the "
            "accelerometers need six or more, for example those of scheme 6 or 12."
        )
    if not turning:
        raise InputError(
            "The recording has no usable turns (item rotation, role turns): the gyros' scale factors need "
            "whole turns in both senses about x, y and z."
        )


def _refuse_unlikely_scale(found: ImuCalibration) -> None:
    """Where the unit is a physical one, E1 is known within a factor of two."""
    nominal = NOMINAL_RATE_SCALE.get(found.rate_unit)
    if nominal is None:
        return
    for axis, scale in zip(AXES, found.gyro.E1, strict=True):
        if scale < 0.0:
            raise InputError(
                "Gyro {axis} shows turns about {axis} with the opposite sign (E1 = {scale}): “turns” are the "
                "table's, positive anticlockwise seen from above, also where {axis} points down. Correct "
                "turns in recording.toml, or the sign of the column.",
                axis=axis,
                scale=f"{scale:.6g}",
            )
        if not 0.5 <= scale / nominal <= 2.0:
            raise InputError(
                "Gyro {axis} shows {scale} {unit} for 1 °/s: rate_unit or turns in recording.toml cannot be "
                "true.",
                axis=axis,
                scale=f"{scale:.6g}",
                unit=found.rate_unit,
            )


def scheme_of(letters: Sequence[str]) -> str:
    """Name of the scheme that these positions are, "own" for others."""
    return next((name for name, known in SCHEMES.items() if sorted(known) == sorted(letters)), "own")


def _provenance(
    recording: Recording,
    reference: ReferenceVectors,
    measured: bool,
    resting: Sequence[InertialRecord],
    software: str,
) -> dict[str, str | float]:
    device, site = recording.header.device, recording.header.site
    return {
        "software": software,
        "bundle_sha256": recording.sha256,
        "device": device.name,
        "manufacturer": device.manufacturer,
        "model": device.model,
        "serial_number": device.serial_number,
        "latitude_deg": site.latitude_deg,
        "altitude_m": site.altitude_m,
        "gravity_mps2": reference.gravity_mps2,
        "gravity": "measured" if measured else "normal",
        "scheme": scheme_of([r.segment.orientation.letters for r in resting]),
        "recorded_utc": next((r.segment.started_utc for r in resting if r.segment.started_utc), ""),
    }
