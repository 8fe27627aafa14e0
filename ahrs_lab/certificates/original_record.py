"""The original record (原始记录): what was measured, as measured: the rate table of 7.1, tables 2 and 3,
order, times, people, environment, warnings, and the fingerprint of the recording it all comes from.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.content import conditions_fields, standards_blocks
from ahrs_lab.certificates.diagnosis_section import diagnosis_section
from ahrs_lab.certificates.documents import (
    Block,
    Column,
    Document,
    Heading,
    Label,
    Paragraph,
    Table,
    Words,
    same,
)
from ahrs_lab.certificates.imu_record import imu_record
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.layout import write_document
from ahrs_lab.certificates.record_parts import (
    column_figures,
    figure,
    marked,
    record_course,
    record_frame,
    record_front,
    record_plan,
    short,
    started_column,
)
from ahrs_lab.certificates.result_tables import AXES, ResultWriter, unit_text
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol, text_of
from ahrs_lab.certificates.uncertainty_statement import symbols_of
from ahrs_lab.metrology.budgets import budgets_of
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.result import (
    MISALIGNMENT_KEYS,
    AxisName,
    CalibrationResult,
    MisalignmentResult,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.rounding import format_grouped

_NO_DIFFERENCE = 9999.0
"""Degrees of freedom from which k is that of the normal distribution to four digits."""


def original_record_pdf(
    result: CalibrationResult | ImuResult,
    target: Path,
    job: JobSheet | None = None,
    language: CertificateLanguage = "bilingual",
) -> Path:
    """Write the original record; without ``job`` what the recording itself says of device and people.

    Raises:
        InputError: a character that cannot be printed.
        MachineError: the file cannot be written.
    """
    if isinstance(result, ImuResult):
        return write_document(imu_record(result, job, language), target)
    return write_document(original_record(result, job, language), target)


def original_record(
    result: CalibrationResult, job: JobSheet | None, language: CertificateLanguage
) -> Document:
    """The contents of the original record."""
    writer = ResultWriter(language, job.rounding if job else "half-even")
    return Document(
        frame=record_frame(result, job, language, wording.RECORD_TITLE),
        front=tuple(record_front(result, job, language, conditions_fields(result, language))),
        signatures=(),
        pages=(
            (
                *(standards_blocks(job.standards, writer) if job and job.standards else ()),
                *_measured(result, writer),
                *_full_results(result, writer),
                *diagnosis_section(result, language),
                *record_course(result, language),
                *record_plan(result, language),
            ),
        ),
    )


# ── as measured ──────────────────────────────────────────────────────────────────────────────────────────


def _measured(result: CalibrationResult, writer: ResultWriter) -> Iterator[Block]:
    if result.scale_factor:
        yield Heading(writer.words(wording.SCALE_FACTOR), "1")
    for axis in AXES:
        if axis in result.scale_factor:
            one = result.scale_factor[axis]
            # at rest before and after; where it was recorded more often, which is which is not kept
            at_rates = one.segments[1:-1] if len(one.segments) == len(one.means) + 2 else ()
            yield from _with_starts(_rates(one, writer), result, at_rates, writer)
    if result.zero_offset:
        yield Heading(writer.words(wording.ZERO_OFFSET), "2")
    for axis in AXES:
        if axis in result.zero_offset:
            offset = result.zero_offset[axis]
            yield from _with_starts(_table_2(offset, writer), result, offset.segments, writer)
    if result.misalignment:
        yield Heading(writer.words(wording.MISALIGNMENT), "3")
    for axis in AXES:
        turned = [
            result.misalignment[k] for k in MISALIGNMENT_KEYS if k in result.misalignment and k[1] == axis
        ]
        if turned:
            yield from _with_starts(_table_3(axis, turned, writer), result, turned[0].segments, writer)


def _with_starts(
    blocks: Iterator[Block], result: CalibrationResult, segments: tuple[str, ...], writer: ResultWriter
) -> Iterator[Block]:
    """The table among ``blocks`` with the time at which each row's segment began, where each row has one."""
    found = started_column(result, segments, writer.language)
    for block in blocks:
        if found is not None and isinstance(block, Table) and len(block.rows) == len(segments):
            column, cells = found
            rows = tuple((*row, cell) for row, cell in zip(block.rows, cells, strict=True))
            yield replace(block, columns=(*block.columns, column), rows=rows)
        else:
            yield block


def _titled(words: Words, writer: ResultWriter) -> Heading:
    return Heading(writer.words(words), level=2)


def _rates(result: ScaleFactorResult, writer: ResultWriter) -> Iterator[Block]:
    """The rate table of 7.1 in the order run, statics and fit below."""
    output = unit_text("deg/s" if result.unit == "1" else result.unit.split("/(deg/s)")[0].strip("()"))
    static = 0.5 * (result.static_before + result.static_after)
    columns = (
        Column(writer.words(wording.RAW_ORDER)),
        writer.column(wording.RAW_DEMANDED, "°/s"),
        writer.column(wording.RAW_USED, "°/s"),
        writer.column(wording.RAW_MEAN, output),
        writer.column(wording.RAW_OUTPUT, output),
        writer.column(wording.RAW_RESIDUAL, output),
    )
    figures = (
        [plain(str(number)) for number in range(1, len(result.means) + 1)],
        [plain(format_grouped(f"{demanded:g}")) for demanded in result.demanded_rates_dps],
        column_figures(result.rates_dps),
        column_figures(result.means),
        column_figures([mean - static for mean in result.means]),
        column_figures(result.residuals),
    )
    rows = tuple(tuple(Label(cell) for cell in row) for row in zip(*figures, strict=True))
    yield _titled(wording.RAW_RATES.filled(axis=result.axis.upper()), writer)
    yield Table(columns, rows, size=8.0, kept=True)
    values = {
        "before": result.static_before,
        "after": result.static_after,
        "mean": static,
        "K": result.K,
        "F0": result.F0,
    }
    texts = {key: marked(figure(value)) for key, value in values.items()}
    words = wording.STATICS.filled(**texts, unit=text_of(unit_text(result.unit)), output=text_of(output))
    yield Paragraph(writer.words(words), together=True)


def _table_2(result: ZeroOffsetResult, writer: ResultWriter) -> Iterator[Block]:
    """Table 2: where each axis points at each position, and what the output accumulated."""
    axis, index = result.axis.upper(), result.axis
    count = len(result.angles_deg)
    pointing = result.orientations if len(result.orientations) == count else ()
    azimuths = result.azimuths_deg if len(result.azimuths_deg) == count else ()
    durations = result.durations_s if len(result.durations_s) == count else (result.duration_s,) * count
    columns = [Column(writer.words(wording.POSITION))]
    if pointing:
        columns += [Column(writer.words(wording.POINTING.filled(axis=one))) for one in "XYZ"]
    if azimuths:
        columns.append(writer.column(wording.AZIMUTH, "°"))
    columns += [
        writer.column(wording.RAW_DWELL, "s"),
        writer.column(wording.RAW_ANGLE.filled(axis=axis, index=index), "°"),
    ]
    rows = []
    for i, angle in enumerate(column_figures(result.angles_deg)):
        row = [same(str(i + 1))]
        if pointing:
            row += [_direction(letter, writer) for letter in pointing[i].upper()[:3].ljust(3, "?")]
        if azimuths:
            row.append(same(format_grouped(f"{azimuths[i]:.10g}")))
        row += [
            same(format_grouped(f"{durations[i]:.10g}")),
            Label(joined(symbol("N", f"{index}{i + 1}"), " = ", angle)),
        ]
        rows.append(tuple(row))
    title = wording.MULTI_POSITION if result.schedule == "multi-position" else wording.TABLE_2
    yield _titled(title.filled(axis=axis), writer)
    yield Table(tuple(columns), tuple(rows), size=8.0, kept=True)
    words = wording.OFFSET_LINE.filled(axis=index, value=marked(figure(result.B)))
    yield Paragraph(writer.words(words), together=True)


def _direction(letter: str, writer: ResultWriter) -> Label:
    words = wording.ORIENTATION_WORDS.get(letter)
    return writer.words(words) if words is not None else same(letter)


def _table_3(axis: AxisName, turned: list[MisalignmentResult], writer: ResultWriter) -> Iterator[Block]:
    """Table 3: the outputs of the two other axes after the turns of both senses."""
    columns = (
        Column(writer.words(wording.TURNED)),
        writer.column(wording.TURN_RATE, "°/s"),
        writer.column(wording.TURN_COUNT),
        writer.column(wording.RAW_DWELL, "s"),
        *(
            writer.column(
                wording.CROSS_OUTPUT.filled(axis=one.output_axis.upper(), index=one.output_axis + axis), "°"
            )
            for one in turned
        ),
    )
    first = turned[0]
    rows = tuple(
        (
            Label(joined(axis.upper(), (Run(sign, "sup"),))),
            same(format_grouped(f"{first.rate_dps:g}")),
            same(str(first.turns)),
            same(format_grouped(f"{first.duration_s:.10g}")),
            *(
                Label(figure(one.angle_positive_deg if sign == "+" else one.angle_negative_deg))
                for one in turned
            ),
        )
        for sign in ("+", "−")
    )
    yield _titled(wording.TABLE_3.filled(axis=axis.upper()), writer)
    yield Table(columns, rows, size=8.0, kept=True)
    parts: list[RichText | str] = []
    for one in turned:
        parts += [symbol("L", one.output_axis + axis), " = ", figure(one.L), " rad    "]
    yield Paragraph(Label(joined(*parts)))


# ── results and course of the run ────────────────────────────────────────────────────────────────────────


def _full_results(result: CalibrationResult, writer: ResultWriter) -> Iterator[Block]:
    columns = (
        Column(writer.words(wording.QUANTITY)),
        writer.column(wording.VALUE, strong=True),
        Column(Label(()), plain("")),
        writer.column(wording.STANDARD_UNCERTAINTY),
        writer.column(wording.EXPANDED),
        writer.column(wording.COVERAGE),
        writer.column(wording.DOF),
    )
    rows = tuple(_full_rows(result))
    yield Heading(writer.words(wording.FULL_RESULTS))
    yield Table(columns, rows, size=8.0)
    widened = [one for one in budgets_of(result) if one.letter != "F0" and one.uncertainty.from_monte_carlo]
    if widened:
        keys, note = symbols_of(widened), wording.NOTE_MONTE_CARLO
        said = Words(f"{keys}：{note.zh}", f"{keys}: {note.en}")
        yield Paragraph(writer.words(said), size=7.0)


def _full_rows(result: CalibrationResult) -> Iterator[tuple[Label, ...]]:
    def row(name: RichText, value: float, unit: str, uncertainty: Uncertainty) -> tuple[Label, ...]:
        dof = "∞" if uncertainty.dof > _NO_DIFFERENCE else f"{uncertainty.dof:.1f}"
        return (
            Label(name),
            Label(figure(value)),
            Label(unit_text(unit)),
            Label(short(uncertainty.standard)),
            Label(short(uncertainty.expanded)),
            same(f"{uncertainty.coverage_factor:.3f}"),
            same(dof),
        )

    for axis in AXES:
        if axis in result.scale_factor:
            one = result.scale_factor[axis]
            yield row(symbol("K", axis), one.K, one.unit, one.uncertainty)
    for axis in AXES:
        if axis in result.zero_offset:
            offset = result.zero_offset[axis]
            yield row(symbol("B", axis), offset.B, offset.unit, offset.uncertainty)
    for key in MISALIGNMENT_KEYS:
        if key in result.misalignment:
            angle = result.misalignment[key]
            yield row(symbol("L", key), angle.L, angle.unit, angle.uncertainty)
