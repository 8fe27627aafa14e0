"""Against published values."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.earth import (
    EARTH_RATE_DPS,
    earth_rate_enu_dps,
    earth_rate_enu_radps,
    meridian_radius_m,
    normal_gravity_mps2,
    transport_rate_enu_radps,
    transverse_radius_m,
)

Array = NDArray[np.float64]


@pytest.mark.parametrize(
    ("latitude_deg", "gravity"),
    [(0, 9.7803253359), (30, 9.7932472692), (45, 9.8061977694), (60, 9.8191769531), (90, 9.8321849379)],
)
def test_gravity_at_sea_level_is_somiglianas(latitude_deg: float, gravity: float) -> None:
    assert float(normal_gravity_mps2(latitude_deg)) == pytest.approx(gravity, abs=1e-10)


def test_gravity_falls_with_height_as_the_free_air_gradient() -> None:
    """−0.3086 mGal/m, the geodesists' round figure at 45°."""
    drop = float(normal_gravity_mps2(45.0, 100.0) - normal_gravity_mps2(45.0, 0.0)) / 100.0
    assert drop == pytest.approx(-3.086e-6, abs=1e-9)


def test_radii_at_45_degrees() -> None:
    assert float(meridian_radius_m(45.0)) == pytest.approx(6367381.815620, abs=1e-6)
    assert float(transverse_radius_m(45.0)) == pytest.approx(6388838.290121, abs=1e-6)


def test_earth_rate_in_beijing() -> None:
    east, north, up = 3600.0 * earth_rate_enu_dps(39.9042)
    assert east == 0.0
    assert north == pytest.approx(11.5382751, abs=5e-8)
    assert up == pytest.approx(9.6489326, abs=5e-8)


def test_arrays_keep_their_shape() -> None:
    assert normal_gravity_mps2(np.array([0.0, 45.0]), np.array([0.0, 100.0])).shape == (2,)


def test_earth_rate_of_many_latitudes() -> None:
    latitudes = np.array([[-90.0, 0.0, 39.9042], [45.0, 60.0, 90.0]])
    rates = np.degrees(earth_rate_enu_radps(latitudes))
    assert rates.shape == (2, 3, 3)
    for latitude, rate in zip(latitudes.ravel(), rates.reshape(-1, 3), strict=True):
        np.testing.assert_allclose(rate, earth_rate_enu_dps(float(latitude)), atol=1e-18)
    np.testing.assert_allclose(np.linalg.norm(rates, axis=-1), EARTH_RATE_DPS, rtol=1e-15)
    np.testing.assert_allclose(3600.0 * rates[0, 2], [0.0, 11.5382751, 9.6489326], atol=5e-8)


def _enu_from_ecef(latitude: float, longitude: float) -> Array:
    """Shape (3, 3): rows east, north, up."""
    sl, cl, so, co = np.sin(latitude), np.cos(latitude), np.sin(longitude), np.cos(longitude)
    return np.array([[-so, co, 0.0], [-sl * co, -sl * so, cl], [cl * co, cl * so, sl]])


def _ecef_m(latitude: float, longitude: float, altitude_m: float) -> Array:
    """WGS-84 as EPSG method 9602 defines it."""
    a, f = 6378137.0, 1.0 / 298.257223563
    square = f * (2.0 - f)
    n = a / np.sqrt(1.0 - square * np.sin(latitude) ** 2)
    level = (n + altitude_m) * np.cos(latitude)
    up = ((1.0 - square) * n + altitude_m) * np.sin(latitude)
    return np.array([level * np.cos(longitude), level * np.sin(longitude), up])


@pytest.mark.parametrize("latitude_deg", [-75.0, -10.0, 0.0, 39.9042, 80.0])
@pytest.mark.parametrize("altitude_m", [0.0, 12_000.0])
def test_transport_rate_is_the_turning_of_the_local_frame(latitude_deg: float, altitude_m: float) -> None:
    """East, north, up of geodetic geometry before and after a small move: what turned them, by how much."""
    latitude, longitude, step = np.radians(latitude_deg), 0.7, 2e-6
    here = _enu_from_ecef(latitude, longitude)
    for move in ((step, 0.0), (0.0, step), (0.7 * step, -0.4 * step)):
        before, after = (
            (latitude + sign * move[0] / 2, longitude + sign * move[1] / 2) for sign in (-1.0, 1.0)
        )
        velocity = here @ (_ecef_m(*after, altitude_m) - _ecef_m(*before, altitude_m))
        turned = _enu_from_ecef(*after) @ _enu_from_ecef(*before).T  # I − [ω×]
        rate = 0.5 * np.array(
            [turned[1, 2] - turned[2, 1], turned[2, 0] - turned[0, 2], turned[0, 1] - turned[1, 0]]
        )
        np.testing.assert_allclose(
            transport_rate_enu_radps(velocity, latitude_deg, altitude_m), rate, rtol=1e-8, atol=1e-15
        )


def test_transport_rates_of_a_whole_flight() -> None:
    velocity = np.array([[100.0, 0.0, 0.0], [0.0, 100.0, 5.0]])
    rates = transport_rate_enu_radps(velocity, np.array([45.0, 45.0]), np.array([0.0, 1000.0]))
    np.testing.assert_allclose(rates[0], [0.0, 100.0 / 6388838.290121, 100.0 / 6388838.290121], rtol=1e-12)
    np.testing.assert_allclose(rates[1], [-100.0 / 6368381.815620, 0.0, 0.0], rtol=1e-12)
    np.testing.assert_array_equal(transport_rate_enu_radps(velocity, 45.0)[0], rates[0])
