"""Records of a unit at rest with known attitude and errors, made from the Earth's rate and gravity alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord, inertial_record
from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.earth import earth_rate_enu_dps, normal_gravity_mps2
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.read import RecordedSegment
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter

Array = NDArray[np.float64]
Disturbance = Callable[[Array, Array, Array], None]

ATTITUDE = (30.0, 1.0, 2.0)
RATE_HZ = 20.0
ANGLE_RANDOM_WALK = 0.002
VELOCITY_RANDOM_WALK = 1e-4
SEGMENT = Segment("rest", Orientation("ENU"), "static", "z", "position", file="segments/rest.csv")


def samples(
    duration_s: float = 120.0,
    latitude_deg: float = 40.0,
    attitude: tuple[float, float, float] = ATTITUDE,
    gyro_bias_deg_per_h: Sequence[float] | Array = (0.0, 0.0, 0.0),
    accel_bias_mps2: Sequence[float] | Array = (0.0, 0.0, 0.0),
    seed: int = 1,
    disturbance: Disturbance | None = None,
    rate_hz: float = RATE_HZ,
    noise: float = 1.0,
) -> Samples:
    """°/s and m/s². ``disturbance(t_s, rate, force)`` changes both in place; ``noise`` is a factor."""
    rng = np.random.default_rng(seed)
    count = round(duration_s * rate_hz)
    t_s = np.arange(1, count + 1) / rate_hz
    C = attitude_matrix(*attitude)
    rate = earth_rate_enu_dps(latitude_deg) @ C + np.array(gyro_bias_deg_per_h) / 3600.0
    force = np.array([0.0, 0.0, float(normal_gravity_mps2(latitude_deg))]) @ C + np.array(accel_bias_mps2)
    drawn = noise * np.sqrt(rate_hz) * rng.standard_normal((2, count, 3))
    gyro = rate + ANGLE_RANDOM_WALK / 60.0 * drawn[0]
    accel = force + VELOCITY_RANDOM_WALK * drawn[1]
    if disturbance is not None:
        disturbance(t_s, gyro, accel)
    columns = {"t_s": t_s}
    for index, axis in enumerate(AXES):
        columns[f"gyro_{axis}"], columns[f"accel_{axis}"] = gyro[:, index], accel[:, index]
    return Samples(columns)


def header(latitude_deg: float = 40.0, rate_hz: float = RATE_HZ) -> RecordingHeader:
    device = DeviceDescription(rate_unit="deg/s", accel_unit="m/s^2", sample_rate_hz=rate_hz)
    return RecordingHeader("static", Site(latitude_deg), device)


def record_of(rows: Samples, latitude_deg: float = 40.0, rate_hz: float = RATE_HZ) -> InertialRecord:
    recorded = RecordedSegment(SEGMENT, rows, (), np.arange(len(rows)) + 2, 0, 1.0 / rate_hz)
    return inertial_record(header(latitude_deg, rate_hz), recorded)


def record(latitude_deg: float = 40.0, **how: object) -> InertialRecord:
    return record_of(samples(latitude_deg=latitude_deg, **how), latitude_deg)  # type: ignore[arg-type]


def bundle(folder: Path, rows: Samples, latitude_deg: float = 40.0) -> Path:
    with BundleWriter(folder, header(latitude_deg)) as writer:
        writer.begin(SEGMENT)
        writer.append(rows)
        writer.finish()
    return folder
