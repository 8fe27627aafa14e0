"""What a certificate says: a pure function of result, job sheet and language.

Contains clause 8 a) to l) and annex C of JJF 1536-2015. All numbers are rounded here; the layout only
places them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from pathlib import Path
from typing import Any

from ahrs_lab.certificates import conformity_wording, wording
from ahrs_lab.certificates.budget_annex import budget_annex
from ahrs_lab.certificates.charts import position_blocks, residual_blocks
from ahrs_lab.certificates.clause_6 import clause_6_fields, violations_of
from ahrs_lab.certificates.conformity_tables import conformity_blocks
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
    SignatureBox,
    Table,
    Words,
    both,
    label,
    same,
    spoken,
)
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet, Party, Person
from ahrs_lab.certificates.result_tables import (
    AXES,
    DASH,
    PER_HOUR,
    ResultWriter,
    budget_table,
    certificates_of,
    linearity_table,
    methods_of,
    misalignment_table,
    scale_factor_table,
    zero_offset_table,
)
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol
from ahrs_lab.certificates.uncertainty_statement import run_on, uncertainty_statement, widened_quantities
from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import reported
from ahrs_lab.metrology.conditions import Standard
from ahrs_lab.metrology.conformity import assess
from ahrs_lab.metrology.figures_json import noted_capability, stated_figures
from ahrs_lab.metrology.recorded_days import is_recorded_on, recorded_days
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, CalibrationResult, Environment, Reported, Uncertainty
from ahrs_lab.metrology.rounding import format_grouped
from ahrs_lab.resource_files import resource_path

CertificateContent = Document

_MOST_REMARKS = 12
_RELATIVE = re.compile(r"U_?rel\b")


def certificate_content(
    result: CalibrationResult, job: JobSheet, language: CertificateLanguage = "bilingual"
) -> CertificateContent:
    """All of a certificate, in the order of clause 8 and annex C.

    Raises:
        InputError: the result is empty, or it belongs to another device or method than the job says (a
            demonstration says so in its remarks instead); its limits cannot be judged, or a unit asked for
            does not fit it.
    """
    if not (result.scale_factor or result.zero_offset or result.misalignment):
        raise InputError("The result holds no scale factor, zero offset or misalignment: nothing to certify")
    mismatches = mismatches_of(result, job)
    if mismatches and not is_demonstration(result, job):
        raise InputError(
            "{mismatch} Correct the job sheet, or evaluate the right recording again with it.",
            mismatch=mismatches[0],
        )
    asked = job.requirements
    _check_units(result, job)
    _check_repeatability(result, job)
    shown = reported(result, job.best_capability)
    conformity = assess(shown.result, asked.limits, asked.rule)
    mark = _raised_mark(result)
    writer = ResultWriter(
        language,
        job.rounding,
        asked.units,
        shown.raised,
        raised_mark=str(mark),
        widened=widened_quantities(shown.result),
        widened_mark=str(mark + 1 if shown.raised else mark),
    )
    return Document(
        frame=document_frame(result, job, language, wording.TITLE),
        front=front_fields(result, job, language),
        signatures=signature_boxes(job, language),
        pages=(
            (
                *standards_blocks(job.standards, writer),
                *_results(shown.result, writer),
                *_footnotes(result, writer),
                *(conformity_blocks(conformity, shown.result, writer) if conformity else ()),
                *_methods(result, shown.result, job, mismatches, language),
            ),
            _annex(result, writer),
            *((budget_annex(result, writer),) if job.budget_annex else ()),
        ),
        seal=seal_of(result, job),
    )


def _check_repeatability(result: CalibrationResult, job: JobSheet) -> None:
    """U of B is what the job asks for: with the repeatability, or without."""
    asked = job.requirements.repeatability
    known = [one for one in result.zero_offset.values() if one.repeatability_dps is not None]
    if not any(one.repeatability_included is not asked for one in known):
        return
    if asked:
        raise InputError(
            "The job asks for U of B with the repeatability, and the result has it without: evaluate the "
            "recording again with this job, by the GUM method."
        )
    raise InputError(
        "The result's U of B includes the repeatability, which this job does not ask for: evaluate the "
        "recording again with this job."
    )


def seal_of(result: Reported, job: JobSheet) -> Path | None:
    """The laboratory's seal; a demonstration has one of its own, a real certificate never carries that."""
    if job.seal is None and is_demonstration(result, job):
        return resource_path("seal/demo-seal.png")
    return job.seal


def is_demonstration(result: Reported, job: JobSheet) -> bool:
    """Whether the document has to say that it is no valid certificate."""
    return job.demonstration or result.simulated


def mismatches_of(result: CalibrationResult, job: JobSheet) -> tuple[Message, ...]:
    """:func:`found_mismatches` of a result by JJF 1536."""
    return found_mismatches(result, job, methods_of(result))


def found_mismatches(
    result: Reported, job: JobSheet, methods: AbstractSet[str] = frozenset()
) -> tuple[Message, ...]:
    """Where result and job sheet are not of the same device, day, method or figures of the standards; the
    facts alone, as a certificate remarks on them. ``methods``: by which the uncertainties were evaluated,
    where there is a choice."""
    found: list[Message] = []
    serial = str(result.device.get("serial_number", "")).strip()
    if serial and serial != job.device.serial_number:
        found.append(
            Message(
                "The result is of the device with serial number {found}, the job sheet is for {wanted}.",
                found=serial,
                wanted=job.device.serial_number,
            )
        )
    days = recorded_days(result.notes)
    if days is not None and not is_recorded_on(result.notes, job.calibrated):
        found.append(
            Message(
                "The recording was made on {days} (UTC), the date of calibration is given as {calibrated}.",
                days=" – ".join(dict.fromkeys(day.isoformat() for day in days)),
                calibrated=job.calibrated.isoformat(),
            )
        )
    if methods and methods != {job.uncertainty_method}:
        found.append(
            Message(
                "The job asks for uncertainty by {wanted}, the result was evaluated by {found}.",
                wanted=job.uncertainty_method,
                found=", ".join(sorted(methods)),
            )
        )
    if set(stated_figures(noted_capability(result.notes))) != set(stated_figures(job.capability)):
        found.append(
            Message(
                "The result was evaluated with other figures of the standards than the job's certificates "
                "state."
            )
        )
    return tuple(found)


# ── every page ───────────────────────────────────────────────────────────────────────────────────────────


def party_name(party: Party, language: CertificateLanguage) -> Label:
    """A laboratory's or customer's name in the scripts that exist."""
    return both(party.name, party.name_en, language)


def document_frame(
    result: Reported, job: JobSheet, language: CertificateLanguage, title: Words
) -> DocumentFrame:
    """Header, footer, banner and what the file says of itself."""
    in_english = language == "en"
    return DocumentFrame(
        laboratory=party_name(job.laboratory, language),
        laboratory_address=both(job.laboratory.address, job.laboratory.address_en, language),
        number_label=label(wording.CERTIFICATE_NUMBER, language),
        number=plain(job.certificate_number, bold=True),
        page_of=wording.PAGE_OF,
        language=language,
        footer=label(wording.FOOTER, language),
        banner=label(wording.DEMONSTRATION, language) if is_demonstration(result, job) else None,
        title=label(title, language),
        file_title=f"{title.en if in_english else title.zh} {job.certificate_number}",
        file_subject=f"{job.device.name} {job.device.model} {job.device.serial_number}",
    )


# ── front page ───────────────────────────────────────────────────────────────────────────────────────────


def front_fields(
    result: Reported, job: JobSheet, language: CertificateLanguage, procedure: Label | None = None
) -> tuple[Block, ...]:
    """Clause 8 e), f), g), i) and k)'s date; ``procedure`` in place of the job's."""

    def line(words: Words, value: Label) -> Field:
        return Field(label(words, language), value)

    issued = same(job.issued.isoformat()) if job.issued else label(wording.ISSUED_BY_SIGNATURE, language)
    return (
        Fields(
            (
                line(wording.CUSTOMER, party_name(job.customer, language)),
                line(wording.ADDRESS, both(job.customer.address, job.customer.address_en, language)),
            )
        ),
        Fields(
            (
                line(wording.DEVICE, both(job.device.name, job.device.name_en, language)),
                line(wording.MANUFACTURER, same(job.device.manufacturer)),
                line(wording.MODEL, same(job.device.model)),
                line(wording.SERIAL, same(job.device.serial_number)),
            )
        ),
        Fields(
            (
                line(wording.RECEIVED, same(job.received.isoformat())),
                line(wording.CALIBRATED, same(job.calibrated.isoformat())),
                line(wording.ISSUED, issued),
                line(
                    wording.INTERVAL,
                    label(wording.MONTHS.filled(months=job.recalibration_months), language),
                ),
            )
        ),
        Fields(
            (
                line(wording.PROCEDURE, procedure or both(job.procedure, job.procedure_en, language)),
                line(wording.PLACE, both(job.place, job.place_en, language) if job.place else same(DASH)),
                line(wording.ENVIRONMENT, environment_text(result.environment, language)),
                *clause_6_fields(result, job, language),
            )
        ),
    )


def environment_text(environment: Environment | None, language: CertificateLanguage) -> Label:
    """Mean ± half the spread over the run; the spread is rounded up."""
    if environment is None:
        return label(wording.NOT_RECORDED, language)
    spread = _spread(environment.temperature_c, environment.temperature_spread_c, 1)
    humid = _spread(environment.humidity_percent, environment.humidity_spread_percent, 0)
    words = wording.ENVIRONMENT_VALUE.filled(
        temperature=f"{format_grouped(f'{environment.temperature_c:.1f}')} ± {spread}",
        humidity=f"{environment.humidity_percent:.0f} ± {humid}",
    )
    return label(words, language)


def _spread(mean: float, half: float, decimals: int) -> str:
    """The spread about the mean as printed that holds all that was measured."""
    printed = float(f"{mean:.{decimals}f}")
    beyond = max(mean + half - printed, printed - (mean - half))
    step = 10**decimals
    return f"{math.ceil(beyond * step - 1e-6) / step:.{decimals}f}"


def person_label(person: Person, language: CertificateLanguage) -> tuple[Label, Label]:
    """Name and position of one who signs."""
    return both(person.name, person.name_en, language), both(person.position, person.position_en, language)


def signature_boxes(job: JobSheet, language: CertificateLanguage) -> tuple[SignatureBox, ...]:
    """The three who sign."""
    return (
        SignatureBox("operator", label(wording.OPERATOR, language), *person_label(job.operator, language)),
        SignatureBox("verifier", label(wording.VERIFIER, language), *person_label(job.verifier, language)),
        SignatureBox("approver", label(wording.APPROVER, language), *person_label(job.approver, language)),
    )


# ── results ──────────────────────────────────────────────────────────────────────────────────────────────


def standards_blocks(standards: Iterable[Standard], writer: ResultWriter) -> tuple[Block, ...]:
    """Clause 8 h)."""
    heading = Heading(writer.words(wording.STANDARDS))
    rows = tuple(
        (
            both(one.name_zh, one.name, writer.language),
            same(" ".join(part for part in (one.manufacturer, one.model) if part) or DASH),
            same(one.serial_number),
            _accuracy(one, writer.language),
            same(one.certificate_number),
            same(one.due.isoformat() if one.due else DASH),
        )
        for one in standards
    )
    if not rows:
        return (heading, Paragraph(writer.words(wording.NO_STANDARDS)))
    columns = (
        wording.STANDARD_NAME,
        wording.STANDARD_MODEL,
        wording.STANDARD_SERIAL,
        wording.STANDARD_ACCURACY,
        wording.STANDARD_CERTIFICATE,
        wording.STANDARD_DUE,
    )
    return (heading, Table(tuple(Column(writer.words(words)) for words in columns), rows))


def _accuracy(standard: Standard, language: CertificateLanguage) -> Label:
    """``U_rel`` and ``10^{−4}`` as they are written by hand."""
    zh, en = (_RELATIVE.sub("U_{rel}", text) for text in (standard.accuracy_zh, standard.accuracy))
    return label(Words(zh or en, en), language)


def _results(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    """Annex C."""
    return (
        Heading(writer.words(wording.RESULTS)),
        Heading(writer.words(wording.SCALE_FACTOR), "1"),
        scale_factor_table(result.scale_factor, writer),
        Heading(writer.words(wording.ZERO_OFFSET), "2"),
        zero_offset_table(result.zero_offset, writer),
        Heading(writer.words(wording.MISALIGNMENT), "3"),
        misalignment_table(result.misalignment, writer),
    )


def _check_units(result: CalibrationResult, job: JobSheet) -> None:
    own = {one.unit for one in result.scale_factor.values()} - {"1", "(deg/s)/(deg/s)"}
    if job.requirements.units.scale_factor == "ppm" and own:
        raise InputError(
            "The scale factor is in {unit}: only a dimensionless one can be given in ppm.",
            unit=", ".join(sorted(own)),
        )


def _raised_mark(result: CalibrationResult) -> int:
    """After the four notes on the print and those on the methods."""
    return 5 + len(methods_of(result))


def _footnotes(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    ratio = conformity_wording.RATIO_IN_ONE_UNIT if writer.units.misalignment else wording.NOTE_RATIO
    notes = [wording.NOTE_SYMBOLS, wording.NOTE_DIVISORS, ratio, wording.NOTE_PRODUCT]
    methods = methods_of(result)
    if "gum" in methods:
        notes.append(wording.NOTE_SENSITIVITY)
    if "annex-a" in methods:
        notes.append(wording.NOTE_ANNEX_A)
    if writer.raised:
        notes.append(conformity_wording.RAISED)
    if writer.widened:
        notes.append(wording.NOTE_MONTE_CARLO)
    return tuple(
        Paragraph(writer.words(note), str(mark), size=7.0, together=True, kept=mark < len(notes))
        for mark, note in enumerate(notes, 1)
    )


# ── methods ──────────────────────────────────────────────────────────────────────────────────────────────


def _methods(
    result: CalibrationResult,
    shown: CalibrationResult,
    job: JobSheet,
    mismatches: tuple[Message, ...],
    language: CertificateLanguage,
) -> tuple[Block, ...]:
    blocks: list[Block] = [Heading(label(wording.UNCERTAINTY, language))]
    statements = uncertainty_statement(result, shown, job, demonstration=is_demonstration(result, job))
    blocks += [
        Paragraph(label(words, language), together=True, kept=number < len(statements))
        for number, words in enumerate(statements, 1)
    ]
    blocks += [
        Heading(label(wording.CONDITIONS, language)),
        Fields(conditions_fields(result, language), ruled=False),
    ]
    blocks.append(Heading(label(wording.DEVIATIONS, language)))
    deviations = [spoken(message, language) for message in result.deviations]
    deviations += [spoken(message, language) for message in violations_of(result, job)]
    deviations += [same(text) for text in job.accepted_violations]
    blocks += [Paragraph(text, together=True) for text in deviations] or [
        Paragraph(label(wording.NO_DEVIATIONS, language), together=True)
    ]
    use = [wording.USE_TEXT]
    if result.device.get("rate_unit") != "LSB":  # counts are scaled by K before B and L are formed
        use.append(wording.USE_AS_DELIVERED)
    blocks += [
        Heading(label(wording.USE, language)),
        Paragraph(_with_mark(label(run_on(use), language), "4"), together=True),
    ]
    remarks = [spoken(message, language) for message in mismatches]
    remarks += [same(note) for note in job.notes]
    remarks += warning_remarks(result, language)
    if remarks:
        blocks.append(Heading(label(wording.REMARKS, language)))
        blocks += [Paragraph(text, together=True) for text in remarks]
    return tuple(blocks)


def _with_mark(text: Label, mark: str) -> Label:
    return Label(joined(text.main, (Run(mark, "sup"),)), text.second)


def warning_remarks(result: Reported, language: CertificateLanguage) -> list[Label]:
    """Each kind of warning once, with its first segment; how often, and at most a dozen."""
    counted: dict[str, tuple[Label, int]] = {}
    for warning in result.warnings:
        said = spoken(warning.what, language)
        if warning.segment:
            said = Label(joined(f"{Path(warning.segment).stem}: ", said.main), said.second)
        text, count = counted.get(warning.what.text(), (said, 0))
        counted[warning.what.text()] = (text, count + 1)
    texts = [
        Label(joined(text.main, f" (×{count})"), text.second) if count > 1 else text
        for text, count in counted.values()
    ]
    if len(texts) > _MOST_REMARKS:
        more = wording.MORE_REMARKS.filled(count=len(texts) - _MOST_REMARKS)
        return [*texts[:_MOST_REMARKS], label(more, language)]
    return texts


def conditions_fields(result: CalibrationResult, language: CertificateLanguage) -> tuple[Field, ...]:
    """Rates, schedule, T, turns, site, recording: what was done, by name."""
    fields: list[Field] = [Field(label(wording.AXES_TIED, language), label(wording.AXES_VALUE, language))]

    def add(words: Words, value: Label) -> None:
        fields.append(Field(label(words, language), value))

    by_rates: dict[str, list[str]] = {}
    for axis in AXES:
        if axis in result.scale_factor:
            by_rates.setdefault(rates_text(result.scale_factor[axis].demanded_rates_dps), []).append(
                axis.upper()
            )
    for rates, axes in by_rates.items():
        add(wording.RATES, same(rates if len(by_rates) == 1 else f"{', '.join(axes)}: {rates}"))
    if result.scale_factor:
        sources = {one.rate_source for one in result.scale_factor.values()}
        add(
            wording.RATE_SOURCE,
            label(wording.RATE_TABLE if "table" in sources else wording.RATE_DEMANDED, language),
        )
    schedules: dict[str, list[str]] = {}
    for axis in (axis for axis in AXES if axis in result.zero_offset):
        schedules.setdefault(result.zero_offset[axis].schedule, []).append(axis.upper())
    for schedule, of_axes in schedules.items():
        words = wording.SCHEDULES[schedule]
        if len(schedules) > 1:
            named = ", ".join(of_axes)
            words = Words(
                wording.SCHEDULE_OF_AXES.zh.format(axes=named, schedule=words.zh),
                wording.SCHEDULE_OF_AXES.en.format(axes=named, schedule=words.en),
            )
        add(wording.ZERO_OFFSET_SCHEDULE, label(words, language))
    dwells = sorted({one.duration_s for one in result.zero_offset.values()})
    if dwells:
        add(wording.DWELL, same(", ".join(f"{format_grouped(f'{dwell:.10g}')} s" for dwell in dwells)))
    for turns, rate in sorted({(one.turns, one.rate_dps) for one in result.misalignment.values()}):
        add(wording.TURNS, label(wording.TURNS_VALUE.filled(turns=turns, rate=f"{rate:g}"), language))
    add_measured(result.device, result.site, language, fields)
    add(wording.RECORDING, same(result.bundle_sha256 or DASH))
    add(wording.SOFTWARE, same(result.software))
    return tuple(fields)


def add_measured(
    device: Mapping[str, Any], site: Mapping[str, Any], language: CertificateLanguage, fields: list[Field]
) -> None:
    """Sampling rate and latitude, where the recording says them."""
    rate, latitude = device.get("sample_rate_hz"), site.get("latitude_deg")
    if isinstance(rate, (int, float)):
        fields.append(Field(label(wording.SAMPLE_RATE, language), same(f"{rate:g} Hz")))
    if isinstance(latitude, (int, float)):
        value = wording.LATITUDE.filled(latitude=format_grouped(f"{latitude:.4f}"))
        fields.append(Field(label(wording.SITE, language), label(value, language)))


def rates_text(rates: Iterable[float]) -> str:
    """``±10, ±50, ±300 °/s`` where all come in pairs, else each with its sign."""
    known = sorted(set(rates))
    if all(-rate in known for rate in known):
        return ", ".join(f"±{rate:g}" for rate in known if rate > 0) + " °/s"
    return ", ".join(format_grouped(f"{rate:g}") for rate in known) + " °/s"


# ── annex ────────────────────────────────────────────────────────────────────────────────────────────────


def _annex(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    language = writer.language
    return (
        Heading(label(wording.ANNEX, language)),
        *residual_blocks(result, language),
        *_linearity(result, writer),
        *position_blocks(result, language),
        *_budgets(result, writer),
    )


def _linearity(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    if not result.scale_factor:
        return ()
    return (
        Heading(writer.words(wording.LINEARITY), level=2),
        linearity_table(result.scale_factor, writer),
        Paragraph(writer.words(wording.LINEARITY_NOTE), size=7.0, together=True),
    )


def _budgets(result: CalibrationResult, writer: ResultWriter) -> tuple[Block, ...]:
    """One table a kind of quantity: K in 10⁻⁶ of K, B in °/h, L in 10⁻⁶ rad."""
    million = (Run("10"), Run("−6", "sup"))
    marks = certificates_of(result)
    angles = [key for key in MISALIGNMENT_KEYS if key in result.misalignment]
    blocks: list[Block] = []
    kinds: list[
        tuple[Words, dict[str, Uncertainty], dict[str, tuple[RichText, RichText]], dict[str, float]]
    ] = [
        (
            wording.SCALE_FACTOR,
            {a: r.uncertainty for a, r in result.scale_factor.items()},
            {a: (joined("u/", symbol("K", a)), million) for a in result.scale_factor},
            {a: 1e6 / abs(r.K) if r.K else 1e6 for a, r in result.scale_factor.items()},
        ),
        (
            wording.ZERO_OFFSET,
            {a: r.uncertainty for a, r in result.zero_offset.items()},
            {a: (symbol("B", a), plain("°/h")) for a in result.zero_offset},
            dict.fromkeys(result.zero_offset, PER_HOUR),
        ),
        (
            wording.MISALIGNMENT,
            {k: result.misalignment[k].uncertainty for k in angles},
            {k: (symbol("L", k), joined(million, " rad")) for k in angles},
            dict.fromkeys(angles, 1e6),
        ),
    ]
    for words, uncertainties, names, factors in kinds:
        if uncertainties:
            note = () if blocks else (_budget_note(marks, writer.language),)
            table = budget_table(names, uncertainties, factors, marks, writer)
            blocks += [_budget_heading(words, writer), *note, table]
    return tuple(blocks)


def _budget_note(marks: Mapping[str, str], language: CertificateLanguage) -> Paragraph:
    """What the columns are and where the bench's figures come from; before the first table, so that it never
    stands alone on a page."""
    note = [wording.BUDGET_NOTE]
    if marks:
        named = "; ".join(f"^{{{mark})}} {number}" for number, mark in marks.items())
        note.append(wording.BUDGET_CERTIFICATES.filled(numbers=named))
    return Paragraph(label(run_on(note), language), size=7.0, together=True, kept=True)


def _budget_heading(kind: Words, writer: ResultWriter) -> Heading:
    words = Words(f"{wording.BUDGET.zh}：{kind.zh}", f"{wording.BUDGET.en}: {kind.en.lower()}")
    return Heading(label(words, writer.language), level=2)
