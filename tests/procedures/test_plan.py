"""Plans: what is refused with which advice, what is only noted, and that nothing is lost on the way to a
file."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.metrology.plan_labels import PLAN_LABELS
from ahrs_lab.procedures.plan import (
    MisalignmentPlan,
    Plan,
    PowerPlan,
    ScaleFactorPlan,
    SettlingPlan,
    ZeroOffsetPlan,
    check_plan,
    default_rates,
    deviations,
    load_plan,
    plan_from_text,
    plan_from_toml,
    plan_to_toml,
    save_plan,
)
from ahrs_lab.resource_files import resource_path

SEVEN = "[-300, -200, -100, 50, 100, 200, 300]"

REFUSED = {
    "six rates": ("[scale_factor]\nrates_dps = [-3, -2, -1, 1, 2, 3]", "has 6 rates", "7 to 11"),
    "twelve rates": (
        "[scale_factor]\nrates_dps = [-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6]",
        "has 12 rates",
        "7 to 11",
    ),
    "one sense only": ("[scale_factor]\nrates_dps = [1, 2, 3, 4, 5, 6, 7]", "one sense only", "± pairs"),
    "a zero rate": ("[scale_factor]\nrates_dps = [-3, -2, -1, 0, 1, 2, 3]", "contains 0 °/s", "replace it"),
    "a rate twice": (
        "[scale_factor]\nrates_dps = [-3, -2, -1, 1, 1, 2, 3]",
        "1 °/s more than once",
        "remove",
    ),
    "a rate too slow": (
        "[scale_factor]\nrates_dps = [-3, -2, -1, 1e-4, 1, 2, 3]",
        "0.0001 °/s",
        "from 0.001",
    ),
    "a short dwell": ("[scale_factor]\ndwell_s = 19.9", "dwell_s is 19.9 s", "write 20 or more"),
    "a short rest": ("[scale_factor]\nstatic_s = 5", "static_s is 5 s", "write 20 or more"),
    "a short position": ("[zero_offset]\nduration_s = 10", "duration_s is 10 s", "write 20 or more"),
    "an endless dwell": ("[scale_factor]\ndwell_s = 1e9", "dwell_s is 1000000000 s", "up to a week"),
    "turns not whole": ("[misalignment]\nturns = 9.5", "turns is 9.5, which is not whole", "for example 10"),
    "no turns": ("[misalignment]\nturns = 0", "turns is 0", "whole number of turns"),
    "negative turns": ("[misalignment]\nturns = -10", "turns is -10", "both senses"),
    "a negative rate of turns": ("[misalignment]\nrate_dps = -100", "rate_dps is -100", "magnitude"),
    "one position": (
        '[zero_offset]\nschedule = "multi-position"\npositions = 1',
        "positions is 1",
        "from 2 to 360",
    ),
    "an unknown setting": ("[scale_factor]\ndwel_s = 30", "no setting scale_factor.dwel_s", "mean dwell_s"),
    "an unlike setting": ("colour = 1", "no setting colour", "use one of axes"),
    "an unknown schedule": ('[zero_offset]\nschedule = "both"', "is 'both'", "standard, combined"),
    "an unknown axis": ('axes = ["x", "w"]', "axes[1] is 'w'", "one of x, y, z"),
    "no axis": ("axes = []", "axes is empty", "at least one"),
    "an axis twice": ('axes = ["x", "x"]', "twice", "remove"),
    "a text for a number": ('[scale_factor]\ndwell_s = "20"', "dwell_s is '20'", "a finite number"),
    "not a number": ("[scale_factor]\ndwell_s = nan", "dwell_s is nan", "a finite number"),
    "a truth for a number": ("[scale_factor]\ndwell_s = true", "dwell_s is True", "a finite number"),
    "a number for a truth": ("[power]\noff_between_mountings = 1", "is 1", "true or false"),
    "a number for a list": ("[scale_factor]\nrates_dps = 100", "rates_dps is 100", "a list"),
    "a number for a table": ("power = 12", "power is 12", "[power]"),
    "a number for a name": ("name = 3", "name is 3", "a text in quotes"),
    "no repeats": ("repeats = 0", "repeats is 0", "from 1 to 100"),
    "too many volts": ("[power]\nvoltage_v = 120", "voltage_v is 120", "from 0 to 30"),
    "no volts": ("[power]\nvoltage_v = 0", "voltage_v is 0", "above zero"),
    "a timeout before the hold": (
        "[settling]\nhold_s = 5\ntimeout_s = 4",
        "timeout_s is 4 s, not longer than the 5 s",
        "make it longer",
    ),
    "no rate tolerance": (
        "[settling]\nrate_tolerance_relative = 0\nrate_tolerance_dps = 0",
        "never count as steady",
        "above zero",
    ),
    "a wild mounting tolerance": ("mounting_tolerance_deg = 90", "is 90", "from 0 to 30"),
    "broken TOML": ("name = ", "not valid TOML", "my.toml"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_plan_that_cannot_be_run_is_refused_with_what_to_do(case: str) -> None:
    text, what, advice = REFUSED[case]
    with pytest.raises(InputError) as caught:
        plan_from_text(text, "my.toml")
    said = str(caught.value)
    assert what in said
    assert advice in said
    assert "my.toml" in said
    chinese = caught.value.message.text("zh")
    assert re.search("[一-鿿]", chinese)
    assert advice.split()[0] in said


@pytest.mark.parametrize(
    ("plan", "fragment"),
    [
        (Plan(), "300 °/s; the table may turn at 250 °/s"),
        (
            Plan(items=("misalignment",), misalignment=MisalignmentPlan(rate_dps=251.0)),
            "misalignment.rate_dps asks for 251",
        ),
        (
            Plan(items=("zero_offset",), settling=SettlingPlan(pointing_rate_dps=260.0)),
            "settling.pointing_rate_dps asks for 260",
        ),
    ],
)
def test_a_rate_above_the_tables_limit_is_refused(plan: Plan, fragment: str) -> None:
    with pytest.raises(InputError, match=re.escape(fragment)):
        check_plan(plan, TableLimits(250.0, 100.0))


def test_a_rate_beyond_the_device_is_refused_and_its_limit_is_not() -> None:
    with pytest.raises(InputError, match="device measures ±250 °/s"):
        check_plan(Plan(), device_range_dps=250.0)
    check_plan(Plan(), TableLimits(300.0, 1.0), device_range_dps=300.0)


def test_a_device_slower_than_ten_samples_a_second_is_refused() -> None:
    with pytest.raises(InputError, match="gives 5 samples per second"):
        check_plan(Plan(), sample_rate_hz=5.0)


def test_settings_of_an_item_that_is_not_calibrated_do_not_matter() -> None:
    check_plan(Plan(items=("zero_offset",), scale_factor=ScaleFactorPlan(rates_dps=(1.0,), dwell_s=1.0)))


def test_the_standard_plan_is_the_default_and_names_every_setting() -> None:
    path = resource_path("plans/standard.toml")
    assert load_plan(path) == Plan()
    written = tomllib.loads(path.read_text(encoding="utf-8"))
    everything = plan_to_toml(Plan())
    assert {k: set(v) if isinstance(v, dict) else None for k, v in written.items()} == {
        k: set(v) if isinstance(v, dict) else None for k, v in everything.items()
    }
    assert deviations(Plan()) == ()


def test_the_accelerated_plan_is_short_and_says_where_it_leaves_the_standard() -> None:
    plan = load_plan(resource_path("plans/accelerated.toml"))
    assert len(plan.scale_factor.rates_dps) == 7
    assert (plan.scale_factor.dwell_s, plan.zero_offset.duration_s) == (20.0, 60.0)
    assert [str(d) for d in deviations(plan)] == [
        "Each zero-offset position is recorded for 60 s instead of 1800 s (the note "
        "to 7.2 permits a time that fits the device)."
    ]


def test_every_setting_has_a_name_to_read() -> None:
    def keys(table: dict[str, object], prefix: str = "") -> set[str]:
        found: set[str] = set()
        for key, value in table.items():
            found |= keys(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}"}
        return found

    every = keys(plan_to_toml(Plan())) | keys(plan_to_toml(Plan(procedure="imu-discrete")))
    assert every == set(PLAN_LABELS)
    for label in PLAN_LABELS.values():
        assert "_" not in label.text()
        assert label.text("zh") != label.text()


@pytest.mark.parametrize("path", sorted(resource_path("plans").glob("*.toml")), ids=lambda p: p.stem)
def test_every_plan_that_is_shipped_can_be_run(path: Path) -> None:
    check_plan(load_plan(path), TableLimits(400.0, 100.0), 300.0, 100.0)


@pytest.mark.parametrize(
    ("plan", "fragments"),
    [
        (Plan(zero_offset=ZeroOffsetPlan(duration_s=600.0)), ["600 s instead of 1800 s"]),
        (Plan(zero_offset=ZeroOffsetPlan("combined")), ["combined schedule"]),
        (
            Plan(zero_offset=ZeroOffsetPlan("multi-position", 1800.0, 8)),
            ["7.2.2 with 8 positions", "1800 s instead of 1200 s"],
        ),
        (Plan(power=PowerPlan(off_between_mountings=False)), ["Power stays on"]),
        (Plan(misalignment=MisalignmentPlan(rate_dps=50.0)), ["±10 turns at 50 °/s"]),
        (Plan(misalignment=MisalignmentPlan(turns=5)), ["±5 turns at 100 °/s"]),
        (
            Plan(settling=SettlingPlan(rate_tolerance_dps=0.5)),
            ["tolerance of the rate / (°/s) is 0.5, wider than"],
        ),
        (Plan(items=("zero_offset",)), ["scale factor", "misalignment"]),
        (Plan(axes=("x", "z")), ["X, Z"]),
        (
            Plan(scale_factor=ScaleFactorPlan(rates_dps=(-2000, -3, -2, 1, 2, 3, 2000))),
            ["up to 1000 °/s only"],
        ),
    ],
)
def test_what_leaves_the_standard_but_can_be_run_is_named(plan: Plan, fragments: list[str]) -> None:
    check_plan(plan)
    said = [str(d) for d in deviations(plan)]
    assert len(said) == len(fragments)
    assert all(fragment in sentence for fragment, sentence in zip(fragments, said, strict=True))
    assert all(re.search("[一-鿿]", d.text("zh")) for d in deviations(plan))


def test_the_multi_position_method_as_the_standard_recommends_it_is_no_deviation() -> None:
    assert deviations(Plan(zero_offset=ZeroOffsetPlan("multi-position", 1200.0, 12))) == ()


def test_power_kept_on_is_no_deviation_for_the_zero_offset_alone() -> None:
    plan = Plan(items=("zero_offset", "misalignment"), power=PowerPlan(off_between_mountings=False))
    assert not any("Power" in str(d) for d in deviations(plan))


def test_rates_that_leave_much_of_the_range_out_are_named() -> None:
    assert any("±450" in str(d) for d in deviations(Plan(), device_range_dps=450.0))
    assert not deviations(Plan(), device_range_dps=300.0)


def test_twenty_minutes_are_the_default_of_the_multi_position_schedule_only() -> None:
    assert plan_from_toml({"zero_offset": {"schedule": "multi-position"}}).zero_offset.duration_s == 1200.0
    assert plan_from_toml({"zero_offset": {"schedule": "combined"}}).zero_offset.duration_s == 1800.0
    assert not any("instead" in str(d) for d in deviations(Plan(zero_offset=ZeroOffsetPlan("combined"))))


PLANS = st.builds(
    Plan,
    name=st.text(st.characters(blacklist_categories=["Cs", "Cc"]), max_size=20),
    axes=st.sampled_from([("x", "y", "z"), ("y",), ("z", "x")]),
    mounting_order=st.sampled_from(["shortest", "standard"]),
    repeats=st.integers(1, 9),
    scale_factor=st.builds(
        ScaleFactorPlan,
        rates_dps=st.lists(st.floats(0.01, 300.0), min_size=4, max_size=5, unique=True).map(
            lambda rates: (*rates, *(-rate for rate in rates))
        ),
        dwell_s=st.floats(20.0, 1000.0),
    ),
    zero_offset=st.builds(
        ZeroOffsetPlan,
        schedule=st.sampled_from(["standard", "combined", "multi-position"]),
        duration_s=st.floats(20.0, 5000.0),
        positions=st.integers(2, 36),
    ),
    misalignment=st.builds(MisalignmentPlan, rate_dps=st.floats(1.0, 300.0), turns=st.integers(1, 99)),
    power=st.builds(PowerPlan, off_between_mountings=st.booleans()),
)


@given(PLANS)
def test_a_plan_survives_its_file(plan: Plan) -> None:
    assert plan_from_toml(plan_to_toml(plan)) == plan


def test_a_plan_is_saved_and_loaded(tmp_path: Path) -> None:
    plan = Plan(name="试验", repeats=2)
    save_plan(plan, tmp_path / "plan.toml")
    assert load_plan(tmp_path / "plan.toml") == plan


def test_a_plan_that_cannot_be_read_or_written_says_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml does not exist"):
        load_plan(tmp_path / "nowhere.toml")
    (tmp_path / "old.toml").write_bytes("name = '度'".encode("gb2312"))
    with pytest.raises(InputError, match="UTF-8"):
        load_plan(tmp_path / "old.toml")
    with pytest.raises(MachineError, match="cannot be read"):
        load_plan(tmp_path)
    with pytest.raises(MachineError, match="cannot be written"):
        save_plan(Plan(), tmp_path / "missing" / "plan.toml")


def test_default_rates_are_those_of_the_standard_plan_for_its_range() -> None:
    assert default_rates(300.0) == ScaleFactorPlan().rates_dps


@given(st.floats(0.05, 20000.0), st.floats(0.05, 5000.0))
def test_default_rates_can_be_run_whatever_the_range(range_dps: float, limit_dps: float) -> None:
    rates = default_rates(range_dps, limit_dps)
    plan = Plan(items=("scale_factor",), scale_factor=ScaleFactorPlan(rates_dps=rates))
    pointing = SettlingPlan(pointing_rate_dps=min(20.0, limit_dps))
    check_plan(Plan(plan.name, ("scale_factor",), scale_factor=plan.scale_factor, settling=pointing),
               TableLimits(limit_dps, 1.0), range_dps)  # fmt: skip
    assert max(rates) >= 0.9 * min(range_dps, limit_dps)


def test_no_rates_are_made_up_for_an_unknown_range() -> None:
    for unknown in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="state the device's range"):
            default_rates(unknown)
