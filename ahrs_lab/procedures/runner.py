"""The runner: executes a procedure on a bench, tells what happens, and ends every run in a safe state.

*Pause* takes effect between two commands. Where the table turns and the next command relies on it (settling
and recording at a rate) the run goes on until that recording is finished; then the table is stopped and the
run pauses at rest. Going on demands the next rate anew.

*Abort* may come from any thread at any time, also while something waits. Whatever ended the run – its end, an
abort, an instrument, a fault of our own – the table is stopped and then the supply switched off, each with a
time limit.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

from ahrs_lab.errors import AbortedError, AhrsLabError, InstrumentError
from ahrs_lab.instruments.by_hand import Setter
from ahrs_lab.instruments.interfaces import Bench, RoomReading, SupplyReading, TableState
from ahrs_lab.messages import Message
from ahrs_lab.procedures import course
from ahrs_lab.procedures.azimuth_check import AzimuthCheck
from ahrs_lab.procedures.commands import Command, Procedure, Record, SettleRate, Step
from ahrs_lab.procedures.events import (
    Activity,
    BenchReading,
    Event,
    HandFelt,
    HandRequested,
    MadeSafe,
    RunState,
    StateChanged,
    StepFinished,
    StepStarted,
    Warned,
)
from ahrs_lab.procedures.execution import Execution
from ahrs_lab.procedures.link_watch import LinkWatch
from ahrs_lab.procedures.plan_file import plan_to_toml
from ahrs_lab.procedures.plan_rules import check_plan, deviations
from ahrs_lab.procedures.plan_settings import Plan
from ahrs_lab.procedures.power_cycles import split_over_power_cycles
from ahrs_lab.procedures.recorder import Recorded, Recorder, SegmentWriter
from ahrs_lab.procedures.remaining import Remaining
from ahrs_lab.procedures.room_log import RoomLog
from ahrs_lab.procedures.run_states import RunStates, RunTrigger
from ahrs_lab.procedures.safe_state import make_safe
from ahrs_lab.procedures.settling import TableRunsAwayError
from ahrs_lab.procedures.watch import Watch, check_table
from ahrs_lab.recording.samples import Samples

_NEWS_INTERVAL_S = 0.2
_PAUSED_LOOK_S = 0.1
_RATE_WINDOW_S = 1.0
_HALT_S = 120.0


@runtime_checkable
class InterruptibleOperator(Protocol):
    """An operator whose waiting ``mount`` can be ended from another thread; it then raises AbortedError."""

    def interrupt(self) -> None: ...


@dataclass(frozen=True)
class RunOutcome:
    """How a run ended. ``segments`` are the names it recorded; ``error`` what ended it early."""

    state: Literal["done", "aborted", "failed"]
    segments: tuple[str, ...]
    warnings: tuple[Warned, ...]
    error: AhrsLabError | None = None
    cause: BaseException | None = None
    """What was raised, where the fault is our own."""

    @property
    def message(self) -> Message | None:
        """Why it ended early."""
        return None if self.error is None else self.error.message

    def raise_error(self) -> None:
        """Raise what ended the run early, if anything did."""
        if self.error is not None:
            raise self.error from self.cause


class Runner:
    """One run of one procedure on one bench. ``pause``, ``resume`` and ``abort`` may be called from any
    thread; the callbacks come in the thread of :meth:`run`."""

    def __init__(
        self,
        bench: Bench,
        writer: SegmentWriter,
        on_event: Callable[[Event], None],
        on_samples: Callable[[Samples], None],
        plan: Plan | None = None,
        *,
        answer_limit_s: float = 3.0,
    ) -> None:
        self._bench = bench
        self._writer = writer
        self._on_event = on_event
        self._plan = plan
        self._answer_limit_s = answer_limit_s
        self._states = RunStates()
        self._told: RunState = "idle"
        self._abort_reason: Message | None = None
        self._pause_wanted = False
        self._go_on = threading.Event()
        self._running = False
        self._safe_begun = threading.Event()
        self._watch = Watch(bench, on_samples, self._read, self._raise_if_stopped)
        recorder = Recorder(bench, writer, self._watch, self._emit, self._conditions)
        self._execution = Execution(bench, self._watch, recorder, self._emit, self._set_waiting)
        self._azimuth = AzimuthCheck(bench.site.latitude_deg, bench.ahrs.description)
        self._room = RoomLog()
        self._link = LinkWatch(bench.ahrs)
        self._remaining = Remaining(())
        self._segments: list[str] = []
        self._warnings: list[Warned] = []
        self._next_activity = 0.0
        self._last_activity: Message | None = None
        self._step: Step | None = None
        self._step_worked = False
        self._told_to_rest = False

    # from any thread ──────────────────────────────────────────────────────────────────────────────────────

    @property
    def state(self) -> RunState:
        """The state now."""
        return self._states.state

    def pause(self) -> None:
        """Pause at the next place where the table can rest."""
        self._pause_wanted = True
        self._go_on.clear()
        self._states.offer("pause")

    def resume(self) -> None:
        """Go on after a pause, or take its request back."""
        self._pause_wanted = False
        self._states.offer("resume")
        self._go_on.set()

    def abort(self, reason: Message | str) -> None:
        """End the run now, in a safe state; what was recorded is kept."""
        if self._abort_reason is None:
            self._abort_reason = reason if isinstance(reason, Message) else Message(reason)
        begun = self._states.offer("abort")
        self._go_on.set()
        self._bench.clock.interrupt()
        if isinstance(self._bench.operator, InterruptibleOperator):
            self._bench.operator.interrupt()
        if begun and self._running:
            threading.Thread(target=self._stand_in, name="abort-watch", daemon=True).start()

    def _stand_in(self) -> None:
        """Where the run's own thread is held by an instrument or a person that does not answer, make the
        bench safe in its place; it does so once more when it comes back."""
        if not self._safe_begun.wait(self._answer_limit_s):
            make_safe(self._bench, self._answer_limit_s)

    # the run ──────────────────────────────────────────────────────────────────────────────────────────────

    def run(self, procedure: Procedure, steps: Sequence[Step] | None = None) -> RunOutcome:
        """Execute ``procedure`` to its end, whatever that is; may be called once.

        ``steps`` serve the time left; by default those of the plan without what is recorded already. Raises
        only what is no Exception (a keyboard interrupt), after making the bench safe.
        """
        self._states.fire("start")
        self._running = True
        started = self._bench.clock.utc().isoformat()
        error: AhrsLabError | None = None
        cause: BaseException | None = None
        try:
            self._tell_state()
            self._prepare(steps)
            self._drive(procedure)
        except AbortedError as aborted:
            self._states.offer("abort")
            error = aborted
        except AhrsLabError as failure:
            error = failure
        except Exception as fault:
            error, cause = _own_fault(fault), fault
        except BaseException:
            self._states.offer("abort")
            raise
        finally:
            unsafe = self._make_safe()
            procedure.close()
        if unsafe and error is None:
            error = InstrumentError(unsafe[0])
        elif unsafe and isinstance(error, TableRunsAwayError):
            # Who reads one sentence has to read that it still turns.
            error = TableRunsAwayError(Message("{first} {then}", first=unsafe[0], then=error.message))
        for split in self._split_over_power_cycles():
            self._warnings.append(Warned(split))
            self._tell_at_the_end(Warned(split))
        error = self._write_notes(started, error)
        return self._end(error, cause)

    def _split_over_power_cycles(self) -> tuple[Message, ...]:
        if not self._segments:
            return ()
        off = self._plan is None or self._plan.power.off_between_mountings
        return split_over_power_cycles(self._writer.segments, off_between_mountings=off)

    def _prepare(self, steps: Sequence[Step] | None) -> None:
        bench = self._bench
        kept = [s for s in self._writer.segments if not s.interrupted]
        if self._plan is not None:
            check_plan(self._plan, bench.table.limits, sample_rate_hz=bench.ahrs.description.sample_rate_hz)
            if steps is None:
                done = frozenset(segment.name for segment in kept if not segment.superseded)
                steps = course.steps(self._plan, bench.table.limits, done)
        self._remaining = Remaining(steps or ())
        self._room.add_earlier(kept)
        cycles = [segment.extra.get("power_cycle", 0) for segment in self._writer.segments]
        self._execution.power_cycle = max((c for c in cycles if isinstance(c, int)), default=0)
        if self._plan is not None:
            self._writer.update_notes(
                {
                    "plan": plan_to_toml(self._plan),
                    "deviations": [message.to_json() for message in deviations(self._plan)],
                    "simulated": bench.simulated,
                }
            )
        self._raise_if_stopped()
        bench.table.enable()  # acknowledges a fault of an earlier run; one that is still there shows at once
        self._execution.by_hand.have_set()
        check_table(bench.table.state())

    def _drive(self, procedure: Procedure) -> None:
        outcome: object = None
        while True:
            try:
                item = procedure.send(outcome)
            except StopIteration:
                self._leave_step()
                return
            outcome = None
            if isinstance(item, Step):
                self._enter_step(item)
                continue
            self._pause_here(item)
            self._raise_if_stopped()
            self._step_worked = True
            outcome = self._execution.do(item)
            if isinstance(outcome, Recorded):
                self._after_segment(outcome)

    def _enter_step(self, step: Step) -> None:
        self._leave_step()
        now = self._bench.clock.now_s()
        self._step, self._step_worked = step, False
        self._remaining.enter(step, now)
        self._emit(StepStarted(step, now))

    def _leave_step(self) -> None:
        if self._step is not None:
            skipped = not self._step_worked
            self._emit(StepFinished(self._step, self._bench.clock.now_s(), skipped))
        self._step = None

    def _after_segment(self, recorded: Recorded) -> None:
        self._segments.append(recorded.segment.name)
        for warning in (self._azimuth.add(recorded), self._link.end()):
            if warning is not None:
                self._emit(Warned(warning, recorded.segment.name))

    def _pause_here(self, following: Command) -> None:
        """Pause, if asked to and the table may be stopped before ``following``."""
        if not self._states.is_in("pausing"):
            return
        execution = self._execution
        if execution.spinning and isinstance(following, (SettleRate, Record)):
            return
        if execution.spinning:
            execution.halt(_HALT_S)
        self._watch.let_pass(_RATE_WINDOW_S)  # the last second is at rest: what is told of it says so
        self._watch.tell()
        if not self._states.offer("hold"):
            return
        self._tell_state()
        while self._states.is_in("paused"):
            self._go_on.wait(_PAUSED_LOOK_S)
            self._watch.look()
        self._tell_state()

    def _raise_if_stopped(self) -> None:
        self._tell_state()
        if self._abort_reason is not None:
            raise AbortedError(self._abort_reason)

    def _set_waiting(self, waiting: bool) -> None:
        self._states.fire("ask" if waiting else "answer")
        if not waiting and self._pause_wanted:
            self._states.offer("pause")
        self._tell_state()

    # the end ──────────────────────────────────────────────────────────────────────────────────────────────

    def _make_safe(self) -> tuple[Message, ...]:
        self._safe_begun.set()
        problems = make_safe(self._bench, self._answer_limit_s, self._tell_whom_to_ask)
        for problem in problems:
            self._warnings.append(Warned(problem))
            self._tell_at_the_end(Warned(problem))
        self._tell_at_the_end(MadeSafe(problems))
        return problems

    def _tell_whom_to_ask(self) -> None:
        """A table that only a person can stop: while the run ends it is felt, and the person is told."""
        table = self._execution.by_hand.table
        if table is None:
            return
        if table.request is not None and not self._told_to_rest:
            self._told_to_rest = True
            if isinstance(self._bench.operator, Setter):
                self._bench.operator.ask(table.request)
            self._tell_at_the_end(HandRequested(table.request))
        self._watch.follow()
        self._tell_at_the_end(HandFelt(table.felt()))

    def _write_notes(self, started_utc: str, error: AhrsLabError | None) -> AhrsLabError | None:
        """What the run adds to the record; a fault of the disk counts unless something else came first."""
        try:
            self._writer.update_notes(self._notes(started_utc))
        except AhrsLabError as failure:
            return error or failure
        except Exception as fault:
            return error or _own_fault(fault)
        return error

    def _notes(self, started_utc: str) -> dict[str, Any]:
        segments = self._writer.segments
        counted = [segment for segment in segments if not segment.interrupted]
        begun = [segment.started_utc for segment in segments if segment.started_utc]
        notes: dict[str, Any] = {
            "order_run": [segment.name for segment in counted],
            "started_utc": min([started_utc, *begun]),
            "finished_utc": self._bench.clock.utc().isoformat(),
        }
        environment = self._room.summary()
        if environment:
            notes["environment"] = environment
        if self._link.totals:
            notes["link"] = dict(self._link.totals)
        if self._warnings:
            earlier = self._writer.notes.get("run_warnings", [])
            notes["run_warnings"] = [
                *(earlier if isinstance(earlier, list) else []),
                *({"what": warned.what.to_json(), "segment": warned.segment} for warned in self._warnings),
            ]
        return notes

    def _end(self, error: AhrsLabError | None, cause: BaseException | None) -> RunOutcome:
        trigger: RunTrigger = "finish" if error is None or isinstance(error, AbortedError) else "fail"
        state = self._states.fire(trigger)
        if state == "aborted" and error is None:
            error = AbortedError(self._abort_reason or Message("The run was stopped."))
        self._told = state
        self._tell_at_the_end(StateChanged(state, None if error is None else error.message))
        final: Literal["done", "aborted", "failed"] = (
            "done" if state == "done" else "aborted" if state == "aborted" else "failed"
        )
        return RunOutcome(final, tuple(self._segments), tuple(self._warnings), error, cause)

    def _tell_at_the_end(self, event: Event) -> None:
        """A listener that fails may not keep the bench from being made safe, nor the outcome from being
        returned."""
        try:
            self._on_event(event)
        except Exception as fault:
            self._warnings.append(Warned(_own_fault(fault).message))

    # telling ──────────────────────────────────────────────────────────────────────────────────────────────

    def _emit(self, event: Event) -> None:
        """Pass news on; activities at most five times a second unless they say something new."""
        if isinstance(event, Activity):
            now = time.monotonic()
            if now < self._next_activity and event.what == self._last_activity:
                return
            self._next_activity, self._last_activity = now + _NEWS_INTERVAL_S, event.what
        if isinstance(event, Warned):
            if event in self._warnings:
                return
            self._warnings.append(event)
        self._on_event(event)

    def _tell_state(self) -> None:
        """State changes are told in the run's thread, whoever caused them."""
        state = self._states.state
        if state != self._told:
            self._told = state
            self._emit(StateChanged(state, self._abort_reason if state == "aborting" else None))

    def _read(self, table: TableState, supply: SupplyReading, room: RoomReading) -> None:
        self._note_room(room)
        total, mounting = self._remaining.seconds(self._bench.clock.now_s())
        mean = self._watch.trace.mean_rate_dps(_RATE_WINDOW_S)
        if mean is not None:
            table = TableState(
                table.t_s,
                table.angle_deg,
                mean,
                table.demanded_rate_dps,
                table.moving,
                table.enabled,
                table.fault,
            )
        self._emit(BenchReading(table, supply, room, total, mounting))

    def _note_room(self, room: RoomReading) -> None:
        for warning in self._room.add(room):
            self._emit(Warned(warning))

    def _conditions(self) -> dict[str, Any]:
        """What is kept with each segment."""
        self._link.begin()
        room, supply = self._bench.room.read(), self._watch.read_supply()
        self._note_room(room)
        return {
            "temperature_c": room.temperature_c,
            "humidity_percent": room.humidity_percent,
            "supply_v": supply.voltage_v,
            "supply_a": supply.current_a,
            "power_cycle": self._execution.power_cycle,
        }


def _own_fault(fault: Exception) -> AhrsLabError:
    return AhrsLabError(
        "The run failed by a fault that is not yours ({kind}: {detail}); what was recorded is kept. Please "
        "report it.",
        kind=type(fault).__name__,
        detail=str(fault),
    )
