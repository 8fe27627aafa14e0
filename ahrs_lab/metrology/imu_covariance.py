"""Covariance of a calibration set: the sensor's noise and drift through the linear map of all means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.stats import chi2, norm
from scipy.stats import t as student

from ahrs_lab.metrology.imu_calibration import OTHERS
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, drift_covariances

Array = NDArray[np.float64]

_RARE = 0.01
"""Scatter that noise alone gives in fewer than one calibration of a hundred is called unexplained."""
_INSIDE = 0.975
"""Upper end of the 95 % that two standard uncertainties hold."""


@dataclass(frozen=True)
class Triad:
    """Of three channels: ``linear`` (3, p) the parameters before the division by the channel's scale,
    ``maps`` (3, p, m) from all m means to them, ``residuals`` (n, 3) of the positions in output units,
    ``keeps`` (3, n, n) from the positions' means to their residuals."""

    linear: Array
    maps: Array
    residuals: Array
    keeps: Array


def errors_of_means(triad: Triad, stated: Array, durations: Array, turns: int) -> Array:
    """``stated`` standard errors of the means, (m, 3); of a channel where one is missing, white noise as
    large as the positions' residuals show."""
    rest_s = durations[turns:]
    free = len(rest_s) - 4
    power = (rest_s[:, np.newaxis] * triad.residuals**2).sum(axis=0) / max(free, 1)
    from_scatter = np.sqrt((power if free else 0.0 * power) / durations[:, np.newaxis])
    return np.where(np.all(stated > 0.0, axis=0), stated, from_scatter)


@dataclass(frozen=True)
class Covariances:
    """Of a triad's linear parameters: ``linear`` (3, p, p). ``scatter``: how many times more the positions
    scatter than noise and drift explain, 1 where chance does as much. ``drift_seen``: a drift shows within
    the dwells."""

    linear: Array
    scatter: float
    drift_seen: bool


def covariance_of(
    triad: Triad,
    errors: Array,
    starts_s: Array,
    durations_s: Array,
    turns: int,
    noise: Sequence[NoiseModel] | None,
) -> Covariances:
    """Noise and drift through the maps.

    What the positions scatter more is taken as flicker from one datum to the next, turns and positions
    alike: dwells too short to show a drift within them show it so. Without ``noise``, or with all dwells at
    one time, it is noise of the positions, and counts where it is no chance.
    """
    count, rest = len(durations_s), slice(turns, None)
    flicker, walk = drift_covariances(starts_s, durations_s)
    drift = np.array([n.flicker**2 * flicker + n.walk**2 * walk for n in noise or (NoiseModel(),) * 3])
    scattered = _Scatter.of(triad, errors[rest], drift[:, rest, rest])
    scatter = scattered.beyond_chance()
    white = errors.copy()
    if noise is None or len(np.unique(starts_s[rest])) < count - turns:
        white[rest] *= scatter
    else:
        density = np.mean((errors[rest].T * np.sqrt(durations_s[rest])) ** 2, axis=1)
        more = density[:, np.newaxis, np.newaxis] * flicker
        drift = drift + scattered.excess(more[:, rest, rest]) * more
    mean = np.zeros(count)
    mean[rest] = durations_s[rest] / durations_s[rest].sum()
    covariance = []
    for linear_map, error, drifting in zip(triad.maps, white.T, drift, strict=True):
        # drift has no fixed zero: a sum's weights have to cancel, so the constant is that of the mean bias
        contrast = linear_map - np.outer(linear_map.sum(axis=1), mean)
        noisy = linear_map * error
        covariance.append(noisy @ noisy.T + contrast @ drifting @ contrast.T)
    seen = any(n.flicker or n.walk for n in noise or ())
    return Covariances(np.array(covariance), scatter, seen)


@dataclass(frozen=True)
class _Scatter:
    """The positions' residuals of three channels in coordinates of their own: ``values`` (3, f), with f = n −
    4, ``spread`` (3, f, f) what noise and drift let expect, ``bases`` (3, f, n) from the positions' means.
    f = 0: nothing can be told."""

    values: Array
    spread: Array
    bases: Array

    @classmethod
    def of(cls, triad: Triad, errors: Array, drift: Array) -> _Scatter:
        free = len(errors) - 4 if np.all((errors > 0.0) & np.isfinite(errors)) else 0
        kept = np.linalg.svd(triad.keeps)[0][:, :, :free]
        bases = np.swapaxes(kept, 1, 2) @ triad.keeps
        spread = np.array([np.diag(error**2) for error in errors.T]) + drift
        values = np.einsum("cnf,nc->cf", kept, triad.residuals)
        return cls(values, bases @ spread @ np.swapaxes(bases, 1, 2), bases)

    def beyond_chance(self) -> float:
        """√(χ²/f) of all three channels; 1 where that is no rare event, or cannot be told."""
        free = self.values.size
        if not free:
            return 1.0
        weighed = np.linalg.solve(self.spread, self.values[:, :, np.newaxis])[:, :, 0]
        square = float(np.sum(self.values * weighed))
        return float(np.sqrt(square / free)) if square > free and chi2.sf(square, free) < _RARE else 1.0

    def excess(self, more: Array) -> float:
        """How often ``more``, (3, n, n), has to be added to what is expected for χ² to be f (Mandel and
        Paule), widened for the few residuals that tell it (Student)."""
        free = self.values.size
        if not free:
            return 0.0
        squares, growths = [], []
        for value, spread, basis, added in zip(self.values, self.spread, self.bases, more, strict=True):
            growth, vectors = eigh(basis @ added @ basis.T, spread)
            squares.append((vectors.T @ value) ** 2)
            growths.append(np.maximum(growth, 0.0))
        square, growth = np.concatenate(squares), np.concatenate(growths)

        def over(share: float) -> float:
            return float(np.sum(square / (1.0 + share * growth))) - free

        if over(0.0) <= 0.0:
            return 0.0
        highest = 1.0 / float(growth.max())
        while over(highest) > 0.0 and highest < 1e30:
            highest *= 4.0
        share = float(brentq(over, 0.0, highest)) if over(highest) < 0.0 else highest
        return share * float(student.ppf(_INSIDE, free) / norm.ppf(_INSIDE)) ** 2


def after_division(linear: Array, channel: int, covariance: Array) -> Array:
    """The covariance after the division by the channel's scale: (M x y z, s …) → (M_ii, s/M_ii …, M_ij/M_ii
    of the two others)."""
    scale, count = linear[channel], len(linear)
    order = [channel, *range(3, count), *OTHERS[channel]]
    jacobian = np.zeros((count, count))
    for row, column in enumerate(order):
        jacobian[row, column] = 1.0 if row == 0 else 1.0 / scale
        if row:
            jacobian[row, channel] -= linear[column] / scale**2
    return np.asarray(jacobian @ covariance @ jacobian.T)


def deviations(covariance: Array) -> Array:
    """Square roots of the diagonals, shape (3, p)."""
    return np.sqrt(np.maximum(np.diagonal(covariance, axis1=-2, axis2=-1), 0.0))
