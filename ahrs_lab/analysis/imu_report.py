"""How a calibration set is shown: coefficients with both uncertainties, residuals, the formula."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.report import Cell, Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import column, digits, paired
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import (
    AXES,
    OTHERS,
    Coefficients,
    ImuCalibration,
    PositionData,
    Quality,
    RotationData,
)

Array = NDArray[np.float64]

DPH = 3600.0

FORMULA = Message(
    "indicated N = E1 ∘ (B0 + Bf·f + (I + E)·ω), N_A = K1 ∘ (K0 + (I + K)·f); compensated "
    "f = (I + K)⁻¹·(N_A/K1 − K0), then ω = (I + E)⁻¹·(N/E1 − B0 − Bf·f). Rows are output channels, columns "
    "input axes; ∘ and / work channel by channel; ω in °/s, f in m/s² (up at rest)."
)
"""The model and the direction in which the coefficients are applied."""


def calibration_report(
    found: ImuCalibration, positions: Sequence[PositionData], rotations: Sequence[RotationData]
) -> Report:
    """Of a set that was just made."""
    quality = found.quality
    assert quality is not None
    return Report(
        title=Message("Calibration set of the inertial measurement unit"),
        tables=(
            _coefficient_table(Message("Gyros"), "gyro", found, quality),
            _coefficient_table(Message("Accelerometers"), "accel", found, quality),
            _position_table(positions, quality),
        ),
        charts=_residual_charts(quality),
        notes=(
            FORMULA,
            Message(
                "{positions} positions (scheme {scheme}), {turns} recordings of turns. Condition numbers: "
                "positions {positions_condition}, turns {turns_condition}.",
                positions=len(positions),
                scheme=str(found.provenance.get("scheme", "own")),
                turns=len(rotations),
                positions_condition=f"{quality.accel_condition:.3g}",
                turns_condition=f"{quality.turns_condition:.3g}",
            ),
            Message(
                "u (noise) is the standard uncertainty by the sensor's noise and drift during this "
                "calibration. u (bench) is that by level, fixture, north, stops, wobble, timing, gravity and "
                "latitude, from the bench's figures; it is not in u (noise). Neither holds the change from "
                "one switching-on to the next."
            ),
            _bench_note(found),
            _gravity_note(found),
        ),
        warnings=found.warnings,
    )


def _bench_note(found: ImuCalibration) -> Message:
    if found.provenance.get("bench_figures") == "stated":
        return Message("The bench's figures are those that its certificates or the recording state.")
    return Message(
        "The recording states no figures of the bench: u (bench) assumes those of JJF 1536 clause 6."
    )


def _gravity_note(found: ImuCalibration) -> Message:
    gravity = f"{float(found.provenance.get('gravity_mps2', 0.0)):.6f}"
    if found.provenance.get("gravity") == "measured":
        return Message("Gravity {gravity} m/s², as measured at the site.", gravity=gravity)
    return Message(
        "Gravity {gravity} m/s² by the normal formula; a measured value ([site] gravity_mps2) makes K1 "
        "better.",
        gravity=gravity,
    )


@dataclass(frozen=True)
class CoefficientRow:
    """One of the 33: ``place`` in its channel's vector (:meth:`Coefficients.vectors`), its unit, and the
    factor to the unit that people read."""

    sensor: Literal["gyro", "accel"]
    channel: int
    place: int
    symbol: str
    input: str
    unit: str
    factor: float
    shown_unit: str

    def of(self, found: Coefficients) -> float:
        """The value in :attr:`unit`."""
        gyro, accel = found.vectors()
        return float((gyro if self.sensor == "gyro" else accel)[self.channel, self.place])


def coefficient_rows(rate_unit: str, accel_unit: str) -> tuple[CoefficientRow, ...]:
    """All 33, gyros first, channel by channel."""
    return (*_gyro_rows(rate_unit or "unit"), *_accel_rows(accel_unit or "unit"))


def _gyro_rows(unit: str) -> Iterator[CoefficientRow]:
    per_g = DPH * STANDARD_GRAVITY_MPS2
    shown = {"deg/s": "(°/s)", "rad/s": "(rad/s)"}.get(unit, unit)
    for i, others in enumerate(OTHERS):
        yield CoefficientRow("gyro", i, 0, "E1", "", f"{unit}/(°/s)", 1.0, f"{shown}/(°/s)")
        yield CoefficientRow("gyro", i, 1, "B0", "", "°/s", DPH, "°/h")
        for j, axis in enumerate(AXES):
            yield CoefficientRow("gyro", i, 2 + j, "Bf", axis, "(°/s)/(m/s²)", per_g, "(°/h)/g")
        for k, j in enumerate(others):
            yield CoefficientRow("gyro", i, 5 + k, "E", AXES[j], "rad", 1e3, "mrad")


def _accel_rows(unit: str) -> Iterator[CoefficientRow]:
    shown = "(m/s²)" if unit == "m/s^2" else unit
    for i, others in enumerate(OTHERS):
        yield CoefficientRow("accel", i, 0, "K1", "", f"{unit}/(m/s²)", 1.0, f"{shown}/(m/s²)")
        yield CoefficientRow("accel", i, 1, "K0", "", "m/s²", 1e3, "mm/s²")
        for k, j in enumerate(others):
            yield CoefficientRow("accel", i, 2 + k, "K", AXES[j], "rad", 1e3, "mrad")


def _coefficient_table(title: Message, sensor: str, found: ImuCalibration, quality: Quality) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for row in coefficient_rows(found.rate_unit, found.accel_unit):
        if row.sensor != sensor:
            continue
        noise = row.factor * row.of(quality.standard_uncertainty)
        bench = None if quality.bench is None else row.factor * row.of(quality.bench)
        rows.append(
            (
                f"{row.symbol} {AXES[row.channel]}{row.input}",
                *paired(row.factor * row.of(found.coefficients), noise, unstated=9),
                "" if bench is None else digits(bench, 2),
                row.shown_unit,
            )
        )
    head = (
        Message("coefficient"),
        Message("value"),
        Message("u (noise)"),
        Message("u (bench)"),
        Message("unit"),
    )
    return Table(title, head, tuple(rows))


def _position_table(positions: Sequence[PositionData], quality: Quality) -> Table:
    head = (
        Message("position"),
        Message("dwell, s"),
        *(Message("gyro {axis}, °/h", axis=axis) for axis in AXES),
        *(Message("accelerometer {axis}, mm/s²", axis=axis) for axis in AXES),
    )
    columns = (
        (position.name for position in positions),
        (f"{position.duration_s:.1f}" for position in positions),
        *(column(values, sign="+") for values in (DPH * quality.gyro_residuals).T),
        *(column(values, sign="+") for values in (1e3 * quality.accel_residuals).T),
    )
    return Table(Message("Residuals of the positions"), head, tuple(zip(*columns, strict=True)))


def _residual_charts(quality: Quality) -> tuple[Chart, ...]:
    numbers = np.arange(1.0, len(quality.positions) + 1.0)

    def chart(title: Message, y_label: Message, residuals: Array) -> Chart:
        curves = tuple(
            Curve(axis, numbers, residuals[:, i], axis=axis, style="points") for i, axis in enumerate(AXES)
        )
        return Chart(title, Message("position, number"), y_label, curves)

    return (
        chart(Message("Residuals of the gyros"), Message("residual, °/h"), DPH * quality.gyro_residuals),
        chart(
            Message("Residuals of the accelerometers"),
            Message("residual, mm/s²"),
            1e3 * quality.accel_residuals,
        ),
    )
