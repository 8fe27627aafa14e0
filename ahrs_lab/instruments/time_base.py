"""Device time against host time: which offset and which rate lie between the two.

A sample arrives late, never early, and adapters hand samples over in bunches of 16 ms and more. So of host
minus device time only the lower envelope means anything: the line under all points that lies closest to them.
That line is an edge of the lower convex hull, the one above whose span the mean device time lies (the optimum
of the linear programme "minimise the sum of distances, none negative").
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BUCKETS = 600
"""Of the points of a bucket only the least late is kept; twice as many are merged in pairs."""
_FIRST_BUCKET_S = 0.1
_RECENT = 4000
"""Samples that the jitter is of."""
_RATE_FROM_S = 2.0
"""Over a shorter time the rate between two clocks drowns in the latency."""


@dataclass(frozen=True)
class TimeRelation:
    """``host = device + offset_s + rate_ppm·10⁻⁶·(device − at_s)``, at the smallest latency of the link.

    ``rate_ppm`` is None before enough was seen; ``jitter_s`` is what 95 % of the samples are later than the
    line by at most; ``least_s`` is the smallest host minus device time ever seen. A constant latency is part
    of both offsets and cannot be told from them.
    """

    at_s: float
    offset_s: float
    least_s: float
    rate_ppm: float | None
    jitter_s: float
    seen_s: float


class TimeBase:
    """Fed with samples as they arrive, in order of device time."""

    def __init__(self) -> None:
        self._origin_s: float | None = None
        self._bucket_s = _FIRST_BUCKET_S
        self._buckets: dict[int, tuple[float, float]] = {}
        self._recent: Array = np.empty((2, 0))
        self._last_s = 0.0

    def add(self, device_s: Array, host_s: Array) -> None:
        """Shapes (n,): device time and host time of arrival."""
        if not len(device_s):
            return
        if self._origin_s is None:
            self._origin_s = float(device_s[0])
        late = host_s - device_s
        self._last_s = float(device_s[-1])
        self._recent = np.hstack([self._recent, np.vstack([device_s, late])])[:, -_RECENT:]
        numbers = ((device_s - self._origin_s) // self._bucket_s).astype(np.int64)
        starts = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
        for start, stop in zip(starts, [*starts[1:], len(numbers)], strict=True):
            least = int(start + np.argmin(late[start:stop]))
            self._keep(int(numbers[start]), (float(device_s[least]), float(late[least])))
        while len(self._buckets) > 2 * _BUCKETS:
            self._merge()

    @property
    def relation(self) -> TimeRelation | None:
        """What is known now; None before the first sample."""
        if not self._buckets:
            return None
        points = sorted(self._buckets.values())
        seen = points[-1][0] - points[0][0]
        least = min(late for _, late in points)
        if seen < _RATE_FROM_S:
            offset, slope = least, None
        else:
            slope, intercept = _line_below(points)
            offset = intercept + slope * self._last_s
        recent_s, late = self._recent
        late = late - (slope or 0.0) * recent_s
        jitter = float(np.quantile(late - late.min(), 0.95))
        return TimeRelation(self._last_s, offset, least, None if slope is None else slope * 1e6, jitter, seen)

    def _keep(self, number: int, point: tuple[float, float]) -> None:
        known = self._buckets.get(number)
        if known is None or point[1] < known[1]:
            self._buckets[number] = point

    def _merge(self) -> None:
        self._bucket_s *= 2.0
        before, self._buckets = self._buckets, {}
        for number, point in before.items():
            self._keep(number // 2, point)


def _line_below(points: list[tuple[float, float]]) -> tuple[float, float]:
    """Slope and intercept of the hull edge over the mean abscissa of points sorted by abscissa."""
    hull: list[tuple[float, float]] = []
    for x, y in points:
        while len(hull) >= 2:
            (x1, y1), (x2, y2) = hull[-2], hull[-1]
            if (x2 - x1) * (y - y1) > (y2 - y1) * (x - x1):
                break
            hull.pop()
        hull.append((x, y))
    mean = sum(x for x, _ in points) / len(points)
    for (x1, y1), (x2, y2) in pairwise(hull):
        if x1 <= mean <= x2:
            slope = (y2 - y1) / (x2 - x1)
            return slope, y1 - slope * x1
    return 0.0, hull[0][1]
