"""The sensor's own noise from recordings at rest: white density, flicker, random walk, and the drift between
means.

Everything works on means over about one second (the standard's own sampling interval, 7.1), which resolves
what an on-board filter correlates at shorter lags. The unit of a density is the unit of the rates times √s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BATCH_S = 1.0
WHITE_NOISE = "N"
"""Name of the white density as an estimate that several rows of a budget share."""
FLICKER_SQUARED = 2.0 * math.log(2.0) / math.pi
"""(0.664282)²: Allan variance of flicker noise over B² (IEEE 952)."""
_LONGEST_WHITE_START_S = 16.0
_FEWEST_OCTAVES_FOR_DRIFT = 5
_FEWEST_DOF_OF_A_LIMIT = 10.0
_SIGNIFICANT = 3.84
"""χ² of one degree of freedom that scatter exceeds in one case of twenty."""


@dataclass(frozen=True)
class NoiseModel:
    """``white`` is N, ``flicker`` the bias instability B, ``walk`` the rate random walk K_r of one axis,
    ``quantisation`` Q the white noise of its angle (unit·s).

    ``batch_variance`` is the Allan variance that the recordings at rest show at ``batch_s``, 0 where unknown.
    Drift terms are 0 where the recordings are too short to tell. ``covariance``, shape (4, 4), is that of the
    estimates of Q², N², B², K_r²; None: they are known.
    """

    white: float = 0.0
    white_dof: float = math.inf
    flicker: float = 0.0
    walk: float = 0.0
    quantisation: float = 0.0
    batch_s: float = BATCH_S
    batch_variance: float = 0.0
    covariance: tuple[tuple[float, ...], ...] | None = None

    def scaled(self, factor: float) -> NoiseModel:
        """The same noise in another unit."""
        size = abs(factor)
        return replace(
            self,
            white=self.white * size,
            flicker=self.flicker * size,
            walk=self.walk * size,
            quantisation=self.quantisation * size,
            batch_variance=self.batch_variance * size**2,
            covariance=self.covariance
            and tuple(tuple(entry * size**4 for entry in row) for row in self.covariance),
        )

    def allan_deviation(self, tau_s: float) -> float:
        """σ(τ) of the model, in the unit of the rates."""
        terms = np.array([self.quantisation, self.white, self.flicker, self.walk]) ** 2
        return math.sqrt(float((_columns(np.array([tau_s])) @ terms)[0]))

    def angle_variance(self, duration_s: float) -> float:
        """Of the angle accumulated over ``duration_s``, without drift, unit²·s²: N²·T, and Q² at each end."""
        return self.white**2 * duration_s + 2.0 * self.quantisation**2

    def inflation(self, duration_s: float) -> float:
        """By how much the variance of a mean over ``duration_s``, drift left aside, exceeds what the scatter
        of neighbouring batches says.

        More than 1 where the output is correlated over seconds; less where the scatter of the batches is
        noise of the angle, which a long mean leaves behind, or drift, which has its own row.
        """
        if self.batch_variance == 0.0:
            return 1.0
        return self.angle_variance(duration_s) / (duration_s * self.batch_s * self.batch_variance)


def batch_means(rate: Array, interval_s: float) -> tuple[Array, float]:
    """Means of ``rate``, shape (n,), over batches of about one second: shape (n // m,), and the batch's
    length, s.

    A recording of under two batches comes back as it is.
    """
    size = max(1, round(BATCH_S / interval_s))
    count = len(rate) // size
    if count < 2:
        return rate, interval_s
    return rate[: count * size].reshape(count, size).mean(axis=1), size * interval_s


def neighbour_variance(batches: Array) -> tuple[float, float]:
    """Half the mean square of neighbours' differences (Allan variance) and its degrees of freedom for white
    noise (von Neumann): drift slower than a batch does not enter."""
    count = len(batches)
    if count < 2:
        return 0.0, math.inf
    difference = np.diff(batches)
    return 0.5 * float(difference @ difference) / (count - 1), 2.0 * (count - 1) ** 2 / (3.0 * count - 4.0)


def standard_error(batches: Array, inflation: float = 1.0) -> tuple[float, float]:
    """Standard uncertainty of the mean of one recording from its batches, and its degrees of freedom."""
    variance, dof = neighbour_variance(batches)
    return math.sqrt(inflation * variance / max(1, len(batches))), dof


def fit_noise(dwells: Sequence[Array], batch_s: float) -> NoiseModel:
    """Q, N, B, K_r from the Allan variances, octave by octave, of recordings at rest (batch means of
    ``batch_s``).

    Differences are pooled over the recordings, each inside its own, so their offsets may differ.
    Non-negative least squares of 3Q²/τ² + N²/τ + 0.4413·B² + K_r²·τ/3, weighted by what each octave is known
    to. Octaves at the short end that the model cannot follow (an output correlated over seconds) are left
    out.
    """
    taus, variances, dofs = _pooled_allan(dwells, batch_s)
    if not len(taus) or variances[0] == 0.0:
        return NoiseModel()
    if not np.all(np.isfinite(variances)):  # readings too large to square
        return NoiseModel(white=math.inf, white_dof=1.0)
    first, fit = 0, _fit_terms(taus, variances, dofs)
    while len(taus) - first > 4 and 2.0 * taus[first] <= _LONGEST_WHITE_START_S:
        spread = math.sqrt(2.0 / dofs[first])
        if variances[first] > fit.at(taus[first]) * (1.0 - 4.0 * spread):
            break
        first += 1
        fit = _fit_terms(taus[first:], variances[first:], dofs[first:])
    quantisation, white, flicker, walk = fit.terms.tolist()
    white_dof = 2.0 * white**2 / fit.covariance[1, 1] if white > 0.0 else 0.0
    if white_dof < 1.0:  # the other terms swallow it: each octave is an upper limit, the lowest holds
        limits = np.where(dofs[first:] >= _FEWEST_DOF_OF_A_LIMIT, variances[first:] * taus[first:], math.inf)
        lowest = first + int(np.argmin(limits))
        white, white_dof = variances[lowest] * taus[lowest], dofs[lowest]
    return NoiseModel(
        white=math.sqrt(white),
        white_dof=float(white_dof),
        flicker=math.sqrt(flicker),
        walk=math.sqrt(walk),
        quantisation=math.sqrt(quantisation),
        batch_s=batch_s,
        batch_variance=float(variances[0]),
        covariance=tuple(tuple(row) for row in fit.covariance.tolist()),
    )


def _pooled_allan(dwells: Sequence[Array], batch_s: float) -> tuple[Array, Array, Array]:
    """τ, Allan variance and degrees of freedom, octave by octave.

    Each octave by itself has more than these, its disjoint pairs; but only theirs are independent from octave
    to octave, so that all octaves together know no more than the data.
    """
    taus, variances, dofs = [], [], []
    lengths = {len(dwell) for dwell in dwells if len(dwell) >= 2}
    current = [np.array([dwell for dwell in dwells if len(dwell) == length]) for length in sorted(lengths)]
    tau = batch_s
    while current:
        differences = [np.diff(block, axis=1) for block in current]
        taus.append(tau)
        squares = sum(float(np.vdot(difference, difference)) for difference in differences)
        variances.append(0.5 * squares / sum(difference.size for difference in differences))
        dofs.append(float(sum(len(block) * (block.shape[1] // 2) for block in current)))
        halves = [block[:, : block.shape[1] // 2 * 2] for block in current if block.shape[1] >= 4]
        current = [0.5 * (block[:, ::2] + block[:, 1::2]) for block in halves]
        tau *= 2.0
    return np.array(taus), np.array(variances), np.array(dofs)


def _columns(taus: Array) -> Array:
    """Shape (n, 4): Allan variance at each τ of unit Q², N², B², K_r² (IEEE 952)."""
    return np.column_stack([3.0 / taus**2, 1.0 / taus, np.full_like(taus, FLICKER_SQUARED), taus / 3.0])


@dataclass(frozen=True)
class _Fit:
    """Q², N², B², K_r² ≥ 0, shape (4,), and their covariance, shape (4, 4)."""

    terms: Array
    covariance: Array

    def at(self, tau: float) -> float:
        return float((_columns(np.array([tau])) @ self.terms)[0])


def _fit_terms(taus: Array, variances: Array, dofs: Array) -> _Fit:
    """Three passes: the later ones weight by the fitted, not by the scattered variances."""
    if len(taus) < _FEWEST_OCTAVES_FOR_DRIFT:
        white = float(variances[0] * taus[0])
        return _Fit(
            np.array([0.0, white, 0.0, 0.0]), np.diag([0.0, 2.0 * white**2 / float(dofs[0]), 0.0, 0.0])
        )
    columns = _columns(taus)
    floor = 1e-6 * float(variances.max())
    expected = np.maximum(variances, floor)
    for _ in range(3):
        weights = np.sqrt(0.5 * dofs) / expected
        fit = _select_terms(columns * weights[:, None], variances * weights)
        expected = np.maximum(columns @ fit.terms, floor)
    return fit


def _select_terms(columns: Array, target: Array) -> _Fit:
    """White noise and flicker, which every gyro has, and with them the noise of the angle and the random walk
    where the data ask for them: a term that is only fitted to scatter takes its share from the others."""
    best, least = None, math.inf
    for more in ((), (0,), (3,), (0, 3)):
        used = sorted((1, 2, *more))
        part = columns[:, used]
        scale = np.sqrt((part**2).sum(axis=0))
        solution, distance = nonnegative_solution(part / scale, target)
        cost = distance**2 + _SIGNIFICANT * len(more)
        if cost < least:
            least, best = cost, (used, part / scale, solution, scale)
    assert best is not None
    used, part, solution, scale = best
    terms, covariance = np.zeros(4), np.zeros((4, 4))
    terms[used] = solution / scale
    if terms[2] == 0.0:
        # N² as it is where flicker may be below zero: cut off at zero, it would pull N down in the mean
        free = np.linalg.lstsq(part, target, rcond=None)[0] / scale
        terms[1] = max(terms[1], float(free[used.index(1)]))
    covariance[np.ix_(used, used)] = np.linalg.pinv(part.T @ part) / np.outer(scale, scale)
    return _Fit(terms, covariance)


def nonnegative_solution(columns: Array, target: Array) -> tuple[Array, float]:
    """Least squares with no solution below zero, shape (m,), and the residual's norm, for a few columns: the
    nearest of the plain solutions with any of the columns that is not below zero.

    As scipy.optimize.nnls finds it, without the half second that importing that takes.
    """
    count = columns.shape[1]
    best, least = np.zeros(count), float(np.linalg.norm(target))
    for used in (list(one) for size in range(1, count + 1) for one in combinations(range(count), size)):
        found = np.linalg.lstsq(columns[:, used], target, rcond=None)[0]
        distance = float(np.linalg.norm(columns[:, used] @ found - target))
        if distance < least and found.min() >= 0.0:
            least, best = distance, np.zeros(count)
            best[used] = found
    return best, least


def drift_covariances(starts_s: Array, durations_s: Array) -> tuple[Array, Array]:
    """Generalised covariances, shape (n, n) each, of means over any intervals of shape (n,), for flicker of
    B = 1 and random walk of K_r = 1: right in sums Σcᵢȳᵢ with Σc = 0, where all constants cancel.

    The double integrals of −ln|t|/π and −|t|/2 over both intervals. For equal ones that follow each other
    C_ii + C_jj − 2C_ij is D_k = (B²/π)[(k+1)²ln(k+1) + (k−1)²ln|k−1| − 2k²ln k] + K_r²T(k − ⅓).
    """
    begin, end = starts_s, starts_s + durations_s
    products = np.outer(durations_s, durations_s)
    flicker, walk = np.zeros_like(products), np.zeros_like(products)
    for sign, one, other in ((1.0, end, begin), (1.0, begin, end), (-1.0, end, end), (-1.0, begin, begin)):
        distance = np.abs(np.subtract.outer(one, other))
        flicker += sign * distance**2 * np.log(np.where(distance > 0.0, distance, 1.0))
        walk += sign * distance**3
    return -flicker / (2.0 * math.pi * products), -walk / (12.0 * products)


def drift_variance(
    weights: Array, starts_s: Array, durations_s: Array, noise: NoiseModel
) -> tuple[float, float]:
    """Variance of Σcᵢȳᵢ (Σc = 0) by flicker and random walk, arrays of shape (n,), and its degrees of
    freedom, from how well B² and K_r² are known.

    Several sums at once: ``weights`` of shape (m, n); the result is for their variances added up.
    """
    if noise.flicker == 0.0 and noise.walk == 0.0:
        return 0.0, math.inf
    products = np.atleast_2d(weights).T @ np.atleast_2d(weights)
    units = [max(0.0, float(np.vdot(products, unit))) for unit in drift_covariances(starts_s, durations_s)]
    variance = units[0] * noise.flicker**2 + units[1] * noise.walk**2
    if noise.covariance is None or variance == 0.0:
        return variance, math.inf
    known = np.array(noise.covariance)[2:, 2:]
    return variance, max(1.0, 2.0 * variance**2 / float(units @ known @ units))
