"""``evaluate`` and ``certificate`` from outside: the sample's numbers, the keys people rely on, and
every defect that a recording can have.

The numbers are those printed in interfaces.md for a unit that was simulated outside this project.
"""

from __future__ import annotations

import codecs
import json
import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.resource_files import resource_path

Capture = pytest.CaptureFixture[str]
Damage = Callable[[Path], None]

PRINTED = {
    "scale_factor": {"x": 1.0023354972170277, "y": 0.9981303779047173, "z": 1.0007446457794191},
    "zero_offset": {"x": 3.087392621666639e-3, "y": -2.3500235037499885e-3, "z": 1.805527627916662e-3},
    "misalignment": {
        "yx": -2.6885030749999997e-4,
        "zx": 3.9153196791666666e-4,
        "xy": 6.027772040277779e-4,
        "zy": -7.190909452777777e-4,
        "xz": -4.287619295833333e-4,
        "yz": 8.788338404166666e-4,
    },
}
SYMBOLS = {"scale_factor": "K", "zero_offset": "B", "misalignment": "L"}
STATED = {"unit", "standard_uncertainty", "expanded_uncertainty", "coverage_factor", "dof"}
KEYS = {
    "scale_factor": STATED
    | {"K", "F0", "rates_dps", "means", "residuals", "nonlinearity_ppm", "asymmetry_ppm"},
    "zero_offset": STATED | {"B", "duration_s", "angles_deg"},
    "misalignment": STATED | {"L", "turns", "angle_positive_deg", "angle_negative_deg"},
}


@pytest.fixture(scope="module")
def sample(shared: Path) -> Path:
    return shared / "samples" / "mems-unit-a"


def evaluated(capsys: Capture, *words: str) -> dict[str, Any]:
    """The JSON of ``evaluate``: one object, strict, and nothing else said."""
    capsys.readouterr()
    assert main(["evaluate", *words, "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""

    def refuse(constant: str) -> float:
        raise AssertionError(f"{constant} is not JSON")

    data = json.loads(captured.out, parse_constant=refuse)
    assert isinstance(data, dict)
    return data


def test_the_sample_gives_the_printed_numbers(sample: Path, capsys: Capture) -> None:
    result = evaluated(capsys, str(sample))
    for item, values in PRINTED.items():
        assert result[item].keys() == values.keys()
        for key, value in values.items():
            assert result[item][key][SYMBOLS[item]] == pytest.approx(value, rel=1e-10, abs=0)


def test_the_keys_are_those_of_the_interface(sample: Path, capsys: Capture) -> None:
    result = evaluated(capsys, str(sample))
    assert {"procedure", "bundle_sha256", "software", *KEYS, "warnings"} <= result.keys()
    assert result["procedure"] == "jjf1536-2015"
    assert re.fullmatch("[0-9a-f]{64}", result["bundle_sha256"])
    assert re.fullmatch(r"ahrs-lab \d+\.\d+\.\d+\S*", result["software"])
    for item, keys in KEYS.items():
        for entry in result[item].values():
            assert keys <= entry.keys()
            assert entry["expanded_uncertainty"] == pytest.approx(
                entry["coverage_factor"] * entry["standard_uncertainty"]
            )
            assert entry["standard_uncertainty"] > 0
    for axis in "xyz":
        scale_factor = result["scale_factor"][axis]
        assert scale_factor["unit"] == "(deg/s)/(deg/s)"
        assert scale_factor["rates_dps"] == [-300, -200, -100, -50, -10, 10, 50, 100, 200, 300]
        assert len(scale_factor["means"]) == len(scale_factor["residuals"]) == 10
        zero_offset = result["zero_offset"][axis]
        assert zero_offset["unit"] == "deg/s"
        assert zero_offset["duration_s"] == pytest.approx(600.0)
        assert len(zero_offset["angles_deg"]) == 4
    for entry in result["misalignment"].values():
        assert (entry["unit"], entry["turns"]) == ("rad", 10)
    for warning in result["warnings"]:
        assert {"segment", "line", "what"} <= warning.keys()
        assert isinstance(warning["line"], int)
        assert isinstance(warning["what"], str)


def test_folder_and_zip_are_the_same_recording(sample: Path, tmp_path: Path, capsys: Capture) -> None:
    packed = tmp_path / "unit.ahrsrec"
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(sample.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(sample).as_posix())
    assert evaluated(capsys, str(packed)) == evaluated(capsys, str(sample))


def test_rates_from_the_tables_angle(sample: Path, capsys: Capture) -> None:
    """The sample's table holds its rates to some parts in a million: so close are the two, and no closer."""
    demanded = evaluated(capsys, str(sample))
    measured = evaluated(capsys, str(sample), "--rates", "table")
    for axis, entry in measured["scale_factor"].items():
        other = demanded["scale_factor"][axis]
        assert entry["K"] == pytest.approx(other["K"], rel=2e-5)
        assert entry["K"] != other["K"]
        assert entry["rates_dps"] != other["rates_dps"]
        assert entry["rates_dps"] == pytest.approx(other["rates_dps"], rel=1e-4)
    assert {k: v["B"] for k, v in measured["zero_offset"].items()} == {
        k: v["B"] for k, v in demanded["zero_offset"].items()
    }


def test_the_uncertainty_of_annex_a(sample: Path, capsys: Capture) -> None:
    result = evaluated(capsys, str(sample), "--uncertainty", "annex-a")
    for item, values in PRINTED.items():
        for key, value in values.items():
            entry = result[item][key]
            assert entry[SYMBOLS[item]] == pytest.approx(value, rel=1e-10, abs=0)
            assert entry["coverage_factor"] == 2.0


@pytest.mark.parametrize("uncertainty", ["gum", "annex-a"])
def test_evaluate_leaves_its_files_and_a_certificate_can_be_made_of_them(
    sample: Path, tmp_path: Path, capsys: Capture, uncertainty: str
) -> None:
    out = tmp_path / "out"
    result = evaluated(capsys, str(sample), "--out", str(out), "--uncertainty", uncertainty)
    assert json.loads((out / "result.json").read_text(encoding="utf-8")) == result
    assert (out / "budget.csv").read_bytes().startswith(codecs.BOM_UTF8 + b"quantity ")
    for name in ("plots.pdf", "original-record.pdf"):
        assert (out / name).read_bytes().startswith(b"%PDF")
    job = tmp_path / "job.toml"
    text = resource_path("jobs/demo.toml").read_text(encoding="utf-8")
    stated = 'uncertainty_method = "gum"'
    assert stated in text
    job.write_text(text.replace(stated, f'uncertainty_method = "{uncertainty}"'), encoding="utf-8")
    target = tmp_path / "certificate.pdf"
    capsys.readouterr()
    words = ["certificate", str(out / "result.json"), "--job", str(job), "--out", str(target), "--json"]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)["certificate"] == str(target)
    assert target.read_bytes().startswith(b"%PDF")
    plain = len(target.read_bytes())
    assert main([*words, "--budget-annex"]) == 0
    capsys.readouterr()
    assert len(target.read_bytes()) > plain
    # Nobody has signed it: the answer is no, not an error.
    assert main(["verify", str(target), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["signatures"] == []


def test_evaluate_takes_the_figures_of_a_jobs_standards(
    sample: Path, tmp_path: Path, capsys: Capture
) -> None:
    text = resource_path("jobs/demo.toml").read_text(encoding="utf-8")
    stated = 'figure = "rate_relative_from_10"\nU = 2e-4\nk = 2\n'
    assert stated in text
    job = tmp_path / "job.toml"
    job.write_text(text.replace(stated, stated.replace("2e-4\nk = 2", "1e-4\nk = 2.5")), encoding="utf-8")
    plain = evaluated(capsys, str(sample))
    result = evaluated(capsys, str(sample), "--job", str(job))
    rows = {row["symbol"]: row for row in result["scale_factor"]["x"]["budget"] if row["symbol"] == "Ω"}
    assert (rows["Ω"]["origin"], rows["Ω"]["certificate"]) == ("certificate", "DEMO-26-0815")
    assert (rows["Ω"]["divisor"], rows["Ω"]["half_width"]) == (2.5, 1e-4)
    assert result["scale_factor"]["x"]["K"] == plain["scale_factor"]["x"]["K"]
    used = result["notes"]["capability"]["stated"]
    certificates = {one["figure"]: one["certificate"] for one in used}
    assert certificates["rate_relative_from_10"] == certificates["wobble_arcsec"] == "DEMO-26-0815"
    assert certificates["fixture_perpendicularity_arcsec"] == "DEMO-26-0821"
    job.write_text(job.read_text(encoding="utf-8").replace("k = 2.5\n", ""), encoding="utf-8")
    assert main(["evaluate", str(sample), "--job", str(job)]) == 2
    assert "“standard[1].figure[3].k” is missing; add it" in capsys.readouterr().err


# ── recordings with defects ─────────────────────────────────────────────────────────────────────────────────


@pytest.fixture
def one_axis(sample: Path, tmp_path: Path) -> Path:
    """A copy of what the sample has of axis x, to be damaged."""
    target = tmp_path / "unit"
    (target / "segments").mkdir(parents=True)
    head, *segments = (sample / "recording.toml").read_text(encoding="utf-8").split("[[segment]]")
    kept = ["[[segment]]" + segment for segment in segments if re.search(r"segments/\w+_x_", segment)]
    (target / "recording.toml").write_text(head + "".join(kept), encoding="utf-8")
    for path in (sample / "segments").glob("*_x_*.csv"):
        shutil.copyfile(path, target / "segments" / path.name)
    return target


def in_lines(name: str, change: Callable[[list[str]], list[str]]) -> Damage:
    """A change of a segment file's lines; ``lines[0]`` is the header row, line 1."""

    def damage(bundle: Path) -> None:
        path = bundle / "segments" / name
        lines = change(path.read_text(encoding="utf-8").splitlines())
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")

    return damage


def in_header(old: str, new: str) -> Damage:
    def damage(bundle: Path) -> None:
        path = bundle / "recording.toml"
        text = path.read_text(encoding="utf-8")
        assert re.search(old, text)
        path.write_text(re.sub(old, new, text), encoding="utf-8")

    return damage


def without_entry(*names: str) -> Damage:
    def damage(bundle: Path) -> None:
        path = bundle / "recording.toml"
        head, *segments = path.read_text(encoding="utf-8").split("[[segment]]")
        kept = [s for s in segments if not any(f"segments/{name}.csv" in s for name in names)]
        assert len(kept) == len(segments) - len(names)
        path.write_text(head + "".join("[[segment]]" + segment for segment in kept), encoding="utf-8")

    return damage


def without_files(pattern: str) -> Damage:
    def damage(bundle: Path) -> None:
        for path in list((bundle / "segments").glob(pattern)):
            path.unlink()

    return damage


def all_of(*damages: Damage) -> Damage:
    def damage(bundle: Path) -> None:
        for one in damages:
            one(bundle)

    return damage


def only_the_zero_offset(bundle: Path) -> None:
    others = [path.stem for path in (bundle / "segments").glob("*.csv") if not path.name.startswith("zo_")]
    without_entry(*others)(bundle)


def cells(lines: list[str], column: str, value: Callable[[int], str], first: int, last: int) -> list[str]:
    """Lines ``first`` to ``last`` with other cells in ``column``; ``value`` of the line's number."""
    index = lines[0].split(",").index(column)
    changed = list(lines)
    for number in range(first, last + 1):
        row = lines[number - 1].split(",")
        row[index] = value(number)
        changed[number - 1] = ",".join(row)
    return changed


def cell(column: str, number: int, text: str) -> Callable[[list[str]], list[str]]:
    return lambda lines: cells(lines, column, lambda _line: text, number, number)


RATE = "sf_x_05.csv"  # 10 °/s for 30 s at 10 samples/s: 300 rows
REST = "zo_x_2.csv"

TOLERATED: list[tuple[str, Damage, str, int, str]] = [
    ("a gap", in_lines(RATE, lambda lines: lines[:100] + lines[150:]), RATE, 101, "50 samples are missing"),
    ("a gap at rest", in_lines(REST, lambda lines: lines[:100] + lines[150:]), REST, 101, "a gap of"),
    ("a repeated time", in_lines(RATE, lambda ln: [*ln[:100], *ln[99:]]), RATE, 101, "repeated"),
    ("a backward time", in_lines(RATE, cell("t_s", 60, "0.5")), RATE, 60, "backward"),
    ("NaN", in_lines(RATE, cell("gyro_x", 60, "NaN")), RATE, 60, "gyro_x = “nan”"),
    ("text in a cell", in_lines(RATE, cell("gyro_y", 61, "abc")), RATE, 61, "gyro_y = “abc”"),
    ("an empty cell", in_lines(RATE, cell("gyro_x", 62, "")), RATE, 62, "gyro_x = “”"),
    ("a short row", in_lines(RATE, lambda ln: [*ln[:49], ln[49][:9], *ln[50:]]), RATE, 50, "cells"),
]


@pytest.mark.parametrize(
    ("damage", "file", "line", "words"), [case[1:] for case in TOLERATED], ids=[case[0] for case in TOLERATED]
)
def test_a_defect_that_leaves_enough_is_named_and_counted(
    one_axis: Path, capsys: Capture, damage: Damage, file: str, line: int, words: str
) -> None:
    before = evaluated(capsys, str(one_axis))
    damage(one_axis)
    result = evaluated(capsys, str(one_axis))
    named = [w for w in result["warnings"] if (w["segment"], w["line"]) == (f"segments/{file}", line)]
    assert any(words in warning["what"] for warning in named)
    for item, symbol in SYMBOLS.items():
        assert result[item].keys() == before[item].keys()
        for key, entry in result[item].items():
            assert entry[symbol] == pytest.approx(before[item][key][symbol], rel=1e-4, abs=1e-4)
    assert result["bundle_sha256"] != before["bundle_sha256"]


def stuck(lines: list[str]) -> list[str]:
    """The table trips half way: its angle stays, the unit feels rest."""
    angle = lines[150].split(",")[lines[0].split(",").index("table_angle_deg")]
    lines = cells(lines, "table_angle_deg", lambda _line: angle, 152, len(lines))
    return cells(lines, "gyro_x", lambda _line: "0.1", 152, len(lines))


def drifting(lines: list[str]) -> list[str]:
    return cells(lines, "table_angle_deg", lambda n: f"{(n - 1) * 5.02 % 360:.5f}", 2, len(lines))


LEFT_OUT: list[tuple[str, Damage, str, int, str, str]] = [
    (
        "orientation against gravity",
        in_header(r'(zo_x_2.csv"\norientation = )"\w+"', r'\1"ENU"'),
        f"segments/{REST}",
        2,
        "the accelerometers feel z- up",
        "zero_offset",
    ),
    (
        "a rate not held",
        in_lines("sf_x_08.csv", drifting),
        "segments/sf_x_08.csv",
        2,
        "demanded were 200",
        "",
    ),
    ("a trip", in_lines("sf_x_08.csv", stuck), "segments/sf_x_08.csv", 2, "demanded were 200", ""),
    (
        "no number at all",
        in_lines(RATE, lambda ln: cells(ln, "gyro_x", lambda _line: "nan", 2, len(ln))),
        f"segments/{RATE}",
        2,
        "no row of the file counts",
        "",
    ),
    ("an empty file", in_lines(RATE, lambda _lines: []), f"segments/{RATE}", 1, "empty", ""),
    ("a file that is not there", without_files(RATE), f"segments/{RATE}", 0, "recording.toml lists it", ""),
    (
        "a position's file that is not there",
        without_files(REST),
        f"segments/{REST}",
        0,
        "recording.toml lists it",
        "zero_offset",
    ),
    (
        "files of too many rates that are not there",
        without_files("sf_x_0[3-6].csv"),
        "segments/sf_x_06.csv",
        0,
        "recording.toml lists it",
        "scale_factor",
    ),
    (
        "a missing position",
        without_entry("zo_x_2"),
        "",
        0,
        "position 2 of 4 is missing",
        "zero_offset",
    ),
    (
        "missing turns",
        without_entry("ma_x_neg"),
        "",
        0,
        "turns in the negative sense are missing",
        "misalignment",
    ),
    (
        "too few rates",
        without_entry("sf_x_03", "sf_x_04", "sf_x_05", "sf_x_06"),
        "",
        0,
        "6 rates were recorded, the standard asks for 7",
        "scale_factor",
    ),
]


@pytest.mark.parametrize(
    ("damage", "file", "line", "words", "lost"),
    [case[1:] for case in LEFT_OUT],
    ids=[case[0] for case in LEFT_OUT],
)
def test_what_a_defect_spoils_is_left_out_and_said_and_the_rest_is_evaluated(
    one_axis: Path, capsys: Capture, damage: Damage, file: str, line: int, words: str, lost: str
) -> None:
    before = evaluated(capsys, str(one_axis))
    damage(one_axis)
    result = evaluated(capsys, str(one_axis))
    assert any(
        (w["segment"], w["line"]) == (file, line) and words in w["what"] for w in result["warnings"]
    ), result["warnings"]
    for item, symbol in SYMBOLS.items():
        assert bool(result[item]) == (item != lost)
        for key, entry in result[item].items():
            assert entry[symbol] == pytest.approx(before[item][key][symbol], rel=1e-4, abs=1e-4)
    if not lost:
        assert len(result["scale_factor"]["x"]["rates_dps"]) == 9


REFUSED: list[tuple[str, Damage, list[str]]] = [
    ("a dwell under 20 s", in_lines(RATE, lambda ln: ln[:190]), [RATE, "line 190", "18.9 s", "20.0 s"]),
    ("a position under 20 s", in_lines(REST, lambda ln: ln[:190]), [REST, "line 190", "18.9 s", "20.0 s"]),
    (
        "a gap that leaves under 20 s",
        in_lines(RATE, lambda ln: ln[:100] + ln[250:]),
        [RATE, "15.0 s", "20.0 s", "record the segment again"],
    ),
    (
        "under 10 samples/s",
        in_lines(REST, lambda ln: [ln[0], *ln[2::2]]),
        [REST, "5.0 samples/s", "10.0"],
    ),
    (
        "turns not whole",
        in_lines("ma_x_pos.csv", lambda ln: ln[:-60]),
        ["ma_x_pos.csv", "3200.0°", "10 whole turns"],
    ),
    (
        "samples lost in the turns",
        in_lines("ma_x_pos.csv", lambda ln: ln[:100] + ln[120:]),
        ["ma_x_pos.csv", "record the segment again"],
    ),
    (
        "none of its files is there",
        without_files("*.csv"),
        ["recording.toml", "segments/sf_x_before.csv", "nor is any other file"],
    ),
    (
        "nothing is left without the files that are not there",
        all_of(only_the_zero_offset, without_files(REST)),
        [f"segments/{REST}: the file is not there", "recording.toml", "zero offset x is not evaluated"],
    ),
    (
        "more than one below the minimum",
        all_of(in_lines(RATE, lambda ln: ln[:190]), in_lines(REST, lambda ln: ln[:190])),
        [f"{RATE}, line 190: 18.9 s", f"{REST}, line 190: 18.9 s", "record these segments again"],
    ),
    (
        "more below the minimum than are named",
        all_of(*(in_lines(f"sf_x_0{i}.csv", lambda ln: ln[:190]) for i in range(7))),
        [f"sf_x_0{i}.csv, line 190" for i in range(5)] + ["And 2 more.", "record these segments again"],
    ),
    ("no recording.toml", lambda bundle: (bundle / "recording.toml").unlink(), ["no recording.toml"]),
    ("a newer format", in_header("version = 1", "version = 2"), ["recording.toml", "version 2", "newer"]),
    ("another format", in_header("ahrs-lab-recording", "something"), ["recording.toml", "something"]),
    ("no TOML", in_header("procedure = ", "procedure "), ["recording.toml", "not valid TOML", "line 3"]),
    ("no latitude", in_header("latitude_deg = .*", ""), ["recording.toml", "latitude_deg"]),
    ("an unknown unit", in_header('"deg/s"', '"rpm"'), ["recording.toml", "rate_unit", "rpm"]),
    ("no such orientation", in_header('"UEN"', '"UUU"'), ["recording.toml", "UUU"]),
    ("a way out of the folder", in_header("segments/zo_x_2.csv", "../../passwd"), ["../../passwd", "inside"]),
]


@pytest.mark.parametrize(
    ("damage", "words"), [case[1:] for case in REFUSED], ids=[case[0] for case in REFUSED]
)
def test_below_the_standards_minimum_or_unreadable_is_exit_2_in_one_line(
    one_axis: Path, tmp_path: Path, capsys: Capture, damage: Damage, words: list[str]
) -> None:
    damage(one_axis)
    assert main(["evaluate", str(one_axis), "--out", str(tmp_path / "out"), "--json"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("ahrs-lab: ")
    assert captured.err.count("\n") == 1
    for word in words:
        assert word in captured.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("result.json", b"", ["result.json", "not JSON"]),
        ("result.json", b"[1, 2]", ["result.json", "no JSON object"]),
        ("result.json", b'{"procedure": "x"}', ["result"]),
        ("result.json", b"[" * 100_000, ["result.json", "not JSON"]),
        ("result.json", b"\xff\xfe", ["result.json", "not JSON"]),
    ],
)
def test_what_is_no_result_is_named(
    tmp_path: Path, capsys: Capture, name: str, content: bytes, words: list[str]
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    job = resource_path("jobs/demo.toml")
    target = tmp_path / "certificate.pdf"
    assert main(["certificate", str(path), "--job", str(job), "--out", str(target)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    for word in words:
        assert word in captured.err
    assert not target.exists()


@pytest.mark.parametrize("content", [b"", b"no pdf", b"%PDF-1.7\n%%EOF\n"])
def test_verify_names_what_is_no_pdf(tmp_path: Path, capsys: Capture, content: bytes) -> None:
    path = tmp_path / "certificate.pdf"
    path.write_bytes(content)
    assert main(["verify", str(path)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert "certificate.pdf" in captured.err


def test_an_incomplete_recording_is_not_taken_into_the_records(one_axis: Path, capsys: Capture) -> None:
    (one_axis / "segments" / RATE).unlink()
    assert main(["import", str(one_axis), "--json"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert f"recording.toml lists segments/{RATE}, which is not there" in captured.err


def test_a_recording_is_taken_into_the_records_and_out_again(
    sample: Path, tmp_path: Path, capsys: Capture
) -> None:
    before = evaluated(capsys, str(sample))
    assert main(["import", str(sample), "--json"]) == 0
    number = json.loads(capsys.readouterr().out)["job"]
    target = tmp_path / "exported"
    assert main(["export", number, str(target), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == {"job": number, "bundle": str(target / f"{number}.ahrsrec")}
    assert evaluated(capsys, told["bundle"]) == before
    assert main(["export", number, str(target)]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "exists already" in captured.err
