"""--strict: the exit code says whether the values lie within the limits of JOB.toml."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from ahrs_lab.cli import main
from ahrs_lab.metrology.result_json import to_json
from ahrs_lab.resource_files import resource_path
from tests.certificates.conftest import sample_result

Capture = pytest.CaptureFixture[str]
Call = Callable[..., tuple[int, str]]
LIMITS = 'low = -30.0\nhigh = 30.0\nunit = "deg/h"'


@pytest.fixture
def certify(tmp_path: Path, capsys: Capture) -> Call:
    """``certificate`` of the sample with limits on B; returns exit code and what was printed or said."""

    def call(*words: str, limits: str = LIMITS, rule: str = "guard-band") -> tuple[int, str]:
        result, job = tmp_path / "result.json", tmp_path / "job.toml"
        result.write_text(json.dumps(to_json(sample_result())), encoding="utf-8")
        text = resource_path("jobs/demo.toml").read_text(encoding="utf-8")
        assert LIMITS in text
        text = text.replace(LIMITS, limits).replace('kind = "guard-band"', f'kind = "{rule}"')
        job.write_text(text, encoding="utf-8")
        target = str(tmp_path / "certificate.pdf")
        code = main(["certificate", str(result), "--job", str(job), "--out", target, *words])
        captured = capsys.readouterr()
        return code, captured.out or captured.err

    return call


def test_within_the_limits_is_zero(certify: Call) -> None:
    code, text = certify("--strict")
    assert code == 0
    assert "Conformity by guard band w = U (ILAC-G8): pass" in text


@pytest.mark.parametrize(
    ("high", "rule", "code", "verdict"),
    [
        (11.2, "simple", 0, "pass"),
        (11.2, "guard-band", 1, "fail"),
        (11.2, "non-binary", 0, "conditional pass"),
        (11.0, "non-binary", 1, "conditional fail"),
        (5.0, "non-binary", 1, "fail"),
    ],
)
def test_out_of_specification_is_one(
    certify: Call, tmp_path: Path, high: float, rule: str, code: int, verdict: str
) -> None:
    limits = f'high = {high}\nunit = "deg/h"'
    assert certify("--strict", "--json", limits=limits, rule=rule)[0] == code
    assert (tmp_path / "certificate.pdf").read_bytes().startswith(b"%PDF")
    done, text = certify("--json", limits=limits, rule=rule)
    assert done == 0
    said = json.loads(text)["conformity"]
    assert said["statements"]["B_x"]["verdict"] == verdict
    assert said["within"] == (code == 0)
    assert said["statements"]["B_x"]["low"] is None


def test_a_limit_of_what_was_not_calibrated_is_not_met(certify: Call, tmp_path: Path) -> None:
    def without_misalignment(path: Path) -> None:
        data = json.loads(path.read_text(encoding="utf-8"))
        del data["misalignment"]
        path.write_text(json.dumps(data), encoding="utf-8")

    certify()
    without_misalignment(tmp_path / "result.json")
    words = ["certificate", str(tmp_path / "result.json"), "--job", str(tmp_path / "job.toml"), "--strict"]
    assert main([*words, "--out", str(tmp_path / "certificate.pdf")]) == 1


def test_limits_that_cannot_be_judged_are_the_call_s_fault(certify: Call, tmp_path: Path) -> None:
    code, text = certify(limits='low = -0.3\nhigh = 0.3\nunit = "deg/h"')
    assert code == 2
    assert "no value can pass" in text
    assert text.count("\n") == 1
    assert not (tmp_path / "certificate.pdf").exists()


def test_strict_without_limits_is_the_call_s_fault(tmp_path: Path, capsys: Capture) -> None:
    assert main(["evaluate", str(tmp_path), "--strict"]) == 2
    assert "--strict needs limits" in capsys.readouterr().err


def test_evaluate_judges_by_the_job(shared: Path, tmp_path: Path, capsys: Capture) -> None:
    sample = str(shared / "samples" / "mems-unit-a")
    text = resource_path("jobs/demo.toml").read_text(encoding="utf-8")
    job = tmp_path / "job.toml"
    job.write_text(text.replace("K = 1e-5", "K = 0.001"), encoding="utf-8")
    assert main(["evaluate", sample, "--job", str(job), "--json", "--strict"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["raised_to_capability"] == ["K_x", "K_y", "K_z"]
    k = said["conformity"]["statements"]["K_x"]
    assert k["expanded_uncertainty"] == pytest.approx(1002.335, abs=1e-3)
    assert said["scale_factor"]["x"]["expanded_uncertainty"] < 1e-3
    assert main(["evaluate", sample, "--job", str(job)]) == 0
    text = capsys.readouterr().out
    assert "U of K_x raised to the laboratory's best capability" in text
    assert "Conformity by guard band w = U (ILAC-G8): pass" in text
