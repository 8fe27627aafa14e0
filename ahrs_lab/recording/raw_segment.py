"""A segment file as it was read, before any check: all its rows, with what could not be read as a number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.recording.samples import ANGLE, ATTITUDE, GYRO, POSITION, VELOCITY_ENU, Array

MAX_ROWS = 50_000_000
MAX_COLUMNS = 256


class SegmentFileError(InputError):
    """No sample can be read from a segment's file; ``line`` says where, 0 for all of it."""

    def __init__(self, what: Message, line: int = 0) -> None:
        super().__init__(what)
        self.line = line


@dataclass(frozen=True)
class RawSegment:
    """Columns of shape (n,), float64, NaN where a cell holds no number, and each row's line in the file.

    ``texts`` are the cells that are no numbers, by row and column; ``ragged`` the rows with a wrong number of
    cells (their whole row is NaN), by row; ``left_out`` the columns without any number.
    """

    columns: Mapping[str, Array]
    lines: NDArray[np.int64]
    texts: Mapping[tuple[int, str], str] = field(default_factory=dict)
    ragged: Mapping[int, int] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.lines)


def required_columns(names: Sequence[str]) -> tuple[str, ...]:
    """The columns without which a row is worth nothing: the time, and the rate or else the angle output
    or what a reference shows (velocity, position).

    Raises :class:`SegmentFileError` where they are not all there.
    """
    for needed in (GYRO, ANGLE, ATTITUDE, VELOCITY_ENU, POSITION):
        if all(name in names for name in needed) and "t_s" in names:
            return ("t_s", *needed)
    missing = [name for name in ("t_s", *GYRO) if name not in names]
    raise SegmentFileError(
        Message(
            "the column {missing} is missing: a segment needs t_s, gyro_x, gyro_y and gyro_z. "
            "It has {names}.",
            missing=", ".join(missing),
            names=", ".join(names),
        ),
        line=1,
    )


def check_column_names(names: Sequence[str]) -> None:
    """Raise :class:`SegmentFileError` for too many columns, one without a name or one named twice."""
    if len(names) > MAX_COLUMNS:
        raise SegmentFileError(
            Message(
                "{count} columns are more than the {limit} that a segment may have.",
                count=len(names),
                limit=MAX_COLUMNS,
            ),
            line=1,
        )
    for index, name in enumerate(names):
        if not name:
            raise SegmentFileError(Message("column {number} has no name.", number=index + 1), line=1)
        if name in names[:index]:
            raise SegmentFileError(Message("the column {name} is there twice.", name=name), line=1)


def consecutive_lines(rows: int) -> NDArray[np.int64]:
    """The lines of ``rows`` rows below a header row: 2, 3, …"""
    return np.arange(2, rows + 2, dtype=np.int64)
