"""Transfer alignment against a virtual carrier's truth: models by differences, filters by statistics."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from ahrs_lab.inertial.attitude import attitude_angles_deg, attitude_matrix, rotation_from_vector
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS, meridian_radius_m, transverse_radius_m
from ahrs_lab.inertial.transfer_alignment import (
    Reference,
    Start,
    TransferAlignment,
    align,
)
from ahrs_lab.inertial.transfer_alignment_model import (
    ACCEL_BIAS,
    ACCEL_SCALE,
    AZIMUTH,
    GYRO_BIAS,
    GYRO_SCALE,
    LATITUDE,
    LONGITUDE,
    METHODS,
    MOUNTING,
    PHI,
    SIZE,
    VELOCITY,
    Assumptions,
    MethodName,
    comparison_matrix,
    discrete,
    error_matrix,
)
from ahrs_lab.inertial.transfer_alignment_motion import Increments, Motion, Window, advance
from ahrs_lab.simulation.manoeuvres import Accelerate, Climb, Manoeuvre, Steady, STurns, Turn
from ahrs_lab.simulation.trajectory import Flight, fly
from ahrs_lab.simulation.trajectory import Start as TakeOff
from ahrs_lab.simulation.transfer_pair import Pair, transfer_pairs

Array = NDArray[np.float64]

DEGREE = np.pi / 180
PER_HOUR = DEGREE / 3600
ASSUMED = Assumptions(
    velocity_noise=0.05,
    position_noise_m=1.0,
    attitude_noise=0.02 * DEGREE,
    angle_random_walk=0.05 * DEGREE / 60,
    velocity_random_walk=0.05 / 60,
    level=1 * DEGREE,
    azimuth=2 * DEGREE,
    velocity=0.5,
    position_m=10.0,
    gyro_bias=5 * PER_HOUR,
    accel_bias=5e-3,
    gyro_scale=3e-4,
    accel_scale=3e-4,
    gyro_cross=3e-4,
    accel_cross=3e-4,
    mounting=1 * DEGREE,
    level_limit=5 * DEGREE,
)
QUIET = replace(
    ASSUMED,
    velocity_noise=1e-3,
    position_noise_m=1e-2,
    attitude_noise=1e-6,
    angle_random_walk=1e-9,
    velocity_random_walk=1e-7,
    gyro_scale=1e-9,
    accel_scale=1e-9,
    gyro_cross=1e-9,
    accel_cross=1e-9,
)
S_TURN = (Steady(10), STurns(80, 40, 2), Accelerate(20, 20), Turn(30, 90), Steady(20))
PAIRS = 100


def flight(*manoeuvres: Manoeuvre, rate_hz: float = 10.0) -> Flight:
    return fly(TakeOff(speed_mps=60.0, heading_deg=30.0), manoeuvres, rate_hz)


@cache
def s_turn() -> Flight:
    return flight(*S_TURN)


@cache
def flown(method: MethodName, copied: bool) -> tuple[Pair, TransferAlignment]:
    # one in twenty seeds lies outside a band of 95 %; the benchmark takes more units and any seed
    pair = transfer_pairs(s_turn(), method, ASSUMED, PAIRS, 1, every=20, copied=copied)
    return pair, align(pair.unit, pair.reference, pair.start, method, ASSUMED)


def band(numbers: int, runs: int) -> tuple[float, float]:
    """Where the mean of ``runs`` χ² values of ``numbers`` degrees lies with 95 % probability."""
    ends = chi2(numbers * runs)
    return float(ends.ppf(0.025)) / runs, float(ends.ppf(0.975)) / runs


METHODS_AND_STARTS: list[tuple[MethodName, bool]] = [
    ("velocity", False),
    ("position", False),
    ("velocity-azimuth", False),
    ("velocity-attitude", True),
]


@pytest.mark.parametrize(("method", "copied"), METHODS_AND_STARTS)
def test_errors_are_as_large_as_their_covariance_says(method: MethodName, copied: bool) -> None:
    pair, found = flown(method, copied)
    estimated = len(found.method.estimated)
    left, P = pair.remaining(found)[:, :estimated], found.covariance[:, :estimated, :estimated]
    nees = np.einsum("bi,bi->b", left, np.linalg.solve(P, left[..., np.newaxis])[..., 0])
    low, high = band(estimated, PAIRS)
    assert low < np.mean(nees) < high
    # nor does one state hide behind another
    scaled = left / np.sqrt(np.diagonal(P, axis1=1, axis2=2))
    assert np.all(np.abs(np.mean(scaled**2, axis=0) - 1) < 4 * np.sqrt(2 / PAIRS))


@pytest.mark.parametrize(("method", "copied"), METHODS_AND_STARTS)
def test_innovations_are_as_large_as_expected_and_white(method: MethodName, copied: bool) -> None:
    _, found = flown(method, copied)
    low, high = band(int(np.sum(found.compared)), PAIRS)
    assert low < np.mean(np.sum(found.nis, axis=1)) < high
    scaled = found.innovation[:, :, 0] / found.innovation_u[:, :, 0]
    lagged = np.mean(scaled[:, 1:] * scaled[:, :-1])
    assert abs(lagged) < 4 / np.sqrt(scaled.size)


@pytest.mark.parametrize(("method", "copied"), METHODS_AND_STARTS)
def test_how_wrong_the_start_was_is_known_as_well(method: MethodName, copied: bool) -> None:
    pair, found = flown(method, copied)
    scaled = (found.misalignment_at_start - pair.errors[:, PHI]) / found.misalignment_at_start_u
    assert np.all(np.abs(np.mean(scaled**2, axis=0) - 1) < 4 * np.sqrt(2 / PAIRS))
    # what drifts in a flight of 160 s is more than what is left to be known of it
    drifted = np.std(found.misalignment[:, -1] - pair.errors[:, PHI], axis=0)
    assert np.all(drifted[:2] > 0.5 * np.mean(found.misalignment_at_start_u[:, :2], axis=0))


def test_states_are_as_many_as_the_text_has() -> None:
    assert {name: len(method.estimated) for name, method in METHODS.items()} == {
        "velocity": 5,
        "position": 10,
        "velocity-azimuth": 19,
        "velocity-attitude": 16,
    }


@pytest.mark.parametrize("rate_hz", [10.0, 100.0])
def test_exact_increments_lead_where_the_carrier_is(rate_hz: float) -> None:
    truth = flight(Steady(2), Turn(20, 90), Climb(20, 5), rate_hz=rate_hz)
    motion = at(truth, 0)
    steps = int(rate_hz)
    compensated = Increments(
        truth.t_s[1:], np.diff(truth.t_s), truth.angle_rad[np.newaxis], truth.velocity_mps[np.newaxis]
    ).compensated()
    for begin in range(0, len(compensated.t_s), steps):
        rows = slice(begin, begin + steps)
        motion = advance(
            motion,
            compensated.angle_rad[:, rows],
            compensated.velocity_mps[:, rows],
            compensated.interval_s[rows],
        ).motion
    away = Rotation.from_matrix(motion.C_bn[0] @ truth.C_bn[-1].T).magnitude()
    assert away < 1e-6 * (10 / rate_hz) ** 2 + 1e-8
    assert np.max(np.abs(motion.velocity[0] - truth.velocity_enu_mps[-1])) < 3e-4
    assert abs(motion.latitude[0] - truth.latitude_rad[-1]) * 6.4e6 < 5e-3
    assert abs(motion.altitude[0] - truth.altitude_m[-1]) < 5e-3


def at(truth: Flight, row: int) -> Motion:
    return Motion(
        truth.C_bn[row : row + 1],
        truth.velocity_enu_mps[row : row + 1],
        truth.latitude_rad[row : row + 1],
        truth.longitude_rad[row : row + 1],
        truth.altitude_m[row : row + 1],
    )


def after(truth: Flight, begin: int, stop: int, x: Array) -> tuple[Array, Window]:
    """The error states (8,) that grow in one window from the errors ``x`` (24,), by navigating with them."""
    start = at(truth, begin)
    wrong = Motion(
        rotation_from_vector(-x[PHI]) @ start.C_bn,
        start.velocity + x[VELOCITY],
        start.latitude + x[LATITUDE],
        start.longitude + x[LONGITUDE],
        start.altitude,
    )
    interval = np.diff(truth.t_s)[begin:stop]
    step = interval[:, np.newaxis]
    angle = truth.angle_rad[begin:stop] * (1 + x[GYRO_SCALE]) + x[GYRO_BIAS] * step
    velocity = truth.velocity_mps[begin:stop] * (1 + x[ACCEL_SCALE]) + x[ACCEL_BIAS] * step
    increments = Increments(
        truth.t_s[begin + 1 : stop + 1], interval, angle[None], velocity[None]
    ).compensated()
    window = advance(wrong, increments.angle_rad, increments.velocity_mps, interval)
    end = window.motion
    errors = np.concatenate(
        [
            -Rotation.from_matrix(end.C_bn[0] @ truth.C_bn[stop].T).as_rotvec(),
            end.velocity[0] - truth.velocity_enu_mps[stop],
            end.latitude - truth.latitude_rad[stop],
            end.longitude - truth.longitude_rad[stop],
        ]
    )
    return errors, window


@pytest.mark.parametrize("begin", [0, 300, 1200])
def test_the_error_model_is_what_navigating_with_errors_shows(begin: int) -> None:
    """Each column of Φ against the difference of two navigations in a turn, at speed."""
    truth = fly(
        TakeOff(latitude_deg=60.0, speed_mps=200.0, heading_deg=50.0),
        (Steady(2), Turn(30, 120), STurns(30, 20)),
        100.0,
    )
    stop = begin + 100
    right, window = after(truth, begin, stop, np.zeros(SIZE))
    F = error_matrix(window, truth.latitude_rad[begin : begin + 1], truth.altitude_m[begin : begin + 1])
    Phi, _ = discrete(F, np.zeros(SIZE), window.duration_s)
    sizes = np.array([1e-4] * 3 + [0.1] * 3 + [1e-5] * 2 + [1e-5] * 3 + [1e-2] * 3 + [1e-4] * 6)
    # what is left is how force and attitude change within the window, of which the model has the means
    for state, size in enumerate(sizes):
        x = np.zeros(SIZE)
        x[state] = size
        # what a gyro's error, and a scale error of a force that changes, do to velocity within the window
        fallen = 9.8 * size * window.duration_s**2 if state in (8, 9, 10, 14, 15, 16) else 0.0
        fallen += 0.5 * size if state >= 17 else 0.0
        grown = after(truth, begin, stop, x)[0] - after(truth, begin, stop, -x)[0]
        expected = 2 * Phi[0, :8, state] * size
        for rows, part, rest in (
            (PHI, 2e-3, 1e-11),
            (VELOCITY, 4e-3, 0.06 * fallen + 1e-8),
            (slice(6, 8), 1e-2, 5e-11),
        ):
            largest = float(np.max(np.abs(expected[rows])))
            assert np.max(np.abs((grown - expected)[rows])) < part * largest + rest, (state, rows)
    assert np.max(np.abs(right)) < 1e-4


def test_the_five_states_of_2_147_at_an_instant() -> None:
    """The printed matrix; what it leaves out (the frame's rate by δv, Coriolis) are other columns."""
    latitude, altitude, v, f = 0.7, 1000.0, np.array([100.0, 50.0, 0.0]), np.array([1.0, -2.0, 9.8])
    nothing, none = np.zeros((1, 3, 3)), np.zeros((1, 3, 3, 3))
    motion = Motion(np.eye(3)[None], v[None], *(np.array([one]) for one in (latitude, 0.0, altitude)))
    window = Window(motion, 1.0, nothing, none, none, f[None], np.zeros((1, 3)), v[None])
    F = error_matrix(window, motion.latitude, motion.altitude)[0]
    along_east = float(transverse_radius_m(np.degrees(latitude))) + altitude
    along_north = float(meridian_radius_m(np.degrees(latitude))) + altitude
    up = EARTH_RATE_RADPS * np.sin(latitude) + v[0] / along_east * np.tan(latitude)
    north = EARTH_RATE_RADPS * np.cos(latitude) + v[0] / along_east
    printed = np.array(
        [
            [0, up, -north, 0, 0],
            [-up, 0, -v[1] / along_north, 0, 0],
            [north, v[1] / along_north, 0, 0, 0],
            [0, -f[2], f[1], 0, 0],
            [f[2], 0, -f[0], 0, 0],
        ]
    )
    np.testing.assert_allclose(F[:5, :3], printed[:, :3], rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize("angles", [(30.0, 2.0, -4.0), (200.0, -35.0, 70.0)])
def test_what_is_compared_changes_with_the_states_as_H_says(angles: tuple[float, float, float]) -> None:
    C = attitude_matrix(*angles)[None]
    H = comparison_matrix(C)[0]
    size = 1e-6
    for axis in range(3):
        turn = size * np.eye(3)[axis]
        wrong = rotation_from_vector(-turn) @ C
        azimuth = (attitude_angles_deg(wrong)[0] - attitude_angles_deg(C)[0])[0] * DEGREE
        # the mounting about x that both attitudes show is taken off
        shown = Rotation.from_matrix((C.mT @ wrong)[0]).as_rotvec()[0]
        rolled = C @ rotation_from_vector([size, 0.0, 0.0])
        share = (attitude_angles_deg(rolled)[0] - attitude_angles_deg(C)[0])[0] * DEGREE / size
        assert azimuth - share * shown == pytest.approx(H[5, axis] * size, abs=1e-11)
        between = Rotation.from_matrix((wrong @ C.mT)[0]).as_rotvec()
        np.testing.assert_allclose(between, H[6:9, axis] * size, atol=1e-11)
        # the case is turned by λ against what is believed of it: T_b = T_a(I + λ×)
        carrier = C @ rotation_from_vector(-turn)
        between = Rotation.from_matrix((C @ carrier.mT)[0]).as_rotvec()
        np.testing.assert_allclose(between, H[6:9, MOUNTING][:, axis] * size, atol=1e-11)
    # clockwise about the case's own up axis
    turned = C @ rotation_from_vector([0.0, 0.0, -size])
    azimuth = (attitude_angles_deg(turned)[0] - attitude_angles_deg(C)[0])[0] * DEGREE
    assert azimuth == pytest.approx(H[5, AZIMUTH] * size, abs=1e-11)


@pytest.mark.parametrize("angles", [(30.0, 2.0, -4.0), (200.0, -35.0, 70.0)])
def test_the_printed_angle_rows_hold_with_their_signs_put_right(angles: tuple[float, float, float]) -> None:
    """(2-174): azimuth, pitch and roll of Ĉ = (I − φ×)C, the third row of H₁ with its sign changed."""
    T = attitude_matrix(*angles)
    level, lower = np.hypot(T[0, 1], T[1, 1]), T[2, 0] ** 2 + T[2, 2] ** 2
    H1 = np.array(
        [
            [-T[0, 1] * T[2, 1] / level**2, -T[1, 1] * T[2, 1] / level**2, 1.0],
            [-T[1, 1] / level, T[0, 1] / level, 0.0],
            [
                -(T[1, 2] * T[2, 0] - T[1, 0] * T[2, 2]) / lower,
                -(T[0, 0] * T[2, 2] - T[0, 2] * T[2, 0]) / lower,
                0.0,
            ],
        ]
    )
    size = 1e-6
    for axis in range(3):
        wrong = rotation_from_vector(-size * np.eye(3)[axis]) @ T
        changed = [float(a - b) * DEGREE for a, b in zip(attitude_angles_deg(wrong), angles, strict=True)]
        np.testing.assert_allclose(changed, H1[:, axis] * size, atol=1e-10)


def test_the_unit_left_alone_carries_its_mounting_along() -> None:
    """Started with the reference's attitude, a perfect unit is misaligned by how it is mounted; that stays
    where it is among the stars."""
    truth = s_turn()
    mounting = np.array([0.3, -0.5, 0.8]) * DEGREE
    mounted = truth.mounted(rotation_from_vector(mounting))
    rows = np.arange(10, len(truth.t_s), 10)
    reference = Reference(
        truth.t_s[rows],
        truth.velocity_enu_mps[None, rows],
        truth.latitude_rad[None, rows],
        truth.longitude_rad[None, rows],
        truth.altitude_m[None, rows],
        truth.C_bn[None, rows],
    )
    unit = Increments(truth.t_s[1:], np.diff(truth.t_s), mounted.angle_rad[None], mounted.velocity_mps[None])
    start = Start(0.0, at(truth, 0), True)
    found = align(unit, reference, start, "velocity-attitude", QUIET)
    latitude = float(truth.latitude_rad[0])
    path = np.mean(truth.velocity_enu_mps, axis=0) * truth.t_s[-1]
    east, north = float(path[0]) / 6.37e6, float(path[1]) / 6.37e6
    turned = EARTH_RATE_RADPS * truth.t_s[-1] * np.array([0.0, np.cos(latitude), np.sin(latitude)])
    turned += [-north, east, east * np.tan(latitude)]
    expected = rotation_from_vector(-turned) @ truth.C_bn[0] @ mounting
    assert found.misalignment[0, -1] == pytest.approx(expected, abs=1e-5)
    assert Rotation.from_matrix(found.mounting[0]).as_rotvec() == pytest.approx(mounting, abs=1e-5)


def test_azimuth_does_not_show_in_straight_flight_and_does_in_a_turn() -> None:
    finals = []
    for way in (flight(Steady(160)), s_turn()):
        pair = transfer_pairs(way, "velocity", ASSUMED, 1, 3, every=10, copied=False)
        found = align(pair.unit, pair.reference, pair.start, "velocity", ASSUMED)
        finals.append(found.misalignment_u[0, -1] / found.prior_u[:3])
    straight, turned = finals
    assert straight[2] > 0.5
    assert turned[2] < 0.15
    assert np.all(straight[:2] < 0.05)


def test_a_bias_that_is_considered_widens_what_is_said() -> None:
    """Without it the five states would claim more than they know of a unit with biases."""
    pair, honest = flown("velocity", False)
    blind = replace(
        ASSUMED,
        gyro_bias=0.0,
        accel_bias=0.0,
        gyro_scale=0.0,
        accel_scale=0.0,
        gyro_cross=0.0,
        accel_cross=0.0,
    )
    found = align(pair.unit, pair.reference, pair.start, "velocity", blind)
    left = pair.remaining(found)[:, :2]
    claimed = np.mean(left**2, axis=0) / found.misalignment_u[0, -1, :2] ** 2
    assert np.all(claimed > 10)
    assert np.all(honest.misalignment_u[0, -1, :2] > 3 * found.misalignment_u[0, -1, :2])


def test_degrees_of_misalignment_come_out_as_well() -> None:
    rough = replace(ASSUMED, level=4 * DEGREE, azimuth=10 * DEGREE)
    pair = transfer_pairs(s_turn(), "velocity", rough, 20, 5, every=10, copied=False)
    found = align(pair.unit, pair.reference, pair.start, "velocity", rough)
    assert np.max(np.abs(pair.remaining(found)[:, :3] / found.misalignment_u[:, -1])) < 4.5


def test_a_lever_arm_is_taken_out() -> None:
    truth = s_turn()
    lever = np.array([1.0, 5.0, -0.5])
    rows = np.arange(10, len(truth.t_s), 10)
    rate = np.gradient(truth.C_bn @ lever, truth.t_s, axis=0)[rows]
    reference = Reference(
        truth.t_s[rows],
        truth.velocity_enu_mps[None, rows] - rate,
        truth.latitude_rad[None, rows],
        truth.longitude_rad[None, rows],
        truth.altitude_m[None, rows],
    )
    unit = Increments(truth.t_s[1:], np.diff(truth.t_s), truth.angle_rad[None], truth.velocity_mps[None])
    start = Start(0.0, at(truth, 0), False)
    with_it, without = (
        align(unit, reference, start, "velocity", QUIET, arm).misalignment[0, -1] for arm in (lever, None)
    )
    assert np.max(np.abs(with_it)) < 0.2 * np.max(np.abs(without))


def test_without_a_common_instant_there_is_nothing_to_align() -> None:
    pair = transfer_pairs(s_turn(), "velocity", ASSUMED, 1, 3, every=10, copied=False)
    late = replace(pair.reference, t_s=pair.reference.t_s + 1000.0)
    with pytest.raises(ValueError, match="no instant"):
        align(pair.unit, late, pair.start, "velocity", ASSUMED)
