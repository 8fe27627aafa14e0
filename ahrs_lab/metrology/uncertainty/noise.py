"""The sensor's own noise from recordings at rest: white density, flicker, random walk, and the drift between
means.

Everything works on means over about one second (the standard's own sampling interval, 7.1), which resolves
what an on-board filter correlates at shorter lags. The unit of a density is the unit of the rates times √s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

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


@dataclass(frozen=True)
class NoiseModel:
    """``white`` is N, ``flicker`` the bias instability B, ``walk`` the rate random walk K_r of one axis.

    ``inflation`` ≥ 1: by how much the variance of a long mean exceeds what the scatter of neighbouring
    one-second means says, where the output is correlated over seconds. Drift terms are 0 where the
    recordings are too short to tell; ``drift_dof`` is then infinite.
    """

    white: float = 0.0
    white_dof: float = math.inf
    flicker: float = 0.0
    walk: float = 0.0
    drift_dof: float = math.inf
    inflation: float = 1.0

    def scaled(self, factor: float) -> NoiseModel:
        """The same noise in another unit."""
        size = abs(factor)
        return NoiseModel(
            self.white * size,
            self.white_dof,
            self.flicker * size,
            self.walk * size,
            self.drift_dof,
            self.inflation,
        )

    def allan_deviation(self, tau_s: float) -> float:
        """σ(τ) of the model, in the unit of the rates."""
        return math.sqrt(
            self.white**2 / tau_s + FLICKER_SQUARED * self.flicker**2 + self.walk**2 * tau_s / 3.0
        )


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
    """N, B, K_r from the Allan variances, octave by octave, of recordings at rest (batch means of
    ``batch_s``).

    Differences are pooled over the recordings, each inside its own, so their offsets may differ.
    Non-negative least squares of N²/τ + 0.4413·B² + K_r²·τ/3, weighted by what each octave is known to.
    Octaves at the short end that the model cannot follow (an output correlated over seconds) are left out.
    """
    taus, variances, counts = _pooled_allan(dwells, batch_s)
    if not len(taus) or variances[0] == 0.0:
        return NoiseModel()
    first = 0
    terms = _fit_terms(taus, variances, counts)
    while len(taus) - first > 4 and 2.0 * taus[first] <= _LONGEST_WHITE_START_S:
        model = _model(taus[first], terms)
        spread = math.sqrt(3.0 / counts[first])  # relative, edf about 2/3 of the differences
        if variances[first] > model * (1.0 - 4.0 * spread):
            break
        first += 1
        terms = _fit_terms(taus[first:], variances[first:], counts[first:])
    white = terms[0]
    if white == 0.0:  # drift swallows it: the shortest octave is an upper limit
        white = variances[first] * taus[first]
    inflation = max(1.0, white / (variances[0] * taus[0])) if first else 1.0
    return NoiseModel(
        white=math.sqrt(white),
        white_dof=max(1.0, 2.0 * counts[first] / 3.0),
        flicker=math.sqrt(terms[1]),
        walk=math.sqrt(terms[2]),
        drift_dof=max(1.0, float(counts[-1])) if terms[1] > 0.0 or terms[2] > 0.0 else math.inf,
        inflation=inflation,
    )


def _pooled_allan(dwells: Sequence[Array], batch_s: float) -> tuple[Array, Array, Array]:
    taus, variances, counts = [], [], []
    current = [dwell for dwell in dwells if len(dwell) >= 2]
    tau = batch_s
    while current:
        squares = [float(difference @ difference) for difference in map(np.diff, current)]
        count = sum(len(dwell) - 1 for dwell in current)
        taus.append(tau)
        variances.append(0.5 * sum(squares) / count)
        counts.append(count)
        halved = [dwell[: len(dwell) // 2 * 2].reshape(-1, 2).mean(axis=1) for dwell in current]
        current = [dwell for dwell in halved if len(dwell) >= 2]
        tau *= 2.0
    return np.array(taus), np.array(variances), np.array(counts, dtype=np.float64)


def _model(tau: float, terms: tuple[float, float, float]) -> float:
    return terms[0] / tau + FLICKER_SQUARED * terms[1] + terms[2] * tau / 3.0


def _fit_terms(taus: Array, variances: Array, counts: Array) -> tuple[float, float, float]:
    """N², B², K_r² ≥ 0. Two passes: the second weights by the fitted, not by the scattered variances."""
    columns = np.column_stack([1.0 / taus, np.full_like(taus, FLICKER_SQUARED), taus / 3.0])
    if len(taus) < _FEWEST_OCTAVES_FOR_DRIFT:
        return float(variances[0] * taus[0]), 0.0, 0.0
    expected = np.maximum(variances, 1e-6 * variances.max())
    best = np.zeros(3)
    for _ in range(2):
        weights = np.sqrt(counts) / expected
        best = _non_negative(columns * weights[:, None], variances * weights)
        expected = np.maximum(columns @ best, 1e-6 * variances.max())
    return float(best[0]), float(best[1]), float(best[2])


def _non_negative(matrix: Array, target: Array) -> Array:
    """Least squares with three non-negative unknowns: the best of the seven subsets that is feasible."""
    best, least = np.zeros(3), float(target @ target)
    for subset in ([0], [1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]):
        part = matrix[:, subset]
        scale = np.sqrt((part**2).sum(axis=0))
        solution = np.linalg.lstsq(part / scale, target, rcond=None)[0] / scale
        residual = target - part @ solution
        if np.all(solution >= 0.0) and residual @ residual < least:
            least = float(residual @ residual)
            best = np.zeros(3)
            best[subset] = solution
    return best


def drift_structure(lags: Array, duration_s: float, flicker: float, walk: float) -> Array:
    """D_k without its white term: E(ȳ_i − ȳ_j)² of means over ``duration_s`` that start ``lags``·duration
    apart.

    Any shape; lags from 1, nearer ones count as 1; lag 0 gives 0. D_k = (B²/π)[(k+1)²ln(k+1) + (k−1)²ln|k−1|
    − 2k²ln k] + K_r²T(k − ⅓).
    """
    lag = np.maximum(lags, 1.0)
    below = lag - 1.0
    near = np.where(below > 0.0, below**2 * np.log(np.where(below > 0.0, below, 1.0)), 0.0)
    bracket = (lag + 1.0) ** 2 * np.log(lag + 1.0) + near - 2.0 * lag**2 * np.log(lag)
    structure = flicker**2 / math.pi * bracket + walk**2 * duration_s * (lag - 1.0 / 3.0)
    return np.where(lags > 0.0, structure, 0.0)


def drift_variance(weights: Array, starts_s: Array, durations_s: Array, noise: NoiseModel) -> float:
    """Variance of Σcᵢȳᵢ (Σc = 0) by flicker and random walk: −½ ΣΣ cᵢcⱼ D_|i−j|; arrays of shape (n,).

    The means are taken as equally long (their mean duration).
    """
    duration = float(durations_s.mean())
    lags = np.abs(starts_s[:, None] - starts_s[None, :]) / duration
    np.fill_diagonal(lags, 0.0)
    off_diagonal = ~np.eye(len(weights), dtype=bool)
    lags[off_diagonal] = np.maximum(lags[off_diagonal], 1.0)
    structure = drift_structure(lags, duration, noise.flicker, noise.walk)
    return max(0.0, -0.5 * float(weights @ structure @ weights))


def resolution_step(column: Array, looked_at: int = 4096) -> float:
    """Smallest step between different values among the first samples: the output's resolution, 0 if it never
    changes."""
    values = np.unique(column[:looked_at])
    return float(np.diff(values).min()) if len(values) > 1 else 0.0
