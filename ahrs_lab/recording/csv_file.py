"""Segment files as CSV: a header row, commas, decimal points; full precision both ways.

A clean file is read by pyarrow in one go. One that pyarrow refuses is read line by line, so that every cell
that is no number is known by its line.
"""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator
from typing import BinaryIO

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.recording.arrow_columns import arrow_arrays
from ahrs_lab.recording.raw_segment import (
    MAX_ROWS,
    RawSegment,
    SegmentFileError,
    check_column_names,
    consecutive_lines,
)
from ahrs_lab.recording.samples import Array, Samples

_BOM = b"\xef\xbb\xbf"
_LONGEST_CELL_SHOWN = 40


def read_csv(data: bytes) -> RawSegment:
    """All rows of a CSV segment; raises :class:`SegmentFileError` where there is no table in it."""
    body = data.removeprefix(_BOM).rstrip(b"\r\n \t")
    if not body:
        raise SegmentFileError(Message("the file is empty: record the segment again."), line=1)
    names = _header(body.split(b"\n", 1)[0])
    if b"\n" not in body:
        raise SegmentFileError(
            Message("the file has a header row and no sample: record the segment again."), line=2
        )
    columns = _read_clean(body, names)
    if columns is not None:
        return RawSegment(columns, consecutive_lines(len(columns[names[0]])))
    return _read_line_by_line(body, names)


def write_csv(samples: Samples, target: BinaryIO) -> None:
    """Write the samples so that reading gives the same bits back (the shortest text that does)."""
    import pyarrow as pa
    from pyarrow import csv as arrow_csv

    header = io.StringIO()
    csv.writer(header, lineterminator="\n").writerow(samples.columns)
    target.write(header.getvalue().encode())
    table = pa.Table.from_arrays(arrow_arrays(samples), list(samples.columns))
    arrow_csv.write_csv(table, target, arrow_csv.WriteOptions(include_header=False))


def _header(first_line: bytes) -> list[str]:
    try:
        text = first_line.decode()
    except UnicodeDecodeError as error:
        raise SegmentFileError(
            Message("the header row is not UTF-8 text: save the file as CSV in UTF-8."), line=1
        ) from error
    names = [name.strip() for name in next(csv.reader([text.strip()]), [])]
    if len(names) == 1 and ";" in text:
        raise SegmentFileError(
            Message(
                "the columns are separated by semicolons: "
                "save the file with commas between columns and decimal points."
            ),
            line=1,
        )
    if names and all(_is_number(name) for name in names):
        raise SegmentFileError(
            Message("the header row is missing: the first line has to name the columns, beginning with t_s."),
            line=1,
        )
    check_column_names(names)
    return names


def _read_clean(body: bytes, names: list[str]) -> dict[str, Array] | None:
    """The columns if every cell of every row is a number (or nan, inf); None if one is not."""
    import pyarrow as pa
    from pyarrow import csv as arrow_csv

    try:
        table = arrow_csv.read_csv(
            io.BytesIO(body),
            read_options=arrow_csv.ReadOptions(column_names=names, skip_rows=1),
            parse_options=arrow_csv.ParseOptions(ignore_empty_lines=False),
            convert_options=arrow_csv.ConvertOptions(
                column_types={name: pa.float64() for name in names},
                null_values=[],
                strings_can_be_null=False,
            ),
        )
    except pa.ArrowInvalid:
        return None
    _check_rows(table.num_rows)
    return {name: np.asarray(table.column(name).to_numpy(), dtype=np.float64) for name in names}


def _read_line_by_line(body: bytes, names: list[str]) -> RawSegment:
    try:
        text = body.decode()
    except UnicodeDecodeError as error:
        line = body.count(b"\n", 0, error.start) + 1
        raise SegmentFileError(
            Message("the file is not UTF-8 text: save it as CSV in UTF-8."), line=line
        ) from error
    values: list[list[float]] = []
    lines: list[int] = []
    texts: dict[tuple[int, str], str] = {}
    ragged: dict[int, int] = {}
    nothing = [float("nan")] * len(names)
    for line, cells in _rows(text):
        row = len(values)
        if len(cells) != len(names):
            ragged[row] = len(cells)
            values.append(nothing)
        else:
            try:
                values.append([_number(cell) for cell in cells])
            except ValueError:
                values.append([float(cell) if _is_number(cell) else float("nan") for cell in cells])
                texts.update(
                    ((row, name), cell.strip()[:_LONGEST_CELL_SHOWN])
                    for name, cell in zip(names, cells, strict=True)
                    if not _is_number(cell)
                )
        lines.append(line)
        _check_rows(len(lines))
    matrix = np.array(values, dtype=np.float64).reshape(len(values), len(names))
    columns = {name: np.ascontiguousarray(matrix[:, i]) for i, name in enumerate(names)}
    wordy = tuple(name for name in names if not np.any(np.isfinite(columns[name])) and (0, name) in texts)
    kept = {name: column for name, column in columns.items() if name not in wordy}
    texts = {place: cell for place, cell in texts.items() if place[1] not in wordy}
    return RawSegment(kept, np.array(lines, dtype=np.int64), texts, ragged, wordy)


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of every row below the header that is not blank."""
    reader = csv.reader(io.StringIO(text, newline=""))
    try:
        for cells in itertools.islice(reader, 1, None):
            if any(cell.strip() for cell in cells):
                yield reader.line_num, cells
    except csv.Error as error:
        raise SegmentFileError(
            Message("the line cannot be read as CSV: {error}", error=error), line=reader.line_num
        ) from error


def _number(cell: str) -> float:
    """As ``float``, without Python's own underscores."""
    if "_" in cell:
        raise ValueError(cell)
    return float(cell)


def _is_number(cell: str) -> bool:
    try:
        _number(cell)
    except ValueError:
        return False
    return True


def _check_rows(rows: int) -> None:
    if rows > MAX_ROWS:
        raise SegmentFileError(
            Message("the file has more than {limit} rows: record shorter segments.", limit=MAX_ROWS)
        )
