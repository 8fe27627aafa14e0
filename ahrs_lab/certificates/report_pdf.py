"""What stands on every page of an analysis' report: it is no certificate, and says so."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Block, Document, DocumentFrame, Label, label, same
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.layout import write_document
from ahrs_lab.certificates.richtext import text_of


def report_pdf(
    title: Label,
    blocks: Iterable[Block],
    target: Path,
    *,
    source: str,
    software: str,
    language: CertificateLanguage = "bilingual",
) -> Path:
    """Write ``blocks`` under ``title``; ``source`` names what was analysed, ``software`` what made it.

    Raises:
        InputError: a character that cannot be printed.
        MachineError: the file cannot be written.
    """
    name = text_of(title.main)
    frame = DocumentFrame(
        laboratory=label(wording.ANALYSIS, language),
        laboratory_address=Label(()),
        number_label=Label(()),
        number=same(source).main,
        page_of=wording.PAGE_OF,
        language=language,
        footer=label(wording.ANALYSIS_FOOTER.filled(software=software), language),
        banner=None,
        title=title,
        file_title=name,
        file_subject=source,
    )
    return write_document(Document(frame=frame, front=tuple(blocks), signatures=()), target)
