"""Installation angles against the patent's printed matrices and tables, and against scipy's rotations."""

from __future__ import annotations

from math import atan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.installation import (
    Calibrated,
    Direction,
    InstallationAngles,
    LevelCarrier,
    calibrate,
    compensate,
    compensation_covariance_deg2,
)

Array = NDArray[np.float64]

E1_RAD, E2_RAD = 1.7e-6, 5e-6
headings = st.floats(0.0, 360.0, exclude_max=True)
pitches = st.floats(-90.0, 90.0)
rolls = st.floats(-180.0, 180.0)
brackets = st.builds(InstallationAngles, st.floats(-180.0, 180.0), st.floats(-89.0, 89.0), rolls)


def printed_D(heading: float, pitch: float, roll: float) -> Array:
    """D₁₁ … D₃₃ in the patent's words."""
    sy, cy, sp, cp, sr, cr = (f(np.radians(a)) for a in (heading, pitch, roll) for f in (np.sin, np.cos))
    return np.array(
        [
            [cy * cr + sy * sp * sr, -sy * cr + cy * sp * sr, -cp * sr],
            [sy * cp, cy * cp, sp],
            [cy * sr - sy * sp * cr, -sy * sr - cy * sp * cr, cp * cr],
        ]
    )


def table_roll(matrix: Array) -> float:
    """The patent's table 1: the principal value and its quadrant, with the guard E₁ on C'₃₃."""
    c31, c33 = float(matrix[2, 0]), float(matrix[2, 2])
    if abs(c33) < E1_RAD:
        return pi / 2 if c31 < 0 else -pi / 2
    principal = atan(-c31 / c33)
    if c33 > 0:
        return principal
    return principal + pi if c31 < 0 else principal - pi


def table_heading(matrix: Array) -> float:
    """The patent's table 2: the principal value and its quadrant, with the guard E₂ on C'₂₂."""
    c12, c22 = float(matrix[0, 1]), float(matrix[1, 1])
    if abs(c22) < E2_RAD:
        return pi / 2 if c12 > 0 else 3 * pi / 2
    principal = atan(c12 / c22)
    if c22 < 0:
        return principal + pi
    return principal if c12 >= 0 else principal + 2 * pi


def test_D_is_the_printed_one() -> None:
    bracket = InstallationAngles(12.0, -3.0, 7.0)
    np.testing.assert_allclose(bracket.compensation_matrix, printed_D(12.0, -3.0, 7.0), atol=1e-15)
    other = InstallationAngles(12.0, -3.0, 7.0, "aircraft-in-box")
    np.testing.assert_allclose(other.compensation_matrix, printed_D(12.0, -3.0, 7.0).T, atol=1e-15)


def test_a_carrier_whose_box_stands_askew_gets_its_own_attitude_back_by_scipy() -> None:
    carrier = Rotation.from_euler("ZXY", [-75.0, 4.0, -20.0], degrees=True)
    box_in_aircraft = Rotation.from_euler("ZXY", [-2.0, 1.0, -1.5], degrees=True)
    yaw, pitch, roll = (carrier * box_in_aircraft).as_euler("ZXY", degrees=True)
    found = compensate(-yaw, pitch, roll, InstallationAngles(2.0, 1.0, -1.5))
    assert [found.heading_deg, found.pitch_deg, found.roll_deg] == pytest.approx(
        [75.0, 4.0, -20.0], abs=1e-12
    )
    assert not found.gimbal_lock


@given(headings, pitches, rolls, brackets)
def test_there_and_back_is_the_same_attitude_all_over_the_sphere(
    heading: float, pitch: float, roll: float, bracket: InstallationAngles
) -> None:
    carrier = attitude_matrix(heading, pitch, roll)
    there = compensate(
        heading, pitch, roll, InstallationAngles(*_angles(bracket), direction="aircraft-in-box")
    )
    back = compensate(there.heading_deg, there.pitch_deg, there.roll_deg, bracket)
    again = attitude_matrix(back.heading_deg, back.pitch_deg, back.roll_deg)
    assert np.linalg.norm(again - carrier) / np.sqrt(2) < 1e-12
    # the angles themselves are as sharp as the cosine of pitch allows
    tolerance = np.degrees(1e-12) * (1 + 1 / max(np.cos(np.radians(pitch)), 1e-13))
    if tolerance < 1:
        assert abs((back.heading_deg - heading + 180) % 360 - 180) < tolerance
        assert abs((back.roll_deg - roll + 180) % 360 - 180) < tolerance
    assert abs(back.pitch_deg - pitch) < np.degrees(1e-12)


@given(brackets)
def test_the_other_direction_of_definition_is_the_same_bracket(bracket: InstallationAngles) -> None:
    other = bracket.the_other_way()
    assert other.direction == "aircraft-in-box"
    np.testing.assert_allclose(other.compensation_matrix, bracket.compensation_matrix, atol=1e-14)
    np.testing.assert_allclose(
        other.the_other_way().compensation_matrix, bracket.compensation_matrix, atol=1e-14
    )


@pytest.mark.parametrize("offset", [1e-3, 1e-5, 2e-6, 1.8e-6, 1.6e-6, 1e-9, 0.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("quarter", [-90.0, 90.0])
def test_atan2_gives_the_values_of_table_1_on_both_sides_of_its_guard(
    quarter: float, side: float, offset: float
) -> None:
    roll = quarter + side * np.degrees(offset)
    found = compensate(40.0, 0.0, roll, InstallationAngles(0.0, 0.0, 0.0))
    table = table_roll(attitude_matrix(40.0, 0.0, roll))
    # inside the guard the table rounds to the quarter turn; outside both are the same
    assert abs(np.radians(found.roll_deg) - table) <= (1e-12 if offset > E1_RAD else offset + 1e-12)
    assert abs(np.radians(found.roll_deg - roll)) < 1e-12


@pytest.mark.parametrize("offset", [1e-3, 1e-5, 5.1e-6, 4.9e-6, 1e-9, 0.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("quarter", [90.0, 270.0])
def test_atan2_gives_the_values_of_table_2_on_both_sides_of_its_guard(
    quarter: float, side: float, offset: float
) -> None:
    heading = quarter + side * np.degrees(offset)
    found = compensate(heading, 0.0, 10.0, InstallationAngles(0.0, 0.0, 0.0))
    table = table_heading(attitude_matrix(heading, 0.0, 10.0))
    assert abs(np.radians(found.heading_deg) - table) <= (1e-12 if offset > E2_RAD else offset + 1e-12)
    assert abs(np.radians(found.heading_deg - heading)) < 1e-12


@given(headings, st.floats(-89.0, 89.0), rolls)
def test_outside_the_guards_all_quadrants_are_the_tables(heading: float, pitch: float, roll: float) -> None:
    matrix = attitude_matrix(heading, pitch, roll)
    found = compensate(heading, pitch, roll, InstallationAngles(0.0, 0.0, 0.0))
    turn = 2 * pi
    if abs(matrix[2, 2]) > E1_RAD:
        away = (np.radians(found.roll_deg) - table_roll(matrix) + pi) % turn - pi
        assert abs(away) < 1e-12
    if abs(matrix[1, 1]) > E2_RAD:
        away = (np.radians(found.heading_deg) - table_heading(matrix) + pi) % turn - pi
        assert abs(away) < 1e-12


@pytest.mark.parametrize("direction", ["box-in-aircraft", "aircraft-in-box"])
def test_small_angles_and_full_D_agree_to_second_order(direction: Direction) -> None:
    rest = []
    for size in (1.0, 0.1, 0.01):
        bracket = InstallationAngles(0.9 * size, -1.1 * size, 0.7 * size, direction)
        rest.append(np.linalg.norm(bracket.compensation_matrix - bracket.small_angle_matrix))
    assert rest[0] < 2 * np.radians(1.6) ** 2
    assert rest[0] / rest[1] == pytest.approx(100, rel=0.05)
    assert rest[1] / rest[2] == pytest.approx(100, rel=0.01)


def test_gimbal_lock_is_named_and_the_attitude_still_right() -> None:
    found = compensate([10.0, 10.0], [88.5, 88.4], [0.0, 0.0], InstallationAngles(0.0, -1.5, 0.0))
    assert found.gimbal_lock.tolist() == [True, False]
    np.testing.assert_allclose(
        attitude_matrix(found.heading_deg, found.pitch_deg, found.roll_deg)[0],
        attitude_matrix(10.0, 88.5, 0.0) @ printed_D(0.0, -1.5, 0.0),
        atol=1e-12,
    )


def test_on_a_level_carrier_the_bracket_reads_itself() -> None:
    found = calibrate(LevelCarrier(0.31, -0.22, -0.45, u_attitude_deg=0.01, u_level_deg=0.02))
    angles = found.angles
    assert (angles.heading_deg, angles.pitch_deg, angles.roll_deg) == pytest.approx((-0.45, 0.31, -0.22))
    u = found.standard_uncertainty_deg
    assert np.isnan(u[0])  # nobody has stated the survey's
    assert u[1:] == pytest.approx([np.hypot(0.01, 0.02)] * 2, rel=1e-3)


def test_what_levelling_left_is_taken_out_exactly() -> None:
    bracket = InstallationAngles(1.2, -0.8, 0.5)
    box = attitude_matrix(0.0, 0.4, -0.3) @ bracket.compensation_matrix.T
    level = Rotation.from_matrix(box).as_euler("ZXY", degrees=True)
    found = calibrate(LevelCarrier(level[1], level[2], -level[0], 0.4, -0.3)).angles
    assert _angles(found) == pytest.approx(_angles(bracket), abs=1e-12)


def test_uncertainty_is_what_a_monte_carlo_gives() -> None:
    rng = np.random.default_rng(8)
    reading = LevelCarrier(
        3.0, -4.0, 6.0, 0.5, 0.2, u_attitude_deg=0.02, u_level_deg=0.03, u_heading_error_deg=0.05
    )
    trials = [
        _angles(
            calibrate(
                LevelCarrier(
                    3.0 + 0.02 * e[0],
                    -4.0 + 0.02 * e[1],
                    6.0 + 0.05 * e[2],
                    0.5 + 0.03 * e[3],
                    0.2 + 0.03 * e[4],
                )
            ).angles
        )
        for e in rng.normal(size=(1500, 5))
    ]
    calibrated = calibrate(reading)
    assert calibrated.standard_uncertainty_deg == pytest.approx(np.std(trials, axis=0), rel=0.06)
    spread = [
        [float(a) for a in (c.heading_deg, c.pitch_deg, c.roll_deg)]
        for c in (compensate(80.0, 30.0, 50.0, InstallationAngles(*angles)) for angles in trials)
    ]
    covariance = compensation_covariance_deg2(80.0, 30.0, 50.0, calibrated)
    assert np.sqrt(np.diag(covariance)) == pytest.approx(np.std(spread, axis=0), rel=0.06)


def test_an_unknown_uncertainty_makes_what_rests_on_it_unknown() -> None:
    calibrated = Calibrated(InstallationAngles(0.0, 0.0, 0.0), np.full((3, 3), np.nan))
    assert np.all(np.isnan(compensation_covariance_deg2(0.0, 0.0, 0.0, calibrated)))


def _angles(bracket: InstallationAngles) -> tuple[float, float, float]:
    return bracket.heading_deg, bracket.pitch_deg, bracket.roll_deg
