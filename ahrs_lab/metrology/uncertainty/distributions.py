"""Distributions of input quantities and how they are drawn (JCGM 101, 6.4).

Every distribution fills ``size`` rows of an array of shape (size, trials) from a generator. One of width 0 is
its mean, which is harmless; negative widths and degrees of freedom that are not positive are refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.uncertainty.correlation import check_correlation, square_root

Array = NDArray[np.float64]


class Input(Protocol):
    """One or more input quantities that are drawn together."""

    @property
    def size(self) -> int:
        """How many quantities, rows of the array, it fills."""

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        """Draw into ``out``, shape (size, trials)."""


def _refuse_width(width: float) -> None:
    if not 0.0 <= width < math.inf:
        raise InputError("A distribution cannot be {width} wide: give 0 or more.", width=width)


def refuse_dof(dof: float, name: str) -> None:
    """Raises InputError for degrees of freedom of the quantity ``name`` that are not positive."""
    if not dof > 0.0:
        raise InputError(
            "{name} has {dof} degrees of freedom: they have to be positive (or infinite).", name=name, dof=dof
        )


def _shift(row: Array, scale: float, mean: float) -> None:
    row *= scale
    if mean != 0.0:
        row += mean


@dataclass(frozen=True)
class Normal:
    """N(mean, standard²) (6.4.7)."""

    mean: float
    standard: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.standard)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        generator.standard_normal(out=out[0])
        _shift(out[0], self.standard, self.mean)


@dataclass(frozen=True)
class StudentT:
    """t with ``dof`` degrees of freedom, scaled and shifted (6.4.9); infinite ones make it normal."""

    mean: float
    scale: float
    dof: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.scale)
        refuse_dof(self.dof, "t")

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        if math.isfinite(self.dof):
            out[0] = generator.standard_t(self.dof, out.shape[1])
        else:
            generator.standard_normal(out=out[0])
        _shift(out[0], self.scale, self.mean)


@dataclass(frozen=True)
class Rectangular:
    """Between ``mean`` ± ``half_width`` (6.4.2)."""

    mean: float
    half_width: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.half_width)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        generator.random(out=out[0])
        _shift(out[0], 2.0 * self.half_width, self.mean - self.half_width)


@dataclass(frozen=True)
class Trapezoidal:
    """Between ``mean`` ± ``half_width``, flat over ``top`` (0 to 1) of that (6.4.4); 0 makes it triangular
    (6.4.5)."""

    mean: float
    half_width: float
    top: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.half_width)
        if not 0.0 <= self.top <= 1.0:
            raise InputError("A trapezium's top is {top} of its base: give 0 to 1.", top=self.top)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        generator.random(out=out[0])
        out[0] *= 1.0 + self.top
        out[0] += (1.0 - self.top) * generator.random(out.shape[1])
        _shift(out[0], self.half_width, self.mean - self.half_width)


def triangular(mean: float, half_width: float) -> Trapezoidal:
    """Between ``mean`` ± ``half_width`` (6.4.5)."""
    return Trapezoidal(mean, half_width, 0.0)


@dataclass(frozen=True)
class CurvilinearTrapezoid:
    """Between ``mean`` ± ``half_width``, limits that are themselves known to ± ``inexactness`` (6.4.3)."""

    mean: float
    half_width: float
    inexactness: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.inexactness)
        _refuse_width(self.half_width - self.inexactness)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        half = self.half_width + self.inexactness * (2.0 * generator.random(out.shape[1]) - 1.0)
        generator.random(out=out[0])
        _shift(out[0], 2.0, -1.0)
        out[0] *= half
        out[0] += self.mean


@dataclass(frozen=True)
class ArcSine:
    """A sine of unknown phase about ``mean`` with amplitude ``half_width`` (6.4.6)."""

    mean: float
    half_width: float
    size: int = field(default=1, init=False)

    def __post_init__(self) -> None:
        _refuse_width(self.half_width)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        generator.random(out=out[0])
        out[0] *= 2.0 * math.pi
        np.sin(out[0], out=out[0])
        _shift(out[0], self.half_width, self.mean)


@dataclass(frozen=True)
class Joint:
    """Correlated normal quantities (6.4.8); with finite ``dof`` a multivariate t: one scatter was estimated
    for all of them.

    ``names``, ``means``, ``standards`` of n quantities, ``correlation`` of shape (n, n) as nested tuples.
    """

    names: tuple[str, ...]
    means: tuple[float, ...]
    standards: tuple[float, ...]
    correlation: tuple[tuple[float, ...], ...]
    dof: float = math.inf

    def __post_init__(self) -> None:
        for standard in self.standards:
            _refuse_width(standard)
        refuse_dof(self.dof, ", ".join(self.names))
        check_correlation(np.array(self.correlation, dtype=np.float64), self.names)

    @property
    def size(self) -> int:
        return len(self.means)

    def fill(self, generator: np.random.Generator, out: Array) -> None:
        scale = np.array(self.standards)
        root = square_root(np.array(self.correlation) * np.outer(scale, scale))
        deviates = generator.standard_normal(out.shape)
        if math.isfinite(self.dof):
            deviates *= np.sqrt(0.5 * self.dof / generator.standard_gamma(0.5 * self.dof, out.shape[1]))
        np.matmul(root, deviates, out=out)
        out += np.array(self.means)[:, None]
