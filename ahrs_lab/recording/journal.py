"""The journal of the segment that is being recorded: what a kill leaves to recover.

An Arrow IPC stream that grows by a record batch at a time, each handed to the operating system at once, with
the segment's description in its schema. Only a journal that was closed ends with the end-of-stream mark.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.recording.arrow_columns import arrow_arrays, arrow_schema
from ahrs_lab.recording.bundle_toml import segment_from_table, segment_to_table
from ahrs_lab.recording.samples import Samples, concatenate
from ahrs_lab.recording.segment import Segment

SUFFIX = ".journal"
WRITE_EVERY_S = 0.5
"""Blocks that come faster are written together; so at most this much is not yet on its way to the disk."""

_KEY = b"ahrs-lab-segment"
_END = b"\xff\xff\xff\xff\x00\x00\x00\x00"


class Journal:
    """Grows with every :meth:`append`; the blocks stay in memory too, for the sealed file.

    Raises OSError as the system does; what is in the file then still ends with a whole batch.
    """

    def __init__(self, path: Path, segment: Segment, clock: Callable[[], float] = time.monotonic) -> None:
        self.path = path
        self.segment = segment
        self.blocks: list[Samples] = []
        self._clock = clock
        self._written = 0
        self._written_at = clock()
        self._ended = False
        self._file: BinaryIO = path.open("wb", buffering=0)
        _load_arrow()

    def __len__(self) -> int:
        return sum(len(block) for block in self.blocks)

    def append(self, samples: Samples) -> None:
        """Keep a block: on disk at once, or together with those of the next :data:`WRITE_EVERY_S`."""
        if self.blocks and samples.columns.keys() != self.blocks[0].columns.keys():
            raise ValueError(f"other columns than before: {sorted(samples.columns)}")
        self.blocks.append(samples)
        if self._clock() - self._written_at >= WRITE_EVERY_S:
            self.write()

    def write(self) -> None:
        """Hand everything that is not yet written to the operating system."""
        # A deleted folder lets an open file grow on where nobody will ever find it.
        self.path.stat()
        whole = self._file.tell()
        try:
            self._write_batch(concatenate(self.blocks[self._written :]))
        except OSError:
            self._file.truncate(whole)
            self._file.seek(whole)
            raise
        self._written = len(self.blocks)
        self._written_at = self._clock()

    def _write_batch(self, samples: Samples) -> None:
        import pyarrow as pa

        if not len(samples):
            return
        described = json.dumps(segment_to_table(self.segment)).encode()
        schema = arrow_schema(list(samples.columns), {_KEY: described})
        if not self._file.tell():
            _write_all(self._file, memoryview(schema.serialize()))
        batch = pa.record_batch(arrow_arrays(samples), schema=schema)
        _write_all(self._file, memoryview(batch.serialize()))

    def end(self) -> None:
        """Say in the file that the segment was recorded to its end.

        A segment so short that nothing of it was written yet is sealed before it could be: nothing is said.
        """
        if self._written and not self._ended:
            self.write()
            _write_all(self._file, memoryview(_END))
            self._ended = True

    def close(self) -> None:
        """Close the file, as it is."""
        self._file.close()


@dataclass(frozen=True)
class Recovered:
    """What a journal holds. ``complete``: the recording had come to its end."""

    segment: Segment
    samples: Samples
    complete: bool


def recover(path: Path) -> Recovered | None:
    """Everything that reached the disk; None where nothing did."""
    import pyarrow as pa

    data = path.read_bytes()
    batches: list[pa.RecordBatch] = []
    try:
        reader = pa.ipc.open_stream(data)
        described = json.loads((reader.schema.metadata or {})[_KEY])
        segment = segment_from_table(described, str(path), "")
    except (pa.ArrowInvalid, KeyError, ValueError, InputError):
        return None
    try:
        batches.extend(reader)
    except (pa.ArrowInvalid, OSError):
        # The batch that the kill cut off.
        complete = False
    else:
        complete = data.endswith(_END)
    if not batches:
        return None
    table = pa.Table.from_batches(batches)
    return Recovered(
        segment, Samples({name: table.column(name).to_numpy() for name in table.column_names}), complete
    )


def _load_arrow() -> None:
    """Before the first sample: loading takes seconds on a busy computer, in which a run would stand still."""
    arrow_arrays(Samples({"t_s": np.empty(0)}))


def _write_all(file: BinaryIO, content: memoryview) -> None:
    """An unbuffered file may take a part only: before the disk is full, say."""
    while len(content):
        content = content[file.write(content) :]
