"""The original record (原始记录): what was measured, as measured: the rate table of 7.1, tables 2 and 3,
order, times, people, environment, warnings, and the fingerprint of the recording it all comes from.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.content import (
    conditions_fields,
    environment_text,
    is_demonstration,
    party_name,
    person_label,
    standards_blocks,
)
from ahrs_lab.certificates.diagnosis_section import diagnosis_section
from ahrs_lab.certificates.documents import (
    Block,
    Column,
    Document,
    DocumentFrame,
    Field,
    Fields,
    Heading,
    Label,
    Paragraph,
    Table,
    Words,
    both,
    label,
    same,
    spoken,
)
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.layout import write_document
from ahrs_lab.certificates.result_tables import AXES, DASH, ResultWriter, unit_text
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol, text_of
from ahrs_lab.certificates.uncertainty_statement import symbols_of
from ahrs_lab.metrology.budgets import budgets_of
from ahrs_lab.metrology.plan_labels import PLAN_LABELS, PLAN_VALUES
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

_DIGITS = 10
_NO_DIFFERENCE = 9999.0
"""Degrees of freedom from which k is that of the normal distribution to four digits."""
_MOST_SETTINGS = 200
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


def original_record_pdf(
    result: CalibrationResult,
    target: Path,
    job: JobSheet | None = None,
    language: CertificateLanguage = "bilingual",
) -> Path:
    """Write the original record; without ``job`` what the recording itself says of device and people.

    Raises:
        InputError: a character that cannot be printed.
        MachineError: the file cannot be written.
    """
    return write_document(original_record(result, job, language), target)


def original_record(
    result: CalibrationResult, job: JobSheet | None, language: CertificateLanguage
) -> Document:
    """The contents of the original record."""
    writer = ResultWriter(language, job.rounding if job else "half-even")
    return Document(
        frame=record_frame(result, job, language, wording.RECORD_TITLE),
        front=tuple(_front(result, job, language)),
        signatures=(),
        pages=(
            (
                *(standards_blocks(job.standards, writer) if job and job.standards else ()),
                *_measured(result, writer),
                *_full_results(result, writer),
                *diagnosis_section(result, language),
                *_course(result, language),
                *_plan(result, language),
            ),
        ),
    )


def record_frame(
    result: CalibrationResult, job: JobSheet | None, language: CertificateLanguage, title: Words
) -> DocumentFrame:
    """Header and footer of what is kept in the laboratory."""
    number = job.certificate_number if job else result.bundle_sha256[:16] or DASH
    name = title.en if language == "en" else title.zh
    device = result.device
    subject = " ".join(str(device[key]) for key in ("name", "model", "serial_number") if device.get(key))
    demonstration = is_demonstration(result, job) if job else result.simulated
    return DocumentFrame(
        laboratory=party_name(job.laboratory, language) if job else same(subject or DASH),
        laboratory_address=Label(()),
        number_label=label(wording.RECORD_NUMBER, language),
        number=plain(number, bold=True),
        page_of=wording.PAGE_OF,
        language=language,
        footer=label(wording.RECORD_FOOTER, language),
        banner=label(wording.DEMONSTRATION_RECORD, language) if demonstration else None,
        title=label(title, language),
        file_title=f"{name} {number}",
        file_subject=subject,
    )


# ── front ────────────────────────────────────────────────────────────────────────────────────────────────


def _front(result: CalibrationResult, job: JobSheet | None, language: CertificateLanguage) -> Iterator[Block]:
    def line(words: Words, value: Label) -> Field:
        return Field(label(words, language), value)

    device = result.device
    if job is None:
        names = (
            (wording.DEVICE, "name"),
            (wording.MANUFACTURER, "manufacturer"),
            (wording.MODEL, "model"),
            (wording.SERIAL, "serial_number"),
        )
        yield Fields(tuple(line(words, same(str(device.get(key) or DASH))) for words, key in names))
    else:
        yield Fields(
            (
                line(wording.JOB_NUMBER, same(job.number)),
                line(wording.CUSTOMER, party_name(job.customer, language)),
                line(wording.DEVICE, both(job.device.name, job.device.name_en, language)),
                line(wording.MANUFACTURER, same(job.device.manufacturer)),
                line(wording.MODEL, same(job.device.model)),
                line(wording.SERIAL, same(job.device.serial_number)),
            )
        )
    yield Fields(tuple(_when_and_where(result, job, language)))
    if job is not None:
        people = ((wording.OPERATOR, job.operator), (wording.VERIFIER, job.verifier))
        yield Fields(tuple(line(words, person_label(person, language)[0]) for words, person in people))
    yield Fields(conditions_fields(result, language))


def _when_and_where(
    result: CalibrationResult, job: JobSheet | None, language: CertificateLanguage
) -> Iterator[Field]:
    notes = result.notes
    if job is not None:
        yield Field(label(wording.RECEIVED, language), same(job.received.isoformat()))
        yield Field(label(wording.CALIBRATED, language), same(job.calibrated.isoformat()))
    for words, key in ((wording.STARTED, "started_utc"), (wording.FINISHED, "finished_utc")):
        if notes.get(key):
            yield Field(label(words, language), same(f"{str(notes[key]).replace('T', ' ')[:19]} UTC"))
    if job is not None and job.place:
        yield Field(label(wording.PLACE, language), both(job.place, job.place_en, language))
    yield Field(label(wording.ENVIRONMENT, language), environment_text(result.environment, language))


# ── as measured ──────────────────────────────────────────────────────────────────────────────────────────


def figure(value: float) -> RichText:
    """A number as it was computed, ten digits; small ones with a power of ten."""
    text = f"{value:.{_DIGITS}g}"
    mantissa, _, exponent = text.partition("e")
    number = plain(format_grouped(mantissa))
    if not exponent:
        return number
    return joined(number, " × 10", (Run(format_grouped(str(int(exponent))), "sup"),))


def column_figures(values: Sequence[float]) -> list[RichText]:
    """Figures of one column with the same number of decimals, ten digits in the largest."""
    largest = max((abs(value) for value in values), default=0.0)
    if not 0.0 < largest < math.inf:
        return [plain("0")] * len(values)
    decimals = min(max(_DIGITS - 1 - math.floor(math.log10(largest)), 0), 15)
    return [plain(format_grouped(f"{value + 0.0:.{decimals}f}")) for value in values]


def _measured(result: CalibrationResult, writer: ResultWriter) -> Iterator[Block]:
    if result.scale_factor:
        yield Heading(writer.words(wording.SCALE_FACTOR), "1")
    for axis in AXES:
        if axis in result.scale_factor:
            yield from _rates(result.scale_factor[axis], writer)
    if result.zero_offset:
        yield Heading(writer.words(wording.ZERO_OFFSET), "2")
    for axis in AXES:
        if axis in result.zero_offset:
            yield from _table_2(result.zero_offset[axis], writer)
    if result.misalignment:
        yield Heading(writer.words(wording.MISALIGNMENT), "3")
    for axis in AXES:
        turned = [
            result.misalignment[k] for k in MISALIGNMENT_KEYS if k in result.misalignment and k[1] == axis
        ]
        if turned:
            yield from _table_3(axis, turned, writer)


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
    texts = {key: _marked(figure(value)) for key, value in values.items()}
    words = wording.STATICS.filled(**texts, unit=text_of(unit_text(result.unit)), output=text_of(output))
    yield Paragraph(writer.words(words), together=True)


def _marked(rich: RichText) -> str:
    """Back to our markup, for use inside wording."""
    return "".join(f"^{{{run.text}}}" if run.shift == "sup" else run.text for run in rich)


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
    words = wording.OFFSET_LINE.filled(axis=index, value=_marked(figure(result.B)))
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
            Label(_short(uncertainty.standard)),
            Label(_short(uncertainty.expanded)),
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


def _short(value: float) -> RichText:
    mantissa, _, exponent = f"{value:.3e}".partition("e")
    return joined(mantissa, " × 10", (Run(format_grouped(str(int(exponent))), "sup"),))


def _course(result: CalibrationResult, language: CertificateLanguage) -> Iterator[Block]:
    """Order run, what was repeated and why, deviations, warnings."""
    notes = result.notes
    order = notes.get("order_run")
    if isinstance(order, (list, tuple)) and order:
        yield Heading(label(wording.ORDER_RUN, language))
        yield Paragraph(same(", ".join(str(name) for name in order)))
    yield Heading(label(wording.REPEATED, language))
    repeated = [*_entries(notes, "repeated"), *_entries(notes, "discarded")]
    if repeated:
        columns = (Column(label(wording.RAW_SEGMENT, language)), Column(label(wording.REASON, language)))
        rows = tuple((same(str(e.get("segment", DASH))), same(str(e.get("reason", DASH)))) for e in repeated)
        yield Table(columns, rows, size=8.0)
    else:
        yield Paragraph(label(wording.NONE_REPEATED, language))
    yield Heading(label(wording.DEVIATIONS, language))
    for message in result.deviations:
        yield Paragraph(spoken(message, language))
    if not result.deviations:
        yield Paragraph(label(wording.NO_DEVIATIONS, language))
    yield Heading(label(wording.WARNINGS, language))
    warned = tuple(_warning_rows(result, language))
    if not warned:
        yield Paragraph(label(wording.NO_DEVIATIONS, language))
        return
    yield Table(
        (
            Column(label(wording.RAW_SEGMENT, language)),
            Column(label(wording.LINE, language), align="right"),
            Column(label(wording.WHAT, language)),
        ),
        warned,
        size=8.0,
    )


def _entries(notes: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    listed = notes.get(key)
    return [one for one in listed if isinstance(one, Mapping)] if isinstance(listed, (list, tuple)) else []


def _warning_rows(
    result: CalibrationResult, language: CertificateLanguage
) -> Iterator[tuple[Label, Label, Label]]:
    for warning in result.warnings:
        line = str(warning.line) if warning.line else DASH
        yield same(warning.segment or DASH), same(line), spoken(warning.what, language)


def _plan(result: CalibrationResult, language: CertificateLanguage) -> Iterator[Block]:
    plan = result.notes.get("plan")
    if not isinstance(plan, Mapping):
        return
    settings = list(_settings(plan, ""))[:_MOST_SETTINGS]
    rows = [(_setting(key, language), _setting_value(value, language)) for key, value in settings]
    yield Heading(label(wording.PLAN, language))
    yield Table(
        (Column(label(wording.SETTING, language)), Column(label(wording.SETTING_VALUE, language))),
        tuple(rows),
        size=7.5,
        whole=True,
    )


def _setting(key: str, language: CertificateLanguage) -> Label:
    """By name; a key that is none of ours as it stands."""
    return spoken(PLAN_LABELS[key], language) if key in PLAN_LABELS else same(key)


def _setting_value(values: list[str], language: CertificateLanguage) -> Label:
    names = [PLAN_VALUES.get(value) for value in values]
    if not any(names):
        return same(", ".join(format_grouped(v) if _NUMBER.fullmatch(v) else v for v in values))
    zh, en = (
        ", ".join(name.text(one) if name else value for name, value in zip(names, values, strict=True))
        for one in ("zh", "en")
    )
    return both(zh, en, language)


def _settings(table: Mapping[str, Any], prefix: str) -> Iterator[tuple[str, list[str]]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _settings(value, f"{prefix}{key}.")
        elif isinstance(value, (list, tuple)):
            yield f"{prefix}{key}", [str(one) for one in value]
        else:
            yield f"{prefix}{key}", [str(value)]
