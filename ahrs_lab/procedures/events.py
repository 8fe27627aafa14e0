"""What a run tells whoever listens: frozen news, fewer than twenty a second. Samples take another way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ahrs_lab.instruments.by_hand import Felt, HandFinding, HandRequest
from ahrs_lab.instruments.interfaces import RoomReading, SupplyReading, TableState
from ahrs_lab.messages import Message
from ahrs_lab.procedures.commands import Step
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import Segment

RunState = Literal["idle", "running", "pausing", "paused", "waiting", "aborting", "done", "aborted", "failed"]


@dataclass(frozen=True)
class StateChanged:
    """The run's state, from the one transition table of the runner. ``reason`` where it failed or was
    aborted."""

    state: RunState
    reason: Message | None = None


@dataclass(frozen=True)
class StepStarted:
    """The commands that follow belong to this step."""

    step: Step
    t_s: float


@dataclass(frozen=True)
class StepFinished:
    """``skipped``: its segments were there already (resume)."""

    step: Step
    t_s: float
    skipped: bool = False


@dataclass(frozen=True)
class MountRequested:
    """The operator is asked; the run waits."""

    orientation: Orientation
    previous: Orientation | None


@dataclass(frozen=True)
class MountingChecked:
    """What the sensor feels: the case axis that is up ("x+"), the tilt from the asked one, still or not."""

    asked: Orientation
    feels: str
    tilt_deg: float
    accepted: bool
    message: Message


@dataclass(frozen=True)
class HandRequested:
    """A person is asked to set an instrument by hand; the run waits, or, where it is ending, goes on all the
    same. ``because``: why it is asked again."""

    request: HandRequest
    because: Message | None = None


@dataclass(frozen=True)
class HandFelt:
    """What the unit feels meanwhile."""

    felt: Felt


@dataclass(frozen=True)
class HandChecked:
    """The person has said that it is done: accepted, or what was felt instead."""

    request: HandRequest
    finding: HandFinding


@dataclass(frozen=True)
class MadeSafe:
    """The run has ended and the bench was made safe; ``problems``: what did not work, and what to do."""

    problems: tuple[Message, ...] = ()


@dataclass(frozen=True)
class Activity:
    """What is going on inside a step, with progress 0…1 where known: "settling the supply current" …"""

    what: Message
    progress: float | None
    remaining_s: float | None


@dataclass(frozen=True)
class SegmentStarted:
    """Recording begins."""

    segment: Segment
    duration_s: float


@dataclass(frozen=True)
class SegmentFinished:
    """Recorded and on disk: ``samples`` rows, ``lost`` known missing ones."""

    segment: Segment
    samples: int
    lost: int


@dataclass(frozen=True)
class BenchReading:
    """The bench a few times a second. ``table_rate_dps`` is averaged over the last second."""

    table: TableState
    supply: SupplyReading
    room: RoomReading
    remaining_s: float
    """Bench time left in the whole run."""
    remaining_mounting_s: float
    """Bench time until the operator is needed again."""


@dataclass(frozen=True)
class Warned:
    """Something that does not stop the run but belongs to the record."""

    what: Message
    segment: str = ""


Event = (
    StateChanged
    | StepStarted
    | StepFinished
    | MountRequested
    | MountingChecked
    | HandRequested
    | HandFelt
    | HandChecked
    | MadeSafe
    | Activity
    | SegmentStarted
    | SegmentFinished
    | BenchReading
    | Warned
)
