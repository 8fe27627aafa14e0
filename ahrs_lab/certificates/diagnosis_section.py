"""The diagnosis in the original record: a sentence for each test, with its p-value."""

from __future__ import annotations

from collections.abc import Iterator

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Block, Column, Heading, Label, Paragraph, Table, both, label, same
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.result_tables import AXES, DASH
from ahrs_lab.certificates.richtext import RichText, symbol
from ahrs_lab.metrology.diagnosis.model import DiagnosisFinding
from ahrs_lab.metrology.diagnosis.words import probability
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, CalibrationResult


def diagnosis_section(result: CalibrationResult, language: CertificateLanguage) -> Iterator[Block]:
    """Nothing where the result has no diagnosis."""
    if result.diagnosis is None:
        return
    groups = [
        rows for rows in (_scale_factors(result), _zero_offsets(result), _misalignments(result)) if rows
    ]
    if not groups:
        return
    yield Heading(label(wording.DIAGNOSIS, language))
    for rows in groups:
        yield _table(rows, language)
    yield Paragraph(label(wording.DIAGNOSIS_NOTE, language))


def _table(rows: list[tuple[RichText, DiagnosisFinding]], language: CertificateLanguage) -> Table:
    return Table(
        (
            Column(label(wording.QUANTITY, language)),
            Column(label(wording.FINDING_STATE, language)),
            Column(label(wording.WHAT, language)),
            Column(label(wording.FINDING_P, language), align="right"),
        ),
        tuple(
            (
                Label(name),
                label(wording.FINDING_STATES[finding.state], language),
                both(finding.what.text("zh"), finding.what.text("en"), language),
                same(DASH if finding.p is None else probability(finding.p).replace(" ", "")),
            )
            for name, finding in rows
        ),
        size=7.5,
    )


def _scale_factors(result: CalibrationResult) -> list[tuple[RichText, DiagnosisFinding]]:
    found = result.diagnosis.scale_factor if result.diagnosis is not None else {}
    return [(symbol("K", axis), one) for axis in AXES if axis in found for one in found[axis].findings]


def _zero_offsets(result: CalibrationResult) -> list[tuple[RichText, DiagnosisFinding]]:
    found = result.diagnosis.zero_offset if result.diagnosis is not None else {}
    return [(symbol("B", axis), one) for axis in AXES if axis in found for one in found[axis].findings]


def _misalignments(result: CalibrationResult) -> list[tuple[RichText, DiagnosisFinding]]:
    """What is worth a look: the figures themselves stand in table 3."""
    found = result.diagnosis.misalignment if result.diagnosis is not None else {}
    return [
        (symbol("L", key), one)
        for key in MISALIGNMENT_KEYS
        if key in found
        for one in found[key].findings
        if one.state != "fine"
    ]
