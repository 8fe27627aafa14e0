"""Strapdown navigation: returns the trajectory, agrees with stepping, shows what free inertial shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.quaternion import from_matrix
from ahrs_lab.inertial.strapdown import (
    HeightReference,
    Navigation,
    NavigationError,
    NavigationState,
    attitude_in_inertial_space,
    navigate,
)
from ahrs_lab.simulation.manoeuvres import Accelerate, Climb, Coning, Manoeuvre, Rocking, Steady, STurns, Turn
from ahrs_lab.simulation.trajectory import Flight, Start, fly
from tests.inertial.stepwise import navigate_stepwise

Array = NDArray[np.float64]

FLIGHT: tuple[Manoeuvre, ...] = (
    Steady(5.0),
    Accelerate(10.0, 80.0),
    Turn(20.0, 120.0),
    STurns(20.0, 15.0, 2),
    Climb(20.0, 6.0),
    Rocking(20.0, (2.0, 3.0, 5.0), (0.5, 0.7, 0.9)),
    Coning(5.0, 0.5, 2.0),
    Accelerate(10.0, -80.0),
)
START = Start(heading_deg=30.0, pitch_deg=1.0, roll_deg=2.0)
RADIUS_M = 6.4e6


def start_of(flight: Flight) -> NavigationState:
    return NavigationState(
        from_matrix(flight.C_bn[0]),
        flight.velocity_enu_mps[0],
        float(flight.latitude_rad[0]),
        float(flight.longitude_rad[0]),
        float(flight.altitude_m[0]),
    )


def flown(flight: Flight, **options: Any) -> Navigation:
    return navigate(
        start_of(flight), flight.angle_rad.T, flight.velocity_mps.T, np.diff(flight.t_s), **options
    )


def worst(flight: Flight, path: Navigation) -> tuple[float, float, float]:
    """Largest differences: attitude rad, velocity m/s, place m."""
    turned = np.max(np.abs(path.matrices() - flight.C_bn))
    away = np.remainder(path.longitude_rad - flight.longitude_rad + np.pi, 2 * np.pi) - np.pi
    east = away * np.cos(flight.latitude_rad) * RADIUS_M
    north, up = (path.latitude_rad - flight.latitude_rad) * RADIUS_M, path.altitude_m - flight.altitude_m
    place = np.max(np.abs([east, north, up]))
    return (
        float(turned),
        float(np.max(np.abs(path.velocity_enu_mps.T - flight.velocity_enu_mps))),
        float(place),
    )


def test_exact_increments_return_the_trajectory() -> None:
    fine, coarse = fly(START, FLIGHT, 400.0), fly(START, FLIGHT, 100.0)
    attitude, velocity, place = worst(fine, flown(fine))
    assert attitude < 3e-9
    assert velocity < 1e-6
    assert place < 1e-4
    # what is left falls with the interval
    assert worst(coarse, flown(coarse))[0] > 8 * attitude


@pytest.mark.parametrize("latitude_deg", [-89.0, -35.0, 0.0, 60.0, 89.0])
def test_anywhere_on_the_earth(latitude_deg: float) -> None:
    start = Start(latitude_deg=latitude_deg, longitude_deg=-179.99, altitude_m=9000.0, heading_deg=260.0)
    flight = fly(start, FLIGHT[1:3], 100.0)
    attitude, velocity, place = worst(flight, flown(flight))
    assert attitude < 1e-7
    assert velocity < 1e-5
    assert place < 3e-3


@settings(max_examples=10, deadline=None)
@given(st.floats(0.0, 360.0), st.floats(-90.0, 90.0), st.floats(-180.0, 180.0))
def test_however_the_unit_is_mounted_its_path_is_the_carriers(
    heading: float, pitch: float, roll: float
) -> None:
    flight = fly(START, FLIGHT[1:3], 50.0)
    turned = flight.mounted(attitude_matrix(heading, pitch, roll))
    carrier, unit = flown(flight), flown(turned)
    assert unit.latitude_rad == pytest.approx(carrier.latitude_rad, abs=1e-14)
    assert unit.velocity_enu_mps == pytest.approx(carrier.velocity_enu_mps, abs=1e-9)
    assert unit.matrices() == pytest.approx(
        carrier.matrices() @ attitude_matrix(heading, pitch, roll), abs=1e-12
    )


def test_coning_and_sculling_need_their_corrections() -> None:
    flight = fly(START, (Accelerate(5.0, 20.0), Coning(20.0, 1.0, 5.0)), 200.0)
    none, two, three = (worst(flight, flown(flight, samples=k))[0] for k in (1, 2, 3))
    assert none > 50 * two > 500 * three


def test_blocks_give_what_stepping_gives() -> None:
    flight = fly(START, FLIGHT, 10.0)
    interval = np.diff(flight.t_s)
    place = np.array([flight.latitude_rad[0], flight.longitude_rad[0], flight.altitude_m[0]])
    for reference in (None, flight.altitude_m + 3.0 * np.sin(0.2 * flight.t_s)):
        C, v, places = navigate_stepwise(
            flight.C_bn[0],
            flight.velocity_enu_mps[0],
            place,
            flight.angle_rad,
            flight.velocity_mps,
            interval,
            reference,
        )
        height = None if reference is None else HeightReference(reference)
        path = flown(flight, height=height)
        assert path.matrices() == pytest.approx(C, abs=1e-9)
        assert path.velocity_enu_mps == pytest.approx(v.T, abs=1e-8)
        assert path.latitude_rad == pytest.approx(places[:, 0], abs=1e-13)
        assert path.longitude_rad == pytest.approx(places[:, 1], abs=1e-13)
        assert path.altitude_m == pytest.approx(places[:, 2], abs=1e-6)


def test_however_many_intervals_are_taken_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    flight = fly(START, FLIGHT, 100.0)
    whole = flown(flight)
    monkeypatch.setattr("ahrs_lab.inertial.strapdown._BLOCK", 700)
    monkeypatch.setattr("ahrs_lab.inertial.block_of_steps._PIECE", 90)
    pieces = flown(flight)
    assert pieces.attitude == pytest.approx(whole.attitude, abs=1e-12)
    assert pieces.velocity_enu_mps == pytest.approx(whole.velocity_enu_mps, abs=1e-9)
    assert pieces.latitude_rad == pytest.approx(whole.latitude_rad, abs=1e-14)
    assert pieces.altitude_m == pytest.approx(whole.altitude_m, abs=1e-7)


def test_attitude_alone_is_the_attitude_of_navigation() -> None:
    flight = fly(START, (Steady(20.0),), 10.0)
    q = attitude_in_inertial_space(np.array([1.0, 0.0, 0.0, 0.0]), flight.angle_rad.T, np.diff(flight.t_s))
    # at rest it turns with the Earth
    assert 2 * np.arccos(q[0, -1]) == pytest.approx(7.292115e-5 * 20.0, rel=1e-6)


def test_longitude_stays_within_half_a_turn() -> None:
    flight = fly(Start(longitude_deg=179.9999, speed_mps=200.0, heading_deg=90.0), (Steady(60.0),), 10.0)
    path = flown(flight)
    assert np.max(np.abs(path.longitude_rad)) <= np.pi
    assert np.degrees(path.longitude_rad[-1]) < -179.8


def test_height_runs_away_without_the_loop_and_not_with_it() -> None:
    """The error of an undamped height grows as cosh(t·√(2g/R)) (2-60); the loop holds it (2-63)."""
    flight = fly(Start(altitude_m=0.0), (Steady(3600.0),), 1.0)
    start = start_of(flight)
    wrong = NavigationState(
        start.attitude, start.velocity_enu_mps, start.latitude_rad, start.longitude_rad, 10.0
    )
    rows = (flight.angle_rad.T, flight.velocity_mps.T, np.diff(flight.t_s))
    free = navigate(wrong, *rows)
    growth = np.cosh(1800.0 * np.sqrt(2 * 9.8 / 6.371e6))
    assert free.altitude_m[1800] == pytest.approx(10.0 * growth, rel=0.02)
    held = navigate(wrong, *rows, height=HeightReference(flight.altitude_m))
    assert abs(held.altitude_m[-1]) < 1e-3
    # as the second order system of (2-63) does
    k1, k2 = 0.06666, 0.00111 - 2 * 9.8 / 6.371e6
    damping, swing = k1 / 2, np.sqrt(k2 - k1**2 / 4 + 0j)
    t = flight.t_s[:200]
    # h'' + k1 h' + k2 h = 0 with h = 10, h' = −k1·10 at the start
    expected = (10 * np.exp(-damping * t) * (np.cos(swing * t) - damping / swing * np.sin(swing * t))).real
    assert held.altitude_m[:200] == pytest.approx(expected, abs=0.01)


def test_a_pole_is_refused() -> None:
    flight = fly(START, (Steady(1.0),), 10.0)
    start = start_of(flight)
    polar = NavigationState(start.attitude, start.velocity_enu_mps, np.pi / 2, 0.0, 0.0)
    with pytest.raises(NavigationError, match=r"89\.9"):
        navigate(polar, flight.angle_rad.T, flight.velocity_mps.T, np.full(10, 0.1))


def test_numbers_that_run_away_are_said() -> None:
    flight = fly(START, (Steady(1.0),), 10.0)
    with pytest.raises(NavigationError, match="run away"):
        navigate(start_of(flight), flight.angle_rad.T, flight.velocity_mps.T * 1e12, np.full(10, 0.1))


def test_no_interval_leaves_the_start() -> None:
    flight = fly(START, (Steady(1.0),), 10.0)
    path = navigate(start_of(flight), np.empty((3, 0)), np.empty((3, 0)), np.empty(0))
    assert path.latitude_rad == pytest.approx(flight.latitude_rad[:1])
    assert path.angles_deg()[0] == pytest.approx([30.0])
