"""Clause 8 and annex C in every language, and every printed number traced to the result."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.clause_6 import place_of
from ahrs_lab.certificates.content import certificate_content, mismatches_of
from ahrs_lab.certificates.documents import Paragraph, Table
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.result_tables import ResultWriter, certificates_of, significant
from ahrs_lab.certificates.richtext import number_of, text_of
from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.capability import capability_of
from ahrs_lab.metrology.declared_place import DeclaredPlace, place_note, place_violations
from ahrs_lab.metrology.figures_json import with_capability
from ahrs_lab.metrology.result import CalibrationResult, Environment, Uncertainty
from ahrs_lab.metrology.stated_figures import StatedFigure
from tests.certificates.conftest import BUNDLE_SHA256, U_B, U_K, U_L, B, K, L
from tests.certificates.pdf_text import lines, whole_text

Certificates = Mapping[CertificateLanguage, Path]
LANGUAGES: tuple[CertificateLanguage, ...] = ("bilingual", "zh", "en")

CLAUSE_8_ZH = {
    "a": ["校准证书"],
    "b": ["演示校准实验室", "演示市示例路 2 号"],
    "c": ["证书编号", "AL-2026-0142", "第 1 页"],
    "d": [],
    "e": ["送校单位", "演示客户有限公司", "演示市示例路 1 号"],
    "f": [
        "被校对象",
        "捷联式惯性航姿仪",
        "制造厂",
        "VectorNav",
        "型号规格",
        "VN-100",
        "出厂编号",
        "0100012345",
    ],
    "g": ["接收日期", "2026-11-20", "校准日期", "2026-11-22"],
    "h": ["单轴位置速率转台", "T-0007", "NIM-26-0815", "0.02 %", "线性直流电源", "安装夹具", "2027-03-01"],
    "i": ["环境条件", "温度 (20.3 ± 0.4) °C", "相对湿度 (47 ± 3) %"],
    "j": ["1.002 34", "测量不确定度的说明", "包含概率约为 95 %", "JJF 1059.1"],
    "k": ["签发人", "签发日期", "2026-11-23"],
    "l": ["校准员", "核验员"],
    "9": ["建议复校间隔", "24 个月"],
}
CLAUSE_8_EN = {
    "a": ["CALIBRATION CERTIFICATE"],
    "b": ["Demonstration Calibration Laboratory", "2 Example Road, Demo City"],
    "c": ["Certificate No.", "AL-2026-0142", "Page 1 of"],
    "e": ["Customer", "Demonstration Customer Ltd.", "1 Example Road, Demo City"],
    "f": ["Item calibrated", "Strapdown AHRS", "Manufacturer", "Model", "Serial number", "0100012345"],
    "g": ["Received", "2026-11-20", "Calibrated", "2026-11-22"],
    "h": ["Position and rate table", "T-0007", "NIM-26-0815", "Linear DC supply", "Fixture"],
    "i": ["temperature (20.3 ± 0.4) °C", "humidity (47 ± 3) %RH"],
    "j": ["1.002 34", "Statement of uncertainty", "coverage probability is about 95 %", "JCGM 100"],
    "k": ["Approver", "Issued", "2026-11-23"],
    "l": ["Operator", "Verifier"],
    "9": ["Recommended interval", "24 months"],
}
ANNEX_C_ZH = [
    "航姿仪校准结果",
    "标度因数", "X 轴标度因数 Kx", "Y 轴标度因数 Ky", "Z 轴标度因数 Kz",
    "零偏", "航向角零偏 Bx", "俯仰角零偏 By", "横滚角零偏 Bz",
    "失准角", "X 轴对 Y 轴失准角 Lyx", "X 轴对 Z 轴失准角 Lzx", "Y 轴对 X 轴失准角 Lxy",
    "Y 轴对 Z 轴失准角 Lzy", "Z 轴对 X 轴失准角 Lxz", "Z 轴对 Y 轴失准角 Lyz",
]  # fmt: skip
HAND_ROUNDED = [
    ("X 轴标度因数", "1.002 34", "0.000 21"),
    ("Y 轴标度因数", "0.998 13", "0.000 21"),
    ("Z 轴标度因数", "1.000 74", "0.000 21"),
    ("航向角零偏", "0.003 087", "0.000 097", "11.11", "0.35"),
    ("俯仰角零偏", "−0.002 350", "0.000 097", "−8.46", "0.35"),
    ("横滚角零偏", "0.001 806", "0.000 097", "6.50", "0.35"),
    ("X 轴对 Y 轴失准角", "−0.000 268 9", "0.000 003 8", "−0.924", "0.013", "−0.015 40"),
    ("X 轴对 Z 轴失准角", "0.000 391 5", "0.000 003 8", "1.346", "0.013", "0.022 43"),
    ("Y 轴对 X 轴失准角", "0.000 602 8", "0.000 003 8", "2.072", "0.013", "0.034 54"),
    ("Y 轴对 Z 轴失准角", "−0.000 719 1", "0.000 003 8", "−2.472", "0.013", "−0.041 20"),
    ("Z 轴对 X 轴失准角", "−0.000 428 8", "0.000 003 8", "−1.474", "0.013", "−0.024 57"),
    ("Z 轴对 Y 轴失准角", "0.000 878 8", "0.000 003 8", "3.021", "0.013", "0.050 35"),
]
"""The sample's values with U_K = 2.1e-4, U_B = 9.7e-5 °/s, U_L = 3.8e-6, rounded by hand."""


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_certificate_holds_each_item_of_clause_8(
    certificates: Certificates, language: CertificateLanguage
) -> None:
    text = whole_text(certificates[language])
    wanted = {} if language == "en" else dict(CLAUSE_8_ZH)
    if language != "zh":
        wanted |= {f"{key} in English": items for key, items in CLAUSE_8_EN.items()}
    missing = {item: [w for w in words if w not in text] for item, words in wanted.items()}
    assert not {item: words for item, words in missing.items() if words}


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="pdftotext (poppler-utils) is not installed")
@pytest.mark.parametrize("language", LANGUAGES)
def test_pdftotext_reads_the_same(certificates: Certificates, language: CertificateLanguage) -> None:
    path = certificates[language]
    out = subprocess.run(["pdftotext", "-layout", str(path), "-"], capture_output=True, check=True).stdout
    text = re.sub(r"\s+", " ", out.decode("utf-8"))
    wanted = CLAUSE_8_EN if language == "en" else CLAUSE_8_ZH
    items = [item for key, words in wanted.items() if key not in ("a", "j") for item in words]
    assert not [item for item in items if item not in text]


def test_annex_c_stands_complete_in_its_words_and_order(
    certificates: Certificates,
) -> None:
    text = whole_text(certificates["zh"])
    places = [text.index(words) for words in ANNEX_C_ZH if words in text]
    assert len(places) == len(ANNEX_C_ZH)
    assert places == sorted(places)


@pytest.mark.parametrize("row", HAND_ROUNDED, ids=lambda row: row[0])
def test_values_are_rounded_as_by_hand(certificates: Certificates, row: tuple[str, ...]) -> None:
    printed = lines(certificates["zh"])
    found = [line for line in printed if line.startswith(row[0])]
    assert len(found) == 1
    assert [value for value in row[1:] if value not in found[0]] == []


def test_every_number_of_the_result_sheet_comes_from_the_result(
    result: CalibrationResult, job: JobSheet
) -> None:
    sheet = [block for block in certificate_content(result, job, "zh").pages[0] if isinstance(block, Table)]
    arcmin, degree = 180 * 60 / math.pi, 180 / math.pi
    wanted: dict[str, list[tuple[float, float]]] = {}
    for axis, value in K.items():
        wanted["K" + axis] = [(value, U_K), (U_K, U_K)]
    for axis, value in B.items():
        wanted["B" + axis] = [(f * v, f * U_B) for f in (1.0, 3600.0) for v in (value, U_B)]
    for key, value in L.items():
        wanted["L" + key] = [(f * v, f * U_L) for f in (1.0, arcmin) for v in (value, U_L)]
        wanted["L" + key].append((degree * value, degree * U_L))
    for table in sheet[1:4]:
        for row in table.rows:
            name = text_of(row[0].main).split()[-1]
            expected = wanted.pop(name)
            for cell, (value, expanded) in zip(row[1:], expected, strict=False):
                printed = text_of(cell.main)
                place = 10.0 ** -len(re.sub(r"\s", "", printed).partition(".")[2])
                assert abs(number_of(printed) - value) <= 0.5000001 * place
                assert 0.01 <= place / expanded <= 0.1, "U has two significant digits"
    assert not wanted


def test_coverage_factor_range_and_repeatability_stand_beside_the_values(
    certificates: Certificates,
) -> None:
    printed = lines(certificates["zh"])
    scale = next(line for line in printed if line.startswith("X 轴标度因数"))
    offset = next(line for line in printed if line.startswith("航向角零偏"))
    assert scale.endswith("2.00 ±300 °/s")
    assert offset.endswith("2.04 0.47"), "1.3e-4 °/s is 0.47 °/h"


@pytest.mark.parametrize(
    "words",
    [
        "±10, ±50, ±100, ±200, ±300 °/s",
        "1800 s",
        "±10 周，100 °/s",
        "四位置法，标准程序",
        BUNDLE_SHA256,
        "100 Hz",
        "39.9042°",
        "ahrs-lab 0.1.0",
        "The dwell is shorter",
        "The unit was warm",
        "M−1 (N − B T)",
    ],
)
def test_conditions_and_methods_are_named(certificates: Certificates, words: str) -> None:
    assert words in whole_text(certificates["zh"])


def test_the_combined_schedule_is_named(result: CalibrationResult, job: JobSheet, tmp_path: Path) -> None:
    offsets = {axis: replace(one, schedule="combined") for axis, one in result.zero_offset.items()}
    path = certificate_pdf(replace(result, zero_offset=offsets), job, tmp_path / "c.pdf", "en")
    assert "combined schedule" in whole_text(path)


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("zh", ["第一下标为输出轴", "除数印刷时缺括号", "比值，小角度时即弧度", "应为乘积", "450 不适用"]),
        ("en", ["first index the output", "without brackets", "radians", "multiplies the vector", "the 450"]),
    ],
)
def test_footnotes_say_where_the_print_is_not_followed(
    certificates: Certificates, language: CertificateLanguage, words: list[str]
) -> None:
    text = whole_text(certificates[language])
    assert [one for one in words if one not in text] == []
    assert "annex a drops" not in text.lower()


def test_annex_a_has_its_own_statement_and_footnote(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    by_annex = replace(
        result,
        scale_factor={
            a: replace(r, uncertainty=replace(r.uncertainty, method="annex-a"))
            for a, r in result.scale_factor.items()
        },
        zero_offset={},
        misalignment={},
    )
    path = certificate_pdf(by_annex, replace(job, uncertainty_method="annex-a"), tmp_path / "c.pdf", "en")
    text = whole_text(path)
    assert "by annex A of JJF 1536-2015 with the coverage factor k = 2" in text
    assert "Annex A drops the sensitivities" in text
    assert "JCGM 100" not in text
    assert "Heading zero offset Bx not calibrated" in text


def test_rounding_up_is_the_jobs_choice(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    raised = {
        axis: replace(one, uncertainty=replace(one.uncertainty, expanded=2.11e-4))
        for axis, one in result.scale_factor.items()
    }
    changed = replace(result, scale_factor=raised)
    even = lines(certificate_pdf(changed, job, tmp_path / "e.pdf", "zh"))
    up = lines(certificate_pdf(changed, replace(job, rounding="up"), tmp_path / "u.pdf", "zh"))
    assert "0.000 21 " in next(line for line in even if line.startswith("X 轴标度因数"))
    assert "0.000 22 " in next(line for line in up if line.startswith("X 轴标度因数"))


def test_a_certificate_for_another_device_is_refused(result: CalibrationResult, job: JobSheet) -> None:
    other = replace(job, device=replace(job.device, serial_number="0100099999"))
    with pytest.raises(InputError, match="0100012345, the job sheet is for 0100099999"):
        certificate_content(result, other)
    remarks = certificate_content(result, replace(other, demonstration=True), "en").pages[0]
    said = " ".join(text_of(block.text.main) for block in remarks if hasattr(block, "text"))
    assert "the job sheet is for 0100099999" in said


def test_another_method_than_the_job_asks_for_is_refused(result: CalibrationResult, job: JobSheet) -> None:
    with pytest.raises(InputError, match="asks for uncertainty by annex-a"):
        certificate_content(result, replace(job, uncertainty_method="annex-a"))


def test_an_empty_result_is_refused(result: CalibrationResult, job: JobSheet) -> None:
    with pytest.raises(InputError, match="nothing to certify"):
        certificate_content(replace(result, scale_factor={}, zero_offset={}, misalignment={}), job)


def test_without_environment_and_issue_date_the_certificate_says_so(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    path = certificate_pdf(
        replace(result, environment=None), replace(job, issued=None, standards=()), tmp_path / "c.pdf", "en"
    )
    text = whole_text(path)
    assert "Environment not recorded" in text
    assert "Issued date of the approver's digital signature" in text
    assert "No measurement standard was entered." in text


def test_deviations_follow_the_language(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    said = replace(result, deviations=(Message("The file is not signed"),))
    text = whole_text(certificate_pdf(said, job, tmp_path / "c.pdf", "bilingual"))
    assert "文件未签名" in text
    assert "The file is not signed" in text


def test_traceability_is_claimed_only_where_the_standards_bear_it_out(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    def said(changed: JobSheet) -> str:
        return whole_text(certificate_pdf(result, changed, tmp_path / "c.pdf", "en"))

    table, *others = job.standards
    assert "Results are traceable through the measurement standards" in said(job)
    named = replace(job, standards=(replace(table, traceability="NIM"), *others))
    assert "The standards are traced through NIM." in said(named)
    for wrong in (
        (),
        (replace(table, certificate_number=""), *others),
        (replace(table, due=None), *others),
        (replace(table, due=job.calibrated - timedelta(days=1)), *others),
    ):
        text = said(replace(job, standards=wrong))
        assert "Traceability of the results is not shown" in text
        assert "Results are traceable" not in text
    text = said(replace(job, demonstration=True))
    assert "its results are not traceable" in text
    assert "Results are traceable" not in text


def test_a_room_out_of_its_limits_stands_among_the_deviations(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    warm = replace(result, deviations=(), environment=Environment(23.4, 0.5, 47.0, 2.0))
    text = whole_text(certificate_pdf(warm, job, tmp_path / "c.pdf", "en"))
    assert "Deviations from the standard None." not in text
    assert "The room was at (23.4 ± 0.5) °C" in text
    accepted = replace(
        job,
        accepted_violations=(
            "The room was at (23.4 ± 0.5) °C; it has to stay within 17.0 °C to 23.0 °C (clause 6.2.1). "
            "– urgent",
        ),
    )
    text = whole_text(certificate_pdf(warm, accepted, tmp_path / "c.pdf", "en"))
    assert text.count("The room was at (23.4 ± 0.5) °C") == 1
    good = replace(result, deviations=())
    text = whole_text(certificate_pdf(good, job, tmp_path / "c.pdf", "en"))
    assert "Deviations from the standard None." in text


def test_the_declared_place_is_printed_with_whether_clause_6_was_met(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    def said(place: DeclaredPlace | None, language: CertificateLanguage = "en", **changes: Any) -> str:
        notes = place_note(place) if place is not None else {}
        sheet = replace(job, **changes)
        return whole_text(certificate_pdf(replace(result, notes=notes), sheet, tmp_path / "c.pdf", language))

    met = "Room, site and measurement standards met the conditions of clause 6."
    text = said(DeclaredPlace(1.2, True))
    assert "Earth resistance 1.2 Ω; table on an isolated foundation" in text
    assert met in text
    text = said(DeclaredPlace(1.2, True), "zh")
    assert "接地电阻 1.2 Ω；转台置于独立地基上" in text
    assert "符合规范第 6 章的要求" in text

    text = said(None)
    assert "Site conditions not declared" in text
    assert "As far as they are known, the conditions of clause 6 were met." in text
    text = said(DeclaredPlace(1.2))
    assert "Earth resistance 1.2 Ω; foundation of the table not declared" in text
    assert met not in text

    text = said(DeclaredPlace(4.5, True))
    assert "The conditions of clause 6 were not all met" in text
    assert "The earth resistance is declared as 4.5 Ω" in text
    (violation,) = place_violations(DeclaredPlace(4.5, True), needed=True)
    reason = f"{violation.text()} – measured after rain (another person)"
    text = said(DeclaredPlace(4.5, True), accepted_violations=(reason,))
    assert "The conditions of clause 6 were not all met" in text
    assert text.count("declared as 4.5 Ω") == 1
    assert "measured after rain" in text


def test_what_the_recording_declares_goes_before_the_job_sheet(
    result: CalibrationResult, job: JobSheet
) -> None:
    sheet = replace(job, declared_place=DeclaredPlace(2.0, True))
    assert place_of(result, sheet) == DeclaredPlace(2.0, True)
    noted = replace(result, notes=place_note(DeclaredPlace(3.0, False)))
    assert place_of(noted, sheet) == DeclaredPlace(3.0, False)
    assert place_of(result, None) == DeclaredPlace()


def test_the_printed_room_holds_all_that_was_measured(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    # 20.05 … 20.85 °C, 45.6 … 51.4 %
    room = replace(result, environment=Environment(20.45, 0.4, 48.5, 2.9))
    text = whole_text(certificate_pdf(room, job, tmp_path / "c.pdf", "en"))
    found = re.search(r"temperature \(([\d.]+) ± ([\d.]+)\) °C, humidity \((\d+) ± (\d+)\)", text)
    assert found is not None
    t, dt, h, dh = map(float, found.groups())
    assert t - dt <= 20.05 + 1e-9
    assert t + dt >= 20.85 - 1e-9
    assert h - dh <= 45.6
    assert h + dh >= 51.4


def test_schedules_that_differ_are_named_by_axis(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    offsets = {
        axis: replace(one, schedule="standard" if axis == "x" else "combined")
        for axis, one in result.zero_offset.items()
    }
    path = certificate_pdf(replace(result, zero_offset=offsets), job, tmp_path / "c.pdf", "en")
    text = whole_text(path)
    assert "X: four positions, standard schedule" in text
    assert "Y, Z: four positions, combined schedule" in text


@pytest.mark.parametrize(
    ("cycles", "words"),
    [(0, "not the turn-on repeatability"), (5, "from 5 measurements with power off between them")],
)
def test_the_certificate_says_what_the_repeatability_is(
    tmp_path: Path, result: CalibrationResult, job: JobSheet, cycles: int, words: str
) -> None:
    offsets = {axis: replace(one, repeatability_cycles=cycles) for axis, one in result.zero_offset.items()}
    path = certificate_pdf(replace(result, zero_offset=offsets), job, tmp_path / "c.pdf", "en")
    assert words in whole_text(path)


def test_u_with_the_repeatability_is_said_and_only_what_the_job_asks_is_certified(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    offsets = {axis: replace(one, repeatability_included=True) for axis, one in result.zero_offset.items()}
    included = replace(result, zero_offset=offsets)
    asking = replace(job, requirements=replace(job.requirements, repeatability=True))
    text = whole_text(certificate_pdf(included, asking, tmp_path / "c.pdf", "bilingual"))
    assert "includes what B may be on another day" in text
    assert "其 U 包含" in text
    assert "does not cover" not in text
    with pytest.raises(InputError, match="does not ask for"):
        certificate_pdf(included, job, tmp_path / "d.pdf")
    with pytest.raises(InputError, match="has it without"):
        certificate_pdf(result, asking, tmp_path / "d.pdf")


def test_a_change_of_unit_does_not_raise_a_digit() -> None:
    expanded = 0.015 / 3600.0
    assert expanded * 3600.0 > 0.015  # in floats by the last bit, which "up" must not see
    stated = Uncertainty(expanded / 2.0, expanded, 2.0, math.inf, "gum")
    value, printed = ResultWriter("en", "up").pair(1.0 / 3600.0, stated, 3600.0)
    assert (text_of(value.main), text_of(printed.main)) == ("1.000", "0.015")


@pytest.mark.parametrize(
    ("value", "printed"),
    [(0.0996, "0.10"), (0.0994, "0.099"), (9.96, "10"), (99.6, "100"), (-0.00396, "−0.0040")],
)
def test_two_significant_digits_are_two(value: float, printed: str) -> None:
    assert significant(value) == printed


def test_counts_need_no_hint_how_to_divide(result: CalibrationResult, job: JobSheet) -> None:
    def hints(unit: str) -> int:
        shown = certificate_content(replace(result, device={**result.device, "rate_unit": unit}), job, "en")
        texts = [text_of(block.text.main) for block in shown.pages[0] if hasattr(block, "text")]
        return sum("as delivered" in text for text in texts)

    assert (hints("deg/s"), hints("rad/s"), hints("LSB")) == (1, 1, 0)


def certified(result: CalibrationResult, numbers: Mapping[str, str]) -> CalibrationResult:
    """The same result with the first rows of its K stated by certificates, axis → number."""
    changed = {}
    for axis, found in result.scale_factor.items():
        first, *rest = found.uncertainty.rows
        row = replace(first, origin="certificate", certificate=numbers[axis]) if axis in numbers else first
        changed[axis] = replace(found, uncertainty=replace(found.uncertainty, rows=(row, *rest)))
    return replace(result, scale_factor=changed)


def test_a_budgets_line_says_which_certificate_states_it(result: CalibrationResult, job: JobSheet) -> None:
    with_numbers = certified(result, {"x": "GFJGJL-1", "y": "GFJGJL-2"})
    assert certificates_of(with_numbers) == {"GFJGJL-1": "a", "GFJGJL-2": "b"}
    content = certificate_content(with_numbers, job, "en")
    names = [
        text_of(row[0].main) for block in content.pages[1] if isinstance(block, Table) for row in block.rows
    ]
    source = result.scale_factor["x"].uncertainty.rows[0].source.text()
    assert f"{source} a)" in names
    assert f"{source} b)" in names
    assert not any(name.startswith(source) and name.endswith("*") for name in names)
    said = [text_of(block.text.main) for block in content.pages[1] if isinstance(block, Paragraph)]
    note = next(text for text in said if text.startswith("Columns"))
    assert "a) GFJGJL-1; b) GFJGJL-2" in note


def named_sources(result: CalibrationResult, template: str) -> CalibrationResult:
    """``result`` with ``template`` as the first source of every misalignment's budget."""
    changed = {}
    for key, one in result.misalignment.items():
        first, *others = one.uncertainty.rows
        rows = (replace(first, source=Message(template)), *others)
        changed[key] = replace(one, uncertainty=replace(one.uncertainty, rows=rows))
    return replace(result, misalignment=changed)


def test_the_sources_of_all_six_misalignments_are_named_in_both_languages(
    result: CalibrationResult, job: JobSheet
) -> None:
    named = named_sources(result, "Sensor noise in the positive turns")
    content = certificate_content(named, job, "bilingual")
    cells = [row[0] for block in content.pages[1] if isinstance(block, Table) for row in block.rows]
    found = next(cell for cell in cells if "Sensor noise" in text_of(cell.second))
    assert text_of(found.main) == "正转时传感器的噪声"


@pytest.mark.parametrize(
    ("language", "main", "second"),
    [
        ("bilingual", "Urel = 0.1 %，纹波 1 mV", "Urel = 0.1 %, ripple 1 mV"),
        ("zh", "Urel = 0.1 %，纹波 1 mV", ""),
        ("en", "Urel = 0.1 %, ripple 1 mV", ""),
    ],
)
def test_the_accuracy_of_a_standard_is_in_the_documents_languages(
    result: CalibrationResult, job: JobSheet, language: CertificateLanguage, main: str, second: str
) -> None:
    one = replace(
        job.standards[0], accuracy="U_rel = 0.1 %, ripple 1 mV", accuracy_zh="U_rel = 0.1 %，纹波 1 mV"
    )
    content = certificate_content(result, replace(job, standards=(one,)), language)
    table = next(block for block in content.pages[0] if isinstance(block, Table))
    assert (text_of(table.rows[0][3].main), text_of(table.rows[0][3].second)) == (main, second)


def test_a_result_of_other_figures_than_the_jobs_is_not_certified(
    result: CalibrationResult, job: JobSheet
) -> None:
    stated = replace(job.standards[0], figures=(StatedFigure("wobble_arcsec", 1.0, "arcsec", 2.0),))
    standards = (stated, *job.standards[1:])
    capability = capability_of(standards, job.calibrated)
    other = replace(job, standards=standards, capability=capability)
    with pytest.raises(InputError, match="evaluated with other figures of the standards"):
        certificate_content(result, other)
    same = replace(result, notes=with_capability(result.notes, capability))
    certificate_content(same, other)
    with pytest.raises(InputError, match="evaluated with other figures of the standards"):
        certificate_content(same, job)


def test_the_fitted_zero_has_its_uncertainty_and_the_asymmetry_what_noise_gives_it(
    result: CalibrationResult, job: JobSheet
) -> None:
    scale = {
        axis: replace(one, F0_uncertainty=Uncertainty(6e-5, 1.234e-4, 2.057, 25.0, "gum"))
        for axis, one in result.scale_factor.items()
    }
    annex = certificate_content(replace(result, scale_factor=scale), job, "en").pages[1]
    table = next(block for block in annex if isinstance(block, Table) and len(block.columns) == 6)
    row = [text_of(cell.main) for cell in table.rows[0]]
    assert row[0] == "X"
    assert row[1] == "7.3"
    # to the place of its standard uncertainty
    value, standard = row[2].partition(".")[2], row[3].partition(".")[2]
    assert len(value) == len(standard)
    assert row[4:] == ["(0.000\u200960 ± 0.000\u200912) °/s", "2.06"]
    without = certificate_content(result, job, "en").pages[1]
    table = next(block for block in without if isinstance(block, Table) and len(block.columns) == 6)
    assert [text_of(cell.main) for cell in table.rows[0]][4:] == ["0.000\u200960 °/s", "—"]


@pytest.mark.parametrize(
    ("started", "finished", "fits"),
    [
        ("2026-11-22T08:00:00+00:00", "2026-11-22T15:01:02+00:00", True),
        ("2026-11-23T01:00:00+00:00", "2026-11-24T15:01:02+00:00", True),  # the day before in America
        ("2026-11-19T01:00:00+00:00", "2026-11-21T15:01:02+00:00", True),  # the day after in Asia
        ("2026-11-24T01:00:00+00:00", "2026-11-25T15:01:02+00:00", False),
        ("2026-11-19T01:00:00+00:00", "2026-11-20T15:01:02+00:00", False),
        ("2026-11-24T01:00:00+00:00", "", False),
        ("", "", True),
        ("yesterday", "0001-01-01", True),
    ],
)
def test_the_date_of_calibration_has_to_be_the_recordings(
    result: CalibrationResult, job: JobSheet, started: str, finished: str, fits: bool
) -> None:
    recorded = replace(result, notes={"started_utc": started, "finished_utc": finished})
    said = [message.text() for message in mismatches_of(recorded, job)]
    if fits:
        assert not said
        certificate_content(recorded, job)
        return
    with pytest.raises(InputError, match=r"The recording was made on 2026-11-.* Correct the job sheet"):
        certificate_content(recorded, job)
    remarks = [
        text_of(block.text.main)
        for page in certificate_content(recorded, replace(job, demonstration=True), "en").pages
        for block in page
        if isinstance(block, Paragraph)
    ]
    assert said[0] in remarks
    assert said[0].endswith("the date of calibration is given as 2026-11-22.")
