"""What saving an analysis leaves: result, series, report with charts, further files."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.analysis.report import Chart, Curve, Mark, Report, Table
from ahrs_lab.errors import MachineError
from ahrs_lab.laboratory.analyses.files import file_names, write_outcome
from ahrs_lab.laboratory.analyses.kinds import Outcome
from ahrs_lab.messages import Message
from tests.certificates.pdf_text import whole_text


def _save(path: Path) -> None:
    path.write_text("saved", encoding="utf-8")


def outcome(points: int = 50) -> Outcome:
    t_s = np.linspace(0.0, 10.0, points)
    chart = Chart(
        Message("operator"),
        Message("t, s"),
        Message("ω, °/h"),
        (Curve("φ_E", t_s, np.sin(t_s), axis="x"), Curve("a name with a missing letter ǂ", t_s, t_s)),
        (Mark(5.0, "half"), Mark(float("nan"), "nowhere")),
    )
    table = Table(Message("operator"), ("", "value"), (("x", "-1.5e-07"), (Message("operator"), "2")))
    return Outcome(
        {"value": 1.0},
        Report(Message("operator"), (table,), (chart,), (Message("a note: Ĉ = E1 ∘ Dᵀ"),), (Message("odd"),)),
        {"t_s": t_s, "omega": t_s**2},
        {"set.txt": _save},
    )


def test_all_files_are_there_and_are_those_announced(tmp_path: Path) -> None:
    files = write_outcome(outcome(), tmp_path / "out", [tmp_path / "unit-a"])
    assert sorted(path.name for path in files.values()) == sorted(file_names(outcome()))
    assert json.loads(files["result"].read_text(encoding="utf-8")) == {"value": 1.0}
    rows = list(csv.reader(files["series"].read_text(encoding="utf-8").splitlines()))
    assert rows[0] == ["t_s", "omega"]
    assert float(rows[-1][1]) == 100.0
    assert files["set.txt"].read_text(encoding="utf-8") == "saved"


def test_the_report_is_in_both_languages_with_its_numbers_set(tmp_path: Path) -> None:
    text = whole_text(write_outcome(outcome(), tmp_path, [tmp_path / "unit-a"])["plots"])
    for words in (
        "operator",
        "校准员",
        "−1.5×10",
        "unit-a",
        "half",
        "a note: C^ = E1 ○ D",
        "警告：odd",
        "missing letter ?",
    ):
        assert words in text
    assert "e-07" not in text
    assert "nowhere" not in text


def test_a_long_series_does_not_make_a_large_report(tmp_path: Path) -> None:
    few = write_outcome(outcome(), tmp_path / "few")["plots"].stat().st_size
    many = write_outcome(outcome(400_000), tmp_path / "many")["plots"].stat().st_size
    assert many < few + 80_000


def test_without_a_series_there_is_no_table_of_it(tmp_path: Path) -> None:
    bare = Outcome({}, Report(Message("operator")))
    assert file_names(bare) == ("result.json", "plots.pdf")
    assert set(write_outcome(bare, tmp_path)) == {"result", "plots"}


def test_a_folder_that_cannot_be_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(MachineError, match="choose another folder"):
        write_outcome(outcome(), tmp_path / "file" / "out")
