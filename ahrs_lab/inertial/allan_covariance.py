"""How well Allan variances are known: their covariance for Gaussian noise of the terms of IEEE 952.

An overlapping Allan variance is a mean of squares of second differences z of the phase (the running sum of
the rate), so that cov(σ̂²(m₁), σ̂²(m₂)) = 2 ΣΣ cov(z₁, z₂)² / (4 m₁² m₂² M₁ M₂), M being the number of
differences (Isserlis). cov(z₁, z₂) at a lag is the double second difference of the phase's generalised
covariance, which is Q²·δ for noise of the angle, −N²|t|/2 for white rate noise, B²·t² ln|t|/2π for flicker,
K²|t|³/12 for random walk of the rate (Greenhall's method; NIST SP 1065 5.3 has its tables). A ramp of the
rate is no noise: it shifts z by R·m² and adds 4 ΣΣ R²m₁²m₂² cov(z₁, z₂).

Everything here counts time in sample intervals, and so do the squared coefficients Q², N², B², K², R².
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaincinv, xlogy

from ahrs_lab.inertial.allan import Counts

Array = NDArray[np.float64]

_EXACT: Final = 32
"""Lags between two kinks up to which each one is summed; beyond that by Gauss's rule."""
_FAR: Final = 8.0
"""Lags of so many averaging times: there the second differences of flicker are a fourth derivative."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_STENCIL = ((-1, 1.0), (0, -2.0), (1, 1.0))


@dataclass(frozen=True)
class AllanCovariance:
    """For f factors: ``quadratic`` (4, 4, f, f) and ``ramp`` (4, f, f), by which :meth:`of` is a polynomial
    of the squared coefficients. It depends on the record's length and the factors, not on the data."""

    quadratic: Array
    ramp: Array

    def of(self, terms: Array) -> Array:
        """Shape (f, f): covariance of the Allan variances, where ``terms`` (5,) are Q², N², B², K², R²."""
        noise = terms[:4]
        return np.asarray(
            np.einsum("a,b,abij->ij", noise, noise, self.quadratic)
            + terms[4] * np.einsum("a,aij->ij", noise, self.ramp)
        )


def allan_covariance(factors: Counts, differences: Counts, count: int) -> AllanCovariance:
    """Of the variances of a record of ``count`` values.

    Where gaps left fewer ``differences`` (f,) than ``count`` values would give, the covariance is larger by
    the ratio.
    """
    size = len(factors)
    quadratic, ramp = np.empty((4, 4, size, size)), np.empty((4, size, size))
    for i in range(size):
        for j in range(i, size):
            quadratic[:, :, i, j], ramp[:, i, j] = pair_moments(int(factors[i]), int(factors[j]), count)
            quadratic[:, :, j, i], ramp[:, j, i] = quadratic[:, :, i, j], ramp[:, i, j]
    full = (count - 2 * factors + 1) / differences
    more = np.sqrt(np.outer(full, full))
    return AllanCovariance(quadratic * more, ramp * more)


@lru_cache(maxsize=4096)  # a record's channels ask for the same ones
def pair_moments(shorter: int, longer: int, count: int) -> tuple[Array, Array]:
    """Shapes (4, 4) and (4,): what :class:`AllanCovariance` holds for one pair of factors."""
    lag, smooth, point = _lags(shorter, longer, count - shorter - longer)
    fewer = count - 2 * longer + 1
    pairs = fewer - np.maximum(0.0, lag - (longer - shorter))  # how many z₁ and z₂ are that far apart
    cross = np.array(_cross_covariances(shorter, longer, lag))
    zero = lag == 0.0  # every other lag counts on both sides
    smooth, point = pairs * (2.0 * smooth - zero), pairs * point * (2.0 - zero)
    norm = float((count - 2 * shorter + 1) * fewer)
    quadratic, ramp = (cross * smooth) @ cross.T, cross @ smooth
    quadratic[0] = quadratic[:, 0] = (cross[0] * point) @ cross.T
    ramp[0] = cross[0] @ point
    return quadratic / (2.0 * float(shorter) ** 2 * float(longer) ** 2 * norm), ramp / norm


def _lags(shorter: int, longer: int, last: int) -> tuple[Array, Array, Array]:
    """Lags from 0 to ``last``, their weight in a sum of a function that is smooth between the kinks, and 1
    for the kinks themselves."""
    kinks = np.array([0, shorter, longer - shorter, longer, longer + shorter])
    doublings = shorter * 2 ** np.arange(1, 2 + int(np.log2(max(1, last) / shorter + 1.0)))
    # finer towards each kink, where a function of the shorter time bends
    around = (np.add.outer(kinks, doublings), np.subtract.outer(kinks, doublings))
    edges = np.concatenate((kinks, *(one.ravel() for one in around), [last]))
    edges = np.unique(edges[(edges >= 0) & (edges <= last)])
    low, high = edges[:-1], edges[1:]
    short = high - low <= _EXACT
    each = [np.arange(a + 1, b, dtype=np.float64) for a, b in zip(low[short], high[short], strict=True)]
    lags = [np.concatenate((np.empty(0), *each))]
    weights = [np.ones(len(lags[0]))]
    half = 0.5 * (high - low)[~short]
    lags.append((low[~short, None] + half[:, None] * (1.0 + _NODES)).ravel())
    weights.append((half[:, None] * _WEIGHTS).ravel())
    # the sum over whole lags inside an interval is the integral less half of each end
    ends = 1.0 - 0.5 * np.isin(edges, low[~short]) - 0.5 * np.isin(edges, high[~short])
    lags.append(edges.astype(np.float64))
    weights.append(ends)
    point = np.zeros(sum(map(len, lags)))
    point[-len(edges) :] = np.isin(edges, kinks)
    return np.concatenate(lags), np.concatenate(weights), point


def _cross_covariances(shorter: int, longer: int, lag: Array) -> tuple[Array, Array, Array, Array]:
    """cov(z₁, z₂) at each lag for Q, N, B and K of 1."""
    angle, white, flicker, walk = (np.zeros_like(lag) for _ in range(4))
    for i, left in _STENCIL:
        for j, right in _STENCIL:
            t = np.abs(lag + (i * shorter - j * longer))
            factor = left * right
            angle += factor * (t == 0.0)
            white -= factor / 2.0 * t
            flicker += factor / (2.0 * np.pi) * xlogy(t**2, t)
            walk += factor / 12.0 * t**3
    # beyond the averages' own lengths two of them are exactly zero, where the sums leave rounding errors
    apart = lag >= shorter + longer
    white[apart], walk[apart] = 0.0, 0.0
    far = lag > _FAR * (shorter + longer)
    flicker[far] = -(float(shorter) ** 2) * float(longer) ** 2 / (np.pi * lag[far] ** 2)
    return angle, white, flicker, walk


def equivalent_dof(variance: float, spread: float) -> float:
    """2σ⁴/var(σ̂²): the χ² distribution with the same mean and variance."""
    return 2.0 * variance**2 / spread


def confidence_limits(variance: Array, dof: Array, confidence: float) -> tuple[Array, Array]:
    """Low and high limit of the deviation, by χ²."""
    tail = 0.5 * (1.0 - confidence)
    squares = (0.5 * variance * dof / gammaincinv(0.5 * dof, p) for p in (1.0 - tail, tail))
    low, high = (np.asarray(np.sqrt(square), dtype=np.float64) for square in squares)
    return low, high
