"""recording.toml: what is wrong is said with table, key and what to write; what is unknown is carried."""

from __future__ import annotations

from pathlib import Path

import pytest
import tomli_w

from ahrs_lab.errors import InputError
from ahrs_lab.recording.bundle_toml import compose, parse
from ahrs_lab.recording.read import read_bundle
from tests.recording.making import HEADER, Take, take, write_bundle

SEGMENT = """
[[segment]]
file = "segments/zo_x_1.csv"
orientation = "ENU"
item = "zero_offset"
axis = "x"
role = "position"
position = 1
"""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('format = "ahrs-lab-recording"\n', "", ["“format” is missing"]),
        ("ahrs-lab-recording", "other", ["“format” is “other”"]),
        ("version = 1", "version = 2", ["format version 2", "newer version of the software"]),
        ("version = 1", 'version = "1"', ["“version” is '1'", "whole number"]),
        ("version = 1\n", "", ["“version” is missing"]),
        ("jjf1536-2015", "jjf9999", ["“procedure” is “jjf9999”", "imu-discrete"]),
        ("[site]\nlatitude_deg = 39.9042\n", "", ["table [site] is missing"]),
        ("latitude_deg = 39.9042\n", "", ["[site]", "“latitude_deg” is missing"]),
        ("39.9042", "139.9042", ["“latitude_deg” is 139.9042", "between -90 and 90"]),
        ("39.9042", "nan", ["“latitude_deg” is nan", "finite number"]),
        ("39.9042", "true", ["“latitude_deg” is True", "finite number"]),
        ('rate_unit = "deg/s"\n', "", ["[device]", "“rate_unit” is missing"]),
        ("deg/s", "deg", ["“rate_unit” is “deg”", "deg/s, rad/s, LSB"]),
        ("sample_rate_hz = 50.0", "sample_rate_hz = 0", ["“sample_rate_hz”", "between"]),
        ("sample_rate_hz = 50.0", 'sample_rate_hz = "50"', ["“sample_rate_hz” is '50'"]),
        ('file = "segments/zo_x_1.csv"\n', "", ["[[segment]] 1", "“file” is missing"]),
        ("zo_x_1.csv", "zo_x_2.csv", ["segments/zo_x_2.csv", "is not there"]),
        ("segments/zo_x_1.csv", "../zo_x_1.csv", ["inside the recording"]),
        ("segments/zo_x_1.csv", "/etc/passwd.csv", ["inside the recording"]),
        ("segments/zo_x_1.csv", "C:/x.csv", ["inside the recording"]),
        ("segments/zo_x_1.csv", "segments/zo_x_1.xlsx", [".csv or .parquet"]),
        ('"ENU"', '"EUN"', ["[[segment]] 1 (segments/zo_x_1.csv)", "“EUN” is not an orientation"]),
        ('"ENU"', "3", ["“orientation” is 3", "quotation marks"]),
        ("zero_offset", "bias", ["“item” is “bias”", "scale_factor, zero_offset"]),
        ('axis = "x"', 'axis = "X"', ["“axis” is “X”", "x, y, z"]),
        ('"position"', '"place"', ["“role” is “place”", "static_before"]),
        ("position = 1\n", "", ["“position” is missing"]),
        ("position = 1\n", "position = 0\n", ["“position” counts from 1"]),
        ('role = "position"', 'role = "turns"', ["“turns” is missing"]),
        ('role = "position"', 'role = "turns"\nturns = 9.5', ["“turns” is 9.5", "whole number"]),
        ('role = "position"', 'role = "turns"\nturns = 0', ["“turns” is 0"]),
        ('role = "position"', 'role = "rate"', ["“rate_dps” is missing"]),
        (SEGMENT, SEGMENT + SEGMENT, ["lists segments/zo_x_1.csv twice"]),
        (SEGMENT, "", ["lists no segment"]),
        (SEGMENT, "segment = 3", ["[[segment]] tables"]),
        ("version = 1", "version = = 1", ["not valid TOML", "line 2"]),
    ],
)
def test_a_fault_says_where_and_what_to_write(tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    text = HEADER + SEGMENT
    assert old in text
    if new == "segment = 3":
        text = "segment = 3\n" + HEADER
    text = text.replace(old, new, 1) if new != "segment = 3" else text
    folder = write_bundle(tmp_path / "b", [take("zo_x_1")])
    (folder / "recording.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_bundle(folder)
    assert caught.value.exit_code == 2
    assert "recording.toml" in str(caught.value)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_header_that_is_not_text_is_refused(tmp_path: Path) -> None:
    folder = write_bundle(tmp_path / "b", [take("zo_x_1")])
    (folder / "recording.toml").write_bytes(b'format = "\xff\xfe"')
    with pytest.raises(InputError, match="UTF-8"):
        read_bundle(folder)


@pytest.mark.parametrize("what", ["nothing", "empty folder", "text file"])
def test_what_is_no_recording_is_refused(tmp_path: Path, what: str) -> None:
    path = tmp_path / "b"
    if what == "empty folder":
        path.mkdir()
    elif what == "text file":
        path.write_text("hello")
    with pytest.raises(InputError, match=str(path)):
        read_bundle(path)


def test_a_link_out_of_the_recording_is_refused(tmp_path: Path) -> None:
    outside = tmp_path / "outside.csv"
    outside.write_text("t_s,gyro_x,gyro_y,gyro_z\n0.02,0,0,0\n")
    folder = write_bundle(tmp_path / "b", [take("zo_x_1")])
    (folder / "segments/zo_x_1.csv").unlink()
    (folder / "segments/zo_x_1.csv").symlink_to(outside)
    with pytest.raises(InputError, match="outside the recording"):
        read_bundle(folder)


def test_what_this_version_does_not_know_is_carried() -> None:
    text = (
        HEADER.replace("[device]", '[device]\nfirmware = "1.2"').replace(
            "[site]", "[site]\ngravity_mps2 = 9.8015"
        )
        + "[initial]\nheading_deg = 30.0\n[weather]\nsun = true\n"
        + SEGMENT
        + 'colour = "red"\n'
    )
    header, segments = parse(text.encode(), "recording.toml")
    assert header.notes == {
        "weather": {"sun": True},
        "site": {"gravity_mps2": 9.8015},
        "device": {"firmware": "1.2"},
    }
    assert segments[0].extra == {"colour": "red"}
    again = tomli_w.dumps(compose(header, segments)).encode()
    assert b'firmware = "1.2"' in again
    assert parse(again, "recording.toml") == (header, segments)


def test_the_name_of_a_segment_is_its_files_without_the_take() -> None:
    text = HEADER + SEGMENT.replace("zo_x_1.csv", "zo_x_1.2.parquet")
    assert parse(text.encode(), "r")[1][0].name == "zo_x_1"


def test_static_and_dynamic_segments_need_no_axis_and_role() -> None:
    text = HEADER.replace("jjf1536-2015", "static") + (
        '[[segment]]\nfile = "segments/a.csv"\norientation = "UEN"\nitem = "static"\n'
    )
    segment = parse(text.encode(), "r")[1][0]
    assert (segment.axis, segment.role, segment.position) == ("x", "position", None)


def missing(folder: Path, takes: list[Take]) -> list[tuple[str, str, str]]:
    general = read_bundle(write_bundle(folder, takes)).general
    assert all(finding.kind == "missing" and not finding.segment for finding in general)
    return [(finding.item, finding.severity, str(finding.what)) for finding in general]


def test_missing_positions_are_named(tmp_path: Path) -> None:
    takes = [take("a", position=1), take("b", orientation="WSU", position=3)]
    assert missing(tmp_path / "b", takes) == [
        ("zero_offset", "unusable", "zero offset of axis x: position 2 of 4 is missing."),
        ("zero_offset", "unusable", "zero offset of axis x: position 4 of 4 is missing."),
    ]


def test_a_superseded_or_interrupted_segment_is_as_good_as_missing(tmp_path: Path) -> None:
    letters = ("ENU", "ESD", "WSU", "WND")
    takes = [take(f"p{i}", orientation=letters[i], position=i + 1) for i in range(4)]
    takes[1].keys["interrupted"] = True
    takes[2].keys["superseded"] = True
    recording = read_bundle(write_bundle(tmp_path / "b", takes))
    assert [finding.what.params["what"].params["position"] for finding in recording.general] == [2, 3]
    assert [entry.counts for entry in recording.segments] == [True, False, False, True]
    assert [finding.kind for finding in recording.segments[1].findings] == ["set_aside"]


def test_four_positions_of_one_axis_serve_the_combined_schedule(tmp_path: Path) -> None:
    letters = ("ENU", "ESD", "WSU", "WND")
    assert (
        missing(
            tmp_path / "b",
            [take(f"p{i}", orientation=letters[i], position=i + 1, axis="z") for i in range(4)],
        )
        == []
    )


def test_positions_that_stand_otherwise_than_table_2_are_named(tmp_path: Path) -> None:
    letters = ("ENU", "ESD", "NWU", "WND")
    found = missing(tmp_path / "b", [take(f"p{i}", orientation=letters[i], position=i + 1) for i in range(4)])
    assert found == [
        (
            "zero_offset",
            "unusable",
            "zero offset of axis x: the positions do not stand as table 2 of the standard says.",
        )
    ]


@pytest.mark.parametrize("gone", [None, 5])
def test_a_multi_position_schedule_counts_its_steps_of_azimuth(tmp_path: Path, gone: int | None) -> None:
    takes = [take(f"p{i}", position=i + 1, azimuth_deg=30.0 * i) for i in range(12) if i != gone]
    expected = [] if gone is None else ["zero offset of axis x: position 6 of 12 is missing."]
    assert [text for _, _, text in missing(tmp_path / "b", takes)] == expected


def scale_factor(
    rates: list[float], roles: tuple[str, ...] = ("static_before", "static_after")
) -> list[Take]:
    common = {"orientation": "UEN", "item": "scale_factor", "axis": "x"}
    return [
        *(take(role, 20.0, role=role, **common) for role in roles),
        *(take(f"r{i}", 36.0, role="rate", rate_dps=rate, **common) for i, rate in enumerate(rates)),
    ]


EIGHT = [10.0, -10.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0]


def test_a_complete_scale_factor_lacks_nothing(tmp_path: Path) -> None:
    assert read_bundle(write_bundle(tmp_path / "b", scale_factor(EIGHT))).findings == ()


def test_what_a_scale_factor_lacks_is_named(tmp_path: Path) -> None:
    found = missing(tmp_path / "b", scale_factor([10.0, 20.0, 30.0, 40.0, 50.0, 60.0], ("static_after",)))
    assert [(severity, text.split(": ", 1)[1]) for _, severity, text in found] == [
        ("unusable", "the recording at rest before the rates is missing (role static_before)."),
        ("unusable", "6 rates were recorded, the standard asks for 7 to 11."),
        ("unusable", "all rates have the same sense: both are needed."),
    ]


def test_more_rates_than_the_standard_asks_for_are_noted(tmp_path: Path) -> None:
    found = missing(
        tmp_path / "b", scale_factor([sign * rate for rate in range(10, 70, 10) for sign in (1, -1)])
    )
    assert [severity for _, severity, _ in found] == ["note"]


def test_turns_in_one_sense_only_lack_the_other(tmp_path: Path) -> None:
    entry = take("ma", 60.0, orientation="UEN", item="misalignment", role="turns", turns=1)
    assert (
        missing(tmp_path / "b", [entry])[0][2]
        == "misalignment of axis x: the turns in the negative sense are missing."
    )


def test_an_axis_that_does_not_stand_vertical_cannot_be_turned_about(tmp_path: Path) -> None:
    takes = scale_factor(EIGHT)
    for entry in takes:
        entry.keys["axis"] = "y"
    recording = read_bundle(write_bundle(tmp_path / "b", takes))
    assert {(finding.kind, finding.severity) for finding in recording.findings} == {
        ("orientation", "unusable")
    }
    assert len(recording.findings) == len(takes)
