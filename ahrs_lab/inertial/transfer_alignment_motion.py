"""Navigation of a unit from one instant of comparison to the next, as transfer alignment needs it.

Over such a window (a second or so) the navigation frame turns by some 10⁻⁴ rad: so attitude is one product
of the samples' rotations (2-74), and velocity (2-45) and position (2-50) are sums over the window, all
samples at once and any number of units side by side. Coning and sculling take the sample before into
account."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import rotation_from_vector
from ahrs_lab.inertial.earth import (
    EARTH_RATE_RADPS,
    meridian_radius_m,
    normal_gravity_mps2,
    transverse_radius_m,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Increments:
    """n samples of b units on the same instants.

    ``t_s`` and ``interval_s`` (n,): end and length of each interval; ``angle_rad`` and ``velocity_mps``
    (b, n, 3): integrals of rate and specific force along the unit's axes.
    """

    t_s: Array
    interval_s: Array
    angle_rad: Array
    velocity_mps: Array

    def compensated(self) -> Increments:
        """Rotation vectors (coning) and velocity increments along the axes at each interval's start
        (rotation to second order, sculling), from two samples each."""
        angle, velocity = self.angle_rad, self.velocity_mps
        angle0 = np.concatenate([np.zeros_like(angle[:, :1]), angle[:, :-1]], axis=1)
        velocity0 = np.concatenate([np.zeros_like(velocity[:, :1]), velocity[:, :-1]], axis=1)
        turned = np.cross(angle, velocity)
        return Increments(
            self.t_s,
            self.interval_s,
            angle + np.cross(angle0, angle) / 12,
            velocity
            + turned / 2
            + np.cross(angle, turned) / 6
            + (np.cross(angle0, velocity) + np.cross(velocity0, angle)) / 12,
        )


@dataclass(frozen=True)
class Motion:
    """b units at one instant: ``C_bn`` (b, 3, 3); ``velocity`` (b, 3), m/s; ``latitude``, ``longitude`` rad
    and ``altitude`` m, (b,)."""

    C_bn: Array
    velocity: Array
    latitude: Array
    longitude: Array
    altitude: Array


@dataclass(frozen=True)
class Window:
    """What lies between two instants of comparison: ``motion`` at the end, and for the error model the means
    over the window: ``C`` (b, 3, 3); ``C_rate`` and ``C_force`` (b, 3, 3, 3): of C_ai·ω_j and C_ai·f_j;
    ``force`` (b, 3) along east, north, up; ``frame_rate`` (b, 3): ω_in; ``velocity`` (b, 3)."""

    motion: Motion
    duration_s: float
    C: Array
    C_rate: Array
    C_force: Array
    force: Array
    frame_rate: Array
    velocity: Array


def frame_rates(latitude: Array, altitude: Array, velocity: Array) -> tuple[Array, Array]:
    """ω_ie (2-3) and ω_en (2-43) in east, north, up, each of shape (b, 3), rad/s; arguments in rad, m,
    m/s."""
    degrees = np.degrees(latitude)
    east, north = velocity[..., 0], velocity[..., 1]
    along_east = east / (transverse_radius_m(degrees) + altitude)
    along_north = north / (meridian_radius_m(degrees) + altitude)
    zero = np.zeros_like(latitude)
    earth = EARTH_RATE_RADPS * np.stack([zero, np.cos(latitude), np.sin(latitude)], axis=-1)
    over = np.stack([-along_north, along_east, along_east * np.tan(latitude)], axis=-1)
    return earth, over


def advance(start: Motion, angle: Array, velocity: Array, interval_s: Array) -> Window:
    """Navigate over one window. ``angle`` and ``velocity`` (b, m, 3) are compensated increments,
    ``interval_s`` (m,)."""
    turned = running_product(rotation_from_vector(angle))
    before = np.concatenate([np.broadcast_to(np.eye(3), turned[:, :1].shape), turned[:, :-1]], axis=1)
    C = start.C_bn[:, np.newaxis] @ before
    duration = float(np.sum(interval_s))
    middle = (np.cumsum(interval_s) - interval_s / 2)[:, np.newaxis]

    felt = np.einsum("bmij,bmj->bmi", C, velocity)
    down = np.stack(
        [
            0 * start.altitude,
            0 * start.altitude,
            -normal_gravity_mps2(np.degrees(start.latitude), start.altitude),
        ],
        axis=-1,
    )
    mean_velocity = start.velocity + (np.sum(felt, axis=1) + down * duration) / 2
    earth, over = frame_rates(
        start.latitude + start.velocity[:, 1] * duration / 2 / meridian_radius_m(np.degrees(start.latitude)),
        start.altitude,
        mean_velocity,
    )
    frame = earth + over
    # C at a sample is that of the frame at the window's start, turned on by −ω_in t
    felt = felt - middle * np.cross(frame[:, np.newaxis], felt)
    fall = down - np.cross(2 * earth + over, mean_velocity)
    gained = np.sum(felt, axis=1)
    path = start.velocity * duration + np.sum(felt * (duration - middle), axis=1) + fall * duration**2 / 2
    end = Motion(
        rotation_from_vector(-frame * duration) @ start.C_bn @ turned[:, -1],
        start.velocity + gained + fall * duration,
        *moved(start, path),
    )
    weighted = C * interval_s[:, np.newaxis, np.newaxis] / duration
    return Window(
        motion=end,
        duration_s=duration,
        C=np.sum(weighted, axis=1),
        C_rate=_mean_product(C, angle) / duration,
        C_force=_mean_product(C, velocity) / duration,
        force=gained / duration,
        frame_rate=frame,
        velocity=mean_velocity,
    )


def moved(start: Motion, path: Array) -> tuple[Array, Array, Array]:
    """Latitude, longitude and altitude after ``path`` (b, 3), m to east, north and up."""
    degrees = np.degrees(start.latitude)
    latitude = start.latitude + path[:, 1] / (meridian_radius_m(degrees) + start.altitude)
    middle = (start.latitude + latitude) / 2
    around = (transverse_radius_m(np.degrees(middle)) + start.altitude) * np.cos(middle)
    return latitude, start.longitude + path[:, 0] / around, start.altitude + path[:, 2]


def _mean_product(C: Array, increments: Array) -> Array:
    """Shape (b, 3, 3, 3): Σ C_ai·x_j over the m samples of C (b, m, 3, 3) and x (b, m, 3)."""
    b, m = C.shape[:2]
    return np.asarray((C.reshape(b, m, 9).mT @ increments).reshape(b, 3, 3, 3))


def running_product(rotations: Array) -> Array:
    """Shape (b, m, 3, 3): the product of the first 1, 2 … m, by doubling."""
    product, shift = rotations, 1
    while shift < product.shape[1]:
        product = np.concatenate([product[:, :shift], product[:, :-shift] @ product[:, shift:]], axis=1)
        shift *= 2
    return product
