"""Random and slow terms of a sensor, by the coefficients of IEEE 952, the same at any sampling rate.

White noise is drawn for each sample. Everything slower (bias instability, rate random walk) lives on a grid
of one second and is interpolated, so it neither depends on the sampling rate nor costs much; below a second
the white noise of any real sensor covers it. Numbers depend on the seed and the time alone, not on the pieces
they are asked in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRID_S: Final = 1.0
"""Spacing of the slow terms' nodes."""

_BLOCK: Final = 2048
_PROCESSES_PER_DECADE: Final = 2
_TIME_CONSTANTS_S = 10.0 ** (np.arange(0, 12) / _PROCESSES_PER_DECADE)
"""1 s to 3×10⁵ s: flat within a percent between 10 s and a day."""


@dataclass(frozen=True)
class NoiseCoefficients:
    """Of one triad, in its unit u (°/s or m/s²) and seconds.

    ``white`` N, u·√s (angle or velocity random walk); ``bias_instability`` B, u (the Allan deviation's floor
    is 0.664 B); ``random_walk`` K, u/√s; ``quantisation`` Q, u·s.
    """

    white: float = 0.0
    bias_instability: float = 0.0
    random_walk: float = 0.0
    quantisation: float = 0.0


class SlowDrift:
    """Bias instability and rate random walk of several channels on the one-second grid, zero at its start.

    Flicker noise S(f) = B²/(2πf) is the sum of Gauss–Markov processes, two a decade, each of variance B²·ln
    10/(2π) (their spectra 2σ²T/(1+(2πfT)²) add up to it); what the processes shorter than the grid would give
    at low frequency is added as white noise of the nodes.
    """

    def __init__(self, coefficients: tuple[NoiseCoefficients, ...], seed: np.random.SeedSequence) -> None:
        self._instability = np.array([c.bias_instability for c in coefficients])
        self._walk = np.array([c.random_walk for c in coefficients])
        self._rng = np.random.Generator(np.random.SFC64(seed))
        self._nodes = np.zeros((len(coefficients), 0))
        self._count = 0
        self._silent = not (self._instability.any() or self._walk.any())
        variance = np.log(10.0) / (np.pi * _PROCESSES_PER_DECADE)
        self._decay = np.exp(-GRID_S / _TIME_CONSTANTS_S)[:, np.newaxis]
        self._drive = np.sqrt(variance * (1.0 - self._decay**2)) * self._instability
        self._floor = np.sqrt(variance * _missing_below_grid(self._decay)) * self._instability
        self._state = np.sqrt(variance) * self._instability * self._rng.standard_normal(self._drive.shape)
        self._level = np.zeros(len(coefficients))
        self._origin: Array | None = None

    def nodes(self, first: int, last: int) -> Array:
        """Shape (channels, last − first + 1): the drift at the grid's nodes first … last."""
        if self._silent:
            return np.zeros((len(self._walk), last - first + 1))
        while self._count <= last:
            self._grow()
        return self._nodes[:, first : last + 1]

    def _grow(self) -> None:
        block = self._block()
        if self._origin is None:
            # B₀ is the bias at the start: taking a constant away leaves the Allan deviation as it is
            self._origin = block[:, :1].copy()
        block -= self._origin
        if self._count + _BLOCK > self._nodes.shape[1]:
            larger = np.zeros((len(self._walk), max(4 * _BLOCK, 2 * self._nodes.shape[1])))
            larger[:, : self._count] = self._nodes[:, : self._count]
            self._nodes = larger
        self._nodes[:, self._count : self._count + _BLOCK] = block
        self._count += _BLOCK

    def _block(self) -> Array:
        channels = len(self._walk)
        noise = self._rng.standard_normal((_BLOCK, len(_TIME_CONSTANTS_S) + 2, channels))
        markov = noise[:, :-2]
        markov *= self._drive
        before, decayed = self._state, np.empty_like(self._state)
        for state in markov:
            np.multiply(self._decay, before, out=decayed)
            np.add(state, decayed, out=state)
            before = state
        self._state = before.copy()
        walk = self._level + np.cumsum(noise[:, -1] * (self._walk * np.sqrt(GRID_S)), axis=0)
        self._level = walk[-1].copy()
        return np.ascontiguousarray((markov.sum(axis=1) + noise[:, -2] * self._floor + walk).T)


def _missing_below_grid(decay: Array) -> float:
    """Variance of the nodes' white noise, for processes of variance 1, that makes the spectrum right at low
    frequency: what the processes shorter than the grid would give, 2T each, less what sampling the others
    adds."""
    ratio = 10.0 ** (-1.0 / _PROCESSES_PER_DECADE)
    shorter = 2.0 * _TIME_CONSTANTS_S[0] / GRID_S * ratio / (1.0 - ratio)
    sampled = (1.0 + decay) / (1.0 - decay) - 2.0 * _TIME_CONSTANTS_S[:, np.newaxis] / GRID_S
    return float(shorter - np.sum(sampled))


class WhiteNoise:
    """Sample noise of one channel: white rate noise and white noise of the angle (quantisation)."""

    def __init__(
        self, coefficients: NoiseCoefficients, interval_s: float, seed: np.random.SeedSequence
    ) -> None:
        white, dither = seed.spawn(2)
        self._rng = np.random.Generator(np.random.SFC64(white))
        self._dither = np.random.Generator(np.random.SFC64(dither))
        self._deviation = coefficients.white / np.sqrt(interval_s)
        # Q is the standard deviation of an angle error spread evenly over one step
        self._step = coefficients.quantisation * np.sqrt(12.0) / interval_s
        self._last = self._dither.random() - 0.5 if self._step else 0.0

    def add_to(self, values: Array, scratch: Array) -> None:
        """Add the noise of the next len(values) samples to ``values``; ``scratch`` has the same shape."""
        if self._deviation:
            self._rng.standard_normal(out=scratch)
            np.multiply(scratch, self._deviation, out=scratch)
            np.add(values, scratch, out=values)
        if self._step and len(values):
            self._dither.random(out=scratch)
            scratch -= 0.5
            scratch *= self._step
            values += scratch
            values[1:] -= scratch[:-1]
            values[0] -= self._last * self._step
            self._last = float(scratch[-1]) / self._step


class Interpolation:
    """Where samples lie between the nodes of the slow grid; made once, used for each channel."""

    def __init__(self, times_s: Array) -> None:
        """``times_s``: shape (n,), not before 0, ascending, n ≥ 1."""
        scaled = times_s / GRID_S
        self.first = int(scaled[0])
        self.last = int(scaled[-1]) + 1
        index = scaled.astype(np.intp)
        self._weight = scaled - index
        self._index = index - self.first

    def __call__(self, nodes: Array, scratch: Array) -> Array:
        """Shape (n,): linear between ``nodes``, which run from ``first`` to ``last``; overwrites
        ``scratch``."""
        np.take(np.diff(nodes), self._index, out=scratch, mode="clip")
        scratch *= self._weight
        scratch += nodes.take(self._index)
        return scratch
