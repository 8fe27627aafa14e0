"""Xsens XBus: FA FF, message identifier, length, data, checksum; everything after FA sums to 0 modulo 256.

Numbers are big-endian. A length byte of FF announces a 16-bit length.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import sum_rows
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D, FrameScanner, LinkCounts, Run

PREAMBLE: Final = 0xFA
BUS_ID: Final = 0xFF
_EXTENDED: Final = 0xFF
_MAX_DATA: Final = 2048

REQ_DEVICE_ID: Final = 0x00
DEVICE_ID: Final = 0x01
INIT_MT: Final = 0x02
REQ_CONFIGURATION: Final = 0x0C
CONFIGURATION: Final = 0x0D
GO_TO_MEASUREMENT: Final = 0x10
GO_TO_MEASUREMENT_ACK: Final = 0x11
REQ_FIRMWARE: Final = 0x12
FIRMWARE: Final = 0x13
SET_BAUDRATE: Final = 0x18
SET_BAUDRATE_ACK: Final = 0x19
REQ_PRODUCT_CODE: Final = 0x1C
PRODUCT_CODE: Final = 0x1D
GO_TO_CONFIG: Final = 0x30
GO_TO_CONFIG_ACK: Final = 0x31
MT_DATA2: Final = 0x36
WAKE_UP: Final = 0x3E
WAKE_UP_ACK: Final = 0x3F
RESET: Final = 0x40
RESET_ACK: Final = 0x41
ERROR: Final = 0x42
SET_OUTPUT_CONFIGURATION: Final = 0xC0
OUTPUT_CONFIGURATION: Final = 0xC1

ERRORS: Final[dict[int, str]] = {
    0x03: "invalid period",
    0x04: "invalid message",
    0x1E: "timer overflow",
    0x20: "invalid baud rate",
    0x21: "invalid parameter",
    0x28: "device error",
}
"""What the first byte of an error message says."""

BAUD_CODES: Final[dict[int, int]] = {
    9600: 0x09, 19200: 0x07, 38400: 0x05, 57600: 0x04, 115200: 0x02, 230400: 0x01, 460800: 0x00, 921600: 0x80,
}  # fmt: skip
"""What SetBaudrate calls them."""


@dataclass(frozen=True)
class XbusMessage:
    """One message: its identifier and data."""

    mid: int
    data: bytes = b""

    @property
    def error(self) -> int | None:
        """The code of an error message, else None."""
        return self.data[0] if self.mid == ERROR and self.data else None

    @property
    def acknowledges(self) -> int | None:
        """The request this answers: answers have its number plus one. None for data and errors."""
        return self.mid - 1 if self.mid & 1 else None


class XbusFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`."""

    def find(self, data: bytes, start: int) -> int:
        place = data.find(PREAMBLE, start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        available = len(data) - start
        if available > 1 and data[start + 1] != BUS_ID:
            return NO_FRAME
        if available < 4:
            return UNDECIDED
        length = data[start + 3]
        if length != _EXTENDED:
            return length + 5
        if available < 6:
            return UNDECIDED
        length = data[start + 4] << 8 | data[start + 5]
        return length + 7 if length <= _MAX_DATA else NO_FRAME

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        return sum(data[start + 1 : stop]) & 0xFF == 0

    def key_length(self, data: bytes, start: int) -> int:
        return 6 if data[start + 3] == _EXTENDED else 4

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        return np.asarray(sum_rows(rows[:, 1:]) & 0xFF == 0)


def data_start(frame: bytes, start: int = 0) -> int:
    """Where the data of a valid frame begins."""
    return start + (6 if frame[start + 3] == _EXTENDED else 4)


def message_of(frame: bytes) -> XbusMessage:
    """From the bytes of a valid frame."""
    return XbusMessage(frame[2], frame[data_start(frame) : -1])


def header(mid: int, length: int) -> bytes:
    """What stands before ``length`` bytes of data; raises ValueError beyond 2048."""
    if length > _MAX_DATA:
        raise ValueError(f"a message has at most {_MAX_DATA} bytes of data, not {length}")
    size = bytes((length,)) if length < _EXTENDED else struct.pack(">BH", _EXTENDED, length)
    return bytes((PREAMBLE, BUS_ID, mid)) + size


def encode(mid: int, data: bytes = b"") -> bytes:
    """A message: commands and the device's own are alike."""
    body = header(mid, len(data)) + data
    return body + bytes((-sum(body[1:]) & 0xFF,))


def encode_acknowledge(request: int, data: bytes = b"") -> bytes:
    """The device's answer to the message ``request``."""
    return encode(request + 1, data)


def encode_error(code: int) -> bytes:
    """The device's error message."""
    return encode(ERROR, bytes((code,)))


def encode_output_configuration(
    outputs: Iterable[tuple[int, int]], mid: int = SET_OUTPUT_CONFIGURATION
) -> bytes:
    """Ask for ``(data identifier, rate in Hz)``; FFFF is the highest rate there is. With ``mid``
    :data:`OUTPUT_CONFIGURATION` the device's answer."""
    return encode(mid, b"".join(struct.pack(">HH", xdi, rate_hz) for xdi, rate_hz in outputs))


def output_configuration(data: bytes) -> tuple[tuple[int, int], ...]:
    """What an output configuration message says; half a pair at its end is passed over."""
    return tuple(struct.unpack_from(">HH", data, at) for at in range(0, len(data) - 3, 4))


class XbusDecoder:
    """Messages as frames; see :class:`~ahrs_lab.instruments.protocols.frames.Decoder`."""

    def __init__(self) -> None:
        self._scanner = FrameScanner([XbusFormat()])
        self.counts: LinkCounts = self._scanner.counts

    def feed(self, data: bytes) -> list[XbusMessage]:
        return self._messages(self._scanner.feed(data))

    def flush(self) -> list[XbusMessage]:
        return self._messages(self._scanner.flush())

    @staticmethod
    def _messages(runs: list[Run]) -> list[XbusMessage]:
        return [message_of(data) for run in runs for data in run.frames()]
