"""A run that begins again at a segment: both takes are kept, the later ones count."""

from pathlib import Path

import pytest

from ahrs_lab.cli import main
from ahrs_lab.recording.read import read_bundle
from tests.laboratory.short_run import SEGMENTS, write_bench, write_plan


def test_a_run_goes_again_from_a_segment_for_a_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, bench, out = write_plan(tmp_path), write_bench(tmp_path), tmp_path / "out"
    call = ["run", str(plan), "--bench", str(bench), "--out", str(out)]
    assert main(call) == 0
    assert main([*call, "--from", "zo_x_2"]) == 2
    assert "why zo_x_2 is repeated" in capsys.readouterr().err
    assert main([*call, "--from", "zo_x_9", "--reason", "draught"]) == 2
    assert main([*call, "--from", "zo_x_2", "--reason", "draught"]) == 0
    takes = [recorded.segment for recorded in read_bundle(out / "recording").segments]
    counting = {take.name for take in takes if not take.superseded}
    again = {take.name for take in takes if take.superseded}
    assert counting == SEGMENTS
    assert "zo_x_2" in again
    assert not again & {"sf_x_before", "ma_x_pos"}
    assert {take.reason for take in takes if take.superseded} == {"draught"}
