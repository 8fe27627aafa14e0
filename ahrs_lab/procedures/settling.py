"""When something counts as steady: table rate and angle by what the table reports, supply current by its
spread.

The table's reports of the hold time are averaged over four parts of it, so that the noise of single reports
does not decide; each part has to be within the tolerance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.interfaces import SupplyReading
from ahrs_lab.procedures.commands import PointTo, SettleCurrent, SettleRate
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.table_trace import TableTrace

Array = NDArray[np.float64]

_PARTS = 4
_NO_CURRENT_A = 1e-3


def rate_is_steady(trace: TableTrace, now_s: float, wanted: SettleRate) -> bool:
    """Whether the table has reported the rate within tolerance over all of the last ``hold_s``."""
    t, _, rate = trace.since(now_s - wanted.hold_s)
    return _all_parts_within(t, rate - wanted.rate_dps, now_s, wanted.hold_s, wanted.tolerance_dps)


def angle_is_steady(trace: TableTrace, now_s: float, target_deg: float, wanted: PointTo) -> bool:
    """Whether the table has reported the angle within tolerance over all of the last ``hold_s``."""
    t, angle, _ = trace.since(now_s - wanted.hold_s)
    return _all_parts_within(t, angle - target_deg, now_s, wanted.hold_s, wanted.tolerance_deg)


def _all_parts_within(t: Array, error: Array, now_s: float, hold_s: float, tolerance: float) -> bool:
    """Shapes (n,): every quarter of the hold time has reports and their mean is within ``tolerance``."""
    part = np.clip(((t - (now_s - hold_s)) / hold_s * _PARTS).astype(int), 0, _PARTS - 1)
    counts = np.bincount(part, minlength=_PARTS)
    if counts.min() == 0:
        return False
    means = np.bincount(part, weights=error, minlength=_PARTS) / counts
    return bool(np.max(np.abs(means)) <= tolerance)


class SteadyCurrent:
    """The supply current over the hold time."""

    def __init__(self, wanted: SettleCurrent) -> None:
        self._wanted = wanted
        self._readings: list[tuple[float, float]] = []
        self._start_s: float | None = None

    def add(self, reading: SupplyReading) -> bool:
        """Take a reading; True once the current has kept within ± the relative tolerance for ``hold_s``."""
        if self._start_s is None:
            self._start_s = reading.t_s
        self._readings.append((reading.t_s, reading.current_a))
        first = reading.t_s - self._wanted.hold_s
        self._readings = [entry for entry in self._readings if entry[0] >= first - 1e-9]
        full = reading.t_s - self._start_s >= self._wanted.hold_s - 1e-9
        mean, half_spread = self._spread()
        return full and mean > _NO_CURRENT_A and half_spread <= self._wanted.tolerance * mean

    def _spread(self) -> tuple[float, float]:
        currents = [current for _, current in self._readings]
        return sum(currents) / len(currents), (max(currents) - min(currents)) / 2.0

    def failure(self, passed_s: float) -> InstrumentError:
        """What to say when it never became steady."""
        mean, half_spread = self._spread()
        if mean <= _NO_CURRENT_A:
            return InstrumentError(
                "The device draws no current ({current} A) {passed} s after power-on: check the power cable "
                "and the supply's terminals.",
                current=round(mean, 4),
                passed=round(passed_s),
            )
        return InstrumentError(
            "The supply current has not settled within {timeout} s: {current} A ± {spread} A, allowed are "
            "±{tolerance} A. Check the cable and the device, or widen power.current_tolerance.",
            timeout=figure(self._wanted.timeout_s),
            current=round(mean, 4),
            spread=round(half_spread, 4),
            tolerance=round(self._wanted.tolerance * mean, 4),
        )
