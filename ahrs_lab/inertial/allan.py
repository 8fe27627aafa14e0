"""Overlapping Allan deviation of rate records (IEEE 952, NIST SP 1065).

The estimate alone; how well it is known is in :mod:`ahrs_lab.inertial.allan_covariance`, what it says of the
sensor in :mod:`ahrs_lab.inertial.allan_fit`. Averages are over m adjoining intervals; m is called a factor.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

MOST_FACTORS: Final = 500
"""Of :func:`all_factors`: each costs a pass over the record."""
FEWEST_PRESENT: Final = 0.95
"""Share of an average's values that have to be there."""

_CHUNK: Final = 8192
"""Values worked on at a time: what stays in the processor's cache is summed several times faster. And so few
that a linear algebra library does not start threads for each piece."""


@dataclass(frozen=True)
class AllanVariance:
    """``variance`` (f,) for averages of ``factors`` (f,) intervals, each from so many overlapping
    ``differences`` (f,) of neighbouring averages."""

    factors: Counts
    variance: Array
    differences: Counts

    @property
    def deviation(self) -> Array:
        """Shape (f,), the unit of the rate."""
        return np.asarray(np.sqrt(self.variance))


def octave_factors(count: int) -> Counts:
    """1, 2, 4 … up to half of ``count`` values."""
    return 2 ** np.arange(max(0, count.bit_length() - 1), dtype=np.int64)


def all_factors(count: int) -> Counts:
    """Every factor up to half of ``count`` values; beyond :data:`MOST_FACTORS` of them so many or fewer,
    evenly on the logarithmic scale."""
    longest = count // 2
    if longest <= MOST_FACTORS:
        return np.arange(1, longest + 1, dtype=np.int64)
    return np.unique(np.rint(np.geomspace(1.0, longest, MOST_FACTORS)).astype(np.int64))


def own_factors(taus_s: Iterable[float], interval_s: float, count: int) -> Counts:
    """The whole factors nearest to these averaging times, in rising order; those that ``count`` values cannot
    show are left out."""
    nearest = np.rint(np.array(sorted(taus_s), dtype=np.float64) / interval_s)
    return np.unique(nearest[(nearest >= 1.0) & (nearest <= count // 2)].astype(np.int64))


def overlapping_allan_deviation(rate: Array, factors: tuple[int, ...]) -> Array:
    """Shape (len(factors),), in the unit of ``rate`` (shape (n,), means over equal adjoining intervals): the
    overlapping Allan deviation over averages of m intervals, for each m of ``factors``.

    Raises ValueError where 2·m exceeds n.
    """
    for m in factors:
        if not 1 <= 2 * m <= len(rate):
            raise ValueError(f"averages of {m} need {2 * m} values, there are {len(rate)}")
    return overlapping_allan_variance(rate, np.array(factors, dtype=np.int64)).deviation


def overlapping_allan_variance(rate: Array, factors: Counts) -> AllanVariance:
    """Of ``rate``, shape (n,), means over equal adjoining intervals, NaN where a value is missing.

    With missing values an average is that of the values which are there, and is used where they are at least
    :data:`FEWEST_PRESENT` of it. Factors without a single difference are left out of the result.
    """
    mean = float(np.mean(rate)) if len(rate) else 0.0
    # the mean is taken out so that the running sum stays small: an offset does not enter anyway
    if np.isfinite(mean):
        with np.errstate(over="ignore"):  # readings too large to square
            squares = _sums_of_squares(_running_sum(rate - mean), factors)
        differences = np.maximum(0, len(rate) - 2 * factors + 1)
    else:
        there = np.isfinite(rate)
        mean = float(np.mean(rate[there])) if there.any() else 0.0
        phase = _running_sum(np.where(there, rate - mean, 0.0))
        present = _running_sum(there.astype(np.float64))
        found = [_gappy(phase, present, int(m)) for m in factors]
        squares = np.array([one for one, _ in found], dtype=np.float64)
        differences = np.array([count for _, count in found], dtype=np.int64)
    some = differences > 0
    return AllanVariance(factors[some], squares[some] / (2.0 * differences[some]), differences[some])


def _running_sum(values: Array) -> Array:
    total = np.empty(len(values) + 1)
    total[0] = 0.0
    np.cumsum(values, out=total[1:])
    return total


def _sums_of_squares(phase: Array, factors: Counts) -> Array:
    """Shape (f,): of the second differences of the phase over m, divided by m²."""
    totals = [0.0] * len(factors)
    later, earlier = np.empty(_CHUNK), np.empty(_CHUNK)
    for start in range(0, len(phase), _CHUNK):
        for index, m in enumerate(factors.tolist()):
            size = min(_CHUNK, len(phase) - 2 * m - start)
            if size > 0:
                middle = phase[start + m : start + m + size]
                second, first = later[:size], earlier[:size]
                np.subtract(phase[start + 2 * m : start + 2 * m + size], middle, out=second)
                np.subtract(middle, phase[start : start + size], out=first)
                np.subtract(second, first, out=second)
                totals[index] += float(second @ second)
    return np.array(totals, dtype=np.float64) / factors.astype(np.float64) ** 2


def _gappy(phase: Array, present: Array, m: int) -> tuple[float, int]:
    """Sum of the squared differences of neighbouring averages, and how many they are."""
    if len(phase) <= 2 * m:
        return 0.0, 0
    sums, counts = phase[m:] - phase[:-m], present[m:] - present[:-m]
    enough = counts >= FEWEST_PRESENT * m
    means = np.divide(sums, counts, out=np.zeros_like(sums), where=enough)
    both = enough[m:] & enough[:-m]
    steps = (means[m:] - means[:-m])[both]
    return float(steps @ steps), len(steps)
