"""The standard's procedures as commands: order within a mounting, dwell, what a resumed run still asks
for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures import course
from ahrs_lab.procedures.blocks import travel_s
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
    Step,
    Stop,
)
from ahrs_lab.procedures.plan import Plan, PowerPlan, ScaleFactorPlan, ZeroOffsetPlan
from ahrs_lab.procedures.takes import averaging_angle_deg, dwell_duration_s

LIMITS = TableLimits(400.0, 100.0)


def commands(procedure: Sequence[Command | Step]) -> list[Command]:
    return [item for item in procedure if not isinstance(item, Step)]


def names(items: Sequence[Command | Step]) -> list[str]:
    return [item.segment.name for item in items if isinstance(item, Record | RecordTurns)]


def calibration(plan: Plan, done: frozenset[str] = frozenset()) -> list[Command | Step]:
    return list(course.calibration(plan, done, LIMITS))


def test_a_mounting_goes_from_power_through_rest_rates_and_turns_to_the_positions() -> None:
    plan = Plan(scale_factor=ScaleFactorPlan(rates_dps=(-3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0)))
    first = commands(calibration(plan))
    end = next(i for i, c in enumerate(first) if isinstance(c, PowerOff) and i > 3)
    kinds = [type(c) for c in first[: end + 1]]
    rate = [Spin, SettleRate, Record]
    assert kinds == [
        Stop, PointTo, PowerOff, Mount, PowerOn, SettleCurrent, CheckMounting,
        PointTo, CheckMounting, Record,
        *rate * 7, Stop,
        PointTo, CheckMounting, Record,
        PointTo, CheckMounting, RecordTurns, RecordTurns,
        PointTo, CheckMounting, Record,
        PointTo, CheckMounting, Record,
        PointTo, PowerOff,
    ]  # fmt: skip


def test_rates_come_in_pairs_of_growing_magnitude_and_keep_their_names() -> None:
    recorded = [c.segment for c in calibration(Plan()) if isinstance(c, Record) and c.segment.role == "rate"]
    x = [segment for segment in recorded if segment.axis == "x"]
    assert [s.rate_dps for s in x] == [10, -10, 50, -50, 100, -100, 200, -200, 300, -300]
    listed = Plan().scale_factor.rates_dps
    assert all(listed[int(s.name[-2:])] == s.rate_dps for s in recorded)


@pytest.mark.parametrize(
    ("order", "expected"), [("ascending", [-3, -2, -1, 1, 2, 3, 4]), ("as_listed", [4, -1, 1, 2, -3, 3, -2])]
)
def test_other_orders_of_the_rates_can_be_chosen(order: str, expected: list[float]) -> None:
    rates = (4.0, -1.0, 1.0, 2.0, -3.0, 3.0, -2.0)
    plan = Plan(axes=("y",), scale_factor=ScaleFactorPlan(rates_dps=rates, order=order))  # type: ignore[arg-type]
    assert [c.rate_dps for c in calibration(plan) if isinstance(c, Spin)] == expected


@pytest.mark.parametrize(
    ("rate", "angle"), [(0.5, 1), (-0.999, 1), (1, 10), (-9.9, 10), (10, 360), (-1000, 360)]
)
def test_the_averaging_angle_follows_the_bands_of_clause_6(rate: float, angle: float) -> None:
    assert averaging_angle_deg(rate) == angle


def test_a_dwell_is_lengthened_to_whole_averaging_angles() -> None:
    assert dwell_duration_s(300.0, 20.0) == pytest.approx(20.4)  # 17 turns
    assert dwell_duration_s(-100.0, 20.0) == pytest.approx(21.6)  # 6 turns
    assert dwell_duration_s(5.0, 20.0) == pytest.approx(20.0)  # ten times 10°
    assert dwell_duration_s(0.001, 20.0) == pytest.approx(1000.0)  # one degree
    assert dwell_duration_s(0.3, 20.0) == pytest.approx(20.0)  # six times 1°


@given(st.floats(0.001, 1000.0), st.floats(20.0, 4000.0))
def test_a_dwell_is_the_shortest_that_will_do(rate: float, least: float) -> None:
    turned = dwell_duration_s(rate, least) * rate / averaging_angle_deg(rate)
    assert turned == pytest.approx(round(turned), abs=1e-6)
    assert round(turned) >= 1
    assert dwell_duration_s(rate, least) >= least * (1 - 1e-9)
    assert round(turned) == 1 or (round(turned) - 1) * averaging_angle_deg(rate) / rate < least


def test_both_senses_of_the_turns_last_equally_long_and_long_enough_for_the_table() -> None:
    for limits in (LIMITS, TableLimits(400.0, 5.0)):
        turns = [c for c in course.calibration(Plan(), limits=limits) if isinstance(c, RecordTurns)]
        assert [c.turns for c in turns] == [10, -10] * 3
        assert len({c.duration_s for c in turns}) == 1
        motion = 3600.0 / 100.0 + 100.0 / limits.max_acceleration_dps2
        assert turns[0].duration_s >= motion + 2.0 * turns[0].lead_s


def test_a_motion_too_short_for_its_rate_never_reaches_it() -> None:
    assert travel_s(90.0, 1000.0, TableLimits(1e4, 10.0)) == pytest.approx(6.0)  # 3 s up, 3 s down: ½·10·9·2
    assert travel_s(90.0, 10.0, TableLimits(1e4, 10.0)) == pytest.approx(10.0)


@given(st.sets(st.sampled_from(course.segment_names(Plan()))))
def test_a_resumed_calibration_records_what_is_left_and_mounts_for_nothing_else(done: set[str]) -> None:
    items = calibration(Plan(), frozenset(done))
    left = [name for name in course.segment_names(Plan()) if name not in done]
    assert names(items) == left
    by_mounting: dict[str, list[str]] = {}
    for item in calibration(Plan()):
        if isinstance(item, Record | RecordTurns):
            by_mounting.setdefault(item.segment.extra["mounting"], []).append(item.segment.name)
    needed = [mounting for mounting, inside in by_mounting.items() if set(inside) - done]
    assert [c.orientation.letters for c in items if isinstance(c, Mount)] == needed
    # whatever was skipped, the list of steps is the whole one
    assert [i.key for i in items if isinstance(i, Step)] == [s.key for s in course.steps(Plan(), LIMITS)]


@given(st.sets(st.sampled_from(course.segment_names(Plan()))))
def test_power_is_on_whenever_something_is_recorded_and_off_at_each_mounting(done: set[str]) -> None:
    powered = spinning = False
    for command in commands(calibration(Plan(), frozenset(done))):
        if isinstance(command, PowerOn):
            assert not powered
            powered = True
        if isinstance(command, PowerOff):
            powered = False
        if isinstance(command, Mount):
            assert not powered
            assert not spinning
        if isinstance(command, Spin):
            spinning = True
        if isinstance(command, Stop | PointTo):
            spinning = False
        if isinstance(command, Record | RecordTurns):
            assert powered
            assert spinning == (command.segment.role == "rate")
    assert not powered
    assert not spinning


PLANS = [
    Plan(),
    Plan(mounting_order="standard"),
    Plan(repeats=2),
    Plan(repeats=3, power=PowerPlan(off_between_mountings=False)),
    Plan(zero_offset=ZeroOffsetPlan("combined")),
    Plan(zero_offset=ZeroOffsetPlan("multi-position", 1200.0, 12)),
    Plan(items=("zero_offset",), axes=("z",)),
]


@pytest.mark.parametrize("plan", PLANS, ids=range(len(PLANS)))
def test_the_list_of_steps_is_what_the_procedure_goes_through(plan: Plan) -> None:
    yielded = [item for item in calibration(plan) if isinstance(item, Step)]
    assert yielded == list(course.steps(plan, LIMITS))
    assert len({step.key for step in yielded}) == len(yielded)
    segments = course.segment_names(plan)
    assert len(set(segments)) == len(segments)
    mountings = [step.mounting for step in yielded if step.kind == "mount"]
    groups = [step.mounting for step in yielded]
    changes = 1 + sum(a != b for a, b in pairwise(groups))
    assert changes == len(mountings)


def test_names_of_segments_tell_item_axis_position_and_repeat() -> None:
    assert {"sf_x_before", "sf_z_09", "sf_y_after", "ma_x_pos", "ma_z_neg", "zo_y_4"} <= set(
        course.segment_names(Plan())
    )
    repeated = course.segment_names(Plan(repeats=2))
    assert {"zo_x_1", "zo_x_1_r2", "ma_y_neg_r2"} <= set(repeated)
    assert not any(name.startswith("sf") and name.endswith("r2") for name in repeated)
    assert "zo_x_12" in course.segment_names(Plan(zero_offset=ZeroOffsetPlan("multi-position")))


def test_the_bench_time_of_the_whole_standard_calibration_is_six_and_a_half_hours() -> None:
    # 12 positions of 30 min are 6 h; rates, turns, warm-up and six mountings are the rest
    hours = sum(step.estimate_s for step in course.steps(Plan(), LIMITS)) / 3600.0
    assert 6.3 < hours < 7.3


def test_done_steps_take_no_time() -> None:
    everything = frozenset(course.segment_names(Plan()))
    assert sum(step.estimate_s for step in course.steps(Plan(), LIMITS, everything)) == 0.0


@pytest.mark.parametrize("name", ["sf_y_before", "sf_y_04", "ma_z_neg", "zo_x_2"])
def test_one_segment_is_repeated_with_all_that_belongs_to_it(name: str) -> None:
    items = list(course.repeat(Plan(), name, LIMITS, reason="noise"))
    assert names(items) == [name]
    recorded = next(c for c in items if isinstance(c, Record | RecordTurns))
    assert recorded.segment.reason == "noise"
    kinds = [type(c) for c in commands(items)]
    assert kinds[:7] == [Stop, PointTo, PowerOff, Mount, PowerOn, SettleCurrent, CheckMounting]
    assert kinds[-2:] == [PointTo, PowerOff]
    keys = {step.key for step in course.steps(Plan(), LIMITS)}
    assert {item.key for item in items if isinstance(item, Step)} <= keys


def test_a_run_from_a_segment_on_takes_the_rest_in_order() -> None:
    everything = course.segment_names(Plan())
    assert tuple(names(list(course.from_segment(Plan(), everything[20], LIMITS)))) == everything[20:]


def test_a_segment_that_the_plan_does_not_have_is_refused_at_once() -> None:
    for call in (course.repeat, course.from_segment):
        with pytest.raises(InputError, match="no segment zo_q_1: choose one"):
            call(Plan(), "zo_q_1")


def test_power_kept_on_is_switched_once_and_off_at_the_end() -> None:
    plan = replace(Plan(), power=PowerPlan(off_between_mountings=False))
    kinds = [type(c) for c in commands(calibration(plan))]
    assert kinds.count(PowerOn) == 1
    assert kinds.count(SettleCurrent) == 1
    assert kinds[-1] is PowerOff
    assert kinds.count(PowerOff) == 2  # before the first mounting and at the end
