"""``[initial]`` of a recording: the state that navigation begins with."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.inertial.quaternion import from_angles_deg
from ahrs_lab.inertial.strapdown import POLE_DEG, NavigationState
from ahrs_lab.messages import Message
from ahrs_lab.recording.bundle_source import HEADER_FILE
from ahrs_lab.recording.segment import RecordingHeader
from ahrs_lab.recording.toml_table import TomlTable

_FASTEST_MPS: Final = 1e4
_HIGHEST_M: Final = 1e5


def initial_state(header: RecordingHeader) -> NavigationState:
    """The state at the first segment's start; latitude, longitude and altitude may stand in ``[site]``
    instead.

    Raises InputError where it is missing, or not to be believed.
    """
    if header.initial is None:
        raise InputError(
            "The recording has no [initial]: add the state at the first segment's start to recording.toml "
            "(heading_deg, pitch_deg, roll_deg, velocity_enu_mps, latitude_deg, longitude_deg, altitude_m), "
            "for example from “ahrs-lab align”."
        )
    table = TomlTable(header.initial, HEADER_FILE, "[initial]")
    site = header.site
    latitude = table.number("latitude_deg", site.latitude_deg, -90.0, 90.0)
    if abs(latitude) > POLE_DEG:
        raise table.fault(
            Message(
                "at latitude {latitude}° east and north are lost: navigation in east, north, up ends at "
                "{limit}°.",
                latitude=latitude,
                limit=POLE_DEG,
            )
        )
    return NavigationState(
        attitude=from_angles_deg(
            table.number("heading_deg", None, -360.0, 360.0),
            table.number("pitch_deg", None, -90.0, 90.0),
            table.number("roll_deg", None, -180.0, 180.0),
        ),
        velocity_enu_mps=np.array(_velocity(table)),
        latitude_rad=math.radians(latitude),
        longitude_rad=math.radians(table.number("longitude_deg", site.longitude_deg or 0.0, -360.0, 360.0)),
        altitude_m=table.number("altitude_m", site.altitude_m, -_HIGHEST_M, _HIGHEST_M),
    )


def _velocity(table: TomlTable) -> list[float]:
    """Three numbers, m/s."""
    values = table.entries.get("velocity_enu_mps")
    if values is None:
        raise table.missing("velocity_enu_mps")
    numbers = isinstance(values, list) and all(
        isinstance(v, (int, float)) and not isinstance(v, bool) and abs(v) <= _FASTEST_MPS for v in values
    )
    if not numbers or len(values) != 3:
        raise table.fault(
            Message(
                "“velocity_enu_mps” is {value}: write three numbers, east, north and up in m/s, for example "
                "[0.0, 0.0, 0.0].",
                value=repr(values),
            )
        )
    return [float(v) for v in values]
