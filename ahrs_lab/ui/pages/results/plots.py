"""The plot that belongs to the chosen quantity, and the raw segment behind a point of it."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QCoreApplication

from ahrs_lab.metrology.result import MisalignmentResult, ScaleFactorResult, ZeroOffsetResult
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.formatting import number, signed_rate
from ahrs_lab.ui.pages.results import plot_data
from ahrs_lab.ui.pages.results.quantities import Quantity
from ahrs_lab.ui.pages.widgets.plot import Plot
from ahrs_lab.ui.theme import AXIS_COLOURS, tokens

_MARGIN = 0.08


def draw_residuals(plot: Plot, source: ScaleFactorResult) -> tuple[str, ...]:
    """Residuals in ppm with error bars over the rate; returns the segment behind each point."""
    data = plot_data.residuals(source)
    plot.clear(
        QCoreApplication.translate("Plots", "Table rate, °/s"),
        QCoreApplication.translate("Plots", "Residual, ppm"),
    )
    plot.add_level(0.0, tokens().faint)
    plot.add_points(data.rates_dps, data.residuals_ppm, AXIS_COLOURS[source.axis], data.errors_ppm)
    _around(plot, data.rates_dps, data.residuals_ppm, data.errors_ppm)
    return data.segments


def draw_fit(plot: Plot, source: ScaleFactorResult, unit: str) -> tuple[str, ...]:
    """Means over the rate with the fitted line."""
    data = plot_data.residuals(source)
    plot.clear(
        QCoreApplication.translate("Plots", "Table rate, °/s"),
        QCoreApplication.translate("Plots", "Mean output, {unit}").format(unit=unit),
    )
    order = np.argsort(data.rates_dps)
    plot.add_curve(data.rates_dps[order], data.fitted[order], tokens().muted)
    plot.add_points(data.rates_dps, data.means, AXIS_COLOURS[source.axis])
    _around(plot, data.rates_dps, data.means, np.zeros_like(data.means))
    return data.segments


def draw_positions(plot: Plot, source: ZeroOffsetResult, latitude_deg: float | None) -> tuple[str, ...]:
    """Mean rate of each position against what B and the Earth's rate make of it."""
    data = plot_data.positions(source, latitude_deg)
    colour = AXIS_COLOURS[source.axis]
    if data.azimuths_deg is not None and data.wave is not None:
        plot.clear(
            QCoreApplication.translate("Plots", "Azimuth of the axis, °"),
            QCoreApplication.translate("Plots", "Mean output, °/h"),
        )
        plot.add_curve(*data.wave, tokens().muted)
        places = data.azimuths_deg
    else:
        plot.clear("", QCoreApplication.translate("Plots", "Mean output, °/h"))
        places = np.arange(1.0, data.rates_dph.size + 1.0)
        plot.add_points(places, data.expected_dph, tokens().faint, hollow=True)
        plot.set_names(list(places), [_position_name(n, label) for n, label in enumerate(data.labels, 1)])
    half_width = 3600.0 * source.uncertainty.expanded
    plot.add_level(data.offset_dph, colour, dashed=True)
    if half_width > 0.0:
        plot.add_band(data.offset_dph - half_width, data.offset_dph + half_width, colour)
    plot.add_points(places, data.rates_dph, colour)
    values = np.concatenate([data.rates_dph, data.expected_dph, [data.offset_dph]])
    low, high = float(values.min()) - half_width, float(values.max()) + half_width
    span = max(high - low, 1e-6)
    edge = 0.5 if data.azimuths_deg is None else 10.0
    plot.set_ranges((places.min() - edge, places.max() + edge), (low - 0.25 * span, high + 0.25 * span))
    return data.segments


def _position_name(number: int, direction: str) -> str:
    names = {
        "E": QCoreApplication.translate("Plots", "east"),
        "W": QCoreApplication.translate("Plots", "west"),
        "N": QCoreApplication.translate("Plots", "north"),
        "S": QCoreApplication.translate("Plots", "south"),
        "U": QCoreApplication.translate("Plots", "up"),
        "D": QCoreApplication.translate("Plots", "down"),
    }
    return f"{number} · {names[direction]}" if direction in names else str(number)


def draw_turns(plot: Plot, source: MisalignmentResult) -> tuple[str, ...]:
    """Output angles at the end of the + and − turns: half their difference gives L."""
    data = plot_data.turns(source)
    colour = AXIS_COLOURS[source.output_axis]
    angles = np.asarray(data.angles_deg)
    middle = float(angles.mean())
    places = np.array([1.0, 2.0])
    plot.clear(
        "",
        QCoreApplication.translate("Plots", "Angle shown by {axis}, °").format(
            axis=source.output_axis.upper()
        ),
    )
    rate = signed_rate(abs(source.rate_dps))
    plot.set_names(
        [1.0, 2.0],
        [
            QCoreApplication.translate("Plots", "+{rate} °/s").format(rate=rate),
            QCoreApplication.translate("Plots", "−{rate} °/s").format(rate=rate),
        ],
    )
    plot.add_level(middle, tokens().faint, dashed=True)
    plot.add_curve(places, angles, tokens().muted)
    plot.add_points(places, angles, colour)
    for place, angle in zip(places, angles, strict=True):
        plot.add_note(float(place), float(angle), f"{number(float(angle), 4)}°", tokens().text)
    span = max(float(np.ptp(angles)), 1e-6)
    plot.set_ranges((0.4, 2.6), (float(angles.min()) - 0.35 * span, float(angles.max()) + 0.35 * span))
    return data.segments


def draw_segment(plot: Plot, samples: Samples, unit: str) -> None:
    """The three rates of a recorded segment over time, thinned without losing an extreme."""
    plot.clear(
        QCoreApplication.translate("Plots", "Time in the segment, s"),
        QCoreApplication.translate("Plots", "Output, {unit}").format(unit=unit),
    )
    time = samples["t_s"] - samples["t_s"][0]
    for axis in AXES:
        column = samples.get(f"gyro_{axis}")
        if column is not None:
            curve = plot_data.envelope(time, column)
            plot.add_curve(curve.time, curve.values, AXIS_COLOURS[axis])


def draw(
    plot: Plot, quantity: Quantity, latitude_deg: float | None, unit: str, *, fit: bool
) -> tuple[str, ...]:
    """The plot of ``quantity``; ``unit`` of the device's rate output."""
    match quantity.source:
        case ScaleFactorResult() as scale:
            return draw_fit(plot, scale, unit) if fit else draw_residuals(plot, scale)
        case ZeroOffsetResult() as offset:
            return draw_positions(plot, offset, latitude_deg)
        case MisalignmentResult() as angle:
            return draw_turns(plot, angle)


def _around(plot: Plot, x: plot_data.Array, y: plot_data.Array, errors: plot_data.Array) -> None:
    if not x.size:
        return
    x_span = float(np.ptp(x)) or 1.0
    low, high = float((y - errors).min()), float((y + errors).max())
    span = (high - low) or 1.0
    plot.set_ranges(
        (float(x.min()) - _MARGIN * x_span, float(x.max()) + _MARGIN * x_span),
        (low - 0.15 * span, high + 0.15 * span),
    )
