"""Small plans on the fake bench, and what every run has to leave behind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ahrs_lab.procedures import course
from ahrs_lab.procedures.commands import Procedure
from ahrs_lab.procedures.events import Event
from ahrs_lab.procedures.plan import Plan, PowerPlan, ScaleFactorPlan, SettlingPlan, ZeroOffsetPlan
from ahrs_lab.procedures.runner import Runner, RunOutcome
from ahrs_lab.procedures.schedule import plan_mountings
from ahrs_lab.recording.samples import Samples
from tests.procedures.fake_bench import FakeBench, MemoryWriter

WHOLE = Plan(
    scale_factor=ScaleFactorPlan(rates_dps=(-30.0, -20.0, -12.0, 10.0, 12.0, 20.0, 30.0), static_s=20.0),
    zero_offset=ZeroOffsetPlan(duration_s=20.0),
    settling=SettlingPlan(timeout_s=20.0),
    power=PowerPlan(warm_up_s=5.0, current_hold_s=2.0, current_timeout_s=20.0),
)
"""All of a calibration, as short as a plan can be."""

SMALL = replace(WHOLE, axes=("x",), zero_offset=ZeroOffsetPlan("combined", 20.0))
"""One axis turned, four positions: three mountings, fifteen segments."""


class Run:
    """One run on a fake bench with its news."""

    def __init__(
        self, plan: Plan = SMALL, fake: FakeBench | None = None, writer: MemoryWriter | None = None
    ) -> None:
        self.plan = plan
        self.fake = fake or FakeBench()
        self.writer = writer or MemoryWriter()
        self.events: list[Event] = []
        self.blocks: list[Samples] = []
        self.on_event: Callable[[Event], None] = lambda event: None
        self.runner = Runner(
            self.fake.bench, self.writer, self._hear, self.blocks.append, plan, answer_limit_s=2.0
        )

    def _hear(self, event: Event) -> None:
        self.events.append(event)
        self.on_event(event)

    def go(self, procedure: Procedure | None = None) -> RunOutcome:
        done = frozenset(self.writer.finished)
        outcome = self.runner.run(procedure or course.calibration(self.plan, done, self.fake.table.limits))
        if outcome.cause is not None and self.expect_no_fault_of_ours:
            raise outcome.cause
        return outcome

    def mountings(self) -> list[str]:
        """The orientations that the plan has the case mounted in."""
        return [mounting.orientation.letters for mounting in plan_mountings(self.plan)]

    expect_no_fault_of_ours = True

    def told(self, kind: type[Event]) -> list[Event]:
        return [event for event in self.events if isinstance(event, kind)]


def is_safe(fake: FakeBench) -> bool:
    """The last that the bench was told is: table stop, then supply off; and it is so."""
    state = fake.table.state()
    return (
        fake.calls.commands[-2:] == ["table.stop", "supply.off"]
        and not fake.supply.read().output_on
        and not state.moving
    )
