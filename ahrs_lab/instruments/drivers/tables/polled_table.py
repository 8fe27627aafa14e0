"""A rate table that is asked about itself 20 to 50 times a second, whatever language it speaks.

One thread looks at the table: it unwraps the angle, keeps the log, brings long moves to their end, minds the
soft limits, a lost link and the watchdog. Commands come from any thread; one lock is held around each
conversation, and a stop goes between the commands of whatever is being said and cancels the rest.

All of this is software: it is no emergency stop. A computer that hangs or loses its link cannot stop a table.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ahrs_lab.errors import AbortedError, AhrsLabError, InstrumentError
from ahrs_lab.instruments.angles import TurnCounter, wrap_180
from ahrs_lab.instruments.drivers.tables.dialect import TableDialect, TableReading
from ahrs_lab.instruments.drivers.tables.plausibility import JUMPED, ODD, Look, Slack, fits
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.drivers.tables.turning import REACH_DEG, Demand, Move
from ahrs_lab.instruments.interfaces import Clock, TableLog, TableState
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.port_reader import FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S
from ahrs_lab.instruments.patience import patient_s, wall_s
from ahrs_lab.instruments.settings import within
from ahrs_lab.messages import Message

_LOG_LENGTH = 400_000
_STALE_S = 1.0
_LATE_LOOK_S = 0.15
"""Wall time between two looks of a busy computer."""


@dataclass(frozen=True)
class Polling:
    """How often the table is looked at, and what counts as being at rest and in position. ``watchdog_s``: the
    table is stopped where :meth:`PolledTable.keep_alive`, once called, is not called again for so long."""

    poll_hz: float = 40.0
    at_rest_dps: float = 0.02
    in_position_deg: float = 0.01
    watchdog_s: float = 2.0

    def __post_init__(self) -> None:
        within("polling.poll_hz", self.poll_hz, 1.0, 200.0)
        within("polling.at_rest_dps", self.at_rest_dps, 1e-6, 10.0)
        within("polling.in_position_deg", self.in_position_deg, 1e-6, 1.0)
        within("polling.watchdog_s", self.watchdog_s, 0.1, 60.0)


class PolledTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable` over a dialect. :meth:`open` connects and starts
    the thread; a test may call :meth:`connect` and :meth:`poll` itself."""

    def __init__(
        self, dialect: TableDialect, limits: SoftLimits, clock: Clock, polling: Polling | None = None
    ) -> None:
        self.limits = limits.table_limits
        self._soft = limits
        self._dialect = dialect
        self._clock = clock
        self._polling = polling or Polling()
        self._talk = threading.RLock()
        self._commanding = threading.RLock()
        self._generation = 0
        self._last_command_s = float("-inf")
        self._told_to_move_s = float("-inf")
        self._turns = TurnCounter()
        self._look: Look | None = None
        self._reports_rate = True
        self._interval_s = 1.0 / self._polling.poll_hz
        self._log: deque[Look] = deque(maxlen=_LOG_LENGTH)
        self._mode: Literal["off", "rate", "position"] = "off"
        self._enabled = False
        self._demanded_dps = 0.0
        self._move: Move | None = None
        self._demand: Demand | None = None
        self._pending: deque[str] = deque()
        self._table_fault: str | Message = ""
        self._own_fault: Message | None = None
        self._lost: LinkLostError | None = None
        self._identity = ""
        self._alive_s: float | None = None
        self._end = threading.Event()
        self._thread: threading.Thread | None = None

    # life ─────────────────────────────────────────────────────────────────────────────────────────────────

    def open(self) -> str:
        """Connect and look at the table from now on; who answered. Raises InstrumentError."""
        identity = self.connect()
        if self._thread is None:
            self._end.clear()
            self._thread = threading.Thread(
                target=self._work, name=f"table {self._dialect.name}", daemon=True
            )
            self._thread.start()
        return identity

    def connect(self) -> str:
        """Open the link, ask who is there, and look once."""
        with self._talk:
            try:
                self._identity = self._dialect.connect()
                self._take(self._dialect.read())
            except AhrsLabError:
                self._dialect.disconnect()
                raise
            self._lost = None
        return self._identity

    def close(self) -> None:
        """End the thread and release the link; stops the table first where it may be turning, and raises
        where that fails. May be called again."""
        self._end.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join()
        try:
            if self._mode != "off" and self._lost is None:
                self.stop()
        finally:
            with self._talk:
                self._dialect.disconnect()

    def _work(self) -> None:
        period = 1.0 / self._polling.poll_hz
        back_off = FIRST_BACK_OFF_S
        while not self._end.wait(period if self._lost is None else back_off):
            back_off = FIRST_BACK_OFF_S if self._lost is None else min(2.0 * back_off, LONGEST_BACK_OFF_S)
            self.poll()

    # from procedures ──────────────────────────────────────────────────────────────────────────────────────

    def identify(self) -> str:
        """Who answered when the link was opened last."""
        return self._identity

    def enable(self) -> None:
        """Acknowledge faults and servo on, at rest. A fault that is still there shows in :meth:`state`."""
        with self._commanding:
            generation = self._begin(None, 0.0)
            self._own_fault, self._table_fault = None, ""
            self._say(generation, self._dialect.enabling())
            self._mode, self._enabled = "rate", True
            self.poll()

    def disable(self) -> None:
        """Stop and servo off."""
        with self._commanding:
            self.stop()
            self._say(self._generation, self._dialect.disabling())
            self._enabled = False

    def set_rate(self, rate_dps: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        self._soft.check_rate(rate_dps)
        with self._commanding:
            self._ready()
            generation = self._begin(None, rate_dps)
            self._say(generation, self._dialect.turning(rate_dps, entering=self._mode != "rate"))
            self._mode, self._told_to_move_s = "rate", self._last_command_s

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        self._soft.check_move(angle_deg, rate_dps)
        with self._commanding:
            self._ready()
            look = self._seen()
            pause, interval = self._dialect.pause_s, self._interval_s
            move = Move(
                angle_deg,
                self._followed_dps(rate_dps),
                self.limits.max_acceleration_dps2,
                delay_s=2.0 * interval + pause,
                prepare_s=3.0 * pause + 4.0 * interval,
            )
            demand = Demand("position")
            if self._dialect.wraps:
                demand = move.demand(look.angle_deg, look.rate_dps, None)
            generation = self._begin(move, 0.0)
            *preparing, starting = self._dialect.pointing(self._reported(angle_deg), rate_dps)
            if demand.mode == "position":
                self._say(generation, [*preparing, starting])
                self._mode, self._demand = "position", demand
                return
            self._say(generation, self._dialect.turning(demand.rate_dps, entering=self._mode != "rate"))
            with self._talk:
                if generation == self._generation:
                    self._mode, self._demand = "rate", demand
                    self._pending.extend(preparing)

    def _followed_dps(self, rate_dps: float) -> float:
        """A rate at which the end of a move is not missed between two looks that are late: slower where bench
        time runs faster than the wire."""
        late_s = wall_s(self._clock, _LATE_LOOK_S) - _LATE_LOOK_S
        return min(rate_dps, REACH_DEG / late_s) if late_s > 0.0 else rate_dps

    def stop(self) -> None:
        """Rate to zero, from any state and any thread, past whatever is being said."""
        self._generation += 1
        self._raise_if_lost()  # it is stopped as the first thing when the link is back
        with self._talk:
            self._generation += 1
            self._forget_move()
            self._demanded_dps = 0.0
            self._mode = "off"
            self._raise_if_lost()
            for command in self._dialect.stopping():
                self._dialect.send(command)
            self._last_command_s = self._told_to_move_s = self._clock.now_s()

    def state(self) -> TableState:
        """What was seen last. Raises LinkLostError while there is no link, InstrumentError where the table
        has not been seen for a second."""
        self._raise_if_lost()
        look = self._seen()
        now = self._clock.now_s()
        if now - look.t_s > patient_s(self._clock, max(_STALE_S, 5.0 / self._polling.poll_hz)):
            raise InstrumentError(
                "The rate table has not answered for {silence} s: check its link.",
                silence=round(now - look.t_s, 1),
            )
        return TableState(
            t_s=look.t_s,
            angle_deg=look.angle_deg,
            rate_dps=look.rate_dps,
            demanded_rate_dps=self._demanded_dps,
            moving=self._is_moving(look),
            enabled=self._enabled,
            fault=str(self._own_fault or self._table_fault),
            doubt_s=look.doubt_s,
        )

    def log(self) -> TableLog:
        """What was seen since the last call."""
        looks: list[Look] = []
        while self._log:
            looks.append(self._log.popleft())
        rows = [(look.t_s, look.angle_deg, look.rate_dps, look.doubt_s) for look in looks]
        columns = np.array(rows).reshape(-1, 4)
        t_s, angle, rate, doubt = columns.T.copy()
        return TableLog(t_s, angle, rate, doubt, self._reports_rate)

    def keep_alive(self) -> None:
        """The application's heart beats. From the first call on, the table is stopped when the next one does
        not come in time."""
        self._alive_s = self._clock.now_s()

    def rest_watchdog(self) -> None:
        """No more beats are to be expected."""
        self._alive_s = None

    # one look ─────────────────────────────────────────────────────────────────────────────────────────────

    def poll(self) -> None:
        """Look at the table and do what is due. Never raises: what is wrong shows in :meth:`state`."""
        if self._lost is not None:
            self._reconnect()
            return
        try:
            with self._talk:
                self._take(self._believable_reading())
                if self._enabled:
                    self._dialect.stay()
            self._mind()
        except LinkLostError as error:
            self._lose(error)
        except AbortedError:
            return  # a stop came in between: nothing more is due
        except AhrsLabError as error:
            self._give_up(error.message)

    def _believable_reading(self) -> TableReading:
        """A reading that fits to the one before, asked twice where it does not: a line without checksums may
        damage one. Raises InstrumentError where the table has really lost its position."""
        try:
            reading = self._dialect.read()
            if self._own_fault is not None or reading.fault or self._fits(reading, ODD):
                return reading
        except LinkLostError:
            raise
        except InstrumentError:
            pass  # an answer that was not understood is asked for once more
        again = self._dialect.read()
        if self._fits(again, JUMPED):
            return again
        before = self._seen().angle_deg
        self._take(again)
        raise InstrumentError(
            "The rate table's position has jumped to {angle}° from {before}°: it has lost its reference, "
            "or the line is disturbed. The table was stopped.",
            angle=round(again.angle_deg, 3),
            before=round(before, 3),
        )

    def _fits(self, reading: TableReading, slack: Slack) -> bool:
        last = self._look
        acceleration = self.limits.max_acceleration_dps2
        return last is None or fits(last, reading, slack, acceleration, wraps=self._dialect.wraps)

    def _take(self, reading: TableReading) -> None:
        rate = reading.rate_dps
        self._reports_rate = rate is not None
        if rate is None:
            rate = self._rate_from_angles(reading)
        angle = reading.angle_deg
        if self._dialect.wraps:
            angle = self._turns.unwrap(reading.t_s, angle, rate)
        if self._look is not None:
            self._interval_s = max(1.0 / self._polling.poll_hz, reading.t_s - self._look.t_s)
        self._look = Look(reading.t_s, angle, rate, reading.doubt_s)
        self._log.append(self._look)
        if reading.fault:
            self._table_fault = reading.fault
            self._enabled = False
            self._forget_move()
            self._demanded_dps = 0.0

    def _rate_from_angles(self, reading: TableReading) -> float:
        look = self._look
        if look is None or reading.t_s <= look.t_s:
            return 0.0
        change = reading.angle_deg - look.angle_deg
        if self._dialect.wraps:
            change = wrap_180(change - look.rate_dps * (reading.t_s - look.t_s))
            change += look.rate_dps * (reading.t_s - look.t_s)
        return change / (reading.t_s - look.t_s)

    def _mind(self) -> None:
        """Limits, the watchdog, and the move under way."""
        look = self._seen()
        now = self._clock.now_s()
        if self._mode != "off":
            longest = wall_s(self._clock, self._polling.watchdog_s)
            if self._alive_s is not None and now - self._alive_s > longest:
                raise InstrumentError(
                    "The table was stopped: the application has given no sign of life for {silence} s.",
                    silence=round(now - self._alive_s, 1),
                )
            if self._soft.must_stop(look.angle_deg, look.rate_dps, 2.0 * self._interval_s):
                raise InstrumentError(
                    "The table was stopped at {angle}°: it would have left the range that is set for it.",
                    angle=round(look.angle_deg, 2),
                )
        self._go_on_with_move(look, now)

    def _go_on_with_move(self, look: Look, now: float) -> None:
        with self._talk:
            move, generation = self._move, self._generation
            if move is None or self._demand is None:
                return
            if not self._pending:
                self._choose(move, look)
            if self._pending and now - self._last_command_s >= self._dialect.pause_s:
                self._send(generation, self._pending.popleft())

    def _choose(self, move: Move, look: Look) -> None:
        """Put what is to be said next on the list of what is pending."""
        wanted = Demand("position")
        if self._dialect.wraps:
            wanted = move.demand(look.angle_deg, look.rate_dps, self._demand)
        if wanted == self._demand:
            return
        if wanted.mode == "position":
            # Everything before was said while the table turned; a repeated start does no harm.
            self._pending.append(self._dialect.pointing(self._reported(move.target_deg), move.rate_dps)[-1])
        else:
            self._pending.extend(self._dialect.turning(wanted.rate_dps, entering=self._mode != "rate"))
        self._demand, self._mode = wanted, wanted.mode

    def _lose(self, error: LinkLostError) -> None:
        with self._talk:
            self._lost = error
            self._generation += 1
            self._forget_move()
            self._enabled = False
            self._dialect.disconnect()

    def _reconnect(self) -> None:
        """Once the link is back: same table? Then stop it; only :meth:`enable` goes on from there."""
        with self._talk:
            before, was, lost = self._identity, self._look, self._lost
            try:
                identity = self._dialect.connect()
                for command in self._dialect.stopping():
                    self._dialect.send(command)
                reading = self._dialect.read()
            except AhrsLabError as error:
                self._dialect.disconnect()
                self._lost = error if isinstance(error, LinkLostError) else self._lost
                return
            self._identity, self._mode, self._demanded_dps = identity, "off", 0.0
            self._last_command_s = self._clock.now_s()
            sure = was is None or not self._turns.uncertain(reading.t_s, self.limits.max_acceleration_dps2)
            self._take(reading)
            self._lost = None
            self._own_fault = self._after_gap(before, reading, was, lost, sure)

    def _after_gap(
        self, before: str, reading: TableReading, was: Look | None, lost: LinkLostError | None, sure: bool
    ) -> Message:
        if before and self._identity != before:
            return Message(
                "After the link was lost another table answers: {found} instead of {wanted}.",
                found=self._identity,
                wanted=before,
            )
        gap = round(reading.t_s - (was.t_s if was is not None else reading.t_s), 1)
        if sure or not self._dialect.wraps:
            return Message(
                "The link to the table was lost for {gap} s ({reason}); the table was stopped when it "
                "came back.",
                gap=gap,
                reason=lost.message if lost is not None else "",
            )
        return Message(
            "The link to the table was lost for {gap} s ({reason}); the table was stopped when it came "
            "back, and how many turns it has made meanwhile is not known.",
            gap=gap,
            reason=lost.message if lost is not None else "",
        )

    def _give_up(self, why: Message) -> None:
        self._own_fault = self._own_fault or why
        try:
            self.stop()
        except LinkLostError as error:
            self._lose(error)
        except AhrsLabError as error:
            self._own_fault = Message(
                "{first} Stopping the table failed as well: {second}", first=why, second=error.message
            )

    # saying ───────────────────────────────────────────────────────────────────────────────────────────────

    def _begin(self, move: Move | None, demanded_dps: float) -> int:
        """Something new is demanded: what was under way is forgotten."""
        with self._talk:
            self._raise_if_lost()
            self._generation += 1
            self._forget_move()
            self._move, self._demanded_dps = move, demanded_dps
            return self._generation

    def _forget_move(self) -> None:
        self._move = self._demand = None
        self._pending.clear()

    def _say(self, generation: int, commands: Sequence[str]) -> None:
        for command in commands:
            while (left := self._last_command_s + self._dialect.pause_s - self._clock.now_s()) > 1e-9:
                self._clock.wait(left)
            try:
                with self._talk:
                    self._send(generation, command)
            except LinkLostError as error:
                self._lose(error)
                raise

    def _send(self, generation: int, command: str) -> None:
        if generation != self._generation:
            raise AbortedError("The table was told to stop before “{command}” was said.", command=command)
        self._raise_if_lost()
        self._dialect.send(command)
        self._last_command_s = self._clock.now_s()

    def _ready(self) -> None:
        self._raise_if_lost()
        fault = self._own_fault or self._table_fault
        if fault:
            raise InstrumentError(
                "The rate table reports a fault: {fault}. Find its cause and enable the table again.",
                fault=fault,
            )
        if not self._enabled:
            raise InstrumentError("The rate table is not enabled: enable it before it is asked to move.")

    def _raise_if_lost(self) -> None:
        if self._lost is not None:
            raise self._lost

    def _seen(self) -> Look:
        if self._look is None:
            raise InstrumentError("The rate table has not been connected yet.")
        return self._look

    def _reported(self, angle_deg: float) -> float:
        return wrap_180(angle_deg) if self._dialect.wraps else angle_deg

    def _is_moving(self, look: Look) -> bool:
        if abs(look.rate_dps) > self._polling.at_rest_dps or self._demanded_dps != 0.0:
            return True
        if look.t_s <= self._told_to_move_s:
            return True  # what has come of it has not been seen yet
        move = self._move
        return move is not None and abs(look.angle_deg - move.target_deg) > self._polling.in_position_deg
