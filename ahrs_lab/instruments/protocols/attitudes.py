"""Attitudes as devices send them (roll, pitch, yaw or a quaternion, in one of three local frames) and as the
bundle keeps them: heading clockwise from north, pitch nose up, roll right side down, deg."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.layouts import Number
from ahrs_lab.recording.samples import ATTITUDE, Samples

Array = NDArray[np.float64]
LocalFrame = Literal["ENU", "NED", "NWU"]

QUATERNION: Final = ("quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z")

_SIGNS: Final[dict[LocalFrame, tuple[float, float, float]]] = {
    "ENU": (-1.0, 90.0, -1.0),
    "NED": (1.0, 0.0, 1.0),
    "NWU": (-1.0, 0.0, -1.0),
}
"""Sign of yaw in heading, what is added to it, sign of pitch.

In east-north-up and north-west-up the case's y points left and its z up, so that yaw is anticlockwise (from
east, from north) and positive pitch is nose down.
"""


def euler_numbers(place: int, code: str, frame: LocalFrame, per_degree: float = 1.0) -> tuple[Number, ...]:
    """Roll, pitch, yaw one behind the other from ``place`` on, as the bundle's columns."""
    yaw, north, pitch = _SIGNS[frame]
    size = Number(0, code, "").size
    return (
        Number(place, code, "roll_deg", per_degree),
        Number(place + size, code, "pitch_deg", pitch * per_degree),
        Number(place + 2 * size, code, "heading_deg", yaw * per_degree, north, half_turn=True),
    )


def attitude_of(quaternion: Sequence[Array], frame: LocalFrame) -> dict[str, Array]:
    """Heading, pitch and roll of the quaternion (w, x, y, z) that turns case axes into ``frame``."""
    w, x, y, z = quaternion
    yaw_sign, north, pitch_sign = _SIGNS[frame]
    roll = np.degrees(np.arctan2(2 * (y * z + w * x), w * w - x * x - y * y + z * z))
    pitch = np.degrees(np.arcsin(np.clip(2 * (w * y - x * z), -1.0, 1.0)))
    yaw = np.degrees(np.arctan2(2 * (x * y + w * z), w * w + x * x - y * y - z * z))
    heading = yaw_sign * yaw + north
    heading = np.where(heading > 180.0, heading - 360.0, heading)
    return dict(zip(ATTITUDE, (heading, pitch_sign * pitch, roll), strict=True))


def with_quaternion(samples: Samples, frame: LocalFrame) -> Samples:
    """``samples`` with the quaternion of their heading, pitch and roll added, unless it is there already."""
    if QUATERNION[0] in samples or any(name not in samples for name in ATTITUDE):
        return samples
    yaw_sign, north, pitch_sign = _SIGNS[frame]
    heading, pitch, roll = (samples[name] for name in ATTITUDE)
    half = [np.radians(a) / 2 for a in (yaw_sign * (heading - north), pitch_sign * pitch, roll)]
    (cy, cp, cr), (sy, sp, sr) = (np.cos(half), np.sin(half))
    parts = (
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    )
    return samples.with_columns(dict(zip(QUATERNION, parts, strict=True)))
