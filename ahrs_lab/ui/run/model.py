"""What the run page shows, without Qt: events in, one consistent picture out. Times are bench time in
seconds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from ahrs_lab.instruments.by_hand import Felt, HandRequest
from ahrs_lab.messages import Message
from ahrs_lab.procedures.commands import Step
from ahrs_lab.procedures.events import (
    Activity,
    BenchReading,
    Event,
    HandChecked,
    HandFelt,
    HandRequested,
    MadeSafe,
    MountingChecked,
    MountRequested,
    RunState,
    SegmentFinished,
    SegmentStarted,
    StateChanged,
    StepFinished,
    StepStarted,
    Warned,
)
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import Segment
from ahrs_lab.ui.run.step_mark import StepMark

Phase = Literal["none", "mount", "hand", "work", "record", "paused", "done", "aborted", "failed"]
"""What the middle card is about."""

ENDED: frozenset[RunState] = frozenset({"done", "aborted", "failed"})


@dataclass
class StepLine:
    """One step and how it stands. ``spent_s`` counts while it is active."""

    step: Step
    mark: StepMark = "pending"
    started_s: float | None = None
    spent_s: float = 0.0

    @property
    def shown_s(self) -> float:
        """Time left while there is some, else what it took."""
        if self.mark in ("pending", "active"):
            return max(0.0, self.step.estimate_s - self.spent_s)
        return self.spent_s

    @property
    def done_s(self) -> float:
        """How much of the estimate is behind us."""
        if self.mark in ("done", "skipped"):
            return self.step.estimate_s
        return min(self.spent_s, self.step.estimate_s)


@dataclass
class StepGroup:
    """The steps of one mounting, in order. A face that is mounted twice has two groups."""

    mounting: str
    lines: list[StepLine] = field(default_factory=list)

    @property
    def mark(self) -> StepMark:
        """The mark of the whole."""
        marks = [line.mark for line in self.lines]
        if "failed" in marks:
            return "failed"
        if all(mark in ("done", "skipped") for mark in marks):
            return "skipped" if all(mark == "skipped" for mark in marks) else "done"
        return "pending" if all(mark == "pending" for mark in marks) else "active"

    @property
    def shown_s(self) -> float:
        """Sum over what is not over yet, else over all."""
        left = [line.shown_s for line in self.lines if line.mark in ("pending", "active")]
        return sum(left) if left else sum(line.spent_s for line in self.lines)


class RunModel:
    """The picture. :meth:`apply` takes one event; everything else is read."""

    def __init__(
        self,
        steps: Sequence[Step] = (),
        *,
        power_off_between: bool = True,
        before: Sequence[Segment] = (),
    ) -> None:
        """``before``: what an earlier run recorded; its steps take no time."""
        self._power_off_between = power_off_between
        self._before = tuple(before)
        self.groups: list[StepGroup] = []
        self._lines: dict[str, StepLine] = {}
        for step in steps:
            line = self._add(step)
            if before and step.estimate_s <= 0.0:
                line.mark = "skipped"
        self.state: RunState = "idle"
        self.reason: Message | None = None
        self.request: MountRequested | None = None
        self.mounted: Orientation | None = None
        """How the case stands, as far as a person has said."""
        self.check: MountingChecked | None = None
        self.activity: Activity | None = None
        self.segment: SegmentStarted | None = None
        self.segment_elapsed_s = 0.0
        """How much of the recording has arrived; whoever counts the samples sets it."""
        self.confirmed = False
        """The person has said "mounted" or "set", and the run has not taken it up yet."""
        self.hand: HandRequest | None = None
        """What a person is asked to set by hand."""
        self.hand_refused: Message | None = None
        """Why it is asked again."""
        self.felt: Felt | None = None
        self.by_hand = False
        """The table has no wire: the operator is needed all the time."""
        self.unsafe: tuple[Message, ...] = ()
        """What did not work when the bench was made safe."""
        self.recorded: list[SegmentFinished] = []
        self.reading: BenchReading | None = None
        self.warnings: list[Warned] = []
        self.lost = 0

    def _add(self, step: Step) -> StepLine:
        if not self.groups or self.groups[-1].mounting != step.mounting:
            self.groups.append(StepGroup(step.mounting))
        line = StepLine(step)
        self.groups[-1].lines.append(line)
        self._lines[step.key] = line
        return line

    # ── events ──────────────────────────────────────────────────────────────────────────────────────────

    def apply(self, event: Event) -> None:
        """Take one event into the picture."""
        match event:
            case StateChanged():
                self._state_changed(event)
            case StepStarted(step=step, t_s=t_s):
                for other in self._lines.values():
                    if other.mark == "active":
                        other.mark = "done"
                line = self._line(step)
                line.mark, line.started_s, line.spent_s = "active", t_s, 0.0
                self.activity = None
                if step.kind == "mount":
                    self.check = None
            case StepFinished(step=step, t_s=t_s, skipped=skipped):
                self._step_finished(self._line(step), t_s, skipped)
            case MountRequested():
                self.request, self.confirmed, self.activity = event, False, None
            case HandRequested() | HandFelt() | HandChecked() | MadeSafe():
                self._by_hand(event)
            case MountingChecked():
                self.check = event
            case Activity():
                self.activity = event
            case SegmentStarted():
                self.segment, self.segment_elapsed_s = event, 0.0
            case SegmentFinished():
                self.segment = None
                self.recorded.append(event)
                self.lost += event.lost
            case BenchReading():
                self.reading = event
                for line in self._lines.values():
                    if line.mark == "active" and line.started_s is not None:
                        line.spent_s = event.table.t_s - line.started_s
            case Warned():
                self.warnings.append(event)

    def _by_hand(self, event: HandRequested | HandFelt | HandChecked | MadeSafe) -> None:
        match event:
            case HandRequested(request=request, because=because):
                self.hand, self.hand_refused, self.by_hand = request, because, True
                self.confirmed, self.felt = False, None
            case HandFelt(felt=felt):
                self.felt = felt
            case HandChecked(finding=finding):
                self.confirmed = False
                self.hand_refused = None if finding.accepted else finding.message
                if finding.accepted:
                    self.hand = None
            case MadeSafe(problems=problems):
                self.unsafe = problems

    def _line(self, step: Step) -> StepLine:
        return self._lines.get(step.key) or self._add(step)

    def _state_changed(self, event: StateChanged) -> None:
        self.state, self.reason = event.state, event.reason
        if event.state == "running" and self.request is not None:
            self.mounted, self.request = self.request.orientation, None
        if event.state in ("running", "aborting") or event.state in ENDED:
            self.hand = self.felt = None
        if event.state in ENDED:
            self.segment = self.request = self.activity = None
            for line in self._lines.values():
                if line.mark == "active":
                    line.mark = "done" if event.state == "done" else "failed"

    def _step_finished(self, line: StepLine, t_s: float, skipped: bool) -> None:
        line.mark = "skipped" if skipped else "done"
        if not skipped and line.started_s is not None:
            line.spent_s = t_s - line.started_s

    # ── what is read ────────────────────────────────────────────────────────────────────────────────────

    @property
    def seen(self) -> BenchReading | None:
        """The last look at the bench while it is looked at; None before and after the run."""
        return self.reading if self.live else None

    @property
    def powered(self) -> bool:
        """Whether the device has power. While the operator mounts nobody looks at the supply, so the plan
        says."""
        if self.request is not None:
            return not self._power_off_between and self.request.previous is not None
        return self.seen is not None and self.seen.supply.output_on

    @property
    def phase(self) -> Phase:
        """What the middle card is about."""
        if self.state == "idle":
            return "none"
        if self.state in ("done", "aborted", "failed", "paused"):
            return self.state
        if self.request is not None:
            return "mount"
        if self.hand is not None:
            return "hand"
        return "record" if self.segment is not None else "work"

    @property
    def live(self) -> bool:
        """Something is going on that can be stopped."""
        return self.state != "idle" and self.state not in ENDED

    @property
    def active(self) -> StepLine | None:
        """The step that is going on."""
        return next((line for line in self._lines.values() if line.mark == "active"), None)

    @property
    def axis(self) -> str:
        """The case axis that the step is about; the upright one while nothing says more."""
        if self.segment is not None:
            return self.segment.segment.axis
        line = self.active
        if line is not None and line.step.axis:
            return line.step.axis
        return self.mounted.up_axis if self.mounted is not None else "x"

    @property
    def progress(self) -> float:
        """How much of the whole run's estimate is behind us, 0…1."""
        total = sum(line.step.estimate_s for line in self._lines.values())
        return sum(line.done_s for line in self._lines.values()) / total if total > 0 else 0.0

    @property
    def step_left_s(self) -> float | None:
        """Bench time left in the activity or recording, as far as it is known."""
        if self.segment is not None:
            return max(0.0, self.segment.duration_s - self.segment_elapsed_s)
        if self.activity is not None and self.activity.remaining_s is not None:
            return self.activity.remaining_s
        line = self.active
        return None if line is None else line.shown_s

    @property
    def segment_progress(self) -> float | None:
        """0…1 of the recording that is going on."""
        left = self.step_left_s
        if self.segment is None or left is None or self.segment.duration_s <= 0:
            return None
        return 1.0 - left / self.segment.duration_s

    @property
    def free_s(self) -> float | None:
        """Bench time until the operator is needed again; while a mounting is asked for, from then on. None
        where it is not known, and where the operator is needed all the time."""
        if self.by_hand:
            return None
        if self.request is None:
            return None if self.seen is None else self.seen.remaining_mounting_s
        lines = list(self._lines.values())
        first = next((i + 1 for i, line in enumerate(lines) if line.mark == "active"), len(lines))
        total = 0.0
        for line in lines[first:]:
            if line.step.kind == "mount" and line.step.estimate_s > 0.0:
                break
            total += line.shown_s
        return total

    @property
    def next_mounting(self) -> str | None:
        """The face that is asked for next, None where none is left."""
        for group in self.groups:
            first = next((line for line in group.lines if line.step.kind == "mount"), None)
            if first is not None and first.mark == "pending":
                return group.mounting
        return None

    @property
    def on_disk(self) -> tuple[Segment, ...]:
        """All of the calibration that is recorded, by an earlier run too, the last take of each name."""
        return tuple({segment.name: segment for segment in (*self._before, *self.segments)}.values())

    @property
    def segments(self) -> tuple[Segment, ...]:
        """What this run has recorded so far, the last take of each name."""
        return tuple({done.segment.name: done.segment for done in self.recorded}.values())
