"""What the annex page plots: residuals of the scale-factor fit, outputs at the zero-offset positions."""

from __future__ import annotations

import math

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Block, Chart, Heading, Label, Paragraph, Series, label
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.result_tables import AXES, PER_HOUR, significant
from ahrs_lab.certificates.richtext import joined, plain, symbol
from ahrs_lab.metrology.result import CalibrationResult, ScaleFactorResult, ZeroOffsetResult

_CURVE_POINTS = 73


def residual_blocks(result: CalibrationResult, language: CertificateLanguage) -> tuple[Block, ...]:
    """Heading, one panel an axis, note; nothing where no scale factor was calibrated."""
    panels = tuple(_residuals(result.scale_factor[axis]) for axis in AXES if axis in result.scale_factor)
    if not panels:
        return ()
    blocks: list[Block] = [
        Heading(label(wording.RESIDUALS, language), level=2),
        Chart(panels, label(wording.RESIDUALS_X, language), label(wording.RESIDUALS_Y, language)),
    ]
    if any(panel.error for panel in panels):
        blocks.append(Paragraph(label(wording.RESIDUALS_NOTE, language), size=7.0))
    return tuple(blocks)


def _residuals(result: ScaleFactorResult) -> Series:
    static = 0.5 * (result.static_before + result.static_after)
    scale = 1e6 / max(1e-300, *(abs(mean - static) for mean in result.means))
    order = sorted(range(len(result.rates_dps)), key=lambda i: result.rates_dps[i])
    errors = result.standard_errors
    return Series(
        axis=result.axis,
        x=tuple(result.rates_dps[i] for i in order),
        y=tuple(result.residuals[i] * scale for i in order),
        error=tuple(2 * errors[i] * scale for i in order) if len(errors) == len(order) else (),
        title=symbol("K", result.axis),
    )


def position_blocks(result: CalibrationResult, language: CertificateLanguage) -> tuple[Block, ...]:
    """N_i/T − B of each position; with the multi-position schedule over azimuth, with its first harmonic."""
    results = [result.zero_offset[axis] for axis in AXES if axis in result.zero_offset]
    if not results:
        return ()
    harmonic = any(one.earth_rate_check and one.azimuths_deg for one in results)
    x_label = label(wording.AZIMUTH_X if harmonic else wording.POSITIONS_X, language)
    most = max(len(one.angles_deg) for one in results)
    ticks = () if harmonic else tuple(float(i) for i in range(1, most + 1)) if most <= 12 else ()
    blocks: list[Block] = [
        Heading(label(wording.POSITIONS, language), level=2),
        Chart(
            tuple(_positions(one, harmonic=harmonic) for one in results),
            x_label,
            label(wording.POSITIONS_Y, language),
            x_ticks=ticks,
        ),
    ]
    for one in results:
        note = _harmonic_note(one, language)
        if note is not None:
            blocks.append(Paragraph(note, size=7.0))
    return tuple(blocks)


def position_rates_dph(result: ZeroOffsetResult) -> tuple[float, ...]:
    """N_i/T of each position, °/h."""
    durations = result.durations_s
    if len(durations) != len(result.angles_deg):
        durations = (result.duration_s,) * len(result.angles_deg)
    return tuple(n / t * PER_HOUR for n, t in zip(result.angles_deg, durations, strict=True))


def _positions(result: ZeroOffsetResult, *, harmonic: bool) -> Series:
    offset = result.B * PER_HOUR
    rates = tuple(rate - offset for rate in position_rates_dph(result))
    over_azimuth = harmonic and len(result.azimuths_deg) == len(rates)
    x = result.azimuths_deg if over_azimuth else tuple(float(i) for i in range(1, len(rates) + 1))
    curve: tuple[tuple[float, float], ...] = ()
    check = result.earth_rate_check
    if over_azimuth and check and "amplitude_dps" in check and "heading_at_zero_deg" in check:
        amplitude = check["amplitude_dps"] * PER_HOUR
        # the axis points to north where the table stands here
        north = math.radians(check["heading_at_zero_deg"] - check.get("phase_deg", 0.0))
        angles = [min(x) + (max(x) - min(x)) * i / (_CURVE_POINTS - 1) for i in range(_CURVE_POINTS)]
        curve = tuple((a, amplitude * math.cos(math.radians(a) - north)) for a in angles)
    return Series(axis=result.axis, x=x, y=rates, curve=curve, title=symbol("B", result.axis))


def _harmonic_note(result: ZeroOffsetResult, language: CertificateLanguage) -> Label | None:
    check = result.earth_rate_check
    if not check or "amplitude_dps" not in check:
        return None
    words = wording.HARMONIC_NOTE.filled(
        amplitude=significant(check["amplitude_dps"] * PER_HOUR, 4),
        expected=significant(check.get("expected_dps", 0.0) * PER_HOUR, 4),
        phase=significant(check.get("phase_deg", 0.0), 3),
    )
    note = label(words, language)
    return Label(joined(plain(f"{result.axis.upper()}: "), note.main), note.second)
