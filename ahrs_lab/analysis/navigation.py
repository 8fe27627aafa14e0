"""Strapdown navigation of a recording, and what its own reference columns say of the result.

The height loop (2-61) follows the column ``altitude_m`` where it is recorded (a barometer's, or a
reference's), else the height of ``[initial]``: right for a carrier that keeps its level, a bench above all.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.initial_state import initial_state
from ahrs_lab.analysis.navigation_record import NavigationRecord, navigation_record
from ahrs_lab.analysis.navigation_result import COLUMNS, ERRORS, Damping, NavigationResult
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.block_of_steps import K1_PER_S, K2_PER_S2
from ahrs_lab.inertial.earth import meridian_radius_m, transverse_radius_m
from ahrs_lab.inertial.strapdown import (
    POLE_DEG,
    HeightReference,
    Navigation,
    NavigationError,
    NavigationState,
    PoleError,
    navigate,
)
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import Recording

Array = NDArray[np.float64]

_HEIGHT_GROWS_S: Final = 600.0


def navigate_recording(recording: Recording, damping: Damping = "none") -> NavigationResult:
    """From ``[initial]`` through the segments that follow each other.

    Raises InputError where the recording cannot be navigated.
    """
    start = initial_state(recording.header)
    rows = navigation_record(recording)
    notes: list[Message] = []
    height = _height(rows, start, notes) if damping == "baro" else None
    path = _navigated(start, rows, height)
    values = _columns(path)
    series = {name: column[1:] for name, column in values.items()}
    result_start = {name: float(column[0]) for name, column in values.items()}
    result_start["t_s"] = float(rows.t_s[0] - rows.interval_s[0])
    warnings = list(rows.warnings)
    if damping == "none" and rows.t_s[-1] - result_start["t_s"] > _HEIGHT_GROWS_S:
        warnings.append(
            Message(
                "The height is not held: its error grows by e in 9.5 minutes, and more than an hour of it "
                "says nothing. With a height from elsewhere: altitude damping “baro”."
            )
        )
    return NavigationResult(
        rows.files,
        rows.t_s,
        series,
        result_start,
        _errors(series, rows.columns),
        damping,
        tuple(notes),
        tuple(warnings),
    )


def _navigated(start: NavigationState, rows: NavigationRecord, height: HeightReference | None) -> Navigation:
    try:
        return navigate(start, rows.angle_rad, rows.velocity_mps, rows.interval_s, height=height)
    except PoleError as error:
        raise InputError(
            "{file}: after {time} s the path is nearer to a pole than {limit}° of latitude, where east and "
            "north are lost.",
            file=", ".join(rows.files),
            time=f"{rows.t_s[error.index]:.6g}",
            limit=POLE_DEG,
        ) from error
    except NavigationError as error:
        raise InputError(
            "{file}: after {time} s the numbers run away: look at the units of recording.toml (rate_unit, "
            "accel_unit) and at [initial].",
            file=", ".join(rows.files),
            time=f"{rows.t_s[error.index]:.6g}",
        ) from error


def _height(rows: NavigationRecord, start: NavigationState, notes: list[Message]) -> HeightReference:
    """The recorded height, cells without a number filled in between; else the initial one."""
    recorded = rows.columns.get("altitude_m")
    known = None if recorded is None else np.isfinite(recorded)
    gains = {"k1": K1_PER_S, "k2": K2_PER_S2}
    if recorded is None or known is None or not np.any(known):
        notes.append(
            Message(
                "Height loop: k₁ = {k1} /s, k₂ = {k2} /s²; the recording has no column altitude_m, so the "
                "initial height is held.",
                **gains,
            )
        )
        return HeightReference(np.full(len(rows.t_s) + 1, start.altitude_m))
    notes.append(
        Message("Height loop: k₁ = {k1} /s, k₂ = {k2} /s²; it follows the column altitude_m.", **gains)
    )
    filled = np.interp(rows.t_s, rows.t_s[known], recorded[known])
    return HeightReference(np.concatenate((filled[:1], filled)))


def _columns(path: Navigation) -> dict[str, Array]:
    angles = path.angles_deg()
    place = (np.degrees(path.latitude_rad), np.degrees(path.longitude_rad), path.altitude_m)
    return dict(zip(COLUMNS, (*angles, *path.velocity_enu_mps, *place), strict=True))


def _errors(series: dict[str, Array], recorded: dict[str, Array]) -> dict[str, Array]:
    """Of each column that both have; latitude and longitude become metres."""
    latitude = series["latitude_deg"]
    metres = {
        "latitude_deg": np.radians(1.0) * (meridian_radius_m(latitude) + series["altitude_m"]),
        "longitude_deg": np.radians(np.cos(np.radians(latitude)))
        * (transverse_radius_m(latitude) + series["altitude_m"]),
    }
    errors = {}
    for name, error in zip(COLUMNS, ERRORS, strict=True):
        if name not in recorded:
            continue
        difference = series[name] - recorded[name]
        if name in ("heading_deg", "roll_deg", "longitude_deg"):
            difference = (difference + 180.0) % 360.0 - 180.0
        errors[error] = difference * metres.get(name, 1.0)
    return {name: values for name, values in errors.items() if np.any(np.isfinite(values))}
