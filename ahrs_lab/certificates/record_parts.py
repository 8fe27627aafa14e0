"""What the original records of every procedure share: frame, front, numbers as computed, the course of
the run and its plan."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.clause_6 import clause_6_fields, place_field
from ahrs_lab.certificates.content import environment_text, is_demonstration, party_name, person_label
from ahrs_lab.certificates.documents import (
    EMPTY,
    Block,
    Column,
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
from ahrs_lab.certificates.result_tables import DASH
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain
from ahrs_lab.metrology.plan_labels import PLAN_LABELS, PLAN_VALUES
from ahrs_lab.metrology.result import Reported
from ahrs_lab.metrology.rounding import format_grouped

_DIGITS = 10
_MOST_SETTINGS = 200
_STARTS_ABREAST = 3
_NUMBER = re.compile(r"-?\d+(\.\d+)?")


def record_frame(
    result: Reported, job: JobSheet | None, language: CertificateLanguage, title: Words
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


def record_front(
    result: Reported, job: JobSheet | None, language: CertificateLanguage, conditions: tuple[Field, ...]
) -> Iterator[Block]:
    """Device or job, when and where, people, and the ``conditions`` of the procedure."""

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
    yield Fields(conditions)


def _when_and_where(result: Reported, job: JobSheet | None, language: CertificateLanguage) -> Iterator[Field]:
    notes = result.notes
    if job is not None:
        yield Field(label(wording.RECEIVED, language), same(job.received.isoformat()))
        yield Field(label(wording.CALIBRATED, language), same(job.calibrated.isoformat()))
    for words, key in ((wording.STARTED, "started_utc"), (wording.FINISHED, "finished_utc")):
        if notes.get(key):
            yield Field(label(words, language), same(f"{_moment(notes[key])} UTC"))
    if job is not None and job.place:
        yield Field(label(wording.PLACE, language), both(job.place, job.place_en, language))
    yield Field(label(wording.ENVIRONMENT, language), environment_text(result.environment, language))
    if job is None:
        yield place_field(result, job, language)
    else:
        yield from clause_6_fields(result, job, language)


# ── numbers ──


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


def marked(rich: RichText) -> str:
    """Back to our markup, for use inside wording."""
    return "".join(f"^{{{run.text}}}" if run.shift == "sup" else run.text for run in rich)


def short(value: float) -> RichText:
    mantissa, _, exponent = f"{value:.3e}".partition("e")
    return joined(mantissa, " × 10", (Run(format_grouped(str(int(exponent))), "sup"),))


# ── course of the run ──


def record_course(result: Reported, language: CertificateLanguage) -> Iterator[Block]:
    """Order run, what was repeated and why, deviations, warnings."""
    notes = result.notes
    order = notes.get("order_run")
    if starts := _entries(notes, "segment_starts"):
        yield Heading(label(wording.ORDER_RUN, language))
        yield _starts_table(starts, language)
    elif isinstance(order, (list, tuple)) and order:  # a result of before the times were kept
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


def _starts_table(starts: list[Mapping[str, Any]], language: CertificateLanguage) -> Table:
    """When each segment began, downward in columns side by side."""
    columns = (
        Column(label(wording.RAW_SEGMENT, language)),
        Column(label(wording.STARTED, language), plain("UTC")),
    )
    height = math.ceil(len(starts) / _STARTS_ABREAST)
    cells = [(same(str(e.get("segment", DASH))), same(_moment(e.get("started_utc", DASH)))) for e in starts]
    cells += [(EMPTY, EMPTY)] * (height * _STARTS_ABREAST - len(cells))
    rows = tuple(tuple(cell for pair in cells[row::height] for cell in pair) for row in range(height))
    return Table(columns * _STARTS_ABREAST, rows, size=8.0, whole=True)


def started_column(
    result: Reported, segments: Sequence[str], language: CertificateLanguage
) -> tuple[Column, list[Label]] | None:
    """When each of ``segments`` began, as a column of their table; None where that is not known of all."""
    starts = {str(e.get("segment")): e.get("started_utc") for e in _entries(result.notes, "segment_starts")}
    if not segments or not all(starts.get(name) for name in segments):
        return None
    column = Column(label(wording.STARTED, language), plain("UTC"), "right")
    return column, [same(_moment(starts[name])) for name in segments]


def _moment(utc: object) -> str:
    return str(utc).replace("T", " ")[:19]


def _entries(notes: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    listed = notes.get(key)
    return [one for one in listed if isinstance(one, Mapping)] if isinstance(listed, (list, tuple)) else []


def _warning_rows(result: Reported, language: CertificateLanguage) -> Iterator[tuple[Label, Label, Label]]:
    for warning in result.warnings:
        line = str(warning.line) if warning.line else DASH
        yield same(warning.segment or DASH), same(line), spoken(warning.what, language)


def record_plan(result: Reported, language: CertificateLanguage) -> Iterator[Block]:
    """Every setting by name."""
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
