"""Alignment by Kalman filter: closed loop, 10 states (2-136), and open loop, 8 states (2-137)–(2-139).

State: φ (3, rad), ε in n (3, rad/s), ∇_E, ∇_N (m/s²), and in the closed loop δv_E, δv_N (m/s). The gyros
carry a computed attitude along. Open: it is left alone, its error is the state, and the horizontal specific
force in its frame is the measurement. Closed: what has been estimated is taken out of the attitude, the
velocity and the sensors after each step, and that the velocity should be zero is the measurement. On a base
that vibrates this knows more: the open loop takes what vibration leaves in each step for white noise.

The filter starts from a coarse alignment on the first part of the record and uses only what comes after it.
That attitude's error is made of the very biases that are states (2-104): the initial covariance says so. What
cannot be told at rest (ε_E, ∇_E, ∇_N) then keeps its assumed deviation, and the attitude carries it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from ahrs_lab.inertial.alignment import Place, UnitModel, limit_matrix, turned
from ahrs_lab.inertial.alignment_steps import Steps
from ahrs_lab.inertial.attitude import rotation_from_vector, skew
from ahrs_lab.inertial.earth import meridian_radius_m, transverse_radius_m

Array = NDArray[np.float64]

OPEN_STATES = 8
CLOSED_STATES = 10
PHI, EPSILON, NABLA, VELOCITY = slice(0, 3), slice(3, 6), slice(6, 8), slice(8, 10)

_VELOCITY_FLOOR = 0.3
"""Deviation of the zero-velocity measurement over the accelerometers' own noise in one step, where nothing
vibrates: small enough to cost nothing, large enough to keep the covariance well conditioned."""

_SMALLEST_VARIANCE = 1e-18
"""m²/s² and m²/s⁴; for sensors without any noise."""


@dataclass(frozen=True)
class KalmanAlignment:
    """``C_bn`` (..., 3, 3) at the end; ``bias`` (..., 5): ε_E, ε_N, ε_U, ∇_E, ∇_N; ``covariance`` of φ and
    these (..., 8, 8).

    ``t_s`` (p,): the start and each step's end, from the first used row on; ``attitudes`` (..., p, 3, 3),
    ``attitude_covariances`` (..., p, 3, 3), ``biases`` and ``bias_deviations`` (..., p, 5).
    """

    C_bn: Array
    bias: Array
    covariance: Array
    t_s: Array
    attitudes: Array
    attitude_covariances: Array
    biases: Array
    bias_deviations: Array


def kalman_alignment(
    steps: Steps, first: Array, first_s: float, place: Place, unit: UnitModel, *, closed: bool
) -> KalmanAlignment:
    """``first`` (..., 3, 3) is the coarse attitude (rows orthogonalised) of the ``first_s`` seconds right
    before ``steps``."""
    run = _Filter(first, first_s, place, unit, closed)
    history = [run.now()]
    for index, duration in enumerate(steps.duration_s):
        run.step(float(duration), steps.turn[..., index, :, :], steps.velocity[..., index, :])
        history.append(run.now())
    attitudes, covariances, biases, deviations = zip(*history, strict=True)
    return KalmanAlignment(
        C_bn=attitudes[-1],
        bias=biases[-1],
        covariance=run.covariance,
        t_s=first_s + np.concatenate(([0.0], steps.end_s)),
        attitudes=np.stack(attitudes, axis=-3),
        attitude_covariances=np.stack(covariances, axis=-3),
        biases=np.stack(biases, axis=-2),
        bias_deviations=np.stack(deviations, axis=-2),
    )


class _Filter:
    """The running filter: ``x`` (..., n), ``P`` (..., n, n), computed attitude ``C`` and velocity ``v``."""

    def __init__(self, first: Array, first_s: float, place: Place, unit: UnitModel, closed: bool) -> None:
        self._place, self._unit, self._closed = place, unit, closed
        self._shake = turned(first, unit.gyro_noise.variances()[2])
        """Of the instantaneous attitude about its mean."""
        self._size = CLOSED_STATES if closed else OPEN_STATES
        runs = first.shape[:-2]
        self.C = first
        self.v = np.zeros((*runs, 3))
        self.x = np.zeros((*runs, self._size))
        self.P = self._initial(first, first_s)
        self._bias = np.zeros((*runs, 5))
        """Taken out already, closed loop."""
        self._transport = transport(place)
        self._F = dynamics(place)[: self._size, : self._size]
        self._density = self._noise_density(first)
        self._transitions: dict[float, tuple[Array, Array]] = {}

    def now(self) -> tuple[Array, Array, Array, Array]:
        """Attitude, its covariance, biases, their deviations, all that was estimated put in."""
        attitude = rotation_from_vector(-self.x[..., PHI]) @ self.C
        # without any noise rounding may leave a variance just below zero
        variances = np.maximum(np.diagonal(self.P, axis1=-2, axis2=-1)[..., 3:8], 0.0)
        deviations = np.sqrt(variances)
        return attitude, self.P[..., PHI, PHI] + self._shake, self._bias + self.x[..., 3:8], deviations

    @property
    def covariance(self) -> Array:
        """Shape (..., 8, 8): of the attitude at this instant and the biases."""
        P = self.P[..., :OPEN_STATES, :OPEN_STATES].copy()
        P[..., PHI, PHI] += self._shake
        return P

    def step(self, dt: float, turn: Array, velocity: Array) -> None:
        """One step of the strapdown, the prediction, the measurement."""
        push = self._strapdown(dt, turn, velocity)
        transition, noise = self._transition(dt)
        self.x = _times(transition, self.x)
        self.P = transition @ self.P @ transition.T + noise
        if self._closed:
            self.P[..., VELOCITY, VELOCITY] += self._shaken_force() * dt**2
        if self._closed:
            H = np.eye(self._size)[VELOCITY]
            self._update(self.v[..., :2], H, self._velocity_variance(dt))
            self._feed_back()
        else:
            # the mean over the step belongs to its middle
            H = measured_force(self._place.gravity_mps2) @ (np.eye(self._size) - 0.5 * dt * self._F)
            self._update(push[..., :2] / dt, H, self._force_variance(dt))

    def _strapdown(self, dt: float, turn: Array, velocity: Array) -> Array:
        """Velocity gained over the step in n, m/s, gravity taken out; carries ``C`` and ``v`` on."""
        place = self._place
        earth = place.earth_rate
        # n turns with the Earth, and so does the case; the increments are in the case at the step's beginning
        push = _times(np.eye(3) - 0.5 * dt * skew(earth), _times(self.C, velocity))
        push = push - np.array([0.0, 0.0, place.gravity_mps2 * dt])
        push[..., :2] -= self._bias[..., 3:5] * dt
        rate = earth + _times(self._transport, self.v) + self._bias[..., :3]
        if self._closed:
            self.v = self.v + push - dt * np.cross(2.0 * earth, self.v)
            self.v[..., 2] = 0.0
        self.C = rotation_from_vector(-rate * dt) @ self.C @ turn
        return np.asarray(push, dtype=np.float64)

    def _transition(self, dt: float) -> tuple[Array, Array]:
        """Φ and the process noise of ``dt`` (Van Loan), made once for steps of the same length."""
        key = round(dt, 4)
        if key not in self._transitions:
            n = self._size
            block = np.zeros((*self._density.shape[:-2], 2 * n, 2 * n))
            block[..., :n, :n] = -self._F
            block[..., :n, n:] = self._density
            block[..., n:, n:] = self._F.T
            grown = expm(block * dt)
            transition = expm(self._F * dt)
            noise = transition @ grown[..., :n, n:]
            self._transitions[key] = transition, 0.5 * (noise + np.swapaxes(noise, -1, -2))
        return self._transitions[key]

    def _update(self, z: Array, H: Array, R: Array) -> None:
        """Joseph's form: the covariance stays that of the error for whatever gain rounding leaves."""
        cross = self.P @ H.T
        gain = np.swapaxes(np.linalg.solve(H @ cross + R, np.swapaxes(cross, -1, -2)), -1, -2)
        self.x = self.x + _times(gain, z - _times(H, self.x))
        keep = np.eye(self._size) - gain @ H
        P = keep @ self.P @ np.swapaxes(keep, -1, -2) + gain @ R @ np.swapaxes(gain, -1, -2)
        self.P = 0.5 * (P + np.swapaxes(P, -1, -2))

    def _feed_back(self) -> None:
        back = rotation_from_vector(-self.x[..., PHI])
        self.C = back @ self.C
        # the biases are the case's: they turn with the attitude that is set right
        self._bias[..., :3] = _times(back, self._bias[..., :3])
        self._bias[..., 3:] = _times(back[..., :2, :2], self._bias[..., 3:])
        self._bias += self.x[..., 3:8]
        self.v[..., :2] -= self.x[..., VELOCITY]
        self.x = np.zeros_like(self.x)

    def _initial(self, C_bn: Array, first_s: float) -> Array:
        unit, limit = self._unit, limit_matrix(self._place)
        bias = np.diag(np.repeat([unit.gyro_bias_radps, unit.accel_bias_mps2], 3)) ** 2
        states = np.concatenate([limit, np.eye(6)[:5]])
        P = np.zeros((*C_bn.shape[:-2], self._size, self._size))
        P[..., :8, :8] = states @ bias @ states.T
        noise = unit.mean_covariance(C_bn, first_s) - bias
        # a base that vibrates has some angle and velocity at the start, which the means before it end with
        ends = -limit[:, :3] @ self._shake / first_s
        P[..., PHI, PHI] += limit @ noise @ limit.T + self._shake + ends + np.swapaxes(ends, -1, -2)
        if self._closed:
            velocity = self._velocity_variance(0.0)
            P[..., VELOCITY, VELOCITY] = velocity
            P[..., PHI, VELOCITY] = -limit[:, 3:5] @ velocity / first_s
            P[..., VELOCITY, PHI] = np.swapaxes(P[..., PHI, VELOCITY], -1, -2)
        return P

    def _noise_density(self, C_bn: Array) -> Array:
        gyro, accel = self._unit.gyro_noise.variances(), self._unit.accel_noise.variances()
        density = np.zeros((*C_bn.shape[:-2], self._size, self._size))
        density[..., PHI, PHI] = turned(C_bn, gyro[0])
        density[..., EPSILON, EPSILON] = turned(C_bn, gyro[1])
        density[..., NABLA, NABLA] = turned(C_bn, accel[1])[..., :2, :2]
        if self._closed:
            density[..., VELOCITY, VELOCITY] = turned(C_bn, accel[0])[..., :2, :2]
        return density

    def _force_variance(self, dt: float) -> Array:
        white, _, jitter = self._unit.accel_noise.variances()
        variance = turned(self.C, white / dt + 2.0 * jitter / dt**2)[..., :2, :2]
        return np.asarray(variance + self._shaken_force() + _SMALLEST_VARIANCE * np.eye(2), dtype=np.float64)

    def _velocity_variance(self, dt: float) -> Array:
        white, _, jitter = self._unit.accel_noise.variances()
        variance = turned(self.C, jitter + _VELOCITY_FLOOR**2 * white * dt)[..., :2, :2]
        return np.asarray(variance + _SMALLEST_VARIANCE * np.eye(2), dtype=np.float64)

    def _shaken_force(self) -> Array:
        """Variance of the horizontal specific force by the shake of the attitude it is seen in."""
        seen = measured_force(self._place.gravity_mps2)[:, PHI]
        return np.asarray(seen @ self._shake @ seen.T, dtype=np.float64)


def dynamics(place: Place) -> Array:
    """Shape (10, 10): the error equations at rest, (2-137) with the velocity's part of 2.4.5; the upper left
    8×8 are those of the open loop."""
    g, up = place.gravity_mps2, place.up_radps
    F = np.zeros((CLOSED_STATES, CLOSED_STATES))
    F[PHI, PHI] = -skew(place.earth_rate)
    F[PHI, EPSILON] = np.eye(3)
    F[PHI, VELOCITY] = -transport(place)[:, :2]
    F[8, 1], F[9, 0] = g, -g
    F[VELOCITY, NABLA] = np.eye(2)
    F[8, 9], F[9, 8] = 2.0 * up, -2.0 * up
    return F


def measured_force(gravity_mps2: float) -> Array:
    """Shape (2, 8): (2-139) with the signs of a specific force that points up."""
    H = np.zeros((2, OPEN_STATES))
    H[0, 1], H[1, 0] = gravity_mps2, -gravity_mps2
    H[0, 6] = H[1, 7] = 1.0
    return H


def transport(place: Place) -> Array:
    """Shape (3, 3): turning of n, rad/s, by velocity, (2-43)."""
    latitude = np.degrees(place.latitude_rad)
    across = 1.0 / float(transverse_radius_m(latitude))
    matrix = np.zeros((3, 3))
    matrix[0, 1] = -1.0 / float(meridian_radius_m(latitude))
    matrix[1, 0], matrix[2, 0] = across, across * np.tan(place.latitude_rad)
    return matrix


def _times(matrix: Array, vector: Array) -> Array:
    return np.asarray((matrix @ vector[..., np.newaxis])[..., 0], dtype=np.float64)
