"""MicroStrain sensor data (MIP descriptor set 80) and filter attitude (82) as samples."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.attitudes import euler_numbers
from ahrs_lab.instruments.protocols.checksums import fletcher_rows
from ahrs_lab.instruments.protocols.frames import Bytes2D, Run, grouped, stacked
from ahrs_lab.instruments.protocols.layouts import DEG_IN_RAD, Layout, Number, numbers
from ahrs_lab.instruments.protocols.microstrain_mip import (
    FILTER_DATA,
    MAX_PAYLOAD,
    SENSOR_DATA,
    SYNC,
    MipFormat,
    field_places,
    packet_of,
)
from ahrs_lab.instruments.protocols.rows import TICKS, Clockwork, Part, rank_of
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples
from ahrs_lab.recording.segment import AccelUnit

ACCELERATION: Final = 0x04
ANGULAR_RATE: Final = 0x05
MAGNETIC_FIELD: Final = 0x06
DELTA_THETA: Final = 0x07
DELTA_VELOCITY: Final = 0x08
QUATERNION: Final = 0x0A
EULER: Final = 0x0C
INTERNAL_TIME: Final = 0x0E
TEMPERATURE: Final = 0x14
PRESSURE: Final = 0x17
OVER_RANGE: Final = 0x18
REFERENCE_TIME: Final = 0xD5
FILTER_EULER: Final = 0x05

_TICKS_PER_S: Final = 62_500.0
_CLOCKWORK: Final = Clockwork(ticks_per_s=_TICKS_PER_S, tick_modulus=1 << 32)

_QUATERNION_COLUMNS: Final = ("quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z")

_SENSOR: Final[dict[int, tuple[int, str, tuple[str, ...], float]]] = {
    ACCELERATION: (12, ">f4", ACCEL, 1.0),
    ANGULAR_RATE: (12, ">f4", GYRO, 1.0),
    MAGNETIC_FIELD: (12, ">f4", ("mag_x", "mag_y", "mag_z"), 1.0),
    DELTA_THETA: (12, ">f4", tuple(f"delta_angle_{a}_deg" for a in "xyz"), DEG_IN_RAD),
    DELTA_VELOCITY: (12, ">f4", tuple(f"delta_velocity_{a}_gs" for a in "xyz"), 1.0),
    QUATERNION: (16, ">f4", _QUATERNION_COLUMNS, 1.0),
    INTERNAL_TIME: (4, ">u4", (TICKS,), 1.0),
    TEMPERATURE: (12, ">f4", ("", "", "temperature_c"), 1.0),
    PRESSURE: (4, ">f4", ("pressure_mbar",), 1.0),
    OVER_RANGE: (2, ">u2", ("over_range",), 1.0),
}
"""Length, number format, columns and scale of the fields; temperature is minimum, maximum, mean."""


def _numbers(data_set: int, descriptor: int, place: int, length: int) -> tuple[Number, ...]:
    if descriptor == REFERENCE_TIME and length == 8:
        return numbers(place, ">u8", ("t_s",), 1e9)
    if data_set == FILTER_DATA:
        if descriptor == FILTER_EULER and length == 14:
            return euler_numbers(place, ">f4", "NED", DEG_IN_RAD)
        return ()
    if descriptor == EULER and length == 12:
        return euler_numbers(place, ">f4", "NED", DEG_IN_RAD)
    wanted, code, columns, per_unit = _SENSOR.get(descriptor, (0, "", (), 1.0))
    return numbers(place, code, columns, per_unit) if columns and wanted == length else ()


@cache
def layout_of(data_set: int, fields: tuple[tuple[int, int, int], ...], payload_length: int) -> Layout:
    """Where the numbers of a data packet with these fields are."""
    template = bytearray(SYNC + bytes((data_set, payload_length)) + bytes(payload_length + 2))
    found: list[Number] = []
    for descriptor, place, length in fields:
        template[4 + place - 2 : 4 + place] = bytes((length + 2, descriptor))
        found.extend(_numbers(data_set, descriptor, 4 + place, length))
    return Layout(bytes(template), tuple(found))


def packet_layout(descriptors: Sequence[int]) -> Layout:
    """Of a sensor data packet with these fields; raises ValueError for one that is not known and where they
    need more than 255 bytes."""
    fields, at = [], 0
    for descriptor in descriptors:
        length = 8 if descriptor == REFERENCE_TIME else 12 if descriptor == EULER else 0
        length = length or _SENSOR.get(descriptor, (0,))[0]
        if not length:
            raise ValueError(f"unknown sensor data field {descriptor:02X}")
        fields.append((descriptor, at + 2, length))
        at += 2 + length
    if at > MAX_PAYLOAD:
        raise ValueError(f"a packet has at most {MAX_PAYLOAD} bytes of fields, not {at}")
    return layout_of(SENSOR_DATA, tuple(fields), at)


def encode_samples(descriptors: Sequence[int], samples: Samples) -> bytes:
    """Sensor data packets that say ``samples`` (rates rad/s, specific force g), one a row; fields without a
    column are zero."""
    if "t_s" in samples:
        samples = samples.with_columns({TICKS: samples["t_s"] * _TICKS_PER_S})
    rows = packet_layout(descriptors).write(samples)
    check = fletcher_rows(rows[:, :-2])
    rows[:, -2], rows[:, -1] = check >> 8, check & 0xFF
    return rows.tobytes()


class MicroStrainStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`. Rates in rad/s, specific force in g,
    magnetic field in Gauss; device time is the reference time (D5, ns) or else the internal time stamp (0E,
    16 µs). ``over_range`` is the over-range field, 0 where all channels are within.

    ``replies`` are :class:`~ahrs_lab.instruments.protocols.microstrain_mip.MipPacket`.
    """

    accel_unit: AccelUnit = "g"

    def __init__(self, nominal_rate_hz: float | None = None) -> None:
        super().__init__([MipFormat()], _CLOCKWORK, nominal_rate_hz)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        data: list[tuple[Hashable, Run]] = []
        for run in runs:
            data_set = run.data[run.start + 2]
            if data_set in (SENSOR_DATA, FILTER_DATA):
                data.append(((data_set, run.length), run))
            else:
                self.replies.extend(packet_of(frame) for frame in run.frames())
        parts: list[Part] = []
        for group in grouped(data).values():
            parts.extend(_parts_of(*stacked(group)))
        return parts


def _parts_of(orders: NDArray[np.int64], rows: Bytes2D) -> list[Part]:
    """Equally long packets of one set, split by what fields they have."""
    parts = []
    while len(rows):
        frame = rows[0].tobytes()
        fields = field_places(frame[4:-2])
        places = [4 + place - 2 + i for _, place, _ in fields for i in range(2)]
        same = (rows[:, places] == rows[0, places]).all(axis=1)
        columns = layout_of(frame[2], fields, len(frame) - 6).read(rows[same])
        if columns:
            parts.append(Part((frame[2], fields), rank_of(tuple(columns)), orders[same], columns))
        orders, rows = orders[~same], rows[~same]
    return parts
