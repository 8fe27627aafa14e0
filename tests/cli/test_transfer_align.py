"""``ahrs-lab transfer-align`` as scripts call it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from ahrs_lab.cli import main
from ahrs_lab.cli.analysis.transfer_align import _NUMBERS
from ahrs_lab.laboratory.analyses.transfer_alignment import KIND
from tests.analysis.test_transfer_alignment import reference, unit


def test_json_has_the_keys_of_the_interface(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = [str(reference(tmp_path)), str(unit(tmp_path)), "--method", "velocity-attitude", "--json"]
    assert main(["transfer-align", *call, "--lever", "0", "0", "0", "--out", str(tmp_path / "out")]) == 0
    data = json.loads(capsys.readouterr().out)
    keys = (
        "misalignment_deg",
        "standard_uncertainty_deg",
        "gyro_bias_deg_per_h",
        "accel_bias_mps2",
        "mounting_deg",
    )
    for key in keys:
        assert len(data[key]) == 3
    assert isinstance(data["nis_mean"], float)
    assert json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8")) == data


def test_recordings_the_wrong_way_round_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["transfer-align", str(unit(tmp_path)), str(reference(tmp_path))]) == 2
    assert "needs the gyros" in capsys.readouterr().err


def test_options_are_the_settings_with_their_defaults() -> None:
    defaults = KIND.defaults()
    for key, text in _NUMBERS:
        assert f"({defaults[key]:g})" in text
