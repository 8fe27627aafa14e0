"""The state model (2-90): its frequencies, Schuler's values, and the strapdown with one error at a time."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from ahrs_lab.inertial.error_dynamics import (
    DLAT,
    DLON,
    DV_E,
    DV_N,
    INPUTS,
    PHI_E,
    PHI_N,
    PHI_U,
    STATES,
    RestingPlace,
    SchulerChannel,
    eigenfrequencies_radps,
    input_matrix,
    propagate,
    state_matrix,
)
from ahrs_lab.inertial.quaternion import from_matrix, to_matrix
from ahrs_lab.inertial.strapdown import HeightReference, Navigation, NavigationState, navigate
from ahrs_lab.simulation.manoeuvres import Steady
from ahrs_lab.simulation.trajectory import Flight, Start, fly

Array = NDArray[np.float64]
ARCSEC = np.radians(1 / 3600)
DEG_PER_H = np.radians(1.0) / 3600
OF_THE_TEXT = {"gravity_mps2": 9.78, "meridian_m": 6378137.0, "transverse_m": 6378137.0}


@pytest.mark.parametrize(
    ("latitude_deg", "slow", "fast"),
    [(45.0, 1.1878004499e-3, 1.2909265292e-3), (60.0, 1.1767481182e-3, 1.3030512549e-3)],
)
def test_eigenfrequencies_are_the_published_ones(latitude_deg: float, slow: float, fast: float) -> None:
    place = RestingPlace(np.radians(latitude_deg), **OF_THE_TEXT)
    found = eigenfrequencies_radps(place)
    assert found == pytest.approx((7.292115e-5, slow, fast), rel=1e-9)
    # the periods of the text: 24 h, 84.4 min, and of the beat
    assert 2 * np.pi / found[0] / 3600 == pytest.approx(24.0, rel=3e-3)
    assert 2 * np.pi / place.schuler_radps / 60 == pytest.approx(84.4, rel=3e-3)
    beat = 0.5 * (found[2] - found[1])
    assert beat == pytest.approx(place.foucault_radps, rel=2e-3)
    if latitude_deg == 45.0:
        assert 2 * np.pi / place.foucault_radps / 3600 == pytest.approx(34.0, rel=5e-3)


def test_schuler_values_of_one_channel() -> None:
    channel = SchulerChannel()
    assert channel.of_gyro_drift(0.01 * DEG_PER_H, 3600.0) == pytest.approx(1353.403, abs=5e-4)
    assert channel.of_accel_bias(100e-6 * 9.8, 3600.0) == pytest.approx(793.1705, abs=5e-5)
    assert channel.of_tilt(10 * ARCSEC, 3600.0) == pytest.approx(384.5399, abs=5e-5)


def test_without_the_earths_turn_a_channel_is_schulers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ahrs_lab.inertial.error_dynamics.EARTH_RATE_RADPS", 0.0)
    place = RestingPlace(0.5, 9.8, 6.371e6, 6.371e6)
    drift = 0.01 * DEG_PER_H
    path = propagate(place, np.zeros(7), np.array([0, 0, drift, 0, 0.0]), 60.0, 60)
    assert path[DLAT, -1] * 6.371e6 == pytest.approx(-1353.403, abs=1e-3)


def test_many_steps_are_one_exponential() -> None:
    place = RestingPlace.on_earth(39.9042)
    x = np.arange(1.0, 8.0) * 1e-6
    path = propagate(place, x, np.zeros(5), 10.0, 2000)
    assert path[:, -1] == pytest.approx(expm(state_matrix(place) * 20000.0) @ x, rel=1e-8, abs=1e-16)


@pytest.fixture(scope="module")
def rest() -> Flight:
    """Six hours at rest, turned, in steps of ten seconds."""
    start = Start(latitude_deg=39.9042, altitude_m=0.0, heading_deg=40.0, pitch_deg=5.0, roll_deg=-8.0)
    return fly(start, (Steady(6 * 3600.0),), 0.1)


INITIAL = {
    DV_E: 0.05,
    DV_N: 0.05,
    DLAT: 10 * ARCSEC,
    PHI_E: 10 * ARCSEC,
    PHI_N: 10 * ARCSEC,
    PHI_U: 60 * ARCSEC,
}
SENSORS = {"accel_e": 1e-4, "accel_n": 1e-4, **{f"gyro_{a}": 0.01 * DEG_PER_H for a in "enu"}}


def run(rest: Flight, initial: Array, sensors: Array) -> Navigation:
    """The strapdown with these errors, its height held tightly, as (2-90) assumes it: the loop of (2-61)
    lets it swing by centimetres, and within hours that is seen in the horizontal."""
    C, t = rest.C_bn[0], np.diff(rest.t_s)
    x, y, z = initial[PHI_E : PHI_U + 1]
    tilted = (np.eye(3) - np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])) @ C
    gyro, accel = C.T @ sensors[2:], C.T @ np.append(sensors[:2], 0.0)
    latitude = float(rest.latitude_rad[0] + initial[DLAT])
    return navigate(
        NavigationState(
            from_matrix(tilted), np.append(initial[:2], 0.0), latitude, float(rest.longitude_rad[0]), 0.0
        ),
        rest.angle_rad.T + gyro[:, np.newaxis] * t,
        rest.velocity_mps.T + accel[:, np.newaxis] * t,
        t,
        height=HeightReference(rest.altitude_m, 0.6, 0.1),
    )


@pytest.fixture(scope="module")
def right(rest: Flight) -> Navigation:
    """Without errors."""
    return run(rest, np.zeros(7), np.zeros(5))


def errors(wrong: Navigation, right: Navigation) -> Array:
    """Shape (7, n + 1): the state of the model, of two paths."""
    skew = np.eye(3) - to_matrix(wrong.attitude) @ np.swapaxes(to_matrix(right.attitude), 1, 2)
    phi = 0.5 * np.stack(
        [skew[:, 2, 1] - skew[:, 1, 2], skew[:, 0, 2] - skew[:, 2, 0], skew[:, 1, 0] - skew[:, 0, 1]]
    )
    return np.concatenate(
        (
            (wrong.velocity_enu_mps - right.velocity_enu_mps)[:2],
            [wrong.latitude_rad - right.latitude_rad],
            phi,
            [wrong.longitude_rad - right.longitude_rad],
        )
    )


SOURCES = [*(STATES[i] for i in INITIAL), *SENSORS]


@pytest.mark.parametrize("source", SOURCES)
def test_the_strapdown_with_one_error_follows_the_model(rest: Flight, right: Navigation, source: str) -> None:
    initial, sensors = np.zeros(7), np.zeros(5)
    if source in STATES:
        initial[STATES.index(source)] = INITIAL[STATES.index(source)]
    else:
        sensors[INPUTS.index(source)] = SENSORS[source]
    place = RestingPlace.on_earth(39.9042)
    model = propagate(place, initial, sensors, 10.0, len(rest.angle_rad))
    shown = errors(run(rest, initial, sensors), right)
    # velocities, angles of the path and of the platform: each kind against its own largest
    print(
        [
            np.max(np.abs(shown[r] - model[r])) / np.max(np.abs(model[r]))
            for r in ([DV_E, DV_N], [DLAT, DLON], [PHI_E, PHI_N, PHI_U])
        ]
    )
    for rows in ([DV_E, DV_N], [DLAT, DLON], [PHI_E, PHI_N, PHI_U]):
        largest = np.max(np.abs(model[rows]))
        assert np.max(np.abs(shown[rows] - model[rows])) < 2e-3 * largest


def test_sensors_enter_with_their_signs() -> None:
    G = input_matrix()
    assert G[PHI_E] @ [0, 0, 1, 0, 0] == -1.0
    assert G[DV_N] @ [0, 1, 0, 0, 0] == 1.0


@pytest.mark.parametrize("latitude_deg", [90.0, -90.0, 95.0, np.nan])
def test_a_pole_has_no_east(latitude_deg: float) -> None:
    with pytest.raises(ValueError, match="pole"):
        RestingPlace.on_earth(latitude_deg)
