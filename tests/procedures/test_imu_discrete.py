"""The discrete IMU calibration as commands: mountings, turns, positions; what is refused before it moves."""

import re
import tomllib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.metrology.imu_calibration import SCHEMES
from ahrs_lab.procedures import course
from ahrs_lab.procedures.commands import (
    CheckMounting,
    Command,
    Mount,
    PointTo,
    PowerOff,
    PowerOn,
    Record,
    RecordTurns,
    Step,
)
from ahrs_lab.procedures.imu_rules import check_scheme
from ahrs_lab.procedures.plan import ImuPlan, Plan, check_plan, deviations, plan_from_toml, plan_to_toml
from ahrs_lab.recording.orientation import Orientation, all_orientations
from ahrs_lab.recording.segment import Segment
from ahrs_lab.resource_files import resource_path

LIMITS = TableLimits(400.0, 100.0)


def imu_plan(**imu: Any) -> Plan:
    return plan_from_toml({"procedure": "imu-discrete", "imu": imu})


def commands(plan: Plan, done: frozenset[str] = frozenset()) -> list[Command]:
    return [c for c in course.calibration(plan, done, LIMITS) if not isinstance(c, Step)]


def recorded(plan: Plan) -> list[Segment]:
    return [c.segment for c in commands(plan) if isinstance(c, (Record, RecordTurns))]


@pytest.mark.parametrize("scheme", list(SCHEMES))
def test_every_named_scheme_takes_six_mountings_and_one_power_on(scheme: str) -> None:
    found = commands(imu_plan(scheme=scheme))
    assert len([c for c in found if isinstance(c, Mount)]) == 6
    assert len([c for c in found if isinstance(c, PowerOn)]) == 1
    assert isinstance(found[-1], PowerOff)
    positions = [s for s in recorded(imu_plan(scheme=scheme)) if s.role == "position"]
    assert {s.position: s.orientation.letters for s in positions} == dict(enumerate(SCHEMES[scheme], 1))
    assert all((s.item, s.axis) == ("static", s.orientation.up_axis) for s in positions)


def test_the_table_points_to_each_position_from_how_the_case_is_mounted() -> None:
    pointed, mounted = 0.0, Orientation("ENU")
    for command in commands(imu_plan(scheme="24")):
        if isinstance(command, Mount):
            mounted, pointed = command.orientation, 0.0
        elif isinstance(command, PointTo):
            pointed = command.azimuth_deg
        elif isinstance(command, CheckMounting):
            assert command.orientation == mounted.turned(round(pointed / 90.0))
        elif isinstance(command, Record):
            segment = command.segment
            assert segment.orientation == mounted.turned(round(pointed / 90.0))
            assert (segment.azimuth_deg, segment.extra["mounting"]) == (pointed, mounted.letters)


def test_the_case_is_turned_forward_and_back_about_each_axis_that_points_up() -> None:
    turns = [c for c in commands(imu_plan(turns=3, rate_dps=50.0)) if isinstance(c, RecordTurns)]
    assert [c.segment.name for c in turns] == [f"rot_{a}_{s}" for a in "xyz" for s in ("pos", "neg")]
    assert [c.turns for c in turns] == [3, -3] * 3
    for command in turns:
        segment = command.segment
        assert (segment.item, segment.role, segment.turns) == ("rotation", "turns", command.turns)
        assert segment.orientation.face == f"{segment.axis}+"
        assert segment.rate_dps == np.copysign(50.0, command.turns)
        assert command.duration_s > 3 * 360.0 / 50.0
    assert len({command.duration_s for command in turns}) == 1


def test_an_axis_that_only_points_down_is_turned_about_as_it_stands() -> None:
    plan = imu_plan(scheme="own", positions=["DES", "DWN", "NUE", "NDW", "ENU"])
    turned = {s.axis: s.orientation.face for s in recorded(plan) if s.role == "turns"}
    assert turned == {"x": "x-", "y": "y+", "z": "z+"}
    assert len([c for c in commands(plan) if isinstance(c, Mount)]) == 4


def test_a_position_between_two_quarter_turns_is_pointed_to() -> None:
    plan = imu_plan(scheme="own", positions=["UEN@30", "DES", "SUW", "NDW", "NWU@-100", "SWD"])
    by_number = {s.position: s for s in recorded(plan) if s.role == "position"}
    for number, wanted in ((1, ("UEN", 30.0)), (5, ("NWU", -100.0))):
        segment = by_number[number]
        mounted = Orientation(str(segment.extra["mounting"]))
        assert segment.azimuth_deg is not None
        off = (segment.azimuth_deg - Orientation(wanted[0]).azimuth_from(mounted) - wanted[1]) % 360.0
        assert min(off, 360.0 - off) < 1e-9
        nearest = round(segment.azimuth_deg / 90.0)
        assert segment.orientation == mounted.turned(nearest)


def test_repeats_record_turns_and_positions_again() -> None:
    plan = plan_from_toml({"procedure": "imu-discrete", "repeats": 2, "imu": {"scheme": "6"}})
    names = course.segment_names(plan)
    assert len(names) == len(set(names)) == 2 * (6 + 6)
    assert sum(name.endswith("_r2") for name in names) == 12


@given(st.sets(st.sampled_from(course.segment_names(imu_plan(scheme="12")))))
def test_what_is_recorded_is_not_recorded_again(done: set[str]) -> None:
    plan = imu_plan(scheme="12")
    left = [name for name in course.segment_names(plan) if name not in done]
    found = [c for c in commands(plan, frozenset(done)) if isinstance(c, (Record, RecordTurns))]
    assert [c.segment.name for c in found] == left
    mounts = len([c for c in commands(plan, frozenset(done)) if isinstance(c, Mount)])
    assert mounts <= 6
    assert bool(mounts) == bool(left)


def test_one_segment_alone_and_all_from_one_on() -> None:
    plan = imu_plan(scheme="8")
    names = course.segment_names(plan)
    again = [c for c in course.repeat(plan, "pos_07", LIMITS, "a door") if isinstance(c, Record)]
    assert [(c.segment.name, c.segment.reason) for c in again] == [("pos_07", "a door")]
    rest = [c for c in course.from_segment(plan, names[5], LIMITS) if isinstance(c, (Record, RecordTurns))]
    assert tuple(c.segment.name for c in rest) == names[5:]


def test_the_steps_are_those_that_are_yielded() -> None:
    plan = imu_plan(scheme="20")
    yielded = [item for item in course.calibration(plan, limits=LIMITS) if isinstance(item, Step)]
    assert yielded == list(course.steps(plan, LIMITS))


# the plan ────────────────────────────────────────────────────────────────────────────────────────────────


@pytest.mark.parametrize(
    ("imu", "said"),
    [
        ({"scheme": "9"}, "write one of 6, 8, 12, 16, 20, 24, own"),
        ({"turns": 0}, "imu.turns is 0: write a number from 1"),
        ({"turns": 2.5}, "imu.turns is 2.5, which is not whole"),
        ({"rate_dps": -10.0}, "imu.rate_dps is -10: write a number from 0.1"),
        ({"dwell_s": 1.0}, "imu.dwell_s is 1: write a number from 10"),
        ({"positions": ["UEN"]}, "a list of your own, but imu.scheme asks for 12"),
        ({"scheme": "own"}, "The 0 positions have rank 0 of 4"),
        ({"scheme": "own", "positions": ["UEN", "UNW", "UWS", "USE"]}, "The 4 positions have rank 1 of 4"),
        ({"scheme": "own", "positions": ["UEN", "DES", "SUW", "NDW"]}, "have rank 3 of 4"),
        ({"scheme": "own", "positions": ["UEN@", "DES"]}, "imu.positions contains “UEN@”"),
        ({"scheme": "own", "positions": ["UEN@361", "DES"]}, "imu.positions contains “UEN@361”"),
        ({"scheme": "own", "positions": ["UEN@" + "9" * 400]}, "imu.positions contains “UEN@999"),
        ({"scheme": "own", "positions": ["UNE"]}, "“UNE” is not an orientation"),
        ({"scheme": "own", "positions": ["UEN", "UNW@-90"]}, "names a position twice"),
        ({"scheme": "own", "positions": ["UEN"] * 400}, "400 positions: 360 are the most"),
        ({"dwel_s": 20.0}, "did you mean dwell_s?"),
    ],
)  # fmt: skip
def test_what_cannot_be_run_or_evaluated_is_refused(imu: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        imu_plan(**imu)


def test_settings_of_the_other_procedure_are_refused() -> None:
    with pytest.raises(InputError, match="zero_offset means nothing to the procedure imu-discrete"):
        plan_from_toml({"procedure": "imu-discrete", "zero_offset": {}})
    with pytest.raises(InputError, match="procedure is 'imu': write one of jjf1536-2015, imu-discrete"):
        plan_from_toml({"procedure": "imu"})


def test_a_table_or_a_unit_too_slow_for_the_turns_is_refused() -> None:
    with pytest.raises(InputError, match=r"imu.rate_dps asks for 100 °/s; the table may turn at 60 °/s"):
        check_plan(imu_plan(), TableLimits(60.0, 10.0))
    with pytest.raises(InputError, match="the device measures ±90 °/s"):
        check_plan(imu_plan(), LIMITS, device_range_dps=90.0)
    check_plan(imu_plan(), LIMITS, device_range_dps=100.0, sample_rate_hz=5.0)


def test_power_stays_on_between_mountings_unless_the_plan_says_otherwise() -> None:
    assert not imu_plan().power.off_between_mountings
    plan = plan_from_toml({"procedure": "imu-discrete", "power": {"off_between_mountings": True}})
    assert any("several power-ons" in message.text() for message in deviations(plan))
    assert len([c for c in commands(plan) if isinstance(c, PowerOn)]) == 6


def test_a_scheme_whose_azimuths_do_not_balance_says_so_and_the_balanced_do_not() -> None:
    said = {
        scheme: any("do not balance" in d.text() for d in deviations(imu_plan(scheme=scheme)))
        for scheme in SCHEMES
    }
    assert said == {"6": True, "8": True, "12": False, "16": False, "20": False, "24": False}


@given(
    st.lists(st.sampled_from([o.letters for o in all_orientations()]), min_size=1, max_size=12, unique=True)
)
def test_an_own_list_is_accepted_exactly_where_its_matrix_has_rank(letters: list[str]) -> None:
    rows = [[1.0, *Orientation(one).gravity_unit()] for one in letters]
    data = {"procedure": "imu-discrete", "imu": {"scheme": "own", "positions": letters}}
    if np.linalg.matrix_rank(np.array(rows)) == 4:
        plan = plan_from_toml(data)
        assert plan_from_toml(plan_to_toml(plan)) == plan
    else:
        with pytest.raises(InputError, match="of 4"):
            plan_from_toml(data)


def test_the_condition_of_a_balanced_scheme_is_the_root_of_three() -> None:
    from ahrs_lab.procedures.imu_discrete import positions

    assert check_scheme(positions(ImuPlan(scheme="24"))) == pytest.approx(np.sqrt(3.0))


def test_the_shipped_plan_names_every_setting() -> None:
    text = resource_path("plans/imu-discrete.toml").read_text(encoding="utf-8")
    assert plan_from_toml(tomllib.loads(text)) == imu_plan()
    assert tomllib.loads(text) == plan_to_toml(imu_plan())


def test_a_plan_of_jjf_1536_is_written_as_it_always_was() -> None:
    assert not {"procedure", "imu"} & plan_to_toml(Plan()).keys()
    assert plan_from_toml({"procedure": "jjf1536-2015"}) == Plan()
