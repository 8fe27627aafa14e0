"""Random and slow terms of a sensor, by the coefficients of IEEE 952, the same at any sampling rate.

White noise is drawn for each sample. Everything slower (bias instability, rate random walk) lives on a grid
of one second and is interpolated, so it neither depends on the sampling rate nor costs much. Bias instability
faster than that is made sample by sample where the white noise does not cover it, without its share at low
frequency, which the grid has. Numbers depend on the seed and the time alone, not on the pieces
they are asked in.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

GRID_S: Final = 1.0
"""Spacing of the slow terms' nodes."""

_BLOCK: Final = 2048
_PROCESSES_PER_DECADE: Final = 2
_TIME_CONSTANTS_S = 10.0 ** (np.arange(0, 12) / _PROCESSES_PER_DECADE)
"""1 s to 3×10⁵ s: flat within a percent between 10 s and a day."""
_VARIANCE: Final = float(np.log(10.0) / (np.pi * _PROCESSES_PER_DECADE))
"""Of each process for B of 1: their spectra 2σ²T/(1+(2πfT)²) add up to B²/(2πf)."""
_FLOOR_SQUARED: Final = float(2.0 * np.log(2.0) / np.pi)
_HIGH_PASS_S: Final = 0.55
_HIGH_PASS_VARIANCE: Final = 1.07
"""Of :class:`FastNoise`, time constant and gain: so the sum with the interpolated grid is flattest."""
_RUN_IN_S: Final = 8.0
_CHUNK: Final = 4096
_ROW: Final = 64
_COVERED: Final = 0.002
"""Flicker below this share of the white noise's Allan variance is not seen in it."""
_UNSEEN: Final = 1e-12
"""White noise below this share of the flicker's variance is left out: its zeros could not be told."""


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
    10/(2π); what the processes shorter than the grid would give at low frequency is added as white noise of
    the nodes.
    """

    def __init__(self, coefficients: tuple[NoiseCoefficients, ...], seed: np.random.SeedSequence) -> None:
        self._instability = np.array([c.bias_instability for c in coefficients])
        self._walk = np.array([c.random_walk for c in coefficients])
        self._rng = np.random.Generator(np.random.SFC64(seed))
        self._nodes = np.zeros((len(coefficients), 0))
        self._count = 0
        self._silent = not (self._instability.any() or self._walk.any())
        self._decay = np.exp(-GRID_S / _TIME_CONSTANTS_S)[:, np.newaxis]
        self._drive = np.sqrt(_VARIANCE * (1.0 - self._decay**2)) * self._instability
        self._floor = np.sqrt(_VARIANCE * _missing_below_grid(self._decay)) * self._instability
        self._state = np.sqrt(_VARIANCE) * self._instability * self._rng.standard_normal(self._drive.shape)
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


class FastNoise:
    """Sample noise of one channel: white noise, and what :class:`SlowDrift` leaves out of its bias
    instability: processes of 1 s and shorter, two a decade, behind a high pass that takes away what the grid
    has of them.

    Only the processes that the white noise does not cover are made. All are one filter of one white noise,
    whose spectrum is the sum of theirs. From two samples on, the Allan variance of flicker alone is within
    12 % up to a second and within 5 % beyond.
    """

    def __init__(
        self, coefficients: NoiseCoefficients, interval_s: float, seed: np.random.SeedSequence
    ) -> None:
        self._rng = np.random.Generator(np.random.SFC64(seed))
        self._deviation = float(coefficients.white / np.sqrt(interval_s))
        self._filter: _Recursion | None = None
        flicker, white = _FLOOR_SQUARED * coefficients.bias_instability**2, coefficients.white**2
        constants = 10.0 ** (-np.arange(0, 12) / _PROCESSES_PER_DECADE)
        constants = constants[(flicker * constants > _COVERED * white) & (constants >= 0.05 * interval_s)]
        if not len(constants) or interval_s > 0.5 * GRID_S:
            return
        decay, short = np.exp(-interval_s / constants), constants / interval_s
        means = 2.0 * short * (1.0 - short * (1.0 - decay))  # variance of means over an interval
        high_pass = float(np.exp(-interval_s / _HIGH_PASS_S))
        size = np.sqrt(_VARIANCE * _HIGH_PASS_VARIANCE) * coefficients.bias_instability
        variance = (0.5 * (1.0 + high_pass) * size) ** 2 * means
        below = self._deviation**2 < _UNSEEN * variance.sum()
        zeros, self._deviation = _factored(decay, variance, high_pass, 0.0 if below else self._deviation**2)
        self._filter = _Recursion(zeros, np.append(decay, high_pass))
        for _ in range(1 + ceil(_RUN_IN_S / interval_s / _CHUNK)):
            self._made = self._next(self._filter)
        self._used = 0

    def add_to(self, values: Array, scratch: Array) -> None:
        """Add the next len(values) samples to ``values``; ``scratch`` has the same shape."""
        if self._filter is not None:
            self._add_filtered(self._filter, values)
        elif self._deviation:
            self._rng.standard_normal(out=scratch)
            scratch *= self._deviation
            values += scratch

    def _add_filtered(self, recursion: _Recursion, values: Array) -> None:
        start = 0
        while start < len(values):
            if self._used == _CHUNK:
                self._made, self._used = self._next(recursion), 0
            taken = min(len(values) - start, _CHUNK - self._used)
            values[start : start + taken] += self._made[self._used : self._used + taken]
            start += taken
            self._used += taken

    def _next(self, recursion: _Recursion) -> Array:
        """A chunk; always a whole one, so that its sums do not depend on how many were asked for."""
        made = self._rng.standard_normal(_CHUNK)
        made *= self._deviation
        return recursion(made)


class _Recursion:
    """The recursive filter Π(1 − zᵢ/z)/Π(1 − pᵢ/z) with no more ``zeros`` than ``poles``, the poles real and
    distinct, by matrix products.

    It is a gain and first-order recursions, one a pole. What these hold at the end of each row of samples is
    a sum over the rows before; within a row the filter is its impulse response. Numbers as of a recursion
    sample by sample, to rounding.
    """

    def __init__(self, zeros: Complex, poles: Array) -> None:
        apart = 1.0 - poles / poles[:, np.newaxis]
        np.fill_diagonal(apart, 1.0)
        share = np.prod(1.0 - zeros / poles[:, np.newaxis], axis=1).real / np.prod(apart, axis=1)
        step, row = np.arange(_ROW), np.arange(_CHUNK // _ROW)
        after = step - step[:, np.newaxis]
        response = share @ poles[:, np.newaxis] ** step
        response[0] = 1.0
        self._within = np.where(after >= 0, response[after], 0.0)
        self._held = poles[:, np.newaxis] ** step[::-1]
        self._shown = (share * poles)[:, np.newaxis] * poles[:, np.newaxis] ** step
        faded = (poles**_ROW)[:, np.newaxis]
        self._faded = faded ** np.append(row, len(row))
        later = row - row[:, np.newaxis]
        self._carried = np.ascontiguousarray(
            np.where(later > 0, self._faded[:, np.maximum(later - 1, 0)], 0.0)
        )
        self._last = faded ** row[::-1]
        self._state = np.zeros((len(poles), 1))

    def __call__(self, values: Array) -> Array:
        """The next chunk."""
        rows = values.reshape(-1, _ROW)
        gained = self._held @ rows.T
        before = (gained[:, np.newaxis] @ self._carried)[:, 0] + self._state * self._faded[:, :-1]
        self._state = np.sum(gained * self._last, axis=1, keepdims=True) + self._state * self._faded[:, -1:]
        made: Array = rows @ self._within
        made += before.T @ self._shown
        return made.reshape(-1)


def _factored(decay: Array, variance: Array, high_pass: float, white: float) -> tuple[Complex, float]:
    """Zeros and gain of the filter, its poles at ``decay`` and ``high_pass``, that gives white noise of
    variance 1 this spectrum: white noise of variance ``white`` and, behind the high pass (1 − 1/z)/(1 −
    ``high_pass``/z), the sum of Gauss–Markov processes of ``variance`` (p,) that decay by ``decay`` (p,) each
    sample.

    In u = |1 − 1/z|² on the unit circle, |1 − d/z|² is (1 − d)² + d·u, so the spectrum is a ratio of
    polynomials in u; of each two z that a root of u belongs to, the one inside the circle is taken.
    """
    poles = np.append(decay, high_pass)
    factors = [np.array([(1.0 - pole) ** 2, pole]) for pole in poles]

    def without(*left_out: int) -> Array:
        product = np.ones(1)
        for index, factor in enumerate(factors):
            if index not in left_out:
                product = np.convolve(product, factor)
        return product

    above = white * without()
    for index, drive in enumerate(variance * (1.0 - decay**2)):
        above[1:-1] += drive * without(index, len(decay))
    half = -0.5 * np.roots(above[::-1]).astype(np.complex128)
    zeros = 1.0 / (1.0 + half + np.sqrt(half * (2.0 + half)))
    zeros = np.where(np.abs(zeros) > 1.0, 1.0 / zeros, zeros)
    there = np.exp(-1j * np.pi / 3.0)  # where u = 1
    shown = np.prod(1.0 - zeros * there) / np.prod(1.0 - poles * there)
    return zeros, float(np.sqrt(above.sum() / np.sum(without())) / np.abs(shown))


class WhiteNoise:
    """Noise of one channel from sample to sample: :class:`FastNoise`, and white noise of the angle
    (quantisation)."""

    def __init__(
        self, coefficients: NoiseCoefficients, interval_s: float, seed: np.random.SeedSequence
    ) -> None:
        fast, dither = seed.spawn(2)
        self._fast = FastNoise(coefficients, interval_s, fast)
        self._dither = np.random.Generator(np.random.SFC64(dither))
        # Q is the standard deviation of an angle error spread evenly over one step
        self._step = coefficients.quantisation * np.sqrt(12.0) / interval_s
        self._last = self._dither.random() - 0.5 if self._step else 0.0

    def add_to(self, values: Array, scratch: Array) -> None:
        """Add the noise of the next len(values) samples to ``values``; ``scratch`` has the same shape."""
        self._fast.add_to(values, scratch)
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
