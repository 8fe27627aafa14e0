"""Samples as Arrow sees them: the same memory, every column float64 and never null (NaN is a number here)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ahrs_lab.recording.samples import Samples

if TYPE_CHECKING:
    import pyarrow as pa


def arrow_schema(names: list[str], metadata: dict[bytes | str, bytes | str] | None = None) -> pa.Schema:
    """A schema of columns that need no list of which rows they have: a third less time to write."""
    import pyarrow as pa

    return pa.schema([pa.field(name, pa.float64(), nullable=False) for name in names], metadata=metadata)


def arrow_arrays(samples: Samples) -> list[pa.Array[Any]]:
    """The columns in their order, not copied. (``pyarrow.array`` would do, but loads pandas where there is
    one.)"""
    import pyarrow as pa

    columns = (np.ascontiguousarray(column, dtype=np.float64) for column in samples.columns.values())
    return [
        pa.Array.from_buffers(pa.float64(), len(column), [None, pa.py_buffer(column.data)])
        for column in columns
    ]
