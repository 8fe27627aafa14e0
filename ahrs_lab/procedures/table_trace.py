"""The last seconds of what the table reported, to be read at the times of samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.interfaces import TableLog, TableState

Array = NDArray[np.float64]

_KEEP = 5.0
"""Times ``ahead_s``: longer than any latency of a sample."""


class TableTrace:
    """Angle and rate against bench time, from the table's log and the states that were seen.

    Of a report older than ``ahead_s`` nothing is concluded. ``reports_rate``: whether the rate is the table's
    own word.
    """

    def __init__(self, ahead_s: float = 1.0) -> None:
        self._reports: Array = np.empty((4, 0))
        """Rows: time, angle, rate, doubt about the time."""
        self._ahead_s = ahead_s
        self._keep_s = _KEEP * ahead_s
        self._exact = True
        self.reports_rate = True

    def keep(self, seconds: float) -> None:
        """From now on remember at least ``seconds``."""
        self._keep_s = max(_KEEP * self._ahead_s, seconds)

    def add(self, log: TableLog, state: TableState) -> None:
        """Append a log and the state seen after it; forget what is older than is to be kept."""
        t_s = self._reports[0]
        end = t_s[-1] if len(t_s) else -np.inf
        doubt = np.zeros(len(log.t_s)) if log.doubt_s is None else log.doubt_s
        self._exact, self.reports_rate = log.doubt_s is None, log.reports_rate
        fresh = np.vstack([log.t_s, log.angle_deg, log.rate_dps, doubt])[:, log.t_s > end]
        tail = np.empty((4, 0))
        if state.t_s > (log.t_s[-1] if len(log.t_s) else end):
            tail = np.array([[state.t_s], [state.angle_deg], [state.rate_dps], [state.doubt_s]])
        first = int(np.searchsorted(t_s, end - self._keep_s)) if len(t_s) else 0
        self._reports = np.hstack([self._reports[:, first:], fresh, tail])

    def columns(self, t_s: Array) -> dict[str, Array]:
        """What a recording keeps of the table at bench times, shapes (n,).

        ``table_angle_deg`` (unwrapped); ``table_rate_dps`` where the table tells one; ``table_doubt_s`` where
        the times of its reports are not exact: by how much the time of the angle may be wrong at most.
        """
        angle, rate = self.at(t_s)
        found = {"table_angle_deg": angle}
        if self.reports_rate:
            found["table_rate_dps"] = rate
        if not self._exact:
            found["table_doubt_s"] = np.interp(t_s, self._reports[0], self._reports[3])
        return found

    def at(self, t_s: Array) -> tuple[Array, Array]:
        """Angle (deg, unwrapped) and rate (°/s) at bench times, shapes (n,), linear between reports.

        After the last report the table goes on at the rate of that report: a table that is asked some times a
        second is always a little behind the samples.
        """
        seen, angles, rates, _ = self._reports
        angle, rate = np.interp(t_s, seen, angles), np.interp(t_s, seen, rates)
        if len(seen):
            angle += rate * np.clip(t_s - seen[-1], 0.0, self._ahead_s)
        return angle, rate

    def since(self, t_s: float) -> tuple[Array, Array, Array]:
        """Times, angles, rates reported from ``t_s`` on."""
        seen, angles, rates, _ = self._reports
        first = int(np.searchsorted(seen, t_s - 1e-9))
        return seen[first:], angles[first:], rates[first:]

    def turned_since(self, t_s: float) -> tuple[float, float]:
        """Angle over time since ``t_s``, and by how much doubtful times may have falsified it at most, °/s;
        nothing and everything where there are no two reports."""
        seen, angles, _, doubts = self._reports[:, np.searchsorted(self._reports[0], t_s - 1e-9) :]
        if len(seen) < 2:
            return 0.0, np.inf
        passed = float(seen[-1] - seen[0])
        rate = float(angles[-1] - angles[0]) / passed
        return rate, abs(rate) * float(doubts[0] + doubts[-1]) / passed

    def mean_rate_dps(self, window_s: float) -> float | None:
        """Angle over time of the last ``window_s``; None before anything was reported."""
        if not len(self._reports[0]):
            return None
        t, angle, _ = self.since(float(self._reports[0, -1]) - window_s)
        if len(t) < 2 or t[-1] <= t[0]:
            return None
        return float((angle[-1] - angle[0]) / (t[-1] - t[0]))
