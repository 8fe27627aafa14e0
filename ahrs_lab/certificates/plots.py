"""The plots of a result as a PDF of their own: residuals, positions, turns."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.charts import position_blocks, residual_blocks
from ahrs_lab.certificates.documents import Block, Chart, Document, Heading, Paragraph, Series, label
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.layout import write_document
from ahrs_lab.certificates.record_parts import record_frame
from ahrs_lab.certificates.result_tables import ARCMIN, AXES
from ahrs_lab.certificates.richtext import plain
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, CalibrationResult


def plots_pdf(result: CalibrationResult, target: Path, language: CertificateLanguage = "bilingual") -> Path:
    """Write the plots to ``target``.

    Raises:
        InputError: a character that cannot be printed.
        MachineError: the file cannot be written.
    """
    document = Document(
        frame=record_frame(result, None, language, wording.PLOTS_TITLE),
        front=(
            *residual_blocks(result, language),
            *position_blocks(result, language),
            *turn_blocks(result, language),
        ),
        signatures=(),
    )
    return write_document(document, target)


def turn_blocks(result: CalibrationResult, language: CertificateLanguage) -> Iterator[Block]:
    """Misalignments with U, one panel for each turned axis."""
    panels = []
    for axis in AXES:
        keys = [key for key in MISALIGNMENT_KEYS if key in result.misalignment and key[1] == axis]
        found = [result.misalignment[key] for key in keys]
        if found:
            panels.append(
                Series(
                    axis=axis,
                    x=tuple(float(i) for i in range(1, len(found) + 1)),
                    y=tuple(one.L * ARCMIN for one in found),
                    error=tuple(one.uncertainty.expanded * ARCMIN for one in found),
                    names=tuple(one.output_axis.upper() for one in found),
                    title=plain(axis.upper()),
                )
            )
    if not panels:
        return
    yield Heading(label(wording.MISALIGNMENT_CHART, language), level=2)
    yield Chart(
        tuple(panels),
        label(wording.MISALIGNMENT_X, language),
        label(wording.MISALIGNMENT_Y, language),
        x_ticks=(1.0, 2.0) if max(len(panel.x) for panel in panels) > 1 else (1.0,),
    )
    yield Paragraph(label(wording.MISALIGNMENT_NOTE, language), size=7.0)
