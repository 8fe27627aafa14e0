"""Covariance of a calibration set: the sensor's noise and drift through the linear map of all means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from ahrs_lab.metrology.imu_calibration import OTHERS
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, drift_covariances

Array = NDArray[np.float64]

_RARE = 0.01
"""Scatter that noise alone gives in fewer than one calibration of a hundred is called unexplained."""


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


def covariance_of(
    triad: Triad,
    errors: Array,
    starts_s: Array,
    durations_s: Array,
    turns: int,
    noise: Sequence[NoiseModel] | None,
) -> tuple[Array, float]:
    """Covariance (3, p, p) of the linear parameters, and by how much the positions' part was widened because
    their residuals show more than noise and drift explain (1: not)."""
    count = len(durations_s)
    drift = np.zeros((3, count, count))
    if noise is not None:
        flicker, walk = drift_covariances(starts_s, durations_s)
        drift = np.array([n.flicker**2 * flicker + n.walk**2 * walk for n in noise])
    widening = _unexplained(triad.keeps, triad.residuals, errors[turns:], drift[:, turns:, turns:])
    mean = np.zeros(count)
    mean[turns:] = durations_s[turns:] / durations_s[turns:].sum()
    wide = np.where(np.arange(count) < turns, 1.0, widening)
    covariance = []
    for linear_map, error, drifting in zip(triad.maps, errors.T, drift, strict=True):
        # drift has no fixed zero: a sum's weights have to cancel, so the constant is that of the mean bias
        contrast = (linear_map - np.outer(linear_map.sum(axis=1), mean)) * wide
        white = linear_map * wide * error
        covariance.append(white @ white.T + contrast @ drifting @ contrast.T)
    return np.array(covariance), widening


def _unexplained(keeps: Array, residuals: Array, errors: Array, drift: Array) -> float:
    """√(χ² of the positions' residuals over what noise and drift let expect), of all three channels; 1 where
    that is no rare event, or cannot be told."""
    free = 3 * (len(residuals) - 4)
    if free == 0 or not np.all(errors > 0.0):
        return 1.0
    spread = keeps @ (np.array([np.diag(error**2) for error in errors.T]) + drift)
    expected = float(np.sum(np.einsum("cij,cij->ci", spread, keeps).T / errors**2))
    ratio = float(np.sum((residuals / errors) ** 2)) / expected
    rare = ratio > 1.0 and chi2.sf(ratio * free, free) < _RARE
    return float(np.sqrt(ratio)) if rare else 1.0


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
