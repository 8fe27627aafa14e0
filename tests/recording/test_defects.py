"""Every defect that samples can have is named with file and line; its severity says if it matters."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.recording.finding import Finding
from ahrs_lab.recording.finding_list import MOST_OF_A_KIND
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.samples import interval_s
from tests.recording.making import (
    HEADER,
    Take,
    cell,
    change,
    columns,
    csv_lines,
    four_positions,
    rate_take,
    read_one,
    take,
    write_bundle,
)

FILE = "segments/zo_x_1.csv"


def only(findings: tuple[Finding, ...]) -> Finding:
    assert len(findings) == 1, [str(finding.placed) for finding in findings]
    return findings[0]


def test_a_clean_zero_offset_has_no_finding(tmp_path: Path) -> None:
    assert read_bundle(write_bundle(tmp_path / "b", four_positions())).findings == ()


def test_a_gap_is_named_at_the_row_after_it_and_its_samples_are_counted(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    del entry.lines[100:105]  # lines 101 to 105
    recording, findings = read_one(tmp_path / "b", entry)
    found = only(findings)
    assert (found.segment, found.line, found.kind, found.severity) == (FILE, 101, "gap", "note")
    assert found.what.params["missing"] == 5
    assert recording.segments[0].lost == 5
    assert recording.segments[0].usable
    assert str(found.placed).startswith(f"{FILE}, line 101: a gap of 0.12 s")


def test_a_counter_that_jumps_while_time_goes_on_is_a_gap(tmp_path: Path) -> None:
    entry = change(
        take("zo_x_1"), "counter", lambda c: (np.arange(len(c)) + 3 * (np.arange(len(c)) >= 700)) % 256.0
    )
    recording, findings = read_one(tmp_path / "b", entry)
    found = only(findings)
    assert (found.line, found.kind, found.what.params["missing"]) == (702, "gap", 3)
    assert recording.segments[0].lost == 3


@pytest.mark.parametrize("period", [256, 65536])
def test_a_counter_that_wraps_around_is_no_gap(tmp_path: Path, period: int) -> None:
    count = 1500
    entry = change(take("zo_x_1"), "counter", lambda c: (np.arange(count) * 4 + period - 400) % period * 1.0)
    _, findings = read_one(tmp_path / "b", entry)
    assert findings == ()


def test_a_repeated_time_is_named_and_its_row_left_out(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    entry.lines.insert(50, entry.lines[49])
    recording, findings = read_one(tmp_path / "b", entry)
    times = [finding for finding in findings if finding.kind == "time"]
    assert only(tuple(times)).line == 51
    assert len(recording.segments[0].samples) == 1500
    assert 51 not in recording.segments[0].lines


def test_a_time_that_goes_backward_is_named_and_its_row_left_out(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    cell(entry.lines, 60, "t_s", "0.5")
    recording, findings = read_one(tmp_path / "b", entry)
    assert [(finding.kind, finding.line) for finding in findings] == [("time", 60), ("gap", 61)]
    assert np.all(np.diff(recording.segments[0].samples["t_s"]) > 0)
    assert recording.segments[0].lost == 1


def test_one_time_far_ahead_does_not_take_the_rest_with_it(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    cell(entry.lines, 60, "t_s", "1e6")
    recording, findings = read_one(tmp_path / "b", entry)
    assert ("time", 61) in [(finding.kind, finding.line) for finding in findings]
    assert len(recording.segments[0].samples) == 1499
    assert recording.segments[0].usable


def test_a_clock_that_starts_again_leaves_what_came_before(tmp_path: Path) -> None:
    entry = change(take("zo_x_1", 60.0), "t_s", lambda t: np.where(t > 30.0, t - 30.0, t))
    recording, findings = read_one(tmp_path / "b", entry)
    assert only(findings).kind == "time"
    assert only(findings).line == 1502
    assert recording.segments[0].samples["t_s"][-1] == 30.0


@pytest.mark.parametrize("text", ["nan", "NaN", "inf", "-inf"])
def test_a_cell_that_is_not_finite_is_named_and_its_row_left_out(tmp_path: Path, text: str) -> None:
    entry = take("zo_x_1")
    cell(entry.lines, 77, "gyro_y", text)
    recording, findings = read_one(tmp_path / "b", entry)
    found = only(findings)
    assert (found.kind, found.line, found.severity) == ("bad_cell", 77, "note")
    assert "gyro_y" in str(found.what)
    assert 77 not in recording.segments[0].lines
    assert recording.segments[0].lost == 1


@pytest.mark.parametrize("text", ["abc", "", "1;5", "0x10", "1_0", "--"])
def test_a_cell_that_is_no_number_is_named_with_its_text(tmp_path: Path, text: str) -> None:
    entry = take("zo_x_1")
    cell(entry.lines, 1200, "gyro_x", text)
    recording, findings = read_one(tmp_path / "b", entry)
    found = only(findings)
    assert (found.kind, found.line) == ("bad_cell", 1200)
    assert f"gyro_x = “{text}”" in str(found.what)
    assert len(recording.segments[0].samples) == 1499


def test_a_bad_cell_of_a_column_that_is_not_needed_keeps_its_row(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    cell(entry.lines, 9, "accel_x", "?")
    recording, findings = read_one(tmp_path / "b", entry)
    assert only(findings).line == 9
    assert len(recording.segments[0].samples) == 1500
    assert np.isnan(recording.segments[0].samples["accel_x"][7])


def test_rows_of_another_length_are_named(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    entry.lines[29] += ",1"
    entry.lines[-1] = entry.lines[-1][:20].rsplit(",", 1)[0]  # cut off by a crash
    recording, findings = read_one(tmp_path / "b", entry)
    places = [(finding.kind, finding.line) for finding in findings]
    assert places == [("bad_cell", 30), ("bad_cell", 1501), ("gap", 31)]
    assert findings[0].what.params == {"cells": 10, "columns": 9}
    assert len(recording.segments[0].samples) == 1498


def test_lines_stay_right_where_blank_lines_lie_between(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    entry.lines.insert(10, "")
    cell(entry.lines, 500, "gyro_x", "x")
    recording, findings = read_one(tmp_path / "b", entry)
    assert only(findings).line == 500
    assert recording.segments[0].lines[9] == 12


def test_a_run_of_equal_bad_rows_is_one_finding(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    for line in range(100, 120):
        cell(entry.lines, line, "gyro_x", "nan")
    recording, findings = read_one(tmp_path / "b", entry)
    assert only(findings).line == 100
    assert "119" in str(only(findings).what)
    assert recording.segments[0].lost == 20


def test_a_defect_that_never_ends_is_counted_not_listed(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    for line in range(2, 1000, 3):
        cell(entry.lines, line, "gyro_x", "?")
    recording, findings = read_one(tmp_path / "b", entry)
    assert len(findings) == MOST_OF_A_KIND + 1
    assert findings[-1].what.params["count"] == 333 - MOST_OF_A_KIND
    assert findings[-1].line == 998
    assert recording.segments[0].lost == 333


@pytest.mark.parametrize(
    ("lines", "line", "word"),
    [
        ([], 1, "empty"),
        (["t_s,gyro_x,gyro_y,gyro_z"], 2, "no sample"),
        (["0.02,1,2,3", "0.04,1,2,3"], 1, "header row is missing"),
        (["t_s,gyro_x,gyro_z", "0.02,1,2"], 1, "gyro_y"),
        (["gyro_x,gyro_y,gyro_z", "1,2,3"], 1, "t_s"),
        (["t_s;gyro_x;gyro_y;gyro_z", "0,02;1;2;3"], 1, "semicolons"),
        (["t_s,gyro_x,gyro_x,gyro_z", "0.02,1,2,3"], 1, "twice"),
        (["t_s,gyro_x,gyro_y,gyro_z", "a,b,c,d"], 1, "t_s"),
    ],
)
def test_a_file_without_samples_is_unusable_and_says_why(
    tmp_path: Path, lines: list[str], line: int, word: str
) -> None:
    entry = take("zo_x_1")
    entry.lines = lines
    recording, findings = read_one(tmp_path / "b", entry)
    found = findings[-1]
    assert (found.kind, found.severity, found.line) == ("file", "unusable", line)
    assert word in str(found.what)
    assert not recording.segments[0].usable


@pytest.mark.parametrize(("orientation", "feels"), [("ESD", "z+"), ("UEN", "z+")])
def test_gravity_that_disagrees_with_the_orientation_is_unusable(
    tmp_path: Path, orientation: str, feels: str
) -> None:
    entry = take("zo_x_1")
    entry.keys["orientation"] = orientation
    _, findings = read_one(tmp_path / "b", entry)
    found = next(finding for finding in findings if finding.kind == "orientation")
    assert (found.severity, found.line, found.what.params["up"]) == ("unusable", 2, feels)


@pytest.mark.parametrize(("tilt_deg", "unusable"), [(4.0, False), (6.0, True)])
def test_a_tilt_of_more_than_five_degrees_at_rest_is_unusable(
    tmp_path: Path, tilt_deg: float, unusable: bool
) -> None:
    entry = take("zo_x_1")
    change(entry, "accel_z", lambda a: a * np.cos(np.radians(tilt_deg)))
    change(entry, "accel_x", lambda a: a + 9.80665 * np.sin(np.radians(tilt_deg)))
    _, findings = read_one(tmp_path / "b", entry)
    assert [finding.kind for finding in findings] == (["orientation"] if unusable else [])
    if unusable:
        assert findings[0].what.params["tilt"] == pytest.approx(tilt_deg, abs=0.1)


def test_without_accelerometers_the_attitude_output_tells_the_mounting(tmp_path: Path) -> None:
    made = columns(30.0, "ENU")
    kept = {name: column for name, column in made.items() if not name.startswith("accel")}
    # X heading, Y pitch, Z roll: right side down by 90° has Y pointing down.
    kept |= {
        name: np.full(1500, angle)
        for name, angle in (("heading_deg", 0.0), ("pitch_deg", 0.0), ("roll_deg", 90.0))
    }
    entry = take("zo_x_1")
    entry.lines = csv_lines(kept)
    _, findings = read_one(tmp_path / "b", entry)
    assert [(finding.kind, finding.what.params["up"]) for finding in findings] == [("orientation", "y-")]
    assert findings[0].what.params["tilt"] == 90.0


def test_attitude_output_that_agrees_is_no_finding(tmp_path: Path) -> None:
    made = columns(30.0, "ENU")
    kept = {name: column for name, column in made.items() if not name.startswith("accel")}
    # zo_x_1 has Z up and X east: nose (Z) straight up, where only pitch counts.
    kept |= {
        "heading_deg": np.full(1500, 0.0),
        "pitch_deg": np.full(1500, 89.5),
        "roll_deg": np.full(1500, 0.0),
    }
    entry = take("zo_x_1")
    entry.lines = csv_lines(kept)
    assert read_one(tmp_path / "b", entry)[1] == ()


@pytest.mark.parametrize(("unit", "factor"), [("g", 1 / 9.80665), ("LSB", 123.0)])
def test_gravity_is_felt_in_any_unit(tmp_path: Path, unit: str, factor: float) -> None:
    header = HEADER + f'accel_unit = "{unit}"\n'
    good, bad = take("zo_x_1"), take("zo_x_1", orientation="ESD")
    bad.keys["orientation"] = "ENU"
    for entry in (good, bad):
        change(entry, "accel_z", lambda a: a * factor)
    assert read_one(tmp_path / "good", good, header)[1] == ()
    assert [finding.kind for finding in read_one(tmp_path / "bad", bad, header)[1]] == ["orientation"]


def test_a_specific_force_that_is_not_gravity_asks_for_the_unit(tmp_path: Path) -> None:
    entry = change(take("zo_x_1"), "accel_z", lambda a: a / 9.80665)
    found = only(read_one(tmp_path / "b", entry)[1])
    assert (found.kind, found.severity) == ("magnitude", "note")


def test_a_rate_that_is_not_the_demanded_one_is_unusable(tmp_path: Path) -> None:
    entry = change(
        rate_take(100.0), "table_angle_deg", lambda a: (100.1 * np.arange(1, len(a) + 1) / 50) % 360
    )
    found = only(read_one(tmp_path / "b", entry)[1])
    assert (found.kind, found.severity, found.line) == ("rate", "unusable", 2)
    assert found.what.params["mean"] == pytest.approx(100.1)


def turning_at(rate_dps: float, angle: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray((rate_dps * np.arange(1, len(angle) + 1) / 50) % 360)


@pytest.mark.parametrize(("rate_dps", "relative"), [(0.5, 2e-2), (5.0, 2e-3), (-200.0, 2e-4)])
def test_the_rate_may_be_off_by_twice_what_clause_6_allows(
    tmp_path: Path, rate_dps: float, relative: float
) -> None:
    for factor, kinds in ((1.9, []), (2.1, ["rate"])):
        real = rate_dps * (1 + factor * relative)
        entry = change(
            rate_take(rate_dps),
            "table_angle_deg",
            partial(turning_at, real),
        )
        findings = read_one(tmp_path / f"b{factor}", entry)[1]
        assert [finding.kind for finding in findings] == kinds


def test_a_rate_that_was_lost_for_a_while_is_named_where_it_began(tmp_path: Path) -> None:
    def stumbles(
        angle: np.ndarray[tuple[int], np.dtype[np.float64]],
    ) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        t_s = np.arange(1, len(angle) + 1) / 50
        return (100.0 * t_s + 0.4 * np.clip(t_s - 20, 0, 1) - 0.4 * np.clip(t_s - 24, 0, 1)) % 360

    found = only(read_one(tmp_path / "b", change(rate_take(100.0), "table_angle_deg", stumbles))[1])
    assert (found.kind, found.severity) == ("rate", "note")
    assert 1001 < found.line <= 1051


def test_the_tables_own_rate_counts_where_its_angle_is_not_there(tmp_path: Path) -> None:
    entry = rate_take(100.0)
    entry.lines[0] = entry.lines[0].replace("table_angle_deg", "table_rate_dps")
    change(entry, "table_rate_dps", lambda a: np.full(len(a), 99.9))
    found = only(read_one(tmp_path / "b", entry)[1])
    assert (found.kind, found.severity) == ("rate", "unusable")


def test_a_trip_of_the_table_shows_in_the_gyro_alone(tmp_path: Path) -> None:
    made = columns(36.0, "UEN", 100.0)
    del made["table_angle_deg"]
    made["gyro_x"][1000:] = 0.0
    made["gyro_x"] += np.random.default_rng(1).normal(0, 0.2, 1800)
    entry = rate_take(100.0)
    entry.lines = csv_lines(made)
    found = only(read_one(tmp_path / "b", entry)[1])
    assert (found.kind, found.severity, found.line) == ("rate", "unusable", 1002)


@pytest.mark.parametrize(("moved_deg", "severity"), [(0.005, None), (0.1, "note"), (2.0, "unusable")])
def test_a_table_that_moves_at_rest_is_named(tmp_path: Path, moved_deg: float, severity: str | None) -> None:
    entry = change(
        take("zo_x_1"), "table_angle_deg", lambda a: (moved_deg * (np.arange(len(a)) > 700) - 0.001) % 360
    )
    findings = read_one(tmp_path / "b", entry)[1]
    assert [(finding.kind, finding.severity) for finding in findings] == (
        [("rest", severity)] if severity else []
    )


def turns_take(degrees: float) -> Take:
    entry = take(
        "ma", 60.0, orientation="UEN", item="misalignment", axis="x", role="turns", rate_dps=0.0, turns=10
    )
    return change(
        entry,
        "table_angle_deg",
        lambda a: (359.9999 + np.clip(np.arange(len(a)) / 50 - 5, 0, 50) / 50 * degrees) % 360,
    )


@pytest.mark.parametrize(
    ("degrees", "severity"), [(3600.0, None), (3600.1, "note"), (3590.0, "unusable"), (-3600.0, "unusable")]
)
def test_turns_have_to_be_whole(tmp_path: Path, degrees: float, severity: str | None) -> None:
    findings = read_one(tmp_path / "b", turns_take(degrees))[1]
    assert [(finding.kind, finding.severity) for finding in findings] == (
        [("turns", severity)] if severity else []
    )


@pytest.mark.parametrize(("turned", "kinds"), [(10, []), (9, ["turns"]), (-10, ["turns"])])
def test_turns_are_counted_by_the_gyro_where_the_table_says_nothing(
    tmp_path: Path, turned: int, kinds: list[str]
) -> None:
    made = columns(60.0, "UEN")
    del made["table_angle_deg"]
    made["gyro_x"][500:2300] = turned * 360.0 / 36.0
    entry = turns_take(3600.0)
    entry.lines = csv_lines(made)
    assert [finding.kind for finding in read_one(tmp_path / "b", entry)[1]] == kinds


def test_samples_lost_while_turning_make_the_angle_unknown(tmp_path: Path) -> None:
    entry = turns_take(3600.0)
    del entry.lines[1000:1100]
    kinds = {finding.kind: finding.severity for finding in read_one(tmp_path / "b", entry)[1]}
    assert kinds == {"gap": "note", "turns": "unusable"}


@pytest.mark.parametrize("role", ["position", "rate", "static_before"])
def test_a_dwell_under_twenty_seconds_is_unusable(tmp_path: Path, role: str) -> None:
    entry = rate_take(100.0, 19.0) if role == "rate" else take("zo_x_1", 19.0)
    if role == "static_before":
        entry = take("st", 19.0, orientation="UEN", item="scale_factor", role=role)
    found = only(read_one(tmp_path / "b", entry)[1])
    assert (found.kind, found.severity) == ("dwell", "unusable")
    assert found.what.params["seen"] == 19.0


def test_twenty_seconds_are_enough(tmp_path: Path) -> None:
    assert read_one(tmp_path / "b", take("zo_x_1", 20.0))[1] == ()


def test_gaps_do_not_count_as_dwell(tmp_path: Path) -> None:
    entry = take("zo_x_1", 24.0)
    del entry.lines[200:500]
    kinds = {finding.kind: finding.severity for finding in read_one(tmp_path / "b", entry)[1]}
    assert kinds == {"gap": "note", "dwell": "unusable"}


@pytest.mark.parametrize(("rate_hz", "unusable"), [(5.0, True), (9.0, True), (10.0, False)])
def test_fewer_than_ten_samples_a_second_are_unusable(tmp_path: Path, rate_hz: float, unusable: bool) -> None:
    entry = take("zo_x_1")
    entry.lines = csv_lines(columns(60.0, "ENU", rate_hz=rate_hz))
    header = HEADER.replace("50.0", str(rate_hz))
    findings = read_one(tmp_path / "b", entry, header)[1]
    assert [(finding.kind, finding.severity) for finding in findings] == (
        [("sample_rate", "unusable")] if unusable else []
    )


def test_a_sample_rate_that_the_times_contradict_is_named_once(tmp_path: Path) -> None:
    findings = read_one(tmp_path / "b", take("zo_x_1"), HEADER.replace("50.0", "100.0"))[1]
    assert (only(findings).kind, only(findings).severity) == ("sample_rate", "note")


def test_parquet_findings_count_lines_like_csv(tmp_path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    folder = write_bundle(tmp_path / "b", [take("zo_x_1")])
    made = columns(30.0, "ENU")
    made["gyro_x"][75] = np.nan
    parquet.write_table(pa.table(made), folder / "segments/zo_x_1.parquet")
    text = (folder / "recording.toml").read_text().replace("zo_x_1.csv", "zo_x_1.parquet")
    (folder / "recording.toml").write_text(text)
    found = only(read_bundle(folder).segments[0].findings)
    assert (found.kind, found.line) == ("bad_cell", 77)


def test_interval_bridges_a_gap_or_not(tmp_path: Path) -> None:
    entry = take("zo_x_1")
    del entry.lines[100:105]
    samples = read_one(tmp_path / "b", entry)[0].segments[0].samples
    assert interval_s(samples, 50.0).sum() == pytest.approx(30.0)
    assert interval_s(samples, 50.0, bridge_gaps=False).sum() == pytest.approx(29.9)


def test_one_sample_and_one_row_are_said_in_the_singular(tmp_path: Path) -> None:
    entry = change(take("zo_x_1"), "t_s", lambda t: np.where(np.arange(len(t)) == 700, t[699], t))
    del entry.lines[100]
    said = [str(finding.what) for finding in read_one(tmp_path / "b", entry)[1]]
    assert any("1 sample is missing." in what for what in said)
    assert any("is repeated. The row is left out." in what for what in said)
    assert not any("1 samples" in what or "1 rows" in what for what in said)


def test_more_samples_and_rows_are_said_in_the_plural(tmp_path: Path) -> None:
    entry = change(take("zo_x_1"), "t_s", lambda t: np.where(np.abs(np.arange(len(t)) - 700) < 2, t[699], t))
    del entry.lines[100:103]
    said = [str(finding.what) for finding in read_one(tmp_path / "b", entry)[1]]
    assert any("3 samples are missing." in what for what in said)
    assert any("is repeated. 2 rows up to line" in what for what in said)
