"""Allan deviation of rate records."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def overlapping_allan_deviation(rate: Array, factors: tuple[int, ...]) -> Array:
    """Shape (len(factors),), in the unit of ``rate`` (shape (n,), means over equal adjoining intervals): the
    overlapping Allan deviation (IEEE 952, NIST SP 1065) over averages of m intervals, for each m of
    ``factors``.

    Raises ValueError where 2·m exceeds n.
    """
    # the mean is taken out so that the running sum stays small
    phase = np.concatenate(([0.0], np.cumsum(rate - np.mean(rate))))
    deviations = []
    for m in factors:
        if not 1 <= 2 * m <= len(rate):
            raise ValueError(f"averages of {m} need {2 * m} values, there are {len(rate)}")
        second = phase[2 * m :] - 2.0 * phase[m:-m] + phase[: -2 * m]
        deviations.append(np.sqrt(np.mean(second**2) / 2.0) / m)
    return np.array(deviations)
