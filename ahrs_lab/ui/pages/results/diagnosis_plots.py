"""The plots of the tab Diagnosis: what the result's diagnosis holds, in the units of the axes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QCoreApplication, Qt

from ahrs_lab.metrology.diagnosis.model import AllanDiagnosis, Harmonic, Residuals, ScaleFactorDiagnosis
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.pages.widgets.plot import Plot
from ahrs_lab.ui.theme import AXIS_COLOURS, tokens

Array = NDArray[np.float64]

_DPH = 3600.0
_BAR = 2.0
"""Error bars are as many standard errors."""


def draw_residuals(plot: Plot, found: ScaleFactorDiagnosis, axis: Axis, against: str) -> tuple[str, ...]:
    """Residuals in ppm against ``rate``, ``order`` or ``time``; returns the segment behind each point."""
    starts = np.asarray(found.residuals.starts_s)
    label, x = {
        "rate": (QCoreApplication.translate("Plots", "Table rate, °/s"), np.asarray(found.rates_dps)),
        "order": (
            QCoreApplication.translate("Plots", "Order of recording"),
            np.asarray(found.order, dtype=np.float64),
        ),
        "time": (
            QCoreApplication.translate("Plots", "Start after the first rate, min"),
            (starts - starts.min(initial=np.inf)) / 60.0,
        ),
    }[against]
    scale = 1e6 / found.full_scale if found.full_scale > 0.0 else 0.0
    plot.clear(label, QCoreApplication.translate("Plots", "Residual, ppm"))
    _points(plot, x, found.residuals, scale, axis)
    return found.residuals.segments


def draw_positions(plot: Plot, found: Residuals, axis: Axis) -> tuple[str, ...]:
    """Residuals of the single recordings in °/h, one after the other; the segment behind each point."""
    plot.clear(
        QCoreApplication.translate("Plots", "Recording"),
        QCoreApplication.translate("Plots", "Residual, °/h"),
    )
    x = np.arange(1.0, len(found.residuals) + 1.0)
    _points(plot, x, found, _DPH, axis)
    if len(x) <= 24:
        plot.set_names(list(x), [f"{place:.0f}" for place in x])
    return found.segments


def _points(plot: Plot, x: Array, found: Residuals, scale: float, axis: Axis) -> None:
    y, errors = scale * np.asarray(found.residuals), _BAR * scale * np.asarray(found.standard_errors)
    outliers = list(found.outliers)
    plot.add_level(0.0, tokens().faint)
    plot.add_rings(x[outliers], y[outliers], tokens().warn)
    plot.add_points(x, y, AXIS_COLOURS[axis], errors)
    if x.size:
        _ranges(plot, x, y - errors, y + errors)


def draw_harmonic(plot: Plot, found: Harmonic, axis: Axis) -> None:
    """Mean outputs over azimuth, the fitted wave, and dashed the one that ω_ie·cos φ makes."""
    plot.clear(
        QCoreApplication.translate("Plots", "Azimuth of the table, °"),
        QCoreApplication.translate("Plots", "Mean output, °/h"),
    )
    curve = np.asarray(found.curve_azimuths_deg)
    plot.add_curve(
        curve, _DPH * np.asarray(found.expected_curve_dps), tokens().muted, style=Qt.PenStyle.DashLine
    )
    plot.add_curve(curve, _DPH * np.asarray(found.fitted_dps), AXIS_COLOURS[axis])
    x, y = np.asarray(found.azimuths_deg), _DPH * np.asarray(found.rates_dps)
    errors = np.full_like(y, _BAR * _DPH * found.standard_error_dps)
    plot.add_points(x, y, AXIS_COLOURS[axis], errors)
    _ranges(plot, curve, np.append(y - errors, y.mean()), np.append(y + errors, y.mean()))


def draw_allan(plot: Plot, found: AllanDiagnosis, axis: Axis) -> None:
    """Allan deviation with its 95 % band, the model of the noise, and T; both axes logarithmic."""
    plot.clear(
        QCoreApplication.translate("Plots", "Averaging time τ, s"),
        QCoreApplication.translate("Plots", "Allan deviation, °/h"),
    )
    colour = AXIS_COLOURS[axis]
    taus = np.log10(found.taus_s)
    low, high, middle = (
        np.log10(_DPH * np.asarray(values))
        for values in (found.low_dps, found.high_dps, found.deviations_dps)
    )
    plot.add_area(taus, low, high, colour)
    model = _DPH * np.asarray(found.model_dps)
    model_taus = np.log10(found.model_taus_s)
    if np.all(model > 0.0):
        plot.add_curve(model_taus, np.log10(model), tokens().text)
    plot.add_points(taus, middle, colour)
    T = math.log10(found.duration_s)
    plot.add_upright(T, tokens().accent)
    bottom = min(low.min(), np.log10(model).min() if np.all(model > 0.0) else math.inf)
    x = (min(taus.min(), T) - 0.1, max(taus.max(), T) + 0.25)
    y = (float(bottom) - 0.15, float(high.max()) + 0.2)
    beside = T - 0.08 * (x[1] - x[0])
    plot.add_note(
        beside, y[1] - 0.04 * (y[1] - y[0]), f"T = {found.duration_s:g} s", tokens().accent, above=False
    )
    plot.set_ranges(x, y)
    plot.set_names(*_decades(*x))
    plot.set_names(*_decades(*y), side="left")


def _decades(low: float, high: float) -> tuple[list[float], list[str]]:
    """Places and words of a logarithmic axis: 1, 2, 5 where the range is short, else whole decades."""
    steps = (1.0, 2.0, 5.0) if high - low < 2.2 else (1.0,)
    values = [
        step * 10.0**decade
        for decade in range(math.floor(low) - 1, math.ceil(high) + 1)
        for step in steps
        if low <= math.log10(step) + decade <= high
    ]
    return [math.log10(value) for value in values], [f"{value:.6g}" for value in values]


def _ranges(plot: Plot, x: Array, low: Array, high: Array) -> None:
    span = float(np.ptp(x)) or 1.0
    height = float(high.max() - low.min()) or 1.0
    plot.set_ranges(
        (float(x.min()) - 0.06 * span, float(x.max()) + 0.06 * span),
        (float(low.min()) - 0.15 * height, float(high.max()) + 0.15 * height),
    )
