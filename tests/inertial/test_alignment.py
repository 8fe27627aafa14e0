"""Self-alignment against other ways to the same answer: two-vector attitude, polar and QR decomposition,
finite differences, the Schuler period."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import polar
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.alignment import (
    ORTHOGONALISATIONS,
    Orthogonalisation,
    Place,
    SensorNoise,
    UnitModel,
    analytic_matrix,
    angle_matrix,
    attitude_limit_rad,
    by_columns,
    by_rows,
    by_svd,
    coarse_alignment,
    limit_matrix,
    small_rotation,
)
from ahrs_lab.inertial.alignment_fine import fine_alignment
from ahrs_lab.inertial.alignment_kalman import dynamics, kalman_alignment
from ahrs_lab.inertial.alignment_steps import steps_of
from ahrs_lab.inertial.attitude import attitude_angles_deg, attitude_matrix, rotation_from_vector
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS, STANDARD_GRAVITY_MPS2

Array = NDArray[np.float64]

PLACE = Place(float(np.radians(40.0)), 9.80166)
DEGREE_PER_HOUR = float(np.radians(1.0)) / 3600.0
PERFECT = UnitModel(0.01 * DEGREE_PER_HOUR, 5e-4)
headings = st.floats(0.0, 359.999)
tilts = st.floats(-80.0, 80.0)
latitudes = st.floats(-85.0, 85.0)


def shown(C_bn: Array, place: Place = PLACE) -> tuple[Array, Array]:
    """Rate and specific force of a unit without errors."""
    return place.earth_rate @ C_bn, np.array([0.0, 0.0, place.gravity_mps2]) @ C_bn


def wrong(C_bn: Array, gyro_enu: Array, accel_enu: Array) -> tuple[Array, Array]:
    """The same with biases given in east, north, up."""
    rate, force = shown(C_bn)
    return rate + gyro_enu @ C_bn, force + accel_enu @ C_bn


@given(heading=headings, pitch=tilts, roll=st.floats(-180.0, 180.0), latitude=latitudes)
def test_without_errors_every_orthogonalisation_gives_the_attitude(
    heading: float, pitch: float, roll: float, latitude: float
) -> None:
    place = Place(float(np.radians(latitude)), 9.8)
    C = attitude_matrix(heading, pitch, roll)
    for make_orthogonal in ORTHOGONALISATIONS.values():
        found = make_orthogonal(analytic_matrix(*shown(C, place), place))
        assert found == pytest.approx(C, abs=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_orthogonalisations_agree_with_other_software(seed: int) -> None:
    """Rows: the attitude of two vectors with gravity exact; columns: QR; nearest: polar decomposition."""
    rng = np.random.default_rng(seed)
    C = attitude_matrix(*rng.uniform(-60.0, 60.0, 3))
    rate, force = shown(C)
    rate = rate + rng.normal(0.0, 3e-6, 3)
    force = force + rng.normal(0.0, 0.05, 3)
    matrix = analytic_matrix(rate, force, PLACE)
    up_and_earth = np.array([[0.0, 0.0, 1.0], PLACE.earth_rate])
    triad, _ = Rotation.align_vectors(up_and_earth, np.array([force, rate]), weights=[np.inf, 1.0])
    assert by_rows(matrix) == pytest.approx(triad.as_matrix(), abs=1e-9)
    q, r = np.linalg.qr(matrix)
    assert by_columns(matrix) == pytest.approx(q * np.sign(np.diag(r)), abs=1e-12)
    nearest, _ = polar(matrix)
    assert by_svd(matrix) == pytest.approx(nearest, abs=1e-12)


def test_mixing_orthogonalisations_bring_the_gyros_into_level() -> None:
    """0.03 °/h makes 0.06° of pitch where accelerometers of 50 µg allow 0.003°."""
    drift = np.array([0.0, 0.0, 0.03 * DEGREE_PER_HOUR])
    level = np.array([0.0, 50e-6 * STANDARD_GRAVITY_MPS2, 0.0])
    place = Place(0.5, 9.8)
    rate, force = place.earth_rate + drift, np.array([0.0, 0.0, 9.8]) + level
    pitch = {
        name: float(attitude_angles_deg(make(analytic_matrix(rate, force, place)))[1])
        for name, make in ORTHOGONALISATIONS.items()
    }
    assert pitch["rows"] == pytest.approx(0.003, rel=0.05)
    assert abs(pitch["svd"]) == pytest.approx(0.06, rel=0.1)
    # the column order takes all of it where x points up
    standing = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    tilted = by_columns(analytic_matrix(rate @ standing, force @ standing, place))
    assert np.degrees(np.arccos(tilted[2, 0])) == pytest.approx(0.13, rel=0.1)


@pytest.mark.parametrize("latitude_deg", [0.0, 40.0, -65.0])
def test_biases_leave_what_formula_2_104_says(latitude_deg: float) -> None:
    place = Place(float(np.radians(latitude_deg)), 9.8)
    for heading in (0.0, 130.0):
        C = attitude_matrix(heading, 5.0, -8.0)
        for index in range(6):
            bias = np.zeros(6)
            bias[index] = 1e-10 if index < 3 else 1e-5
            rate, force = shown(C, place)
            found = by_rows(analytic_matrix(rate + bias[:3] @ C, force + bias[3:] @ C, place))
            expected = limit_matrix(place)[:, index] * bias[index]
            assert small_rotation(C, found) == pytest.approx(expected, abs=2e-10)


def test_signs_are_those_of_a_hand_calculation() -> None:
    """An accelerometer that shows too much to the right says: right side up. The gyros, level by then, see
    north to the right of where it is."""
    rate, force = wrong(np.eye(3), np.zeros(3), np.array([1e-3, 0.0, 0.0]))
    heading, pitch, roll = attitude_angles_deg(by_rows(analytic_matrix(rate, force, PLACE)))
    tilt = np.degrees(1e-3 / PLACE.gravity_mps2)
    assert float(roll) == pytest.approx(-tilt, rel=1e-3)
    assert float(pitch) == pytest.approx(0.0, abs=1e-6)
    assert float(heading) == pytest.approx(tilt * np.tan(PLACE.latitude_rad), rel=1e-3)
    rate, force = wrong(np.eye(3), np.array([0.01 * DEGREE_PER_HOUR, 0.0, 0.0]), np.zeros(3))
    heading, _, _ = attitude_angles_deg(by_rows(analytic_matrix(rate, force, PLACE)))
    # 0.01 °/h at 45° is a milliradian
    assert np.radians(360.0 - float(heading)) == pytest.approx(
        1e-3 * 0.7071 / np.cos(np.radians(40)), rel=0.06
    )


@given(heading=headings, pitch=tilts, roll=st.floats(-170.0, 170.0))
def test_errors_of_the_angles_follow_the_small_rotation(heading: float, pitch: float, roll: float) -> None:
    C = attitude_matrix(heading, pitch, roll)
    for axis in range(3):
        phi = np.zeros(3)
        phi[axis] = 1e-6
        before, after = (np.array(attitude_angles_deg(m)) for m in (C, rotation_from_vector(phi) @ C))
        change = np.radians((after - before + 180.0) % 360.0 - 180.0)
        assert change == pytest.approx(angle_matrix(C) @ phi, abs=1e-9)


@pytest.mark.parametrize("orthogonalisation", ["rows", "columns", "svd"])
def test_the_stated_covariance_is_the_scatter(orthogonalisation: Orthogonalisation) -> None:
    rng = np.random.default_rng(7)
    unit = UnitModel(
        0.002 * DEGREE_PER_HOUR,
        3e-5,
        SensorNoise(white=[1e-7, 2e-7, 4e-7]),
        SensorNoise(white=[1e-4, 2e-4, 4e-4]),
    )
    C = np.broadcast_to(attitude_matrix(70.0, 10.0, -20.0), (4000, 3, 3))
    rate, force = shown(C[0])
    gyro, accel = (
        np.sqrt(bias**2 + noise.mean_variance(100.0))
        for bias, noise in (
            (unit.gyro_bias_radps, unit.gyro_noise),
            (unit.accel_bias_mps2, unit.accel_noise),
        )
    )
    found = coarse_alignment(
        rate + gyro * rng.standard_normal((4000, 3)),
        force + accel * rng.standard_normal((4000, 3)),
        100.0,
        PLACE,
        unit,
        orthogonalisation,
    )
    scatter = np.cov(small_rotation(C, found.C_bn).T)
    stated = found.covariance.mean(axis=0)
    scale = np.sqrt(np.diag(stated))
    assert scatter / np.outer(scale, scale) == pytest.approx(stated / np.outer(scale, scale), abs=0.08)


def test_steps_compose_rotations_and_turn_the_force() -> None:
    """Against products of single rotations; the force is constant in space, so its integral is too."""
    rng = np.random.default_rng(3)
    n = 47
    rate, interval = rng.normal(0.0, 0.05, (n, 3)), rng.uniform(0.009, 0.011, n)
    force, turn = np.zeros((n, 3)), Rotation.identity()
    for row in range(n):
        half = turn * Rotation.from_rotvec(0.5 * rate[row] * interval[row])
        force[row] = half.inv().apply([1.0, -2.0, 9.8])
        turn = turn * Rotation.from_rotvec(rate[row] * interval[row])
    steps = steps_of(rate, force, interval, 10)
    assert len(steps) == 5
    assert steps.duration_s.sum() == pytest.approx(interval.sum())
    product = np.linalg.multi_dot(list(steps.turn))
    assert product == pytest.approx(turn.as_matrix(), abs=1e-14)
    total, C = np.zeros(3), np.eye(3)
    for index in range(len(steps)):
        total, C = total + C @ steps.velocity[index], C @ steps.turn[index]
    assert total == pytest.approx(np.array([1.0, -2.0, 9.8]) * interval.sum(), rel=1e-6)


def test_the_filters_dynamics_turn_with_the_earth_and_swing_with_schuler() -> None:
    roots = np.linalg.eigvals(dynamics(PLACE))
    frequencies = np.sort(np.abs(roots.imag))
    schuler = frequencies[frequencies > 5e-4]
    assert 2.0 * np.pi / schuler.mean() / 60.0 == pytest.approx(84.4, rel=0.01)
    open_loop = np.linalg.eigvals(dynamics(PLACE)[:3, :3])
    assert np.abs(open_loop.imag).max() == pytest.approx(EARTH_RATE_RADPS)


def test_fine_and_filters_find_a_known_attitude_exactly() -> None:
    """No noise, no bias: from half a degree off the true attitude where a first one is given."""
    C = attitude_matrix(213.0, 4.0, -7.0)
    rate, force = shown(C)
    steps = steps_of(np.tile(rate, (120, 1)), np.tile(force, (120, 1)), np.ones(120), 1)
    off = rotation_from_vector(np.radians([0.05, -0.05, 0.5])) @ C
    assert fine_alignment(steps, off, PLACE, PERFECT).C_bn == pytest.approx(C, abs=1e-10)
    quiet = UnitModel(PERFECT.gyro_bias_radps, 5e-4, SensorNoise(1e-8), SensorNoise(1e-5))
    for closed in (False, True):
        run = kalman_alignment(steps, C, 60.0, PLACE, quiet, closed=closed)
        assert run.C_bn == pytest.approx(C, abs=1e-6)
        assert run.bias[:3] == pytest.approx(np.zeros(3), abs=1e-10)


def test_the_filters_keep_the_assumption_where_nothing_can_be_seen() -> None:
    C = attitude_matrix(20.0, 0.0, 0.0)
    unit = UnitModel(PERFECT.gyro_bias_radps, 5e-4, SensorNoise(1e-8), SensorNoise(1e-5))
    rate, force = wrong(C, np.array([5e-8, 4e-8, 0.0]), np.array([3e-4, -4e-4, 0.0]))
    steps = steps_of(np.tile(rate, (600, 1)), np.tile(force, (600, 1)), np.ones(600), 1)
    start = by_rows(analytic_matrix(rate, force, PLACE))
    for closed in (False, True):
        run = kalman_alignment(steps, start, 60.0, PLACE, unit, closed=closed)
        deviation = np.sqrt(np.diag(run.covariance))
        assert np.sqrt(np.diag(run.covariance)[:3]) == pytest.approx(
            attitude_limit_rad(PLACE, unit), rel=0.02
        )
        assert run.bias[0] == pytest.approx(0.0, abs=1e-9)
        assert run.bias[3:] == pytest.approx(np.zeros(2), abs=5e-5)
        assert deviation[[3, 6, 7]] == pytest.approx([unit.gyro_bias_radps, 5e-4, 5e-4], rel=0.02)
        # north shows: the drift of level, less the Earth's rate in the tilt that ∇ makes
        assert deviation[4] < 0.1 * unit.gyro_bias_radps
        tilt = -4e-4 / PLACE.gravity_mps2 * PLACE.up_radps
        assert run.bias[1] == pytest.approx(4e-8 - tilt, abs=3e-10)


def test_a_line_needs_points() -> None:
    steps = steps_of(np.zeros((4, 3)), np.zeros((4, 3)), np.ones(4), 1)
    with pytest.raises(ValueError, match="needs 5 steps"):
        fine_alignment(steps, np.eye(3), PLACE, PERFECT)
