"""A run that plays what it is told: stands for the laboratory's LiveRun, without threads, bench and
recorder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import cast

import numpy as np

from ahrs_lab.instruments.interfaces import RoomReading, SupplyReading, TableState
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.messages import Message
from ahrs_lab.procedures.commands import Step
from ahrs_lab.procedures.events import (
    BenchReading,
    Event,
    MountingChecked,
    MountRequested,
    SegmentFinished,
    SegmentStarted,
    StateChanged,
    StepFinished,
    StepStarted,
)
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, Segment
from ahrs_lab.ui.run.bridge import RunBridge

RATE_HZ = 100.0
FACES = ("UEN", "NUE", "ENU")


def plan_steps() -> tuple[Step, ...]:
    """Three mountings as a calibration has them, shortened."""
    steps: list[Step] = []
    for index, letters in enumerate(FACES, start=1):
        orientation = Orientation(letters)
        axis, face = orientation.up_axis, orientation.face

        def add(
            name: str, kind: str, seconds: float, detail: str, i: int = index, a: str = axis, f: str = face
        ) -> None:
            steps.append(Step(f"m{i}.{name}", f, kind, a, seconds, detail))

        add("mount", "mount", 180.0, letters)
        add("power", "power", 75.0, "12 V")
        add("before", "rest", 64.0, "60 s")
        add("rates", "rates", 260.0, "10 × 20 s")
        add("after", "rest", 64.0, "60 s")
        add("turns", "turns", 96.0, "±10")
        add("zo", "position", 1804.0, letters)
    return tuple(steps)


@dataclass
class ScriptedRun:
    """See the module. ``calls`` remembers what the screen asked for."""

    on_event: Callable[[Event], None]
    on_samples: Callable[[Samples], None]
    steps: tuple[Step, ...] = field(default_factory=plan_steps)
    recorded_before: tuple[Segment, ...] = ()
    calls: list[str] = field(default_factory=list)
    over: bool = False
    t_s: float = 1000.0
    rate_dps: float = 0.0
    angle_deg: float = 0.0
    powered: bool = False
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(5))

    @property
    def bench(self) -> object:
        """As far as the screen looks at it."""
        description = DeviceDescription(model="VN-100", sample_rate_hz=RATE_HZ)
        return SimpleNamespace(ahrs=SimpleNamespace(description=description))

    @property
    def plan(self) -> Plan:
        """The standard's."""
        return Plan()

    def start(self) -> None:
        self.calls.append("start")
        self.over = False
        self.on_event(StateChanged("running"))

    def confirm_mounted(self) -> None:
        self.calls.append("mounted")
        self.on_event(StateChanged("running"))

    def pause(self) -> None:
        self.calls.append("pause")
        self.on_event(StateChanged("paused"))

    def resume(self) -> None:
        self.calls.append("resume")
        self.on_event(StateChanged("running"))

    def repeat(self, segment_name: str, reason: str) -> None:
        self.calls.append(f"repeat {segment_name}: {reason}")
        self.over = False
        self.on_event(StateChanged("running"))

    def abort(self, reason: Message) -> None:
        self.calls.append("abort")
        self.on_event(StateChanged("aborting", reason))
        self.finish("aborted", reason)

    def join(self, timeout_s: float | None = None) -> bool:
        return self.over

    # ── the script ──────────────────────────────────────────────────────────────────────────────────────

    def finish(self, state: str, reason: Message | None = None) -> None:
        """The run comes to its end."""
        self.over = True
        self.on_event(StateChanged(state, reason))  # type: ignore[arg-type]

    def step(self, key: str) -> Step:
        """The step called so."""
        return next(step for step in self.steps if step.key == key)

    def begin(self, key: str) -> None:
        """A step starts."""
        self.on_event(StepStarted(self.step(key), self.t_s))
        self.look()

    def done(self, *keys: str) -> None:
        """Steps start, take their time, and end."""
        for key in keys:
            self.begin(key)
            self.t_s += self.step(key).estimate_s
            self.on_event(StepFinished(self.step(key), self.t_s))

    def ask(self, letters: str, previous: str | None) -> None:
        """The operator is asked."""
        self.powered = False
        self.look()
        self.on_event(StateChanged("waiting"))
        self.on_event(
            MountRequested(Orientation(letters), None if previous is None else Orientation(previous))
        )

    def check(self, letters: str, feels: str, tilt_deg: float, accepted: bool, message: Message) -> None:
        """The sensor was asked."""
        self.on_event(MountingChecked(Orientation(letters), feels, tilt_deg, accepted, message))

    def record(self, segment: Segment, duration_s: float, seconds: float, *, whole: bool = False) -> None:
        """A recording starts and ``seconds`` of it arrive."""
        self.look()
        self.on_event(SegmentStarted(segment, duration_s))
        rows = self.stream(seconds, segment.axis)
        if whole:
            self.on_event(SegmentFinished(segment, rows, 0))

    def stream(self, seconds: float, axis: str = "x") -> int:
        """Samples of that time, and looks at the bench; returns the number of samples."""
        n = round(seconds * RATE_HZ)
        t_s = self.t_s + np.arange(1, n + 1) / RATE_HZ
        columns = {"t_s": t_s, "host_t_s": t_s.copy()}
        for number, name in enumerate("xyz"):
            mean = self.rate_dps if name == axis else 0.0
            drift = 0.02 * (number - 1)
            columns[f"gyro_{name}"] = mean + drift + self.rng.normal(0.0, 0.03, n)
        columns["table_rate_dps"] = self.rate_dps + self.rng.normal(0.0, 1e-4, n)
        self.on_samples(Samples(columns))
        self.t_s += seconds
        self.angle_deg += seconds * self.rate_dps
        self.look()
        return n

    def look(self) -> None:
        """A look at the bench."""
        table = TableState(self.t_s, self.angle_deg, self.rate_dps, self.rate_dps, self.rate_dps != 0.0, True)
        volts, amperes = (12.0, 0.142) if self.powered else (0.0, 0.0)
        supply = SupplyReading(self.t_s, volts, amperes, self.powered)
        room = RoomReading(self.t_s, 20.4, 48.0)
        self.on_event(BenchReading(table, supply, room, 15960.0, 4330.0))


def scripted(bridge: RunBridge) -> ScriptedRun:
    """Start a scripted run on the bridge."""
    made: list[ScriptedRun] = []

    def make(to: RunBridge) -> LiveRun:
        made.append(ScriptedRun(to.on_event, to.on_samples))
        return cast(LiveRun, made[0])

    bridge.start(make)
    return made[0]
