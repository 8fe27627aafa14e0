"""The main job from plan to verified certificate, the way the README's first command does it."""

import json
import shutil
import subprocess
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from ahrs_lab.cli import main
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.resource_files import resource_path


@pytest.fixture(scope="module")
def demonstration(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """An accelerated demonstration: where it left its files, and its laboratory."""
    out = tmp_path_factory.mktemp("demo") / "demo-output"
    home = tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AHRS_LAB_HOME", str(home))
        plan = resource_path("plans/accelerated.toml")
        assert main(["demo", "--headless", "--speed", "max", "--plan", str(plan), "--out", str(out)]) == 0
    return out, home


@pytest.fixture
def out(demonstration: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("AHRS_LAB_HOME", str(demonstration[1]))
    return demonstration[0]


def test_everything_is_left_where_it_is_said(out: Path) -> None:
    for name in (
        "recording/recording.toml",
        "result.json",
        "budget.csv",
        "plots.pdf",
        "original-record.pdf",
        "certificate.pdf",
    ):
        assert (out / name).is_file(), name


def test_the_certificate_verifies_with_three_signatures(
    out: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(out / "certificate.pdf"), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert len(report["signatures"]) == 3


def test_nobody_signs_before_the_calibration_has_ended(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    notes = json.loads((out / "result.json").read_text(encoding="utf-8"))["notes"]
    started, finished = (datetime.fromisoformat(notes[key]) for key in ("started_utc", "finished_utc"))
    assert finished - started > timedelta(minutes=30)
    assert main(["verify", str(out / "certificate.pdf"), "--json"]) == 0
    for signature in json.loads(capsys.readouterr().out)["signatures"]:
        assert finished <= datetime.fromisoformat(signature["signed_at"])


def test_the_result_says_when_each_of_its_segments_began(out: Path) -> None:
    result = json.loads((out / "result.json").read_text(encoding="utf-8"))
    starts = {one["segment"]: one["started_utc"] for one in result["notes"]["segment_starts"]}
    assert list(starts) == result["notes"]["order_run"]
    assert list(starts.values()) == sorted(starts.values())
    for quantity in ("scale_factor", "zero_offset", "misalignment"):
        assert all(starts[name] for found in result[quantity].values() for name in found["segments"])


def test_a_changed_byte_is_found(out: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = bytearray((out / "certificate.pdf").read_bytes())
    data[len(data) // 4] ^= 1
    changed = tmp_path / "changed.pdf"
    changed.write_bytes(bytes(data))
    assert main(["verify", str(changed)]) == 1
    assert capsys.readouterr().out


def test_another_laboratory_does_not_trust_it(
    out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AHRS_LAB_HOME", str(tmp_path))
    assert main(["verify", str(out / "certificate.pdf")]) == 1


def test_the_recording_evaluates_to_the_same_result(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evaluate", str(out / "recording"), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    first = json.loads((out / "result.json").read_text(encoding="utf-8"))
    for item in ("scale_factor", "zero_offset", "misalignment"):
        for key, found in again[item].items():
            symbol = {"scale_factor": "K", "zero_offset": "B", "misalignment": "L"}[item]
            assert found[symbol] == first[item][key][symbol]
    assert again["bundle_sha256"] == first["bundle_sha256"]


def test_the_certificate_can_be_laid_out_from_the_files(out: Path, tmp_path: Path) -> None:
    target = tmp_path / "certificate.pdf"
    job = resource_path("jobs/demo.toml")
    assert main(["certificate", str(out / "result.json"), "--job", str(job), "--out", str(target)]) == 0
    assert target.read_bytes().startswith(b"%PDF")


def test_a_simulated_bench_is_said_on_every_page(out: Path) -> None:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext (poppler-utils) is not installed")
    done = subprocess.run(
        ["pdftotext", "-layout", str(out / "certificate.pdf"), "-"],
        capture_output=True,
        text=True,
        check=True,
    )
    pages = done.stdout.rstrip("\f").split("\f")
    assert len(pages) >= 2
    assert all("演示" in page for page in pages)


def test_a_second_demonstration_keeps_the_first(out: Path) -> None:
    first = (out / "result.json").read_bytes()
    plan = resource_path("plans/accelerated.toml")
    assert main(["demo", "--headless", "--speed", "max", "--plan", str(plan), "--out", str(out)]) == 0
    assert (out / "earlier-1" / "result.json").read_bytes() == first
    assert (out / "certificate.pdf").is_file()


def test_a_folder_with_something_else_is_left_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "thesis.tex").write_text("years of work", encoding="utf-8")
    assert main(["demo", "--headless", "--out", str(tmp_path)]) == 2
    assert "thesis" not in capsys.readouterr().out
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_the_job_can_be_exported_and_taken_in_elsewhere(
    out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from ahrs_lab.laboratory.laboratory import Laboratory

    with Laboratory() as laboratory:
        number = laboratory.jobs()[0].number
    assert main(["export", number, str(tmp_path / "exported")]) == 0
    monkeypatch.setenv("AHRS_LAB_HOME", str(tmp_path / "elsewhere"))
    capsys.readouterr()
    assert main(["import", str(tmp_path / "exported" / f"{number}.ahrsrec"), "--json"]) == 0
    taken = json.loads(capsys.readouterr().out)["job"]
    with Laboratory() as laboratory:
        result = laboratory.result(taken)
        assert laboratory.job(taken).state == "measured"
    first = json.loads((out / "result.json").read_text(encoding="utf-8"))
    assert isinstance(result, CalibrationResult)
    assert first["scale_factor"]["x"]["K"] == result.scale_factor["x"].K
