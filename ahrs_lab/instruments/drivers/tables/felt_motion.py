"""What the unit on a table set by hand has felt, against what was asked for.

It is good enough to tell 10 °/s from −10 °/s and from standing still, not to measure the table: its scale
factor is what is being calibrated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.by_hand import HandFinding, HandRequest
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.settings import within
from ahrs_lab.messages import Message

Array = NDArray[np.float64]

_PARTS = 4
_KEEP_S = 60.0
_LEAST_ROWS = 4


@dataclass(frozen=True)
class ManualSettings:
    """``relative_tolerance`` and ``tolerance_dps``: how far the unit's rate may be from what was asked for
    and still count as it; ``turn_tolerance``: the same of an angle travelled, relative, at least
    ``angle_tolerance_deg`` and never half a turn; ``check_s``: for how long it has to hold."""

    limits: SoftLimits
    name: str = "manual rate table"
    relative_tolerance: float = 0.05
    tolerance_dps: float = 0.5
    turn_tolerance: float = 0.05
    angle_tolerance_deg: float = 10.0
    check_s: float = 2.0

    def __post_init__(self) -> None:
        within("relative_tolerance", self.relative_tolerance, 0.0, 0.5)
        within("tolerance_dps", self.tolerance_dps, 0.01, 10.0)
        within("turn_tolerance", self.turn_tolerance, 0.0, 0.5)
        within("angle_tolerance_deg", self.angle_tolerance_deg, 0.1, 90.0)
        within("check_s", self.check_s, 0.5, 30.0)

    def allowed_dps(self, rate_dps: float) -> float:
        """How far the felt rate may be off, °/s."""
        return max(self.tolerance_dps, self.relative_tolerance * abs(rate_dps))

    def allowed_deg(self, travel_deg: float) -> float:
        """How far the felt turning may be off, °."""
        return min(max(self.angle_tolerance_deg, self.turn_tolerance * abs(travel_deg)), 179.0)


class FeltRates:
    """The last minute of the unit's rates; ``angle_deg`` is their integral since :meth:`restart`."""

    def __init__(self) -> None:
        self._t_s = self._rate_dps = np.empty(0)
        self.angle_deg = 0.0

    def add(self, t_s: Array, rate_dps: Array) -> None:
        """Later rows than before, shapes (n,)."""
        known = len(self._t_s) > 0
        steps = np.diff(t_s, prepend=self._t_s[-1] if known else t_s[0])
        before = np.concatenate([self._rate_dps[-1:] if known else rate_dps[:1], rate_dps[:-1]])
        self.angle_deg += float(np.sum(0.5 * (rate_dps + before) * steps))
        first = int(np.searchsorted(self._t_s, t_s[-1] - _KEEP_S))
        self._t_s = np.concatenate([self._t_s[first:], t_s])
        self._rate_dps = np.concatenate([self._rate_dps[first:], rate_dps])

    def restart(self) -> None:
        """Count the angle from here."""
        self.angle_deg = 0.0

    @property
    def last_s(self) -> float | None:
        """When something was felt last; None: never."""
        return float(self._t_s[-1]) if len(self._t_s) else None

    def since(self, t_s: float) -> Array:
        """The rates felt after a bench time, °/s."""
        return self._rate_dps[int(np.searchsorted(self._t_s, t_s, side="right")) :]

    def mean_dps(self, window_s: float) -> float:
        """Over the last ``window_s`` of what was felt; 0 before the first."""
        rates = self.since(self._t_s[-1] - window_s) if len(self._t_s) else np.empty(0)
        return float(rates.mean()) if len(rates) else 0.0


class SteadyHold:
    """Whether the unit goes on to feel what was accepted, second by second."""

    def __init__(self) -> None:
        self._from_s: float | None = None
        self._t_s = self._rate_dps = np.empty(0)
        self.off_dps: float | None = None
        """The first second's mean that was not within; None: it held."""

    def restart(self, t_s: float | None) -> None:
        """Watch from ``t_s`` on; None: not."""
        self._from_s, self.off_dps = t_s, None
        self._t_s = self._rate_dps = np.empty(0)

    def add(self, t_s: Array, rate_dps: Array, demanded_dps: float, allowed_dps: float) -> None:
        """Shapes (n,)."""
        if self._from_s is None or self.off_dps is not None:
            return
        t = np.concatenate([self._t_s, t_s[t_s > self._from_s]])
        rates = np.concatenate([self._rate_dps, rate_dps[t_s > self._from_s]])
        if not len(t):
            return
        second = np.floor(t - self._from_s).astype(int)
        whole = second < second[-1]
        self._t_s, self._rate_dps = t[~whole], rates[~whole]
        counts = np.bincount(second[whole])
        sums = np.bincount(second[whole], weights=rates[whole])
        means = sums[counts > 0] / counts[counts > 0]
        off = np.abs(means - demanded_dps) > allowed_dps
        if off.any():
            self.off_dps = float(means[np.argmax(off)])


def judge_rest(rates: Array, settings: ManualSettings) -> HandFinding:
    """Shape (n,), °/s: the table stands still."""
    worst = _worst_part(rates, 0.0)
    if abs(worst) <= settings.tolerance_dps:
        return HandFinding(True, True, Message("The device feels the table at rest."))
    return HandFinding(
        False,
        True,
        Message(
            "The device feels the table turn at {felt} °/s. Bring it to rest, then confirm again.",
            felt=signed(worst, 2),
        ),
    )


def judge_rate(rates: Array, asked_dps: float, settings: ManualSettings) -> HandFinding:
    """Shape (n,), °/s: the table turns at ``asked_dps`` and steadily."""
    allowed, mean = settings.allowed_dps(asked_dps), float(rates.mean())
    worst = _worst_part(rates, asked_dps)
    if abs(worst - asked_dps) <= allowed:
        message = Message("The device feels {felt} °/s.", felt=signed(mean, 2))
        return HandFinding(True, True, message)
    return HandFinding(False, True, _wrong_rate(mean, asked_dps, worst, allowed, settings))


def _wrong_rate(mean: float, asked: float, worst: float, allowed: float, settings: ManualSettings) -> Message:
    known = {"asked": signed(asked), "felt": signed(mean, 2), "sense": sense(asked)}
    if abs(mean) <= settings.tolerance_dps and abs(asked) > settings.tolerance_dps:
        return Message(
            "The device feels the table at rest. Set it to {asked} °/s, {sense} seen from above, then "
            "confirm again.",
            **known,
        )
    if abs(mean + asked) <= allowed:
        return Message(
            "The device feels {felt} °/s: the table turns the wrong way. Set it to {asked} °/s, {sense} seen "
            "from above, then confirm again.",
            **known,
        )
    if abs(mean - asked) <= allowed:
        return Message(
            "The device feels a rate that still changes, between {felt} °/s and {worst} °/s. Wait until the "
            "table turns steadily, then confirm again.",
            felt=signed(mean, 2),
            worst=signed(worst, 2),
        )
    return Message(
        "The device feels {felt} °/s, not {asked} °/s; up to {allowed} °/s off are accepted. Set the table "
        "to {asked} °/s, {sense} seen from above, then confirm again.",
        allowed=f"{allowed:g}",
        **known,
    )


def judge_travel(travelled_deg: float, request: HandRequest, settings: ManualSettings) -> HandFinding:
    """The table, which rests, has turned by ``request.travel_deg``."""
    if travel_is_right(travelled_deg, request, settings):
        message = Message("The device has felt {felt}°.", felt=signed(travelled_deg, 1))
        return HandFinding(True, True, message)
    known = {"felt": signed(travelled_deg, 0), "asked": signed(request.travel_deg, 0)}
    if request.kind == "turns":
        message = Message("The device has felt the table turn by {felt}°, not by {asked}°.", **known)
        return HandFinding(False, True, message, begin_again=True)
    return HandFinding(
        False,
        True,
        Message(
            "The device has felt the table turn by {felt}°, not by {asked}°. Turn it to {angle}° on its "
            "scale, then confirm again.",
            angle=f"{request.angle_deg:g}",
            **known,
        ),
    )


def travel_is_right(travelled_deg: float, request: HandRequest, settings: ManualSettings) -> bool:
    """Turns count in number and sense; to an angle any way is good."""
    off = travelled_deg - request.travel_deg
    if request.kind == "angle":
        off = (off + 180.0) % 360.0 - 180.0
    return abs(off) <= settings.allowed_deg(request.travel_deg)


def sense(rate_dps: float) -> Message:
    """The sense of rotation, seen from above."""
    return Message("anticlockwise") if rate_dps > 0 else Message("clockwise")


def signed(value: float, decimals: int | None = None) -> str:
    """With its sign, a true minus; without ``decimals`` as many digits as are meant."""
    text = f"{value:+g}" if decimals is None else f"{value:+.{decimals}f}"
    return text.replace("-", "\N{MINUS SIGN}")


def enough(rates: Array) -> bool:
    """Whether there is something to judge."""
    return len(rates) >= _LEAST_ROWS


def _worst_part(rates: Array, asked_dps: float) -> float:
    """Of the means of four consecutive parts the one that is furthest off."""
    means = np.array([part.mean() for part in np.array_split(rates, _PARTS)])
    return float(means[np.argmax(np.abs(means - asked_dps))])
