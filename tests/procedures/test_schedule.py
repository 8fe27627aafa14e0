"""The mountings a plan needs: no more than needed, in the best order, each segment exactly once."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise, permutations, product
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.procedures.plan import ItemName, Plan, Schedule, ZeroOffsetPlan
from ahrs_lab.procedures.schedule import (
    Mounting,
    four_positions,
    plan_mountings,
    rotation_reference,
    turning_deg,
)
from ahrs_lab.recording.orientation import AXES, Axis, Orientation, all_orientations

PLANS = st.builds(
    Plan,
    items=st.lists(st.sampled_from(get_args(ItemName)), min_size=1, unique=True).map(tuple),
    axes=st.lists(st.sampled_from(AXES), min_size=1, unique=True).map(tuple),
    mounting_order=st.sampled_from(["shortest", "standard"]),
    repeats=st.integers(1, 3),
    zero_offset=st.builds(
        ZeroOffsetPlan, schedule=st.sampled_from(get_args(Schedule)), positions=st.integers(2, 14)
    ),
)


def letters(mountings: tuple[Mounting, ...]) -> list[str]:
    return [mounting.orientation.letters for mounting in mountings]


def test_the_four_positions_are_those_of_table_2() -> None:
    # X as printed; Y and Z by the cyclic exchange (Y, Z, X), (Z, X, Y).
    assert [o.letters for o in four_positions("x")] == ["ENU", "ESD", "WSU", "WND"]
    assert [o.letters for o in four_positions("y")] == ["UEN", "DES", "UWS", "DWN"]
    assert [o.letters for o in four_positions("z")] == ["NUE", "SDE", "SUW", "NDW"]


def test_the_positions_are_those_of_a_recording_made_elsewhere(shared: Path) -> None:
    import tomllib

    header = tomllib.loads((shared / "samples/mems-unit-a/recording.toml").read_text(encoding="utf-8"))
    for segment in header["segment"]:
        axis: Axis = segment["axis"]
        if segment["role"] == "position":
            assert four_positions(axis)[segment["position"] - 1].letters == segment["orientation"]
        else:
            assert rotation_reference(axis).letters == segment["orientation"]


@pytest.mark.parametrize("axis", AXES)
def test_what_the_earth_and_the_other_axes_add_cancels_over_the_four_positions(axis: Axis) -> None:
    total = sum(orientation.matrix for orientation in four_positions(axis))
    assert np.all(total == 0.0)  # any fixed vector, seen from the case, sums to zero on all three axes


def test_a_whole_standard_calibration_needs_six_mountings() -> None:
    mountings = plan_mountings(Plan())
    assert sorted(m.orientation.face for m in mountings) == ["x+", "x-", "y+", "y-", "z+", "z-"]


def test_the_combined_zero_offset_alone_needs_two() -> None:
    assert letters(plan_mountings(Plan(items=("zero_offset",), zero_offset=ZeroOffsetPlan("combined")))) == [
        "ENU",
        "ESD",
    ]


def test_the_combined_schedule_with_the_rates_needs_four() -> None:
    assert len(plan_mountings(Plan(zero_offset=ZeroOffsetPlan("combined")))) == 4


def test_the_order_of_the_standard_takes_the_positions_as_table_2_lists_them() -> None:
    mountings = plan_mountings(Plan(mounting_order="standard"))
    positions = [
        (work.axis, work.position) for mounting in mountings for work in mounting.work if work.position
    ]
    assert positions == [(axis, number) for axis in AXES for number in (1, 2, 3, 4)]
    assert letters(mountings)[:3] == ["UEN", "NUE", "ENU"]
    assert len(mountings) == 14  # X position 1 shares the mounting of Z up


@pytest.mark.parametrize("axis", AXES)
def test_rates_and_turns_share_a_mounting(axis: Axis) -> None:
    kinds = [[w.kind for w in m.work if w.kind != "position"] for m in plan_mountings(Plan())]
    assert kinds.count(["scale_factor", "misalignment"]) == 3


def brute_force(faces: list[list[Orientation]]) -> float:
    """The least turning over every order of the faces and every way to put each."""
    return min(
        sum(turning_deg(a, b) for a, b in pairwise(path))
        for order in permutations(faces)
        for path in product(*order)
    )


@pytest.mark.parametrize(
    "plan",
    [
        Plan(),
        Plan(items=("zero_offset",), axes=("x", "y")),
        Plan(items=("zero_offset",)),
        Plan(items=("scale_factor",)),
        Plan(axes=("x",)),
        Plan(axes=("z", "y"), items=("misalignment", "zero_offset")),
        Plan(zero_offset=ZeroOffsetPlan("combined")),
        Plan(zero_offset=ZeroOffsetPlan("multi-position")),
    ],
)
def test_no_order_turns_the_case_less(plan: Plan) -> None:
    mountings = plan_mountings(plan)
    possible = []
    for mounting in mountings:
        fixed = [w.orientation for w in mounting.work if w.kind != "position"]
        multi = plan.zero_offset.schedule == "multi-position"
        choices = fixed[:1] or ([mounting.orientation] if multi else [w.orientation for w in mounting.work])
        possible.append(list(dict.fromkeys(choices)))
    turned = sum(turning_deg(a.orientation, b.orientation) for a, b in pairwise(mountings))
    assert turned == pytest.approx(brute_force(possible), abs=1e-4)


def test_turning_is_the_angle_of_the_rotation_between_two_ways_to_stand() -> None:
    from scipy.spatial.transform import Rotation

    for a, b in product(all_orientations(), repeat=2):
        expected = np.degrees(Rotation.from_matrix(b.matrix @ a.matrix.T).magnitude())
        assert turning_deg(a, b) == pytest.approx(expected, abs=1e-6)


def expected_work(plan: Plan) -> Counter[tuple[str, str, int | None, int]]:
    wanted: Counter[tuple[str, str, int | None, int]] = Counter()
    for axis in plan.axes:
        if "scale_factor" in plan.items:
            wanted["scale_factor", axis, None, 1] += 1
        if "misalignment" in plan.items:
            for repeat in range(1, plan.repeats + 1):
                wanted["misalignment", axis, None, repeat] += 1
    if "zero_offset" in plan.items:
        schedule = plan.zero_offset.schedule
        count = plan.zero_offset.positions if schedule == "multi-position" else 4
        for axis in ("x",) if schedule == "combined" else plan.axes:
            for position in range(1, count + 1):
                for repeat in range(1, plan.repeats + 1):
                    wanted["position", axis, position, repeat] += 1
    return wanted


@given(PLANS)
def test_each_recording_is_made_exactly_once_and_where_the_table_can_reach(plan: Plan) -> None:
    mountings = plan_mountings(plan)
    made = Counter((w.kind, w.axis, w.position, w.repeat) for m in mountings for w in m.work)
    assert made == expected_work(plan)
    for mounting in mountings:
        for work in mounting.work:
            reached = work.orientation.azimuth_from(mounting.orientation)
            off = (work.azimuth_deg - reached + 180.0) % 360.0 - 180.0
            # multi-position names the nearest of the four orientations
            assert abs(off) <= 45.0 + 1e-9
            if plan.zero_offset.schedule != "multi-position" or work.kind != "position":
                assert off == 0.0
            if work.kind != "position":
                assert work.orientation == rotation_reference(work.axis)
                assert work.azimuth_deg == 0.0


@given(PLANS)
def test_the_shortest_order_mounts_each_face_at_most_once(plan: Plan) -> None:
    from dataclasses import replace

    mountings = plan_mountings(replace(plan, mounting_order="shortest"))
    faces = [mounting.orientation.face for mounting in mountings]
    assert len(faces) == len(set(faces))
    assert len(mountings) <= len(plan_mountings(replace(plan, mounting_order="standard")))


@given(PLANS)
def test_no_mounting_follows_one_of_the_same_face(plan: Plan) -> None:
    faces = [mounting.orientation.face for mounting in plan_mountings(plan)]
    assert all(a != b for a, b in pairwise(faces))


@given(
    st.lists(st.sampled_from(AXES), min_size=1, unique=True).map(tuple),
    st.booleans(),
    st.integers(2, 24),
)
def test_multi_position_keeps_the_axis_level_and_adds_the_fewest_mountings(
    axes: tuple[Axis, ...], rates: bool, count: int
) -> None:
    items: tuple[ItemName, ...] = ("scale_factor", "zero_offset") if rates else ("zero_offset",)
    plan = Plan(items=items, axes=axes, zero_offset=ZeroOffsetPlan("multi-position", 1200.0, count))
    mountings = plan_mountings(plan)
    for mounting in mountings:
        for work in mounting.work:
            if work.kind == "position":
                assert work.orientation.up_axis != work.axis
    azimuths = sorted(w.azimuth_deg for m in mountings for w in m.work if w.position and w.axis == axes[0])
    assert azimuths == pytest.approx([360.0 * i / count for i in range(count)])
    # Two axes lie level at once, so two mountings serve three axes and one serves one or two; with rates,
    # each axis has its own mounting up, in which the other two lie level.
    alone = 2 if len(axes) == 3 else 1
    assert len(mountings) == (max(len(axes), 2) if rates else alone)
