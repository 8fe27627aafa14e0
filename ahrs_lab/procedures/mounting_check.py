"""How the case really stands: gravity on the accelerometers, or the attitude output, against the asked
orientation.

A wrong mounting is refused before it is recorded: it would cost a day. The azimuth is not felt here; see
:mod:`~ahrs_lab.procedures.azimuth_check`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.procedures.figures import figure
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription

Array = NDArray[np.float64]

STILL_SWING_DEG = 0.5
"""How far the felt vertical may wander during the check."""
STILL_SWING_DPS = 1.0
"""How far the rate outputs' means may wander during the check."""
_PIECES = 4
_USUAL_G = {"m/s^2": 9.80665, "g": 1.0}


@dataclass(frozen=True)
class MountingFinding:
    """What was felt. ``feels`` is the axis that points up (``"x+"``), empty where nothing could be felt;
    ``tilt_deg`` the angle between the felt and the asked vertical (nan where nothing could be felt)."""

    asked: Orientation
    feels: str
    tilt_deg: float
    still: bool
    accepted: bool
    by: Literal["accelerometer", "attitude", "operator"]
    message: Message
    warnings: tuple[Message, ...] = field(default=())


def judge_mounting(
    samples: Samples, device: DeviceDescription, asked: Orientation, tolerance_deg: float
) -> MountingFinding:
    """Judge ``samples`` taken at rest; at least one row."""
    up, by = _felt_up(samples)
    if up is None:
        message = Message(
            "The device gives neither acceleration nor attitude: that {axis} points {direction} is the "
            "operator's word.",
            **_axis_words(asked.face),
        )
        return MountingFinding(asked, "", float("nan"), True, True, "operator", message, (message,))
    mean = up.mean(axis=0)
    length = float(np.linalg.norm(mean))
    if not np.isfinite(length) or length == 0.0:
        message = Message(
            "The accelerometers show nothing that can be gravity: check the device and its wiring."
        )
        return MountingFinding(asked, "", float("nan"), True, False, by, message)
    feels = _face(mean)
    tilt = _angle_deg(mean, asked.gravity_unit())
    still = _swing_deg(up) <= STILL_SWING_DEG and _rate_swing_dps(samples, device) <= STILL_SWING_DPS
    level = tilt <= tolerance_deg
    message = _message(asked, feels, tilt, still, level, tolerance_deg)
    warnings = _unit_warnings(length, device) if by == "accelerometer" else ()
    return MountingFinding(asked, feels, tilt, still, still and level, by, message, warnings)


def _felt_up(samples: Samples) -> tuple[Array | None, Literal["accelerometer", "attitude", "operator"]]:
    """Shape (n, 3): where up is in case axes, of any length."""
    if all(name in samples for name in ACCEL):
        return samples.matrix(ACCEL), "accelerometer"
    if "pitch_deg" in samples and "roll_deg" in samples:
        return up_from_attitude(samples["pitch_deg"], samples["roll_deg"]), "attitude"
    return None, "operator"


def up_from_attitude(pitch_deg: Array, roll_deg: Array) -> Array:
    """Shape (n, 3): up in case axes: the third column of ``R_y(γ)·R_x(θ)·R_z(ψ)`` (annex B: right, forward,
    up), pitch nose up and roll right side down positive.

    By the standard's tie of axes and angles X is up (heading), Y right (pitch), Z forward (roll).
    """
    pitch, roll = np.radians(pitch_deg), np.radians(roll_deg)
    return np.column_stack([np.cos(roll) * np.cos(pitch), -np.sin(roll) * np.cos(pitch), np.sin(pitch)])


def _face(up: Array) -> str:
    index = int(np.argmax(np.abs(up)))
    return AXES[index] + ("+" if up[index] > 0 else "-")


def _angle_deg(a: Array, b: Array) -> float:
    cross, dot = np.linalg.norm(np.cross(a, b)), float(a @ b)
    return float(np.degrees(np.arctan2(cross, dot)))


def _pieces(values: Array) -> Array:
    """Shape (m, k): means of up to four consecutive pieces."""
    return np.array([piece.mean(axis=0) for piece in np.array_split(values, min(_PIECES, len(values)))])


def _swing_deg(up: Array) -> float:
    mean = up.mean(axis=0)
    return max(_angle_deg(piece, mean) for piece in _pieces(up))


def _rate_swing_dps(samples: Samples, device: DeviceDescription) -> float:
    """Zero where the rate's unit says nothing of °/s."""
    if device.rate_unit == "LSB" or not all(name in samples for name in GYRO):
        return 0.0
    means = _pieces(samples.matrix(GYRO))
    swing = float(np.max(np.ptp(means, axis=0)))
    return float(np.degrees(swing)) if device.rate_unit == "rad/s" else swing


def _axis_words(face: str) -> dict[str, object]:
    return {"axis": face[0].upper(), "direction": Message("up") if face[1] == "+" else Message("down")}


def _message(
    asked: Orientation, feels: str, tilt: float, still: bool, level: bool, tolerance_deg: float
) -> Message:
    wanted = _axis_words(asked.face)
    if not level and feels != asked.face:
        felt = _axis_words(feels)
        return Message(
            "Asked: {axis} {direction}. The sensor feels {felt_axis} {felt_direction} (tilt {tilt}°). "
            "Turn the case so that {axis} points {direction}.",
            felt_axis=felt["axis"],
            felt_direction=felt["direction"],
            tilt=round(tilt, 1),
            **wanted,
        )
    if not level:
        return Message(
            "{axis} points {direction}, but {tilt}° off; up to {tolerance}° are allowed. Level the case.",
            tilt=round(tilt, 1),
            tolerance=figure(tolerance_deg),
            **wanted,
        )
    if not still:
        return Message("The case is not still: keep away from the table until it is.")
    return Message("{axis} points {direction}, {tilt}° off.", tilt=round(tilt, 2), **wanted)


def _unit_warnings(length: float, device: DeviceDescription) -> tuple[Message, ...]:
    usual = _USUAL_G.get(device.accel_unit)
    if usual is None or 0.9 < length / usual < 1.1:
        return ()
    for unit, value in _USUAL_G.items():
        if 0.9 < length / value < 1.1:
            return (
                Message(
                    "The accelerometers show {length} at rest: these look like {looks}, not {unit}. Correct "
                    "the device's acceleration unit.",
                    length=round(length, 3),
                    looks=unit,
                    unit=device.accel_unit,
                ),
            )
    return (
        Message(
            "The accelerometers show {length} {unit} at rest instead of {usual}: check the device and its "
            "unit.",
            length=round(length, 3),
            unit=device.accel_unit,
            usual=usual,
        ),
    )
