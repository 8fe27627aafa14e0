"""The diagnosis in the original record: K and B whole, of L what is worth a look, each with its p-value."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.certificates.original_record import original_record_pdf
from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.allan import allan_finding, diagnose_allan
from ahrs_lab.metrology.diagnosis.model import (
    Diagnosis,
    DiagnosisFinding,
    MisalignmentDiagnosis,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.diagnosis.zero_offset import diagnose_harmonic, harmonic_findings
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from tests.certificates.pdf_text import lines, spans, whole_text
from tests.certificates.test_layout import outside, overlapping


@pytest.fixture
def diagnosed(result: CalibrationResult) -> CalibrationResult:
    """With the sentences that hold the rarest signs: φ, √, °."""
    rng = np.random.default_rng(1)
    allan = diagnose_allan([rng.normal(0.0, 1e-3, 600)], 1.0, NoiseModel(1e-3), 600.0)
    azimuths = np.arange(0.0, 360.0, 30.0)
    harmonic = diagnose_harmonic(
        azimuths, -azimuths, rng.normal(0.0, 1e-5, 12), latitude_deg=39.9, gain=1.0, noise_dps=1e-5,
        latitude_standard_deg=0.0, azimuth_standard_deg=0.0,
    )  # fmt: skip
    assert allan is not None
    assert harmonic is not None
    # the phase of nothing is anything: it is replaced by a known sentence
    amplitude, _ = harmonic_findings(harmonic)
    moved = DiagnosisFinding("look", Message("The residuals show no trend with time."), 0.0042, "zo_x_1")
    fine = DiagnosisFinding("fine", Message("The line fits as well as the noise of the recordings lets it."))
    diagnosis = Diagnosis(
        {},
        {"x": ZeroOffsetDiagnosis(None, harmonic, allan, (amplitude, moved, allan_finding(allan)))},
        {"yx": MisalignmentDiagnosis(0.0, 0.0, (fine,))},
    )
    return replace(result, diagnosis=diagnosis)


def test_each_finding_has_state_sentence_and_chance(tmp_path: Path, diagnosed: CalibrationResult) -> None:
    printed = lines(original_record_pdf(diagnosed, tmp_path / "r.pdf", None, "en"))
    text = " ".join(" ".join(printed).split())
    start = text.index("What the data say about themselves")
    section = text[start : text.index("below 0.01 it is worth a look", start)]
    assert "ω_ie·cos φ" in section
    assert "<0.0001" in section
    assert "look" in section
    assert "0.0042" in section
    assert "doubling T would lower it by" in section
    assert "1/√2" in section
    assert "The line fits" not in section


@pytest.mark.parametrize("language", ["zh", "bilingual"])
def test_it_stands_within_the_page(tmp_path: Path, diagnosed: CalibrationResult, language: str) -> None:
    pdf = original_record_pdf(diagnosed, tmp_path / "r.pdf", None, language)  # type: ignore[arg-type]
    assert "数据诊断" in whole_text(pdf)
    found = spans(pdf)
    assert list(outside(found)) == []
    assert list(overlapping(found)) == []


def test_an_older_result_has_no_such_section(tmp_path: Path, result: CalibrationResult) -> None:
    pdf = original_record_pdf(result, tmp_path / "r.pdf", None, "en")
    assert "What the data say" not in whole_text(pdf)
