"""Fine alignment: least squares over time (2-121)–(2-135).

In the frame that a first attitude computes, the specific force's horizontal parts show the tilt (2-127) and
the integrated rate's eastern part grows with the heading error (2-131). Lines are fitted to both. Reported is
the attitude in the middle of the record, the best known point of a line: a unit at rest has one attitude.

Signs are those of :mod:`ahrs_lab.inertial.alignment`: δf_E = g φ_N, δf_N = −g φ_E,
ω_E = φ_N ω_ie sin L − φ_U ω_ie cos L.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.alignment import Place, UnitModel, limit_matrix, turned
from ahrs_lab.inertial.alignment_steps import Steps
from ahrs_lab.inertial.attitude import rotation_from_vector

Array = NDArray[np.float64]

_PASSES = 3
"""φ is small against the first attitude, not zero: the second pass starts from the first one's result."""
_FEWEST_STEPS = 5
_SLOPE_WHITE = 6.0 / 5.0
"""Variance of a line's slope through the integral of white noise N, over N²/T."""
_SLOPE_WALK = 13.0 / 35.0
"""The same for a random walk K of the rate, against the rate at the beginning, over K²T."""


@dataclass(frozen=True)
class FineAlignment:
    """``C_bn`` (..., 3, 3) and ``covariance`` of φ (..., 3, 3), rad², of the whole record. ``t_s`` (p,),
    ``attitudes`` (..., p, 3, 3), ``covariances`` (..., p, 3, 3): the same from the record up to then.
    ``tilt_rate`` (..., 2) is the slope of φ_E and φ_N, rad/s, ``tilt_rate_deviation`` its standard
    deviation."""

    C_bn: Array
    covariance: Array
    t_s: Array
    attitudes: Array
    covariances: Array
    tilt_rate: Array
    tilt_rate_deviation: Array


def fine_alignment(steps: Steps, first: Array, place: Place, unit: UnitModel) -> FineAlignment:
    """From the attitude ``first``, shape (..., 3, 3), near enough that its error is small.

    Raises ValueError for fewer than five steps.
    """
    if len(steps) < _FEWEST_STEPS:
        raise ValueError(f"a line in time needs {_FEWEST_STEPS} steps, there are {len(steps)}")
    C_bn = first
    for _ in range(_PASSES):
        phi, tilt_rate = _fit(steps, C_bn, place)
        computed, C_bn = C_bn, rotation_from_vector(-phi[..., -1, :]) @ C_bn
    t_s = steps.end_s
    attitudes = rotation_from_vector(-phi) @ computed[..., np.newaxis, :, :]
    covariances = _covariances(t_s, float(np.mean(steps.duration_s)), C_bn, place, unit)
    shown = slice(_FEWEST_STEPS - 1, None)
    level = turned(C_bn, unit.accel_noise.mean_variance(float(t_s[-1])))
    deviation = np.sqrt(12.0 * np.stack([level[..., 1, 1], level[..., 0, 0]], axis=-1)) / t_s[-1]
    return FineAlignment(
        C_bn,
        covariances[..., -1, :, :],
        t_s[shown],
        attitudes[..., shown, :, :],
        covariances[..., shown, :, :],
        tilt_rate,
        deviation / place.gravity_mps2,
    )


def _fit(steps: Steps, computed: Array, place: Place) -> tuple[Array, Array]:
    """φ from the record up to the end of each step, (..., k, 3), and the slope of the tilts, (..., 2)."""
    force = steps.force @ np.swapaxes(computed, -1, -2)
    rate = steps.rate @ np.swapaxes(computed, -1, -2) - place.earth_rate
    end, length = steps.end_s, steps.duration_s
    tilt = np.stack([-force[..., 1], force[..., 0]], axis=-1) / place.gravity_mps2
    angle = np.cumsum(rate[..., 0] * length, axis=-1)
    middle, _ = _lines(end - 0.5 * length, length, tilt)
    _, slope = _lines(end, length, angle[..., np.newaxis])
    _, tilt_rate = _lines(end - 0.5 * length, length, tilt)
    heading = (middle[..., 1] * place.up_radps - slope[..., 0]) / place.north_radps
    return np.concatenate([middle, heading[..., np.newaxis]], axis=-1), tilt_rate[..., -1, :]


def _lines(t: Array, weight: Array, y: Array) -> tuple[Array, Array]:
    """Mean and slope of the lines through the first 1, 2, … points, (..., k, m) each, weighted by (k,)."""
    w, t = weight[:, np.newaxis], (t - t.mean())[:, np.newaxis]
    total, first, second = (np.cumsum(part, axis=0) for part in (w, w * t, w * t * t))
    level = np.cumsum(w * y, axis=-2)
    moment = np.cumsum(w * t * y, axis=-2)
    spread = second - first**2 / total
    spread[0] = np.inf  # one point has no slope
    return level / total, (moment - first * level / total) / spread


def _covariances(t_s: Array, step_s: float, C_bn: Array, place: Place, unit: UnitModel) -> Array:
    """Of φ from the record up to each of ``t_s``, (..., k, 3, 3): (2-104) for the assumed biases and for the
    noise of mean and slope."""
    gyro, accel = unit.gyro_noise.variances(), unit.accel_noise.variances()
    t = t_s[:, np.newaxis]
    rate = (
        unit.gyro_bias_radps**2
        + _SLOPE_WHITE * gyro[0] / t
        + _SLOPE_WALK * gyro[1] * t
        + 12.0 * gyro[2] * step_s / t**3
    )
    force = unit.accel_bias_mps2**2 + accel[0] / t + accel[1] * t / 3.0 + 2.0 * accel[2] / t**2
    limit, across = limit_matrix(place), C_bn[..., np.newaxis, :, :]
    return np.asarray(
        limit[:, :3] @ turned(across, rate[:, np.newaxis, :]) @ limit[:, :3].T
        + limit[:, 3:] @ turned(across, force[:, np.newaxis, :]) @ limit[:, 3:].T,
        dtype=np.float64,
    )
