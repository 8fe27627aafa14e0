"""A plan's procedure as a generator of commands: a whole calibration, one segment again, the steps of it.

What is recorded is the procedure's that the plan names (:data:`_PLANNERS`); how the case is mounted, powered,
checked and put away around it is the same for each. Within one mounting: mount (power off, if so set) → power
on → supply current steady → warm-up → check of the mounting → what there is to record → table north → power
off.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import replace

from ahrs_lab.errors import InputError, MountingError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures import imu_discrete, jjf1536
from ahrs_lab.procedures.blocks import CAUTIOUS_TABLE, Block, Session, point_to, travel_s
from ahrs_lab.procedures.commands import (
    CheckMounting,
    Command,
    Mount,
    PowerOff,
    PowerOn,
    Procedure,
    Record,
    RecordTurns,
    SettleCurrent,
    Step,
    Stop,
)
from ahrs_lab.procedures.mounting_check import MountingFinding
from ahrs_lab.procedures.plan_settings import Plan, ProcedureName
from ahrs_lab.recording.orientation import Orientation

MOUNTING_ATTEMPTS = 3
"""How often the operator is asked for one mounting before the run gives up."""
_PATIENCE = 5
"""How often a case that is not still is looked at again before it counts as wrongly mounted."""
MOUNTING_ESTIMATE_S = 180.0
"""A practised operator flips the fixture in three minutes."""
_CURRENT_ESTIMATE_S = 5.0

_Commands = Generator[Command | Step, object, None]

_PLANNERS: Mapping[ProcedureName, Callable[[Plan, TableLimits], tuple[Session, ...]]] = {
    "jjf1536-2015": jjf1536.sessions,
    "imu-discrete": imu_discrete.sessions,
}
"""What each procedure records, mounting by mounting."""


def calibration(
    plan: Plan, done: frozenset[str] = frozenset(), limits: TableLimits | None = None
) -> Procedure:
    """The whole of ``plan`` without the segments in ``done``; a mounting that nothing is left of is not asked
    for.

    Steps are yielded for skipped work too, with no commands behind them. ``limits`` of the table make turns
    no longer than they need; without them a slow table is assumed.
    """
    sessions = sessions_of(plan, limits)
    yield from _Course(plan, limits).run([session.without(done) for session in sessions])


def repeat(plan: Plan, segment_name: str, limits: TableLimits | None = None, reason: str = "") -> Procedure:
    """One segment again, with all that belongs to it: mounting, power-on, settling. ``reason`` goes into the
    new take; the earlier one is kept."""
    return _only(plan, {_known(plan, segment_name)}, limits, reason)


def from_segment(
    plan: Plan, segment_name: str, limits: TableLimits | None = None, reason: str = ""
) -> Procedure:
    """That segment and everything after it, in the order of :func:`segment_names`."""
    names = segment_names(plan)
    return _only(plan, set(names[names.index(_known(plan, segment_name)) :]), limits, reason)


def segment_names(plan: Plan) -> tuple[str, ...]:
    """All segments of ``plan`` in the order of recording."""
    return tuple(
        take.segment.name
        for session in sessions_of(plan, None)
        for block in session.blocks
        for take in block.takes
    )


def steps(
    plan: Plan, limits: TableLimits | None = None, done: frozenset[str] = frozenset()
) -> tuple[Step, ...]:
    """The operator's list, with the keys that :func:`calibration` yields; what is done takes no time."""
    course = _Course(plan, limits)
    listed: list[Step] = []
    for session in sessions_of(plan, limits):
        listed += course.steps_of(session.without(done))
    return tuple(listed)


def sessions_of(plan: Plan, limits: TableLimits | None = None) -> tuple[Session, ...]:
    """What the plan's procedure records, mounting by mounting."""
    return _PLANNERS[plan.procedure](plan, limits or CAUTIOUS_TABLE)


def _known(plan: Plan, segment_name: str) -> str:
    if segment_name not in segment_names(plan):
        raise InputError(
            "The plan has no segment {segment}: choose one that it records, for example {example}.",
            segment=segment_name,
            example=segment_names(plan)[0],
        )
    return segment_name


def _only(plan: Plan, names: set[str], limits: TableLimits | None, reason: str) -> Procedure:
    done = frozenset(segment_names(plan)) - names
    left = [session.without(done) for session in sessions_of(plan, limits)]
    wanted = [replace(session, blocks=session.open_blocks) for session in left if session.open_blocks]
    return _with_reason(_Course(plan, limits).run(wanted), reason)


def _with_reason(commands: _Commands, reason: str) -> _Commands:
    """The same commands, each segment with the reason why it is recorded again."""
    outcome: object = None
    while True:
        try:
            item = commands.send(outcome)
        except StopIteration:
            return
        if reason and isinstance(item, (Record, RecordTurns)):
            item = replace(item, segment=replace(item.segment, reason=reason))
        outcome = yield item


class _Course:
    """The commands of a calibration, and what they leave behind: is the power on, how was the case put
    last."""

    def __init__(self, plan: Plan, limits: TableLimits | None) -> None:
        self._plan = plan
        self._limits = limits or CAUTIOUS_TABLE
        self._powered = False
        self._previous: Orientation | None = None
        self._estimated_on = False

    # steps ────────────────────────────────────────────────────────────────────────────────────────────────

    def steps_of(self, session: Session) -> list[Step]:
        listed = [self._mount_step(session)]
        for number, cycle in session.cycles(self._plan.power.off_between_mountings):
            listed.append(self._power_step(session, number, any(block.takes for block in cycle)))
            listed += [block.step for block in cycle]
        return listed

    def _mount_step(self, session: Session) -> Step:
        orientation = session.orientation
        travel = travel_s(180.0, self._plan.settling.pointing_rate_dps, self._limits)
        estimate = MOUNTING_ESTIMATE_S + travel + self._plan.settling.hold_s
        return Step(
            key=f"m{session.index}.mount",
            mounting=orientation.face,
            kind="mount",
            axis=orientation.up_axis,
            estimate_s=estimate if session.open_blocks else 0.0,
            detail=orientation.letters,
        )

    def _power_step(self, session: Session, number: int, needed: bool) -> Step:
        power = self._plan.power
        warm = power.off_between_mountings or not self._estimated_on
        estimate = self._plan.mounting_check_s
        if warm:
            estimate += power.current_hold_s + power.warm_up_s + _CURRENT_ESTIMATE_S
        if needed:
            self._estimated_on = True
        suffix = f"_r{number}" if number > 1 else ""
        return Step(
            key=f"m{session.index}.power{suffix}",
            mounting=session.orientation.face,
            kind="power",
            axis=session.orientation.up_axis,
            estimate_s=estimate if needed else 0.0,
            detail=f"{power.voltage_v:g} V",
        )

    # commands ─────────────────────────────────────────────────────────────────────────────────────────────

    def run(self, sessions: Sequence[Session]) -> _Commands:
        last = max((i for i, session in enumerate(sessions) if session.open_blocks), default=-1)
        for number, session in enumerate(sessions):
            if not session.open_blocks:
                yield from self.steps_of(session)
                continue
            yield from self._session(session)
            yield point_to(self._plan, 0.0, self._limits)
            if self._plan.power.off_between_mountings or number == last:
                yield from self._power_off()

    def _session(self, session: Session) -> _Commands:
        cycles = session.cycles(self._plan.power.off_between_mountings)
        yield self._mount_step(session)
        yield from self._mount(session.orientation)
        for number, cycle in cycles:
            needed = any(block.takes for block in cycle)
            yield self._power_step(session, number, needed)
            if needed:
                if self._powered and number > cycles[0][0] and self._plan.power.off_between_mountings:
                    yield from self._power_off()
                yield from self._power_on()
                yield from self._sure_of(session.orientation, session.orientation, 0.0)
            for block in cycle:
                yield block.step
                if block.takes:
                    yield from self._block(session.orientation, block)

    def _block(self, mounted: Orientation, block: Block) -> _Commands:
        for command in block.before:
            yield command
        if block.check:
            asked = block.takes[0].segment.orientation
            yield from self._sure_of(mounted, asked, block.azimuth_deg or 0.0)
        for take in block.takes:
            for command in take.commands:
                yield command
        for command in block.after:
            yield command

    def _mount(self, orientation: Orientation) -> _Commands:
        yield Stop(self._plan.settling.timeout_s)
        yield point_to(self._plan, 0.0, self._limits)
        if self._plan.power.off_between_mountings or not self._powered:
            yield from self._power_off()
        yield Mount(orientation, self._previous)
        self._previous = orientation

    def _power_on(self) -> _Commands:
        if self._powered:
            return
        power = self._plan.power
        self._powered = True
        yield PowerOn(power.voltage_v, power.current_limit_a)
        yield SettleCurrent(
            power.current_tolerance, power.current_hold_s, power.current_timeout_s, power.warm_up_s
        )

    def _power_off(self) -> _Commands:
        self._powered = False
        yield PowerOff()

    def _sure_of(self, mounted: Orientation, asked: Orientation, azimuth_deg: float) -> _Commands:
        """Check; where the case stands otherwise have it mounted again, at most three times in all."""
        for attempt in range(1, MOUNTING_ATTEMPTS + 1):
            finding = yield from self._look(asked)
            if finding is not None:
                self._sure_of_what_it_gives(finding)
            if finding is None or finding.accepted:
                return
            if attempt == MOUNTING_ATTEMPTS:
                raise MountingError(
                    "The case was mounted {attempts} times and still does not stand as asked. {finding} "
                    "Nothing was recorded in this mounting since; check the fixture and the device's axes, "
                    "then start again.",
                    attempts=attempt,
                    finding=finding.message,
                )
            yield from self._mount(mounted)
            yield from self._power_on()
            if azimuth_deg:
                yield point_to(self._plan, azimuth_deg, self._limits)

    def _sure_of_what_it_gives(self, finding: MountingFinding) -> None:
        if self._plan.procedure == "imu-discrete" and finding.by != "accelerometer":
            raise InputError(
                "The device gives no accelerations, which a calibration of an inertial measurement unit "
                "needs: have it send accel_x, accel_y, accel_z, or choose JJF 1536-2015 for a unit of gyros "
                "alone."
            )

    def _look(self, asked: Orientation) -> Generator[Command | Step, object, MountingFinding | None]:
        """None where whoever drives this procedure only wants to see its commands."""
        finding: MountingFinding | None = None
        for _ in range(_PATIENCE):
            outcome = yield CheckMounting(
                asked, self._plan.mounting_tolerance_deg, self._plan.mounting_check_s
            )
            finding = outcome if isinstance(outcome, MountingFinding) else None
            if finding is None or finding.still:
                break
        return finding
