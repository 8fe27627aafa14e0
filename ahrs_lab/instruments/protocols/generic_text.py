"""Delimited text of a described format: a line a sample."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.instruments.protocols.checksums import CHECKSUMS
from ahrs_lab.instruments.protocols.description import ColumnDescription, StreamDescription, TextDescription
from ahrs_lab.instruments.protocols.frames import NO_FRAME, UNDECIDED, Bytes2D, Run
from ahrs_lab.instruments.protocols.generic_binary import clockwork_of, raw_name
from ahrs_lab.instruments.protocols.rows import Part, rank_of
from ahrs_lab.instruments.protocols.stream import FramedStream
from ahrs_lab.recording.samples import Samples

_MAX_LENGTH: Final = 4096
_NEWLINE: Final = 0x0A
_NUMERIC: Final = b"0123456789+-.eEnNaAiIfF \t"


class TextFormat:
    """See :class:`~ahrs_lab.instruments.protocols.frames.FrameFormat`.

    With a prefix a frame is a line from its prefix to its line feed. Without one nothing tells where a line
    begins but the line feed before it: a frame is that line feed and the line up to the next one. So the
    first line of a stream, which may have lost its beginning, is never a sample.
    """

    def __init__(self, description: TextDescription, columns: Sequence[ColumnDescription]) -> None:
        self._description = description
        self._start = description.prefix or b"\n"
        self._checksum = CHECKSUMS[description.checksum]
        self._fields = sorted({column.field for column in columns})

    def find(self, data: bytes, start: int) -> int:
        place = data.find(self._start[0], start)
        return place if place >= 0 else len(data)

    def extent(self, data: bytes, start: int) -> int:
        if not self._start.startswith(data[start : start + len(self._start)]):
            return NO_FRAME
        end = data.find(_NEWLINE, start + 1, start + _MAX_LENGTH)
        if end < 0:
            return UNDECIDED if len(data) < start + _MAX_LENGTH else NO_FRAME
        return end - start + (1 if self._description.prefix else 0)

    def holds(self, data: bytes, start: int, stop: int) -> bool:
        return self.values(data[start:stop]) is not None

    def key_length(self, _data: bytes, _start: int) -> int:
        return 0

    def rows_hold(self, rows: Bytes2D) -> NDArray[np.bool_]:
        return np.array([self.holds(row.tobytes(), 0, len(row)) for row in rows], dtype=np.bool_)

    def values(self, line: bytes) -> dict[int, float] | None:
        """Numbers of the fields that are used; None where the line is not as described."""
        body = self._checked(line.strip(b"\r\n"))
        return None if body is None else self._numbers(body)

    def values_of_held(self, line: bytes) -> dict[int, float] | None:
        """:meth:`values` of a line whose checksum has been found right."""
        body = line.strip(b"\r\n")
        return self._numbers(body.rpartition(self._description.marker)[0] if self._checksum.size else body)

    def _numbers(self, body: bytes) -> dict[int, float] | None:
        fields = body[len(self._description.prefix) :].split(self._description.separator)
        if len(fields) != self._description.fields:
            return None
        used = [fields[i] for i in self._fields]
        if b"".join(used).translate(None, _NUMERIC):
            return None
        try:
            return {i: float(value) for i, value in zip(self._fields, used, strict=True)}
        except ValueError:
            return None

    def _checked(self, line: bytes) -> bytes | None:
        """The line without its checksum; None where that is wrong."""
        if not self._checksum.size:
            return line
        body, marker, given = line.rpartition(self._description.marker)
        counted = body[1:] if self._description.prefix else body
        digits = b"%0*X" % (2 * self._checksum.size, self._checksum.of(counted))
        return body if marker and given.strip().upper() == digits else None


def encode_samples(description: StreamDescription, samples: Samples) -> bytes:
    """Lines that say ``samples``, one a row, to ten digits; fields without a column are 0."""
    frame = description.frame
    if not isinstance(frame, TextDescription):
        raise TypeError("not a text format")
    matrix = np.zeros((len(samples), frame.fields))
    for column in description.columns:
        if column.name in samples:
            raw = (samples[column.name] - column.offset) / column.factor
            matrix[:, column.field] = np.mod(np.rint(raw), column.modulus) if column.modulus else raw
    separator, checksum = frame.separator or b" ", CHECKSUMS[frame.checksum]
    lines = []
    for row in matrix:
        body = frame.prefix + separator.join(b"%.15g" % value for value in row)
        if checksum.size:
            counted = body[1:] if frame.prefix else body
            body += frame.marker + b"%0*X" % (2 * checksum.size, checksum.of(counted))
        lines.append(body + b"\r\n")
    return b"".join(lines)


class GenericTextStream(FramedStream):
    """See :class:`~ahrs_lab.instruments.protocols.stream.StreamDecoder`; units as described."""

    def __init__(self, description: StreamDescription, nominal_rate_hz: float | None = None) -> None:
        frame = description.frame
        if not isinstance(frame, TextDescription):
            raise TypeError("not a text format")
        self._format = TextFormat(frame, description.columns)
        super().__init__([self._format], clockwork_of(description.columns), nominal_rate_hz)
        self.rate_unit, self.accel_unit = description.rate_unit, description.accel_unit
        self._columns = description.columns

    def _parts(self, runs: Sequence[Run]) -> list[Part]:
        rows = [self._format.values_of_held(run.data[run.start : run.start + run.length]) for run in runs]
        orders = np.array([run.order for run in runs], dtype=np.int64)
        fields = {c.field: np.array([row[c.field] if row else np.nan for row in rows]) for c in self._columns}
        columns = {
            raw_name(c): fields[c.field] if c.modulus else fields[c.field] * c.factor + c.offset
            for c in self._columns
        }
        return [Part("line", rank_of(tuple(columns)), orders, columns)]
