"""Numbers at fixed places of a frame, and the columns of the bundle they are: read and written by the same
table, so that a simulated unit speaks exactly what the driver reads.

A column is ``number / per_unit + offset``; ``per_unit`` says how many of the frame's numbers make one unit of
the column (10⁹ for a time in ns, 2²⁰ for fixed point, negative to turn a sign).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.frames import Bytes2D
from ahrs_lab.recording.samples import Samples

Array = NDArray[np.float64]

DEG_IN_RAD: Final = np.pi / 180.0
"""``per_unit`` of an angle that is sent in radians and kept in degrees."""

FIXED_16_32: Final = "fixed 16.32"
"""A number format numpy does not know: 32 bits of fraction, then 16 bits of whole number, big-endian."""


@dataclass(frozen=True)
class Number:
    """One number in a frame: ``place`` in bytes from the frame's start, numpy ``code`` (or
    :data:`FIXED_16_32`), and the column it gives. ``half_turn`` brings the column into (−180, 180]."""

    place: int
    code: str
    column: str
    per_unit: float = 1.0
    offset: float = 0.0
    half_turn: bool = False

    @property
    def size(self) -> int:
        """Bytes."""
        return 6 if self.code == FIXED_16_32 else np.dtype(self.code).itemsize


def numbers(
    place: int, code: str, columns: Iterable[str], per_unit: float = 1.0, offset: float = 0.0
) -> tuple[Number, ...]:
    """Equal numbers one behind the other; an empty column name leaves one out."""
    size = Number(0, code, "").size
    return tuple(
        Number(place + i * size, code, column, per_unit, offset) for i, column in enumerate(columns) if column
    )


@dataclass(frozen=True)
class Layout:
    """Frames of ``length`` bytes with ``numbers`` in them; ``template`` is one such frame, numbers zero."""

    template: bytes
    numbers: tuple[Number, ...] = field(default=())

    @property
    def length(self) -> int:
        """Bytes of a frame."""
        return len(self.template)

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """What it gives, in the order of the frame."""
        return tuple(number.column for number in self.numbers)

    def read(self, rows: Bytes2D) -> dict[str, Array]:
        """Columns, each of shape (k,), of k frames."""
        if not self.numbers:
            return {}
        frames = np.ascontiguousarray(rows).view(self._record)[:, 0]
        columns: dict[str, Array] = {}
        for i, number in enumerate(self.numbers):
            fixed = number.code == FIXED_16_32
            columns[number.column] = _column(_fixed(rows, number.place) if fixed else frames[f"n{i}"], number)
        return columns

    @cached_property
    def _record(self) -> np.dtype[np.void]:
        return np.dtype(
            {
                "names": [f"n{i}" for i in range(len(self.numbers))],
                "formats": ["V6" if n.code == FIXED_16_32 else n.code for n in self.numbers],
                "offsets": [n.place for n in self.numbers],
                "itemsize": self.length,
            }
        )

    def write(self, samples: Samples) -> Bytes2D:
        """Frames (n, length) that say ``samples``; numbers whose column is not there stay as in the template.

        Whole numbers are rounded and wrap as the device's own counters do.
        """
        rows = np.tile(np.frombuffer(self.template, np.uint8), (len(samples), 1))
        for number in self.numbers:
            column = samples.get(number.column)
            if column is not None:
                rows[:, number.place : number.place + number.size] = _bytes_of(column, number)
        return rows


def _column(raw: NDArray[np.generic], number: Number) -> Array:
    column = np.asarray(raw, dtype=np.float64)
    if number.per_unit != 1.0:
        column = column / number.per_unit
    if number.offset:
        column = column + number.offset
    if number.half_turn:
        column = np.where(np.abs(column) > 180.0, column - 360.0 * np.ceil(column / 360.0 - 0.5), column)
    return column


def _fixed(rows: Bytes2D, place: int) -> Array:
    part = np.ascontiguousarray(rows[:, place : place + 6])
    pair = part.view(np.dtype([("fraction", ">u4"), ("whole", ">i2")]))[:, 0]
    return np.asarray(pair["whole"] + pair["fraction"] / 2.0**32, dtype=np.float64)


def _bytes_of(column: Array, number: Number) -> Bytes2D:
    raw = (column - number.offset) * number.per_unit
    if number.code == FIXED_16_32:
        pair = np.empty(len(raw), dtype=np.dtype([("fraction", ">u4"), ("whole", ">i2")]))
        steps = np.rint(raw * 2.0**32)
        whole = np.floor(steps / 2.0**32)
        pair["whole"] = whole
        pair["fraction"] = steps - whole * 2.0**32
        return pair.view(np.uint8).reshape(len(raw), 6)
    kind = np.dtype(number.code)
    if kind.kind in "iu":
        # A negative number modulo the range is its two's complement.
        unsigned = np.mod(np.rint(raw), 2.0 ** (8 * kind.itemsize)).astype(np.uint64)
        whole = unsigned.astype(np.dtype(kind.str.replace("i", "u")))
        return whole.view(np.uint8).reshape(len(raw), kind.itemsize)
    return np.ascontiguousarray(raw.astype(kind)).view(np.uint8).reshape(len(raw), kind.itemsize)
