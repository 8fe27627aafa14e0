"""Xsens MTData2 (message 36): repeated data identifier, length, numbers; as samples.

An identifier's low four bits say the number format (bits 0–1) and the local frame (bits 2–3).
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.attitudes import (
    QUATERNION,
    LocalFrame,
    attitude_of,
    euler_numbers,
    with_quaternion,
)
from ahrs_lab.instruments.protocols.checksums import sum_rows
from ahrs_lab.instruments.protocols.frames import Bytes2D, Run, grouped, stacked
from ahrs_lab.instruments.protocols.layouts import FIXED_16_32, Layout, Number, numbers
from ahrs_lab.instruments.protocols.rows import COUNTER, TICKS, Clockwork, Part, rank_of
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.instruments.protocols.xsens_xbus import MT_DATA2, XbusFormat, data_start, header, message_of
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples

Array = NDArray[np.float64]

PACKET_COUNTER: Final = 0x1020
SAMPLE_TIME_FINE: Final = 0x1060
TEMPERATURE: Final = 0x0810
QUATERNION_XDI: Final = 0x2010
EULER: Final = 0x2030
PRESSURE: Final = 0x3010
DELTA_V: Final = 0x4010
ACCELERATION: Final = 0x4020
FREE_ACCELERATION: Final = 0x4030
RATE_OF_TURN: Final = 0x8020
DELTA_Q: Final = 0x8030
MAGNETIC_FIELD: Final = 0xC020
STATUS_WORD: Final = 0xE020

FLOAT32, FIXED_12_20, FIXED_16_32_FORMAT, FLOAT64 = range(4)
"""Bits 0–1 of an identifier."""

LOCAL_FRAMES: Final[tuple[LocalFrame | None, ...]] = ("ENU", "NED", "NWU", None)
"""By bits 2–3 of an identifier."""

_FORMATS: Final = ((">f4", 1.0), (">i4", 2.0**20), (FIXED_16_32, 1.0), (">f8", 1.0))

_WHOLE: Final[dict[int, tuple[str, str]]] = {
    PACKET_COUNTER: (">u2", COUNTER),
    SAMPLE_TIME_FINE: (">u4", TICKS),
    PRESSURE: (">u4", "pressure_pa"),
    STATUS_WORD: (">u4", "status"),
}

_MEASURED: Final[dict[int, tuple[str, ...]]] = {
    TEMPERATURE: ("temperature_c",),
    QUATERNION_XDI: QUATERNION,
    DELTA_V: ("delta_velocity_x_mps", "delta_velocity_y_mps", "delta_velocity_z_mps"),
    ACCELERATION: ACCEL,
    FREE_ACCELERATION: ("free_accel_x", "free_accel_y", "free_accel_z"),
    RATE_OF_TURN: GYRO,
    DELTA_Q: ("delta_q_w", "delta_q_x", "delta_q_y", "delta_q_z"),
    MAGNETIC_FIELD: ("mag_x", "mag_y", "mag_z"),
}

_CLOCKWORK: Final = Clockwork(ticks_per_s=1e4, tick_modulus=1 << 32, counter_modulus=1 << 16)
_CLIPPED_FIRST_BIT: Final = 8
_CLIPPED_BITS: Final = 0x9FF
"""Of the status word shifted by eight: one bit an axis, and the flag of any."""


def size_of(xdi: int) -> int:
    """Bytes of one number of a measured quantity."""
    return Number(0, _FORMATS[xdi & 3][0], "").size


def items_of(data: bytes) -> tuple[tuple[int, int, int], ...]:
    """(identifier, place, length) of the items of MTData2; what is cut off at the end is left out."""
    items, at = [], 0
    while at + 3 <= len(data) and at + 3 + data[at + 2] <= len(data):
        items.append((data[at] << 8 | data[at + 1], at + 3, data[at + 2]))
        at += 3 + data[at + 2]
    return tuple(items)


def _numbers(xdi: int, place: int, length: int) -> tuple[Number, ...]:
    kind = xdi & 0xFFF0
    if kind in _WHOLE:
        code, column = _WHOLE[kind]
        return numbers(place, code, (column,)) if np.dtype(code).itemsize == length else ()
    code, per_unit = _FORMATS[xdi & 3]
    frame = LOCAL_FRAMES[xdi >> 2 & 3]
    if kind == EULER and frame and length == 3 * size_of(xdi):
        return euler_numbers(place, code, frame, per_unit)
    columns = _MEASURED.get(kind, ())
    return (
        numbers(place, code, columns, per_unit) if columns and length == len(columns) * size_of(xdi) else ()
    )


@cache
def layout_of(head: bytes, items: tuple[tuple[int, int, int], ...], data_length: int) -> Layout:
    """Where the numbers of an MTData2 message with this header and these items are; data behind the last
    item is passed over."""
    template = bytearray(head)
    found: list[Number] = []
    for xdi, place, length in items:
        template += xdi.to_bytes(2, "big") + bytes((length,)) + bytes(length)
        found.extend(_numbers(xdi, len(head) + place, length))
    return Layout(bytes(template).ljust(len(head) + data_length + 1, b"\0"), tuple(found))


def _default_length(xdi: int) -> int:
    kind = xdi & 0xFFF0
    if kind in _WHOLE:
        return np.dtype(_WHOLE[kind][0]).itemsize
    if kind == EULER:
        return 3 * size_of(xdi)
    if kind not in _MEASURED:
        raise ValueError(f"unknown data identifier {xdi:04X}")
    return len(_MEASURED[kind]) * size_of(xdi)


def message_layout(xdis: Iterable[int]) -> Layout:
    """Of the MTData2 message that has these identifiers; raises ValueError for one that is not known."""
    items, at = [], 0
    for xdi in xdis:
        length = _default_length(xdi)
        items.append((xdi, at + 3, length))
        at += 3 + length
    return layout_of(header(MT_DATA2, at), tuple(items), at)


def encode_samples(xdis: Sequence[int], samples: Samples) -> bytes:
    """MTData2 messages that say ``samples``, one a row; quantities without a column are zero.

    Time comes from ``t_s``, the packet counter from ``counter``, a quaternion from heading, pitch and roll.
    """
    raw = dict(samples.columns)
    if "t_s" in raw:
        raw[TICKS] = raw["t_s"] * _CLOCKWORK.ticks_per_s
    if "counter" in raw:
        raw[COUNTER] = raw["counter"]
    said = Samples(raw)
    for xdi in xdis:
        frame = LOCAL_FRAMES[xdi >> 2 & 3]
        if xdi & 0xFFF0 == QUATERNION_XDI and frame:
            said = with_quaternion(said, frame)
    rows = message_layout(xdis).write(said)
    rows[:, -1] = -sum_rows(rows[:, 1:-1]) & 0xFF
    return rows.tobytes()


class XsensStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`. Rates in rad/s, specific force in
    m/s², magnetic field in the device's arbitrary unit; device time is SampleTimeFine (100 µs). ``status`` is
    the status word, ``over_range`` its clipping flags, 0 where no channel clips. Attitude in any of the three
    local frames becomes the bundle's; the case's x is forward.

    ``replies`` are :class:`~ahrs_lab.instruments.protocols.xsens_xbus.XbusMessage`.
    """

    def __init__(self, nominal_rate_hz: float | None = None) -> None:
        super().__init__([XbusFormat()], _CLOCKWORK, nominal_rate_hz)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        data: list[tuple[Hashable, Run]] = []
        for run in runs:
            if run.data[run.start + 2] == MT_DATA2:
                data.append((run.length, run))
            else:
                self.replies.extend(message_of(frame) for frame in run.frames())
        parts: list[Part] = []
        for group in grouped(data).values():
            parts.extend(_parts_of(*stacked(group)))
        return parts


def _parts_of(orders: NDArray[np.int64], rows: Bytes2D) -> list[Part]:
    """Equally long messages, split by what items they have."""
    parts = []
    while len(rows):
        frame = rows[0].tobytes()
        start = data_start(frame)
        items = items_of(frame[start:-1])
        places = [start + place - 3 + i for _, place, _ in items for i in range(3)]
        same = (rows[:, places] == rows[0, places]).all(axis=1)
        if not items or sum(items[-1][1:]) < len(frame) - 1 - start:
            # Bytes behind the last item are none in this message, but may begin one in another.
            same = np.array([items_of(row[start:-1].tobytes()) == items for row in rows])
        if items:
            columns = _completed(
                layout_of(frame[:start], items, len(frame) - start - 1).read(rows[same]), items
            )
            parts.append(Part(items, rank_of(tuple(columns)), orders[same], columns))
        orders, rows = orders[~same], rows[~same]
    return parts


def _completed(columns: dict[str, Array], items: tuple[tuple[int, int, int], ...]) -> dict[str, Array]:
    if QUATERNION[0] in columns and "heading_deg" not in columns:
        frame = next(
            (LOCAL_FRAMES[xdi >> 2 & 3] for xdi, _, _ in items if xdi & 0xFFF0 == QUATERNION_XDI), None
        )
        if frame:
            columns.update(attitude_of([columns[name] for name in QUATERNION], frame))
    if "status" in columns:
        flags = columns["status"].astype(np.int64) >> _CLIPPED_FIRST_BIT & _CLIPPED_BITS
        columns["over_range"] = flags.astype(np.float64)
    return columns
