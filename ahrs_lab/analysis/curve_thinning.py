"""Curves with more points than a picture has places: least and greatest value of each place are kept, so that
no peak is lost and nothing is drawn twice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.report import Curve

Array = NDArray[np.float64]


def thinned(curve: Curve, places: int, *, log_x: bool = False) -> Curve:
    """``curve`` with at most about ``2·places`` points, evenly over the axis (its logarithm with ``log_x``).

    A place without any finite value stays a gap. A curve whose x runs back (a path) keeps every k-th point.
    """
    x = np.asarray(curve.x, dtype=np.float64)
    if len(x) <= 2 * places:
        return curve
    scale = np.log10(np.where(x > 0.0, x, np.nan)) if log_x else x
    if not np.isfinite(scale).all() or (np.diff(scale) < 0.0).any():
        step = -(-len(x) // (2 * places))
        return _picked(curve, np.unique(np.append(np.arange(0, len(x), step), len(x) - 1)))
    span = float(scale[-1] - scale[0]) or 1.0
    place = np.minimum((scale - scale[0]) / span * places, places - 1).astype(np.int64)
    starts = np.concatenate(([0], np.flatnonzero(np.diff(place)) + 1))
    kept = _extremes(np.asarray(curve.y, dtype=np.float64), starts)
    return _picked(curve, np.unique(np.append(kept, len(x) - 1)))


def _extremes(y: Array, starts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Indices of the least and the greatest of each stretch; of its first where it has no finite value."""
    counts = np.diff(np.append(starts, len(y)))
    stretch = np.repeat(np.arange(len(starts)), counts)
    finite = np.isfinite(y)
    found = []
    for values in (np.where(finite, y, np.inf), np.where(finite, -y, np.inf)):
        least = np.minimum.reduceat(values, starts)
        where = np.flatnonzero(values == np.repeat(least, counts))
        found.append(where[np.unique(stretch[where], return_index=True)[1]])
    return np.concatenate(found)


def _picked(curve: Curve, chosen: NDArray[np.int64]) -> Curve:
    def of(values: Array | None) -> Array | None:
        return None if values is None else np.asarray(values)[chosen]

    return replace(
        curve,
        x=np.asarray(curve.x)[chosen],
        y=np.asarray(curve.y)[chosen],
        low=of(curve.low),
        high=of(curve.high),
    )
