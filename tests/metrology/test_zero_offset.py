"""B by (16) and by the multi-position method."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.misalignment import misalignment
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS, azimuth_harmonic, zero_offset

HEADINGS = np.linspace(0.0, 330.0, 12)


def test_four_positions_are_summed_over_four_durations() -> None:
    assert zero_offset([1.0, 2.0, 3.0, 6.0], [1800.0] * 4) == pytest.approx(12.0 / 7200.0, rel=1e-15)


def test_unequal_durations_do_not_let_the_earths_rate_in() -> None:
    durations = np.array([100.0, 120.0])
    assert zero_offset(np.array([1.0, -1.0]) * durations + 0.25 * durations, durations) == pytest.approx(0.25)


def test_the_earths_rate_is_that_of_the_reference() -> None:
    # references.md: 39.9042° N: 11.5382751 °/h horizontal
    assert azimuth_harmonic([0.0] * 12, HEADINGS, 39.9042).expected_dps * 3600 == pytest.approx(
        11.5382751, abs=5e-8
    )
    assert pytest.approx(15.0410668769, abs=1e-9) == EARTH_RATE_DPS * 3600  # 7.292115e-5 rad/s


@pytest.mark.parametrize("phase", [-170.0, -3.0, 0.0, 1.5, 90.0])
def test_the_harmonic_has_amplitude_and_azimuth_error(phase: float) -> None:
    found = azimuth_harmonic(0.5 + 3e-3 * np.cos(np.radians(HEADINGS - phase)), HEADINGS, 0.0)
    assert found.amplitude_dps == pytest.approx(3e-3)
    assert found.phase_deg == pytest.approx(phase)


@pytest.mark.parametrize("headings", [[0.0, 180.0], [0.0, 90.0, 180.0], list(HEADINGS[:-1])])
def test_azimuths_that_are_no_equal_steps_are_refused(headings: list[float]) -> None:
    with pytest.raises(InputError, match="equal steps"):
        azimuth_harmonic([0.0] * len(headings), headings, 0.0)


def test_misalignment_is_half_the_difference_over_the_turned_angle() -> None:
    # 1 mrad over ten turns is 3.6°, beside 0.5° of constant bias
    assert misalignment(3.6 + 0.5, -3.6 + 0.5, 10) == pytest.approx(1e-3, rel=1e-15)
    with pytest.raises(ValueError, match="at least 1"):
        misalignment(1.0, -1.0, 0)
