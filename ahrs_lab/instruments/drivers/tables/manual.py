"""A table without a link: the operator sets it by hand, the application asks, and the unit on it tells
whether it happened.

The rate is taken to be the one that was asked for as long as the unit agrees with it roughly, and the unit's
own where it does not: see :mod:`~ahrs_lab.instruments.drivers.tables.felt_motion`.
"""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.by_hand import Felt, HandFinding, HandRequest
from ahrs_lab.instruments.drivers.tables.felt_motion import (
    FeltRates,
    ManualSettings,
    SteadyHold,
    enough,
    judge_rate,
    judge_rest,
    judge_travel,
    sense,
    signed,
    travel_is_right,
)
from ahrs_lab.instruments.interfaces import Clock, TableLog, TableState
from ahrs_lab.messages import Message

Array = NDArray[np.float64]

_FRESH_S = 1.0
"""What was felt longer ago says nothing of now."""
_NOW_S = 0.5
_SHOWN_S = 1.0
_SAME_DEG = 0.5
"""Nobody is asked to turn a table by less."""


class ManualTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable` that is
    :class:`~ahrs_lab.instruments.by_hand.SetByHand`. Angles count from the zero mark at which it is switched
    on."""

    def __init__(self, settings: ManualSettings, clock: Clock) -> None:
        self.limits = settings.limits.table_limits
        self._settings = settings
        self._clock = clock
        self._lock = threading.RLock()
        self._request: HandRequest | None = None
        self._enabled = False
        self._demanded_dps = 0.0
        self._confirmed = True
        self._turning = False
        self._angle_deg = 0.0
        self._angle_known = False
        self._rate_dps = 0.0
        self._felt = FeltRates()
        self._hold = SteadyHold()
        self._log: list[Array] = []

    # the interface of a table ─────────────────────────────────────────────────────────────────────────────

    def open(self) -> str:
        """There is nothing to connect."""
        return self.identify()

    def identify(self) -> str:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        return self._settings.name

    def enable(self) -> None:
        """Ask for the table to be switched on, at its zero mark."""
        self._ask(
            HandRequest(
                "switch_on",
                Message("Switch the rate table on and let it stand still at its zero mark."),
            )
        )

    def disable(self) -> None:
        """Ask for the table to be switched off."""
        self._ask(HandRequest("switch_off", Message("Stop the rate table and switch it off.")))

    def set_rate(self, rate_dps: float) -> None:
        """Ask for a rate. Raises InputError beyond the limits."""
        self._settings.limits.check_rate(rate_dps)
        if rate_dps == 0.0:
            self.stop()
            return
        message = Message(
            "Set the rate table to {rate} °/s ({sense} seen from above) and confirm when it turns steadily.",
            rate=signed(rate_dps),
            sense=sense(rate_dps),
        )
        self._ask(HandRequest("rate", message, rate_dps=rate_dps), rate_dps)

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """Ask for an angle or, where the way there is whole turns, for these; nothing is asked where the
        table stands there. Raises InputError beyond the limits."""
        self._settings.limits.check_move(angle_deg, rate_dps)
        with self._lock:
            travel = angle_deg - self._angle_deg
            turns = round(travel / 360.0)
            if self._angle_known and abs(travel) < _SAME_DEG:
                self._stand_at(angle_deg)
            elif turns and abs(travel - 360.0 * turns) < _SAME_DEG:
                self._ask(_turns(turns, travel, angle_deg, rate_dps))
            else:
                self._ask(_angle(travel, angle_deg, rate_dps))

    def stop(self) -> None:
        """Ask for the table to be brought to rest; nothing is asked where it stands still."""
        with self._lock:
            if self._moves():
                message = Message("Bring the rate table to rest by hand and confirm when it stands still.")
                self._ask(HandRequest("rest", message))
            else:
                self._request, self._demanded_dps, self._turning = None, 0.0, False

    def state(self) -> TableState:
        """What was confirmed, unless the unit shows otherwise."""
        with self._lock:
            feels, last = self._feels(), self._felt.last_s
            unfelt = self._demanded_dps if self._confirmed else 0.0
            return TableState(
                t_s=last if feels and last is not None else self._clock.now_s(),
                angle_deg=self._angle_deg,
                rate_dps=self._rate_dps if feels else unfelt,
                demanded_rate_dps=self._demanded_dps,
                moving=self._moves(),
                enabled=self._enabled,
            )

    def log(self) -> TableLog:
        """Rates and integrated angles at the unit's own samples."""
        with self._lock:
            rows = np.concatenate([np.empty((0, 3)), *self._log])
            self._log.clear()
        return TableLog(*rows.T.copy())

    def close(self) -> None:
        """Nothing to release."""

    # set by hand ──────────────────────────────────────────────────────────────────────────────────────────

    @property
    def request(self) -> HandRequest | None:
        """See :class:`~ahrs_lab.instruments.by_hand.SetByHand`."""
        return self._request

    def feel(self, t_s: Array, rate_dps: Array) -> None:
        """See :class:`~ahrs_lab.instruments.by_hand.SetByHand`."""
        with self._lock:
            last = self._felt.last_s
            later = slice(0 if last is None else int(np.searchsorted(t_s, last, side="right")), None)
            t, seen = t_s[later], rate_dps[later]
            if not len(t):
                return
            rates = self._believed(seen)
            steps = np.diff(t, prepend=t[0] if last is None else last)
            before = np.concatenate([[rates[0] if last is None else self._rate_dps], rates[:-1]])
            angles = self._angle_deg + np.cumsum(0.5 * (rates + before) * steps)
            self._log.append(np.column_stack([t, angles, rates]))
            self._angle_deg, self._rate_dps = float(angles[-1]), float(rates[-1])
            self._felt.add(t, seen)
            allowed = self._settings.allowed_dps(self._demanded_dps)
            self._hold.add(t, seen, self._demanded_dps, allowed)

    def felt(self) -> Felt:
        """See :class:`~ahrs_lab.instruments.by_hand.SetByHand`."""
        with self._lock:
            request = self._request
            wanted = request.rate_dps if request is not None and request.kind == "rate" else 0.0
            allowed = self._settings.allowed_dps(wanted)
            if not self._feels():
                return Felt(None, None, allowed, False)
            rate, travel = self._felt.mean_dps(_SHOWN_S), self._felt.angle_deg
            holds = abs(rate - wanted) <= allowed
            if request is not None and self._travel_tells(request):
                allowed = self._settings.allowed_deg(request.travel_deg)
                holds = holds and travel_is_right(travel, request, self._settings)
            return Felt(rate, travel, allowed, holds)

    def check(self, since_s: float, *, blind: bool) -> HandFinding | None:
        """See :class:`~ahrs_lab.instruments.by_hand.SetByHand`."""
        with self._lock:
            request = self._request
            if request is None or blind:
                finding = HandFinding(True, False, _OPERATORS_WORD)
            else:
                last = self._felt.last_s or 0.0
                rates = self._felt.since(since_s)
                if last - since_s < 0.8 * self._settings.check_s or not enough(rates):
                    return None
                finding = self._judge(request, rates)
            if request is not None and finding.accepted:
                self._accept(request)
            elif finding.begin_again:
                self._angle_known = False
            return finding

    def strayed(self) -> HandFinding | None:
        """See :class:`~ahrs_lab.instruments.by_hand.SetByHand`."""
        with self._lock:
            off, self._hold.off_dps = self._hold.off_dps, None
            if off is None:
                return None
            message = Message(
                "The table has not kept {asked} °/s while it was recorded: the device has felt {felt} °/s. "
                "That recording does not count; it is made again.",
                asked=signed(self._demanded_dps) if self._demanded_dps else "0",
                felt=signed(off, 2),
            )
            return HandFinding(False, True, message, begin_again=True)

    # ──────────────────────────────────────────────────────────────────────────────────────────────────────

    def _ask(self, request: HandRequest, rate_dps: float = 0.0) -> None:
        with self._lock:
            if request.kind in ("rate", "angle", "turns"):
                self._turning = True
            if request.kind == "rate":
                self._angle_known = False
            self._request, self._demanded_dps, self._confirmed = request, rate_dps, False
            self._felt.restart()
            self._hold.restart(None)

    def _judge(self, request: HandRequest, rates: Array) -> HandFinding:
        if request.kind == "rate":
            return judge_rate(rates, request.rate_dps, self._settings)
        rest = judge_rest(rates, self._settings)
        if rest.accepted and self._travel_tells(request):
            return judge_travel(self._felt.angle_deg, request, self._settings)
        return rest

    def _travel_tells(self, request: HandRequest) -> bool:
        """Turns count from wherever they begin; an angle only from one that is known."""
        return request.kind == "turns" or (request.kind == "angle" and self._angle_known)

    def _accept(self, request: HandRequest) -> None:
        self._request, self._confirmed = None, True
        self._turning = request.kind == "rate"
        self._hold.restart(self._felt.last_s)
        if request.kind in ("switch_on", "switch_off"):
            self._enabled = request.kind == "switch_on"
        if request.kind in ("switch_on", "angle", "turns"):
            self._stand_at(request.angle_deg)

    def _stand_at(self, angle_deg: float) -> None:
        self._angle_deg, self._angle_known = angle_deg, True
        self._log.append(np.array([[self._clock.now_s(), angle_deg, 0.0]]))

    def _feels(self) -> bool:
        last = self._felt.last_s
        return last is not None and self._clock.now_s() - last < _FRESH_S

    def _moves(self) -> bool:
        if self._feels():
            return abs(self._felt.mean_dps(_NOW_S)) > self._settings.tolerance_dps
        return self._turning

    def _believed(self, seen: Array) -> Array:
        if not self._confirmed:
            return seen
        allowed = self._settings.allowed_dps(self._demanded_dps)
        return np.where(np.abs(seen - self._demanded_dps) <= allowed, self._demanded_dps, seen)


_OPERATORS_WORD = Message(
    "The device does not tell what the table does: that it does what was asked is the operator's word."
)


def _turns(turns: int, travel: float, angle_deg: float, rate_dps: float) -> HandRequest:
    message = Message(
        "Turn the rate table by {turns} whole turns ({sense} seen from above) with at most {rate} °/s, bring "
        "it to rest where it began, and confirm.",
        turns=abs(turns),
        sense=sense(travel),
        rate=f"{rate_dps:g}",
    )
    return HandRequest("turns", message, rate_dps, angle_deg, travel)


def _angle(travel: float, angle_deg: float, rate_dps: float) -> HandRequest:
    message = Message(
        "Turn the rate table to {angle}° on its scale (counted anticlockwise seen from above) and confirm "
        "when it stands still there.",
        angle=f"{angle_deg % 360.0:g}",
    )
    return HandRequest("angle", message, rate_dps, angle_deg, travel)
