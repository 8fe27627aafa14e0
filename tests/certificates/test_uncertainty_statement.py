"""The statement of uncertainty claims neither 95 % nor traceability where the budgets do not bear it out."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ahrs_lab.certificates.content import certificate_content
from ahrs_lab.certificates.documents import Paragraph, Table
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.original_record import original_record
from ahrs_lab.certificates.richtext import text_of
from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.result import CalibrationResult, MonteCarloCheck, Uncertainty


def checked(found: Uncertainty, value: float, reach: float, *, widened: bool) -> Uncertainty:
    """Not validated: the trials' interval reaches ``reach``·U."""
    ends = value - reach * found.expanded, value + reach * found.expanded
    check = MonteCarloCheck(200_000, 1, value, None, ends, ends, 1, 1e-9, False, ends, (), found.expanded)
    if not widened:
        return replace(found, monte_carlo=check)
    expanded = reach * found.expanded
    return replace(
        found,
        expanded=expanded,
        coverage_factor=expanded / found.standard,
        monte_carlo=check,
        from_monte_carlo=True,
    )


def with_checks(result: CalibrationResult, reach: float, *, widened: bool) -> CalibrationResult:
    """B_x and L_yx are not validated."""
    offset, angle = result.zero_offset["x"], result.misalignment["yx"]
    offset = replace(offset, uncertainty=checked(offset.uncertainty, offset.B, reach, widened=widened))
    angle = replace(angle, uncertainty=checked(angle.uncertainty, angle.L, reach, widened=widened))
    return replace(
        result,
        zero_offset={**result.zero_offset, "x": offset},
        misalignment={**result.misalignment, "yx": angle},
    )


def said(result: CalibrationResult, job: JobSheet, language: CertificateLanguage = "en") -> str:
    page = certificate_content(result, job, language).pages[0]
    return "\n".join(text_of(block.text.main) for block in page if isinstance(block, Paragraph))


def test_a_u_from_the_trials_is_an_exception_with_a_footnote(
    result: CalibrationResult, job: JobSheet
) -> None:
    found = with_checks(result, 1.2, widened=True)
    text = said(found, job)
    assert "Exception: Bx, Lyx, whose GUM interval is not validated by Monte Carlo" in text
    assert "covers the trials' symmetric 95 % coverage interval, k = U/uc." in text
    assert "U is from the Monte Carlo trials (JCGM 101, 8.3)" in text
    assert "例外：Bx, Lyx" in said(found, job, "zh")
    rows = [
        row
        for block in certificate_content(found, job, "en").pages[0]
        if isinstance(block, Table)
        for row in block.rows
    ]
    marked = [text_of(row[0].main) for row in rows if any(run.text == "6" for run in row[0].main)]
    assert len(marked) == 2
    assert marked[0].startswith("Heading zero offset6")
    record = original_record(found, job, "en")
    texts = [text_of(b.text.main) for page in record.pages for b in page if isinstance(b, Paragraph)]
    assert any(one.startswith("Bx, Lyx: U is from the Monte Carlo trials") for one in texts)


def test_a_longer_u_of_the_gum_is_said_to_hold_more(result: CalibrationResult, job: JobSheet) -> None:
    text = said(with_checks(result, 0.8, widened=False), job)
    assert "Bx, Lyx, whose GUM interval is not validated" in text
    assert "its coverage probability is more than 95 %" in text
    assert "U is from the Monte Carlo trials" not in text


def test_a_result_of_before_claims_nothing(result: CalibrationResult, job: JobSheet) -> None:
    text = said(with_checks(result, 1.2, widened=False), job)
    assert "its coverage probability may be less than 95 %; evaluate the recording again" in text


def test_a_u_raised_to_the_capability_is_no_exception(result: CalibrationResult, job: JobSheet) -> None:
    found = with_checks(result, 1.2, widened=True)
    text = said(found, replace(job, best_capability=BestCapability(B_dps=1.0)))
    assert "Exception: Lyx, whose" in text
    assert "Exception" not in said(result, job)


def assumed(found: Uncertainty) -> Uncertainty:
    """The larger of the two rows of type B is an assumption."""
    rows = tuple(replace(row, origin="assumption") if row.symbol == "Ω" else row for row in found.rows)
    return replace(found, rows=rows)


@pytest.mark.parametrize(("share", "named"), [(1.0, True), (0.4, False)])
def test_quantities_that_rest_on_assumptions_are_named(
    result: CalibrationResult, job: JobSheet, share: float, named: bool
) -> None:
    offset = result.zero_offset["y"]
    rows = tuple(
        replace(row, origin="assumption", contribution=share * row.contribution)
        if row.symbol == "Ω"
        else replace(row, origin="certificate")
        if row.symbol == "α"
        else row
        for row in offset.uncertainty.rows
    )
    offset = replace(offset, uncertainty=replace(offset.uncertainty, rows=rows))
    text = said(replace(result, zero_offset={**result.zero_offset, "y": offset}), job)
    assert "Results are traceable" in text
    assert ("Of By most of the type B variance (more than 50 %) is from assumed figures" in text) == named


def test_nothing_is_called_traceable_where_everything_is_assumed(
    result: CalibrationResult, job: JobSheet
) -> None:
    scale = result.scale_factor["x"]
    angle = result.misalignment["yx"]
    found = replace(
        result,
        scale_factor={"x": replace(scale, uncertainty=assumed(scale.uncertainty))},
        zero_offset={},
        misalignment={"yx": replace(angle, uncertainty=assumed(angle.uncertainty))},
    )
    text = said(found, job)
    assert "Traceability of the results is not shown: of every one most" in text
    assert "Results are traceable" not in text
