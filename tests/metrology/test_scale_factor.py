"""The line of (14), (15) is least squares; what it shows beyond has its meaning."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.scale_factor import asymmetry_standard_ppm, fit_scale_factor

RATES = np.array([-300.0, -200.0, -100.0, -50.0, -10.0, 10.0, 50.0, 100.0, 200.0, 300.0])
NUMBERS = st.floats(-1e3, 1e3)


def test_it_agrees_with_the_printed_sums_and_with_numpy() -> None:
    means = 1.002 * RATES + 0.3 + np.random.default_rng(1).normal(0.0, 0.01, 10)
    fit = fit_scale_factor(RATES, means, 0.1, 0.3)
    F, M = means - 0.2, len(RATES)
    K = ((RATES * F).sum() - RATES.sum() * F.sum() / M) / ((RATES**2).sum() - RATES.sum() ** 2 / M)
    assert pytest.approx(K, rel=1e-14) == fit.K
    assert pytest.approx(F.sum() / M - K * RATES.sum() / M, rel=1e-12) == fit.F0
    assert pytest.approx(tuple(np.polyfit(RATES, F, 1)), rel=1e-12) == (fit.K, fit.F0)
    assert fit.residuals == pytest.approx(tuple(F - np.polyval(np.polyfit(RATES, F, 1), RATES)), abs=1e-12)


@given(st.lists(NUMBERS, min_size=10, max_size=10), NUMBERS, NUMBERS)
def test_a_shift_of_all_outputs_is_a_shift_of_F0_alone(
    means: list[float], shift: float, static: float
) -> None:
    first = fit_scale_factor(RATES, means, static, static)
    second = fit_scale_factor(RATES, np.array(means) + shift, static, static)
    assert pytest.approx(first.K, abs=1e-12) == second.K
    assert pytest.approx(shift, abs=1e-9) == second.F0 - first.F0
    third = fit_scale_factor(RATES, np.array(means) + shift, static + shift, static + shift)
    assert pytest.approx((first.K, first.F0), abs=1e-9) == (third.K, third.F0)


@given(st.permutations(range(10)), st.lists(NUMBERS, min_size=10, max_size=10))
def test_the_order_of_the_rates_does_not_matter(order: list[int], means: list[float]) -> None:
    first = fit_scale_factor(RATES, means, 0.0, 0.0)
    second = fit_scale_factor(RATES[order], np.array(means)[order], 0.0, 0.0)
    assert pytest.approx((first.K, first.F0), abs=1e-9) == (second.K, second.F0)


def test_an_offset_that_dwarfs_the_signal_costs_no_digits() -> None:
    rates = RATES * 1e-3
    fit = fit_scale_factor(rates, 2.0 * rates + 2.0**20, 0.0, 0.0)
    assert pytest.approx(2.0, rel=1e-9) == fit.K


def test_the_weights_are_the_derivatives() -> None:
    rates = RATES + 7.0
    means = np.sin(RATES)
    fit = fit_scale_factor(rates, means, 0.0, 0.0)
    for index in range(10):
        moved = means.copy()
        moved[index] += 1.0
        other = fit_scale_factor(rates, moved, 0.0, 0.0)
        assert pytest.approx(fit.K_weights[index], abs=1e-14) == other.K - fit.K
        assert pytest.approx(fit.F0_weights[index], abs=1e-12) == other.F0 - fit.F0


def test_nonlinearity_is_the_largest_residual_over_the_largest_output() -> None:
    rates = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    # residuals of a line through (0, 1, 0, 1, 0)·ε about it: mean 0.4 ε, no slope
    fit = fit_scale_factor(rates, rates + np.array([0.0, 1.0, 0.0, 1.0, 0.0]) * 1e-3, 0.0, 0.0)
    assert pytest.approx(1.0) == fit.K
    assert fit.nonlinearity_ppm == pytest.approx(1e6 * 0.6e-3 / 2.0)


def test_asymmetry_is_what_the_senses_differ_by() -> None:
    means = np.where(RATES > 0, 1.0001, 0.9999) * RATES
    fit = fit_scale_factor(RATES, means, 0.0, 0.0)
    assert fit.asymmetry_ppm == pytest.approx(200.0, rel=1e-6)


def test_a_single_rate_of_one_sense_gives_its_slope_from_the_fitted_zero() -> None:
    fit = fit_scale_factor([-100.0, 50.0, 100.0], [-100.0, 50.0, 100.0], 0.0, 0.0)
    assert fit.asymmetry_ppm == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("rates", [[1.0, 2.0, 3.0], [-1.0, -2.0], [0.0, 0.0]])
def test_one_sense_alone_is_refused(rates: list[float]) -> None:
    with pytest.raises(InputError, match="both senses"):
        fit_scale_factor(rates, rates, 0.0, 0.0)


@pytest.mark.parametrize("rates", [RATES, np.array([-100.0, 50.0, 100.0]), np.array([-30.0, 40.0])])
def test_the_asymmetrys_uncertainty_is_the_scatter_that_noise_gives_it(rates: NDArray[np.float64]) -> None:
    rng = np.random.default_rng(7)
    errors = np.linspace(1e-4, 3e-4, len(rates))
    found = [
        fit_scale_factor(rates, rates + errors * rng.standard_normal(len(rates)), 0.0, 0.0).asymmetry_ppm
        for _ in range(4000)
    ]
    stated = asymmetry_standard_ppm(rates, 1.0, errors)
    assert stated == pytest.approx(np.std(found), rel=0.05, abs=1e-6)
    assert asymmetry_standard_ppm(rates, 1.0, ()) is None
