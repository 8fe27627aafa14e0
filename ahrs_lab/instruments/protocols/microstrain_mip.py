"""MicroStrain MIP: 75 65, descriptor set, length, fields, two check bytes.

A field is its length, a descriptor and big-endian data. A packet has at most 261 bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import fletcher, fletcher_rows
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D, FrameScanner, LinkCounts, Run

SYNC: Final = b"\x75\x65"
MAX_PAYLOAD: Final = 255

BASE_COMMANDS: Final = 0x01
COMMANDS_3DM: Final = 0x0C
SENSOR_DATA: Final = 0x80
FILTER_DATA: Final = 0x82
ACKNOWLEDGE: Final = 0xF1

PING: Final = 0x01
SET_IDLE: Final = 0x02
DEVICE_INFO: Final = 0x03
RESUME: Final = 0x06
BASE_RATE: Final = 0x0E
MESSAGE_FORMAT: Final = 0x0F
STREAM: Final = 0x11

DEVICE_INFO_REPLY: Final = 0x81
MESSAGE_FORMAT_REPLY: Final = 0x8F
BASE_RATE_REPLY: Final = 0x8E
STREAM_REPLY: Final = 0x91

APPLY: Final = 0x01
READ: Final = 0x02
"""Functions: the first byte of a setting's field."""

ACK_CODES: Final[dict[int, str]] = {
    0: "accepted",
    1: "unknown command",
    2: "invalid checksum",
    3: "invalid parameter",
    4: "command failed",
    5: "command timed out",
}
"""What the second byte of an acknowledgement says."""


@dataclass(frozen=True)
class MipField:
    """A field of a packet."""

    descriptor: int
    data: bytes = b""


@dataclass(frozen=True)
class MipPacket:
    """A packet; ``fields`` up to where the payload is no field any more."""

    descriptor_set: int
    fields: tuple[MipField, ...]

    @property
    def acknowledgements(self) -> tuple[tuple[int, int], ...]:
        """(command, code) of each acknowledgement in it; code 0 is accepted."""
        return tuple(
            (field.data[0], field.data[1])
            for field in self.fields
            if field.descriptor == ACKNOWLEDGE and len(field.data) >= 2
        )


class MipFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`."""

    def find(self, data: bytes, start: int) -> int:
        place = data.find(SYNC[0], start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        available = len(data) - start
        if available > 1 and data[start + 1] != SYNC[1]:
            return NO_FRAME
        return UNDECIDED if available < 4 else data[start + 3] + 6

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        return fletcher(data[start : stop - 2]) == data[stop - 2] << 8 | data[stop - 1]

    def key_length(self, _data: bytes, _start: int) -> int:
        return 4

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        given = rows[:, -2].astype(np.int64) << 8 | rows[:, -1]
        return np.asarray(fletcher_rows(rows[:, :-2]) == given)


def field_places(payload: bytes) -> tuple[tuple[int, int, int], ...]:
    """(descriptor, place of its data, length of its data) of each field of a payload."""
    places, at = [], 0
    while at + 2 <= len(payload) and 2 <= payload[at] <= len(payload) - at:
        places.append((payload[at + 1], at + 2, payload[at] - 2))
        at += payload[at]
    return tuple(places)


def packet_of(frame: bytes) -> MipPacket:
    """From the bytes of a valid frame."""
    payload = frame[4:-2]
    fields = tuple(MipField(d, payload[at : at + n]) for d, at, n in field_places(payload))
    return MipPacket(frame[2], fields)


def encode(descriptor_set: int, fields: Iterable[tuple[int, bytes]] = ()) -> bytes:
    """A packet of ``(descriptor, data)``: commands and the device's own are alike. Raises ValueError where
    the fields need more than 255 bytes."""
    payload = b"".join(bytes((len(data) + 2, descriptor)) + data for descriptor, data in fields)
    if len(payload) > MAX_PAYLOAD:
        raise ValueError(f"a packet has at most {MAX_PAYLOAD} bytes of fields, not {len(payload)}")
    body = SYNC + bytes((descriptor_set, len(payload))) + payload
    return body + struct.pack(">H", fletcher(body))


def encode_acknowledge(
    descriptor_set: int, command: int, code: int = 0, reply: Iterable[tuple[int, bytes]] = ()
) -> bytes:
    """The device's answer to one command field, with what it was asked for in ``reply``."""
    return encode(descriptor_set, [(ACKNOWLEDGE, bytes((command, code))), *reply])


def encode_message_format(
    fields: Iterable[tuple[int, int]], data_set: int = SENSOR_DATA, function: int = APPLY
) -> bytes:
    """Ask for ``(descriptor, decimation)``; sent every ``decimation`` samples of the base rate."""
    return encode(
        COMMANDS_3DM, [(MESSAGE_FORMAT, bytes((function,)) + message_format_data(fields, data_set))]
    )


def message_format_data(fields: Iterable[tuple[int, int]], data_set: int = SENSOR_DATA) -> bytes:
    """Data of a message format: as the device's reply field has it, too."""
    listed = list(fields)
    return bytes((data_set, len(listed))) + b"".join(struct.pack(">BH", d, n) for d, n in listed)


def message_format_of(data: bytes) -> tuple[int, tuple[tuple[int, int], ...]]:
    """(data set, ((descriptor, decimation), …)) of a message format reply."""
    count = (len(data) - 2) // 3
    entries = (struct.unpack_from(">BH", data, 2 + 3 * i) for i in range(max(0, min(data[1], count))))
    return data[0], tuple((d, n) for d, n in entries)


def encode_stream(on: bool, data_set: int = SENSOR_DATA) -> bytes:
    """Stop or start what the device sends by itself."""
    return encode(COMMANDS_3DM, [(STREAM, bytes((APPLY, data_set, int(on))))])


def encode_idle() -> bytes:
    """Pause all output."""
    return encode(BASE_COMMANDS, [(SET_IDLE, b"")])


def encode_resume() -> bytes:
    """Leave idle."""
    return encode(BASE_COMMANDS, [(RESUME, b"")])


def encode_base_rate_request(data_set: int = SENSOR_DATA) -> bytes:
    """Ask for the rate that decimations divide."""
    return encode(COMMANDS_3DM, [(BASE_RATE, bytes((data_set,)))])


class MipDecoder:
    """Packets as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([MipFormat()])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[MipPacket]:
        return self._packets(self._scanner.feed(data))

    def flush(self) -> list[MipPacket]:
        return self._packets(self._scanner.flush())

    @staticmethod
    def _packets(runs: list[Run]) -> list[MipPacket]:
        return [packet_of(data) for run in runs for data in run.frames()]
