"""What any rate table is allowed to do, whoever asks: refused before it is sent, stopped where exceeded.

The limits hold for a run as for a hand on the jog buttons. They are software: no replacement for the limits
and the emergency stop of the table itself.
"""

from __future__ import annotations

import math
from collections import deque

from ahrs_lab.errors import AhrsLabError, InputError, InstrumentError
from ahrs_lab.instruments.by_hand import SetByHand
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import RateTable, TableLimits, TableLog, TableState
from ahrs_lab.messages import Message

_OVER = 1.2
"""A table that overshoots its demand a little is well; one that is this far beyond its limit runs away."""
_OVER_ACCELERATION = 1.5
_WINDOW_S = 0.5
"""Over a shorter time the noise of the reported rate would be taken for acceleration."""
_LONGEST_WINDOW_S = 2.0
_LEAST_EXCESS_DPS = 1.0
_REACTION_S = 0.2
"""Between a look at the table and its obeying a stop."""


class LimitedTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable` around another one.

    Rates and angles beyond the limits are refused with InputError and nothing is sent. Every :meth:`state`
    compares what the table does with what it may do; where it turns faster, accelerates harder or is about to
    leave its range it is stopped, and InstrumentError says so until it is enabled again.
    """

    def __init__(self, table: RateTable, limits: SoftLimits) -> None:
        self._table = table
        self._soft = limits
        self._looks: deque[tuple[float, float, float]] = deque()
        self._tripped: InstrumentError | None = None
        _refuse_more_than_the_table_can(limits, table.limits)
        self.limits = limits.table_limits

    @property
    def soft_limits(self) -> SoftLimits:
        """What it holds the table to."""
        return self._soft

    def identify(self) -> str:
        """Of the table."""
        return self._table.identify()

    def enable(self) -> None:
        """Also acknowledges that a limit has stopped the table."""
        self._tripped = None
        self._looks.clear()
        self._table.enable()

    def disable(self) -> None:
        """Of the table."""
        self._table.disable()

    def set_rate(self, rate_dps: float) -> None:
        """Raises InputError beyond the limit, or away from the range at its end."""
        self._soft.check_rate(rate_dps)
        self._raise_if_tripped()
        if rate_dps and not self._soft.continuous:
            angle = self._table.state().angle_deg
            if self._soft.must_stop(angle, rate_dps, _REACTION_S):
                raise InputError(
                    "The rate table stands at {angle_deg}° and may not turn at {rate_dps} °/s from there: "
                    "its "
                    "range is set to {low}° … {high}°.",
                    angle_deg=round(angle, 3),
                    rate_dps=rate_dps,
                    low=self._soft.min_angle_deg,
                    high=self._soft.max_angle_deg,
                )
        self._table.set_rate(rate_dps)

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """Raises InputError where the angle or the rate is not allowed."""
        self._soft.check_move(angle_deg, rate_dps)
        self._raise_if_tripped()
        self._table.move_to(angle_deg, rate_dps)

    def stop(self) -> None:
        """Never refused."""
        self._table.stop()

    def state(self) -> TableState:
        """What the table does, compared with what it may. Raises InstrumentError where a limit stopped it."""
        state = self._table.state()
        if isinstance(self._table, SetByHand):
            return state  # only a person can stop it
        excess = self._excess(state)
        if excess is not None and self._tripped is None:
            self._tripped = self._stopped(excess)
        self._raise_if_tripped()
        return state

    def log(self) -> TableLog:
        """Of the table."""
        return self._table.log()

    def _excess(self, state: TableState) -> Message | None:
        soft = self._soft
        if abs(state.rate_dps) > max(_OVER * soft.max_rate_dps, soft.max_rate_dps + _LEAST_EXCESS_DPS):
            return Message(
                "it turned at {rate} °/s, its limit is set to {limit} °/s",
                rate=round(state.rate_dps, 2),
                limit=soft.max_rate_dps,
            )
        if state.moving and soft.must_stop(state.angle_deg, state.rate_dps, _REACTION_S):
            return Message(
                "at {angle}° and {rate} °/s it would have left its range {low}° … {high}°",
                angle=round(state.angle_deg, 2),
                rate=round(state.rate_dps, 2),
                low=soft.min_angle_deg,
                high=soft.max_angle_deg,
            )
        acceleration = self._acceleration(state)
        if acceleration > _OVER_ACCELERATION * soft.max_acceleration_dps2 + _LEAST_EXCESS_DPS / _WINDOW_S:
            return Message(
                "it accelerated with {acceleration} °/s², its limit is set to {limit} °/s²",
                acceleration=round(acceleration, 1),
                limit=soft.max_acceleration_dps2,
            )
        return None

    def _acceleration(self, state: TableState) -> float:
        """Mean magnitude over the last half second, as little as the doubt about when it was seen allows,
        °/s²; 0 before that much was seen."""
        looks = self._looks
        if looks and state.t_s <= looks[-1][0]:
            return 0.0
        looks.append((state.t_s, state.rate_dps, state.doubt_s))
        while len(looks) > 2 and state.t_s - looks[1][0] >= _WINDOW_S:
            looks.popleft()
        passed = state.t_s - looks[0][0]
        if not _WINDOW_S <= passed <= _LONGEST_WINDOW_S:
            return 0.0
        return abs(state.rate_dps - looks[0][1]) / (passed + looks[0][2] + state.doubt_s)

    def _stopped(self, excess: Message) -> InstrumentError:
        try:
            self._table.stop()
        except AhrsLabError as error:
            return InstrumentError(
                "The rate table has exceeded its limits ({excess}) and could not be stopped ({reason}): use "
                "the emergency stop.",
                excess=excess,
                reason=error.message,
            )
        return InstrumentError(
            "The rate table was stopped: {excess}. Find the cause, then enable the table again.",
            excess=excess,
        )

    def _raise_if_tripped(self) -> None:
        if self._tripped is not None:
            raise self._tripped


def _refuse_more_than_the_table_can(limits: SoftLimits, able: TableLimits) -> None:
    for name, asked, possible in (
        ("max_rate_dps", limits.max_rate_dps, able.max_rate_dps),
        ("max_acceleration_dps2", limits.max_acceleration_dps2, able.max_acceleration_dps2),
    ):
        if math.isfinite(possible) and asked > possible * (1.0 + 1e-9):
            raise InputError(
                "The limit {name} is set to {asked}, but the rate table goes up to {possible}: lower it.",
                name=name,
                asked=asked,
                possible=possible,
            )
