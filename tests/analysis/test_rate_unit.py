"""A wrong unit of the rates is told where something else tells the rate, never for a gyro's own errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord, unit_doubts
from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.earth import earth_rate_enu_dps
from ahrs_lab.recording.orientation import Orientation, all_orientations
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RateUnit, RecordingHeader, Segment, Site
from ahrs_lab.simulation.presets import GRADES, sensor_preset

Array = NDArray[np.float64]
LATITUDE_DEG = 39.9042
HZ = 20.0
STATIC = Segment("a", Orientation("ENU"), "static", "x", "position", file="a.csv")
OTHER: dict[RateUnit, RateUnit] = {"deg/s": "rad/s", "rad/s": "deg/s"}


def _record(
    rate_dps: Array,
    written: RateUnit,
    header: RateUnit,
    segment: Segment = STATIC,
    force: Array | None = None,
    table_dps: Array | None = None,
) -> InertialRecord:
    """Rates of °/s, ``written`` in one unit under a ``header`` that names the same or another."""
    count = len(rate_dps)
    numbers = rate_dps if written == "deg/s" else np.radians(rate_dps)
    interval = np.full(count, 1.0 / HZ)
    columns = {"table_rate_dps": table_dps} if table_dps is not None else {}
    return InertialRecord(
        RecordingHeader("static", Site(LATITUDE_DEG), DeviceDescription(rate_unit=header)),
        segment,
        np.cumsum(interval),
        interval,
        np.radians(numbers) if header == "deg/s" else numbers,
        force,
        np.empty(0, dtype=np.int64),
        Samples(columns),
    )


def _told(record: InertialRecord) -> str:
    return " ".join(str(doubt) for doubt in unit_doubts(record))


def _gyros(grade: str, rate_dps: Array, rng: np.random.Generator) -> Array:
    """Shown by a unit of the grade with a bias of its own; ``rate_dps`` (n, 3)."""
    settings = sensor_preset(grade)
    wakes = settings.gyro_stability.turn_on * rng.standard_normal(3)
    shown = settings.gyro.indicated_dps(rate_dps.T, np.zeros((3, len(rate_dps)))).T
    white = settings.gyro_noise.angle_random_walk_deg_per_sqrt_h / 60.0 * np.sqrt(HZ)
    bias = rng.normal(0.0, 3.0) * np.array(settings.gyro.bias_dps) + wakes
    return np.asarray(shown + bias + rng.normal(0.0, white, rate_dps.shape))


@pytest.mark.parametrize("unit", ["deg/s", "rad/s"])
@pytest.mark.parametrize("grade", GRADES)
def test_no_bias_and_no_rate_of_any_grade_raises_a_false_alarm(grade: str, unit: RateUnit) -> None:
    rng = np.random.default_rng(1)
    for orientation in all_orientations()[::3]:
        segment = replace(STATIC, orientation=orientation)
        earth = orientation.matrix.T @ earth_rate_enu_dps(LATITUDE_DEG)
        still = _gyros(grade, np.tile(earth, (2000, 1)), rng)
        assert not _told(_record(still, unit, unit, segment, np.tile(9.8 * orientation.matrix[2], (2000, 1))))
        assert not _told(_record(still, unit, unit, segment))
        for rate_dps in (0.5, -7.0, 100.0):
            turning = _gyros(grade, np.tile(earth + np.array([0.0, 0.0, rate_dps]), (400, 1)), rng)
            assert not _told(_record(turning, unit, unit, replace(segment, rate_dps=rate_dps)))


def test_large_biases_of_any_size_raise_no_false_alarm_at_rest() -> None:
    """From a thousandth of a °/h to the worst of phones, evenly on the logarithmic scale."""
    rng = np.random.default_rng(2)
    earth = earth_rate_enu_dps(LATITUDE_DEG)
    alarms = 0
    for _ in range(4000):
        bias = rng.standard_normal(3) * 10.0 ** rng.uniform(-6.5, 1.0)
        alarms += bool(_told(_record(np.tile(earth + bias, (2, 1)), "deg/s", "deg/s")))
        alarms += bool(_told(_record(np.tile(earth + bias, (2, 1)), "rad/s", "rad/s")))
    assert alarms <= 2


@pytest.mark.parametrize("written", ["deg/s", "rad/s"])
@pytest.mark.parametrize("grade", ["navigation-rlg", "strategic", "fog"])
def test_the_earths_rate_tells_the_unit_of_good_gyros(grade: str, written: RateUnit) -> None:
    rng = np.random.default_rng(3)
    earth = np.tile(Orientation("UEN").matrix.T @ earth_rate_enu_dps(LATITUDE_DEG), (20_000, 1))
    segment = replace(STATIC, orientation=Orientation("UEN"))
    told = _told(_record(_gyros(grade, earth, rng), written, OTHER[written], segment))
    assert "the Earth's rate" in told
    assert f"these look like {written}" in told


@pytest.mark.parametrize("written", ["deg/s", "rad/s"])
@pytest.mark.parametrize("grade", GRADES)
def test_the_tables_rate_tells_the_unit_of_any_gyro(grade: str, written: RateUnit) -> None:
    rng = np.random.default_rng(4)
    rate = _gyros(grade, np.tile([0.0, -30.0, 0.0], (400, 1)), rng)
    asked = replace(STATIC, item="rotation", axis="y", rate_dps=-30.0)
    assert f"look like {written}" in _told(_record(rate, written, OTHER[written], asked))
    reported = _record(rate, written, OTHER[written], table_dps=np.full(400, -30.0))
    assert "the rate that the table reports" in _told(reported)
    turns = replace(STATIC, item="rotation", role="turns", turns=-2)
    angle = _gyros(grade, np.tile([0.0, -36.0, 0.0], (400, 1)), rng)  # 20 s
    assert "the turns of the table" in _told(_record(angle, written, OTHER[written], turns))
    assert not _told(_record(angle, written, written, turns))


def _tumbling(seconds: float, seed: int) -> tuple[Array, Array]:
    """Rates (°/s) and specific forces of a case that pitches and rolls, by its attitude."""
    t = np.arange(0.0, seconds, 1.0 / HZ / 10.0)
    pitch, roll, heading = 40.0 * np.sin(0.4 * t), 60.0 * np.sin(0.7 * t), 5.0 * t
    attitude = np.array([attitude_matrix(*angles) for angles in zip(heading, pitch, roll, strict=True)])
    to_body = attitude.transpose(0, 2, 1)
    step = np.einsum("nji,njk->nik", attitude[:-1], attitude[1:])  # body turns by step
    fine = np.stack(
        [step[:, 2, 1] - step[:, 1, 2], step[:, 0, 2] - step[:, 2, 0], step[:, 1, 0] - step[:, 0, 1]]
    )
    rate = np.degrees(0.5 * fine.T) * HZ * 10.0
    force = to_body[:-1] @ np.array([0.0, 0.0, 9.8])
    force = force + np.random.default_rng(seed).normal(0.0, 0.3, force.shape)
    count = len(rate) // 10 * 10
    return rate[:count].reshape(-1, 10, 3).mean(axis=1), force[:count].reshape(-1, 10, 3).mean(axis=1)


@pytest.mark.parametrize("written", ["deg/s", "rad/s"])
def test_gravity_tells_the_unit_of_a_case_that_is_moved_about(written: RateUnit) -> None:
    rate, force = _tumbling(40.0, 5)
    moving = replace(STATIC, item="dynamic")
    assert not _told(_record(rate, written, written, moving, force))
    told = _told(_record(rate, written, OTHER[written], moving, force))
    assert "how gravity turns in the accelerometers" in told
    assert f"look like {written}" in told


def test_what_tells_nothing_raises_no_alarm() -> None:
    """Shaking without turning, turning about the vertical, three samples."""
    rng = np.random.default_rng(6)
    moving = replace(STATIC, item="dynamic")
    shaken = rng.normal(0.0, 5.0, (400, 3)) + np.array([0.0, 0.0, 9.8])
    assert not _told(_record(rng.normal(0.0, 1.0, (400, 3)), "deg/s", "rad/s", moving, shaken))
    level = np.tile([0.0, 0.0, 9.8], (400, 1)) + rng.normal(0.0, 0.01, (400, 3))
    assert not _told(_record(np.tile([0.0, 0.0, 20.0], (400, 1)), "deg/s", "rad/s", moving, level))
    assert not _told(_record(np.ones((3, 3)), "deg/s", "rad/s", moving, level[:3]))
