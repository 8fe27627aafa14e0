"""A virtual carrier on the rotating WGS-84 Earth: its trajectory, and the exact increments of an ideal unit
on it.

The path is given (speed, course, climb) with its derivatives, the attitude too; so rate and specific force
follow without integrating them: ``ω = C_nb ω_in + ω_nb`` with (2-78), ``f = C_nb(v̇ + (2ω_ie + ω_en)×v − g)``
(2-42). Only the position (2-50) is integrated, by Gauss collocation; the same nodes integrate rate and force
over every sample's interval. Errors are those of rounding; in the few intervals in which a ramp of a
manoeuvre ends, some 10⁻¹² m/s.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import Final

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from ahrs_lab.inertial.attitude import attitude_matrix, rotation_from_vector
from ahrs_lab.inertial.earth import (
    EARTH_RATE_RADPS,
    STANDARD_GRAVITY_MPS2,
    meridian_radius_m,
    normal_gravity_mps2,
    transverse_radius_m,
)
from ahrs_lab.simulation.manoeuvres import CHANNELS, CONE_X, COURSE, PITCH, ROLL, SPEED, Manoeuvre

Array = NDArray[np.float64]

_CHUNK: Final = 4096
_ITERATIONS: Final = 12
_NODES: Final = 6
_SAME_INSTANT_S: Final = 1e-9


@dataclass(frozen=True)
class Start:
    """Where the carrier begins, and how: it moves along its heading, level, with the case at these angles."""

    latitude_deg: float = 39.9042
    longitude_deg: float = 116.4074
    altitude_m: float = 50.0
    heading_deg: float = 0.0
    pitch_deg: float = 0.0
    roll_deg: float = 0.0
    speed_mps: float = 0.0


@dataclass(frozen=True)
class Flight:
    """n samples of an ideal unit, and the truth at their n + 1 edges.

    ``t_s`` (n + 1,) from 0; ``angle_rad`` and ``velocity_mps`` (n, 3): ∫ω_ib^b dt and ∫f^b dt over each
    interval; ``C_bn`` (n + 1, 3, 3); ``velocity_enu_mps`` (n + 1, 3); ``latitude_rad``, ``longitude_rad``
    and ``altitude_m`` (n + 1,).
    """

    t_s: Array
    angle_rad: Array
    velocity_mps: Array
    C_bn: Array
    velocity_enu_mps: Array
    latitude_rad: Array
    longitude_rad: Array
    altitude_m: Array

    def mounted(self, C_case: ArrayLike) -> Flight:
        """The same flight for a unit turned in the carrier: ``C_case`` (3, 3) takes case components to the
        carrier's."""
        C = np.asarray(C_case, dtype=np.float64)
        return replace(
            self, angle_rad=self.angle_rad @ C, velocity_mps=self.velocity_mps @ C, C_bn=self.C_bn @ C
        )


def fly(
    start: Start, manoeuvres: Sequence[Manoeuvre], sample_rate_hz: float, *, banked: bool = True
) -> Flight:
    """The flight sampled at ``sample_rate_hz``; what does not fill a last interval is left out.

    ``banked``: the carrier rolls by atan(V·χ̇/g) in turns, as an aircraft; off, it stays level, as a car.
    """
    ends = list(accumulate((m.duration_s for m in manoeuvres), initial=0.0))
    count = int(np.floor(ends[-1] * sample_rate_hz + 1e-6))
    if count < 1:
        raise ValueError(f"{ends[-1]} s give no sample at {sample_rate_hz} Hz")
    samples = np.arange(count + 1) / sample_rate_hz
    state = _initial(start)
    place = np.array([np.radians(start.latitude_deg), np.radians(start.longitude_deg), start.altitude_m])
    pieces = [_Piece.at(state, place, banked)]
    for manoeuvre, (begin, end) in zip(manoeuvres, pairwise(ends), strict=True):
        for edges in _chunks(samples, begin, end):
            pieces.append(_Piece.over(manoeuvre, begin, edges, state, pieces[-1].place[:, -1], banked))
        state = state + manoeuvre.changes(np.array([manoeuvre.duration_s]))[:, 0]
    return _sampled(samples, pieces)


def _initial(start: Start) -> Array:
    """Shape (9, 1): the channels at the beginning."""
    state = np.zeros((len(CHANNELS), 1))
    state[SPEED] = start.speed_mps
    state[COURSE] = np.radians(start.heading_deg)
    state[PITCH], state[ROLL] = np.radians(start.pitch_deg), np.radians(start.roll_deg)
    return state


def _chunks(samples: Array, begin: float, end: float) -> Iterator[Array]:
    """The edges of a manoeuvre, in pieces that fit in memory: its ends and the sample edges between."""
    inside = samples[(samples > begin + _SAME_INSTANT_S) & (samples < end - _SAME_INSTANT_S)]
    edges = np.concatenate(([begin], inside, [end]))
    for first in range(0, len(edges) - 1, _CHUNK):
        yield edges[first : first + _CHUNK + 1]


@dataclass(frozen=True)
class _Piece:
    """Increments (m, 3) of the intervals that end at ``t_s`` (m,), and the truth there; ``place`` (3, m)."""

    t_s: Array
    angle: Array
    velocity: Array
    C_bn: Array
    velocity_enu: Array
    place: Array

    @classmethod
    def at(cls, state: Array, place: Array, banked: bool) -> _Piece:
        """The beginning: no interval yet."""
        carrier = _Carrier(np.stack([state, 0 * state, 0 * state], axis=1), banked)
        nothing = np.zeros((1, 3))
        return cls(np.zeros(1), nothing, nothing, carrier.C_bn, carrier.velocity.T, place[:, np.newaxis])

    @classmethod
    def over(
        cls, manoeuvre: Manoeuvre, begin: float, edges: Array, state: Array, place: Array, banked: bool
    ) -> _Piece:
        """The intervals between ``edges``, from the ``place`` at the first."""
        interval = np.diff(edges)
        # what was reached before adds to the values, not to their derivatives
        base = np.stack([state, 0 * state, 0 * state], axis=1)
        times = (edges[:-1, np.newaxis] + interval[:, np.newaxis] * _POINTS).ravel() - begin
        within = _Carrier(base + manoeuvre.changes(times), banked)
        at_end = _Carrier(base + manoeuvre.changes(edges[1:] - begin), banked)
        nodes, ends = _travel(within.velocity, interval, place)
        rate, force = within.felt(nodes)
        weights = (interval[:, np.newaxis] * _WEIGHTS)[..., np.newaxis]
        return cls(
            edges[1:],
            np.sum(rate.reshape(-1, _NODES, 3) * weights, axis=1),
            np.sum(force.reshape(-1, _NODES, 3) * weights, axis=1),
            at_end.C_bn,
            at_end.velocity.T,
            ends,
        )


def _sampled(samples: Array, pieces: Sequence[_Piece]) -> Flight:
    """Pieces of one sample's interval put together."""
    t_s = np.concatenate([piece.t_s for piece in pieces])
    at = np.searchsorted(t_s, samples - _SAME_INSTANT_S)
    starts = at[:-1] + 1

    def summed(name: str) -> Array:
        parts = np.concatenate([getattr(piece, name) for piece in pieces])
        return np.asarray(np.add.reduceat(parts[: at[-1] + 1], starts, axis=0), dtype=np.float64)

    place = np.concatenate([piece.place for piece in pieces], axis=1)[:, at]
    return Flight(
        t_s=samples,
        angle_rad=summed("angle"),
        velocity_mps=summed("velocity"),
        C_bn=np.concatenate([piece.C_bn for piece in pieces])[at],
        velocity_enu_mps=np.concatenate([piece.velocity_enu for piece in pieces])[at],
        latitude_rad=place[0],
        longitude_rad=place[1],
        altitude_m=place[2],
    )


class _Carrier:
    """Attitude, velocity and their rates at n instants, of channels of shape (9, 3, n)."""

    def __init__(self, channels: Array, banked: bool) -> None:
        (V, V1, _), (course, course1, course2), (climb, climb1, _) = channels[:3]
        sine, cosine, up, along = np.sin(course), np.cos(course), np.sin(climb), np.cos(climb)
        self.velocity = V * np.stack([sine * along, cosine * along, up])
        self.acceleration = (
            V1 * np.stack([sine * along, cosine * along, up])
            + V * course1 * np.stack([cosine * along, -sine * along, 0 * up])
            + V * climb1 * np.stack([-sine * up, -cosine * up, along])
        )
        heading, pitch, roll = channels[3:6, 0]
        heading1, pitch1, roll1 = channels[3:6, 1]
        if banked:
            lean = V * course1 / STANDARD_GRAVITY_MPS2
            roll = roll + np.arctan(lean)
            roll1 = roll1 + (V1 * course1 + V * course2) / STANDARD_GRAVITY_MPS2 / (1.0 + lean**2)
        heading, pitch, heading1, pitch1 = (
            heading + course,
            pitch + climb,
            heading1 + course1,
            pitch1 + climb1,
        )
        body = attitude_matrix(np.degrees(heading), np.degrees(pitch), np.degrees(roll))
        # (2-78)
        rate = np.stack(
            [
                np.cos(roll) * pitch1 + np.sin(roll) * np.cos(pitch) * heading1,
                roll1 - np.sin(pitch) * heading1,
                np.sin(roll) * pitch1 - np.cos(roll) * np.cos(pitch) * heading1,
            ],
            axis=1,
        )
        cone, cone1 = channels[CONE_X:, 0].T, channels[CONE_X:, 1].T
        case = rotation_from_vector(cone)
        self.C_bn = body @ case
        self.turning = np.einsum("nji,nj->ni", case, rate) + _rate_of_rotation_vector(cone, cone1)

    def felt(self, place: Array) -> tuple[Array, Array]:
        """Shapes (n, 3): ω_ib^b and f^b at ``place`` (3, n)."""
        latitude, _, altitude = place
        east, north, _ = self.velocity
        along_east, along_north = _radii(latitude, altitude)
        earth = EARTH_RATE_RADPS * np.stack([0 * latitude, np.cos(latitude), np.sin(latitude)])
        over = np.stack([-north / along_north, east / along_east, east / along_east * np.tan(latitude)])
        force = self.acceleration + np.cross(2 * earth + over, self.velocity, axis=0)
        force[2] += normal_gravity_mps2(np.degrees(latitude), altitude)
        rate = self.turning + np.einsum("nji,jn->ni", self.C_bn, earth + over)
        return rate, np.einsum("nji,jn->ni", self.C_bn, force)


def _rate_of_rotation_vector(vector: Array, rate: Array) -> Array:
    """Shape (n, 3): body rate of the rotation by a vector (n, 3) that changes at ``rate`` (n, 3)."""
    angle = np.linalg.norm(vector, axis=1)[:, np.newaxis]
    small = angle < 1e-3
    safe = np.where(small, 1.0, angle)
    # (φ − sin φ)/φ³, whose difference cancels for small angles
    second = np.where(small, 1 / 6 - angle**2 / 120, (safe - np.sin(safe)) / safe**3)
    first = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    cross = np.cross(vector, rate)
    return np.asarray(rate - first * cross + second * np.cross(vector, cross), dtype=np.float64)


def _radii(latitude_rad: Array, altitude_m: Array) -> tuple[Array, Array]:
    """R_N + h and R_M + h."""
    degrees = np.degrees(latitude_rad)
    return transverse_radius_m(degrees) + altitude_m, meridian_radius_m(degrees) + altitude_m


def _travel(velocity: Array, interval: Array, place: Array) -> tuple[Array, Array]:
    """Latitude, longitude and altitude, (3, m·nodes) at the nodes and (3, m) at the intervals' ends, for the
    velocity (3, m·nodes): (2-50) by fixed-point iteration, R_N in the rate of longitude."""
    at_nodes = np.repeat(place[:, np.newaxis], velocity.shape[1], axis=1)
    ends = np.empty((3, len(interval)))
    for _ in range(_ITERATIONS):
        along_east, along_north = _radii(at_nodes[0], at_nodes[2])
        rate = np.stack(
            [velocity[1] / along_north, velocity[0] / (along_east * np.cos(at_nodes[0])), velocity[2]]
        ).reshape(3, -1, _NODES)
        ends = place[:, np.newaxis] + np.cumsum(np.sum(rate * _WEIGHTS, axis=2) * interval, axis=1)
        starts = np.concatenate((place[:, np.newaxis], ends[:, :-1]), axis=1)
        partial = np.einsum("ij,kmj->kmi", _COLLOCATION, rate) * interval[:, np.newaxis]
        new = (starts[..., np.newaxis] + partial).reshape(3, -1)
        settled = np.array_equal(new, at_nodes)
        at_nodes = new
        if settled:
            break
    return at_nodes, ends


def _gauss() -> tuple[Array, Array, Array]:
    """Nodes and weights on 0 … 1, and the matrix that integrates node values from 0 to each node."""
    nodes, weights = leggauss(_NODES)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    powers = np.arange(_NODES)
    integrals = nodes[:, np.newaxis] ** (powers + 1) / (powers + 1)
    return nodes, weights, integrals @ np.linalg.inv(np.vander(nodes, increasing=True))


_POINTS, _WEIGHTS, _COLLOCATION = _gauss()
