"""Does the case stand as the segment says? Gravity on the accelerometers, or the attitude output, answers."""

from __future__ import annotations

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.recording.clean_rows import CleanRows
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.samples import ACCEL, ATTITUDE, Array, Samples
from ahrs_lab.recording.segment import AccelUnit, Segment

TILT_LIMIT_DEG = 5.0
"""At rest, by the accelerometers in a physical unit or by the attitude output."""
COARSE_LIMIT_DEG = 30.0
"""While turning (a lever arm adds centripetal acceleration), and in counts (whose zero is not known)."""
MAGNITUDE_LIMIT = 0.05

_GRAVITY = {"m/s^2": 9.80665, "g": 1.0}


def up_by_attitude(samples: Samples) -> Array:
    """Shape (3,): mean direction of up in case axes (x up, y right, z forward: the standard's tie of axes and
    angles) by pitch θ and roll γ: (cos γ·cos θ, −sin γ·cos θ, sin θ), from the third column of C_n^b (annex
    B)."""
    pitch, roll = np.radians(samples["pitch_deg"]), np.radians(samples["roll_deg"])
    up = (np.cos(roll) * np.cos(pitch), -np.sin(roll) * np.cos(pitch), np.sin(pitch))
    return np.array([np.nanmean(component) for component in up])


def check_gravity(segment: Segment, rows: CleanRows, accel_unit: AccelUnit, found: FindingList) -> None:
    """Compare the mean specific force with the orientation; add a finding where they disagree."""
    at_rest = segment.role in ("static_before", "static_after", "position")
    samples = rows.samples
    if all(_has_numbers(samples, name) for name in ACCEL):
        felt = np.array([float(np.nanmean(samples[name])) for name in ACCEL])
        limit = TILT_LIMIT_DEG if at_rest and accel_unit != "LSB" else COARSE_LIMIT_DEG
        source = Message("the accelerometers")
    elif at_rest and all(_has_numbers(samples, name) for name in ATTITUDE[1:]):
        felt, limit = up_by_attitude(samples), TILT_LIMIT_DEG
        source = Message("the attitude output")
    else:
        return
    size = float(np.linalg.norm(felt))
    expected = segment.orientation.gravity_unit()
    tilt = (
        float(np.degrees(np.arctan2(np.linalg.norm(np.cross(expected, felt)), expected @ felt)))
        if size
        else 180.0
    )
    line = int(rows.lines[0])
    if tilt > limit:
        found.add(
            "orientation",
            Message(
                "{source} feel {up} up, {tilt}° away from the orientation {orientation}: "
                "the case was mounted otherwise, or the orientation is written wrongly.",
                source=source,
                up=feels(felt),
                tilt=round(tilt, 1),
                orientation=segment.orientation.letters,
            ),
            line,
            "unusable",
        )
    elif at_rest and source.template == "the accelerometers" and accel_unit in _GRAVITY:
        _check_magnitude(size / _GRAVITY[accel_unit], size, accel_unit, line, found)


def feels(felt: Array) -> str:
    """The case axis nearest to up: ``"x+"``, ``"x-"``, …"""
    index = int(np.argmax(np.abs(felt)))
    return AXES[index] + ("+" if felt[index] > 0 else "-")


def _check_magnitude(ratio: float, size: float, unit: str, line: int, found: FindingList) -> None:
    if abs(ratio - 1) > MAGNITUDE_LIMIT:
        found.add(
            "magnitude",
            Message(
                "the specific force at rest is {size} {unit}, not that of gravity: is accel_unit right?",
                size=round(size, 4),
                unit=unit,
            ),
            line,
        )


def _has_numbers(samples: Samples, name: str) -> bool:
    column = samples.get(name)
    return column is not None and bool(np.any(np.isfinite(column)))
