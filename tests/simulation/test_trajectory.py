"""The virtual carrier: its increments against its own truth, differentiated in the Earth's frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import records
from ahrs_lab.inertial.attitude import attitude_angles_deg, attitude_matrix
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS, normal_gravity_mps2
from ahrs_lab.inertial.sensor_model import AccelModel, GyroModel
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.simulation.manoeuvres import (
    Accelerate,
    Climb,
    Coning,
    Manoeuvre,
    Rocking,
    Steady,
    STurns,
    Turn,
)
from ahrs_lab.simulation.settings import SensorSettings
from ahrs_lab.simulation.trajectory import Flight, Start, fly
from ahrs_lab.simulation.trajectory_recording import write_flight

Array = NDArray[np.float64]

EVERYTHING: tuple[Manoeuvre, ...] = (
    Steady(2.0),
    Accelerate(5.0, 80.0),
    Turn(8.0, 60.0),
    STurns(8.0, 15.0, 2),
    Climb(7.0031, 6.0),
    Rocking(6.0, (2.0, 3.0, 5.0), (0.5, 0.7, 0.9)),
    Coning(4.0, 1.0, 5.0),
    Accelerate(5.0, -80.0),
)
START = Start(heading_deg=30.0, pitch_deg=1.0, roll_deg=2.0)


@pytest.fixture(scope="module")
def flight() -> Flight:
    """All manoeuvres at 1000 Hz."""
    return fly(START, EVERYTHING, 1000.0)


def earth_from_enu(flight: Flight) -> Array:
    """C_ne of (2-52), transposed."""
    sl, cl = np.sin(flight.latitude_rad), np.cos(flight.latitude_rad)
    so, co = np.sin(flight.longitude_rad), np.cos(flight.longitude_rad)
    return np.stack(
        [
            np.stack([-so, -sl * co, cl * co], -1),
            np.stack([co, -sl * so, cl * so], -1),
            np.stack([0 * sl, cl, sl], -1),
        ],
        -2,
    )


def test_position_moves_with_the_velocity(flight: Flight) -> None:
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    sl, cl = np.sin(flight.latitude_rad), np.cos(flight.latitude_rad)
    radius = a / np.sqrt(1 - e2 * sl**2)
    place = np.stack(
        [
            (radius + flight.altitude_m) * cl * np.cos(flight.longitude_rad),
            (radius + flight.altitude_m) * cl * np.sin(flight.longitude_rad),
            (radius * (1 - e2) + flight.altitude_m) * sl,
        ],
        -1,
    )
    velocity = np.einsum("nij,nj->ni", earth_from_enu(flight), flight.velocity_enu_mps)
    h = 0.001
    simpson = (velocity[:-2] + 4 * velocity[1:-1] + velocity[2:]) * h / 3
    assert np.diff(place[::2], axis=0) == pytest.approx(simpson[::2], abs=1e-8)


def test_increments_of_velocity_are_those_of_the_motion_in_the_earths_frame(flight: Flight) -> None:
    C_ne, h = earth_from_enu(flight), 0.001
    v = np.einsum("nij,nj->ni", C_ne, flight.velocity_enu_mps)
    acceleration = (v[:-4] - 8 * v[1:-3] + 8 * v[3:-1] - v[4:]) / (12 * h)
    spin = np.array([0.0, 0.0, EARTH_RATE_RADPS])
    gravity = normal_gravity_mps2(np.degrees(flight.latitude_rad), flight.altitude_m)[2:-2, np.newaxis]
    force_e = acceleration + 2 * np.cross(spin, v[2:-2]) + C_ne[2:-2, :, 2] * gravity
    force_b = np.einsum("nji,nj->ni", C_ne[2:-2] @ flight.C_bn[2:-2], force_e)
    simpson = (force_b[:-2] + 4 * force_b[1:-1] + force_b[2:]) * h / 3
    over_two = flight.velocity_mps[2:-3] + flight.velocity_mps[3:-2]
    assert np.max(np.abs(over_two - simpson)) < 2e-11


def test_increments_of_angle_are_those_of_the_attitude_in_inertial_space(flight: Flight) -> None:
    angle = EARTH_RATE_RADPS * flight.t_s
    turn = np.zeros((len(angle), 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0] = np.sin(angle)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    C_bi = turn @ earth_from_enu(flight) @ flight.C_bn
    between = np.swapaxes(C_bi[1:-1], 1, 2) @ C_bi[2:]
    skewed = 0.5 * np.stack(
        [
            between[:, 2, 1] - between[:, 1, 2],
            between[:, 0, 2] - between[:, 2, 0],
            between[:, 1, 0] - between[:, 0, 1],
        ],
        -1,
    )
    sine = np.linalg.norm(skewed, axis=1)[:, np.newaxis]
    vector = skewed * np.where(sine > 1e-9, np.arcsin(sine) / np.maximum(sine, 1e-30), 1.0)
    d = flight.angle_rad
    assert np.max(np.abs(vector - d[1:] - np.cross(d[:-1], d[1:]) / 12)) < 2e-10


def test_a_coarser_rate_sums_the_same_increments(flight: Flight) -> None:
    coarse = fly(START, EVERYTHING, 50.0)
    n = len(coarse.angle_rad)
    assert flight.angle_rad[: 20 * n].reshape(n, 20, 3).sum(1) == pytest.approx(coarse.angle_rad, abs=1e-13)
    assert flight.velocity_mps[: 20 * n].reshape(n, 20, 3).sum(1) == pytest.approx(
        coarse.velocity_mps, abs=1e-11
    )
    assert flight.latitude_rad[: 20 * n + 1 : 20] == pytest.approx(coarse.latitude_rad, abs=1e-15)


def test_at_rest_the_unit_feels_earth_rate_and_gravity() -> None:
    rest = fly(Start(latitude_deg=39.9042, altitude_m=0.0), (Steady(1.0),), 10.0)
    hourly = np.degrees(rest.angle_rad[0]) * 10.0 * 3600.0
    assert hourly == pytest.approx([0.0, 11.5382751, 9.6489326], abs=1e-6)
    assert rest.velocity_mps[:, :2] == pytest.approx(0.0, abs=1e-15)


def test_a_banked_turn_feels_nothing_sideways() -> None:
    turn = fly(Start(speed_mps=100.0), (Turn(40.0, 90.0), Steady(1.0)), 10.0)
    heading, _, roll = attitude_angles_deg(turn.C_bn)
    assert heading[-1] == pytest.approx(90.0)
    rate = np.radians(90.0) / 30.0
    assert roll[200] == pytest.approx(np.degrees(np.arctan(100.0 * rate / 9.80665)))
    # what is left is the Coriolis force of the Earth and normal gravity's difference from standard
    assert abs(turn.velocity_mps[200, 0] * 10.0) < 0.02
    flat = fly(Start(speed_mps=100.0), (Turn(40.0, 90.0), Steady(1.0)), 10.0, banked=False)
    assert flat.velocity_mps[200, 0] * 10.0 == pytest.approx(100.0 * rate, abs=0.02)


def test_a_recording_gives_the_increments_and_the_truth_back(tmp_path: Path) -> None:
    flight = fly(START, (Steady(1.0), Accelerate(2.0, 10.0)), 100.0)
    bias = SensorSettings(gyro=GyroModel(bias_dps=(1.0, 2.0, 3.0)), accel=AccelModel(bias_mps2=(0, 0, 0.5)))
    case = attitude_matrix(1.0, 2.0, 3.0)
    ideal = read_bundle(write_flight(tmp_path / "ideal", flight, reference=True))
    (record,) = records(ideal)
    assert not record.warnings
    assert record.angle_increments_rad == pytest.approx(flight.angle_rad, rel=1e-15, abs=1e-16)
    assert record.velocity_increments_mps() == pytest.approx(flight.velocity_mps, rel=1e-15, abs=1e-15)
    assert record.samples["vn_mps"][-1] == pytest.approx(10.0 * np.cos(np.radians(30.0)))
    assert ideal.header.initial is not None
    assert ideal.header.initial["heading_deg"] == pytest.approx(30.0)
    turned = flight.mounted(case)
    (unit,) = records(read_bundle(write_flight(tmp_path / "unit", turned, bias, initial=False)))
    assert unit.rate - np.radians([1.0, 2.0, 3.0]) == pytest.approx(record.rate @ case, abs=1e-15)
    assert unit.needed_force()[:, 2] - 0.5 == pytest.approx((record.needed_force() @ case)[:, 2])
    assert "ve_mps" not in unit.samples


def test_no_time_for_a_sample_is_said() -> None:
    with pytest.raises(ValueError, match="no sample"):
        fly(START, (Steady(0.01),), 50.0)
