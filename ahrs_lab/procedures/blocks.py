"""What is recorded within one mounting, whatever the procedure: takes, blocks, sessions, how long they take.

A *take* is one segment and the commands that make it; a *block* is a line of the operator's list: the takes
that belong together and what has to be done before and after them; a *session* is one mounting with its
blocks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures.commands import Command, PointTo, RecordTurns, Step
from ahrs_lab.procedures.plan_settings import Plan, SettlingPlan
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import Segment

CAUTIOUS_TABLE = TableLimits(max_rate_dps=math.inf, max_acceleration_dps2=10.0)
"""What is assumed of a table that nobody has described: it needs its time to accelerate."""


@dataclass(frozen=True)
class Take:
    """One segment, the commands that record it, and their bench time."""

    segment: Segment
    commands: tuple[Command, ...]
    estimate_s: float


@dataclass(frozen=True)
class Block:
    """Takes under one :class:`Step`. ``azimuth_deg``: where the table points meanwhile, None where it turns.
    ``repeat`` counts the power-ons of a mounting that repeats need."""

    step: Step
    takes: tuple[Take, ...]
    before: tuple[Command, ...] = ()
    after: tuple[Command, ...] = ()
    azimuth_deg: float | None = 0.0
    repeat: int = 1
    check: bool = True

    def without(self, done: frozenset[str]) -> Block:
        """This block with only what is left to record; its step's estimate follows."""
        left = tuple(take for take in self.takes if take.segment.name not in done)
        if len(left) == len(self.takes):
            return self
        gone = sum(take.estimate_s for take in self.takes) - sum(take.estimate_s for take in left)
        estimate = self.step.estimate_s - gone if left else 0.0
        return replace(self, takes=left, step=replace(self.step, estimate_s=max(estimate, 0.0)))


@dataclass(frozen=True)
class Session:
    """One mounting – the case stands like ``orientation`` with the table at north – and its blocks."""

    index: int
    orientation: Orientation
    blocks: tuple[Block, ...]

    def without(self, done: frozenset[str]) -> Session:
        """This session with only what is left to record."""
        return replace(self, blocks=tuple(block.without(done) for block in self.blocks))

    @property
    def open_blocks(self) -> tuple[Block, ...]:
        """Those that something is left of."""
        return tuple(block for block in self.blocks if block.takes)

    def cycles(self, power_cycled: bool) -> list[tuple[int, tuple[Block, ...]]]:
        """The blocks by power-on: each repeat has its own where power goes off between mountings."""
        if not power_cycled:
            return [(1, self.blocks)]
        numbers = sorted({block.repeat for block in self.blocks})
        return [(n, tuple(block for block in self.blocks if block.repeat == n)) for n in numbers]


def travel_s(angle_deg: float, rate_dps: float, limits: TableLimits) -> float:
    """From rest to rest through ``angle_deg`` with at most ``rate_dps`` and the table's acceleration."""
    angle, acceleration = abs(angle_deg), limits.max_acceleration_dps2
    if angle <= rate_dps**2 / acceleration:
        return 2.0 * math.sqrt(angle / acceleration)
    return angle / rate_dps + rate_dps / acceleration


def point_to(plan: Plan, azimuth_deg: float, limits: TableLimits) -> PointTo:
    """Turn the table there; it may be half a turn away."""
    settling = plan.settling
    travel = travel_s(180.0, settling.pointing_rate_dps, limits)
    return PointTo(
        azimuth_deg,
        settling.pointing_rate_dps,
        settling.position_tolerance_deg,
        settling.hold_s,
        settling.timeout_s + 1.5 * travel,
    )


def turns_take(segment: Segment, settling: SettlingPlan, limits: TableLimits) -> Take:
    """``segment.turns`` whole turns at ``segment.rate_dps`` from rest to rest, recorded from before to after
    the motion: as long for either sense."""
    turns, rate_dps = segment.turns or 0, abs(segment.rate_dps)
    lead = max(settling.hold_s, 1.0)
    motion = travel_s(360.0 * turns, rate_dps, limits)
    duration = float(math.ceil(2.0 * lead + 1.02 * motion + 2.0))
    return Take(segment, (RecordTurns(segment, turns, rate_dps, lead, duration),), duration)
