"""What a virtual carrier does: manoeuvres in a row, each smooth, each beginning where the last one ended.

A manoeuvre gives the change of nine channels since its start, with their first and second derivatives, all
exact. Changes begin and end with four vanishing derivatives, so the whole trajectory is smooth.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

Array = NDArray[np.float64]

CHANNELS: Final = ("speed", "course", "climb", "heading", "pitch", "roll", "cone_x", "cone_y", "cone_z")
"""Speed over the Earth, m/s; course clockwise from north and climb angle of the path, rad; heading, pitch and
roll of the carrier beside its path, rad; rotation vector of the case in the carrier, rad."""

SPEED, COURSE, CLIMB, HEADING, PITCH, ROLL, CONE_X, CONE_Y, CONE_Z = range(9)

_STEP: Final = Polynomial([0, 0, 0, 0, 0, 126, -420, 540, -315, 70])
"""From 0 to 1, both ends flat to the fourth derivative."""


class Manoeuvre(Protocol):
    """``duration_s`` and the channels' change over it."""

    @property
    def duration_s(self) -> float:
        """How long it takes."""

    def changes(self, t_s: Array) -> Array:
        """Shape (9, 3, n): change, rate and acceleration of each of :data:`CHANNELS`, ``t_s`` (n,) since the
        start."""


@dataclass(frozen=True)
class Steady:
    """Everything as it is: rest, or straight flight."""

    duration_s: float

    def changes(self, t_s: Array) -> Array:
        """None."""
        return _none(t_s)


@dataclass(frozen=True)
class Accelerate:
    """Straight, the speed changes by ``change_mps`` (negative: braking)."""

    duration_s: float
    change_mps: float

    def changes(self, t_s: Array) -> Array:
        """Of the speed."""
        changes = _none(t_s)
        changes[SPEED] = self.change_mps * _step(t_s, self.duration_s)
        return changes


@dataclass(frozen=True)
class Turn:
    """The course changes by ``change_deg`` (right is positive), at a constant rate but for the first and last
    ``ramp`` of the time. A banked carrier rolls into it."""

    duration_s: float
    change_deg: float
    ramp: float = 0.25

    def changes(self, t_s: Array) -> Array:
        """Of the course."""
        ramp_s = self.ramp * self.duration_s
        rate = np.radians(self.change_deg) / (self.duration_s - ramp_s)
        into, out = _slope(t_s, ramp_s), _slope(t_s - (self.duration_s - ramp_s), ramp_s)
        changes = _none(t_s)
        changes[COURSE] = rate * (into - out)
        return changes


@dataclass(frozen=True)
class STurns:
    """The course swings by ±``amplitude_deg``, ``count`` times."""

    duration_s: float
    amplitude_deg: float
    count: int = 1

    def changes(self, t_s: Array) -> Array:
        """Of the course."""
        changes = _none(t_s)
        swing = _wave(t_s, 2 * np.pi * self.count / self.duration_s, 0.0)
        changes[COURSE] = np.radians(self.amplitude_deg) * _product(_envelope(t_s, self.duration_s), swing)
        return changes


@dataclass(frozen=True)
class Climb:
    """The path rises to ``angle_deg`` (negative: falls) and is level again at the end."""

    duration_s: float
    angle_deg: float

    def changes(self, t_s: Array) -> Array:
        """Of the climb angle."""
        changes = _none(t_s)
        changes[CLIMB] = np.radians(self.angle_deg) * _envelope(t_s, self.duration_s)
        return changes


@dataclass(frozen=True)
class Rocking:
    """Heading, pitch and roll swing about the path, as on a ship: amplitudes and frequencies each in that
    order."""

    duration_s: float
    amplitudes_deg: tuple[float, float, float]
    frequencies_hz: tuple[float, float, float] = (0.13, 0.2, 0.17)

    def changes(self, t_s: Array) -> Array:
        """Of heading, pitch and roll."""
        changes, envelope = _none(t_s), _envelope(t_s, self.duration_s)
        for i, (amplitude, frequency) in enumerate(
            zip(self.amplitudes_deg, self.frequencies_hz, strict=True)
        ):
            swing = _wave(t_s, 2 * np.pi * frequency, 0.0)
            changes[HEADING + i] = np.radians(amplitude) * _product(envelope, swing)
        return changes


@dataclass(frozen=True)
class Coning:
    """The case's z axis runs round a cone of ``half_angle_deg``, its rotation vector turning in the x–y
    plane: the motion that integrated rates take for a drift."""

    duration_s: float
    half_angle_deg: float
    frequency_hz: float

    def changes(self, t_s: Array) -> Array:
        """Of the rotation vector."""
        changes, envelope = _none(t_s), _envelope(t_s, self.duration_s)
        for channel, phase in ((CONE_X, np.pi / 2), (CONE_Y, 0.0)):
            turning = _wave(t_s, 2 * np.pi * self.frequency_hz, phase)
            changes[channel] = np.radians(self.half_angle_deg) * _product(envelope, turning)
        return changes


def _none(t_s: Array) -> Array:
    return np.zeros((len(CHANNELS), 3, len(t_s)))


def _step(t_s: Array, length_s: float) -> Array:
    """Shape (3, n): the step over ``length_s`` and its derivatives."""
    x = np.clip(t_s / length_s, 0.0, 1.0)
    return np.stack([_STEP.deriv(k)(x) / length_s**k if k else _STEP(x) for k in range(3)])


def _slope(t_s: Array, length_s: float) -> Array:
    """Shape (3, n): the integral of the step, and its derivatives."""
    x = np.clip(t_s / length_s, 0.0, 1.0)
    beyond = np.maximum(t_s - length_s, 0.0)
    integral = length_s * _STEP.integ()(x) + beyond
    return np.stack([integral, *_step(t_s, length_s)[:2]])


def _envelope(t_s: Array, duration_s: float, ramp: float = 0.25) -> Array:
    """Shape (3, n): up from 0 to 1 in the first ``ramp`` of the time, down again in the last."""
    ramp_s = ramp * duration_s
    return _step(t_s, ramp_s) - _step(t_s - (duration_s - ramp_s), ramp_s)


def _wave(t_s: Array, rate_radps: float, phase_rad: float) -> Array:
    """Shape (3, n): sin(ωt + phase) and its derivatives."""
    angle = rate_radps * t_s + phase_rad
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.stack([sine, rate_radps * cosine, -(rate_radps**2) * sine])


def _product(a: Array, b: Array) -> Array:
    """The product of two, with its derivatives."""
    return np.stack([a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2 * a[1] * b[1] + a[0] * b[2]])
