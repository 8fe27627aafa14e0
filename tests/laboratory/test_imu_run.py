"""The discrete IMU calibration from the plan to its result and sheet, on the virtual bench."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.analysis.imu_calibration import calibrate_recording
from ahrs_lab.cli import main
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory.benches import load_bench
from ahrs_lab.laboratory.evaluation import evaluate_bundle, read_result
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.procedures import course
from ahrs_lab.procedures.events import Event, MountRequested, SegmentFinished
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.resource_files import resource_path
from tests.laboratory.imu_run import BENCH, PLAN, TRUTH, write
from tests.laboratory.short_run import assert_safe, counted, only_json

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a whole run."""
    folder = tmp_path_factory.mktemp("imu")
    assert main(write(folder)) == 0
    return folder / "out"


def result_of(folder: Path) -> ImuResult:
    result = read_result(folder / "result.json")
    assert isinstance(result, ImuResult)
    return result


def test_all_33_entered_coefficients_are_found_within_their_uncertainties(measured: Path) -> None:
    result = result_of(measured)
    combined = result.combined
    assert combined is not None
    for found, true, u in zip(
        result.calibration.coefficients.vectors(), TRUTH.vectors(), combined.vectors(), strict=True
    ):
        assert np.all(u > 0.0)
        assert np.all(np.abs(found - true) < 3.0 * u)
    gyro, accel = combined.vectors()
    assert np.all(gyro[:, 0] < 1e-4), "an uncertainty so wide would make the comparison empty"
    assert np.all(accel[:, 1] < 1e-2)


def test_the_result_is_what_imu_calibrate_makes_of_the_recording(measured: Path) -> None:
    data = json.loads((measured / "result.json").read_text(encoding="utf-8"))
    again = calibrate_recording(read_bundle(measured / "recording")).to_json()
    for key in ("gyro", "accel", "standard_uncertainty", "condition_number"):
        assert data[key] == again[key]
    assert data["procedure"] == "imu-discrete"
    assert data["condition_number"]["accel"] == pytest.approx(3.0**0.5)
    assert data["simulated"] is True
    assert len(data["dwells"]) == 12
    assert [turns["turns"] for turns in data["turns"]] == [2, -2] * 3


def test_evaluate_says_the_same_as_the_run(measured: Path, capsys: Capture) -> None:
    capsys.readouterr()
    assert main(["evaluate", str(measured / "recording"), "--json"]) == 0
    assert only_json(capsys.readouterr().out) == json.loads(
        (measured / "result.json").read_text(encoding="utf-8")
    )


def test_the_result_survives_its_file(measured: Path) -> None:
    evaluated = evaluate_bundle(measured / "recording")
    assert to_json(evaluated) == to_json(result_of(measured))


def test_the_summary_names_each_coefficient(measured: Path, capsys: Capture) -> None:
    assert main(["evaluate", str(measured / "recording")]) == 0
    said = capsys.readouterr().out
    for name in ("E1 x", "B0 y", "Bf zx", "E yz", "K1 z", "K0 x", "K zy"):
        assert name in said


def test_certificate_gives_the_sheet(measured: Path, tmp_path: Path, capsys: Capture) -> None:
    from tests.certificates.pdf_text import whole_text

    sheet = tmp_path / "sheet.pdf"
    call = ["certificate", str(measured / "result.json"), "--job", str(resource_path("jobs/demo.toml"))]
    assert main([*call, "--out", str(sheet)]) == 0
    text = whole_text(sheet)
    assert "惯性测量组合校准证书" in text
    assert "12 positions of 20 s each" in text
    assert main([*call, "--out", str(sheet), "--strict"]) == 2
    assert "have no limits" in capsys.readouterr().err


def test_a_run_that_broke_off_goes_on_where_it_stopped(tmp_path: Path, benches: list[Bench]) -> None:
    write(tmp_path)
    plan = load_plan(tmp_path / "plan.toml")
    finished: list[str] = []
    mounted: list[str] = []

    class StopError(Exception):
        """The program dies."""

    def until_seven(event: Event) -> None:
        if isinstance(event, SegmentFinished):
            finished.append(event.segment.name)
            if len(finished) == 7:
                raise StopError

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished):
            finished.append(event.segment.name)
        if isinstance(event, MountRequested):
            mounted.append(event.orientation.face)

    bench = load_bench(tmp_path / "bench.toml")
    with pytest.raises(Exception, match="not yours"):
        run_plan(plan, bench, tmp_path / "out", on_event=until_seven)
    assert_safe(bench)
    outcome = run_plan(plan, load_bench(tmp_path / "bench.toml"), tmp_path / "out", on_event=hear)
    assert tuple(finished) == course.segment_names(plan), "nothing is recorded twice, nothing left out"
    assert mounted == ["y+", "z+", "x-", "z-", "y-"]
    assert isinstance(outcome.result, ImuResult)
    assert any("over 2 power-ons" in warning.what.text() for warning in outcome.result.warnings)
    assert counted(tmp_path / "out" / "recording") == set(course.segment_names(plan))


def test_what_the_plan_has_and_the_recording_lacks_is_named(measured: Path, tmp_path: Path) -> None:
    bundle = tmp_path / "recording"
    shutil.copytree(measured / "recording", bundle)
    toml = (bundle / "recording.toml").read_text(encoding="utf-8")
    head, *tables = toml.split("[[segment]]")
    left = [head, *(table for table in tables if "segments/pos_07." not in table)]
    (bundle / "recording.toml").write_text("[[segment]]".join(left), encoding="utf-8")
    result = evaluate_bundle(bundle)
    assert isinstance(result, ImuResult)
    assert len(result.dwells) == 11
    said = [warning.what.text() for warning in result.warnings]
    assert "1 of the plan's 18 segments are missing or cannot be used: pos_07." in said


def test_a_wrong_mounting_is_refused_before_it_is_recorded(tmp_path: Path, capsys: Capture) -> None:
    fault = '\n[[fault]]\nname = "wrong_mounting"\norientation = "ENU"\n'
    assert main(write(tmp_path, bench=BENCH + fault)) == 3
    said = capsys.readouterr().err
    assert "mounted 3 times and still does not stand as asked" in said
    assert "Asked: X up" in said
    assert not list((tmp_path / "out" / "recording" / "segments").glob("*"))


@pytest.mark.parametrize(
    ("plan", "bench", "said"),
    [
        (PLAN, BENCH.replace("[table]", "[table]\nmax_rate_dps = 60.0"), "may turn at 60 °/s at most"),
        (
            PLAN.replace('"12"', '"own"\npositions = ["UEN", "UNW", "UWS", "USE"]'),
            BENCH,
            "have rank 1 of 4",
        ),
        (PLAN.replace("[imu]", "[misalignment]\n[imu]"), BENCH, "misalignment means nothing"),
    ],
)
def test_what_cannot_be_run_is_refused_before_anything_moves(
    tmp_path: Path, capsys: Capture, plan: str, bench: str, said: str
) -> None:
    assert main(write(tmp_path, plan=plan, bench=bench)) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert said in lines[-1]
    assert not (tmp_path / "out").exists()


def test_a_unit_without_accelerometers_is_refused_at_the_first_mounting(
    tmp_path: Path, capsys: Capture
) -> None:
    bench = BENCH + '\n[device]\noutputs = ["rate"]\n'
    assert main(write(tmp_path, bench=bench)) == 2
    assert "The device gives no accelerations" in capsys.readouterr().err


def test_a_table_that_is_set_by_hand_will_do(tmp_path: Path) -> None:
    plan = re.sub("dwell_s = 20.0", "dwell_s = 10.0", PLAN).replace('"12"', '"6"')
    assert main(write(tmp_path, plan=plan, bench=BENCH + "sets_table = true\n")) == 0
    result = result_of(tmp_path / "out")
    scale = result.calibration.gyro.E1
    assert np.allclose(scale, TRUTH.gyro.E1, rtol=0.0, atol=1e-4)


def test_a_position_between_quarter_turns_counts_as_it_stood(tmp_path: Path) -> None:
    """The Earth turns 11.5 °/h about north: by the letters alone the biases would be degrees per hour off."""
    own = '["UEN@30", "DES@30", "NUE@100", "NDW@-100", "ENU", "NED", "UWS@30", "DWN@30"]'
    quiet = re.sub(
        r"(angle_random_walk_deg_per_sqrt_h|velocity_random_walk_mps_per_sqrt_s) = .*", r"\1 = 1e-5", BENCH
    )
    plan = PLAN.replace('"12"', f'"own"\npositions = {own}')
    assert main(write(tmp_path, plan=plan, bench=quiet)) == 0
    result: Any = result_of(tmp_path / "out")
    assert [d.beyond_deg for d in result.dwells if d.beyond_deg] != []
    off_dph = 3600.0 * np.abs(result.calibration.gyro.B0 - TRUTH.gyro.B0)
    assert np.all(off_dph < 0.05)
