"""The annex of budgets: there where it is asked for, whole, in the certificate's languages, nothing over
anything else."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from ahrs_lab.certificates.budget_annex import budget_annex
from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.documents import Heading, Paragraph, Table
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.result_tables import ResultWriter
from ahrs_lab.certificates.richtext import Run, text_of
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import CalibrationResult, Correlation, MonteCarloCheck, Uncertainty
from ahrs_lab.metrology.uncertainty.budget import combine, from_expanded, from_half_width, type_a
from tests.certificates.pdf_text import spans, whole_text
from tests.certificates.test_layout import outside, overlapping


def budget() -> Uncertainty:
    """Symbols and units of the real budgets; by hand: u_c = √(4² + 3²)·10⁻⁵ °/s = 0.18 °/h."""
    rows = [
        type_a("N_1", Message("Sensor noise in position {position}", position=1), "deg", 0.04, 1e-3, 12.0),
        type_a("F̄", Message("Sensor noise in the means at the rates"), "deg/s", 0.0, 1.0, 9.0),
        type_a("N⁺", Message("Sensor noise in the positive turns"), "deg", 0.0, 1.0, 9.0),
        from_expanded(
            "β", Message("Level of the case, through the Earth's rate"), "rad", 6e-5, 1.0, "assumption"
        ),
        from_half_width("ΔT", Message("Different duration of the two recordings"), "s", 0.0, 1.0, "data"),
    ]
    return combine(rows)


def checked(value: float, *, validated: bool = True) -> Uncertainty:
    low, high = value - 9.8e-5, value + 9.8e-5
    check = MonteCarloCheck(
        200_000, 1, value, 5e-5, (low, high), (low, high), 1, 5e-6, validated, (low, high), (1,)
    )
    return replace(budget(), monte_carlo=check)


@pytest.fixture
def full(result: CalibrationResult) -> CalibrationResult:
    """The sample with budgets of every kind of row, Monte Carlo checks among them."""
    offsets = {
        axis: replace(one, uncertainty=checked(one.B, validated=axis != "y"))
        for axis, one in result.zero_offset.items()
    }
    return replace(result, zero_offset=offsets)


def table_of(result: CalibrationResult, name: str, language: CertificateLanguage = "en") -> Table:
    """The table below the heading that begins with ``name``."""
    blocks = budget_annex(result, ResultWriter(language, "half-even"))
    for block, after in pairwise(blocks):
        if isinstance(block, Heading) and text_of(block.label.main).startswith(name):
            assert isinstance(after, Table)
            return after
    raise AssertionError(name)


def test_it_is_there_only_where_the_job_asks_for_it(
    tmp_path: Path, full: CalibrationResult, job: JobSheet
) -> None:
    without = whole_text(certificate_pdf(full, job, tmp_path / "a.pdf", "en"))
    annexed = whole_text(certificate_pdf(full, replace(job, budget_annex=True), tmp_path / "b.pdf", "en"))
    assert "uncertainty budgets" not in without
    assert "Annex: uncertainty budgets" in annexed
    pages = {int(count) for count in re.findall(r"Page \d+ of (\d+)", annexed)}
    assert len(pages) == 1
    assert pages.pop() > int(re.findall(r"Page \d+ of (\d+)", without)[0])


def test_each_quantity_has_its_table_in_annex_c_order(full: CalibrationResult) -> None:
    blocks = budget_annex(full, ResultWriter("en", "half-even"))
    names = [
        text_of(block.label.main).split("  ")[1]
        for block in blocks
        if isinstance(block, Heading) and block.level == 2
    ]
    assert names == ["Kx", "Ky", "Kz", "Bx", "By", "Bz", "Lyx", "Lzx", "Lxy", "Lzy", "Lxz", "Lyz"]
    assert sum(isinstance(block, Table) for block in blocks) == 12


def test_a_table_says_the_budget_in_the_printed_unit(full: CalibrationResult) -> None:
    rows = [[text_of(cell.main) for cell in row] for row in table_of(full, "Heading zero offset").rows]
    assert rows[0] == ["N1", "Sensor noise in position 1", "0.0400 °", "t", "12", "0.144", "64.0"]
    assert rows[3] == [
        "β", "Level of the case, through the Earth's rate *", "3.00×10−5 rad", "normal", "∞", "0.108", "36.0",
    ]  # fmt: skip
    assert [row[0] for row in rows[:5]] == ["N1", "F", "N+", "β", "ΔT"]
    total, expanded = rows[-2:]
    found = full.zero_offset["x"].uncertainty
    assert total[1:] == ["Combined standard uncertainty\u00a0uc", "", "", "29", "0.18", "100"]
    assert math.floor(found.dof) == 29  # (4² + 3²)²·12/4⁴
    assert expanded[1] == f"Expanded uncertainty U, k = {found.coverage_factor:.2f}"
    assert expanded[5] == "0.37"


def test_powers_and_indices_are_raised_and_lowered_text(full: CalibrationResult) -> None:
    rows = table_of(full, "Heading zero offset").rows
    assert rows[0][0].main == (Run("N"), Run("1", "sub"))
    assert Run("−5", "sup") in rows[3][2].main


def test_the_monte_carlo_line_says_whether_u_is_validated(full: CalibrationResult) -> None:
    blocks = budget_annex(full, ResultWriter("en", "half-even"))
    said = [text_of(block.text.main) for block in blocks if isinstance(block, Paragraph)]
    assert len(said) == 4  # three checks and the note
    assert said[0].startswith("u(x):")  # before the tables that it explains
    assert said[1].startswith(
        "Bx / (°/h): Monte Carlo (JCGM 101), 200\u2009000 trials: mean 11.115, u = 0.180;"
    )
    assert "symmetric [10.762, 11.467]" in said[1]
    assert said[1].endswith("± U is validated by clause 8 (δ = 0.018).")
    assert "not validated" in said[2]


def test_a_u_from_the_trials_and_a_missing_one_are_said(full: CalibrationResult) -> None:
    offset = full.zero_offset["y"]
    check = offset.uncertainty.monte_carlo
    assert check is not None
    check = replace(check, standard=None, gum_expanded=offset.uncertainty.expanded)
    stated = replace(offset.uncertainty, expanded=9.8e-5, monte_carlo=check, from_monte_carlo=True)
    found = replace(full, zero_offset={"y": replace(offset, uncertainty=stated)})
    blocks = budget_annex(found, ResultWriter("en", "half-even"))
    (said,) = [
        text
        for block in blocks
        if isinstance(block, Paragraph) and "u = –;" in (text := text_of(block.text.main))
    ]
    assert said.endswith(
        "The GUM's ± U (0.368) is not validated by clause 8 (δ = 0.018) and too short; "
        "U is the half-width that covers the symmetric interval."
    )


def test_correlations_are_mentioned_where_there_are_any(full: CalibrationResult) -> None:
    rows = budget().rows
    linked = combine(rows, correlations=[Correlation(0, 3, -0.5)])
    offset = replace(full.zero_offset["x"], uncertainty=linked)
    blocks = budget_annex(replace(full, zero_offset={"x": offset}), ResultWriter("en", "half-even"))
    assert any(isinstance(b, Paragraph) and "(13) of JCGM 100" in text_of(b.text.main) for b in blocks)


@pytest.mark.parametrize("language", ["bilingual", "zh", "en"])
def test_it_is_in_the_certificates_languages_and_nothing_overlaps(
    tmp_path: Path, full: CalibrationResult, job: JobSheet, language: CertificateLanguage
) -> None:
    path = certificate_pdf(full, replace(job, budget_annex=True), tmp_path / "c.pdf", language)
    text = whole_text(path)
    assert ("附页：不确定度评定" in text) == (language != "en")
    assert ("Annex: uncertainty budgets" in text) == (language != "zh")
    assert ("位置 1 上传感器的噪声" in text) == (language != "en")
    assert ("Sensor noise in position 1" in text) == (language != "zh")
    found = spans(path)
    assert list(outside(found)) == []
    assert list(overlapping(found)) == []
