"""When something counts as steady: table rate and angle by what the table reports, supply current by its
spread.

The table's reports of the hold time are averaged over four parts of it, so that the noise of single reports
does not decide; each part has to be within the tolerance. In the same way a table is judged that turns as
nobody demanded.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.interfaces import SupplyReading
from ahrs_lab.messages import Message
from ahrs_lab.procedures.commands import PointTo, SettleCurrent, SettleRate
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.table_trace import TableTrace

Array = NDArray[np.float64]

_PARTS = 4
_NO_CURRENT_A = 1e-3
_CLEARLY, _CLEARLY_DPS = 0.1, 0.2
"""Of the step and the demand together, and at least: more than an overshoot or the noise of a report."""
_COMES_NEARER = 0.01
"""Of what is missing, over a judgement."""


class TableRunsAwayError(InstrumentError):
    """The table turns as nobody demanded, and may not stop either."""


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
    means = _means_of_parts(t, error, now_s, hold_s)
    return means is not None and bool(np.max(np.abs(means)) <= tolerance)


def _means_of_parts(t: Array, values: Array, now_s: float, hold_s: float) -> Array | None:
    """Of each quarter of the last ``hold_s``; None where one of them has no reports."""
    part = np.clip(((t - (now_s - hold_s)) / hold_s * _PARTS).astype(int), 0, _PARTS - 1)
    counts = np.bincount(part, minlength=_PARTS)
    if counts.min() == 0:
        return None
    return np.asarray(np.bincount(part, weights=values, minlength=_PARTS) / counts)


class Obedience:
    """Whether a table that has been told a rate goes there at all, judged over ``window_s``.

    It does not where it turns the wrong way or clearly faster than demanded and comes no nearer. A table on
    its way from another rate, through zero as well, comes nearer all the time; one that is slow, overshoots
    or swings about the demand is none of this.
    """

    def __init__(self, wanted: SettleRate, came_from_dps: float, window_s: float) -> None:
        demanded_dps = wanted.rate_dps
        self._demanded = demanded_dps
        # A table that needs all of the time limit, twice over, still comes nearer.
        self._nearer = min(_COMES_NEARER, 0.5 * (1.0 - 1.0 / _PARTS) * window_s / wanted.timeout_s)
        self._margin = max(_CLEARLY * (abs(demanded_dps - came_from_dps) + abs(demanded_dps)), _CLEARLY_DPS)
        self.window_s = window_s

    def check(self, trace: TableTrace, now_s: float) -> None:
        """Raises :class:`TableRunsAwayError`. Reported rates and angles both have to tell it, each as far as
        noise and doubtful times allow."""
        t, _, rate = trace.since(now_s - self.window_s)
        means = _means_of_parts(t, rate, now_s, self.window_s)
        if means is None or not np.all(self._wrong(means)):
            return
        turned_dps, doubt_dps = trace.turned_since(now_s - self.window_s)
        if not self._wrong(turned_dps - np.clip(turned_dps, -doubt_dps, doubt_dps)):
            return
        missing = np.abs(means - self._demanded)
        if missing[0] - missing[-1] <= self._nearer * missing[0]:
            raise self._failure(float(means[-1]))

    def _wrong(self, rate_dps: Array | float) -> NDArray[np.bool_] | np.bool_:
        along = np.asarray(rate_dps) * (1.0 if self._demanded >= 0.0 else -1.0)
        return (along < -self._margin) | (along > abs(self._demanded) + self._margin)

    def _failure(self, rate_dps: float) -> TableRunsAwayError:
        backwards = rate_dps * self._demanded < 0.0
        said = Message(
            "The table {how}: it turns at {actual} °/s, demanded are {demanded} °/s, and it comes no nearer. "
            "Press the table's own emergency stop and do not go near it before it rests. Then check its "
            "controller, its encoder and the connection to it. What was recorded is kept.",
            how=Message("turns the wrong way") if backwards else Message("turns too fast"),
            actual=round(rate_dps, 2),
            demanded=figure(self._demanded),
        )
        return TableRunsAwayError(said)


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
