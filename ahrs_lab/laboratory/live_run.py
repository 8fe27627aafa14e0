"""A run in its own thread, with a person at the screen: start, confirm a mounting, pause, abort, repeat.

Callbacks come in the run's thread; a screen queues them. Everything else may be called from any thread and
returns at once.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from ahrs_lab.errors import AbortedError, InputError, MachineError
from ahrs_lab.instruments.by_hand import HandRequest, Setter
from ahrs_lab.instruments.interfaces import Bench, Operator
from ahrs_lab.laboratory.bundles import counting, open_bundle, sound
from ahrs_lab.messages import Message
from ahrs_lab.procedures import course
from ahrs_lab.procedures.commands import Procedure, Step
from ahrs_lab.procedures.events import Event, RunState, StateChanged
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.procedures.runner import Runner, RunOutcome
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import RecordingHeader, Segment
from ahrs_lab.recording.write import BundleWriter

_LOOK_S = 0.05
"""How often a waiting operator's answer is looked for; wall time."""


class ScreenOperator:
    """The operator behind the screen: :meth:`mount` waits in the run's thread until :meth:`confirm` is
    called, and so says :meth:`has_set`.

    ``hands`` is who moves a fixture, or a table, that is not real: the simulated operator of a virtual bench.
    """

    def __init__(self, hands: Operator | None = None) -> None:
        self._hands = hands
        self._setter = _setter_of(hands)
        self._answered = threading.Event()
        self._given_up = False

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:
        """Wait for the person; raises AbortedError when the run is given up meanwhile."""
        self._answered.clear()
        while not self._answered.wait(_LOOK_S):
            if self._given_up:
                break
        if self._given_up:
            raise AbortedError("The run was stopped while the case was being mounted.")
        if self._hands is not None:
            self._hands.mount(orientation, previous)

    def ask(self, request: HandRequest, because: Message | None = None) -> None:
        """See :class:`~ahrs_lab.instruments.by_hand.Setter`; what is asked goes to the screen as an event."""
        self._answered.clear()
        if self._setter is not None:
            self._setter.ask(request, because)

    def has_set(self, wait_s: float) -> bool:
        """See :class:`~ahrs_lab.instruments.by_hand.Setter`."""
        said = self._answered.wait(wait_s)
        if self._given_up:
            raise AbortedError("The run was stopped while the rate table was being set by hand.")
        if said:
            self._answered.clear()
            if self._setter is not None:
                self._setter.has_set(0.0)
        return said

    def confirm(self) -> None:
        """The person says that the case is mounted, or the table set."""
        self._answered.set()

    def interrupt(self) -> None:
        """Nobody will answer any more."""
        self._given_up = True
        self._answered.set()

    def reset(self) -> None:
        """Ready for another run."""
        self._given_up = False
        self._answered.clear()


def _setter_of(hands: object) -> Setter | None:
    return hands if isinstance(hands, Setter) else None


_Work = tuple[Procedure, tuple[Step, ...]]
"""What is to be done, and its steps for the list and the time left."""


@contextmanager
def _raw_bytes_kept(bench: Bench, folder: Path) -> Iterator[None]:
    """What arrives from real instruments meanwhile is kept beside the segments, in ``raw/``."""
    keep_raw = getattr(bench, "keep_raw", None)
    if keep_raw is None:
        yield
        return
    keep_raw(folder / "raw")
    try:
        yield
    finally:
        keep_raw(None)


class LiveRun:
    """One calibration on a bench, recorded into ``folder``.

    ``ask=True``: a person confirms each mounting (:meth:`confirm_mounted`); False: the bench's own operator
    does.
    An unfinished recording in ``folder`` is resumed: what is recorded there is not recorded again.
    """

    def __init__(
        self,
        bench: Bench,
        plan: Plan,
        folder: Path,
        header: RecordingHeader,
        *,
        on_event: Callable[[Event], None],
        on_samples: Callable[[Samples], None],
        ask: bool = True,
    ) -> None:
        self.plan = plan
        self.folder = folder
        self.header = header
        self._screen = ScreenOperator(bench.operator if bench.simulated else None)
        self._bench = replace(bench, operator=self._screen) if ask else bench
        self._listeners = [on_event]
        self._on_samples = on_samples
        self._ended = threading.Event()
        self._ended.set()
        self._runner: Runner | None = None
        self._state: RunState = "idle"
        self.outcome: RunOutcome | None = None
        self.steps: tuple[Step, ...] = course.steps(plan, bench.table.limits)
        self.recorded_before: tuple[Segment, ...] = ()
        """What counted in the folder when the run began or went on; its steps take no time."""

    @property
    def state(self) -> RunState:
        """The run's state now."""
        return self._state

    @property
    def bench(self) -> Bench:
        """The bench this run is on."""
        return self._bench

    def listen(self, on_event: Callable[[Event], None]) -> None:
        """Tell ``on_event`` too, in the run's thread; before the start."""
        self._listeners.append(on_event)

    def start(self, before: Callable[[tuple[Step, ...]], None] | None = None) -> None:
        """Begin, or go on with what an earlier run left in the folder; ``before`` hears what is to be done,
        before the bench does anything."""
        limits = self._bench.table.limits

        def rest(writer: BundleWriter) -> _Work:
            done = sound(writer)
            return course.calibration(self.plan, done, limits), course.steps(self.plan, limits, done)

        self._launch(rest, before)

    def start_from(self, segment_name: str, reason: str) -> None:
        """Record that segment and all that follow it in the plan; earlier takes of them are kept."""
        _need_reason(segment_name, reason)
        limits = self._bench.table.limits

        def again(_writer: BundleWriter) -> _Work:
            procedure = course.from_segment(self.plan, segment_name, limits, reason)
            names = course.segment_names(self.plan)
            return procedure, course.steps(self.plan, limits, frozenset(names[: names.index(segment_name)]))

        self._launch(again)

    def repeat(self, segment_name: str, reason: str) -> None:
        """Record one segment again; both takes are kept, the last one counts. Only when nothing runs."""
        _need_reason(segment_name, reason)
        limits = self._bench.table.limits

        def again(writer: BundleWriter) -> _Work:
            if segment_name not in {segment.name for segment in counting(writer.segments)}:
                raise InputError(
                    "{segment} is not recorded yet: there is nothing to repeat.", segment=segment_name
                )
            others = frozenset(course.segment_names(self.plan)) - {segment_name}
            steps = tuple(step for step in course.steps(self.plan, limits, others) if step.estimate_s > 0.0)
            return course.repeat(self.plan, segment_name, limits, reason), steps

        self._launch(again)

    def _launch(
        self,
        work: Callable[[BundleWriter], _Work],
        before: Callable[[tuple[Step, ...]], None] | None = None,
    ) -> None:
        if not self._ended.is_set():
            raise InputError("A run is going on: stop it or wait for its end.")
        self._screen.reset()
        self.outcome = None
        writer = open_bundle(self.folder, self.header)
        try:
            procedure, self.steps = work(writer)
            self.recorded_before = counting(writer.segments)
            if before is not None:
                before(self.steps)
        except BaseException:
            writer.close()
            raise
        self._runner = Runner(self._bench, writer, self._tell, self._on_samples, self.plan)
        self._ended.clear()
        threading.Thread(
            target=self._work, args=(self._runner, writer, procedure), name="calibration-run", daemon=True
        ).start()

    def _work(self, runner: Runner, writer: BundleWriter, procedure: Procedure) -> None:
        try:
            with _raw_bytes_kept(self._bench, self.folder):
                self.outcome = self._run(runner, writer, procedure, self.steps)
        finally:
            self._ended.set()

    @staticmethod
    def _run(
        runner: Runner, writer: BundleWriter, procedure: Procedure, steps: tuple[Step, ...]
    ) -> RunOutcome:
        try:
            with writer:
                outcome = runner.run(procedure, steps)
        except MachineError as error:
            # The folder could not be given free in order; where the run failed before, that is what counts.
            if outcome.error is None:
                return replace(outcome, state="failed", error=error)
        return outcome

    def _tell(self, event: Event) -> None:
        if isinstance(event, StateChanged):
            self._state = event.state
        for listener in self._listeners:
            listener(event)

    def confirm_mounted(self) -> None:
        """The person says that the case stands as asked."""
        self._screen.confirm()

    def confirm_set(self) -> None:
        """The person says that the table does what was asked; it is checked before it counts."""
        self._screen.confirm()

    def pause(self) -> None:
        """Pause before the next command."""
        if self._runner is not None:
            self._runner.pause()

    def resume(self) -> None:
        """Go on after a pause."""
        if self._runner is not None:
            self._runner.resume()

    def abort(self, reason: Message) -> None:
        """Stop the table, then the supply, whatever is going on; what was recorded is kept."""
        if self._runner is not None:
            self._runner.abort(reason)
        self._screen.interrupt()

    def join(self, timeout_s: float | None = None) -> bool:
        """Wait for the run's end; True when it has ended."""
        # Not by the thread's own join: one that Ctrl-C interrupts may take a thread for ended that is not.
        return self._ended.wait(timeout_s)


def _need_reason(segment_name: str, reason: str) -> None:
    if not reason.strip():
        raise InputError(
            "Say why {segment} is repeated: the reason goes into the record.", segment=segment_name
        )
