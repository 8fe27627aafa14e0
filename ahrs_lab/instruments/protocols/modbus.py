"""Modbus, the little of it that a temperature and humidity sensor needs: reading registers over RTU and TCP.

Own, because the well-kept library brings its transports and an event loop along; here the same links serve
that can be watched, damaged and replayed.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from ahrs_lab.instruments.protocols.checksums import crc16_modbus
from ahrs_lab.instruments.protocols.frames import LinkCounts

Function = Literal[3, 4]
"""3 reads holding registers, 4 input registers."""
ValueKind = Literal["int16", "uint16", "int32", "uint32", "float32"]
WordOrder = Literal["big", "little"]

DEFAULT_PORT = 502
LONGEST_READ = 125
_REQUEST = struct.Struct(">BBHH")
_MBAP = struct.Struct(">HHHB")
_LEAST_RTU = 5
_EXCEPTION_BIT = 0x80
_LONGEST_TCP = 254

EXCEPTIONS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "server device failure",
    6: "server device busy",
}


@dataclass(frozen=True)
class ModbusReply:
    """Registers read, or the code of an exception (0: none)."""

    unit: int
    function: int
    registers: tuple[int, ...] = ()
    exception: int = 0
    transaction: int = 0


def encode_rtu_read(unit: int, function: Function, address: int, count: int) -> bytes:
    """A request on a serial line."""
    return with_crc(_REQUEST.pack(unit, function, address, count))


def encode_tcp_read(transaction: int, unit: int, function: Function, address: int, count: int) -> bytes:
    """A request over TCP."""
    body = _REQUEST.pack(unit, function, address, count)[1:]
    return _MBAP.pack(transaction, 0, len(body) + 1, unit) + body


def encode_rtu_reply(unit: int, function: Function, registers: Sequence[int]) -> bytes:
    """The sensor's side."""
    return with_crc(struct.pack(f">BBB{len(registers)}H", unit, function, 2 * len(registers), *registers))


def encode_tcp_reply(transaction: int, unit: int, function: Function, registers: Sequence[int]) -> bytes:
    """The sensor's side."""
    body = struct.pack(f">BB{len(registers)}H", function, 2 * len(registers), *registers)
    return _MBAP.pack(transaction, 0, len(body) + 1, unit) + body


def with_crc(message: bytes) -> bytes:
    """RTU: the CRC follows, low byte first."""
    return message + struct.pack("<H", crc16_modbus(message))


class RtuDecoder:
    """Finds answers to reads on a serial line by length and CRC."""

    def __init__(self) -> None:
        self.counts = LinkCounts()
        self._rest = b""

    def feed(self, data: bytes) -> list[ModbusReply]:
        """The answers completed by ``data``."""
        self.counts.received_bytes += len(data)
        data = self._rest + data
        found: list[ModbusReply] = []
        at = 0
        while len(data) - at >= 3:
            length = _rtu_length(data[at + 1], data[at + 2])
            if length and at + length > len(data):
                break
            frame = data[at : at + length]
            if length and crc16_modbus(frame) == 0:
                found.append(_reply(frame[0], frame[1:-2]))
                self.counts.frames += 1
                at += length
            else:
                self.counts.failed += bool(length)
                self.counts.skipped_bytes += 1
                at += 1
        self._rest = data[at:]
        return found

    def flush(self) -> list[ModbusReply]:
        """Forget an answer that was not finished."""
        self.counts.skipped_bytes += len(self._rest)
        self._rest = b""
        return []


class TcpDecoder:
    """Finds answers to reads over TCP by their header."""

    def __init__(self) -> None:
        self.counts = LinkCounts()
        self._rest = b""

    def feed(self, data: bytes) -> list[ModbusReply]:
        """The answers completed by ``data``."""
        self.counts.received_bytes += len(data)
        data = self._rest + data
        found: list[ModbusReply] = []
        at = 0
        while len(data) - at >= _MBAP.size + 2:
            transaction, protocol, length, unit = _MBAP.unpack_from(data, at)
            body_at = at + _MBAP.size
            expected = _rtu_length(data[body_at], data[body_at + 1]) - 2 if length else 0
            if protocol != 0 or not 3 <= length <= _LONGEST_TCP or expected != length:
                self.counts.skipped_bytes += 1
                at += 1
                continue
            end = at + _MBAP.size - 1 + length
            if end > len(data):
                break
            found.append(_reply(unit, data[body_at:end], transaction))
            self.counts.frames += 1
            at = end
        self._rest = data[at:]
        return found

    def flush(self) -> list[ModbusReply]:
        """Forget an answer that was not finished."""
        self.counts.skipped_bytes += len(self._rest)
        self._rest = b""
        return []


def _rtu_length(function: int, second: int) -> int:
    """Of an answer with unit and CRC; 0 where it is none."""
    if function & ~_EXCEPTION_BIT not in (3, 4):
        return 0
    if function & _EXCEPTION_BIT:
        return _LEAST_RTU
    return _LEAST_RTU + second if second and second % 2 == 0 and second <= 2 * LONGEST_READ else 0


def _reply(unit: int, body: bytes, transaction: int = 0) -> ModbusReply:
    function = body[0]
    if function & _EXCEPTION_BIT:
        return ModbusReply(unit, function & ~_EXCEPTION_BIT, (), body[1], transaction)
    registers = struct.unpack(f">{(len(body) - 2) // 2}H", body[2:])
    return ModbusReply(unit, function, registers, 0, transaction)


def register_count(kind: ValueKind) -> int:
    """Registers of 16 bits that a value takes."""
    return 1 if kind in ("int16", "uint16") else 2


def value_of(registers: Sequence[int], kind: ValueKind, order: WordOrder = "big") -> float:
    """The number that registers hold; ``order`` of the words of 32 bits."""
    words = list(registers) if order == "big" else list(reversed(registers))
    data = struct.pack(f">{len(words)}H", *words)
    code = {"int16": ">h", "uint16": ">H", "int32": ">i", "uint32": ">I", "float32": ">f"}[kind]
    return float(struct.unpack(code, data)[0])
