"""An analysis' report as a PDF: its warnings, tables, charts and notes in the blocks that certificates are
laid out of."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ahrs_lab.analysis import report as reports
from ahrs_lab.analysis.curve_thinning import thinned
from ahrs_lab.analysis.report_cells import number_columns, readable
from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import (
    Block,
    Column,
    Heading,
    Label,
    Line,
    LineChart,
    Paragraph,
    Table,
    Words,
    label,
)
from ahrs_lab.certificates.fonts import printable
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.report_pdf import report_pdf
from ahrs_lab.certificates.richtext import bold, joined, markup, plain, text_of
from ahrs_lab.messages import Message

_PLACES = 700
"""Across a chart's width: finer than a printer's dot at the line's own width."""


def save_report(
    report: reports.Report,
    target: Path,
    *,
    bundles: Sequence[Path] = (),
    software: str,
    language: CertificateLanguage = "bilingual",
) -> Path:
    """Write ``report`` to ``target``; ``bundles`` are the recordings it was made of.

    Raises MachineError where the file cannot be written.
    """
    return report_pdf(
        _said(report.title, language),
        report_blocks(report, language),
        target,
        source=text_of(printable(plain(", ".join(path.resolve().name for path in bundles)))),
        software=software,
        language=language,
    )


def report_blocks(report: reports.Report, language: CertificateLanguage) -> Iterator[Block]:
    """In the order in which a person reads: what stands against the numbers, the numbers, charts, notes."""
    for what in report.warnings:
        text, mark = _said(what, language), label(wording.ANALYSIS_WARNING, language)
        yield Paragraph(
            Label(
                joined(bold(mark.main), text.main),
                joined(bold(mark.second), text.second) if text.second else (),
            ),
            size=8.5,
        )
    for table in report.tables:
        yield Heading(_said(table.title, language), level=2)
        yield _table(table, language)
    for chart in report.charts:
        yield Heading(_said(chart.title, language), level=2)
        yield _chart(chart, language)
    for note in report.notes:
        yield Paragraph(_said(note, language))


def _said(text: reports.Cell, language: CertificateLanguage) -> Label:
    """A report is not refused for a character of a file's name that the fonts lack."""
    if isinstance(text, Message):
        found = label(Words(readable(text.text("zh")), readable(text.text("en"))), language)
        return Label(printable(found.main), printable(found.second))
    return Label(printable(markup(readable(text))))


def _table(table: reports.Table, language: CertificateLanguage) -> Table:
    columns = tuple(
        Column(_said(head, language), align="right" if numbers else "left")
        for head, numbers in zip(table.head, number_columns(table), strict=True)
    )
    rows = tuple(tuple(_said(cell, language) for cell in row) for row in table.rows)
    return Table(columns, rows)


def _chart(chart: reports.Chart, language: CertificateLanguage) -> LineChart:
    return LineChart(
        tuple(_line(curve, language, log_x=chart.log_x) for curve in chart.curves),
        _said(chart.x_label, language),
        _said(chart.y_label, language),
        marks=tuple((mark.x, _said(mark.label, language)) for mark in chart.marks if math.isfinite(mark.x)),
        log_x=chart.log_x,
        log_y=chart.log_y,
        equal=chart.equal,
    )


def _line(curve: reports.Curve, language: CertificateLanguage, *, log_x: bool) -> Line:
    drawn = thinned(curve, _PLACES, log_x=log_x)
    line = Line(
        _said(drawn.label, language),
        tuple(zip(np.asarray(drawn.x).tolist(), np.asarray(drawn.y).tolist(), strict=True)),
        axis=drawn.axis,
        style=drawn.style,
    )
    if drawn.low is None or drawn.high is None:
        return line
    return replace(
        line, low=tuple(np.asarray(drawn.low).tolist()), high=tuple(np.asarray(drawn.high).tolist())
    )
