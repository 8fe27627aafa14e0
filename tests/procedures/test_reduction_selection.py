"""What a recording lacks is named; what can still stand is evaluated, what cannot stops or is left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.procedures import reduction
from ahrs_lab.procedures.reduction_selection import select
from ahrs_lab.recording.completeness import missing_segments
from ahrs_lab.recording.finding import Finding, Kind
from ahrs_lab.recording.read import RecordedSegment, Recording, read_bundle
from tests.procedures.virtual_unit import VirtualUnit, changed, without

reduce_recording = partial(reduction.reduce_recording, trials=0)
"""Without the Monte Carlo check, which has tests of its own."""


def spoilt(recorded: RecordedSegment, kind: Kind, line: int = 7) -> RecordedSegment:
    what = Message("spoilt by {kind}", kind=kind)
    finding = Finding(what, recorded.segment.file, line, "unusable", kind)
    return replace(recorded, findings=(finding,))


def set_aside(recorded: RecordedSegment, **flags: bool) -> RecordedSegment:
    return replace(recorded, segment=replace(recorded.segment, **flags))  # type: ignore[arg-type]


def complete(unit: VirtualUnit, segments: Sequence[RecordedSegment]) -> Recording:
    """With the findings of what is missing, as the reader adds them."""
    recording = unit.recording(segments)
    return replace(recording, general=missing_segments([recorded.segment for recorded in segments]))


@pytest.mark.parametrize("kind", ["dwell", "sample_rate", "turns", "gap"])
def test_a_segment_below_the_standards_minimum_stops_and_names_file_and_line(kind: Kind) -> None:
    unit = VirtualUnit()
    made = unit.rates("x")
    made[3] = spoilt(made[3], kind)
    with pytest.raises(InputError, match=rf"sf_x_02\.csv, line 7: spoilt by {kind}"):
        reduce_recording(complete(unit, made))


@pytest.mark.parametrize("kind", ["orientation", "rate", "rest", "file"])
def test_a_rate_that_cannot_be_used_is_left_out_while_seven_remain(kind: Kind) -> None:
    unit = VirtualUnit(K=(1.01, 1, 1))
    made = unit.rates("x")
    made[3] = spoilt(changed(made[3], gyro_x=made[3].samples["gyro_x"] + 5.0), kind)
    result = reduce_recording(complete(unit, made))
    assert pytest.approx(1.01, rel=1e-9) == result.scale_factor["x"].K
    assert made[3].segment.name not in result.scale_factor["x"].segments
    assert [(w.segment, w.line) for w in result.warnings] == [("segments/sf_x_02.csv", 7)]


def test_with_fewer_than_seven_rates_the_axis_is_left_out_and_the_others_stand() -> None:
    unit = VirtualUnit()
    made = unit.rates("x")
    made[3], made[4] = spoilt(made[3], "rate"), spoilt(made[4], "rate")
    result = reduce_recording(complete(unit, [*made, *unit.rates("y")]))
    assert set(result.scale_factor) == {"y"}
    assert "scale factor x is not evaluated: 6 usable rates are left" in result.warnings[-1].what.text()


def test_where_nothing_stands_the_evaluation_stops() -> None:
    unit = VirtualUnit()
    made = unit.positions("x")
    made[1] = spoilt(made[1], "orientation", line=2)
    with pytest.raises(InputError, match=r"zo_x_2\.csv, line 2: spoilt by orientation"):
        reduce_recording(complete(unit, made))


@pytest.mark.parametrize(
    ("item", "make", "gone"),
    [
        ("zero offset", lambda unit: unit.positions("x"), 2),
        ("misalignment about", lambda unit: unit.turns("x"), 1),
        ("scale factor", lambda unit: unit.rates("x"), 0),
        ("scale factor", lambda unit: unit.rates("x"), -1),
    ],
)
def test_a_missing_segment_takes_its_own_quantity_with_it(
    item: str, make: Callable[[VirtualUnit], list[RecordedSegment]], gone: int
) -> None:
    unit = VirtualUnit()
    made = make(unit)
    del made[gone]
    result = reduce_recording(complete(unit, [*made, *unit.positions("z")]))
    assert not result.scale_factor
    assert not result.misalignment
    assert set(result.zero_offset) == {"z"}
    assert any(f"{item} x is not evaluated" in warning.what.text() for warning in result.warnings)


def test_the_last_take_counts() -> None:
    unit = VirtualUnit(B=(1e-3, 0, 0))
    made = unit.positions("x")
    wrong = set_aside(changed(made[2], gyro_x=made[2].samples["gyro_x"] + 1.0), superseded=True)
    broken = set_aside(changed(made[1], gyro_x=made[1].samples["gyro_x"] + 1.0), interrupted=True)
    result = reduce_recording(complete(unit, [made[0], broken, made[1], wrong, made[2], made[3]]))
    assert pytest.approx(1e-3) == result.zero_offset["x"].B
    assert [take["segment"] for take in result.notes["repeated"]] == [broken.segment.file, wrong.segment.file]


def test_lost_samples_of_a_dwell_do_not_change_the_zero_offset() -> None:
    unit = VirtualUnit(B=(1e-3, 0, 0))
    made = unit.positions("x", duration_s=100.0)
    kept = np.ones(1000, dtype=bool)
    kept[300:350] = False
    columns = {name: column[kept] for name, column in made[0].samples.columns.items()}
    made[0] = replace(made[0], samples=type(made[0].samples)(columns))
    result = reduce_recording(complete(unit, made)).zero_offset["x"]
    assert pytest.approx(1e-3, abs=1e-15) == result.B
    assert result.durations_s == pytest.approx([100.0] * 4)


def test_lost_samples_of_a_turn_are_bridged() -> None:
    unit = VirtualUnit(L={"yx": 1e-3}, earth_dps=0.0)
    made = unit.turns("x")
    kept = np.ones(380, dtype=bool)
    kept[200:203] = False
    columns = {name: column[kept] for name, column in made[0].samples.columns.items()}
    made[0] = replace(made[0], samples=type(made[0].samples)(columns))
    assert pytest.approx(1e-3, rel=1e-12) == reduce_recording(complete(unit, made)).misalignment["yx"].L


def test_turns_that_differ_in_number_are_not_combined() -> None:
    unit = VirtualUnit()
    made = [unit.turns("x", turns=10)[0], unit.turns("x", turns=9)[1]]
    with pytest.raises(InputError, match="different numbers of turns"):
        reduce_recording(complete(unit, made))


def test_recordings_of_turns_that_differ_in_duration_are_warned_of() -> None:
    unit = VirtualUnit(B=(0, 0.1, 0))
    made = unit.turns("x")
    longer = {name: np.append(column, column[-1]) for name, column in made[1].samples.columns.items()}
    for _ in range(4):
        longer = {name: np.append(column, column[-1]) for name, column in longer.items()}
    longer["t_s"] = np.arange(1, len(longer["t_s"]) + 1) / 10.0
    made[1] = replace(made[1], samples=type(made[1].samples)(longer))
    result = reduce_recording(complete(unit, made))
    assert "differ by -0.5 s" in result.warnings[0].what.text()
    row = next(row for row in result.misalignment["yx"].uncertainty.rows if row.symbol == "ΔT")
    # 0.1 °/s over half a second is 0.05° in 7200°; the rectangular law has half of that width to each side
    assert row.half_width == pytest.approx(0.5)
    assert abs(row.sensitivity) == pytest.approx(0.1 / 7200.0, rel=0.02)


def test_counts_without_a_fitted_scale_factor_are_left_out() -> None:
    unit = VirtualUnit(rate_unit="LSB", shown_per_dps=(1000.0,) * 3)
    with pytest.raises(InputError, match="counts need the fitted scale factor"):
        reduce_recording(complete(unit, unit.positions("x")))


def test_rates_of_the_table_need_its_angle() -> None:
    unit = VirtualUnit()
    made = [without(recorded, "table_angle_deg") for recorded in unit.rates("x")]
    with pytest.raises(InputError, match="table_angle_deg"):
        reduce_recording(complete(unit, made), rates="table")


def test_another_procedure_is_refused() -> None:
    unit = VirtualUnit()
    recording = unit.recording(unit.positions("x"))
    other = replace(recording, header=replace(recording.header, procedure="static"))
    with pytest.raises(InputError, match="static"):
        reduce_recording(other)


def test_a_recording_without_anything_of_the_standard_is_refused() -> None:
    unit = VirtualUnit()
    made = [replace(r, segment=replace(r.segment, item="static")) for r in unit.positions("x")]
    with pytest.raises(InputError, match="no segment that is evaluated"):
        reduce_recording(complete(unit, made))


def test_numbers_too_large_to_add_are_refused() -> None:
    unit = VirtualUnit()
    made = unit.positions("x")
    made[0] = changed(made[0], gyro_x=np.full(len(made[0].samples), 1e308))
    with pytest.raises(InputError, match="B_x is not a finite number"):
        reduce_recording(complete(unit, made))


def test_a_dead_axis_in_counts_is_left_out() -> None:
    unit = VirtualUnit(K=(0.0, 1.0, 1.0), B=(1.0, 0.0, 0.0), rate_unit="LSB", earth_dps=0.0)
    result = reduce_recording(complete(unit, [*unit.rates("x"), *unit.positions("x"), *unit.rates("y")]))
    assert result.scale_factor["x"].K == 0.0
    assert not result.zero_offset


def shorten(folder: Path) -> None:
    """15 s of the 30 s at 100 °/s."""
    path = folder / "segments" / "sf_y_07.csv"
    path.write_text("\n".join(path.read_text().split("\n")[:151]) + "\n")


def spoil_a_cell(folder: Path) -> None:
    path = folder / "segments" / "zo_x_2.csv"
    lines = path.read_text().split("\n")
    lines[100] = lines[100].replace(lines[100].split(",")[1], "nan")
    path.write_text("\n".join(lines))


def mount_wrongly(folder: Path) -> None:
    path = folder / "recording.toml"
    text = path.read_text().replace(
        'segments/zo_z_2.csv"\norientation = "SDE"', 'segments/zo_z_2.csv"\norientation = "SUE"'
    )
    path.write_text(text.replace('orientation = "SUE"', 'orientation = "NUE"'))


@pytest.fixture
def sample(shared: Path, tmp_path: Path) -> Path:
    folder = tmp_path / "bundle"
    (folder / "segments").mkdir(parents=True)
    source = shared / "samples" / "mems-unit-a"
    for path in source.rglob("*.*"):
        (folder / path.relative_to(source)).write_bytes(path.read_bytes())
    return folder


def test_a_short_segment_of_a_bundle_stops_with_its_name(sample: Path) -> None:
    shorten(sample)
    with pytest.raises(InputError, match=r"sf_y_07\.csv, line 151: 15\.0 s"):
        reduce_recording(read_bundle(sample))


def test_a_spoilt_cell_of_a_bundle_is_named_and_costs_next_to_nothing(sample: Path) -> None:
    spoil_a_cell(sample)
    result = reduce_recording(read_bundle(sample))
    assert ("segments/zo_x_2.csv", 101) in [(w.segment, w.line) for w in result.warnings]
    assert pytest.approx(3.0874e-3, abs=1e-6) == result.zero_offset["x"].B


def test_a_wrong_mounting_in_a_bundle_takes_its_quantity_and_leaves_the_others(sample: Path) -> None:
    mount_wrongly(sample)
    result = reduce_recording(read_bundle(sample))
    assert set(result.zero_offset) == {"x", "y"}
    assert set(result.scale_factor) == {"x", "y", "z"}
    assert len(result.misalignment) == 6
    assert "zero offset z is not evaluated" in result.warnings[-1].what.text()


@pytest.mark.parametrize(
    "notes",
    [
        {"environment": {"temperature_c": "warm"}},
        {"environment": 20.0},
        {"environment": {"temperature_c": float("nan")}},
        {"deviations": 3},
        {"deviations": [3]},
        {"deviations": [{"template": "{a.__class__}", "params": {"a": 1}}]},
    ],
)
def test_notes_that_are_no_notes_are_refused(notes: dict[str, object]) -> None:
    unit = VirtualUnit()
    with pytest.raises(InputError, match=r"environment|deviations"):
        reduce_recording(unit.recording(unit.positions("x"), **notes))


def test_pauses_between_recordings_count_also_after_the_power_was_off() -> None:
    """The device's clock starts anew with each power-on; drift goes by the time between its recordings."""
    unit = VirtualUnit()
    begun = [70.0, 100.0, 40.0, 75.0]
    made = [unit.rest("x", "static_before"), unit.rest("x", "static_after")] * 2
    shifted = [
        changed(recorded, t_s=recorded.samples["t_s"] + start)
        for recorded, start in zip(made, begun, strict=True)
    ]
    starts = np.array([take.start_s for take in select(unit.recording(shifted)).takes])
    assert np.diff(starts) == pytest.approx([30.0, 20.0, 35.0])
    one_after_the_other = [take.start_s for take in select(unit.recording(made)).takes]
    assert one_after_the_other == pytest.approx([0.0, 20.0, 40.0, 60.0])
