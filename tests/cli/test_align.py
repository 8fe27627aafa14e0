"""``ahrs-lab align`` from outside."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.laboratory.analyses import analyses
from tests.analysis.unit_at_rest import ATTITUDE, bundle, samples

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return bundle(tmp_path_factory.mktemp("align") / "rest", samples())


def aligned(capsys: Capture, *words: str) -> dict[str, Any]:
    assert main(["align", *words, "--json"]) == 0
    said = capsys.readouterr()
    assert all(line.startswith("ahrs-lab: warning: ") for line in said.err.splitlines())
    found = json.loads(said.out)
    assert isinstance(found, dict)
    return found


@pytest.mark.parametrize("method", ["coarse", "fine", "kalman-open", "kalman-closed"])
def test_each_method_gives_the_attitude_as_one_object(capsys: Capture, recording: Path, method: str) -> None:
    found = aligned(capsys, str(recording), "--method", method)
    heading, pitch, roll = found["standard_uncertainty_deg"]
    for key, true, u in zip(
        ("heading_deg", "pitch_deg", "roll_deg"), ATTITUDE, (heading, pitch, roll), strict=True
    ):
        assert found[key] == pytest.approx(true, abs=3.0 * u)
    assert pitch == pytest.approx(roll, rel=0.05)
    assert heading > 10.0 * pitch
    assert len(found["gyro_bias_deg_per_h"]) == len(found["accel_bias_mps2"]) == 3


def test_assumptions_are_options(capsys: Capture, recording: Path) -> None:
    words = [str(recording), "--method", "fine", "--segment", "rest"]
    default = aligned(capsys, *words)["standard_uncertainty_deg"]
    better = aligned(capsys, *words, "--gyro-bias", "0.003", "--accel-bias", "1e-4")[
        "standard_uncertainty_deg"
    ]
    assert better[0] < 0.7 * default[0]
    assert better[1] == pytest.approx(0.1 * default[1], rel=0.1)


def test_out_leaves_result_and_series(capsys: Capture, recording: Path, tmp_path: Path) -> None:
    assert main(["align", str(recording), "--out", str(tmp_path / "out")]) == 0
    text = capsys.readouterr().out
    assert "Kalman filter, closed loop (chosen)" in text
    assert "gyro bias assumed" in text
    result = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    with (tmp_path / "out" / "series.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[-1]["heading_deg"]) == result["heading_deg"]
    assert float(rows[-1]["heading_uncertainty_deg"]) == result["standard_uncertainty_deg"][0]
    assert len(rows) > 50


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--segment", "other"], "no segment other"),
        (["--heading-limit", "0.01"], "(limit 0.01°)"),
        (["--method", "guess"], "invalid choice"),
        (["--gyro-bias", "-1"], "not a number 0 or more"),
        (["--accel-bias", "nan"], "not a number 0 or more"),
    ],
)
def test_a_wrong_call_says_what_and_exits_with_2(
    capsys: Capture, recording: Path, words: list[str], said: str
) -> None:
    try:
        code = main(["align", str(recording), *words])
    except SystemExit as exit_:
        code = int(str(exit_.code))
    assert code == 2
    error = capsys.readouterr().err
    assert said in error
    assert len(error.strip().splitlines()) == 1


def test_the_pole_exits_with_2(capsys: Capture, tmp_path: Path) -> None:
    pole = bundle(tmp_path / "pole", samples(latitude_deg=90.0), 90.0)
    assert main(["align", str(pole), "--json"]) == 2
    assert "does not find north" in capsys.readouterr().err


def test_the_analysis_page_offers_it_with_defaults_that_run(recording: Path) -> None:
    kind = next(kind for kind in analyses() if kind.key == "align")
    outcome = kind.run([recording], kind.defaults())
    assert outcome.report.charts
    assert outcome.data["heading_deg"] == pytest.approx(ATTITUDE[0], abs=1.0)


def test_a_unit_that_stands_otherwise_than_its_orientation_says_is_aligned_and_told(
    capsys: Capture, tmp_path: Path
) -> None:
    tilted = bundle(tmp_path / "tilted", samples(attitude=(120.0, 35.0, -50.0)))
    assert aligned(capsys, str(tilted), "--method", "fine")["pitch_deg"] == pytest.approx(35.0, abs=0.03)
    assert main(["align", str(tilted)]) == 0
    assert "away from the orientation ENU" in capsys.readouterr().out
