"""How well a table held its rate, from what its readings can really tell.

The times of a table that is asked over a wire are known to within a doubt: over a base Δt between two
readings the rate of their angles is known to within Ω·(δ₁ + δ₂)/Δt. Where that is more than the tolerance,
the rate that the table itself reports decides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ahrs_lab.recording.samples import Array


@dataclass(frozen=True)
class Hold:
    """A segment at a demanded rate, arrays of shape (n,), at least two rows: times (s), the angle travelled
    (deg, unwrapped), the doubt about the time of each angle (s), and the rate that the table reported, None
    where it tells none. ``tolerance`` is relative; ``window`` is the rows over which a rate is averaged."""

    demanded_dps: float
    tolerance: float
    window: int
    t_s: Array
    travelled_deg: Array
    doubt_s: Array
    reported_dps: Array | None

    def mean(self) -> tuple[float, float]:
        """Mean rate (°/s) by the least doubtful readings at either end, and its relative doubt."""
        quarter = max(1, len(self.t_s) // 4)
        first = int(np.argmin(self.doubt_s[:quarter]))
        last = len(self.t_s) - 1 - int(np.argmin(self.doubt_s[::-1][:quarter]))
        passed = float(self.t_s[last] - self.t_s[first])
        mean = float(self.travelled_deg[last] - self.travelled_deg[first]) / passed
        return mean, float(self.doubt_s[first] + self.doubt_s[last]) / passed

    @property
    def angles_tell(self) -> bool:
        """Whether the angles tell the mean rate to within the tolerance."""
        return self.mean()[1] <= self.tolerance

    def wrong_mean(self) -> float | None:
        """The mean rate, where it is certainly out of tolerance."""
        mean, doubt = self.mean()
        if abs(mean / self.demanded_dps - 1) > self.tolerance + doubt:
            return mean
        if not self.angles_tell and self.reported_dps is not None:
            reported = float(np.mean(self.reported_dps))
            if abs(reported / self.demanded_dps - 1) > self.tolerance:
                return reported
        return None

    def lapse(self) -> Lapse | None:
        """Where the rate was farthest out of tolerance over a window, or over a longer time that leaves less
        doubt; None where it was not."""
        found: list[Lapse] = []
        rows = self.window
        while rows < len(self.t_s):
            found += self._lapses(rows)
            rows *= 2
        return max(found, key=lambda lapse: lapse.excess, default=None)

    def _lapses(self, rows: int) -> list[Lapse]:
        passed = self.t_s[rows:] - self.t_s[:-rows]
        doubt = (self.doubt_s[rows:] + self.doubt_s[:-rows]) / passed
        by_angle = (self.travelled_deg[rows:] - self.travelled_deg[:-rows]) / passed
        found = self._worst(by_angle, self.tolerance + doubt, rows)
        if rows == self.window and self.reported_dps is not None and np.any(doubt > self.tolerance):
            total = np.concatenate([[0.0], np.cumsum(self.reported_dps)])
            by_report = (total[rows + 1 :] - total[1:-rows]) / rows
            allowed = np.where(doubt > self.tolerance, self.tolerance, np.inf)
            found += self._worst(by_report, allowed, rows)
        return found

    def _worst(self, rate_dps: Array, allowed: Array, rows: int) -> list[Lapse]:
        excess = np.abs(rate_dps / self.demanded_dps - 1) - allowed
        worst = int(np.argmax(excess))
        if not excess[worst] > 0:
            return []
        first = int(np.argmax(excess > 0))
        return [Lapse(float(excess[worst]), float(rate_dps[worst]), worst + rows, first + rows)]


@dataclass(frozen=True)
class Lapse:
    """A rate that was not held: relative ``excess`` over what is allowed, the rate, the row at whose end it
    was worst, and the row by which it began."""

    excess: float
    rate_dps: float
    worst_row: int
    first_row: int
