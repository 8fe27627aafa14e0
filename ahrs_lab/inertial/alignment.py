"""Self-alignment of a unit at rest: what it is made of, the coarse analytic method, and the limit of all
methods (2.5.2).

Arrays may carry leading axes "..." for many runs at once. Vectors of the navigation frame are east, north,
up; biases "in n" are the case's, turned into it, which is the same thing for a unit at rest.

The attitude error φ is the small rotation that takes the true attitude to the computed one:
``C' = (I + [φ×])·C``. Then (2-137) and (2-104) hold as printed, for a specific force that points up:
φ_E = ∇_N/g, φ_N = −∇_E/g, φ_U = ε_E/(ω_ie cos L) + φ_N tan L. The last term is −∇_E tan L/g; (2-104) prints
it with the opposite sign, which its own φ_N contradicts. (2-103) and (2-121) count φ the other way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ahrs_lab.inertial.attitude import attitude_angles_deg
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS

Array = NDArray[np.float64]
Orthogonalisation = Literal["rows", "columns", "svd"]


@dataclass(frozen=True)
class Place:
    """Where the unit stands: ``latitude_rad``, ``gravity_mps2``."""

    latitude_rad: float
    gravity_mps2: float

    @property
    def north_radps(self) -> float:
        """Horizontal part of the Earth's rate, ω_ie cos L."""
        return EARTH_RATE_RADPS * float(np.cos(self.latitude_rad))

    @property
    def up_radps(self) -> float:
        """Vertical part of the Earth's rate, ω_ie sin L."""
        return EARTH_RATE_RADPS * float(np.sin(self.latitude_rad))

    @property
    def earth_rate(self) -> Array:
        """Shape (3,), rad/s: (2-106)."""
        return np.array([0.0, self.north_radps, self.up_radps])


@dataclass(frozen=True)
class SensorNoise:
    """Random terms of a triad, each a number or shape (3,) by case axis, in its unit u (rad/s or m/s²).

    ``white`` N, u·√s; ``walk`` of the bias, u/√s; ``jitter``: white noise of the increments' sum (angle or
    velocity: quantisation, vibration), u·s.
    """

    white: ArrayLike = 0.0
    walk: ArrayLike = 0.0
    jitter: ArrayLike = 0.0

    def mean_variance(self, duration_s: float) -> Array:
        """Shape (3,): variance of a mean over ``duration_s``, against the bias at its beginning."""
        white, walk, jitter = self.variances()
        return np.asarray(white / duration_s + 2.0 * jitter / duration_s**2 + walk * duration_s / 3.0)

    def variances(self) -> Array:
        """Shape (3, 3): the squares of white, walk, jitter by case axis."""
        terms = [np.broadcast_to(x, 3) for x in (self.white, self.walk, self.jitter)]
        return np.array(terms, dtype=np.float64) ** 2


@dataclass(frozen=True)
class UnitModel:
    """What is known of the unit: standard deviation of the constant bias of each axis (rad/s, m/s²; an
    assumption, no static recording shows it) and its noise."""

    gyro_bias_radps: float
    accel_bias_mps2: float
    gyro_noise: SensorNoise = SensorNoise()
    accel_noise: SensorNoise = SensorNoise()

    def mean_covariance(self, C_bn: Array, duration_s: float) -> Array:
        """Shape (..., 6, 6): covariance, in n, of the errors of mean rate and mean specific force."""
        covariance = np.zeros((*C_bn.shape[:-2], 6, 6))
        for place, bias, noise in (
            (slice(0, 3), self.gyro_bias_radps, self.gyro_noise),
            (slice(3, 6), self.accel_bias_mps2, self.accel_noise),
        ):
            covariance[..., place, place] = turned(C_bn, bias**2 + noise.mean_variance(duration_s))
        return covariance


def turned(C_bn: Array, variances: Array) -> Array:
    """Shape (..., 3, 3): the covariance in n of independent errors of the case's axes, variances (3,)."""
    return np.asarray((C_bn * variances) @ np.swapaxes(C_bn, -1, -2), dtype=np.float64)


def limit_matrix(place: Place) -> Array:
    """Shape (3, 6): (2-104), φ of ε_E, ε_N, ε_U, ∇_E, ∇_N, ∇_U (rad/s, m/s²)."""
    matrix = np.zeros((3, 6))
    matrix[0, 4] = 1.0 / place.gravity_mps2
    matrix[1, 3] = -1.0 / place.gravity_mps2
    matrix[2, 0] = 1.0 / place.north_radps
    matrix[2, 3] = -np.tan(place.latitude_rad) / place.gravity_mps2
    return matrix


def attitude_limit_rad(place: Place, unit: UnitModel) -> Array:
    """Shape (3,): standard deviation of φ_E, φ_N, φ_U by (2-104) for the unit's biases alone."""
    deviations = np.repeat([unit.gyro_bias_radps, unit.accel_bias_mps2], 3)
    return np.asarray(np.linalg.norm(limit_matrix(place) * deviations, axis=1))


def angle_matrix(C_bn: Array) -> Array:
    """Shape (..., 3, 3): errors of heading, pitch, roll (rad) of φ."""
    heading, pitch, _ = (np.radians(angle) for angle in attitude_angles_deg(C_bn))
    sine, cosine = np.sin(heading), np.cos(heading)
    matrix = np.zeros((*heading.shape, 3, 3))
    matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 0, 2] = (
        sine * np.tan(pitch),
        cosine * np.tan(pitch),
        -1.0,
    )
    matrix[..., 1, 0], matrix[..., 1, 1] = cosine, -sine
    matrix[..., 2, 0], matrix[..., 2, 1] = sine / np.cos(pitch), cosine / np.cos(pitch)
    return matrix


def small_rotation(C_from: Array, C_to: Array) -> Array:
    """Shape (..., 3): the rotation vector, to second order, that takes one attitude to the other."""
    turn = 0.5 * (C_to @ np.swapaxes(C_from, -1, -2))
    return np.stack([turn[..., j, i] - turn[..., i, j] for i, j in ((1, 2), (2, 0), (0, 1))], axis=-1)


@dataclass(frozen=True)
class CoarseAlignment:
    """``C_bn`` (..., 3, 3); ``covariance`` of φ (..., 3, 3), rad²."""

    C_bn: Array
    covariance: Array


def coarse_alignment(
    rate: Array,
    force: Array,
    duration_s: float,
    place: Place,
    unit: UnitModel,
    orthogonalisation: Orthogonalisation = "rows",
) -> CoarseAlignment:
    """From mean rate and specific force, shape (..., 3), over ``duration_s``.

    The covariance carries the errors of both means through the method, whichever orthogonalisation it ends
    with.
    """
    make_orthogonal = ORTHOGONALISATIONS[orthogonalisation]
    C_bn = make_orthogonal(analytic_matrix(rate, force, place))
    sensitivity = np.zeros((*rate.shape[:-1], 3, 6))
    for index in range(6):
        # steps by which the attitude turns about a thousandth of a degree
        step = 1e-5 * (EARTH_RATE_RADPS if index < 3 else place.gravity_mps2)
        off = step * C_bn[..., index % 3, :]
        ends = []
        for sign in (1.0, -1.0):
            moved = (rate + sign * off, force) if index < 3 else (rate, force + sign * off)
            ends.append(small_rotation(C_bn, make_orthogonal(analytic_matrix(*moved, place))))
        sensitivity[..., index] = (ends[0] - ends[1]) / (2.0 * step)
    means = unit.mean_covariance(C_bn, duration_s)
    return CoarseAlignment(C_bn, sensitivity @ means @ np.swapaxes(sensitivity, -1, -2))


def analytic_matrix(rate: Array, force: Array, place: Place) -> Array:
    """Shape (..., 3, 3): C_bn by (2-113), (2-114), not yet orthogonal."""
    gravity, north = place.gravity_mps2, place.north_radps
    down = -force
    m = np.cross(down, rate)
    return np.stack(
        [
            m / (gravity * north),
            down * np.tan(place.latitude_rad) / gravity + rate / north,
            -down / gravity,
        ],
        axis=-2,
    )


def by_rows(matrix: Array) -> Array:
    """Gram–Schmidt over the rows, up first: up is the accelerometers' alone, and by far the best known."""
    up = _unit(matrix[..., 2, :])
    north = matrix[..., 1, :]
    north = _unit(north - np.sum(north * up, axis=-1, keepdims=True) * up)
    return np.stack([np.cross(north, up), north, up], axis=-2)


def by_columns(matrix: Array) -> Array:
    """(2-115)–(2-120): Gram–Schmidt over the columns in their order, then made of length 1. The gyros' error
    comes into level."""
    first = _unit(matrix[..., :, 0])
    second = matrix[..., :, 1]
    second = _unit(second - np.sum(second * first, axis=-1, keepdims=True) * first)
    return np.stack([first, second, np.cross(first, second)], axis=-1)


def by_svd(matrix: Array) -> Array:
    """The orthogonal matrix nearest to it. Half the gyros' error comes into level."""
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right, dtype=np.float64)


ORTHOGONALISATIONS: dict[Orthogonalisation, Callable[[Array], Array]] = {
    "rows": by_rows,
    "columns": by_columns,
    "svd": by_svd,
}


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True), dtype=np.float64)
