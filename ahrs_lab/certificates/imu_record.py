"""The original record of a discrete IMU calibration: outputs of turns and positions as they were recorded,
the coefficients as computed, the course of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ahrs_lab.certificates import imu_wording, wording
from ahrs_lab.certificates.content import standards_blocks
from ahrs_lab.certificates.documents import Column, Document, Heading, Label, Table, same
from ahrs_lab.certificates.imu_sheet import accel_scale_unit, condition_fields, gyro_scale_unit
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.record_parts import (
    column_figures,
    figure,
    record_course,
    record_frame,
    record_front,
    record_plan,
    short,
)
from ahrs_lab.certificates.result_tables import DASH, ResultWriter, unit_text
from ahrs_lab.certificates.richtext import RichText, joined, plain, symbol
from ahrs_lab.metrology.imu_calibration import OTHERS, ImuCalibration
from ahrs_lab.metrology.imu_result import ImuDwell, ImuResult, ImuTurns
from ahrs_lab.metrology.rounding import format_grouped

_AXES = ("x", "y", "z")


def imu_record(result: ImuResult, job: JobSheet | None, language: CertificateLanguage) -> Document:
    """The contents of the record; without ``job`` what the recording itself says of device and people."""
    writer = ResultWriter(language, job.rounding if job else "half-even")
    conditions = tuple(condition_fields(result, language))
    return Document(
        frame=record_frame(result, job, language, wording.RECORD_TITLE),
        front=tuple(record_front(result, job, language, conditions)),
        signatures=(),
        pages=(
            (
                *(standards_blocks(job.standards, writer) if job and job.standards else ()),
                Heading(writer.words(imu_wording.RAW_TURNS), "1"),
                _turns(result.turns, result.calibration, writer),
                Heading(writer.words(imu_wording.RAW_POSITIONS), "2"),
                _dwells(result.dwells, result.calibration, writer),
                Heading(writer.words(wording.FULL_RESULTS), "3"),
                _coefficients(result, writer),
                *record_course(result, language),
                *record_plan(result, language),
            ),
        ),
    )


def _turns(turns: Sequence[ImuTurns], calibration: ImuCalibration, writer: ResultWriter) -> Table:
    columns = [
        Column(writer.words(wording.RAW_SEGMENT)),
        writer.column(wording.TURN_RATE, "°/s"),
        writer.column(imu_wording.TABLE_ANGLE, "°"),
        writer.column(wording.RAW_DWELL, "s"),
    ]
    unit = joined(unit_text(calibration.rate_unit or "deg/s"), "·s")
    columns += [
        writer.column(imu_wording.OUTPUT_SUM.filled(axis=axis.upper(), index=axis), unit) for axis in _AXES
    ]
    sums = [column_figures([one.angle[i] for one in turns]) for i in range(3)]
    rows = [
        (
            same(one.name),
            same(format_grouped(f"{one.rate_dps:g}")),
            same(format_grouped(f"{one.turned_deg:.4f}")),
            same(format_grouped(f"{one.duration_s:.10g}")),
            *(Label(column[row]) for column in sums),
        )
        for row, one in enumerate(turns)
    ]
    return Table(tuple(columns), tuple(rows), size=7.5)


def _dwells(dwells: Sequence[ImuDwell], calibration: ImuCalibration, writer: ResultWriter) -> Table:
    columns = [Column(writer.words(wording.RAW_SEGMENT)), writer.column(wording.RAW_DWELL, "s")]
    rate = unit_text(calibration.rate_unit or "deg/s")
    accel = plain((calibration.accel_unit or "m/s^2").replace("^2", "²"))
    columns += [writer.column(imu_wording.GYRO_MEAN.filled(index=axis), rate) for axis in _AXES]
    columns += [writer.column(imu_wording.ACCEL_MEAN.filled(index=axis), accel) for axis in _AXES]
    means = [column_figures([one.gyro[i] for one in dwells]) for i in range(3)]
    means += [column_figures([one.accel[i] for one in dwells]) for i in range(3)]
    rows = []
    for row, one in enumerate(dwells):
        turned = f" + {one.beyond_deg:g}°" if one.beyond_deg else ""
        rows.append(
            (
                same(f"{one.name}{turned}"),
                same(format_grouped(f"{one.duration_s:.10g}")),
                *(Label(column[row]) for column in means),
            )
        )
    return Table(tuple(columns), tuple(rows), size=6.5)


def _coefficients(result: ImuResult, writer: ResultWriter) -> Table:
    """All 33, not rounded, with both parts of their standard uncertainty."""
    columns = (
        Column(writer.words(wording.QUANTITY)),
        writer.column(wording.VALUE, strong=True),
        Column(Label(()), plain("")),
        writer.column(imu_wording.OF_RECORDING),
        writer.column(imu_wording.OF_BENCH),
        writer.column(wording.STANDARD_UNCERTAINTY),
    )
    return Table(columns, tuple(_coefficient_rows(result)), size=7.5)


def _coefficient_rows(result: ImuResult) -> Iterator[tuple[Label, ...]]:
    quality, combined = result.calibration.quality, result.combined
    values = result.calibration.coefficients.vectors()
    parts = [
        one.vectors() if one is not None else None
        for one in (
            quality.standard_uncertainty if quality else None,
            quality.bench if quality else None,
            combined,
        )
    ]
    for triad, names in enumerate((_gyro_names(result.calibration), _accel_names(result.calibration))):
        for place in range(len(names[0])):
            for channel in range(3):
                name, unit = names[channel][place]
                yield (
                    Label(name),
                    Label(figure(float(values[triad][channel, place]))),
                    Label(unit),
                    *(
                        same(DASH) if part is None else Label(short(float(part[triad][channel, place])))
                        for part in parts
                    ),
                )


def _gyro_names(calibration: ImuCalibration) -> list[list[tuple[RichText, RichText]]]:
    """Per channel, in the order of :meth:`~ahrs_lab.metrology.imu_calibration.Coefficients.vectors`."""
    force = plain("(°/s)/(m/s²)")
    return [
        [
            (symbol("E", f"1{axis}"), gyro_scale_unit(calibration)),
            (symbol("B", f"0{axis}"), plain("°/s")),
            *((symbol("B", f"f{axis}{other}"), force) for other in _AXES),
            *((symbol("E", f"{axis}{_AXES[j]}"), plain("rad")) for j in OTHERS[i]),
        ]
        for i, axis in enumerate(_AXES)
    ]


def _accel_names(calibration: ImuCalibration) -> list[list[tuple[RichText, RichText]]]:
    return [
        [
            (symbol("K", f"1{axis}"), accel_scale_unit(calibration)),
            (symbol("K", f"0{axis}"), plain("m/s²")),
            *((symbol("K", f"{axis}{_AXES[j]}"), plain("rad")) for j in OTHERS[i]),
        ]
        for i, axis in enumerate(_AXES)
    ]
