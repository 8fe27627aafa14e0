"""An Allan deviation as a person reads it: curves with limits and fit, coefficients, plain sentences."""

from __future__ import annotations

from typing import Literal

import numpy as np

from ahrs_lab.analysis.allan import CONFIDENCE, AllanChannel, AllanResult
from ahrs_lab.analysis.report import Cell, Chart, Curve, Report, Table
from ahrs_lab.inertial.allan_fit import FLICKER, QUANTISATION, RAMP, WALK, WHITE, AllanFit
from ahrs_lab.messages import Message
from ahrs_lab.recording.samples import GYRO

_GYRO_UNITS = ("″", "°/√h", "°/h", "°/h/√h", "°/h/h")
_ACCEL_UNITS = ("m/s", "(m/s²)·√s", "m/s²", "(m/s²)/√s", "(m/s²)/s")
_COUNT_UNITS = ("LSB·s", "LSB·√s", "LSB", "LSB/√s", "LSB/s")
_SHOWN_ORDER = (QUANTISATION, WHITE, FLICKER, WALK, RAMP)


def allan_report(result: AllanResult) -> Report:
    """Two tables and two charts at most: gyros, accelerometers."""
    gyros = [channel for channel in result.channels if channel.name in GYRO]
    accels = [channel for channel in result.channels if channel.name not in GYRO]
    triads = [triad for triad in (gyros, accels) if triad]
    return Report(
        Message("Allan deviation of {file}", file=result.file),
        tuple(_table(triad) for triad in triads),
        tuple(_chart(triad) for triad in triads),
        tuple(_notes(result)),
        result.warnings,
    )


def _table(triad: list[AllanChannel]) -> Table:
    gyros, counts = triad[0].name in GYRO, triad[0].factors is None
    units = _COUNT_UNITS if counts else _GYRO_UNITS if gyros else _ACCEL_UNITS
    title = Message("Noise of the gyros") if gyros else Message("Noise of the accelerometers")
    head = (
        Message("quantisation Q, {unit}", unit=units[QUANTISATION]),
        Message("angle random walk N, {unit}", unit=units[WHITE])
        if gyros
        else Message("velocity random walk N, {unit}", unit=units[WHITE]),
        Message("bias instability B, {unit}", unit=units[FLICKER]),
        Message("rate random walk K, {unit}", unit=units[WALK])
        if gyros
        else Message("acceleration random walk K, {unit}", unit=units[WALK]),
        Message("ramp R, {unit}", unit=units[RAMP]),
    )
    rows = tuple((one.name, *(_term(one, term) for term in _SHOWN_ORDER)) for one in triad)
    return Table(title, (Message("channel"), *head), rows)


def _term(channel: AllanChannel, term: int) -> Cell:
    fit = channel.fit
    if fit is None:
        return "–"
    factor = 1.0 if channel.factors is None else float(channel.factors[term])
    value, uncertainty, upper = (
        float(numbers[term]) * factor for numbers in (fit.terms, fit.uncertainty, fit.upper)
    )
    if value > 0.0:
        return with_uncertainty(value, uncertainty)
    return f"< {upper:.2g}" if np.isfinite(upper) else "–"


def with_uncertainty(value: float, uncertainty: float) -> str:
    """``value ± u``, u to two figures and the value to the same place."""
    if not (np.isfinite(uncertainty) and uncertainty > 0.0):
        return f"{value:.3g}"
    place = 1 - int(np.floor(np.log10(uncertainty)))
    if -4 < place <= 7:
        digits = max(0, place)
        return f"{round(value, place):.{digits}f} ± {round(uncertainty, place):.{digits}f}"
    exponent = int(np.floor(np.log10(value)))
    scale, digits = 10.0**exponent, max(0, place + exponent)
    return f"({value / scale:.{digits}f} ± {uncertainty / scale:.{digits}f})e{exponent:+03d}"


def _chart(triad: list[AllanChannel]) -> Chart:
    gyros = triad[0].name in GYRO
    counts = triad[0].factors is None
    unit = "LSB" if counts else "°/h" if gyros else "m/s²"
    curves: list[Curve] = []
    for one in triad:
        positive = one.deviation > 0.0  # a logarithmic axis has no zero
        if not positive.any():
            continue
        factor = 1.0 if one.factors is None else float(one.factors[FLICKER])
        tau = one.tau_s[positive]
        axis = _axis(one.name)
        curves.append(
            Curve(
                one.name,
                tau,
                one.deviation[positive] * factor,
                one.low[positive] * factor,
                one.high[positive] * factor,
                axis,
            )
        )
        if one.fit is not None:
            label = Message("{channel}, fit", channel=one.name)
            curves.append(Curve(label, tau, one.fit.deviation(tau) * factor, axis=axis, style="dashed"))
    return Chart(
        Message("Allan deviation of the gyros")
        if gyros
        else Message("Allan deviation of the accelerometers"),
        Message("averaging time, s"),
        Message("Allan deviation, {unit}", unit=unit),
        tuple(curves),
        log_x=True,
        log_y=True,
    )


def _axis(name: str) -> Literal["x", "y", "z"]:
    return "x" if name.endswith("x") else "y" if name.endswith("y") else "z"


def _notes(result: AllanResult) -> list[Message]:
    total_s = (result.samples + result.missing) * result.interval_s
    notes = [
        Message(
            "{file}: {samples} samples, one each {interval} s, {total} s in all.",
            file=result.file,
            samples=result.samples,
            interval=f"{result.interval_s:.6g}",
            total=f"{total_s:.0f}" if total_s >= 10.0 else f"{total_s:.3g}",
        )
    ]
    if result.missing:
        notes.append(
            Message(
                "{missing} samples are missing: averages count where 95 % of their samples are there.",
                missing=result.missing,
            )
        )
    notes += [
        Message(
            "{channel}: averaging times under {tau} s are no noise of these terms (a filter, vibration) and "
            "are left out of the fit.",
            channel=one.name,
            tau=f"{2**one.fit.first * result.interval_s:.3g}",
        )
        for one in result.channels
        if one.fit is not None and one.fit.first
    ]
    notes += _sentences(result)
    notes.append(
        Message(
            "Fit: σ²(τ) = 3Q²/τ² + N²/τ + (0.664 B)² + K²τ/3 + R²τ²/2 over the octaves. The bands hold the "
            "deviation with {confidence} %; ± is one standard uncertainty; < is the upper limit of a term "
            "that the recording does not show (95 %).",
            confidence=f"{100 * CONFIDENCE:g}",
        )
    )
    return notes


def _sentences(result: AllanResult) -> list[Message]:
    """How long an average is worth taking; channels of which the same is true share a sentence."""
    channels: dict[tuple[bool, str], list[str]] = {}
    for one in result.channels:
        if one.fit is not None:
            best = _best_tau(one.fit)
            still = best is None or best > one.tau_s[-1]
            tau = _round(one.tau_s[-1], 3) if best is None or still else _round(best, 1)
            channels.setdefault((still, tau), []).append(one.name)
    return [
        Message(
            "{channels}: averaging still helps at {tau} s, the longest shown.",
            channels=", ".join(names),
            tau=tau,
        )
        if still
        else Message(
            "{channels}: averages beyond about {tau} s gain nothing more.",
            channels=", ".join(names),
            tau=tau,
        )
        for (still, tau), names in channels.items()
    ]


def _round(value: float, digits: int) -> str:
    """So many digits, without an exponent where that is readable."""
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:g}" if 1e-3 <= rounded < 1e5 else f"{rounded:.{digits}g}"


def _best_tau(fit: AllanFit) -> float | None:
    """Where what averaging lowers has come down to what it does not; None where it never does."""
    squares = fit.terms**2
    tau = np.geomspace(1e-4, 1e7, 1101)
    falling = 3.0 * squares[QUANTISATION] / tau**2 + squares[WHITE] / tau
    staying = fit.deviation(tau) ** 2 - falling
    past = np.flatnonzero(staying >= falling)
    return float(tau[past[0]]) if len(past) and np.any(falling > 0.0) else None
