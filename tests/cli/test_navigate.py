"""``navigate`` and ``error-propagation`` as a script calls them."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from pyarrow import parquet

from ahrs_lab.cli import main
from ahrs_lab.simulation.manoeuvres import Accelerate, Steady
from ahrs_lab.simulation.trajectory import Start, fly
from ahrs_lab.simulation.trajectory_recording import write_flight

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    flight = fly(Start(heading_deg=30.0), (Steady(2.0), Accelerate(5.0, 10.0)), 20.0)
    return write_flight(tmp_path / "bundle", flight, reference=True)


def test_navigate_prints_one_object(bundle: Path, capsys: Capture) -> None:
    assert main(["navigate", str(bundle), "--json"]) == 0
    captured = capsys.readouterr()
    final = json.loads(captured.out)["final"]
    assert captured.err == ""
    assert final["heading_deg"] == pytest.approx(30.0, abs=1e-6)
    assert final["velocity_enu_mps"][2] == pytest.approx(0.0, abs=1e-6)
    assert final["t_s"] == 7.0


def test_what_stands_against_the_numbers_is_said_beside_the_object(bundle: Path, capsys: Capture) -> None:
    segment = next((bundle / "segments").iterdir())
    table = parquet.read_table(segment)
    times = table["t_s"].to_numpy()
    parquet.write_table(table.filter((times < 3.0) | (times > 3.4)), segment)
    assert main(["navigate", str(bundle), "--json"]) == 0
    captured = capsys.readouterr()
    assert list(json.loads(captured.out)) == ["final"]
    assert "warning: 1 gaps" in captured.err


def test_navigate_leaves_the_series(bundle: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "out"
    assert main(["navigate", str(bundle), "--altitude-damping", "baro", "--out", str(out)]) == 0
    assert "Height loop" in capsys.readouterr().out
    with (out / "series.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 140
    assert float(rows[-1]["vn_mps"]) == pytest.approx(8.66, abs=0.01)
    assert abs(float(rows[-1]["error_north_m"])) < 0.01
    assert json.loads((out / "result.json").read_text(encoding="utf-8"))["final"]["t_s"] == 7.0


def test_navigate_without_initial_state_is_two(tmp_path: Path, capsys: Capture) -> None:
    flight = fly(Start(), (Steady(2.0),), 20.0)
    folder = write_flight(tmp_path / "bundle", flight, initial=False)
    assert main(["navigate", str(folder), "--json"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "[initial]" in captured.err
    assert main(["navigate", str(tmp_path / "nowhere")]) == 2


def test_error_propagation_prints_one_object(capsys: Capture) -> None:
    words = ["error-propagation", "gyro_north", "0.01", "--latitude", "45", "--hours", "24"]
    assert main([*words, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["period_h"]["earth"] == pytest.approx(23.9345, abs=1e-3)
    assert main(words) == 0
    assert "Eigenfrequencies" in capsys.readouterr().out


def test_error_propagation_at_the_pole_is_two(capsys: Capture) -> None:
    assert main(["error-propagation", "gyro_north", "0.01", "--latitude", "90"]) == 2
    assert "90" in capsys.readouterr().err
