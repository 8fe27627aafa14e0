"""Rows of a recording drawn together to steps of about a second, for the methods that follow time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import rotation_from_vector

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Steps:
    """k steps. ``duration_s`` (k,); ``turn`` (..., k, 3, 3): the case's rotation over the step, from the case
    at its end to the case at its beginning; ``velocity`` (..., k, 3), m/s: the specific force's integral in
    the case at its beginning; ``rate``, ``force`` (..., k, 3): means over the step by case axis."""

    duration_s: Array
    turn: Array
    velocity: Array
    rate: Array
    force: Array

    def __len__(self) -> int:
        return len(self.duration_s)

    @property
    def end_s(self) -> Array:
        """Shape (k,): each step's end, from the first one's beginning."""
        return np.cumsum(self.duration_s)

    def part(self, start: int, stop: int | None = None) -> Steps:
        """The steps start:stop."""
        return Steps(
            self.duration_s[start:stop],
            self.turn[..., start:stop, :, :],
            self.velocity[..., start:stop, :],
            self.rate[..., start:stop, :],
            self.force[..., start:stop, :],
        )

    def means(self) -> tuple[Array, Array]:
        """Mean rate and specific force of all steps, shape (..., 3) each."""
        weight = self.duration_s / self.duration_s.sum()
        return weight @ self.rate, weight @ self.force


def steps_of(rate: Array, force: Array, interval_s: Array, rows: int) -> Steps:
    """``rows`` rows a step. ``rate``, ``force``: shape (..., n, 3), means over ``interval_s`` (n,).

    Rotations are composed row by row and the specific force is turned with them, so that vibration in angle
    does not add up. What is left over at the end makes a shorter step.
    """
    count = -(-len(interval_s) // rows)
    missing = count * rows - len(interval_s)
    lengths = np.pad(interval_s, (0, missing)).reshape(count, rows)
    pad = [(0, 0)] * (rate.ndim - 2) + [(0, missing), (0, 0)]
    shape = (*rate.shape[:-2], count, rows, 3)
    angle = np.pad(rate, pad).reshape(shape) * lengths[..., np.newaxis]
    push = np.pad(force, pad).reshape(shape) * lengths[..., np.newaxis]
    turn = np.broadcast_to(np.eye(3), (*shape[:-2], 3, 3))
    velocity = np.zeros((*shape[:-2], 3))
    for row in range(rows):
        theta, v = angle[..., row, :], push[..., row, :]
        v = v + 0.5 * np.cross(theta, v)
        velocity = velocity + (turn @ v[..., np.newaxis])[..., 0]
        turn = turn @ rotation_from_vector(theta)
    duration = lengths.sum(axis=1)
    mean = duration[:, np.newaxis]
    return Steps(duration, turn, velocity, angle.sum(axis=-2) / mean, push.sum(axis=-2) / mean)
