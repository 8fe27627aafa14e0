"""Alignment of a unit against a reference inertial system on the same carrier (2.5.3).

Closed loop: the unit navigates from its own increments to the next instant of comparison, the difference to
the reference updates the errors of :mod:`~ahrs_lab.inertial.transfer_alignment_model`, and what was found is
taken out of the unit's state and sensors at once. So the model stays linear also where misalignments are
degrees at first.

What is shown as misalignment is not the small remainder in the loop, but that of the unit as it would have
gone on by itself: its attitude from the start, carried on with its own uncorrected rates in the reference's
frame, against the attitude found.

All arrays have a leading dimension b of units side by side; a real unit is b = 1, statistics take hundreds
at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.attitude import rotation_from_vector
from ahrs_lab.inertial.transfer_alignment_model import (
    ACCEL_BIAS,
    ACCEL_SCALE,
    AT_START,
    AZIMUTH,
    EARTH_RADIUS_M,
    GYRO_BIAS,
    GYRO_SCALE,
    LATITUDE,
    LONGITUDE,
    METHODS,
    MOUNTING,
    PHI,
    SIZE,
    VELOCITY,
    Assumptions,
    Method,
    MethodName,
    azimuth_share,
    comparison_matrix,
    discrete,
    error_matrix,
    prior_covariance,
    tilt_share,
)
from ahrs_lab.inertial.transfer_alignment_motion import (
    Increments,
    Motion,
    Window,
    advance,
    moved,
    running_product,
)

Array = NDArray[np.float64]

LONGEST_WINDOW_S = 2.0
"""Comparisons further apart are reached in steps: the error model is a series in the length of a step."""


@dataclass(frozen=True)
class Reference:
    """m instants: ``t_s`` (m,), ``velocity`` (b, m, 3), ``latitude``, ``longitude`` rad and ``altitude`` m
    (b, m), ``C_bn`` (b, m, 3, 3) or None; b = 1 is the same for all units."""

    t_s: Array
    velocity: Array
    latitude: Array
    longitude: Array
    altitude: Array
    C_bn: Array | None = None

    def at(self, row: int) -> Motion:
        """The state at one instant; the attitude is the unit matrix where it is not known."""
        C = np.broadcast_to(np.eye(3), (1, 3, 3)) if self.C_bn is None else self.C_bn[:, row]
        return Motion(
            C, self.velocity[:, row], self.latitude[:, row], self.longitude[:, row], self.altitude[:, row]
        )


@dataclass(frozen=True)
class Start:
    """The unit's state at ``t_s``. ``copied``: its attitude is the reference's (one-shot transfer), so that
    its misalignment is how the two cases are mounted, and nothing else."""

    t_s: float
    motion: Motion
    copied: bool


@dataclass(frozen=True)
class TransferAlignment:
    """k comparisons of b units.

    ``t_s`` (k,); ``misalignment`` and ``misalignment_u`` (b, k, 3) rad about east, north, up; ``estimate``
    and ``estimate_u`` (b, k, 39): sensors' errors, mounting and azimuth offset found so far, and the
    standard uncertainty of every state (NaN where the method has it not); ``innovation``, ``innovation_u``
    (b, k, q), NaN where not compared; ``nis`` (b, k), ``compared`` (k,) how many numbers. At the end:
    ``motion``, ``mounting`` (b, 3, 3) C_b^a, ``covariance`` (b, n, n) of ``method.states``. At the start, as
    the end lets it be seen: ``misalignment_at_start`` and its uncertainty (b, 3). ``prior_u``
    (n,), and ``information`` (e, e) that the comparisons hold of the estimated states at the start, in units
    of the prior's."""

    method: Method
    t_s: Array
    misalignment: Array
    misalignment_u: Array
    estimate: Array
    estimate_u: Array
    innovation: Array
    innovation_u: Array
    nis: Array
    compared: NDArray[np.int64]
    motion: Motion
    mounting: Array
    covariance: Array
    misalignment_at_start: Array
    misalignment_at_start_u: Array
    prior_u: Array
    information: Array


def align(
    unit: Increments,
    reference: Reference,
    start: Start,
    method: MethodName,
    assumed: Assumptions,
    lever: Array | None = None,
) -> TransferAlignment:
    """Run the filter over all instants of ``reference`` after the start.

    Each of them has to be the end of one of the unit's intervals. ``lever`` (3,): the unit's place from the
    reference's, m, along the unit's axes. Raises ValueError where no instant is left.
    """
    filter_ = _Filter(METHODS[method], unit, start, assumed, lever)
    ends = np.searchsorted(unit.t_s, reference.t_s - 1e-6)
    rows = np.flatnonzero((reference.t_s > start.t_s + 1e-6) & (ends < len(unit.t_s)))
    if not len(rows):
        raise ValueError("no instant of the reference lies within the unit's record")
    for row in rows:
        filter_.step(int(ends[row]) + 1, reference.at(int(row)), float(reference.t_s[row]))
    return filter_.finished()


class _Filter:
    """The loop's state. ``found`` (b, 39) holds the totals fed back so far; ``P`` belongs to what is left."""

    def __init__(
        self, method: Method, unit: Increments, start: Start, assumed: Assumptions, lever: Array | None
    ) -> None:
        self.lever = lever
        self.method, self.unit, self.assumed = method, unit.compensated(), assumed
        self.states = np.array(method.states)
        self.estimated = len(method.estimated)
        self.considered = slice(self.estimated, self.estimated + len(method.considered))
        b = max(len(unit.angle_rad), len(start.motion.C_bn))
        self.motion = _spread(start.motion, b)
        self.alone = self.motion.C_bn
        self.found = np.zeros((b, SIZE))
        self.mounting = self.start = np.broadcast_to(np.eye(3), (b, 3, 3))
        self.next = int(np.searchsorted(unit.t_s, start.t_s + 1e-6))
        full = prior_covariance(self.motion, assumed, start.copied, method)
        self.P = full[:, self.states[:, np.newaxis], self.states]
        self.prior_u = np.sqrt(np.diagonal(self.P[0]))
        noise = np.zeros(SIZE)
        noise[PHI] = assumed.angle_random_walk**2
        noise[VELOCITY] = assumed.velocity_random_walk**2
        self.noise = noise[self.states]
        self.since_start = np.eye(len(self.states))
        self.information = np.zeros((self.estimated, self.estimated))
        self.log: list[tuple[object, ...]] = []

    def step(self, stop: int, reference: Motion, t_s: float) -> None:
        """To the end of the unit's row ``stop`` − 1, and compare there."""
        while self.next < stop:
            far = np.searchsorted(self.unit.t_s, self.unit.t_s[self.next] + LONGEST_WINDOW_S)
            self._propagate(min(stop, max(int(far), self.next + 1)))
        if self.lever is not None:
            rate = self.unit.angle_rad[:, stop - 1] / self.unit.interval_s[stop - 1]
            reference = carried_over(reference, self.motion.C_bn, rate, self.lever)
        self.motion = self._tied(self.motion, reference)
        compares = self._compared(reference)
        z, H, R = self._difference(reference, compares)
        self._observe(H[0], R[0])
        nis, u = self._update(z, H, R)
        self._keep(t_s, z, u, nis, compares)

    def _propagate(self, stop: int) -> None:
        window = self._advance(stop)
        F = error_matrix(window, self.motion.latitude, self.motion.altitude)
        F = F[:, self.states[:, np.newaxis], self.states]
        Phi, Q = discrete(F, self.noise, window.duration_s)
        self.P = Phi @ self.P @ Phi.mT + Q
        self.since_start = Phi[0] @ self.since_start
        self.motion = window.motion

    def _advance(self, stop: int) -> Window:
        rows = slice(self.next, stop)
        self.next = stop
        interval = self.unit.interval_s[rows]
        angle, velocity = self.unit.angle_rad[:, rows], self.unit.velocity_mps[:, rows]
        step = interval[:, np.newaxis]
        found = self.found[:, np.newaxis]
        right_angle = (angle - found[..., GYRO_BIAS] * step) / (1 + found[..., GYRO_SCALE])
        right_velocity = (velocity - found[..., ACCEL_BIAS] * step) / (1 + found[..., ACCEL_SCALE])
        window = advance(self.motion, right_angle, right_velocity, interval)
        frame = rotation_from_vector(-window.frame_rate * window.duration_s)
        self.alone = frame @ self.alone @ running_product(rotation_from_vector(angle))[:, -1]
        return window

    def _tied(self, motion: Motion, reference: Motion) -> Motion:
        """What the method has no state for is the reference's: height and climb always (the vertical channel
        is unstable alone), latitude and longitude where they are no states."""
        b = len(motion.C_bn)
        tied = _spread(reference, b)
        velocity = motion.velocity
        if VELOCITY.stop - 1 not in self.states:
            velocity = np.concatenate([velocity[:, :2], tied.velocity[:, 2:]], axis=1)
        return Motion(
            motion.C_bn,
            velocity,
            motion.latitude if LATITUDE in self.states else tied.latitude,
            motion.longitude if LONGITUDE in self.states else tied.longitude,
            tied.altitude,
        )

    def _compared(self, reference: Motion) -> tuple[int, ...]:
        """Azimuth only in nearly level flight."""
        up, forward = reference.C_bn[0, 2, 2], reference.C_bn[0, 2, 1]
        level = min(up, np.cos(np.arcsin(np.clip(forward, -1, 1)))) > np.cos(self.assumed.level_limit)
        return tuple(one for one in self.method.compares if one != 5 or level)

    def _difference(self, reference: Motion, compares: tuple[int, ...]) -> tuple[Array, Array, Array]:
        """z (b, q) unit minus reference, H (b, q, n), R (b, q, q)."""
        assumed, motion = self.assumed, self.motion
        b = len(motion.C_bn)
        z = np.zeros((b, 9))
        z[:, :3] = motion.velocity - reference.velocity
        z[:, 3] = motion.latitude - reference.latitude
        z[:, 4] = motion.longitude - reference.longitude
        if self.method.needs_attitude:
            z[:, 5] = _wrapped(
                _azimuth(motion.C_bn)
                - _azimuth(reference.C_bn)
                - self.found[:, AZIMUTH] * azimuth_share(motion.C_bn)
                - _rotation_vector(reference.C_bn.mT @ motion.C_bn)[:, 0] * tilt_share(motion.C_bn)
            )
            z[:, 6:] = _rotation_vector(motion.C_bn @ (reference.C_bn @ self.mounting).mT)
        metre = 1 / EARTH_RADIUS_M
        around = metre / np.cos(motion.latitude[0])
        sigma = np.array(
            [
                *(3 * [assumed.velocity_noise]),
                *(assumed.position_noise_m * metre, assumed.position_noise_m * around),
                *(4 * [assumed.attitude_noise]),
            ]
        )
        rows = np.array(compares)
        H = comparison_matrix(motion.C_bn)[:, rows[:, np.newaxis], self.states]
        R = np.broadcast_to(np.diag(sigma[rows] ** 2), (b, len(rows), len(rows)))
        return z[:, rows], H, R

    def _observe(self, H: Array, R: Array) -> None:
        """Add what this comparison tells of the estimated states at the start, each in units of its prior."""
        e = self.estimated
        seen = (H @ self.since_start)[:, :e] * self.prior_u[:e] / np.sqrt(np.diagonal(R))[:, np.newaxis]
        self.information = self.information + seen.T @ seen

    def _update(self, z: Array, H: Array, R: Array) -> tuple[Array, Array]:
        """Joseph's form, which also holds for the gain that leaves the considered states alone."""
        S = H @ self.P @ H.mT + R
        K = np.linalg.solve(S, H @ self.P).mT.copy()
        K[:, self.considered] = 0.0
        left = np.eye(len(self.states)) - K @ H
        self.P = left @ self.P @ left.mT + K @ R @ K.mT
        self._feed_back(np.einsum("bij,bj->bi", K, z))
        nis = np.einsum("bi,bi->b", z, np.linalg.solve(S, z[..., np.newaxis])[..., 0])
        return nis, np.sqrt(np.diagonal(S, axis1=1, axis2=2))

    def _feed_back(self, x: Array) -> None:
        full = np.zeros_like(self.found)
        full[:, self.states] = x
        motion = self.motion
        self.motion = Motion(
            rotation_from_vector(full[:, PHI]) @ motion.C_bn,
            motion.velocity - full[:, VELOCITY],
            motion.latitude - full[:, LATITUDE],
            motion.longitude - full[:, LONGITUDE],
            motion.altitude,
        )
        self.mounting = self.mounting @ rotation_from_vector(full[:, MOUNTING])
        self.found = self.found + full
        self.found[:, MOUNTING] = _rotation_vector(self.mounting)
        self.start = rotation_from_vector(full[:, AT_START]) @ self.start
        self.found[:, AT_START] = _rotation_vector(self.start)

    def _keep(self, t_s: float, z: Array, u: Array, nis: Array, compares: tuple[int, ...]) -> None:
        variances = np.full(self.found.shape, np.nan)
        variances[:, self.states] = np.diagonal(self.P, axis1=1, axis2=2)
        columns = [self.method.compares.index(one) for one in compares]
        innovation = np.full((2, len(z), len(self.method.compares)), np.nan)
        innovation[:, :, columns] = z, u
        misalignment = -_rotation_vector(self.alone @ self.motion.C_bn.mT)
        self.log.append((t_s, misalignment, self.found, np.sqrt(variances), *innovation, nis, len(compares)))

    def finished(self) -> TransferAlignment:
        """All that was kept, time second."""
        t_s, misalignment, found, u, innovation, innovation_u, nis, compared = (
            np.array(one) for one in zip(*self.log, strict=True)
        )
        u = u.swapaxes(0, 1)
        return TransferAlignment(
            self.method,
            t_s,
            misalignment.swapaxes(0, 1),
            u[..., PHI],
            found.swapaxes(0, 1),
            u,
            innovation.swapaxes(0, 1),
            innovation_u.swapaxes(0, 1),
            nis.swapaxes(0, 1),
            compared,
            self.motion,
            self.mounting,
            self.P,
            found[-1, :, AT_START],
            u[:, -1, AT_START],
            self.prior_u,
            self.information,
        )


def carried_over(reference: Motion, C_bn: Array, rate: Array, lever: Array) -> Motion:
    """The reference's velocity and place where the unit is: ``lever`` (3,) m along the unit's axes, which
    turn at ``rate`` (b, 3)."""
    arm = np.einsum("bij,j->bi", C_bn, lever)
    swing = np.einsum("bij,bj->bi", C_bn, np.cross(rate, lever))
    return Motion(reference.C_bn, reference.velocity + swing, *moved(reference, arm))


def _spread(motion: Motion, b: int) -> Motion:
    """The same for each of b units."""
    return Motion(
        np.broadcast_to(motion.C_bn, (b, 3, 3)),
        np.broadcast_to(motion.velocity, (b, 3)),
        *(np.broadcast_to(one, (b,)) for one in (motion.latitude, motion.longitude, motion.altitude)),
    )


def _azimuth(C_bn: Array) -> Array:
    return np.asarray(np.arctan2(C_bn[..., 0, 1], C_bn[..., 1, 1]))


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)


def _rotation_vector(rotation: Array) -> Array:
    """Shape (b, 3)."""
    return np.asarray(Rotation.from_matrix(rotation).as_rotvec(), dtype=np.float64)
