"""Against NIST SP 1065, and against the definition written out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from ahrs_lab.inertial.allan import (
    MOST_FACTORS,
    all_factors,
    octave_factors,
    overlapping_allan_deviation,
    overlapping_allan_variance,
    own_factors,
)

Array = NDArray[np.float64]
NBS14 = np.array([892, 809, 823, 798, 671, 644, 883, 903, 677], dtype=np.float64)


def _by_definition(rate: Array, m: int) -> tuple[float, int]:
    """Half the mean square of differences of neighbouring averages that are all there."""
    averages = [rate[i : i + m].mean() for i in range(len(rate) - m + 1)]
    steps = np.array([averages[i + m] - averages[i] for i in range(len(averages) - m)])
    steps = steps[np.isfinite(steps)]
    return float(np.mean(steps**2) / 2.0), len(steps)


def test_ten_point_set() -> None:
    np.testing.assert_allclose(overlapping_allan_deviation(NBS14, (1, 2)), [91.22945, 85.95287], atol=5e-6)


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


@settings(deadline=None, max_examples=60)
@given(st.lists(st.floats(-1e3, 1e3), min_size=0, max_size=40))
def test_any_record_is_the_definition(values: list[float]) -> None:
    rate = np.array(values)
    found = overlapping_allan_variance(rate, octave_factors(len(rate)))
    assert found.factors.tolist() == [m for m in (1, 2, 4, 8, 16) if 2 * m <= len(rate)]
    for m, variance, count in zip(found.factors, found.variance, found.differences, strict=True):
        expected, pairs = _by_definition(rate, int(m))
        assert count == pairs
        assert variance == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_records_longer_than_a_piece_of_work_are_the_definition() -> None:
    rate = np.random.default_rng(3).normal(5.0, 1.0, 20_000)
    for m in (1, 3, 8191, 8192, 9000):
        phase = np.concatenate(([0.0], np.cumsum(rate, dtype=np.longdouble)))
        second = phase[2 * m :] - 2 * phase[m:-m] + phase[: -2 * m]
        expected = np.sqrt(np.mean(second**2) / 2) / m
        assert overlapping_allan_deviation(rate, (m,))[0] == pytest.approx(float(expected), rel=1e-12)


def test_a_large_offset_costs_no_digits() -> None:
    noise = np.random.default_rng(4).normal(0.0, 1e-3, 50_000)
    there = overlapping_allan_deviation(noise, (1, 100, 10_000))
    np.testing.assert_allclose(overlapping_allan_deviation(noise + 1.0, (1, 100, 10_000)), there, rtol=1e-12)


def test_a_gap_leaves_out_the_averages_that_it_spoils() -> None:
    rate = np.random.default_rng(5).normal(0.0, 1.0, 60)
    rate[20:23] = np.nan
    found = overlapping_allan_variance(rate, np.array([1, 4, 10, 19, 30]))
    assert found.factors.tolist() == [1, 4, 10]
    for m, variance, count in zip(found.factors, found.variance, found.differences, strict=True):
        expected, pairs = _by_definition(rate, int(m))
        assert count == pairs
        assert variance == pytest.approx(expected, rel=1e-12)


def test_single_lost_samples_do_not_end_the_record() -> None:
    """One in two hundred: averages of a hundred and more go on, and white noise stays what it is."""
    rng = np.random.default_rng(6)
    rate = rng.normal(0.0, 1.0, 100_000)
    rate[rng.random(100_000) < 0.005] = np.nan
    found = overlapping_allan_variance(rate, np.array([1, 100, 1000]))
    assert found.factors.tolist() == [1, 100, 1000]
    np.testing.assert_allclose(found.deviation * np.sqrt(found.factors), 1.0, rtol=0.12)
    assert found.differences[1] > 90_000


def test_nothing_there_gives_nothing() -> None:
    assert not len(overlapping_allan_variance(np.full(10, np.nan), np.array([1, 2])).variance)
    assert not len(octave_factors(1))
    assert not len(octave_factors(0))


def test_factors_are_those_that_fit() -> None:
    assert octave_factors(9).tolist() == [1, 2, 4]
    assert all_factors(9).tolist() == [1, 2, 3, 4]
    many = all_factors(1_000_000)
    assert (many[0], many[-1]) == (1, 500_000)
    assert len(many) <= MOST_FACTORS
    assert own_factors([100.0, 1.0, 1e9, 0.001, 10.0], 0.1, 2500).tolist() == [10, 100, 1000]
