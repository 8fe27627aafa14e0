"""The mean of a recording so far and how sure it is: what a dwell shows while it lasts."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MOST_POINTS = 512


@dataclass(frozen=True)
class RunningMean:
    """After ``samples`` samples over ``elapsed_s``: mean and its standard error, and how both went:
    ``elapsed_s``, ``means``, ``errors`` of shape (m,). The error is NaN below two whole batches."""

    samples: int
    elapsed_s: float
    mean: float
    error: float
    history_s: Array
    means: Array
    errors: Array


class RunningMeanOf:
    """Mean of one signal from batches of ``batch_s``; their scatter gives the standard error.

    The batches show white noise right and slow drift partly: it is a view of how the recording goes, the
    result's uncertainty is computed from the recording itself.
    """

    def __init__(self, batch_s: float = 1.0) -> None:
        self._batch_s = batch_s
        self._lock = threading.Lock()
        self.restart()

    def restart(self) -> None:
        """Another recording begins with the next sample."""
        with self._lock:
            self._start_s: float | None = None
            self._last_s = 0.0
            self._samples = 0
            self._sum = 0.0
            self._batch = 0
            self._batch_sum = 0.0
            self._batch_count = 0
            # Welford over the batch means.
            self._batches = 0
            self._mean = 0.0
            self._squares = 0.0
            self._stride = 1
            self._history: list[tuple[float, float, float]] = []

    def append(self, t_s: Array, values: Array) -> None:
        """Both of shape (n,), in order of time. Values that are not finite are left out."""
        finite = np.isfinite(values)
        t_s, values = t_s[finite], values[finite]
        if not len(t_s):
            return
        with self._lock:
            if self._start_s is None:
                self._start_s = float(t_s[0])
            self._last_s = float(t_s[-1])
            self._samples += len(values)
            self._sum += float(values.sum())
            number = np.floor((t_s - self._start_s) / self._batch_s).astype(np.int64)
            starts = np.concatenate(([0], np.flatnonzero(np.diff(number)) + 1))
            sums = np.add.reduceat(values, starts)
            counts = np.diff(np.concatenate((starts, [len(values)])))
            for batch, total, count in zip(
                number[starts].tolist(), sums.tolist(), counts.tolist(), strict=True
            ):
                self._add(batch, total, count)

    def _add(self, batch: int, total: float, count: int) -> None:
        if batch != self._batch and self._batch_count:
            self._close_batch()
        self._batch = batch
        self._batch_sum += total
        self._batch_count += count

    def _close_batch(self) -> None:
        value = self._batch_sum / self._batch_count
        self._batches += 1
        step = value - self._mean
        self._mean += step / self._batches
        self._squares += step * (value - self._mean)
        self._batch_sum, self._batch_count = 0.0, 0
        if self._batches % self._stride == 0:
            self._history.append(((self._batch + 1) * self._batch_s, self._mean, self._error()))
            if len(self._history) > _MOST_POINTS:
                self._history = self._history[1::2]
                self._stride *= 2

    def _error(self) -> float:
        if self._batches < 2:
            return float("nan")
        return float(np.sqrt(self._squares / (self._batches - 1) / self._batches))

    @property
    def elapsed_s(self) -> float:
        """From the first to the last sample."""
        return 0.0 if self._start_s is None else self._last_s - self._start_s

    def look(self) -> RunningMean:
        """A copy of what there is."""
        with self._lock:
            history = np.array(self._history, dtype=np.float64).reshape(-1, 3)
            return RunningMean(
                samples=self._samples,
                elapsed_s=self.elapsed_s,
                mean=self._sum / self._samples if self._samples else float("nan"),
                error=self._error(),
                history_s=history[:, 0],
                means=history[:, 1],
                errors=history[:, 2],
            )
