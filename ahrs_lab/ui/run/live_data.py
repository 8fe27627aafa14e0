"""The samples of a run as the screen needs them: the last minute as an envelope, the mean of the last
second, the mean of the recording so far. Written by the run's thread, read by the screen's; no Qt."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.samples import GYRO, Samples
from ahrs_lab.ui.plots.envelope import EnvelopeRing
from ahrs_lab.ui.plots.running_mean import RunningMeanOf

Array = NDArray[np.float64]

_REANCHOR_S = 0.25
"""The device's clock may wander from the bench's by this much before its samples are put at their arrival
again."""
_WINDOW_S = 1.0


class LiveData:
    """See the module. One per run; ``rate_hz`` is the device's nominal sample rate."""

    def __init__(self, rate_hz: float = 100.0) -> None:
        self.gyro = EnvelopeRing(3)
        self.table = EnvelopeRing(1)
        self.running = RunningMeanOf()
        self.rate_hz = rate_hz
        self._lock = threading.Lock()
        self._axis = 0
        self._offset_s: float | None = None
        self._last_t_s: float | None = None
        self._tail = _Tail()
        self._recording = False
        self.samples = 0
        self.lost = 0

    def begin_segment(self, axis: str) -> None:
        """A recording of this axis begins: count from zero."""
        with self._lock:
            self._axis = _index(axis)
            self._recording = True
            self.samples = self.lost = 0
            self._last_t_s = None
            self.running.restart()

    def end_segment(self, samples: int, lost: int) -> None:
        """Samples that still come do not belong to it; the recorder's own counts replace the running ones."""
        with self._lock:
            self._recording = False
            self.samples, self.lost = samples, lost

    def add(self, samples: Samples) -> None:
        """A block from the device, in the run's thread."""
        if not len(samples) or any(name not in samples for name in GYRO):
            return
        t_s = self._on_bench_time(samples)
        gyro = np.vstack([samples[name] for name in GYRO])
        self.gyro.append(t_s, gyro)
        table = samples.get("table_rate_dps")
        if table is not None:
            self.table.append(t_s, table[np.newaxis, :])
        with self._lock:
            self._tail.append(t_s, gyro)
            if self._recording:
                self.samples += len(samples)
                self._count_lost(samples["t_s"])
                self.running.append(samples["t_s"], gyro[self._axis])

    def add_table(self, t_s: float, rate_dps: float) -> None:
        """A look at the table, for the time that no sample carries its rate."""
        if t_s > self.table.newest_s:
            self.table.append(np.array([t_s]), np.array([[rate_dps]]))

    def _on_bench_time(self, samples: Samples) -> Array:
        t_s = samples["t_s"]
        arrival = samples.get("host_t_s")
        if arrival is None:
            return t_s
        offset = float(arrival[-1] - t_s[-1])
        if self._offset_s is None or abs(offset - self._offset_s) > _REANCHOR_S:
            self._offset_s = offset
        return t_s + self._offset_s

    def _count_lost(self, t_s: Array) -> None:
        seen = t_s if self._last_t_s is None else np.concatenate(([self._last_t_s], t_s))
        steps = np.diff(seen) * self.rate_hz
        self.lost += int(np.maximum(0, np.round(steps) - 1).sum())
        self._last_t_s = float(t_s[-1])

    def gyro_now(self, axis: str) -> float | None:
        """Mean of the last second of this axis, device unit."""
        with self._lock:
            mean = self._tail.mean()
        return None if mean is None else float(mean[_index(axis)])


def _index(axis: str) -> int:
    return "xyz".index(axis)


class _Tail:
    """The last second of a few channels, by blocks."""

    def __init__(self) -> None:
        self._t_s = np.empty(0)
        self._values: Array | None = None

    def append(self, t_s: Array, values: Array) -> None:
        newest = float(t_s[-1])
        if self._values is not None and len(self._t_s) and newest >= self._t_s[-1]:
            t_s = np.concatenate((self._t_s, t_s))
            values = np.concatenate((self._values, values), axis=1)
        kept = t_s > newest - _WINDOW_S
        self._t_s, self._values = t_s[kept], values[:, kept]

    def mean(self) -> Array | None:
        if self._values is None or not self._values.shape[1]:
            return None
        finite = np.isfinite(self._values).all(axis=0)
        return np.asarray(self._values[:, finite].mean(axis=1)) if finite.any() else None
