"""A reference and a unit on one virtual carrier, many times over: for the statistics of transfer alignment.

Each of b pairs flies the same flight with errors of its own, drawn from what the filter assumes of them; so
a filter that knows what it does shows errors as large as it says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.attitude import rotation_from_vector
from ahrs_lab.inertial.transfer_alignment import Reference, Start, TransferAlignment
from ahrs_lab.inertial.transfer_alignment_model import (
    ACCEL_BIAS,
    ACCEL_CROSS,
    ACCEL_SCALE,
    AT_START,
    AZIMUTH,
    CROSS,
    EARTH_RADIUS_M,
    GYRO_BIAS,
    GYRO_CROSS,
    GYRO_SCALE,
    LATITUDE,
    LONGITUDE,
    METHODS,
    MOUNTING,
    PHI,
    SIZE,
    VELOCITY,
    Assumptions,
    MethodName,
)
from ahrs_lab.inertial.transfer_alignment_motion import Increments, Motion
from ahrs_lab.simulation.trajectory import Flight

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Pair:
    """b pairs as the filter takes them; ``errors`` (b, 39) are the states at the start, ``C_bn`` (b, 3, 3),
    ``velocity`` and ``place`` (3,) the truth at the end of the flight."""

    unit: Increments
    reference: Reference
    start: Start
    errors: Array
    C_bn: Array
    velocity: Array
    place: Array

    def remaining(self, found: TransferAlignment) -> Array:
        """Shape (b, n): the true errors left at the end, in the order of ``found.method.states``."""
        motion = found.motion
        left = self.errors - found.estimate[:, -1]
        left[:, AT_START] = self.errors[:, PHI] - found.misalignment_at_start
        left[:, PHI] = -_rotation_vector(motion.C_bn @ self.C_bn.mT)
        left[:, VELOCITY] = motion.velocity - self.velocity
        left[:, LATITUDE] = motion.latitude - self.place[0]
        left[:, LONGITUDE] = motion.longitude - self.place[1]
        left[:, MOUNTING] = _rotation_vector(
            found.mounting.mT @ rotation_from_vector(self.errors[:, MOUNTING])
        )
        return left[:, list(found.method.states)]


def transfer_pairs(
    flight: Flight,
    method: MethodName,
    assumed: Assumptions,
    count: int,
    seed: int,
    *,
    every: int,
    copied: bool,
) -> Pair:
    """``count`` pairs whose errors are drawn from ``assumed``; compared at each ``every``-th sample's end.

    ``copied``: the unit starts with the reference's attitude.
    """
    rng = np.random.default_rng(seed)
    errors = _drawn(rng, assumed, method, count, float(flight.latitude_rad[0]))
    turned = rotation_from_vector(errors[:, MOUNTING])
    if method == "velocity-azimuth":
        # heading is clockwise, the case's z axis up
        turned = rotation_from_vector(np.stack([0 * errors[:, 0]] * 2 + [-errors[:, AZIMUTH]], axis=-1))
    C_bn = flight.C_bn @ turned[:, np.newaxis]
    interval = np.diff(flight.t_s)
    rows = np.arange(every, len(flight.t_s), every)
    reference = _reference(rng, flight, assumed, rows, count)
    if copied:
        C_start = flight.C_bn[0] @ rotation_from_vector(assumed.attitude_noise * rng.normal(size=(count, 3)))
        errors[:, PHI] = -_rotation_vector(C_start @ C_bn[:, 0].mT)
    else:
        C_start = rotation_from_vector(-errors[:, PHI]) @ C_bn[:, 0]
    motion = Motion(
        C_start,
        flight.velocity_enu_mps[0] + errors[:, VELOCITY],
        flight.latitude_rad[0] + errors[:, LATITUDE],
        flight.longitude_rad[0] + errors[:, LONGITUDE],
        np.full(count, flight.altitude_m[0]),
    )
    return Pair(
        _unit(rng, flight, turned, errors, assumed, interval),
        reference,
        Start(float(flight.t_s[0]), motion, copied),
        errors,
        C_bn[:, -1],
        flight.velocity_enu_mps[-1],
        np.array([flight.latitude_rad[-1], flight.longitude_rad[-1], flight.altitude_m[-1]]),
    )


def _drawn(
    rng: np.random.Generator, assumed: Assumptions, method: MethodName, count: int, latitude: float
) -> Array:
    """Shape (count, 39): errors of the states that the method has or considers; the others are none."""
    sigma = np.zeros(SIZE)
    sigma[PHI] = (assumed.level, assumed.level, assumed.azimuth)
    sigma[VELOCITY] = assumed.velocity
    sigma[LATITUDE] = assumed.position_m / EARTH_RADIUS_M
    sigma[LONGITUDE] = assumed.position_m / EARTH_RADIUS_M / np.cos(latitude)
    sigma[GYRO_BIAS], sigma[ACCEL_BIAS] = assumed.gyro_bias, assumed.accel_bias
    sigma[GYRO_SCALE], sigma[ACCEL_SCALE] = assumed.gyro_scale, assumed.accel_scale
    sigma[GYRO_CROSS], sigma[ACCEL_CROSS] = assumed.gyro_cross, assumed.accel_cross
    sigma[MOUNTING], sigma[AZIMUTH] = assumed.mounting, assumed.mounting
    has = np.zeros(SIZE)
    has[list(METHODS[method].states)] = 1.0
    has[AT_START] = 0.0
    return np.asarray(sigma * has * rng.normal(size=(count, SIZE)))


def _unit(
    rng: np.random.Generator,
    flight: Flight,
    turned: Array,
    errors: Array,
    assumed: Assumptions,
    interval: Array,
) -> Increments:
    shape = (len(errors), len(interval), 3)
    root = np.sqrt(interval)[:, np.newaxis]
    step, each = interval[:, np.newaxis], errors[:, np.newaxis]
    # C_b^a takes the case's components to the carrier's
    angle = (flight.angle_rad @ turned) @ _gains(errors, GYRO_SCALE, GYRO_CROSS).mT
    velocity = (flight.velocity_mps @ turned) @ _gains(errors, ACCEL_SCALE, ACCEL_CROSS).mT
    angle += each[..., GYRO_BIAS] * step
    velocity += each[..., ACCEL_BIAS] * step
    return Increments(
        flight.t_s[1:],
        interval,
        angle + assumed.angle_random_walk * root * rng.normal(size=shape),
        velocity + assumed.velocity_random_walk * root * rng.normal(size=shape),
    )


def _gains(errors: Array, scale: slice, cross: slice) -> Array:
    """Shape (b, 3, 3): I + δK + E, row = output channel."""
    gains = np.repeat(np.eye(3)[np.newaxis], len(errors), axis=0)
    axes, (outputs, inputs) = np.arange(3), np.array(CROSS).T
    gains[:, axes, axes] += errors[:, scale]
    gains[:, outputs, inputs] += errors[:, cross]
    return gains


def _reference(
    rng: np.random.Generator, flight: Flight, assumed: Assumptions, rows: NDArray[np.int64], count: int
) -> Reference:
    """The truth at ``rows`` with the noise of a comparison."""
    shape = (count, len(rows))
    metre = assumed.position_noise_m / EARTH_RADIUS_M
    latitude = flight.latitude_rad[rows]
    noise = rotation_from_vector(assumed.attitude_noise * rng.normal(size=(*shape, 3)))
    return Reference(
        flight.t_s[rows],
        flight.velocity_enu_mps[rows] + assumed.velocity_noise * rng.normal(size=(*shape, 3)),
        latitude + metre * rng.normal(size=shape),
        flight.longitude_rad[rows] + metre / np.cos(latitude) * rng.normal(size=shape),
        np.broadcast_to(flight.altitude_m[rows], shape),
        noise @ flight.C_bn[rows],
    )


def _rotation_vector(rotation: Array) -> Array:
    return np.asarray(Rotation.from_matrix(rotation).as_rotvec(), dtype=np.float64)
