"""Noise from recordings against published Allan variances and against noise of known size."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.metrology.uncertainty.noise import (
    NoiseModel,
    _pooled_allan,
    batch_means,
    drift_variance,
    fit_noise,
    neighbour_variance,
    nonnegative_solution,
    standard_error,
)

NBS14 = np.array([892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0])


def test_the_allan_variance_is_that_of_nist_sp_1065() -> None:
    taus, variances, dofs = _pooled_allan([NBS14], 1.0)
    assert taus[:2].tolist() == [1.0, 2.0]
    assert np.sqrt(variances[:2]) == pytest.approx([91.22945, 115.8082], rel=1e-6)
    assert dofs[:2].tolist() == [4.0, 2.0]
    assert neighbour_variance(NBS14)[0] == pytest.approx(91.22945**2, rel=1e-6)


def test_the_set_of_a_thousand_points_too() -> None:
    state, values = 1234567890, []
    for _ in range(1000):
        values.append(state / 2147483647)
        state = 16807 * state % 2147483647
    data = np.array(values)
    assert math.sqrt(neighbour_variance(data)[0]) == pytest.approx(0.2922319, rel=1e-6)
    by_ten = data.reshape(-1, 10).mean(axis=1)
    assert math.sqrt(neighbour_variance(by_ten)[0]) == pytest.approx(0.09965736, rel=1e-6)


def test_batches_are_of_about_a_second() -> None:
    means, batch_s = batch_means(np.arange(25.0), 0.1)
    assert (means.tolist(), batch_s) == ([4.5, 14.5], 1.0)
    assert batch_means(np.arange(4.0), 2.0)[1] == 2.0
    assert len(batch_means(np.arange(12.0), 0.1)[0]) == 12


def test_offsets_between_recordings_are_no_noise() -> None:
    rng = np.random.default_rng(1)
    dwells = [rng.normal(level, 1e-3, 600) for level in (0.0, 5.0, -3.0)]
    assert fit_noise(dwells, 1.0).white == pytest.approx(1e-3, rel=0.05)


def test_white_noise_has_its_density() -> None:
    rng = np.random.default_rng(2)
    found = fit_noise([rng.normal(0.0, 2e-3, 1800) for _ in range(4)], 1.0)
    # flicker, fitted beside, takes its part of the 7200 one-second means' degrees of freedom
    assert 4000.0 < found.white_dof < 7200.0
    assert found.white == pytest.approx(2e-3, rel=4.0 / math.sqrt(2 * found.white_dof))


def test_estimates_of_white_noise_scatter_about_it_as_their_degrees_of_freedom_say() -> None:
    rng = np.random.default_rng(6)
    found = [fit_noise([rng.normal(0.0, 1.0, 600) for _ in range(6)], 1.0) for _ in range(200)]
    squares = np.array([one.white**2 for one in found])
    assert squares.mean() == pytest.approx(1.0, abs=0.01)
    stated = math.sqrt(float(np.mean([2.0 / one.white_dof for one in found])))
    assert squares.std() == pytest.approx(stated, rel=0.3)


def test_noise_of_the_angle_does_not_count_as_noise_of_the_rate() -> None:
    """0.5″ at each end of a second are forty times the white noise of a navigation grade there."""
    rng = np.random.default_rng(7)
    white, angle = 3.3e-5, 1.4e-4

    def dwell(seconds: int) -> np.ndarray:
        return rng.normal(0.0, white, seconds) + np.diff(rng.normal(0.0, angle, seconds + 1))

    found = fit_noise([dwell(1800) for _ in range(4)], 1.0)
    assert found.quantisation == pytest.approx(angle, rel=0.03)
    assert found.white == pytest.approx(white, rel=0.3)
    means = np.array([dwell(20).mean() for _ in range(2000)])
    stated = np.array([standard_error(dwell(20), found.inflation(20.0))[0] for _ in range(200)])
    assert math.sqrt(float(np.mean(stated**2))) == pytest.approx(float(means.std()), rel=0.1)
    assert found.angle_variance(20.0) == pytest.approx(float(means.var()) * 400.0, rel=0.2)
    naive = standard_error(dwell(20))[0]
    assert naive > 2.5 * means.std()


def test_a_random_walk_is_told_from_white_noise() -> None:
    rng = np.random.default_rng(3)
    walk, white = 1e-4, 1e-3
    dwells = [np.cumsum(rng.normal(0.0, walk, 3600)) + rng.normal(0.0, white, 3600) for _ in range(8)]
    found = fit_noise(dwells, 1.0)
    assert found.walk == pytest.approx(walk, rel=0.15)
    assert found.white == pytest.approx(white, rel=0.05)


def test_an_output_correlated_over_seconds_has_the_uncertainty_of_its_long_mean() -> None:
    """A first-order filter of 2 s: neighbours' scatter says far too little."""
    rng = np.random.default_rng(4)
    density, pole = 1e-3, math.exp(-0.5)
    dwells = []
    for _ in range(8):
        noise = rng.normal(0.0, density, 4000)
        out = np.empty_like(noise)
        state = 0.0
        for i, drive in enumerate(noise):
            state = pole * state + (1.0 - pole) * drive
            out[i] = state
        dwells.append(out[100:])
    found = fit_noise(dwells, 1.0)
    naive, _ = standard_error(dwells[0])
    stated, _ = standard_error(dwells[0], found.inflation(len(dwells[0])))
    truth = density / math.sqrt(len(dwells[0]))
    assert naive < 0.5 * truth
    assert stated == pytest.approx(truth, rel=0.15)
    assert found.white == pytest.approx(density, rel=0.15)


@pytest.mark.parametrize("dwells", [[], [np.zeros(100)], [np.array([1.0])]])
def test_no_noise_is_no_noise(dwells: list[np.ndarray]) -> None:
    assert fit_noise(dwells, 1.0) == NoiseModel()


def test_short_recordings_say_nothing_of_drift() -> None:
    found = fit_noise([np.random.default_rng(5).normal(0.0, 1.0, 20)], 1.0)
    assert (found.flicker, found.walk, found.quantisation) == (0.0, 0.0, 0.0)
    assert drift_variance(np.array([1.0, -1.0]), np.arange(2.0), np.ones(2), found) == (0.0, math.inf)
    assert found.white > 0.0


def test_neighbouring_means_differ_by_the_allan_variance() -> None:
    """D_1 = 2σ²(T): flicker (2 ln 2/π)B², random walk K²T/3 (IEEE 952)."""
    next_to_each_other = np.array([0.5, -0.5]) * math.sqrt(2.0), np.array([0.0, 100.0]), np.full(2, 100.0)
    flicker, walk = NoiseModel(flicker=1.0), NoiseModel(walk=0.2)
    assert drift_variance(*next_to_each_other, flicker)[0] == pytest.approx(0.664282**2, rel=1e-5)
    assert drift_variance(*next_to_each_other, walk)[0] == pytest.approx(0.2**2 * 100.0 / 3.0)
    model = NoiseModel(white=3.0, flicker=1.0, walk=0.2)
    assert model.allan_deviation(100.0) ** 2 == pytest.approx(
        9.0 / 100.0 + 0.664282**2 + 0.04 * 100.0 / 3.0, rel=1e-5
    )


def test_drift_of_a_weighted_sum_is_that_of_the_covariance() -> None:
    """Random walk: covariance of means computed from a finely stepped walk."""
    count, steps, walk = 4, 400, 0.3
    lower = np.tril(np.ones((count * steps, count * steps))) * walk / math.sqrt(steps)
    average = np.kron(np.eye(count), np.full((1, steps), 1.0 / steps))
    covariance = (average @ lower) @ (average @ lower).T
    weights = np.array([0.5, -1.0, 1.5, -1.0])
    found, dof = drift_variance(weights, np.arange(4.0), np.ones(4), NoiseModel(walk=walk))
    assert dof == math.inf
    assert found == pytest.approx(float(weights @ covariance @ weights), rel=5e-3)


def test_means_of_different_length_drift_by_what_they_are_made_of() -> None:
    """A long mean is the mean of its parts; for flicker and for a walk, with pauses between."""
    weights = np.array([1.0, -0.4, -0.6])
    starts, durations = np.array([0.0, 70.0, 200.0]), np.array([60.0, 20.0, 40.0])
    parts = [np.arange(start, start + length, 20.0) for start, length in zip(starts, durations, strict=True)]
    in_parts = np.concatenate([np.full(len(p), w / len(p)) for p, w in zip(parts, weights, strict=True)])
    for noise in (NoiseModel(flicker=1.3), NoiseModel(walk=0.02)):
        whole, _ = drift_variance(weights, starts, durations, noise)
        finely, _ = drift_variance(in_parts, np.concatenate(parts), np.full(len(in_parts), 20.0), noise)
        assert whole == pytest.approx(finely, rel=1e-9)


def test_white_noise_is_not_lowered_where_flicker_is_cut_off_at_zero() -> None:
    """Little flicker beside much noise of the angle: the three are told apart with difficulty."""
    rng = np.random.default_rng(11)
    squares = []
    for _ in range(150):
        dwells = [rng.normal(0.0, 1.0, 600) + np.diff(rng.normal(0.0, 4.0, 601)) for _ in range(6)]
        squares.append(fit_noise(dwells, 1.0).white ** 2)
    assert float(np.mean(squares)) == pytest.approx(1.0, abs=4.0 * float(np.std(squares)) / math.sqrt(150))


def test_pairs_of_rates_suffer_less_from_drift_than_a_sweep() -> None:
    sweep = np.array([-300.0, -200, -100, -50, -10, 10, 50, 100, 200, 300])
    pairs = np.array([10.0, -10, 50, -50, 100, -100, 200, -200, 300, -300])
    noise = NoiseModel(flicker=1.0)
    starts, durations = np.arange(10.0) * 20.0, np.full(10, 20.0)
    spread = float((sweep**2).sum())
    of_pairs, of_sweep = (
        drift_variance(rates / spread, starts, durations, noise)[0] for rates in (pairs, sweep)
    )
    assert of_pairs < 0.5 * of_sweep
    both = drift_variance(np.array([pairs, sweep]) / spread, starts, durations, noise)[0]
    assert both == pytest.approx(of_pairs + of_sweep)


def test_drift_is_known_as_well_as_its_coefficients() -> None:
    """Var(B²) of 0.02·B⁴: two over it are the degrees of freedom, in any unit."""
    covariance = np.zeros((4, 4))
    covariance[2, 2] = 0.02
    noise = NoiseModel(flicker=1.0, covariance=tuple(map(tuple, covariance.tolist())))
    for known in (noise, noise.scaled(-3.0)):
        variance, dof = drift_variance(np.array([1.0, -1.0]), np.arange(2.0), np.ones(2), known)
        assert dof == pytest.approx(100.0)
        assert variance == pytest.approx(known.flicker**2 * 4.0 * math.log(2.0) / math.pi)


@given(st.integers(0, 10_000))
def test_the_non_negative_solution_is_scipys(seed: int) -> None:
    rng = np.random.default_rng(seed)
    columns = rng.random((12, int(rng.integers(1, 5)))) + 0.1
    target = columns @ rng.normal(0.2, 1.0, columns.shape[1]) + 0.1 * rng.standard_normal(12)
    solution, distance = nonnegative_solution(columns, target)
    expected, least = scipy.optimize.nnls(columns, target)
    assert distance == pytest.approx(least, rel=1e-9)
    assert solution == pytest.approx(expected, abs=1e-7)
