"""Against published values."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.inertial.earth import (
    earth_rate_enu_dps,
    meridian_radius_m,
    normal_gravity_mps2,
    transverse_radius_m,
)


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
