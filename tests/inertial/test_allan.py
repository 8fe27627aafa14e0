"""Against NIST SP 1065."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.inertial.allan import overlapping_allan_deviation


def test_ten_point_set() -> None:
    data = np.array([892, 809, 823, 798, 671, 644, 883, 903, 677], dtype=np.float64)
    found = overlapping_allan_deviation(data, (1, 2))
    np.testing.assert_allclose(found, [91.22945, 85.95287], atol=5e-6)


def test_thousand_point_set() -> None:
    number, values = 1234567890, []
    for _ in range(1000):
        values.append(number / 2147483647)
        number = 16807 * number % 2147483647
    found = overlapping_allan_deviation(np.array(values), (1, 10, 100))
    np.testing.assert_allclose(found, [0.2922319, 0.09159953, 0.03241343], rtol=2e-7)


def test_averages_longer_than_half_the_record_are_refused() -> None:
    with pytest.raises(ValueError, match="need 12 values"):
        overlapping_allan_deviation(np.zeros(10), (6,))
