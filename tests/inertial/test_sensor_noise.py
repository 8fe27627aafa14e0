"""The Allan deviation of long records gives the entered coefficients back (IEEE 952)."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ahrs_lab.inertial import sensor_noise
from ahrs_lab.inertial.allan import overlapping_allan_deviation
from ahrs_lab.inertial.sensor_noise import Interpolation, NoiseCoefficients, SlowDrift, WhiteNoise

_SEED = np.random.SeedSequence(20)


def _white(coefficients: NoiseCoefficients, rate_hz: float, count: int) -> NDArray[np.float64]:
    values = np.zeros(count)
    seed = np.random.SeedSequence(5)
    WhiteNoise(coefficients, 1.0 / rate_hz, seed).add_to(values, np.empty(count))
    return values


def _error(count: int, m: int) -> float:
    """Relative standard error of an Allan deviation, IEEE 952."""
    return float(1.0 / np.sqrt(2.0 * (count / m - 1.0)))


@pytest.mark.parametrize("rate_hz", [10.0, 250.0])
def test_white_noise_is_the_random_walk_coefficient_at_any_sampling_rate(rate_hz: float) -> None:
    count = 200_000
    record = _white(NoiseCoefficients(white=0.0035), rate_hz, count)
    for m in (1, 10, 100):
        (found,) = overlapping_allan_deviation(record, (m,))
        assert found == pytest.approx(0.0035 / np.sqrt(m / rate_hz), rel=4 * _error(count, m))


@pytest.mark.parametrize("rate_hz", [10.0, 250.0])
def test_quantisation_falls_with_tau(rate_hz: float) -> None:
    count = 200_000
    record = _white(NoiseCoefficients(quantisation=0.02), rate_hz, count)
    for m in (1, 10, 30):
        (found,) = overlapping_allan_deviation(record, (m,))
        assert found == pytest.approx(np.sqrt(3.0) * 0.02 * rate_hz / m, rel=4 * _error(count, m))


def test_quantisation_leaves_nothing_behind_in_the_angle() -> None:
    record = _white(NoiseCoefficients(quantisation=0.02), 10.0, 100_000)
    half_step = 0.02 * np.sqrt(12.0) / 2.0
    assert np.max(np.abs(np.cumsum(record) / 10.0)) <= 2.0 * half_step


def test_bias_instability_is_a_floor_over_three_decades() -> None:
    """Forty independent channels, because a flicker record has few degrees of freedom at long averages."""
    nodes = SlowDrift((NoiseCoefficients(bias_instability=1.0),) * 40, _SEED).nodes(0, 40_000)
    for m in (10, 30, 100, 300, 1000, 3000):
        squares = [overlapping_allan_deviation(row, (m,))[0] ** 2 for row in nodes]
        floor = np.sqrt(np.mean(squares))
        spread = np.std(squares) / np.sqrt(len(squares)) / (2.0 * floor)
        assert floor == pytest.approx(0.664282, rel=0.01, abs=4.0 * spread), m


def test_rate_random_walk_rises_with_tau() -> None:
    nodes = SlowDrift((NoiseCoefficients(random_walk=0.5),) * 40, _SEED).nodes(0, 20_000)
    for m in (10, 100, 1000):
        squares = [overlapping_allan_deviation(row, (m,))[0] ** 2 for row in nodes]
        found = np.sqrt(np.mean(squares))
        spread = np.std(squares) / np.sqrt(len(squares)) / (2.0 * found)
        assert found == pytest.approx(0.5 * np.sqrt(m / 3.0), rel=0.01, abs=4.0 * spread), m


def test_drift_begins_at_zero_and_does_not_depend_on_how_it_is_asked() -> None:
    coefficients = (NoiseCoefficients(bias_instability=1.0, random_walk=0.1),) * 6
    whole = SlowDrift(coefficients, np.random.SeedSequence(1)).nodes(0, 9000).copy()
    other = SlowDrift(coefficients, np.random.SeedSequence(1))
    assert not whole[:, 0].any()
    for first, last in ((3, 17), (4000, 4500), (0, 9000)):
        np.testing.assert_array_equal(other.nodes(first, last), whole[:, first : last + 1])


def test_white_noise_does_not_depend_on_how_it_is_asked() -> None:
    coefficients = NoiseCoefficients(white=1.0, quantisation=0.3)
    whole = np.zeros(1000)
    WhiteNoise(coefficients, 0.01, np.random.SeedSequence(4)).add_to(whole, np.empty(1000))
    source = WhiteNoise(coefficients, 0.01, np.random.SeedSequence(4))
    parts = []
    for count in (1, 0, 399, 600):
        part = np.zeros(count)
        source.add_to(part, np.empty(count))
        parts.append(part)
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_interpolation_is_numpys() -> None:
    times = np.sort(np.random.default_rng(1).uniform(3.0, 20.0, 500))
    between = Interpolation(times)
    nodes = np.random.default_rng(2).normal(size=between.last - between.first + 1)
    reference = np.interp(times, np.arange(between.first, between.last + 1), nodes)
    np.testing.assert_allclose(between(nodes, np.empty(500)), reference, atol=1e-14)


@pytest.mark.parametrize(
    "decays",
    [
        (0.99, 0.96, 0.9),
        (0.9995, 0.9991, 0.995, 0.95),
        (0.5,),
        tuple(np.exp(-0.01 / 10.0 ** (-np.arange(5) / 2.0))),
        tuple(np.exp(-0.0002 / 10.0 ** (-np.arange(7) / 2.0))),
    ],
)
def test_the_recursion_by_rows_is_scipys_filter(decays: tuple[float, ...]) -> None:
    poles = np.array(decays)
    zeros = 0.5 * (poles[1:] + poles[:-1])
    recursion = sensor_noise._Recursion(zeros, poles)
    given = np.random.default_rng(5).standard_normal((3, sensor_noise._CHUNK))
    sections = scipy.signal.zpk2sos(np.append(zeros, 0.0), poles, 1.0)
    expected = scipy.signal.sosfilt(sections, given.ravel())
    found = np.concatenate([recursion(chunk) for chunk in given])
    assert found == pytest.approx(expected, abs=1e-9 * float(np.std(expected)))


@pytest.mark.parametrize("white", [0.0, 1e-4, 0.01])
@pytest.mark.parametrize("interval_s", [0.1, 0.01, 0.0005])
def test_one_filter_has_the_spectrum_of_white_noise_and_the_short_processes(
    white: float, interval_s: float
) -> None:
    constants = 10.0 ** (-np.arange(4) / 2.0)
    decay = np.exp(-interval_s / constants)
    variance, high_pass = 0.3 * np.arange(1.0, 5.0), float(np.exp(-interval_s / 0.55))
    zeros, gain = sensor_noise._factored(decay, variance, high_pass, white)
    assert np.all(np.abs(zeros) <= 1.0)
    turn = np.exp(-1j * np.geomspace(1e-5, np.pi, 400))
    markov = variance[:, np.newaxis] * (1.0 - decay[:, np.newaxis] ** 2)
    sums = np.sum(markov / np.abs(1.0 - decay[:, np.newaxis] * turn) ** 2, axis=0)
    expected = white + sums * np.abs((1.0 - turn) / (1.0 - high_pass * turn)) ** 2
    shown = np.prod(1.0 - zeros[:, np.newaxis] * turn, axis=0)
    shown /= np.prod(1.0 - np.append(decay, high_pass)[:, np.newaxis] * turn, axis=0)
    # where nothing but the high pass's zero is left, rounding is of the whole
    np.testing.assert_allclose((gain * np.abs(shown)) ** 2, expected, rtol=1e-7, atol=1e-15)


def test_filtered_noise_does_not_depend_on_how_it_is_asked() -> None:
    coefficients = NoiseCoefficients(white=0.005, bias_instability=0.003)
    whole = np.zeros(10_000)
    WhiteNoise(coefficients, 0.01, np.random.SeedSequence(4)).add_to(whole, np.empty(10_000))
    source = WhiteNoise(coefficients, 0.01, np.random.SeedSequence(4))
    parts = [np.zeros(count) for count in (1, 0, 4095, 5000, 904)]
    for part in parts:
        source.add_to(part, np.empty(len(part)))
    np.testing.assert_array_equal(np.concatenate(parts), whole)


@pytest.mark.parametrize("white", [0.0, 1e-160, 1e-20, 1e-12, 1e-9, 1e-7])
@pytest.mark.parametrize("interval_s", [0.01, 0.001, 0.0005])
def test_white_noise_that_is_all_but_none_changes_nothing(white: float, interval_s: float) -> None:
    def deviation(white: float) -> float:
        values = np.zeros(40_000)
        coefficients = NoiseCoefficients(white=white, bias_instability=1.0)
        WhiteNoise(coefficients, interval_s, np.random.SeedSequence(3)).add_to(values, np.empty(40_000))
        return float(values.std())

    assert deviation(white) == pytest.approx(deviation(0.0), rel=1e-3)


@pytest.mark.parametrize("rate_hz", [10.0, 100.0, 500.0, 2000.0])
def test_filtered_noise_is_stationary_from_its_first_sample(rate_hz: float) -> None:
    coefficients = NoiseCoefficients(bias_instability=1.0)
    seeds = np.random.SeedSequence(8).spawn(600)
    noises = [WhiteNoise(coefficients, 1.0 / rate_hz, seed) for seed in seeds]
    first, later = np.zeros((600, 1)), np.zeros((600, 3000))
    for noise, begin, rest in zip(noises, first, later, strict=True):
        noise.add_to(begin, np.empty(1))
        noise.add_to(rest, np.empty(3000))
    # six standard deviations of a ratio of 600 independent values to very many
    assert float(first.std() / later.std()) == pytest.approx(1.0, abs=6.0 / np.sqrt(2 * 600))
