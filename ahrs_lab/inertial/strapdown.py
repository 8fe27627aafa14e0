"""Strapdown navigation in east, north, up: attitude, velocity, position from a unit's increments (2.3).

Attitude is summed in inertial space, where no other quantity enters, and brought to the navigation frame by
position and the Earth's angle: an equal form of (2-74), free of its truncation. Velocity follows (2-42), with
the signs of (2-45); position (2-50) with R_N in the rate of longitude, where (2-49) prints R_M; the height
loop (2-61).

How many intervals are taken at once: :mod:`ahrs_lab.inertial.block_of_steps`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.block_of_steps import K1_PER_S, K2_PER_S2, Steps, sine_and_cosine, travel
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS
from ahrs_lab.inertial.increments import Samples, rotation_vectors, velocity_changes
from ahrs_lab.inertial.quaternion import (
    angles_deg,
    conjugate,
    from_rotation_vector,
    product,
    rotate,
    running_product,
    to_matrix,
)

Array = NDArray[np.float64]

POLE_DEG: Final = 89.9
"""Nearer to a pole east and north turn too fast for this frame."""

_BLOCK: Final = 32768
_BLOCK_S: Final = 200.0
_SHORTEST_BLOCK: Final = 16


class NavigationError(ValueError):
    """The numbers run away; ``index``: the first interval of the block in which they do."""

    def __init__(self, what: str, index: int) -> None:
        super().__init__(what)
        self.index = index


class PoleError(NavigationError):
    """The start or the path is too near a pole."""


@dataclass(frozen=True)
class NavigationState:
    """Where, how fast, how turned: ``attitude`` (4,) the quaternion b→n, scalar first; ``velocity_enu_mps``
    (3,)."""

    attitude: Array
    velocity_enu_mps: Array
    latitude_rad: float
    longitude_rad: float
    altitude_m: float


@dataclass(frozen=True)
class HeightReference:
    """Height from elsewhere, for the loop (2-61): ``altitude_m`` (n + 1,), at the intervals' edges."""

    altitude_m: Array
    k1_per_s: float = K1_PER_S
    k2_per_s2: float = K2_PER_S2


@dataclass(frozen=True)
class Navigation:
    """The state at the n + 1 edges of the intervals: ``attitude`` (4, n + 1) quaternions b→n,
    ``velocity_enu_mps`` (3, n + 1), the place (n + 1,) each."""

    attitude: Array
    velocity_enu_mps: Array
    latitude_rad: Array
    longitude_rad: Array
    altitude_m: Array

    def angles_deg(self) -> tuple[Array, Array, Array]:
        """Heading, pitch, roll, each (n + 1,)."""
        return angles_deg(self.attitude)

    def matrices(self) -> Array:
        """C_bn, shape (n + 1, 3, 3)."""
        return to_matrix(self.attitude)

    def state(self, index: int) -> NavigationState:
        """At one edge."""
        return NavigationState(
            self.attitude[:, index].copy(),
            self.velocity_enu_mps[:, index].copy(),
            float(self.latitude_rad[index]),
            float(self.longitude_rad[index]),
            float(self.altitude_m[index]),
        )


def attitude_in_inertial_space(
    start: Array, angle_rad: Array, interval_s: Array, samples: Samples = 3
) -> Array:
    """Shape (4, n + 1): the quaternion b→i at the intervals' edges, of the angle increments (3, n)."""
    result = np.empty((4, angle_rad.shape[1] + 1))
    result[:, 0] = start
    for first, last, margin in _blocks(interval_s):
        turned = rotation_vectors(angle_rad[:, margin], interval_s[margin], samples)
        turned = turned[:, first - margin.start : last - margin.start]
        steps = from_rotation_vector(turned)
        result[:, first : last + 1] = running_product(result[:, first], steps)
    return result


def navigate(
    start: NavigationState,
    angle_rad: Array,
    velocity_mps: Array,
    interval_s: Array,
    *,
    height: HeightReference | None = None,
    samples: Samples = 3,
) -> Navigation:
    """The states from ``start`` through n intervals (n,), of the increments ∫ω dt and ∫f dt (3, n).

    ``samples``: see :mod:`ahrs_lab.inertial.increments`. Raises :class:`PoleError` near a pole,
    :class:`NavigationError` where the numbers run away.
    """
    count = angle_rad.shape[1]
    path = _Path(start, count)
    bi = product(_n_to_e(path.place[0, :1], path.place[1, :1])[:, 0], start.attitude)
    for first, last, margin in _blocks(interval_s):
        inner = slice(first - margin.start, last - margin.start)
        angle, interval = angle_rad[:, margin], interval_s[margin]
        turned = rotation_vectors(angle, interval, samples)[:, inner]
        change = velocity_changes(angle, velocity_mps[:, margin], interval, samples)[:, inner]
        attitude = running_product(bi, from_rotation_vector(turned))
        bi = attitude[:, -1]
        pushed = rotate(attitude[:, :-1], change)
        path.go(first, _steps(pushed, interval[inner], first, height), attitude)
    elapsed = np.concatenate(([0.0], np.cumsum(interval_s)))
    longitude = path.place[1] - EARTH_RATE_RADPS * elapsed
    longitude = np.remainder(longitude + np.pi, 2 * np.pi) - np.pi
    return Navigation(path.attitude, path.velocity, path.place[0], longitude, path.place[2])


def _steps(pushed: Array, interval_s: Array, first: int, height: HeightReference | None) -> Steps:
    if height is None:
        return Steps(pushed, interval_s)
    edges = height.altitude_m[first : first + len(interval_s) + 1]
    middle = 0.5 * (edges[1:] + edges[:-1])
    return Steps(pushed, interval_s, middle, height.k1_per_s, height.k2_per_s2)


class _Path:
    """The result as it grows; the second row of ``place`` is longitude plus the Earth's turn since the
    start."""

    def __init__(self, start: NavigationState, count: int) -> None:
        self.attitude = np.empty((4, count + 1))
        self.velocity = np.empty((3, count + 1))
        self.place = np.empty((3, count + 1))
        self.attitude[:, 0], self.velocity[:, 0] = start.attitude, start.velocity_enu_mps
        self.place[:, 0] = start.latitude_rad, start.longitude_rad, start.altitude_m
        if not abs(np.degrees(start.latitude_rad)) <= POLE_DEG:
            raise PoleError(f"latitude beyond {POLE_DEG}°", 0)

    def go(self, first: int, steps: Steps, attitude: Array) -> None:
        """On by ``steps`` from the interval ``first``, with the attitudes b→i (4, m + 1) at their edges."""
        edges = slice(first, first + len(steps) + 1)
        solved = travel(np.concatenate((self.velocity[:, first], self.place[:, first])), steps)
        if solved is None:
            raise NavigationError("the numbers run away", first)
        if np.max(np.abs(solved[3])) > np.radians(POLE_DEG):
            raise PoleError(f"latitude beyond {POLE_DEG}°", first)
        self.velocity[:, edges], self.place[:, edges] = solved[:3], solved[3:]
        self.attitude[:, edges] = product(conjugate(_n_to_e(solved[3], solved[4])), attitude)


def _blocks(interval_s: Array) -> list[tuple[int, int, slice]]:
    """First and last interval of each block, and the block with a neighbour at either side."""
    count = len(interval_s)
    size = _BLOCK
    if count:
        size = int(np.clip(_BLOCK_S / float(np.median(interval_s)), _SHORTEST_BLOCK, _BLOCK))
    return [
        (first, min(first + size, count), slice(max(first - 1, 0), min(first + size + 1, count)))
        for first in range(0, count, size)
    ]


def _n_to_e(latitude: Array, longitude: Array) -> Array:
    """Shape (4, n): east, north, up to the Earth's axes, the transpose of (2-52): first about east, then
    about the Earth's axis."""
    d, c = sine_and_cosine(0.25 * np.pi - 0.5 * latitude)
    b, a = sine_and_cosine(0.25 * np.pi + 0.5 * longitude)
    return np.stack([a * c, a * d, b * d, b * c])
