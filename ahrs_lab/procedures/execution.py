"""What each command does on a bench, and the outcome that the procedure receives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.messages import Message
from ahrs_lab.procedures.by_hand import ByHand
from ahrs_lab.procedures.commands import (
    CheckMounting,
    Command,
    Mount,
    PointTo,
    PowerOff,
    PowerOn,
    Record,
    RecordTurns,
    SettleCurrent,
    SettleRate,
    Spin,
    Stop,
)
from ahrs_lab.procedures.events import Activity, Event, MountingChecked, MountRequested, Warned
from ahrs_lab.procedures.figures import figure
from ahrs_lab.procedures.mounting_check import MountingFinding, judge_mounting
from ahrs_lab.procedures.recorder import Recorded, Recorder
from ahrs_lab.procedures.settling import Obedience, SteadyCurrent, angle_is_steady, rate_is_steady
from ahrs_lab.procedures.watch import Watch
from ahrs_lab.recording.samples import Samples, concatenate

_TURNED_TOLERANCE_DEG = 0.1
_CURRENT_POLL_S = 1.0
_LATE_TURN_S = 3.0
_SEEN_S = 0.5
"""Wall time in which a wire brings enough reports to judge a table by."""
_BACK_DPS = 10.0
_OBEYS_S, _BEGINS_S = 2.0, 1.0
"""Bench time over which a table is watched that has been told a rate, and that it has to begin."""


class Waiting(Protocol):
    """How the run's state follows while the operator is asked."""

    def __call__(self, waiting: bool, /) -> None: ...


class Execution:
    """Executes commands one by one. ``spinning`` tells that the table turns and the next command relies on
    it; ``power_cycle`` counts the power-ons."""

    def __init__(
        self,
        bench: Bench,
        watch: Watch,
        recorder: Recorder,
        emit: Callable[[Event], None],
        waiting: Waiting,
    ) -> None:
        self._bench = bench
        self._watch = watch
        self._recorder = recorder
        self._emit = emit
        self._waiting = waiting
        self.by_hand = ByHand(bench, watch, emit, waiting)
        self.spinning = False
        self.power_cycle = 0
        self._target_deg: float | None = None
        self._doers: dict[type, Callable[[Any], object]] = {
            PowerOn: self._power_on,
            SettleCurrent: self._settle_current,
            PowerOff: self._power_off,
            Mount: self._mount,
            CheckMounting: self._check_mounting,
            PointTo: self._point_to,
            Spin: self._spin,
            SettleRate: self._settle_rate,
            Record: self._record,
            RecordTurns: self._record_turns,
            Stop: self._stop,
        }

    def do(self, command: Command) -> object:
        """Execute ``command``; its outcome, None where there is nothing to tell."""
        return self._doers[type(command)](command)

    def halt(self, timeout_s: float) -> None:
        """Table to rest and wait for it."""
        self._bench.table.stop()
        self.spinning = False
        self._target_deg = None
        self.by_hand.have_set()
        state = self._bench.table.state()
        expected = abs(state.rate_dps) / max(self._bench.table.limits.max_acceleration_dps2, 1e-3)
        self._tell(Message("Table stops"), expected)
        end = self._bench.clock.now_s() + timeout_s
        wait = expected + 0.05
        while self._bench.table.state().moving:
            if self._bench.clock.now_s() >= end:
                raise InstrumentError(
                    "The table still turns at {rate} °/s, {timeout} s after it was told to stop: use its own "
                    "stop button and find the cause.",
                    rate=round(self._bench.table.state().rate_dps, 3),
                    timeout=figure(timeout_s),
                )
            self._watch.let_pass(min(wait, timeout_s))
            wait = 0.2

    # supply ───────────────────────────────────────────────────────────────────────────────────────────────

    def _power_on(self, command: PowerOn) -> None:
        self._bench.supply.set_output(command.voltage_v, command.current_limit_a)
        self._bench.supply.on()
        self._watch.powered = True
        self.power_cycle += 1

    def _settle_current(self, command: SettleCurrent) -> None:
        clock, steady = self._bench.clock, SteadyCurrent(command)
        start = clock.now_s()
        poll = min(_CURRENT_POLL_S, command.hold_s / 5.0)
        while not steady.add(self._watch.read_supply()):
            passed = clock.now_s() - start
            if passed >= command.timeout_s:
                raise steady.failure(passed)
            self._tell(Message("Supply current settles"), command.hold_s - passed)
            self._watch.let_pass(poll)
        if command.warm_up_s > 0.0:
            self._wait_telling(Message("Warm-up of the device"), command.warm_up_s)
        self._watch.start_stream()

    def _power_off(self, _: PowerOff) -> None:
        self._watch.powered = False
        try:
            self._watch.stop_stream()
        finally:
            self._bench.supply.off()

    # operator ─────────────────────────────────────────────────────────────────────────────────────────────

    def _mount(self, command: Mount) -> None:
        self._watch.tell()
        self._emit(MountRequested(command.orientation, command.previous))
        self._waiting(True)
        try:
            self._bench.operator.mount(command.orientation, command.previous)
        finally:
            self._waiting(False)
        self.by_hand.mounted(command.orientation)
        if self._watch.powered:
            self._watch.start_stream()

    def _check_mounting(self, command: CheckMounting) -> MountingFinding:
        self._tell(Message("Check of the mounting"), command.duration_s)
        blocks: list[Samples] = []
        self._watch.look()
        self._watch.sink = blocks.append
        try:
            self._watch.let_pass(command.duration_s)
            while not blocks:
                self._watch.let_pass(max(0.1, self._watch.interval_s))
        finally:
            self._watch.sink = None
        finding = judge_mounting(
            concatenate(blocks), self._bench.ahrs.description, command.orientation, command.tolerance_deg
        )
        self._emit(
            MountingChecked(
                command.orientation, finding.feels, finding.tilt_deg, finding.accepted, finding.message
            )
        )
        for warning in finding.warnings:
            self._emit(Warned(warning))
        return finding

    # table ────────────────────────────────────────────────────────────────────────────────────────────────

    def _point_to(self, command: PointTo) -> None:
        table, clock = self._bench.table, self._bench.clock
        command = replace(command, hold_s=patient_s(clock, command.hold_s, _SEEN_S))
        wanted = self._bench.north_deg + command.azimuth_deg
        now_deg = table.state().angle_deg
        target = wanted + 360.0 * round((now_deg - wanted) / 360.0)
        table.move_to(target, command.rate_dps)
        self._target_deg, self.spinning = target, False
        self.by_hand.have_set()
        acceleration = max(table.limits.max_acceleration_dps2, 1e-3)
        travel = abs(target - now_deg)
        expected = travel / command.rate_dps + (command.rate_dps / acceleration if travel > 1e-3 else 0.0)
        start = clock.now_s()
        self._watch.trace.keep(command.hold_s + 1.0)
        wait = min(expected + command.hold_s, command.timeout_s)
        while True:
            self._tell(Message("Table turns to {azimuth}°", azimuth=figure(command.azimuth_deg)), wait)
            self._watch.let_pass(wait)
            if angle_is_steady(self._watch.trace, clock.now_s(), target, command):
                return
            if clock.now_s() - start >= command.timeout_s:
                raise InstrumentError(
                    "The table has not come to rest at {target}° within {timeout} s; it is at {angle}°. "
                    "Check the table, or widen settling.position_tolerance_deg ({tolerance}°).",
                    target=round(target, 4),
                    timeout=figure(command.timeout_s),
                    angle=round(table.state().angle_deg, 4),
                    tolerance=figure(command.tolerance_deg),
                )
            wait = command.hold_s / 4.0

    def _spin(self, command: Spin) -> None:
        self._bench.table.set_rate(command.rate_dps)
        self.spinning, self._target_deg = True, None
        self.by_hand.have_set()

    def _settle_rate(self, command: SettleRate) -> None:
        table, clock = self._bench.table, self._bench.clock
        command = replace(command, hold_s=patient_s(clock, command.hold_s, _SEEN_S))
        came_from = table.state().rate_dps
        start = clock.now_s()
        obedience = Obedience(command, came_from, patient_s(clock, _OBEYS_S, _SEEN_S))
        judged_after_s = patient_s(clock, _BEGINS_S, _SEEN_S) + obedience.window_s
        self._watch.trace.keep(max(command.hold_s, obedience.window_s) + 1.0)
        acceleration = max(table.limits.max_acceleration_dps2, 1e-3)
        change = abs(command.rate_dps - came_from)
        wait = min(change / acceleration + command.hold_s + 0.05, command.timeout_s)
        while True:
            self._tell(Message("Rate settles at {rate} °/s", rate=figure(command.rate_dps)), wait)
            # On a long ramp a table would run away unseen.
            part = obedience.window_s / 2.0 if wait > judged_after_s else wait
            self._watch.let_pass(part)
            wait = max(wait - part, command.hold_s / 4.0)
            if rate_is_steady(self._watch.trace, clock.now_s(), command):
                return
            # Of one that a person sets this was asked before.
            if clock.now_s() - start >= judged_after_s and self.by_hand.table is None:
                obedience.check(self._watch.trace, clock.now_s())
            if clock.now_s() - start >= command.timeout_s:
                raise InstrumentError(
                    "The table has not held {demanded} °/s within ±{tolerance} °/s for {hold} s; after "
                    "{timeout} s it reports {actual} °/s. Check its load and balance, or widen "
                    "settling.rate_tolerance_dps.",
                    demanded=figure(command.rate_dps),
                    tolerance=figure(command.tolerance_dps),
                    hold=figure(command.hold_s),
                    timeout=figure(command.timeout_s),
                    actual=round(table.state().rate_dps, 4),
                )

    def _stop(self, command: Stop) -> None:
        self.halt(command.timeout_s)

    # recording ────────────────────────────────────────────────────────────────────────────────────────────

    def _record(self, command: Record) -> Recorded:
        def record(sure: Callable[[], None]) -> Recorded:
            return self._recorder.record(command.segment, command.duration_s, verify=sure)

        def again() -> None:
            if self.spinning:
                self._bench.table.set_rate(command.segment.rate_dps)
            elif self._target_deg is not None:
                self._bench.table.move_to(self._target_deg, _BACK_DPS)
            else:
                self._bench.table.stop()

        return self.by_hand.recorded(record, again)

    def _record_turns(self, command: RecordTurns) -> Recorded:
        table = self._bench.table
        start = table.state().angle_deg if self._target_deg is None else self._target_deg
        target = start + 360.0 * command.turns

        def turn() -> None:
            table.move_to(target, abs(command.rate_dps))
            self.by_hand.have_set()

        # A wire that is behind bench time tells the table late to turn and to come to rest.
        late_s = patient_s(self._bench.clock, _LATE_TURN_S, _LATE_TURN_S) - _LATE_TURN_S

        def record(sure: Callable[[], None]) -> Recorded:
            def verify() -> None:
                sure()
                self._sure_of_turns(command, target)

            # A person takes as long as it takes; what comes after the motion is recorded as planned.
            tail_s = command.lead_s if self.by_hand.table is not None else None
            actions = [(command.lead_s, turn)]
            return self._recorder.record(
                command.segment, command.duration_s + late_s, actions, verify, tail_s
            )

        recorded = self.by_hand.recorded(record, lambda: table.move_to(start, abs(command.rate_dps)))
        self._target_deg = target
        return recorded

    def _sure_of_turns(self, command: RecordTurns, target: float) -> None:
        state = self._bench.table.state()
        if state.moving or not np.isclose(state.angle_deg, target, rtol=0.0, atol=_TURNED_TOLERANCE_DEG):
            raise InstrumentError(
                "After {duration} s the table is at {angle}° instead of {target}°: the {turns} turns of "
                "{segment} were not completed. Check the table's acceleration and its limits.",
                duration=figure(command.duration_s),
                angle=round(state.angle_deg, 3),
                target=round(target, 3),
                turns=command.turns,
                segment=command.segment.name,
            )

    # telling ──────────────────────────────────────────────────────────────────────────────────────────────

    def _tell(self, what: Message, remaining_s: float) -> None:
        self._emit(Activity(what, None, max(remaining_s, 0.0)))

    def _wait_telling(self, what: Message, seconds: float) -> None:
        clock = self._bench.clock
        end = clock.now_s() + seconds
        while (left := end - clock.now_s()) > 1e-9:
            self._emit(Activity(what, 1.0 - left / seconds, left))
            step = clock.step_s
            self._watch.let_pass(left if step is None else min(left, step))
