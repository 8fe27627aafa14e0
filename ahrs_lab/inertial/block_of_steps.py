"""Velocity and place over many intervals at once, for :mod:`ahrs_lab.inertial.strapdown`.

Each interval is an implicit equation: what depends on the state (Coriolis, gravity, the turn of the frame) is
taken at the mean of the states at its ends. With those terms of the last guess, all intervals of a block are
one sum; repeated, the sums settle on the result that stepping would give. Intervals of a coarse block, put
together from many, give a first guess so close that two repetitions do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from ahrs_lab.inertial.earth import (
    EARTH_RATE_RADPS,
    ECCENTRICITY_SQUARED,
    SEMI_MAJOR_AXIS_M,
    normal_gravity_from_sine,
)

Array = NDArray[np.float64]

K1_PER_S: Final = 0.06666
K2_PER_S2: Final = 0.00111
"""Gains of the height loop (2-61)."""

EAST, NORTH, UP, LATITUDE, ANGLE, ALTITUDE = range(6)
"""Rows of a state: velocity, m/s; latitude and angle of the meridian (longitude plus the Earth's turn since
the start), rad; height, m."""

_PIECE: Final = 4096
_CELLS: Final = 512
_REPETITIONS: Final = 80
_SETTLED: Final = np.array([1e-11, 1e-11, 1e-11, 2e-15, 2e-15, 1e-11])
"""What a state may still move by, m/s, rad, m, and as much of its own size: some units of the last place."""
_SMALL_ANGLE: Final = 0.02


@dataclass(frozen=True)
class Steps:
    """m intervals: ``pushed`` (3, m), the velocity changes by the specific force in inertial axes (those of
    the Earth at the start); ``interval_s`` (m,); ``reference_m`` (m,) the height that the loop follows, in
    the middle of each interval, or None; its gains."""

    pushed: Array
    interval_s: Array
    reference_m: Array | None = None
    k1_per_s: float = K1_PER_S
    k2_per_s2: float = K2_PER_S2

    def __len__(self) -> int:
        return len(self.interval_s)

    def piece(self, first: int, last: int) -> Steps:
        """The intervals first:last."""
        reference = None if self.reference_m is None else self.reference_m[first:last]
        return Steps(
            self.pushed[:, first:last], self.interval_s[first:last], reference, self.k1_per_s, self.k2_per_s2
        )

    def coarse(self, firsts: NDArray[np.intp]) -> Steps:
        """Intervals put together, beginning at ``firsts``."""
        reference = None
        duration = np.add.reduceat(self.interval_s, firsts)
        if self.reference_m is not None:
            reference = np.add.reduceat(self.reference_m * self.interval_s, firsts) / duration
        pushed = np.add.reduceat(self.pushed, firsts, axis=1)
        return Steps(pushed, duration, reference, self.k1_per_s, self.k2_per_s2)


def travel(start: Array, steps: Steps) -> Array | None:
    """Shape (6, m + 1): the states at the edges of the intervals from ``start`` (6,); None where they do not
    settle."""
    cell = -(-len(steps) // _CELLS)
    if cell < 4:
        return _settled(start, steps, _at_rest(start, steps.interval_s))
    coarse = steps.coarse(np.arange(0, len(steps), cell))
    edges = _settled(start, coarse, _at_rest(start, coarse.interval_s))
    if edges is None:
        return None
    guess = _between(edges, cell, steps.interval_s)
    states = np.empty((6, len(steps) + 1))
    states[:, 0] = start
    for first in range(0, len(steps), _PIECE):
        last = min(first + _PIECE, len(steps))
        near = guess[:, first : last + 1]
        solved = _settled(states[:, first], steps.piece(first, last), near)
        if solved is None:
            return None
        states[:, first : last + 1] = solved
    return states


def _between(edges: Array, cell: int, interval_s: Array) -> Array:
    """Shape (6, m + 1): straight lines between the ``edges`` of cells of ``cell`` intervals each, the last
    perhaps of fewer."""
    cells, count = edges.shape[1] - 1, len(interval_s)
    padded = np.zeros(cells * cell)
    padded[:count] = interval_s
    time = np.cumsum(padded.reshape(cells, cell), axis=1)
    part = time / time[:, -1:]
    between = edges[:, :-1, np.newaxis] + np.diff(edges, axis=1)[..., np.newaxis] * part
    return np.concatenate((edges[:, :1], between.reshape(6, -1)[:, :count]), axis=1)


def _at_rest(start: Array, interval_s: Array) -> Array:
    """A first guess of nothing but the Earth's turn."""
    states = np.repeat(start[:, np.newaxis], len(interval_s) + 1, axis=1)
    states[ANGLE, 1:] += EARTH_RATE_RADPS * np.cumsum(interval_s)
    return states


def _settled(start: Array, steps: Steps, states: Array) -> Array | None:
    """The states (6, m + 1), from a guess of them, which is overwritten."""
    states[:, 0] = start
    before = 0.0
    allowed = (_SETTLED * (1.0 + np.abs(start)))[:, np.newaxis]
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for _ in range(_REPETITIONS):
            middle = 0.5 * (states[:, 1:] + states[:, :-1])
            new = _once_more(start, steps, middle)
            moved = float(np.max(np.abs(new - states[:, 1:]) / allowed))
            states[:, 1:] = new
            if not np.isfinite(moved):
                return None
            # it moves less each time by a factor that itself falls: what is still to come is less than this
            if moved * (moved / before if before > moved else 1.0) < 1.0:
                return states
            before = moved
    return None


def _once_more(start: Array, steps: Steps, middle: Array) -> Array:
    """Shape (6, m): the states at the intervals' ends, with the terms of the states ``middle`` (6, m) in
    their middles; the place with the new velocity, which is put into ``middle``."""
    east, north, up, latitude, angle, altitude = middle
    h = steps.interval_s
    sine, cosine = sine_and_cosine(latitude)
    root_squared = 1.0 - ECCENTRICITY_SQUARED * sine * sine
    root = np.sqrt(root_squared)
    along_east = SEMI_MAJOR_AXIS_M / root
    along_north = along_east * (1.0 - ECCENTRICITY_SQUARED) / root_squared + altitude
    along_east += altitude
    over_east, over_north = east / along_east, north / along_north
    # 2 ω_ie + ω_en (2-43)
    turn_north = 2.0 * EARTH_RATE_RADPS * cosine + over_east
    turn_up = 2.0 * EARTH_RATE_RADPS * sine + over_east * (sine / cosine)
    new = np.empty_like(middle)
    _resolve(steps.pushed, sine, cosine, angle, new)
    new[EAST] += h * (turn_up * north - turn_north * up)
    new[NORTH] -= h * (turn_up * east + over_north * up)
    gravity = normal_gravity_from_sine(sine * sine, root, altitude)
    new[UP] += h * (turn_north * east + over_north * north - gravity)
    if steps.reference_m is not None:
        held = _held(start, new[UP], steps, steps.reference_m)
    _summed(new[:3], start[:3])
    # the mean of the new velocity at the ends
    middle[0, 0], middle[1, 0], middle[2, 0] = 0.5 * (start[:3] + new[:3, 0])
    np.add(new[:3, 1:], new[:3, :-1], out=middle[:3, 1:])
    middle[:3, 1:] *= 0.5
    new[LATITUDE] = h * north / along_north
    new[ANGLE] = h * (east / (along_east * cosine) + EARTH_RATE_RADPS)
    new[ALTITUDE] = h * up
    _summed(new[3:], start[3:])
    if steps.reference_m is not None:
        new[UP], new[ALTITUDE] = held
    return new


def _held(start: Array, push: Array, steps: Steps, reference_m: Array) -> Array:
    """Shape (2, m): vertical velocity and height at the intervals' ends under the loop (2-61), for the
    changes ``push`` (m,) of velocity by all else: v' = −k₂(h − h_b) + …, h' = v − k₁(h − h_b)."""
    k1, k2, t = steps.k1_per_s, steps.k2_per_s2, 0.5 * steps.interval_s
    # unknown in turn: velocity, height; rows of the bands: one above the diagonal, three below
    bands = np.zeros((5, 2 * len(t)))
    bands[1, 0::2], bands[1, 1::2] = 1.0, 1.0 + k1 * t
    bands[0, 1::2], bands[2, 0::2] = k2 * t, -t
    bands[3, 0:-2:2], bands[3, 1:-2:2] = -1.0, k1 * t[1:] - 1.0
    bands[2, 1:-2:2], bands[4, 0:-2:2] = k2 * t[1:], -t[1:]
    sides = np.empty(2 * len(t))
    sides[0::2], sides[1::2] = push + 2 * t * k2 * reference_m, 2 * t * k1 * reference_m
    sides[0] += start[UP] - k2 * t[0] * start[ALTITUDE]
    sides[1] += start[ALTITUDE] - k1 * t[0] * start[ALTITUDE] + t[0] * start[UP]
    solved = solve_banded((3, 1), bands, sides, overwrite_ab=True, overwrite_b=True, check_finite=False)
    return np.asarray(solved.reshape(-1, 2).T, dtype=np.float64)


def _summed(values: Array, start: Array) -> None:
    np.cumsum(values, axis=1, out=values)
    values += start[:, np.newaxis]


def _resolve(pushed: Array, sine: Array, cosine: Array, angle: Array, new: Array) -> None:
    """The velocity changes in east, north, up: (2-52) with the meridian's angle in inertial space."""
    x, y, z = pushed
    sine_angle, cosine_angle = sine_and_cosine(angle)
    outward = cosine_angle * x + sine_angle * y
    new[EAST] = cosine_angle * y - sine_angle * x
    new[NORTH] = cosine * z - sine * outward
    new[UP] = cosine * outward + sine * z


def sine_and_cosine(angle: Array) -> tuple[Array, Array]:
    """Of angles that differ little: by series about the first, to rounding."""
    first = float(angle[0])
    d = angle - first
    if not np.max(np.abs(d)) < _SMALL_ANGLE:
        return np.sin(angle), np.cos(angle)
    square = d * d
    sine = d * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)))
    less = square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0)))
    s, c = np.sin(first), np.cos(first)
    return s + (c * sine - s * less), c - (s * sine + c * less)
