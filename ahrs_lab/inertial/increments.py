"""From the increments that a unit gives to rotation vectors and velocity changes of its intervals.

The integral of the rate is not the rotation where the axis moves (coning), nor the integral of the specific
force its change of velocity where the unit turns (sculling). Both are corrected from the increments of
neighbouring intervals: none ("samples" 1, for comparison), the one before (2), or one at either side (3).
Equal intervals are assumed; where they are not (a gap), an interval stands alone.

With d the increments, h the interval, the correction of the middle interval that is exact for coning to the
fifth power of Ωh is ``c₁ d₋×d₊ + c₂ d×(d₊ − d₋)``, c₁ = −1/60, c₂ = 7/120; of two intervals ``d₋×d/12``. The
drift left is α²Ω⁵h⁴/60 and α²Ω⁷h⁶/280 for a cone of half-angle α. Sculling takes the same weights (Roscoe).
"""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Samples = Literal[1, 2, 3]

_OUTER: Final = -1.0 / 60.0
_INNER: Final = 7.0 / 120.0
_TWO: Final = 1.0 / 12.0
_UNEQUAL: Final = 1.5


def rotation_vectors(angle_rad: Array, interval_s: Array, samples: Samples = 3) -> Array:
    """Shape (3, n): rotation vector of each interval, of the angle increments (3, n)."""
    if samples == 1 or angle_rad.shape[1] < 2:
        return angle_rad
    return angle_rad + _correction(angle_rad, angle_rad, interval_s, samples) * 0.5


def velocity_changes(angle_rad: Array, velocity_mps: Array, interval_s: Array, samples: Samples = 3) -> Array:
    """Shape (3, n): ∫ C f dt over each interval, m/s, in the body axes at its start; increments (3, n).

    The turn within the interval is taken whole, so a steady turn is exact at any rate.
    """
    square = _dot(angle_rad, angle_rad)
    # (1 − cos a)/a² and (a − sin a)/a³; beyond the series' reach the unit turned more than a radian a sample
    small = square < 1.0
    near = np.where(small, square, 0.0)
    first = 0.5 - near / 24 * (1 - near / 30 * (1 - near / 56 * (1 - near / 90)))
    second = 1 / 6 - near / 120 * (1 - near / 42 * (1 - near / 72 * (1 - near / 110)))
    if not np.all(small):
        a = np.sqrt(np.where(small, 1.0, square))
        first = np.where(small, first, (1 - np.cos(a)) / a**2)
        second = np.where(small, second, (a - np.sin(a)) / a**3)
    turn = _cross(angle_rad, velocity_mps)
    change = velocity_mps + first * turn + second * _cross(angle_rad, turn)
    if samples != 1 and angle_rad.shape[1] > 1:
        change += _correction(angle_rad, velocity_mps, interval_s, samples)
    return change


def _correction(angle: Array, other: Array, interval_s: Array, samples: Samples) -> Array:
    """Shape (3, n): the weighted cross products of neighbours, both ways (a×b and b×a of the two kinds)."""
    same = angle is other
    pairs = _both(angle[:, :-1], angle[:, 1:], other[:, :-1], other[:, 1:], same)
    ratio = interval_s[1:] / interval_s[:-1]
    apart = (ratio > _UNEQUAL) | (ratio < 1 / _UNEQUAL)
    pairs[:, apart] = 0.0
    total = np.empty_like(angle)
    if samples == 2 or angle.shape[1] < 3:
        total[:, 1:] = _TWO * pairs
        total[:, 0] = total[:, 1]
        return total
    outer = _both(angle[:, :-2], angle[:, 2:], other[:, :-2], other[:, 2:], same)
    lonely = apart[1:] | apart[:-1]
    middle = _OUTER * outer + _INNER * (pairs[:, :-1] + pairs[:, 1:])
    if np.any(lonely):
        # next to a gap: what of the two neighbours is there
        middle[:, lonely] = _TWO * (pairs[:, :-1] + pairs[:, 1:])[:, lonely]
    total[:, 1:-1] = middle
    # the ends have neighbours on one side only: what is next to them is right to the same power
    total[:, 0], total[:, -1] = total[:, 1], total[:, -2]
    return total


def _both(a: Array, b: Array, v: Array, w: Array, same: bool) -> Array:
    """a×w + v×b; where angle and other are one, twice a×b."""
    return 2.0 * _cross(a, b) if same else _cross(a, w) + _cross(v, b)


def _cross(a: Array, b: Array) -> Array:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], dtype=np.float64)
