"""Segment files as Parquet: written fast (no dictionary, no compression), read as something untrusted."""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.recording.arrow_columns import arrow_arrays, arrow_schema
from ahrs_lab.recording.raw_segment import (
    MAX_ROWS,
    RawSegment,
    SegmentFileError,
    check_column_names,
    consecutive_lines,
)
from ahrs_lab.recording.samples import Array, Samples

MAX_DECODED_BYTES = 8 * 2**30


def read_parquet(source: Path | bytes) -> RawSegment:
    """All rows of a Parquet segment, every numeric column as float64 (nulls as NaN).

    Raises :class:`SegmentFileError` for what is no Parquet file, is damaged, or larger than a segment can be.
    """
    import pyarrow as pa
    from pyarrow import parquet

    try:
        with parquet.ParquetFile(
            pa.BufferReader(source) if isinstance(source, bytes) else source, memory_map=True
        ) as file:
            schema = file.schema_arrow
            check_column_names(schema.names)
            numeric = [entry.name for entry in schema if _is_numeric(entry.type)]
            _check_size(file.metadata.num_rows, len(numeric))
            table = file.read(columns=numeric, use_pandas_metadata=False)
        columns = {name: _float_column(table.column(name)) for name in numeric}
    except (pa.ArrowException, OSError, ValueError) as error:
        raise SegmentFileError(
            Message("the file cannot be read as Parquet: {error}", error=_first_line(error))
        ) from error
    if table.num_rows == 0:
        raise SegmentFileError(Message("the file has no sample: record the segment again."), line=2)
    left_out = tuple(name for name in schema.names if name not in columns)
    return RawSegment(columns, consecutive_lines(table.num_rows), left_out=left_out)


def write_parquet(samples: Samples, target: BinaryIO) -> None:
    """Write the samples as plain float64 columns: as fast as the disk takes them."""
    import pyarrow as pa
    from pyarrow import parquet

    table = pa.Table.from_arrays(arrow_arrays(samples), schema=arrow_schema(list(samples.columns)))
    parquet.write_table(table, target, use_dictionary=False, compression="none", write_statistics=False)


def _is_numeric(kind: Any) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind))


def _check_size(rows: int, columns: int) -> None:
    if rows > MAX_ROWS or rows * columns * 8 > MAX_DECODED_BYTES:
        raise SegmentFileError(
            Message(
                "{rows} rows × {columns} columns are more than a segment may have.",
                rows=rows,
                columns=columns,
            )
        )


def _float_column(column: Any) -> Array:
    import pyarrow as pa

    if column.type != pa.float64() or column.null_count:
        # Counters beyond 2^53 lose their last digits: nothing else can be done with them.
        column = column.cast(pa.float64(), safe=False).fill_null(float("nan"))
    return np.asarray(column.to_numpy(), dtype=np.float64)


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
