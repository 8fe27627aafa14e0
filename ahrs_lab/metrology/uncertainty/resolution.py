"""The resolution of the output, as the recordings show it, and how it enters means."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LOOKED_AT = 4096
"""Samples of each recording: a step that none of so many shows is none that counts."""
_OF_THE_SPREAD = 1e-6
_OF_THE_SIZE = 1e-12
"""Differences up to these parts of the spread at rest and of the largest value are rounding of floats."""


@dataclass(frozen=True)
class Resolution:
    """``step`` of the output, in its unit, or, where rates are made of angles (``of_angle``), of the angle,
    deg; 0 where no recording shows one.

    ``dithered``: in every recording at rest the noise spreads readings over several steps, so that their
    errors are independent; else neighbouring readings, and recordings of the same code, err alike.
    """

    step: float = 0.0
    dithered: bool = True
    of_angle: bool = False

    def scaled(self, factor: float) -> Resolution:
        """In another unit."""
        return replace(self, step=self.step * abs(factor))

    def mean_factors(self, durations_s: Array, samples: Array) -> Array:
        """Shape (n,): what an error of one reading makes of each mean. A mean of angle increments is the
        difference of two readings over its duration."""
        if self.of_angle:
            return np.asarray(math.sqrt(2.0) / durations_s)
        return np.asarray(1.0 / np.sqrt(samples) if self.dithered else np.ones_like(durations_s))

    def unseen_variances(self, durations_s: Array, samples: Array) -> Array:
        """Shape (n,): of the means, so far as the scatter of their own readings does not show it."""
        if self.dithered and not self.of_angle:
            return np.zeros_like(durations_s)
        return np.asarray(self.mean_factors(durations_s, samples) ** 2 * self.step**2 / 12.0)


def find_resolution(
    rest: Sequence[Array], moving: Sequence[Array], across: Sequence[Array] = (), *, of_angle: bool = False
) -> Resolution:
    """From one output's recordings at rest and in motion.

    The smallest step between values of all recordings at rest and of turns about the other axes (``across``)
    together, which may each show one code alone, or within one in motion.
    """
    at_rest = [column[:LOOKED_AT] for column in rest]
    in_motion = [column[:LOOKED_AT] for column in moving]
    spread = max((float(np.ptp(column)) for column in at_rest), default=0.0)
    together = [*at_rest, *(column[:LOOKED_AT] for column in across)]
    pooled = [np.concatenate(together)] if at_rest else []
    steps = [smallest_step(column, _OF_THE_SPREAD * spread) for column in pooled]
    steps += [smallest_step(column) for column in in_motion]
    step = min((found for found in steps if found > 0.0), default=0.0)
    spreads = [float(np.std(column)) for column in at_rest or in_motion]
    return Resolution(step, step > 0.0 and min(spreads) >= 0.5 * step, of_angle)


def smallest_step(column: Array, merged: float = 0.0) -> float:
    """Smallest difference between different values, 0 if there is none; differences up to ``merged`` and the
    rounding of floats do not count."""
    values = np.unique(column)
    steps = np.diff(values)
    steps = steps[steps > max(merged, _OF_THE_SIZE * float(np.abs(values).max()))]
    return float(steps.min()) if len(steps) else 0.0
