"""Which decoded samples count: a checksum of eight bits lets one damaged frame in 256 pass, and a device that
restarts begins its time anew.

What is dropped is counted, and a device that really went somewhere else in time is told, never guessed.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples

Mask = NDArray[np.bool_]

EARLY_S = 0.5
"""A sample that arrives this much before it can have been made has a damaged time."""
_EARLY_SHARE = 2e-3
"""So much may two clocks run apart."""
_LONGEST_EARLY_S = 10.0
_CONSISTENT = 5
"""So many samples in a row that agree with each other are no damage."""
_RANGE_MARGIN = 1.5


@dataclass
class Screening:
    """Takes samples with ``t_s`` and ``host_t_s``; gives those that count. ``range_limit`` is the device's
    range in its own rate unit; ``early_s``: how late the first sample may have come, bench time."""

    interval_s: float
    range_limit: float
    early_s: float = EARLY_S
    lost: int = 0
    """Samples that did not come, by the counter where there is one, else by the time."""
    repeated: int = 0
    implausible: int = 0
    _last_t_s: float | None = None
    _last_counter: float | None = None
    _counted_t_s: float | None = None
    _first_t_s: float = 0.0
    _offset_s: float = 0.0
    _suspects: list[float] = field(default_factory=list)

    def take(self, samples: Samples) -> Samples:
        """Raises InstrumentError where the device has restarted or its time has jumped."""
        if not len(samples):
            return samples
        good = self._in_range(samples)
        timely = self._timely(samples, good)
        self.implausible += int(np.count_nonzero(~good))
        keep = good & timely
        if not keep.all():
            samples = Samples({name: column[keep] for name, column in samples.columns.items()})
        self._count_lost(samples)
        return samples

    def _in_range(self, samples: Samples) -> Mask:
        good = np.isfinite(samples["t_s"])
        for name in GYRO:
            column = samples.get(name)
            if column is not None:
                good &= np.abs(column) <= _RANGE_MARGIN * self.range_limit
        for name in ACCEL:
            column = samples.get(name)
            if column is not None:
                good &= np.isfinite(column) & (np.abs(column) < 1e6)
        return good

    def _timely(self, samples: Samples, good: Mask) -> Mask:
        """Rows whose time goes on from the one before and does not lie ahead of their arrival."""
        t, host = samples["t_s"], samples["host_t_s"]
        late = host - t
        if self._last_t_s is None:
            first = np.flatnonzero(good)
            if not len(first):
                return good
            self._first_t_s = float(t[first[0]])
            self._offset_s = float(late[first[0]])
            self._last_t_s = self._first_t_s - self.interval_s
        allowed = self.early_s + _EARLY_SHARE * np.maximum(t - self._first_t_s, 0.0)
        with np.errstate(invalid="ignore"):
            early = late - self._offset_s < -np.minimum(allowed, max(self.early_s, _LONGEST_EARLY_S))
            rising = np.diff(t, prepend=self._last_t_s) > 0.0
        if rising.all() and not early.any() and good.all():
            self._went_on(t, late)
            return good
        return self._one_by_one(t, late, early, good)

    def _went_on(self, t: NDArray[np.float64], late: NDArray[np.float64]) -> None:
        self._last_t_s = float(t[-1])
        self._offset_s = min(self._offset_s, float(late.min()))
        self._suspects.clear()

    def _one_by_one(self, t: NDArray[np.float64], late: NDArray[np.float64], early: Mask, good: Mask) -> Mask:
        keep = good.copy()
        last = self._last_t_s if self._last_t_s is not None else -np.inf
        half = 0.5 * self.interval_s
        for row in np.flatnonzero(good):
            time = float(t[row])
            if abs(time - last) < half:
                keep[row] = False
                self.repeated += 1
            elif time <= last or early[row]:
                keep[row] = False
                self.implausible += 1
                self._suspect(time, last)
            else:
                last = time
                self._offset_s = min(self._offset_s, float(late[row]))
                self._suspects.clear()
        self._last_t_s = last
        return keep

    def _suspect(self, time_s: float, last_s: float) -> None:
        if self._suspects and not 0.0 < time_s - self._suspects[-1] < 10.0 * self.interval_s + 1.0:
            self._suspects.clear()
        self._suspects.append(time_s)
        if len(self._suspects) < _CONSISTENT:
            return
        begun, self._suspects = self._suspects[0], []
        if begun < last_s:
            raise InstrumentError(
                "The device has restarted: its time went back from {before} s to {after} s. Check its power "
                "and its cable; what was recorded since its last start does not go together with what "
                "follows.",
                before=round(last_s, 3),
                after=round(begun, 3),
            )
        raise InstrumentError(
            "The device's time has jumped from {before} s to {after} s while no such time passed. Check "
            "its output settings, and whether something else sets its clock.",
            before=round(last_s, 3),
            after=round(begun, 3),
        )

    def _count_lost(self, samples: Samples) -> None:
        if not len(samples):
            return
        counter, t_s = samples.get("counter"), samples["t_s"]
        if counter is not None and np.isfinite(counter).all():
            before = counter[0] - 1.0 if self._last_counter is None else self._last_counter
            steps = np.diff(counter, prepend=before)
            self._last_counter = float(counter[-1])
        else:
            begun = t_s[0] - self.interval_s if self._counted_t_s is None else self._counted_t_s
            steps = np.rint(np.diff(t_s, prepend=begun) / self.interval_s)
        self._counted_t_s = float(t_s[-1])
        self.lost += int(np.maximum(steps - 1.0, 0.0).sum())
