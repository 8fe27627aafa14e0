"""The IMU's result sheet says the matrices as they are, and is signed like any certificate."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.certificates.authority import Authority
from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.layout import Role
from ahrs_lab.certificates.original_record import original_record_pdf
from ahrs_lab.certificates.richtext import number_of
from ahrs_lab.certificates.signing import sign_certificate
from ahrs_lab.certificates.verify import verify_pdf
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.capability import capability_of
from ahrs_lab.metrology.figures_json import with_capability
from ahrs_lab.metrology.imu_calibration import Coefficients
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.stated_figures import StatedFigure
from tests.certificates.imu_sample import COEFFICIENTS, sample_imu_result
from tests.certificates.pdf_text import lines, spans, whole_text
from tests.certificates.test_layout import outside, overlapping

LANGUAGES: tuple[CertificateLanguage, ...] = ("bilingual", "zh", "en")


@pytest.fixture
def result() -> ImuResult:
    return sample_imu_result()


def rows_below(printed: list[str], title: str, count: int = 3) -> list[str]:
    """The rows of the table under the heading that begins like this."""
    start = next(i for i, line in enumerate(printed) if title in line)
    rows = [line for line in printed[start + 1 :] if re.match(r"[XYZ] [−\d]", line)]
    return rows[:count]


def numbers(row: str) -> list[float]:
    return [number_of(part) for part in re.split(r" ± | (?=[−\d])", row[2:])]


@pytest.mark.parametrize("language", LANGUAGES)
def test_nothing_is_clipped_and_nothing_overlaps(
    tmp_path: Path, result: ImuResult, job: JobSheet, language: CertificateLanguage
) -> None:
    found = spans(certificate_pdf(result, job, tmp_path / "s.pdf", language))
    assert not list(outside(found))
    assert not list(overlapping(found))


@pytest.mark.parametrize("language", ["bilingual", "zh"])
def test_nothing_of_the_record_is_clipped_and_nothing_overlaps(
    tmp_path: Path, result: ImuResult, job: JobSheet, language: CertificateLanguage
) -> None:
    found = spans(original_record_pdf(result, tmp_path / "r.pdf", job, language))
    assert not list(outside(found))
    assert not list(overlapping(found))


def test_scale_factors_and_offsets_stand_with_twice_the_combined_uncertainty(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    printed = lines(certificate_pdf(result, job, tmp_path / "s.pdf", "en"))
    assert rows_below(printed, "1  Gyros") == [
        "X 1.002 34 0.000 10 0.0031 0.0010",
        "Y 0.998 13 0.000 10 −0.0024 0.0010",
        "Z 1.000 74 0.000 10 0.0018 0.0010",
    ]
    assert rows_below(printed, "2  Accelerometers") == [
        "X 1.001 12 0.000 10 0.0197 0.0010",
        "Y 0.998 71 0.000 10 −0.0103 0.0010",
        "Z 1.000 53 0.000 10 0.0301 0.0010",
    ]


@pytest.mark.parametrize(
    ("title", "matrix", "expanded"),
    [
        ("Specific-force coefficients", COEFFICIENTS.gyro.Bf, 10.0),
        ("Misalignment E", COEFFICIENTS.gyro.E, 10.0),
        ("Misalignment K", COEFFICIENTS.accel.K, 100.0),
    ],
)
def test_rows_of_a_matrix_are_output_channels_and_columns_input_axes(
    tmp_path: Path,
    result: ImuResult,
    job: JobSheet,
    title: str,
    matrix: np.ndarray[tuple[int, int], np.dtype[np.float64]],
    expanded: float,
) -> None:
    printed = lines(certificate_pdf(result, job, tmp_path / "s.pdf", "en"))
    for i, row in enumerate(rows_below(printed, title)):
        wanted: list[float] = []
        for j in range(3):
            diagonal = i == j and "Misalignment" in title
            wanted += [0.0] if diagonal else [1e6 * matrix[i, j], expanded]
        assert numbers(row) == pytest.approx(wanted, abs=0.051 * expanded)


def test_the_sheet_says_formula_direction_conditions_and_what_was_done(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    text = whole_text(certificate_pdf(result, job, tmp_path / "s.pdf", "en"))
    for said in (
        "IMU CALIBRATION CERTIFICATE",
        "Discrete calibration of an inertial measurement unit: rates by whole turns, 12 positions at rest",
        "To compensate: first f = (I + K)",
        "positions [1, f/g]: 1.73; turns: 1.00",
        "12 positions of 300 s each",
        "about X, Y, Z: ±10 turns each, 100 °/s",
        "local gravity (9.80146 m/s2)",
        "latitude 39.9042°",
        "north 30″ *, level of the seat 10″ *, sampling time (relative) 5.0 × 10−7 *",
        "the errors of the bench are assumed figures",
        "The dwell is shorter",
        "pos_03: The unit was warm",
        "T-0007",
    ):
        assert said in text, said


def test_the_chinese_sheet_uses_the_terms_of_the_standard(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    text = whole_text(certificate_pdf(result, job, tmp_path / "s.pdf", "zh"))
    for term in (
        "惯性测量组合校准证书",
        "标度因数 E1",
        "零偏（常值漂移）B0",
        "视加速度影响系数",
        "失准角 E",
        "陀螺",
        "加速度计",
        "扩展不确定度",
    ):
        assert term in text, term


def test_residuals_stand_beside_the_position_they_are_of(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    printed = lines(certificate_pdf(result, job, tmp_path / "s.pdf", "en"))
    row = next(line for line in printed if line.startswith("3 up west south"))
    quality = result.calibration.quality
    assert quality is not None
    wanted = [*(quality.gyro_residuals[2] * 3600.0), *(quality.accel_residuals[2] * 1e3)]
    assert [number_of(part) for part in row.split()[4:]] == pytest.approx(wanted, abs=0.0051)


def test_three_people_sign_the_sheet(tmp_path: Path, result: ImuResult, job: JobSheet) -> None:
    authority = Authority(tmp_path / "authority")
    sheet = certificate_pdf(result, job, tmp_path / "s.pdf")
    roles: tuple[Role, ...] = ("operator", "verifier", "approver")
    for role in roles:
        authority.issue(role, f"Demo {role}", "a password of theirs")
        sign_certificate(sheet, role, authority.unlock(role, "a password of theirs"), getattr(job, role))
    report = verify_pdf(sheet, authority.trust_roots)
    assert report.valid
    assert [one.role for one in report.signatures] == list(roles)


def test_the_same_result_gives_the_same_bytes(tmp_path: Path, result: ImuResult, job: JobSheet) -> None:
    first, second = (certificate_pdf(result, job, tmp_path / name) for name in ("a.pdf", "b.pdf"))
    assert first.read_bytes() == second.read_bytes()


def test_a_unit_that_counts_has_its_scale_in_counts(tmp_path: Path, result: ImuResult, job: JobSheet) -> None:
    counts = replace(result, calibration=replace(result.calibration, rate_unit="LSB", accel_unit="LSB"))
    text = whole_text(certificate_pdf(counts, job, tmp_path / "s.pdf", "en"))
    assert "LSB/(°/s)" in text
    assert "LSB/(m/s2)" in text


def test_without_the_benchs_share_the_sheet_says_what_u_leaves_out(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    quality = result.calibration.quality
    assert quality is not None
    alone = replace(result, calibration=replace(result.calibration, quality=replace(quality, bench=None)))
    printed = lines(certificate_pdf(alone, job, tmp_path / "s.pdf", "en"))
    assert "not of the bench's errors" in " ".join(printed)
    assert rows_below(printed, "1  Gyros")[0] == "X 1.002 335 0.000 060 0.003 09 0.000 60"


def test_traceability_is_said_as_far_as_certificates_state_the_bench(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    stated = replace(job.standards[0], figures=(StatedFigure("level_arcsec", 20.0, "arcsec", 2.0),))
    standards = (stated, *job.standards[1:])
    capability = capability_of(standards, job.calibrated)
    of_job = replace(job, standards=standards, capability=capability)
    known = replace(result, notes=with_capability(result.notes, capability))
    text = whole_text(certificate_pdf(known, of_job, tmp_path / "s.pdf", "en"))
    assert "north 30″ *, level of the seat 10″ (NIM-26-0815), sampling time" in text
    assert "errors of the bench marked * are assumed" in text
    quality = known.calibration.quality
    assert quality is not None
    level_alone = replace(quality, bench_figures={"level_arcsec": 10.0})
    whole = replace(known, calibration=replace(known.calibration, quality=level_alone))
    text = whole_text(certificate_pdf(whole, of_job, tmp_path / "w.pdf", "en"))
    assert "Results are traceable through the measurement standards listed above." in text


def test_a_job_that_names_its_own_procedure_is_followed(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    own = replace(job, procedure="作业指导书 7", procedure_en="Work instruction 7")
    text = whole_text(certificate_pdf(result, own, tmp_path / "s.pdf", "en"))
    assert "Work instruction 7" in text


def test_a_result_of_another_unit_or_without_uncertainties_is_refused(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    other = replace(result, device={**result.device, "serial_number": "7"})
    with pytest.raises(InputError, match="serial number 7"):
        certificate_pdf(other, job, tmp_path / "s.pdf")
    bare = replace(result, calibration=replace(result.calibration, quality=None))
    with pytest.raises(InputError, match="comes without uncertainties"):
        certificate_pdf(bare, job, tmp_path / "s.pdf")


def test_a_turned_position_says_by_how_much(tmp_path: Path, result: ImuResult, job: JobSheet) -> None:
    first = replace(result.dwells[0], beyond_deg=-30.0)
    turned = replace(result, dwells=(first, *result.dwells[1:]))
    printed = lines(certificate_pdf(turned, job, tmp_path / "s.pdf", "en"))
    assert any(line.startswith("1 south up west −30 ") for line in printed)


def test_the_record_holds_every_output_and_both_parts_of_u(
    tmp_path: Path, result: ImuResult, job: JobSheet
) -> None:
    printed = lines(original_record_pdf(result, tmp_path / "r.pdf", job, "en"))
    text = "\n".join(printed)
    assert "rot_y_neg −100 −3600.0000 41 −3608.000 000" in text
    assert "pos_12 (NED) 300 0.011 500 000 00 −0.002 100 000 000" in text
    assert "E1x 1.002 335 497 (°/s)/(°/s) 3.000 × 10−5 4.000 × 10−5 5.000 × 10−5" in text
    assert len([line for line in printed if re.match(r"[EBK][01f]?[xyz]{1,2} ", line)]) == 33


def test_the_combined_uncertainty_is_the_root_of_the_sum_of_squares(result: ImuResult) -> None:
    combined = result.combined
    assert isinstance(combined, Coefficients)
    assert combined.gyro.E1.tolist() == pytest.approx([5e-5] * 3)
    assert combined.accel.K[0, 1] == pytest.approx(5e-5)
    assert combined.gyro.E[1, 1] == 0.0
