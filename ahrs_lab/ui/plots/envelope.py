"""What a plot of the last minute needs of a stream, however fast it is: per time bin the lowest, highest
and mean value.

Appending costs time for what is new, drawing for the number of bins; nothing looks at old samples again.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bins = NDArray[np.int64]


@dataclass(frozen=True)
class Envelope:
    """Bins in order of time: ``t_s`` shape (m,) their middles, the others (channels, m); a channel without
    a finite sample in a bin has NaN there and ``count`` 0."""

    t_s: Array
    low: Array
    high: Array
    mean: Array
    count: Bins


class EnvelopeRing:
    """The last ``span_s`` seconds of ``channels`` signals in ``bins`` bins. Any thread may append or look."""

    def __init__(self, channels: int, span_s: float = 60.0, bins: int = 1200) -> None:
        self.span_s = span_s
        self._width_s = span_s / bins
        self._bins = bins
        self._channels = channels
        self._lock = threading.Lock()
        self._newest_s = -np.inf
        self.clear()

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            shape = (self._channels, self._bins)
            self._low = np.full(shape, np.nan)
            self._high = np.full(shape, np.nan)
            self._sum = np.zeros(shape)
            self._count = np.zeros(shape, dtype=np.int64)
            self._held = np.full(self._bins, np.iinfo(np.int64).min, dtype=np.int64)
            self._newest_s = -np.inf

    @property
    def newest_s(self) -> float:
        """Time of the latest sample, −inf where there is none."""
        return float(self._newest_s)

    def append(self, t_s: Array, values: Array) -> None:
        """``t_s`` shape (n,), ``values`` (channels, n). Order does not matter; what is older than the span
        is left out, and so are values that are not finite."""
        if not len(t_s):
            return
        with self._lock:
            self._newest_s = max(self._newest_s, float(t_s[-1]), float(t_s.max()))
            # One bin more than the span would fall on the slot of the newest one.
            oldest = int(np.floor(self._newest_s / self._width_s)) - self._bins + 1
            number = np.floor(t_s / self._width_s).astype(np.int64)
            wanted = number >= oldest
            if not wanted.all():
                number, values = number[wanted], values[:, wanted]
                if not len(number):
                    return
            if (np.diff(number) < 0).any():
                order = np.argsort(number, kind="stable")
                number, values = number[order], values[:, order]
            self._merge(number, values)

    def _merge(self, number: Bins, values: Array) -> None:
        starts = np.concatenate(([0], np.flatnonzero(np.diff(number)) + 1))
        found = number[starts]
        slot = found % self._bins
        stale = slot[self._held[slot] != found]
        self._low[:, stale] = self._high[:, stale] = np.nan
        self._sum[:, stale] = 0.0
        self._count[:, stale] = 0
        self._held[slot] = found
        finite = np.isfinite(values)
        clean = values if finite.all() else np.where(finite, values, np.nan)
        # fmin and fmax pass over NaN.
        self._low[:, slot] = np.fmin(self._low[:, slot], np.fmin.reduceat(clean, starts, axis=1))
        self._high[:, slot] = np.fmax(self._high[:, slot], np.fmax.reduceat(clean, starts, axis=1))
        self._sum[:, slot] += np.add.reduceat(np.where(finite, values, 0.0), starts, axis=1)
        self._count[:, slot] += np.add.reduceat(finite.astype(np.int64), starts, axis=1)

    def look(self) -> Envelope:
        """A copy of what there is, oldest bin first."""
        with self._lock:
            if not np.isfinite(self._newest_s):
                empty = np.empty((self._channels, 0))
                return Envelope(
                    np.empty(0), empty, empty, empty, np.empty((self._channels, 0), dtype=np.int64)
                )
            oldest = int(np.floor(self._newest_s / self._width_s)) - self._bins + 1
            slots = np.flatnonzero(self._held >= oldest)
            slots = slots[np.argsort(self._held[slots])]
            count = self._count[:, slots]
            with np.errstate(invalid="ignore", divide="ignore"):
                mean: Array = np.where(count > 0, self._sum[:, slots] / count, np.nan)
            return Envelope(
                np.asarray((self._held[slots] + 0.5) * self._width_s, dtype=np.float64),
                self._low[:, slots],
                self._high[:, slots],
                mean,
                count,
            )
