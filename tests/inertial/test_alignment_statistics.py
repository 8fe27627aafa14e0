"""Many units with known errors: the limit (2-104) is reached, and the stated covariance is the true one.

The same fleets as ``benchmarks/alignment.py``, smaller.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from ahrs_lab.inertial.alignment import Orthogonalisation, SensorNoise
from benchmarks.alignment import METHODS, MICRO_G, NAVIGATION, Fleet, draw_fleet, statistics

RUNS = 256

VIBRATING = replace(
    NAVIGATION,
    gyro_noise=replace(NAVIGATION.gyro_noise, jitter=2e-6),
    accel_noise=replace(NAVIGATION.accel_noise, jitter=1e-3),
)
UNEQUAL = replace(NAVIGATION, accel_noise=SensorNoise(white=[10 * MICRO_G, 100 * MICRO_G, 30 * MICRO_G]))


@cache
def navigation() -> Fleet:
    return draw_fleet(39.9042, NAVIGATION, RUNS, 300, 1)


@pytest.mark.parametrize("method", METHODS)
def test_the_limit_is_reached_and_the_covariance_is_honest(method: str) -> None:
    found = statistics(navigation(), method)
    assert found.ratio == pytest.approx([1.0, 1.0, 1.0], abs=0.1)
    assert found.honest, (found.nees, found.band)


@pytest.mark.parametrize("orthogonalisation", ["columns", "svd"])
def test_the_other_orthogonalisations_are_worse_in_level_and_say_so(
    orthogonalisation: Orthogonalisation,
) -> None:
    found = statistics(navigation(), "coarse", orthogonalisation)
    assert found.ratio[0] > 3.0
    assert found.honest, (found.nees, found.band)


@pytest.mark.parametrize("method", ["fine", "kalman-closed"])
def test_far_south_and_with_unequal_channels_too(method: str) -> None:
    found = statistics(draw_fleet(-70.0, UNEQUAL, RUNS, 200, 3), method)
    assert found.ratio == pytest.approx([1.0, 1.0, 1.0], abs=0.1)
    assert found.honest, (found.nees, found.band)


@pytest.mark.parametrize("method", ["coarse", "fine", "kalman-closed"])
def test_vibration_of_the_base_is_in_the_covariance(method: str) -> None:
    found = statistics(draw_fleet(60.0, VIBRATING, RUNS, 200, 9), method)
    assert found.honest, (found.nees, found.band)


def test_the_open_loop_is_careful_on_a_vibrating_base() -> None:
    """It takes what vibration leaves in each step for white noise, which is more than it is."""
    found = statistics(draw_fleet(60.0, VIBRATING, RUNS, 200, 9), "kalman-open")
    assert all(found.nees[n] < high for n, (_, high) in found.band.items())
