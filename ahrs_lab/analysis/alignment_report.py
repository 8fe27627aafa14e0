"""The report of a self-alignment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.alignment_unit import RADPS_PER_DEG_PER_H
from ahrs_lab.analysis.report import Cell, Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import paired
from ahrs_lab.inertial.alignment import Orthogonalisation
from ahrs_lab.messages import Message

if TYPE_CHECKING:
    from ahrs_lab.analysis.alignment import Alignment, Attitude, Method

Array = NDArray[np.float64]

METHOD_NAMES: Mapping[Method, Message] = {
    "coarse": Message("Coarse, analytic"),
    "fine": Message("Fine, least squares over time"),
    "kalman-open": Message("Kalman filter, open loop"),
    "kalman-closed": Message("Kalman filter, closed loop"),
}
ORTHOGONALISATION_NAMES: Mapping[Orthogonalisation, Message] = {
    "rows": Message("Gram–Schmidt over rows, up first"),
    "columns": Message("Gram–Schmidt over columns, as printed"),
    "svd": Message("Nearest orthogonal matrix (SVD)"),
}

_BAND = 3.0
_ANGLES = (Message("Heading"), Message("Pitch"), Message("Roll"))


def report_of(alignment: Alignment) -> Report:
    """Tables, charts, notes."""
    tables = [_attitudes(alignment), _limit(alignment)]
    if alignment.biases is not None:
        tables.append(_biases(alignment))
    return Report(
        Message("Self-alignment of {file}", file=alignment.file),
        tuple(tables),
        _charts(alignment),
        (_where(alignment), *_notes(alignment)),
        alignment.warnings,
    )


def _where(alignment: Alignment) -> Message:
    return Message(
        "At rest for {seconds} s at latitude {latitude}°.",
        seconds=f"{alignment.duration_s:.0f}",
        latitude=f"{np.degrees(alignment.place.latitude_rad):.4f}",
    )


def _attitudes(alignment: Alignment) -> Table:
    settings = alignment.settings
    name = METHOD_NAMES[settings.method]
    if settings.method == "coarse":
        name = ORTHOGONALISATION_NAMES[settings.orthogonalisation]
    chosen = Message("{method} (chosen)", method=name)
    rows = [_row(chosen, alignment.attitude), *(_row(*other) for other in alignment.others)]
    head: list[Cell] = [Message("method")]
    for angle in _ANGLES:
        head += [Message("{angle}, °", angle=angle), "u, °"]
    return Table(Message("Attitude and its standard uncertainty"), tuple(head), tuple(rows))


def _row(name: Message, attitude: Attitude) -> tuple[Cell, ...]:
    cells: list[Cell] = [name]
    for angle, uncertainty in zip(attitude.angles_deg, attitude.uncertainty_deg, strict=True):
        cells += paired(float(angle), float(uncertainty), unstated=6)
    return tuple(cells)


def _limit(alignment: Alignment) -> Table:
    unit = alignment.unit
    rows: tuple[tuple[Cell, ...], ...] = (
        (Message("gyro bias assumed"), f"{unit.gyro_bias_radps / RADPS_PER_DEG_PER_H:.3g}", "°/h"),
        (Message("accelerometer bias assumed"), f"{unit.accel_bias_mps2:.3g}", "m/s²"),
        *(
            (Message("{symbol} left by these biases, formula (2-104)", symbol=symbol), f"{value:.3g}", "°")
            for symbol, value in zip(("φ_E", "φ_N", "φ_U"), alignment.limit_deg, strict=True)
        ),
        *_noise_rows(alignment),
    )
    head = (Message("quantity"), Message("value"), Message("unit"))
    return Table(Message("What the uncertainty is made of (standard deviations)"), head, rows)


def _noise_rows(alignment: Alignment) -> tuple[tuple[Cell, ...], ...]:
    gyro, accel = (
        np.sqrt(noise.variances()[0]) for noise in (alignment.unit.gyro_noise, alignment.unit.accel_noise)
    )
    walk = ", ".join(f"{value:.2g}" for value in np.degrees(gyro) * 60.0)
    velocity = ", ".join(f"{value:.2g}" for value in accel)
    return (
        (Message("angle random walk found, axes x, y, z"), walk, "°/√h"),
        (Message("velocity random walk found, axes x, y, z"), velocity, "(m/s²)·√s"),
    )


def _biases(alignment: Alignment) -> Table:
    biases = alignment.biases
    assert biases is not None
    rows = tuple(
        (axis, *paired(gyro, u_gyro), *paired(accel, u_accel))
        for axis, gyro, u_gyro, accel, u_accel in zip(
            "xyz",
            biases.gyro_deg_per_h,
            biases.gyro_uncertainty_deg_per_h,
            biases.accel_mps2,
            biases.accel_uncertainty_mps2,
            strict=True,
        )
    )
    head = (
        Message("case axis"),
        Message("gyro bias, °/h"),
        "u, °/h",
        Message("accelerometer bias, m/s²"),
        "u, m/s²",
    )
    return Table(Message("Biases by case axis"), head, rows)


def _charts(alignment: Alignment) -> tuple[Chart, ...]:
    course = alignment.course
    if course is None:
        return ()
    t = alignment.course_s
    charts = []
    for index, angle in enumerate(_ANGLES):
        last = alignment.attitude.angles_deg[index]
        # heading and roll run on through north and through upside down
        values = last + (course.angles_deg[:, index] - last + 180.0) % 360.0 - 180.0
        curve = _curve(angle, t, values, course.uncertainty_deg[:, index])
        charts.append(
            Chart(
                Message("{angle} over time, with ±3σ", angle=angle),
                Message("time, s"),
                Message("{angle}, °", angle=angle),
                (curve,),
            )
        )
    if alignment.bias_course is not None:
        charts += _bias_charts(t, *alignment.bias_course)
    return tuple(charts)


def _bias_charts(t: Array, values: Array, deviations: Array) -> list[Chart]:
    east, north, up = Message("east"), Message("north"), Message("upward")
    return [
        Chart(
            title,
            Message("time, s"),
            label,
            tuple(_curve(name, t, values[:, i], deviations[:, i]) for i, name in columns),
        )
        for title, label, columns in (
            (
                Message("Gyro biases over time, with ±3σ"),
                Message("gyro bias, °/h"),
                ((0, east), (1, north), (2, up)),
            ),
            (
                Message("Accelerometer biases over time, with ±3σ"),
                Message("accelerometer bias, m/s²"),
                ((3, east), (4, north)),
            ),
        )
    ]


def _curve(name: Message, t: Array, values: Array, deviations: Array) -> Curve:
    return Curve(name, t, values, values - _BAND * deviations, values + _BAND * deviations)


def _notes(alignment: Alignment) -> tuple[Message, ...]:
    settings = alignment.settings
    notes = [
        Message(
            "A unit at rest cannot tell the bias of the gyro that points east from a heading error, nor "
            "those of the level accelerometers from a tilt: φ_E = ∇_N/g, φ_N = −∇_E/g, "
            "φ_U = ε_E/(ω_ie cos L) − ∇_E tan L/g. The biases above are assumptions about the unit, and the "
            "uncertainty rests on them; a longer recording only takes the noise away."
        ),
        Message(
            "The assumed accelerometer bias stands for every constant error in this position: a case axis "
            "that is out of square by 5″ makes 2.4×10⁻⁴ m/s² of it."
        ),
        Message(
            "Heading clockwise from north, pitch nose up, roll right side down; right, forward and up are "
            "the case axes {right}, {forward}, {up}.",
            right=settings.axes[0],
            forward=settings.axes[1],
            up=settings.axes[2],
        ),
    ]
    if settings.method == "coarse":
        notes.append(
            Message(
                "Gram–Schmidt over rows keeps the up row, which is the accelerometers' alone; the others mix "
                "the gyros' error into pitch and roll."
            )
        )
    if alignment.biases is not None:
        notes.append(
            Message(
                "Biases whose uncertainty is that assumed were not observed. The north gyro shows its bias "
                "in the drift of level, the up gyro in its mean rate, the up accelerometer in the excess "
                "over normal gravity, which itself is known to 5×10⁻⁴ m/s²."
            )
        )
    return tuple(notes)
