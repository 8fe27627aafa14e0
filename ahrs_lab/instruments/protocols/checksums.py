"""Checksums of frames: of one frame's bytes, and of many equally long frames at once."""

from __future__ import annotations

import binascii
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Bytes2D = NDArray[np.uint8]
ChecksumKind = Literal[
    "none", "xor", "sum8", "sum16", "crc16-ccitt", "crc16-xmodem", "crc16-modbus", "fletcher", "crc32"
]


def crc16_xmodem(data: bytes) -> int:
    """Polynomial 0x1021, initial value 0. Over a message with its CRC appended, high byte first: 0."""
    return binascii.crc_hqx(data, 0)


def crc16_ccitt(data: bytes) -> int:
    """Polynomial 0x1021, initial value 0xFFFF (also called CRC-16/IBM-3740 or CCITT-FALSE)."""
    return binascii.crc_hqx(data, 0xFFFF)


def xor8(data: bytes) -> int:
    """Exclusive or of all bytes."""
    number = int.from_bytes(data, "big")
    shift = 8
    while shift < 8 * len(data):
        # Folding by doubling distances leaves the xor of all bytes in the lowest one.
        number ^= number >> shift
        shift *= 2
    return number & 0xFF


def sum8(data: bytes) -> int:
    """Sum of all bytes modulo 256."""
    return sum(data) & 0xFF


def sum16(data: bytes) -> int:
    """Sum of all bytes modulo 65536."""
    return sum(data) & 0xFFFF


def fletcher(data: bytes) -> int:
    """MIP's pair: the running sum modulo 256 in the high byte, the running sum of that in the low byte."""
    return (sum(data) & 0xFF) << 8 | _weighted(data) & 0xFF


def _weighted(data: bytes) -> int:
    count = len(data)
    return int(np.frombuffer(data, np.uint8) @ np.arange(count, 0, -1, dtype=np.int64)) if count else 0


@cache
def _modbus_table() -> tuple[int, ...]:
    table = []
    for byte in range(256):
        value = byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
        table.append(value)
    return tuple(table)


def crc16_modbus(data: bytes) -> int:
    """Polynomial 0x8005 reflected, initial value 0xFFFF."""
    table, value = _modbus_table(), 0xFFFF
    for byte in data:
        value = value >> 8 ^ table[(value ^ byte) & 0xFF]
    return value


@lru_cache(maxsize=16)
def _modbus_places(length: int) -> tuple[NDArray[np.uint16], int]:
    """Shape (length, 256): what a byte at each place of a message adds to its CRC, and the CRC of zeros."""
    table = np.array(_modbus_table(), dtype=np.uint16)
    places = np.empty((length, 256), dtype=np.uint16)
    value = table
    for place in reversed(range(length)):
        places[place] = value
        value = value >> 8 ^ table[value & 0xFF]
    return places, crc16_modbus(bytes(length))


def crc16_modbus_rows(rows: Bytes2D) -> NDArray[np.int64]:
    """Shape (k,): :func:`crc16_modbus` of each row. A CRC is linear: the bytes' shares are summed without
    carry."""
    places, zeros = _modbus_places(rows.shape[1])
    shares = places[np.arange(rows.shape[1]), rows]
    return np.asarray(np.bitwise_xor.reduce(shares, axis=1), dtype=np.int64) ^ zeros


def sum_rows(rows: Bytes2D) -> NDArray[np.int64]:
    """Shape (k,): sum of each row's bytes."""
    return np.asarray(rows.sum(axis=1), dtype=np.int64)


def fletcher_rows(rows: Bytes2D) -> NDArray[np.int64]:
    """Shape (k,): :func:`fletcher` of each row."""
    length = rows.shape[1]
    # Whole numbers far below 2⁵³ are exact in float64, whose matrix product is the fast one.
    weights = np.column_stack([np.ones(length), np.arange(length, 0, -1.0)])
    sums = np.asarray(rows.astype(np.float64) @ weights, dtype=np.int64) & 0xFF
    return np.asarray(sums[:, 0] * 256 + sums[:, 1], dtype=np.int64)


def _xor_rows(rows: Bytes2D) -> NDArray[np.int64]:
    return np.asarray(np.bitwise_xor.reduce(rows, axis=1), dtype=np.int64)


def each_row(function: Callable[[bytes], int]) -> Callable[[Bytes2D], NDArray[np.int64]]:
    """``function`` of the bytes of each row."""

    def rows_of(rows: Bytes2D) -> NDArray[np.int64]:
        data, length = rows.tobytes(), rows.shape[1]
        starts = range(0, len(data), length) if length else range(0)
        values = [function(data[at : at + length]) for at in starts]
        return np.array(values, dtype=np.int64)

    return rows_of


@dataclass(frozen=True)
class Checksum:
    """One kind: how many bytes it takes, of one message, of many."""

    size: int
    of: Callable[[bytes], int]
    of_rows: Callable[[Bytes2D], NDArray[np.int64]]


CHECKSUMS: Final[dict[ChecksumKind, Checksum]] = {
    "none": Checksum(0, lambda _: 0, lambda rows: np.zeros(len(rows), dtype=np.int64)),
    "xor": Checksum(1, xor8, _xor_rows),
    "sum8": Checksum(1, sum8, lambda rows: sum_rows(rows) & 0xFF),
    "sum16": Checksum(2, sum16, lambda rows: sum_rows(rows) & 0xFFFF),
    "crc16-ccitt": Checksum(2, crc16_ccitt, each_row(crc16_ccitt)),
    "crc16-xmodem": Checksum(2, crc16_xmodem, each_row(crc16_xmodem)),
    "crc16-modbus": Checksum(2, crc16_modbus, crc16_modbus_rows),
    "fletcher": Checksum(2, fletcher, fletcher_rows),
    "crc32": Checksum(4, zlib.crc32, each_row(zlib.crc32)),
}
"""Of the kinds that a description may name."""
