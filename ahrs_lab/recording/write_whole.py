"""Writing a recording that is there as a whole: made from another one, or by other software."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path

from ahrs_lab.errors import InputError
from ahrs_lab.recording.archive import pack
from ahrs_lab.recording.bundle_source import ARCHIVE_SUFFIX, HEADER_FILE
from ahrs_lab.recording.bundle_toml import compose
from ahrs_lab.recording.csv_file import write_csv
from ahrs_lab.recording.machine_faults import machine_faults, write_atomically
from ahrs_lab.recording.parquet_file import write_parquet
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import RecordingHeader, Segment


def write_recording(
    folder: Path, header: RecordingHeader, segments: Iterable[tuple[Segment, Samples]]
) -> None:
    """Write each segment to its ``file`` under ``folder`` (new or empty; by the suffix CSV or Parquet), then
    ``recording.toml``, so that what is broken off is no recording.

    Raises InputError for a folder that holds something, MachineError for what the machine does not allow.
    """
    import tomli_w

    with machine_faults(folder):
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError("{folder} is not empty: choose an empty or a new folder.", folder=folder)
        folder.mkdir(parents=True, exist_ok=True)
        written = []
        for segment, samples in segments:
            path = folder / segment.file
            path.parent.mkdir(parents=True, exist_ok=True)
            write = write_csv if path.suffix.lower() == ".csv" else write_parquet
            write_atomically(path, partial(write, samples))
            written.append(segment)
        document = compose(header, written)
        write_atomically(folder / HEADER_FILE, partial(tomli_w.dump, document))


def write_bundle(target: Path, header: RecordingHeader, segments: Sequence[tuple[Segment, Samples]]) -> None:
    """As a recording in a new folder, or packed where the name ends in ``.ahrsrec``, in a new file."""
    if target.suffix.lower() != ARCHIVE_SUFFIX:
        write_recording(target, header, segments)
        return
    if target.exists():
        raise InputError("{path} is there already: choose another name.", path=target)
    with tempfile.TemporaryDirectory() as beside:
        write_recording(Path(beside) / "recording", header, segments)
        pack(Path(beside) / "recording", target)
