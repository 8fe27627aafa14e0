"""``ahrs-lab installation`` as scripts call it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.recording.read import read_bundle
from tests.analysis.test_installation import angles_bundle

Capture = pytest.CaptureFixture[str]


def answer(capsys: Capture, *call: str) -> Any:
    assert main(["installation", *call, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_from_the_level_carrier_to_corrected_angles(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "set.json"
    known = ("--u-attitude", "0.01", "--u-level", "0.01", "--u-heading-error", "0.05")
    call = ("--pitch", "0.5", "--roll", "-0.25", "--heading-error", "1.5", *known, "--save", str(path))
    bracket = answer(capsys, "calibrate", *call)
    assert bracket["bracket_deg"] == pytest.approx({"heading": 1.5, "pitch": 0.5, "roll": -0.25})
    assert bracket["standard_uncertainty_deg"]["heading"] == pytest.approx(0.05, rel=1e-5)
    # the carrier level at heading 100°: the unit shows its bracket
    angles = ("--heading", "101.5", "--pitch", "0.5", "--roll", "-0.25")
    found = answer(capsys, "compensate", "--set", str(path), *angles)
    assert found["heading_deg"] == pytest.approx(100.0, abs=1e-12)
    assert found["pitch_deg"] == pytest.approx(0.0, abs=1e-12)
    assert found["roll_deg"] == pytest.approx(0.0, abs=1e-12)
    assert found["gimbal_lock"] is False
    assert found["standard_uncertainty_deg"]["heading"] == pytest.approx(0.05, rel=1e-3)


def test_json_before_the_action_counts_too(capsys: Capture) -> None:
    call = ("calibrate", "--pitch", "0", "--roll", "0", "--heading-error", "0")
    assert main(["installation", "--json", *call]) == 0
    assert json.loads(capsys.readouterr().out)["direction"] == "box-in-aircraft"


def test_both_directions_of_definition(capsys: Capture) -> None:
    angles = ("--heading", "0", "--pitch", "0", "--roll", "0", "--bracket-heading", "10")
    assert answer(capsys, "compensate", *angles)["heading_deg"] == pytest.approx(350.0)
    other = answer(capsys, "compensate", *angles, "--direction", "aircraft-in-box")
    assert other["heading_deg"] == pytest.approx(10.0)


def test_a_recording_in_a_corrected_recording_out(tmp_path: Path, capsys: Capture) -> None:
    source = angles_bundle(tmp_path / "in", [[350.0, 0.0, 0.0]] * 20)
    out = tmp_path / "out"
    data = answer(capsys, "compensate", str(source), "--bracket-heading", "10", "--out", str(out))
    assert data["rows"] == 20
    assert data["first"]["heading_deg"] == pytest.approx(340.0)
    assert read_bundle(out).segments[0].samples["heading_deg"][0] == pytest.approx(340.0)
    assert main(["installation", "compensate", str(source), "--bracket-heading", "1", "--out", str(out)]) == 2
    assert "is not empty" in capsys.readouterr().err
    packed = tmp_path / "out.ahrsrec"
    answer(capsys, "compensate", str(source), "--bracket-heading", "10", "--out", str(packed))
    assert read_bundle(packed).segments[0].samples["heading_deg"][0] == pytest.approx(340.0)
    level = answer(capsys, "calibrate", str(source), "--heading-error", "10")
    assert level["bracket_deg"]["heading"] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (["calibrate", "--heading-error", "1"], "--pitch and --roll"),
        (["calibrate", "x", "--pitch", "1", "--heading-error", "1"], "not both"),
        (
            ["calibrate", "--pitch", "0", "--roll", "0", "--heading-error", "1", "--u-level", "-1"],
            "0 or more",
        ),
        (["compensate", "--bracket-pitch", "1"], "--heading, --pitch and --roll"),
        (["compensate", "--heading", "1", "--pitch", "1", "--roll", "1"], "--set SET.json"),
        (["compensate", "--set", "nowhere.json", "--bracket-pitch", "1"], "not both"),
        (["compensate", "--set", "nowhere.json"], "cannot be read"),
        (
            ["compensate", "--bracket-pitch", "1", "--heading", "1", "--pitch", "-91", "--roll", "1"],
            "pitch is",
        ),
        (
            ["compensate", "--bracket-pitch", "95", "--heading", "1", "--pitch", "1", "--roll", "1"],
            "bracket's",
        ),
        (
            [
                "compensate",
                "--bracket-pitch",
                "1",
                "--heading",
                "1",
                "--pitch",
                "1",
                "--roll",
                "1",
                "--out",
                "x",
            ],
            "--out belongs",
        ),
    ],
)
def test_calls_that_cannot_be_are_told(call: list[str], what: str, capsys: Capture) -> None:
    assert main(["installation", *call]) == 2
    error = capsys.readouterr().err
    assert what in error
    assert error.count("\n") == 1
