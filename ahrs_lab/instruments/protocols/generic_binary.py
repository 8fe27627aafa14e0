"""Fixed binary frames of a described format: sync, numbers, checksum."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import CHECKSUMS
from ahrs_lab.instruments.protocols.description import BinaryDescription, ColumnDescription, StreamDescription
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D, Run, stacked
from ahrs_lab.instruments.protocols.layouts import Layout, Number
from ahrs_lab.instruments.protocols.rows import COUNTER, TICKS, Clockwork, Part, rank_of
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.recording.samples import Samples


class BinaryFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`. Without a checksum any bytes behind a
    sync are a frame: such a format can be misread where its sync also occurs in its numbers."""

    def __init__(self, description: BinaryDescription) -> None:
        self._sync = description.sync
        self._checksum = CHECKSUMS[description.checksum]
        self._from = description.checksum_from
        self._order = description.checksum_order
        self.length = len(description.sync) + description.payload_length + self._checksum.size

    def find(self, data: bytes, start: int) -> int:
        place = data.find(self._sync[0], start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        head = data[start : start + len(self._sync)]
        if not self._sync.startswith(head):
            return NO_FRAME
        return self.length if len(head) == len(self._sync) else UNDECIDED

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        split = stop - self._checksum.size
        return self._checksum.of(data[start + self._from : split]) == int.from_bytes(
            data[split:stop], self._order
        )

    def key_length(self, _data: bytes, _start: int) -> int:
        return len(self._sync)

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        split = rows.shape[1] - self._checksum.size
        given = np.zeros(len(rows), dtype=np.int64)
        places = range(split, rows.shape[1])
        for place in places if self._order == "big" else reversed(places):
            given = given << 8 | rows[:, place]
        return np.asarray(self._checksum.of_rows(rows[:, self._from : split]) == given)

    def seal(self, rows: Bytes2D) -> None:
        """Write the checksum into each row."""
        size = self._checksum.size
        if size:
            values = self._checksum.of_rows(rows[:, self._from : -size])
            digits = [(values >> (8 * i) & 0xFF).astype(np.uint8) for i in range(size)]
            rows[:, -size:] = np.column_stack(digits if self._order == "little" else digits[::-1])


def raw_name(column: ColumnDescription) -> str:
    """Under which name a column that wraps is carried until it is made continuous."""
    if column.modulus is None:
        return column.name
    return TICKS if column.name == "t_s" else COUNTER


def clockwork_of(columns: Sequence[ColumnDescription]) -> Clockwork:
    """How the time and counter of a described format wrap."""
    ticks = next((c for c in columns if c.name == "t_s" and c.modulus), None)
    counter = next((c for c in columns if c.name == "counter" and c.modulus), None)
    return Clockwork(
        ticks_per_s=1.0 / ticks.factor if ticks else 1.0,
        tick_modulus=ticks.modulus if ticks and ticks.modulus else 1 << 32,
        counter_modulus=counter.modulus if counter and counter.modulus else 1 << 16,
    )


def layout_of(description: StreamDescription, frame: BinaryDescription) -> Layout:
    """Where the numbers of a described frame are."""
    found = []
    for column in description.columns:
        place, code = frame.fields[column.field]
        if column.modulus is None:
            found.append(Number(place, code, column.name, 1.0 / column.factor, column.offset))
        else:
            found.append(Number(place, code, raw_name(column)))
    size = frame.payload_length + CHECKSUMS[frame.checksum].size
    return Layout(frame.sync + bytes(size), tuple(found))


def encode_samples(description: StreamDescription, samples: Samples) -> bytes:
    """Frames that say ``samples``, one a row; numbers without a column are zero."""
    frame = description.frame
    if not isinstance(frame, BinaryDescription):
        raise TypeError("not a binary format")
    wrapped = {
        raw_name(c): np.mod(np.rint(samples[c.name] / c.factor), c.modulus)
        for c in description.columns
        if c.modulus is not None and c.name in samples
    }
    rows = layout_of(description, frame).write(samples.with_columns(wrapped))
    BinaryFormat(frame).seal(rows)
    return rows.tobytes()


class GenericBinaryStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`; units as described."""

    def __init__(self, description: StreamDescription, nominal_rate_hz: float | None = None) -> None:
        frame = description.frame
        if not isinstance(frame, BinaryDescription):
            raise TypeError("not a binary format")
        super().__init__([BinaryFormat(frame)], clockwork_of(description.columns), nominal_rate_hz)
        self.rate_unit, self.accel_unit = description.rate_unit, description.accel_unit
        self._layout = layout_of(description, frame)

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        orders, rows = stacked(runs)
        columns = self._layout.read(rows)
        return [Part("frame", rank_of(tuple(columns)), orders, columns)]
