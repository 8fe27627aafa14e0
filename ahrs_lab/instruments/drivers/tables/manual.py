"""A table without a link: the operator sets it by hand, the application asks, and the unit on it tells
whether it happened.

What the unit shows is good enough to tell 10 °/s from −10 °/s and from standing still, not to measure the
table: its scale factor is what is being calibrated. So the rate is taken to be the one that was asked for as
long as the unit agrees with it roughly, and the unit's own where it does not.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Clock, TableLog, TableState
from ahrs_lab.instruments.settings import within
from ahrs_lab.messages import Message

Array = NDArray[np.float64]

_AT_REST_DPS = 0.5


@dataclass(frozen=True)
class ManualSettings:
    """``relative_tolerance`` and ``tolerance_dps``: how far the unit's rate may be from what was asked for
    and still count as it; ``turn_tolerance``: the same of an angle travelled, relative, at least
    ``angle_tolerance_deg``."""

    limits: SoftLimits
    name: str = "manual rate table"
    relative_tolerance: float = 0.05
    tolerance_dps: float = 0.5
    turn_tolerance: float = 0.05
    angle_tolerance_deg: float = 10.0

    def __post_init__(self) -> None:
        within("relative_tolerance", self.relative_tolerance, 0.0, 0.5)
        within("tolerance_dps", self.tolerance_dps, 0.01, 10.0)
        within("turn_tolerance", self.turn_tolerance, 0.0, 0.5)
        within("angle_tolerance_deg", self.angle_tolerance_deg, 0.1, 90.0)


@dataclass(frozen=True)
class ManualRequest:
    """What the operator is asked to do; ``message`` says it. ``travel_deg``: from where the table stands."""

    kind: Literal["enable", "rate", "position", "stop", "disable"]
    message: Message
    rate_dps: float = 0.0
    angle_deg: float = 0.0
    travel_deg: float = 0.0


class ManualTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`.

    ``ask`` shows a request and returns when the operator confirms; it raises AbortedError where the person
    gives up. Calls that move the table therefore take as long as the person does. ``rates`` gives bench times
    and the unit's rates about the table's axis (°/s, right hand about up) since it was called last; empty
    while the unit does not stream, then the confirmation is all there is.
    """

    def __init__(
        self,
        settings: ManualSettings,
        clock: Clock,
        ask: Callable[[ManualRequest], None],
        rates: Callable[[], tuple[Array, Array]],
    ) -> None:
        self.limits = settings.limits.table_limits
        self._settings = settings
        self._clock = clock
        self._ask = ask
        self._rates = rates
        self._lock = threading.RLock()
        self._enabled = False
        self._demanded_dps = 0.0
        self._confirmed = True
        self._angle_deg = 0.0
        self._rate_dps = 0.0
        self._seen_s: float | None = None
        self._log: list[Array] = []

    def open(self) -> str:
        """There is nothing to connect."""
        return self.identify()

    def identify(self) -> str:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        return self._settings.name

    def enable(self) -> None:
        """Ask for the table to be switched on."""
        self._ask(
            ManualRequest("enable", Message("Switch the rate table on and make sure that it stands still."))
        )
        self._enabled = True

    def disable(self) -> None:
        """Ask for the table to be switched off."""
        self._ask(ManualRequest("disable", Message("Stop the rate table and switch it off.")))
        self._enabled, self._demanded_dps = False, 0.0

    def set_rate(self, rate_dps: float) -> None:
        """Ask for a rate; returns when the operator says that it is reached."""
        self._settings.limits.check_rate(rate_dps)
        self._demand(rate_dps)
        message = Message(
            "Set the rate table to {rate} °/s (positive: anticlockwise seen from above) and confirm when "
            "it turns steadily.",
            rate=f"{rate_dps:+g}",
        )
        self._ask(ManualRequest("rate", message, rate_dps=rate_dps))
        self._confirmed = True

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """Ask for an angle; returns when the operator says that the table stands there. Raises
        InstrumentError where the unit has seen another angle travelled."""
        self._settings.limits.check_move(angle_deg, rate_dps)
        self._follow()
        start = self._angle_deg
        travel = angle_deg - start
        self._demand(0.0)
        message = Message(
            "Turn the rate table by {travel}° ({turns} turns; positive: anticlockwise seen from above) "
            "with at most {rate} °/s, to {angle}°, and confirm when it stands there.",
            travel=f"{travel:+g}",
            turns=f"{travel / 360.0:+.3g}",
            rate=f"{rate_dps:g}",
            angle=f"{angle_deg:g}",
        )
        request = ManualRequest("position", message, rate_dps, angle_deg, travel)
        self._confirmed = False
        self._ask(request)
        seen = self._follow()
        with self._lock:
            travelled = self._angle_deg - start
            self._confirmed = True
            allowed = max(self._settings.angle_tolerance_deg, self._settings.turn_tolerance * abs(travel))
            if seen and abs(travelled - travel) > allowed:
                raise InstrumentError(
                    "The device has seen the table turn by {seen}°, not by {asked}°: turn it back and "
                    "start this step again.",
                    seen=round(travelled, 1),
                    asked=round(travel, 1),
                )
            self._angle_deg = angle_deg
            self._log.append(np.array([[self._clock.now_s(), angle_deg, self._rate_dps]]))

    def stop(self) -> None:
        """Ask for the table to be stopped; nothing is asked where it stands still."""
        moving = self.state().moving
        self._demand(0.0)
        if moving:
            self._ask(ManualRequest("stop", Message("Stop the rate table and confirm when it stands still.")))
        self._confirmed = True

    def state(self) -> TableState:
        """What was confirmed, unless the unit shows otherwise."""
        self._follow()
        with self._lock:
            now = self._clock.now_s()
            return TableState(
                t_s=now if self._seen_s is None else max(self._seen_s, 0.0),
                angle_deg=self._angle_deg,
                rate_dps=self._rate_dps if self._seen_s is not None else self._demanded_dps,
                demanded_rate_dps=self._demanded_dps,
                moving=abs(self._rate_dps) > _AT_REST_DPS or self._demanded_dps != 0.0,
                enabled=self._enabled,
            )

    def log(self) -> TableLog:
        """Rates and integrated angles at the unit's own samples."""
        self._follow()
        with self._lock:
            rows = np.concatenate([np.empty((0, 3)), *self._log])
            self._log.clear()
        return TableLog(*rows.T.copy())

    def close(self) -> None:
        """Nothing to release."""

    def _demand(self, rate_dps: float) -> None:
        self._follow()
        with self._lock:
            self._demanded_dps, self._confirmed = rate_dps, False

    def _follow(self) -> bool:
        """Take in what the unit has seen; whether it has ever seen anything."""
        with self._lock:
            t, seen = self._rates()
            if not len(t):
                return self._seen_s is not None
            rates = self._believed(np.asarray(seen, dtype=np.float64))
            before_t = t[0] if self._seen_s is None else self._seen_s
            before_rate = rates[0] if self._seen_s is None else self._rate_dps
            steps = np.diff(t, prepend=before_t)
            means = 0.5 * (rates + np.concatenate([[before_rate], rates[:-1]]))
            angles = self._angle_deg + np.cumsum(means * steps)
            self._log.append(np.column_stack([t, angles, rates]))
            self._seen_s = float(t[-1])
            self._angle_deg, self._rate_dps = float(angles[-1]), float(rates[-1])
            return True

    def _believed(self, seen: Array) -> Array:
        if not self._confirmed:
            return seen
        s = self._settings
        allowed = max(s.tolerance_dps, s.relative_tolerance * abs(self._demanded_dps))
        return np.where(np.abs(seen - self._demanded_dps) <= allowed, self._demanded_dps, seen)
