"""The statement of conformity, units and capability as a certificate shows them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from scipy import stats

from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.conformity_tables import probability_text
from ahrs_lab.certificates.content import certificate_content
from ahrs_lab.certificates.documents import Block, Document, Paragraph, Table
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.result_tables import ARCMIN
from ahrs_lab.certificates.richtext import text_of
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.conformity import DecisionRule
from ahrs_lab.metrology.limits import Limit
from ahrs_lab.metrology.requirements import Requirements, ResultUnits
from ahrs_lab.metrology.result import CalibrationResult
from tests.certificates.conftest import U_B, U_K, U_L, B, K, L
from tests.certificates.pdf_text import lines, whole_text

LIMITS = (
    Limit("K", -2400.0, 2400.0, "ppm", nominal=1.0),
    Limit("B", None, 11.2, "deg/h"),
    Limit("L", -3.0, 3.02, "arcmin"),
    Limit("L_zy", -500.0, None, "arcsec"),
)


def asking(job: JobSheet, rule: DecisionRule, **more: object) -> JobSheet:
    return replace(job, requirements=Requirements(LIMITS, rule), **more)  # type: ignore[arg-type]


def blocks(document: Document) -> tuple[Block, ...]:
    return document.pages[0]


def rows(document: Document) -> dict[str, list[str]]:
    """Of the table of conformity, by the quantity's symbol."""
    table = next(
        b for b in blocks(document) if isinstance(b, Table) and text_of(b.columns[-1].label.main) == "Verdict"
    )
    return {text_of(row[0].main): [text_of(cell.main) for cell in row[1:]] for row in table.rows}


def paragraphs(document: Document) -> str:
    return "\n".join(text_of(b.text.main) for b in blocks(document) if isinstance(b, Paragraph))


def chance(high: float, value: float, u: float) -> str:
    """Probability below the upper limit; the lower one is far."""
    return f"{100.0 * float(stats.t.cdf((high - value) / u, 40.0)):.1f} %"


def test_each_quantity_stands_beside_its_limits_in_their_unit(
    result: CalibrationResult, job: JobSheet
) -> None:
    found = rows(certificate_content(result, asking(job, DecisionRule("non-binary", 1.0, True)), "en"))
    scale = chance(2400.0, K["x"] * 1e6 - 1e6, U_K * 1e6 / 2.0)
    assert found["Kx"] == [
        "2340", "210", "−2400", "2400", "−2190 ... 2190", "10−6", scale, "conditional pass",
    ]  # fmt: skip
    offset = chance(11.2, B["x"] * 3600.0, U_B * 3600.0 / 2.04)
    assert found["Bx"] == ["11.11", "0.35", "—", "11.2", "≤ 10.85", "°/h", offset, "conditional pass"]
    angle = chance(3.02, L["yz"] * ARCMIN, U_L * ARCMIN / 2.11)
    assert found["Lyz"][-2:] == [angle, "conditional fail"]
    assert found["Lzy"] == ["−148.32", "0.78", "−500", "—", "≥ −499.22", "″", "> 99.9 %", "pass"]
    assert len(found) == 12


@pytest.mark.parametrize(
    ("kind", "verdict", "named"),
    [
        ("simple", "fail", "simple acceptance (ILAC-G8), w = 0"),
        ("guard-band", "fail", "guard band w = 0.5 U (ILAC-G8)"),
        ("non-binary", "conditional fail", "non-binary with guard band w = 0.5 U (ILAC-G8)"),
    ],
)
def test_the_rule_is_named_and_stated(
    result: CalibrationResult, job: JobSheet, kind: str, verdict: str, named: str
) -> None:
    document = certificate_content(result, asking(job, DecisionRule(kind, 0.5)), "en")  # type: ignore[arg-type]
    text = paragraphs(document)
    assert f"12 values against the customer's limits: {verdict}." in text
    assert f"Decision rule: {named}" in text
    assert "before rounding" in text
    assert "as deviation from the nominal value 1 (°/s)/(°/s)" in text
    assert "pc: probability" not in text


def test_a_risk_is_rounded_up(result: CalibrationResult, job: JobSheet) -> None:
    text = paragraphs(certificate_content(result, asking(job, DecisionRule("guard-band")), "en"))
    assert "is up to 2.7 %" in text  # k = 2.00 with 40 degrees of freedom: 2.6147 %
    text = paragraphs(certificate_content(result, asking(job, DecisionRule()), "en"))
    assert "is up to 50 %" in text


def test_no_limits_are_no_section(result: CalibrationResult, job: JobSheet) -> None:
    assert "Decision rule" not in paragraphs(certificate_content(result, job, "en"))


def test_a_limit_of_what_was_not_calibrated_is_said(result: CalibrationResult, job: JobSheet) -> None:
    part = replace(result, misalignment={})
    document = certificate_content(part, asking(job, DecisionRule()), "en")
    assert "Lyx, Lzx, Lxy, Lzy, Lxz, Lyz: limits were set, but not calibrated; not judged." in paragraphs(
        document
    )
    assert len(rows(document)) == 6


def test_a_guard_band_that_lets_nothing_pass_makes_no_certificate(
    result: CalibrationResult, job: JobSheet
) -> None:
    narrow = Requirements((Limit("B", -0.3, 0.3, "deg/h"),), DecisionRule("guard-band"))
    with pytest.raises(InputError, match="no value can pass"):
        certificate_content(result, replace(job, requirements=narrow))


def test_units_are_as_chosen(result: CalibrationResult, job: JobSheet) -> None:
    units = ResultUnits("ppm", "deg/s", "arcsec")
    document = certificate_content(result, replace(job, requirements=Requirements(units=units)), "en")
    heads = [
        [text_of(c.label.main) + text_of(c.unit) for c in b.columns]
        for b in blocks(document)
        if isinstance(b, Table)
    ][1:]
    assert heads[0][1:5] == ["Value(°/s)/(°/s)", "U(°/s)/(°/s)", "K − 110−6", "U10−6"]
    assert heads[1][1:] == ["Value°/s", "U°/s", "k", "Repeatability°/s"]
    assert heads[2][1:] == ["Value″", "U″", "k"]
    assert "given in the unit agreed" in paragraphs(document)


def test_counts_have_no_ppm(result: CalibrationResult, job: JobSheet) -> None:
    counts = {axis: replace(one, unit="LSB/(deg/s)") for axis, one in result.scale_factor.items()}
    asked = replace(job, requirements=Requirements(units=ResultUnits("ppm")))
    with pytest.raises(InputError, match="only a dimensionless one"):
        certificate_content(replace(result, scale_factor=counts), asked)


def test_a_raised_u_is_printed_and_said(result: CalibrationResult, job: JobSheet) -> None:
    document = certificate_content(result, replace(job, best_capability=BestCapability(3e-4)), "en")
    table = [b for b in blocks(document) if isinstance(b, Table)][1]
    assert [text_of(cell.main) for cell in table.rows[0]][:4] == [
        "Scale factor, X axis6  Kx", "1.002\u200934", "0.000\u200930", "2.00",
    ]  # fmt: skip
    assert "best measurement capability (CMC, k = 2)" in paragraphs(document)
    budgets = [b for b in document.pages[1] if isinstance(b, Table) and b.summary_rows]
    assert text_of(budgets[0].rows[-1][2].main) == "210"
    unraised = certificate_content(result, replace(job, best_capability=BestCapability(1e-5)), "en")
    assert "CMC" not in paragraphs(unraised)


def test_a_raised_u_widens_the_guard_band(result: CalibrationResult, job: JobSheet) -> None:
    rule = DecisionRule("guard-band")
    wide = asking(job, rule, best_capability=BestCapability(3e-4))
    assert rows(certificate_content(result, asking(job, rule), "en"))["Kx"][4] == "−2190 ... 2190"
    assert rows(certificate_content(result, wide, "en"))["Kx"][4] == "−2100 ... 2100"


@pytest.mark.parametrize(
    ("probability", "text"),
    [(1.0, "> 99.9 %"), (0.9994, "99.9 %"), (0.5, "50.0 %"), (0.001, "0.1 %"), (0.0, "< 0.1 %")],
)
def test_no_probability_is_printed_as_certain(probability: float, text: str) -> None:
    assert probability_text(probability) == text


@pytest.mark.parametrize("language", ["bilingual", "zh", "en"])
def test_both_languages_name_rule_and_verdict(
    result: CalibrationResult, job: JobSheet, tmp_path: Path, language: CertificateLanguage
) -> None:
    asked = asking(job, DecisionRule("non-binary", 1.0, True), best_capability=BestCapability(3e-4))
    text = whole_text(certificate_pdf(result, asked, tmp_path / "c.pdf", language))
    if language != "en":
        flowing = text.replace("\n", "")
        for words in ("符合性判定", "判定规则", "非二元判定，保护带 w = U", "最佳测量能力"):
            assert words in flowing
        assert any("有条件不合格" in line for line in lines(tmp_path / "c.pdf"))
    if language != "zh":
        assert "Statement of conformity" in text
        assert "conditional pass" in text
