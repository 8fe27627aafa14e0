"""What the plots of the results page draw, from a result: points, their error bars, what theory expects.

No Qt here. Units are those of the axis titles the page writes: rates in °/s, residuals in ppm of the largest
mean, zero offset positions in °/h.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.result import MisalignmentResult, ScaleFactorResult, ZeroOffsetResult
from ahrs_lab.recording.orientation import AXES

Array = NDArray[np.float64]

EARTH_RATE_DPH = 15.041067178669
"""WGS 84, 7.292115×10⁻⁵ rad/s."""
_AZIMUTH_OF = {"N": 0.0, "E": 90.0, "S": 180.0, "W": 270.0}


@dataclass(frozen=True)
class Residuals:
    """Fit and residuals of a scale factor: arrays of shape (M,), and the segment behind each point."""

    rates_dps: Array
    means: Array
    fitted: Array
    residuals_ppm: Array
    errors_ppm: Array
    full_scale: float
    segments: tuple[str, ...]


def residuals(result: ScaleFactorResult) -> Residuals:
    """ppm of the largest |mean_j − F_r|; the error bar is two standard errors of the mean."""
    rates = np.asarray(result.rates_dps, dtype=np.float64)
    means = np.asarray(result.means, dtype=np.float64)
    left = np.asarray(result.residuals, dtype=np.float64)
    rest = 0.5 * (result.static_before + result.static_after)
    full_scale = float(np.max(np.abs(means - rest))) if means.size else 0.0
    scale = 1e6 / full_scale if full_scale > 0.0 else 0.0
    errors = np.asarray(result.standard_errors, dtype=np.float64)
    if errors.shape != left.shape:
        errors = np.zeros_like(left)
    return Residuals(
        rates, means, result.K * rates + result.F0, left * scale, 2.0 * errors * scale, full_scale,
        _names(result.segments, rates.size),
    )  # fmt: skip


@dataclass(frozen=True)
class Positions:
    """Mean rates N_i/T of the positions of one axis, °/h.

    ``expected_dph`` is B plus the Earth rate along the axis there; ``azimuths_deg`` where the axis points,
    clockwise from north, for a multi-position run (else None, and the positions stand in their order).
    ``wave`` are (azimuth, rate) of the expected curve.
    """

    rates_dph: Array
    expected_dph: Array
    offset_dph: float
    labels: tuple[str, ...]
    azimuths_deg: Array | None
    wave: tuple[Array, Array] | None
    segments: tuple[str, ...]


def positions(result: ZeroOffsetResult, latitude_deg: float | None) -> Positions:
    """``latitude_deg`` None: the Earth rate is unknown and nothing but B is expected."""
    angles = np.asarray(result.angles_deg, dtype=np.float64)
    times = np.asarray(result.durations_s or [result.duration_s] * angles.size, dtype=np.float64)
    rates = 3600.0 * angles / times
    offset = 3600.0 * result.B
    names = result.segments if len(result.segments) == angles.size else ("",) * angles.size
    if result.schedule == "multi-position" and len(result.azimuths_deg) == angles.size:
        azimuths = np.asarray(result.azimuths_deg, dtype=np.float64)
        check = result.earth_rate_check or {}
        amplitude = 3600.0 * check.get("amplitude_dps", 0.0)
        # azimuth counts anticlockwise, the heading of the axis clockwise
        north = check.get("heading_at_zero_deg", 0.0) - check.get("phase_deg", 0.0)
        grid = np.linspace(0.0, 360.0, 181)
        labels = tuple(f"{azimuth:g}°" for azimuth in azimuths)

        def wave(at: Array) -> Array:
            return np.asarray(offset + amplitude * np.cos(np.radians(at - north)), dtype=np.float64)

        return Positions(rates, wave(azimuths), offset, labels, azimuths, (grid, wave(grid)), names)
    column = AXES.index(result.axis)
    where = [letters[column] for letters in result.orientations] or [""] * angles.size
    earth = np.array([_earth_along(letter, latitude_deg) for letter in where])
    return Positions(rates, offset + earth, offset, tuple(where), None, None, names)


def _earth_along(letter: str, latitude_deg: float | None) -> float:
    """Earth rate in °/h along a direction E N U W S D."""
    if latitude_deg is None or not letter:
        return 0.0
    latitude = np.radians(latitude_deg)
    if letter in "UD":
        return float(EARTH_RATE_DPH * np.sin(latitude) * (1.0 if letter == "U" else -1.0))
    return float(EARTH_RATE_DPH * np.cos(latitude) * np.cos(np.radians(_AZIMUTH_OF[letter])))


@dataclass(frozen=True)
class Turns:
    """Output angles of a misalignment at the end of the turns, degrees, + then −; the first take of each."""

    angles_deg: tuple[float, float]
    segments: tuple[str, str]


def turns(result: MisalignmentResult) -> Turns:
    """The two ends; their half difference over 360·n is L, their half sum the zero offset's part."""
    names = result.segments
    half = len(names) // 2
    ends = (names[0], names[half]) if half else ("", "")
    return Turns((result.angle_positive_deg, result.angle_negative_deg), ends)


@dataclass(frozen=True)
class Envelope:
    """A curve thinned to what a screen can show: lowest and highest of each bin, shape (2·bins,)."""

    time: Array
    values: Array


def envelope(time: Array, values: Array, bins: int = 1200) -> Envelope:
    """Every extreme survives; a curve with fewer samples than two a bin is left as it is."""
    count = values.size
    if count <= 2 * bins:
        return Envelope(time, values)
    size = -(-count // bins)
    full = (count // size) * size
    blocks = values[:full].reshape(-1, size)
    low, high = blocks.min(axis=1), blocks.max(axis=1)
    low_first = blocks.argmin(axis=1) <= blocks.argmax(axis=1)
    pairs = np.column_stack([np.where(low_first, low, high), np.where(low_first, high, low)])
    starts = time[:full:size]
    ends = time[size - 1 : full : size]
    times = np.column_stack([starts, ends])
    return Envelope(
        np.concatenate([times.ravel(), time[full:]]), np.concatenate([pairs.ravel(), values[full:]])
    )


def _names(segments: tuple[str, ...], count: int) -> tuple[str, ...]:
    """The ``count`` names of the points: without the rests before and after, as many on either side. Empty
    where that leaves none for each point (an imported result, repeated recordings)."""
    rests = len(segments) - count
    if rests < 0 or rests % 2:
        return ("",) * count
    return segments[rests // 2 : len(segments) - rests // 2]
