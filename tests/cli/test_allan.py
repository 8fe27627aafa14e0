"""``ahrs-lab allan`` from outside."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.cli import main
from tests.analysis.recorded import columns, write_bundle

Capture = pytest.CaptureFixture[str]
KEYS = {
    "tau_s",
    "oadev",
    "oadev_low",
    "oadev_high",
    "angle_random_walk_deg_per_sqrt_h",
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "quantisation_arcsec",
}


@pytest.fixture(scope="module")
def sample(shared: Path) -> Path:
    return shared / "samples" / "mems-unit-a"


def test_the_sample_gives_its_angle_random_walk_back(sample: Path, capsys: Capture) -> None:
    """0.15 °/√h, simulated outside this project, with 600 s at each position."""
    assert main(["allan", str(sample), "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    data = json.loads(captured.out)
    assert {"gyro_x", "gyro_y", "gyro_z"} <= set(data)
    for name in ("gyro_x", "gyro_y", "gyro_z"):
        assert set(data[name]) >= KEYS
        assert data[name]["angle_random_walk_deg_per_sqrt_h"] == pytest.approx(0.15, rel=0.04)


def test_segment_and_averaging_times_are_taken(sample: Path, tmp_path: Path, capsys: Capture) -> None:
    words = ["allan", str(sample), "--segment", "segments/zo_x_2.csv", "--taus", "1,10,100", "--json"]
    assert main([*words, "--out", str(tmp_path / "out")]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["gyro_x"]["segment"] == "segments/zo_x_2.csv"
    np.testing.assert_allclose(data["gyro_x"]["tau_s"], [1.0, 10.0, 100.0], rtol=1e-6)
    assert json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8")) == data
    with (tmp_path / "out" / "series.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["oadev"]) for row in rows if row["channel"] == "gyro_x"] == data["gyro_x"]["oadev"]


def test_the_text_names_the_segment(sample: Path, capsys: Capture) -> None:
    assert main(["allan", str(sample)]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Allan deviation of segments/zo_x_1.csv")
    assert "angle random walk N, °/√h" in text


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--taus", "1,ten"], "no list of averaging times"),
        (["--taus", "0"], "above 0"),
        (["--segment", "segments/none.csv"], "no segment segments/none.csv"),
    ],
)
def test_a_wrong_call_is_one_line_and_exit_2(
    sample: Path, capsys: Capture, words: list[str], says: str
) -> None:
    assert main(["allan", str(sample), *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert says in captured.err
    assert captured.err.count("\n") == 1


def test_nan_and_unordered_rows_are_told_and_left_out(tmp_path: Path, capsys: Capture) -> None:
    rng = np.random.default_rng(1)
    t_s, gyro = np.arange(1, 2001) / 10.0, rng.normal(size=(2000, 3))
    gyro[100, 1] = np.nan
    t_s[[500, 501]] = t_s[[501, 500]]
    static = 'orientation = "ENU"\nitem = "static"'
    bundle = write_bundle(tmp_path, {"a.csv": (columns(t_s, gyro), static)})
    assert main(["allan", str(bundle), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)["gyro_x"]
    assert data["missing"] == 2
    assert any("NaN" in warning or "nan" in warning for warning in data["warnings"])
    assert any("backward" in warning for warning in data["warnings"])
    assert np.all(np.isfinite(data["oadev"]))
