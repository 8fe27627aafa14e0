"""The Monte Carlo engine by itself: repeatable, adaptive, bounded; distributions by their known moments."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.uncertainty.distributions import (
    ArcSine,
    CurvilinearTrapezoid,
    Input,
    Joint,
    Normal,
    Rectangular,
    StudentT,
    Trapezoidal,
    triangular,
)
from ahrs_lab.metrology.uncertainty.full_model import meaningful_digits
from ahrs_lab.metrology.uncertainty.monte_carlo import (
    BLOCK,
    numerical_tolerance,
    propagate,
    shortest_interval,
    symmetric_interval,
    validate,
)

Array = NDArray[np.float64]


def first(x: Array) -> Array:
    return np.asarray(x[0])


def total(x: Array) -> Array:
    return np.asarray(x.sum(axis=0))


def test_a_seed_gives_the_same_trials_on_any_number_of_threads() -> None:
    inputs: list[Input] = [
        Normal(1.0, 2.0),
        StudentT(0.0, 1.0, 5.0),
        Joint(("a", "b"), (0, 0), (1, 1), ((1, 0.5), (0.5, 1))),
    ]
    alone, together, other = (
        propagate(inputs, total, seed=seed, trials=55_001, threads=threads)
        for seed, threads in ((7, 1), (7, 2), (8, 2))
    )
    assert np.array_equal(alone.values, together.values)
    assert (alone.mean, alone.symmetric) == (together.mean, together.symmetric)
    assert alone.trials == 55_001
    assert alone.mean != other.mean


def test_the_adaptive_procedure_ends_the_same_on_any_number_of_threads() -> None:
    alone, together = (
        propagate([Normal(0.0, 3.0)], first, seed=1, digits=1, threads=threads) for threads in (1, 2)
    )
    assert np.array_equal(alone.values, together.values)
    assert alone.stable


@pytest.mark.parametrize(
    ("entry", "shape"),
    [
        (Normal(2.0, 3.0), stats.norm(2.0, 3.0)),
        (StudentT(2.0, 3.0, 7.0), stats.t(7.0, 2.0, 3.0)),
        (StudentT(2.0, 3.0, math.inf), stats.norm(2.0, 3.0)),
        (Rectangular(2.0, 3.0), stats.uniform(-1.0, 6.0)),
        (triangular(2.0, 3.0), stats.triang(0.5, -1.0, 6.0)),
        (Trapezoidal(2.0, 3.0, 0.4), stats.trapezoid(0.3, 0.7, -1.0, 6.0)),
        (ArcSine(2.0, 3.0), stats.arcsine(-1.0, 6.0)),
        (Rectangular(2.0, 0.0), None),
        (StudentT(2.0, 0.0, 3.0), None),
    ],
)
def test_a_distribution_is_drawn_as_scipy_knows_it(entry: Input, shape: object) -> None:
    found = propagate([entry], first, seed=3, trials=200_000)
    if shape is None:
        assert (found.mean, found.standard, found.shortest) == (2.0, 0.0, (2.0, 2.0))
    else:
        assert stats.kstest(found.values[::10], shape.cdf).pvalue > 1e-4  # type: ignore[attr-defined]
        assert found.standard == pytest.approx(shape.std(), rel=0.02)  # type: ignore[attr-defined]
        assert found.symmetric == pytest.approx(shape.ppf([0.025, 0.975]), abs=0.06)  # type: ignore[attr-defined]


def test_limits_that_are_known_inexactly_widen_the_rectangle() -> None:
    """JCGM 101, 6.4.3.4: variance (b − a)²/12 + d²/9."""
    found = propagate([CurvilinearTrapezoid(1.0, 2.0, 0.6)], first, seed=3, trials=400_000)
    assert found.mean == pytest.approx(1.0, abs=0.01)
    assert found.standard == pytest.approx(math.sqrt(4.0**2 / 12.0 + 0.6**2 / 9.0), rel=5e-3)
    assert (found.values[0], found.values[-1]) == pytest.approx((-1.6, 3.6), abs=0.02)


def test_quantities_that_share_an_estimate_are_a_multivariate_t() -> None:
    inputs = [Joint(("a", "b"), (1.0, 2.0), (1.0, 2.0), ((1.0, -0.5), (-0.5, 1.0)), 8.0)]
    found = propagate(inputs, total, seed=4, trials=400_000)
    assert found.mean == pytest.approx(3.0, abs=0.015)
    # a sum is a t again, with the same degrees of freedom
    assert stats.kstest(found.values[::20], stats.t(8.0, 3.0, math.sqrt(3.0)).cdf).pvalue > 1e-4


def test_correlations_that_contradict_each_other_are_refused_by_name() -> None:
    matrix = ((1.0, 0.9, -0.9), (0.9, 1.0, 0.9), (-0.9, 0.9, 1.0))
    with pytest.raises(InputError, match=r"correlations of a, b, c contradict each other.*−?-0\.8"):
        Joint(("a", "b", "c"), (0, 0, 0), (1, 1, 1), matrix)
    with pytest.raises(InputError, match=r"coefficient of a and b is 1\.5"):
        Joint(("a", "b"), (0, 0), (1, 1), ((1.0, 1.5), (1.5, 1.0)))
    # fully correlated is the edge of what can be
    found = propagate(
        [Joint(("a", "b"), (0, 0), (1, 1), ((1.0, -1.0), (-1.0, 1.0)))], total, seed=1, trials=BLOCK
    )
    assert found.standard == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("dof", [0.0, -1.0, math.nan])
def test_degrees_of_freedom_that_are_not_positive_are_refused(dof: float) -> None:
    with pytest.raises(InputError, match="degrees of freedom"):
        StudentT(0.0, 1.0, dof)


@pytest.mark.parametrize("width", [-1.0, math.nan, math.inf])
def test_a_width_that_cannot_be_is_refused(width: float) -> None:
    with pytest.raises(InputError, match="wide"):
        Rectangular(0.0, width)


@pytest.mark.parametrize("trials", [-1, 9_999, 1_000_000_000])
def test_a_number_of_trials_out_of_bounds_is_refused_with_the_reason(trials: int) -> None:
    with pytest.raises(InputError, match=r"at most 10000000, because all of them are kept in memory"):
        propagate([Normal(0.0, 1.0)], first, seed=1, trials=trials)


def test_a_model_that_gives_no_number_is_refused() -> None:
    def root(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.asarray(np.sqrt(x[0]))

    with pytest.raises(InputError, match=r"no finite number in \d+ of 10000"):
        propagate([Normal(0.0, 1.0)], root, seed=1, trials=BLOCK)


@pytest.mark.parametrize(
    ("standard", "digits", "expected"),
    # the examples of JCGM 101, 7.9.2, and the edges of rounding
    [
        (0.00035, 2, 0.000005),
        (2.0, 1, 0.5),
        (0.0996, 2, 0.0005),
        (0.0994, 2, 0.0005),
        (33.0, 2, 0.5),
        (0.0, 1, 0.0),
    ],
)
def test_the_numerical_tolerance_is_half_the_last_digit(
    standard: float, digits: int, expected: float
) -> None:
    assert numerical_tolerance(standard, digits) == pytest.approx(expected, rel=1e-12)


def test_the_adaptive_procedure_takes_the_trials_that_the_ends_need() -> None:
    """Twice the standard error of a normal's 97.5 % quantile is 5.34 σ/√M, which has to reach δ/5."""
    found = propagate([Normal(0.0, 1.0)], first, seed=5, digits=2)
    assert found.stable
    assert 0.5 < found.trials / (5.34 / (0.05 / 5.0)) ** 2 < 2.0
    limited = propagate([Normal(0.0, 1.0)], first, seed=5, digits=2, most=50_000)
    assert (limited.trials, limited.stable) == (50_000, False)


def test_a_skew_distribution_has_a_shorter_interval_than_the_symmetric_one() -> None:
    """χ² with two degrees of freedom: [0, 5.99] against [0.05, 7.38]."""
    found = propagate([Normal(0.0, 1.0)] * 2, lambda x: x[0] ** 2 + x[1] ** 2, seed=6, trials=10**6)
    assert found.symmetric == pytest.approx(stats.chi2(2).ppf([0.025, 0.975]), abs=0.03)
    assert found.shortest == pytest.approx((0.0, stats.chi2(2).ppf(0.95)), abs=0.03)


def test_intervals_hold_the_share_of_the_values_that_they_are_asked_for() -> None:
    ordered = np.arange(1.0, 10_001.0)
    assert symmetric_interval(ordered) == (250.0, 9750.0)
    assert shortest_interval(ordered) == (1.0, 9501.0)
    assert symmetric_interval(ordered, 0.99) == (50.0, 9950.0)


def test_the_check_says_passed_or_not_and_can_be_looked_at() -> None:
    found = propagate([Normal(10.0, 1.0)], first, seed=1, trials=400_000)
    good, bad = (validate(found, 10.0 - U, 10.0 + U, standard=1.0, digits=2) for U in (1.96, 2.05))
    assert (good.validated, bad.validated) == (True, False)
    assert (good.tolerance, good.digits) == (0.05, 2)
    assert sum(good.counts) == pytest.approx(400_000, rel=1e-3)
    assert good.bins == pytest.approx((6.0, 14.0), abs=0.05)
    still = propagate([Normal(1.0, 0.0)], first, seed=1, trials=BLOCK)
    certain = validate(still, 1.0, 1.0, standard=0.0, digits=2)
    assert (certain.validated, certain.counts) == (True, ())


@pytest.mark.parametrize("exponent", [-9, -1, 0, 3])
@pytest.mark.parametrize("mantissa", [1.0, 1.99, 2.95, 2.9999, 3.0, 9.49, 9.5, 9.7, 9.95, 9.96, 9.9999999])
def test_the_tolerance_is_a_few_percent_of_any_u(mantissa: float, exponent: int) -> None:
    """From the first digit before rounding: 9.7 is not taken for 1·10¹, whose δ would be half of u."""
    u = float(f"{mantissa}e{exponent}")
    assert 0.0166 <= numerical_tolerance(u, meaningful_digits(u)) / u <= 0.1667


def test_a_t_without_variance_has_no_standard_uncertainty_but_an_interval() -> None:
    """ν = 2: t₀.₉₇₅ = 4.303 is found, adaptively, though the trials' own u grows with their number."""
    found = propagate([StudentT(0.0, 1.0, 2.0)], first, seed=3, tolerance=0.1, digits=2)
    assert found.stable
    assert not found.finite
    assert found.symmetric == pytest.approx((-4.303, 4.303), abs=0.05)
    check = validate(found, -4.303, 4.303, standard=1.0, digits=2)
    assert (check.standard, check.tolerance, check.validated) == (None, 0.05, True)
    assert sum(check.counts) > 0.97 * check.trials
    assert check.bins == pytest.approx((-8.6, 8.6), abs=0.2)


def test_the_tolerance_is_of_the_gums_u_and_not_of_the_trials() -> None:
    """ν = 2.1 makes the trials' u many times the budget's, and with it δ would let anything pass."""
    found = propagate([StudentT(0.0, 1.0, 2.1)], first, seed=3, trials=200_000)
    assert found.standard > 2.0
    check = validate(found, -3.9, 3.9, standard=1.0, digits=2)
    assert (check.tolerance, check.validated) == (0.05, False)
