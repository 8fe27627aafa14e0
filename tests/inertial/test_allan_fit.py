"""The five terms of IEEE 952 from an Allan deviation."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.allan import octave_factors, overlapping_allan_variance
from ahrs_lab.inertial.allan_covariance import allan_covariance
from ahrs_lab.inertial.allan_fit import FLICKER, QUANTISATION, RAMP, WALK, WHITE, AllanFit, fit_allan

Array = NDArray[np.float64]


def _fit(rate: Array, interval_s: float = 1.0) -> AllanFit | None:
    octaves = overlapping_allan_variance(rate, octave_factors(len(rate)))
    covariance = allan_covariance(octaves.factors, octaves.differences, len(rate))
    return fit_allan(octaves, covariance, interval_s)


def _fitted(rate: Array, interval_s: float = 1.0) -> AllanFit:
    found = _fit(rate, interval_s)
    assert found is not None
    return found


def _flicker(rng: np.random.Generator, count: int) -> Array:
    """Of bias instability 1, by Kasdin's fractional difference of white noise: S(f) = 1/(2πf)."""
    k = np.arange(1, count)
    response = np.concatenate(([1.0], np.cumprod((k - 0.5) / k)))
    size = 2 * count
    noise = rng.normal(size=count)
    made = np.fft.irfft(np.fft.rfft(response, size) * np.fft.rfft(noise, size), size)[:count]
    return np.asarray(made)


@pytest.mark.parametrize("interval_s", [0.01, 10.0])
@pytest.mark.parametrize("term", [QUANTISATION, WHITE, FLICKER, WALK, RAMP])
def test_each_term_by_itself_comes_back_in_its_unit(term: int, interval_s: float) -> None:
    """Made from its definition; nothing else is seen beside it."""
    rng = np.random.default_rng(11)
    count = 40_000
    made = {
        QUANTISATION: np.diff(rng.normal(0.0, 3.0, count + 1)) / interval_s,
        WHITE: rng.normal(0.0, 3.0 / np.sqrt(interval_s), count),
        FLICKER: 3.0 * _flicker(rng, count),
        WALK: np.cumsum(rng.normal(0.0, 3.0 * np.sqrt(interval_s), count)),
        RAMP: 3.0 * interval_s * np.arange(count) + rng.normal(0.0, 1e-3 * interval_s, count),
    }[term]
    found = _fitted(made, interval_s)
    assert found.terms[term] == pytest.approx(3.0, abs=4.0 * found.uncertainty[term] + 0.005 * 3.0)
    assert found.uncertainty[term] < 0.2
    others = found.deviation(np.array([interval_s * 2.0**5])) / _only(found, term).deviation(
        np.array([interval_s * 2.0**5])
    )
    assert others[0] == pytest.approx(1.0, abs=0.05)


def _only(found: AllanFit, term: int) -> AllanFit:
    terms = np.zeros(5)
    terms[term] = found.terms[term]
    return AllanFit(terms, found.uncertainty, found.upper, found.chi_squared, found.dof, found.first)


def test_white_noise_alone_shows_nothing_else_and_its_uncertainty_is_true() -> None:
    """Three hundred records: a term that is not there is taken in seldom, and N scatters as told."""
    rng = np.random.default_rng(12)
    pulls, extra, described = [], 0, 0
    for _ in range(300):
        found = _fitted(rng.normal(size=2000))
        extra += int(np.count_nonzero(found.terms)) - 1
        described += found.describes
        if np.count_nonzero(found.terms) == 1:
            pulls.append((found.terms[WHITE] - 1.0) / found.uncertainty[WHITE])
    assert extra <= 15
    assert described >= 285
    assert np.std(pulls) == pytest.approx(1.0, abs=0.15)
    assert np.mean(pulls) == pytest.approx(0.0, abs=0.25)


def test_limits_of_what_is_not_shown_hold() -> None:
    """A bias instability that hides below white noise is below its limit in nineteen of twenty records."""
    rng = np.random.default_rng(13)
    held = looked = 0
    for _ in range(150):
        found = _fitted(rng.normal(size=2000) + 0.03 * _flicker(rng, 2000))
        if found.terms[FLICKER] == 0.0:
            looked += 1
            held += bool(found.upper[FLICKER] >= 0.03)
    assert looked > 100
    assert held >= 0.9 * looked


def test_all_terms_together() -> None:
    rng = np.random.default_rng(14)
    count, interval_s = 400_000, 0.1
    rate = (
        np.diff(rng.normal(0.0, 0.2, count + 1)) / interval_s
        + rng.normal(0.0, 1.0 / np.sqrt(interval_s), count)
        + 0.2 * _flicker(rng, count)
        + np.cumsum(rng.normal(0.0, 0.01 * np.sqrt(interval_s), count))
    )
    found = _fitted(rate, interval_s)
    np.testing.assert_allclose(found.terms[:2], [0.2, 1.0], rtol=0.02)
    assert found.terms[FLICKER] == pytest.approx(0.2, abs=4 * found.uncertainty[FLICKER])
    assert found.terms[WALK] == pytest.approx(0.01, abs=4 * found.uncertainty[WALK])
    assert found.describes


def test_a_filtered_output_is_fitted_beyond_the_filter() -> None:
    """A mean over twenty samples: the shortest octaves are not white and are left out."""
    rng = np.random.default_rng(15)
    smooth = np.convolve(rng.normal(size=100_020), np.full(20, 1.0 / 20.0), "valid")
    found = _fitted(smooth)
    assert found.first >= 3
    assert found.terms[WHITE] == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize("count", range(2, 11))
def test_a_handful_of_values_gives_white_noise_and_no_more_than_they_know(count: int) -> None:
    found = _fitted(np.random.default_rng(count).normal(size=count))
    assert np.all(np.isfinite(found.terms))
    assert found.terms[WHITE] > 0.0
    assert np.count_nonzero(found.terms) == 1
    assert found.uncertainty[WHITE] > 0.1


def test_without_noise_there_is_no_fit() -> None:
    assert _fit(np.zeros(100)) is None
    assert _fit(np.zeros(1)) is None
    assert _fit(np.full(100, 1e200) * (-1.0) ** np.arange(100)) is None
