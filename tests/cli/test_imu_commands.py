"""``imu-calibrate`` and ``compensate`` from outside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.cli import main
from ahrs_lab.laboratory.analyses import analyses
from ahrs_lab.laboratory.analyses.files import write_outcome
from ahrs_lab.recording.read import read_bundle
from tests.analysis.imu_bundle import Recorder, unit

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def recorder() -> Recorder:
    return Recorder(unit(12, 1000.0, 2000.0), "LSB", "LSB", gyro_density=1e-3, accel_density=1e-4)


@pytest.fixture
def bundle(tmp_path: Path, recorder: Recorder) -> Path:
    return recorder.write(tmp_path / "calibration", recorder.everything("12"))


def answer(capsys: Capture, *words: object) -> dict[str, Any]:
    capsys.readouterr()
    assert main([*map(str, words), "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    data: dict[str, Any] = json.loads(captured.out)
    return data


def test_from_the_calibration_to_the_compensated_recording(
    tmp_path: Path, bundle: Path, recorder: Recorder, capsys: Capture
) -> None:
    data = answer(capsys, "imu-calibrate", bundle, "--save", tmp_path / "set.json")
    assert {"gyro", "accel", "standard_uncertainty", "condition_number"} <= set(data)
    assert data == json.loads((tmp_path / "set.json").read_text(encoding="utf-8"))
    true = recorder.unit
    for part, key, truth in (
        ("gyro", "E1", true.gyro.E1),
        ("gyro", "Bf", true.gyro.Bf),
        ("accel", "K", true.accel.K),
    ):
        error = np.abs(np.array(data[part][key]) - truth)
        assert np.all(error <= 4.0 * np.array(data["standard_uncertainty"][part][key]))
    other = recorder.write(tmp_path / "other", recorder.everything("6")[6:], "static")
    said = answer(capsys, "compensate", other, "--set", tmp_path / "set.json", "--out", tmp_path / "out")
    assert said["rate_unit"] == "deg/s"
    assert len(said["static"]) == 6
    back = read_bundle(tmp_path / "out")
    assert back.header.notes["compensation"]["set_sha256"] == said["set_sha256"]
    assert np.abs(said["static"][0]["rate_residual_after_dps"]).max() < 2e-3


def test_people_read_tables_and_the_formula(tmp_path: Path, bundle: Path, capsys: Capture) -> None:
    assert (
        main(["imu-calibrate", str(bundle), "--save", str(tmp_path / "set.h"), "--out", str(tmp_path / "o")])
        == 0
    )
    text = capsys.readouterr().out
    assert "u (bench)" in text
    assert "compensated f = (I + K)⁻¹" in text
    assert "set.h" in text
    assert {p.name for p in (tmp_path / "o").iterdir()} == {
        "result.json",
        "plots.pdf",
        "calibration-set.json",
        "calibration-set.csv",
        "calibration_set.h",
    }


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["imu-calibrate", "{none}"], "none"),
        (["imu-calibrate", "{bundle}", "--save", "{none}.txt"], ".json, .csv or .h"),
        (["imu-calibrate", "{bundle}", "--gravity", "1"], "9.7 to 9.9"),
        (["compensate", "{bundle}", "--set", "{none}", "--out", "{none}"], "cannot be read"),
    ],
)
def test_a_wrong_call_is_told_in_one_line(
    tmp_path: Path, bundle: Path, capsys: Capture, words: list[str], named: str
) -> None:
    filled = [word.format(none=tmp_path / "none", bundle=bundle) for word in words]
    assert main(filled) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert named in captured.err
    assert len(captured.err.strip().splitlines()) == 1


def test_the_analysis_page_can_run_and_save_both(tmp_path: Path, bundle: Path, recorder: Recorder) -> None:
    kinds = {kind.key: kind for kind in analyses()}
    calibrate, compensate = kinds["imu-calibrate"], kinds["compensate"]
    made = calibrate.run([bundle], calibrate.defaults())
    files = write_outcome(made, tmp_path / "saved")
    other = recorder.write(tmp_path / "other", recorder.everything("6")[6:], "static")
    done = compensate.run([other], {"set": str(files["calibration-set.json"])})
    files = write_outcome(done, tmp_path / "done")
    assert len(read_bundle(files["compensated"]).segments) == 6
    assert [chart.title.text() for chart in done.report.charts] == [
        "Rate beyond the Earth's",
        "Force beyond gravity",
    ]
