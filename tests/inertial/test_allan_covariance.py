"""How well an Allan variance is known: against matrices written out, against SP 1065, against simulation."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.allan import octave_factors, overlapping_allan_variance
from ahrs_lab.inertial.allan_covariance import (
    allan_covariance,
    confidence_limits,
    equivalent_dof,
    pair_moments,
)

Array = NDArray[np.float64]


def _second_differences(m: int, count: int) -> Array:
    matrix = np.zeros((count - 2 * m + 1, count + 1))
    rows = np.arange(len(matrix))
    for offset, value in ((0, 1.0), (m, -2.0), (2 * m, 1.0)):
        matrix[rows, rows + offset] = value
    return matrix


def _phase_covariances(count: int) -> list[Array]:
    """Of the phase for Q, N, K of 1, each from how the process comes about, not from its spectrum."""
    k = np.arange(count + 1.0)
    steps = np.tril(np.ones((count + 1, count + 1)), -1)  # phase from rates
    s, t = np.minimum.outer(k, k), np.maximum.outer(k, k)
    # the integral of a Wiener process: ∫∫ min(u, v) = s²(3t − s)/6
    return [np.eye(count + 1), steps @ steps.T, s**2 * (3.0 * t - s) / 6.0]


@pytest.mark.parametrize(
    ("count", "shorter", "longer"),
    [(10, 1, 1), (10, 2, 4), (300, 1, 1), (300, 1, 64), (300, 7, 90), (300, 64, 128), (300, 150, 150)],
)
def test_moments_are_those_of_the_matrices(count: int, shorter: int, longer: int) -> None:
    quadratic, ramp = pair_moments(shorter, longer, count)
    left, right = _second_differences(shorter, count), _second_differences(longer, count)
    cross = [left @ covariance @ right.T for covariance in _phase_covariances(count)]
    pairs = len(left) * len(right)
    size = np.abs([one.sum() for one in cross]).max() / pairs
    for a, row in zip((0, 1, 3), cross, strict=True):
        assert ramp[a] == pytest.approx(row.sum() / pairs, rel=1e-3, abs=1e-5 * size)
        for b, column in zip((0, 1, 3), cross, strict=True):
            expected = 2.0 * np.sum(row * column) / (4.0 * shorter**2 * longer**2 * pairs)
            assert quadratic[a, b] == pytest.approx(expected, rel=2e-4)


@pytest.mark.parametrize(("count", "m"), [(100, 1), (100, 8), (1000, 1), (1000, 2), (1000, 8), (1000, 32)])
def test_degrees_of_freedom_of_white_noise_are_those_of_sp_1065(count: int, m: int) -> None:
    """Table 5, white FM; the table is an approximation of some percent."""
    n = count + 1.0
    expected = (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m**2 / (4.0 * m**2 + 5.0)
    assert equivalent_dof(1.0 / m, pair_moments(m, m, count)[0][1, 1]) == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize("m", [8, 64])
def test_degrees_of_freedom_of_flicker_are_those_of_sp_1065(m: int) -> None:
    n = 1001.0
    expected = 5.0 * n**2 / (4.0 * m * (n + 3.0 * m))
    variance = 2.0 * np.log(2.0) / np.pi
    assert equivalent_dof(variance, pair_moments(m, m, 1000)[0][2, 2]) == pytest.approx(expected, rel=0.1)


def test_a_single_difference_has_one_degree_of_freedom() -> None:
    for term, variance in ((0, 3.0 / 25.0), (1, 0.2), (2, 2.0 * np.log(2.0) / np.pi), (3, 5.0 / 3.0)):
        assert equivalent_dof(variance, pair_moments(5, 5, 10)[0][term, term]) == pytest.approx(1.0)


def test_long_records_cost_no_digits() -> None:
    """Far apart factors of ten million values: correlations stay correlations."""
    count = 10_000_000
    factors = octave_factors(count)
    covariance = allan_covariance(factors, count - 2 * factors + 1, count)
    for noise in np.eye(5)[1:4]:
        matrix = covariance.of(noise)
        spread = np.sqrt(np.diag(matrix))
        correlation = matrix / np.outer(spread, spread)
        assert np.linalg.eigvalsh(correlation)[0] > 1e-4
        assert np.abs(correlation).max() <= 1.0 + 1e-12
        assert np.abs(correlation[0, -1]) < 0.05


def test_estimates_of_many_records_scatter_as_told() -> None:
    rng = np.random.default_rng(7)
    count, records = 256, 3000
    factors = octave_factors(count)
    white, walk, angle = 1.0, 0.1, 0.7
    found = []
    for _ in range(records):
        phase = rng.normal(0.0, angle, count + 1)
        rate = rng.normal(0.0, white, count) + np.cumsum(rng.normal(0.0, walk, count)) + np.diff(phase)
        found.append(overlapping_allan_variance(rate, factors).variance)
    terms = np.array([angle**2, white**2, 0.0, walk**2, 0.0])
    told = allan_covariance(factors, count - 2 * factors + 1, count).of(terms)
    spread = np.sqrt(np.diag(told))
    # a mean over records of a covariance of heavy-tailed squares: some percent, more for the last octaves
    np.testing.assert_allclose(
        np.cov(np.array(found).T) / np.outer(spread, spread), told / np.outer(spread, spread), atol=0.15
    )


def test_limits_hold_the_deviation_as_often_as_they_say() -> None:
    rng = np.random.default_rng(8)
    count, records = 200, 2000
    factors = np.array([1, 10, 50])
    dof = np.array([equivalent_dof(1.0 / m, pair_moments(int(m), int(m), count)[0][1, 1]) for m in factors])
    inside = np.zeros(3)
    for _ in range(records):
        variance = overlapping_allan_variance(rng.normal(size=count), factors).variance
        low, high = confidence_limits(variance, dof, 0.95)
        inside += (low <= 1.0 / np.sqrt(factors)) & (1.0 / np.sqrt(factors) <= high)
    np.testing.assert_allclose(inside / records, 0.95, atol=0.02)
