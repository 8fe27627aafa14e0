"""What an Allan deviation says of the sensor: the five terms of IEEE 952, with their uncertainties.

σ²(τ) = 3Q²/τ² + N²/τ + (2 ln 2/π)·B² + K²·τ/3 + R²·τ²/2. Non-negative generalised least squares over the
octaves, weighted by the covariance that the fitted terms themselves give the estimates
(:mod:`ahrs_lab.inertial.allan_covariance`), in a few passes; octaves share data, so their correlation counts.

An output that is filtered or shaken is no noise of the five terms at the shortest octaves: these are left out
as far as the rest is described (χ²).

A term is shown where it is needed: of all subsets of the terms the one with the least χ² + 6.63 a term, so
that a term which is not there is taken in about one case in a hundred. The others are 0, with the upper limit
(95 %, one-sided) that the data still allow.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from ahrs_lab.inertial.allan import AllanVariance
from ahrs_lab.inertial.allan_covariance import AllanCovariance

Array = NDArray[np.float64]

QUANTISATION, WHITE, FLICKER, WALK, RAMP = range(5)
PENALTY: Final = 6.63
"""χ² of one degree of freedom that scatter exceeds in one case of a hundred."""
MODEL_ERROR: Final = 0.005
"""Of the variance, relative: no sensor follows the five terms better than that, and a single octave known to
10⁻⁴ shall not outweigh all others."""
_ONE_SIDED = 1.645
_FEWEST = 4
"""Octaves: with less, all is taken for white noise."""
_PASSES = 8
_ORDER = (WHITE, FLICKER, WALK, QUANTISATION, RAMP)
"""What is believed first where the data cannot tell."""


@dataclass(frozen=True)
class AllanFit:
    """``terms`` (5,): Q, N, B, K, R in the unit u of the rate and seconds: u·s, u·√s, u, u/√s, u/s; 0 where
    not shown. ``uncertainty`` (5,) standard, NaN where not shown; ``upper`` (5,) limits of those not shown,
    NaN for the shown; NaN, too, where the record is too short for a limit.

    ``chi_squared`` with ``dof`` tells how well the terms describe the octaves from the one numbered ``first``
    on.
    """

    terms: Array
    uncertainty: Array
    upper: Array
    chi_squared: float
    dof: int
    first: int

    def deviation(self, tau_s: Array) -> Array:
        """Of the fitted terms, shape of ``tau_s``."""
        return np.sqrt(allan_columns(tau_s) @ self.terms**2)

    @property
    def describes(self) -> bool:
        """Whether χ² is within what scatter allows."""
        return _describes(self.chi_squared, self.dof)


def _describes(chi_squared: float, dof: int) -> bool:
    """Four of its standard deviations: estimates from a few differences scatter more than normally."""
    return bool(chi_squared <= dof + 4.0 * np.sqrt(2.0 * max(1, dof)))


def allan_columns(tau: Array) -> Array:
    """Shape (f, 5): Allan variance at each τ for Q, N, B, K, R of 1 (IEEE 952)."""
    flat = np.full_like(tau, 2.0 * np.log(2.0) / np.pi)
    return np.stack([3.0 / tau**2, 1.0 / tau, flat, tau / 3.0, tau**2 / 2.0], axis=-1)


def in_seconds(interval_s: float) -> Array:
    """Shape (5,): Q, N, B, K, R per those that count time in sample intervals."""
    return np.array([interval_s, np.sqrt(interval_s), 1.0, 1.0 / np.sqrt(interval_s), 1.0 / interval_s])


def fit_allan(octaves: AllanVariance, covariance: AllanCovariance, interval_s: float) -> AllanFit | None:
    """The terms that these octaves show; None where there is no noise at all.

    ``covariance`` is that of the same factors.
    """
    variance = octaves.variance
    if not len(variance) or not np.all(np.isfinite(variance)) or not np.all(variance > 0.0):
        return None
    size = float(variance.max())
    tau = octaves.factors.astype(np.float64)
    problem = _Problem(allan_columns(tau), variance / size, covariance)
    first, fit = _first_described(problem)
    unit = np.sqrt(size) * in_seconds(interval_s)
    upper = _upper(problem, fit, first)
    return AllanFit(
        np.sqrt(fit.squares) * unit,
        _of_roots(fit) * unit,
        upper * unit,
        fit.chi_squared,
        len(tau) - first - len(fit.used),
        first,
    )


@dataclass(frozen=True)
class _Solution:
    """``squares`` (5,): Q² …, their ``covariance`` (5, 5), which terms are ``used``."""

    squares: Array
    covariance: Array
    used: tuple[int, ...]
    chi_squared: float


@dataclass(frozen=True)
class _Problem:
    """Time in sample intervals, variances relative to the largest."""

    columns: Array
    variance: Array
    covariance: AllanCovariance

    def solved(self, first: int) -> _Solution:
        """From octave ``first`` on; passes until the weights no longer change the choice of terms."""
        expected = self.variance[first:]
        # to begin with, octaves as if independent, each known to the white noise that would make it
        white = np.array([0.0, 1.0, 0.0, 0.0, 0.0])
        relative = np.diag(self.covariance.of(white))[first:] / self.columns[first:, WHITE] ** 2
        spread = np.diag((relative + MODEL_ERROR**2) * expected**2)
        solution = self._chosen(first, spread)
        for _ in range(_PASSES):
            before, solution = solution, self._chosen(first, self.spread(solution.squares)[first:, first:])
            if solution.used == before.used and np.allclose(solution.squares, before.squares, rtol=1e-6):
                break
        return solution

    def spread(self, squares: Array) -> Array:
        """Shape (f, f): covariance of the variances, were these the terms."""
        expected = self.columns @ squares
        return self.covariance.of(squares) + np.diag((MODEL_ERROR * expected) ** 2)

    def _chosen(self, first: int, spread: Array) -> _Solution:
        most = max(1, min(5, len(self.variance) - first - 2))
        subsets = [s for k in range(1, most + 1) for s in combinations(_ORDER, k)]
        if len(self.variance) - first < _FEWEST:
            subsets = [(WHITE,)]
        whiten = np.linalg.inv(np.linalg.cholesky(spread))
        target = whiten @ self.variance[first:]
        best: _Solution | None = None
        for subset in subsets:
            used = tuple(sorted(subset))
            found = _least_squares(whiten @ self.columns[first:, used], target, used)
            if found is not None and (best is None or _cost(found) < _cost(best) - 1e-9):
                best = found
        assert best is not None  # one positive term always fits positive variances
        return best

    def with_term(self, term: int, solution: _Solution, first: int) -> _Solution:
        """Unconstrained, with ``term`` beside the used ones."""
        whiten = np.linalg.inv(np.linalg.cholesky(self.spread(solution.squares)[first:, first:]))
        used = (*solution.used, term)
        found = _least_squares(
            whiten @ self.columns[first:, used], whiten @ self.variance[first:], used, False
        )
        assert found is not None
        return found


def _first_described(problem: _Problem) -> tuple[int, _Solution]:
    """From the first octave on; where the terms cannot follow that, from the shortest octave on from which
    they can; where there is none, from the first, and χ² says so."""
    octaves = len(problem.variance)
    whole = problem.solved(0)
    for first in range(max(1, octaves - _FEWEST)):
        solution = problem.solved(first) if first else whole
        if _describes(solution.chi_squared, octaves - first - len(solution.used)):
            return first, solution
    return 0, whole


def _cost(solution: _Solution) -> float:
    return solution.chi_squared + PENALTY * len(solution.used)


def _least_squares(
    columns: Array, target: Array, used: tuple[int, ...], positive: bool = True
) -> _Solution | None:
    """None where a term comes out as 0: the subset without it is tried by itself."""
    scale = np.sqrt(np.sum(columns**2, axis=0))
    part = columns / scale
    found = nnls(part, target)[0] if positive else np.linalg.lstsq(part, target, rcond=None)[0]
    if positive and not np.all(found > 0.0):
        return None
    squares, covariance = np.zeros(5), np.zeros((5, 5))
    squares[list(used)] = found / scale
    covariance[np.ix_(used, used)] = np.linalg.pinv(part.T @ part) / np.outer(scale, scale)
    rest = target - part @ found
    return _Solution(squares, covariance, used, float(rest @ rest))


def _of_roots(solution: _Solution) -> Array:
    """Standard uncertainties of Q … from those of Q² …."""
    found = np.full(5, np.nan)
    for term in solution.used:
        found[term] = 0.5 * np.sqrt(solution.covariance[term, term] / solution.squares[term])
    return found


def _upper(problem: _Problem, solution: _Solution, first: int) -> Array:
    found = np.full(5, np.nan)
    if len(problem.variance) - first > len(solution.used):
        for term in range(5):
            if term not in solution.used:
                more = problem.with_term(term, solution, first)
                spread = np.sqrt(more.covariance[term, term])
                found[term] = np.sqrt(max(0.0, more.squares[term]) + _ONE_SIDED * spread)
    return found
