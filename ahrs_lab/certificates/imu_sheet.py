"""The result sheet of a discrete IMU calibration: the matrices with their uncertainties, units, formula and
its direction, on a certificate that is signed like any other.

A pure function of result, job sheet and language; all numbers are rounded here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.certificates import imu_wording, wording
from ahrs_lab.certificates.clause_6 import violations_of
from ahrs_lab.certificates.content import (
    add_measured,
    document_frame,
    found_mismatches,
    front_fields,
    is_demonstration,
    seal_of,
    signature_boxes,
    standards_blocks,
    warning_remarks,
)
from ahrs_lab.certificates.documents import (
    Block,
    Column,
    Document,
    Field,
    Fields,
    Heading,
    Label,
    Paragraph,
    Table,
    Words,
    label,
    same,
    spoken,
)
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.result_tables import (
    DASH,
    PER_HOUR,
    ResultWriter,
    significant,
    unit_text,
    without_noise,
)
from ahrs_lab.certificates.richtext import RichText, Run, joined, plain, symbol
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.conditions import BenchCapability, clause6_violations
from ahrs_lab.metrology.figures_json import noted_capability
from ahrs_lab.metrology.imu_calibration import Coefficients, ImuCalibration, Quality
from ahrs_lab.metrology.imu_result import ImuDwell, ImuResult
from ahrs_lab.metrology.rounding import format_grouped, round_to_place, round_to_uncertainty

Array = NDArray[np.float64]

COVERAGE_FACTOR = 2.0
_AXES = ("x", "y", "z")
_MILLION = (Run("10"), Run("−6", "sup"))


def imu_sheet(result: ImuResult, job: JobSheet, language: CertificateLanguage = "bilingual") -> Document:
    """All of the sheet, in the order of a certificate.

    Raises:
        InputError: the result does not belong to the job (a demonstration says so in its remarks instead), or
            it has no uncertainties.
    """
    quality, combined = result.calibration.quality, result.combined
    if quality is None or combined is None:
        raise InputError(
            "The calibration set comes without uncertainties: nothing to certify. Calibrate from a recording."
        )
    mismatches = found_mismatches(result, job)
    if mismatches and not is_demonstration(result, job):
        raise InputError(
            "{mismatch} Correct the job sheet, or evaluate the right recording again with it.",
            mismatch=mismatches[0],
        )
    writer = ResultWriter(language, job.rounding)
    remarks = [spoken(message, language) for message in mismatches]
    if job.requirements.limits:
        remarks.append(writer.words(imu_wording.NOT_JUDGED))
    remarks += [same(note) for note in job.notes]
    remarks += warning_remarks(result, language)
    return Document(
        frame=document_frame(result, job, language, imu_wording.TITLE),
        front=front_fields(result, job, language, _procedure(result, job, language)),
        signatures=signature_boxes(job, language),
        pages=(
            (
                *standards_blocks(job.standards, writer),
                Heading(writer.words(imu_wording.RESULTS)),
                *_gyros(result, combined, writer),
                *_accelerometers(result, combined, writer),
                Paragraph(writer.words(imu_wording.MATRIX_NOTE), size=7.0, together=True),
                Heading(writer.words(wording.USE)),
                Paragraph(writer.words(imu_wording.MODEL), together=True, kept=True),
                Paragraph(writer.words(imu_wording.INVERSE), together=True),
                Heading(writer.words(wording.UNCERTAINTY)),
                *_statement(result, quality, job, writer),
                Heading(writer.words(wording.CONDITIONS)),
                Fields(tuple(condition_fields(result, language)), ruled=False),
                Heading(writer.words(imu_wording.DEVIATIONS)),
                *_method_remarks(result, job, language),
                *([Heading(writer.words(wording.REMARKS))] if remarks else []),
                *(Paragraph(text, together=True) for text in remarks),
                *_positions(result, quality, writer),
            ),
        ),
        seal=seal_of(result, job),
    )


def _procedure(result: ImuResult, job: JobSheet, language: CertificateLanguage) -> Label | None:
    """The method by name, unless the job names its own instead of the standard that it has by itself."""
    if job.procedure != JobSheet.procedure:
        return None
    return label(imu_wording.METHOD.filled(count=len(result.dwells)), language)


# ── results ──────────────────────────────────────────────────────────────────────────────────────────────


def _gyros(result: ImuResult, u: Coefficients, writer: ResultWriter) -> Iterator[Block]:
    gyro = result.calibration.gyro
    unit = gyro_scale_unit(result.calibration)
    yield Heading(writer.words(imu_wording.GYROS), "1")
    yield _vectors(
        writer,
        (imu_wording.GYRO_SCALE, "E1", unit, gyro.E1, u.gyro.E1),
        (imu_wording.GYRO_BIAS, "B0", plain("°/s"), gyro.B0, u.gyro.B0),
    )
    yield Heading(writer.words(imu_wording.GYRO_FORCE), level=2)
    yield _matrix(writer, "f", joined(_MILLION, " (°/s)/(m/s²)"), gyro.Bf, u.gyro.Bf)
    yield Heading(writer.words(imu_wording.GYRO_MISALIGNMENT), level=2)
    yield _matrix(writer, "ω", joined(_MILLION, " rad"), gyro.E, u.gyro.E)


def _accelerometers(result: ImuResult, u: Coefficients, writer: ResultWriter) -> Iterator[Block]:
    accel = result.calibration.accel
    unit = accel_scale_unit(result.calibration)
    yield Heading(writer.words(imu_wording.ACCELEROMETERS), "2")
    yield _vectors(
        writer,
        (imu_wording.ACCEL_SCALE, "K1", unit, accel.K1, u.accel.K1),
        (imu_wording.ACCEL_BIAS, "K0", plain("m/s²"), accel.K0, u.accel.K0),
    )
    yield Heading(writer.words(imu_wording.ACCEL_MISALIGNMENT), level=2)
    yield _matrix(writer, "f", joined(_MILLION, " rad"), accel.K, u.accel.K)


def gyro_scale_unit(calibration: ImuCalibration) -> RichText:
    """Of E₁."""
    outer = calibration.rate_unit or "deg/s"
    return unit_text(f"({outer})/(deg/s)" if "/" in outer else f"{outer}/(deg/s)")


def accel_scale_unit(calibration: ImuCalibration) -> RichText:
    """Of K₁."""
    outer = (calibration.accel_unit or "m/s^2").replace("^2", "²")
    return plain(f"({outer})/(m/s²)" if "/" in outer else f"{outer}/(m/s²)")


def _vectors(writer: ResultWriter, *quantities: tuple[Words, str, RichText, Array, Array]) -> Table:
    """A row a channel: each quantity with its U beside it."""
    columns = [Column(writer.words(imu_wording.CHANNEL))]
    for words, _, unit, _, _ in quantities:
        columns += [writer.column(words, unit, strong=True), writer.column(imu_wording.EXPANDED, unit)]
    rows = []
    for i, axis in enumerate(_AXES):
        row = [same(axis.upper())]
        for _, _, _, values, uncertainties in quantities:
            row += [Label(part) for part in _pair(writer, values[i], uncertainties[i])]
        rows.append(tuple(row))
    return Table(tuple(columns), tuple(rows), whole=True)


def _matrix(writer: ResultWriter, letter: str, unit: RichText, values: Array, uncertainties: Array) -> Table:
    """Three rows, three columns of value ± U in 10⁻⁶ of the unit; what the model has as zero says so."""
    columns = [Column(writer.words(imu_wording.CHANNEL))]
    columns += [Column(Label(symbol(letter, axis)), unit, "right") for axis in _AXES]
    rows = []
    for i, axis in enumerate(_AXES):
        cells = []
        for j in range(3):
            if uncertainties[i, j] == 0.0 and values[i, j] == 0.0:
                cells.append(same("0"))
                continue
            value, expanded = _pair(writer, values[i, j], uncertainties[i, j], 1e6)
            cells.append(Label(joined(value, " ± ", expanded)))
        rows.append((same(axis.upper()), *cells))
    return Table(tuple(columns), tuple(rows), whole=True)


def _pair(
    writer: ResultWriter, value: float, standard: float, factor: float = 1.0
) -> tuple[RichText, RichText]:
    """Value and U, rounded to the same place."""
    expanded = without_noise(COVERAGE_FACTOR * float(standard) * factor)
    rounded = round_to_uncertainty(without_noise(float(value) * factor), expanded, writer.rounding)
    return plain(format_grouped(rounded.value)), plain(format_grouped(rounded.expanded))


# ── positions ────────────────────────────────────────────────────────────────────────────────────────────


def _positions(result: ImuResult, quality: Quality, writer: ResultWriter) -> Iterator[Block]:
    """Where the case stood, and what of each output the set does not explain."""
    known = {dwell.name: dwell for dwell in result.dwells}
    dwells = [known.get(name) for name in quality.positions]
    turned = any(dwell is not None and dwell.beyond_deg for dwell in dwells)
    columns = [Column(writer.words(imu_wording.POSITION), align="right")]
    columns += [Column(writer.words(imu_wording.POINTS.filled(axis=axis.upper()))) for axis in _AXES]
    if turned:
        columns.append(writer.column(imu_wording.TURNED_ON, "°"))
    columns += [writer.column(imu_wording.GYRO_RESIDUAL.filled(axis=axis.upper()), "°/h") for axis in _AXES]
    columns += [
        writer.column(imu_wording.ACCEL_RESIDUAL.filled(axis=axis.upper()), "mm/s²") for axis in _AXES
    ]
    figures = np.hstack([quality.gyro_residuals * PER_HOUR, quality.accel_residuals * 1e3])
    texts = [*_figures(figures[:, :3]), *_figures(figures[:, 3:])]
    rows = []
    for number, dwell in enumerate(dwells, start=1):
        row = [same(str(number)), *pointing(dwell, writer)]
        if turned:
            row.append(same(format_grouped(f"{dwell.beyond_deg:g}") if dwell else DASH))
        rows.append((*row, *(same(column[number - 1]) for column in texts)))
    yield Heading(writer.words(imu_wording.POSITIONS))
    yield Table(tuple(columns), tuple(rows), size=8.0, whole=True)


def pointing(dwell: ImuDwell | None, writer: ResultWriter) -> list[Label]:
    """Where x, y, z pointed, in words."""
    letters = dwell.orientation[:3].ljust(3, "?") if dwell else "???"
    known = wording.ORIENTATION_WORDS
    return [_direction(letter, writer) if letter in known else same(DASH) for letter in letters]


def _direction(letter: str, writer: ResultWriter) -> Label:
    """In one line, so that a position is one."""
    words = wording.ORIENTATION_WORDS[letter]
    return same(f"{words.zh} {letter}") if writer.language == "bilingual" else writer.words(words)


def _figures(values: Array) -> list[list[str]]:
    """Columns of numbers with the same decimals, three significant digits in the largest."""
    largest = float(np.max(np.abs(values), initial=0.0))
    decimals = 2 - math.floor(math.log10(largest)) if largest > 0.0 else 0
    decimals = min(max(decimals, 0), 9)
    return [
        [format_grouped(round_to_place(float(value) + 0.0, decimals)) for value in column]
        for column in values.T
    ]


# ── methods ──────────────────────────────────────────────────────────────────────────────────────────────


def _statement(result: ImuResult, quality: Quality, job: JobSheet, writer: ResultWriter) -> Iterator[Block]:
    words = [imu_wording.UNCERTAINTY]
    if quality.bench is None:
        words.append(imu_wording.WITHOUT_BENCH)
    else:
        words.append(_with_bench(result, quality))
    if job.rounding == "up":
        words.append(wording.ROUNDED_UP)
    words += [imu_wording.MEANING, _traceability(result, quality, job)]
    for number, one in enumerate(words, 1):
        yield Paragraph(writer.words(one), together=True, kept=number < len(words))


def _with_bench(result: ImuResult, quality: Quality) -> Words:
    """Each figure with the certificate that states it, or the star of an assumption."""
    said: list[tuple[str, str]] = []
    for key, value in quality.bench_figures.items():
        name, unit = imu_wording.FIGURES.get(key, (Words(key, key), ""))
        certificate = _certificate(result, key)
        number = f"{_small(value)}{unit} ({certificate})" if certificate else f"{_small(value)}{unit} *"
        said.append((f"{name.zh} {number}", f"{name.en} {number}"))
    return Words(
        imu_wording.WITH_BENCH.zh.format(figures="，".join(zh for zh, _ in said)),
        imu_wording.WITH_BENCH.en.format(figures=", ".join(en for _, en in said)),
    )


def _small(value: float) -> str:
    """Two digits; far below one with a power of ten, in the wording's markup."""
    if value == 0.0 or abs(value) >= 1e-3:
        return significant(value)
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return f"{mantissa} × 10^{{{format_grouped(str(int(exponent)))}}}"


def _traceability(result: ImuResult, quality: Quality, job: JobSheet) -> Words:
    """Only what the standards used, and the certificates behind the figures, bear out."""
    if is_demonstration(result, job):
        return wording.DEMONSTRATION_NOT_TRACEABLE
    if clause6_violations(job.standards, on_date=job.calibrated):
        return wording.NOT_TRACEABLE
    known = [bool(_certificate(result, key)) for key in quality.bench_figures]
    if quality.bench is None or not any(known):
        return imu_wording.ASSUMED
    return imu_wording.TRACED if all(known) else imu_wording.TRACED_PARTLY


def _certificate(result: ImuResult, key: str) -> str:
    """The number of the certificate that states this figure of the bench; "" for an assumption, which gravity
    always is: the set does not say who measured it."""
    capability = noted_capability(result.notes)
    if capability is None or key not in {field.name for field in fields(BenchCapability)}:
        return ""
    return capability.figure(key).certificate


def condition_fields(result: ImuResult, language: CertificateLanguage) -> Iterator[Field]:
    """Positions, turns, references, site, recording: what was done, by name."""

    def line(words: Words, value: Label) -> Field:
        return Field(label(words, language), value)

    by_dwell: dict[str, int] = {}
    for dwell in result.dwells:
        duration = format_grouped(f"{dwell.duration_s:.6g}")
        by_dwell[duration] = by_dwell.get(duration, 0) + 1
    for duration, count in by_dwell.items():
        words = imu_wording.SCHEME_VALUE.filled(count=count, dwell=duration)
        yield line(imu_wording.SCHEME, label(words, language))
    for turns, rate, axes in _turns(result):
        words = imu_wording.TURNS_VALUE.filled(axes=", ".join(axes), turns=turns, rate=rate)
        yield line(imu_wording.TURNS, label(words, language))
    quality = result.calibration.quality
    if quality is not None:
        numbers = (quality.accel_condition, quality.turns_condition)
        positions, turned = (significant(value, 3) for value in numbers)
        yield line(
            imu_wording.CONDITION,
            label(imu_wording.CONDITION_VALUE.filled(positions=positions, turns=turned), language),
        )
    gravity = result.calibration.provenance.get("gravity_mps2")
    words = (
        imu_wording.REFERENCE_VALUE.filled(gravity=f"{gravity:.5f}")
        if isinstance(gravity, float)
        else imu_wording.REFERENCE_PLAIN
    )
    yield line(imu_wording.REFERENCE, label(words, language))
    measured: list[Field] = []
    add_measured(result.device, result.site, language, measured)
    yield from measured
    yield line(wording.RECORDING, same(result.bundle_sha256 or DASH))
    yield line(wording.SOFTWARE, same(result.software))


def _turns(result: ImuResult) -> Sequence[tuple[str, str, list[str]]]:
    """Turns alike in number and rate, with the axes (and senses of the vertical) they were made about."""
    alike: dict[tuple[str, str], list[str]] = {}
    for one in result.turns:
        axis = next((a for a, letter in zip("XYZ", one.orientation, strict=False) if letter in "UD"), "?")
        axes = alike.setdefault((f"±{abs(one.turns)}", f"{abs(one.rate_dps):g}"), [])
        if axis not in axes:
            axes.append(axis)
    return [(turns, rate, axes) for (turns, rate), axes in alike.items()]


def _method_remarks(result: ImuResult, job: JobSheet, language: CertificateLanguage) -> list[Block]:
    texts = [spoken(message, language) for message in result.deviations]
    texts += [spoken(message, language) for message in violations_of(result, job)]
    texts += [same(text) for text in job.accepted_violations]
    return [Paragraph(text, together=True) for text in texts or [label(wording.NO_DEVIATIONS, language)]]
