"""The last seconds of what the table reported, to be read at the times of samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.interfaces import TableLog, TableState

Array = NDArray[np.float64]

_KEEP_S = 5.0
"""Longer than any latency of a sample; what a settling table is judged by is kept longer on request."""
_AHEAD_S = 1.0
"""Of a report older than this nothing is concluded."""


class TableTrace:
    """Angle and rate against bench time, from the table's log and the states that were seen."""

    def __init__(self) -> None:
        self._t_s = self._angle_deg = self._rate_dps = np.empty(0)
        self.keep_s = _KEEP_S

    def add(self, log: TableLog, state: TableState) -> None:
        """Append a log and the state seen after it; forget what is older than ``keep_s`` before the log."""
        end = self._t_s[-1] if len(self._t_s) else -np.inf
        fresh = log.t_s > end
        late = state.t_s > (log.t_s[-1] if len(log.t_s) else end)
        tail = ([state.t_s], [state.angle_deg], [state.rate_dps]) if late else ([], [], [])
        keep = slice(int(np.searchsorted(self._t_s, end - self.keep_s)) if len(self._t_s) else 0, None)
        self._t_s = np.concatenate([self._t_s[keep], log.t_s[fresh], tail[0]])
        self._angle_deg = np.concatenate([self._angle_deg[keep], log.angle_deg[fresh], tail[1]])
        self._rate_dps = np.concatenate([self._rate_dps[keep], log.rate_dps[fresh], tail[2]])

    def at(self, t_s: Array) -> tuple[Array, Array]:
        """Angle (deg, unwrapped) and rate (°/s) at bench times, shapes (n,), linear between reports.

        After the last report the table goes on at the rate of that report: a table that is asked some times a
        second is always a little behind the samples.
        """
        angle, rate = np.interp(t_s, self._t_s, self._angle_deg), np.interp(t_s, self._t_s, self._rate_dps)
        if len(self._t_s):
            angle += rate * np.clip(t_s - self._t_s[-1], 0.0, _AHEAD_S)
        return angle, rate

    def since(self, t_s: float) -> tuple[Array, Array, Array]:
        """Times, angles, rates reported from ``t_s`` on."""
        first = int(np.searchsorted(self._t_s, t_s - 1e-9))
        return self._t_s[first:], self._angle_deg[first:], self._rate_dps[first:]

    def mean_rate_dps(self, window_s: float) -> float | None:
        """Angle over time of the last ``window_s``; None before anything was reported."""
        if len(self._t_s) < 2:
            return None
        t, angle, _ = self.since(float(self._t_s[-1]) - window_s)
        if len(t) < 2 or t[-1] <= t[0]:
            return None
        return float((angle[-1] - angle[0]) / (t[-1] - t[0]))
