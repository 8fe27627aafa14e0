"""Sealed segments read and checked while the next ones are being recorded.

What :func:`~ahrs_lab.recording.read.read_bundle` is given of them at the end is what it would read itself:
the same file (its size and time of change are compared), of the same segment and device.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import TracebackType

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.recording.bundle_source import FolderSource
from ahrs_lab.recording.read import RecordedSegment, read_header, read_segment
from ahrs_lab.recording.segment import RecordingHeader, Segment

_Stamp = tuple[int, int]
_Read = tuple[_Stamp, RecordingHeader, RecordedSegment]


class ReadAhead:
    """One thread that reads; close it when the recording is read, or given up."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="recording-read-ahead")
        self._read: dict[str, tuple[Segment, Future[_Read]]] = {}

    def __enter__(self) -> ReadAhead:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pool.shutdown(cancel_futures=True)

    def take(self, segment: Segment) -> None:
        """Begin to read a sealed segment."""
        self._read[segment.file] = (segment, self._pool.submit(self._work, segment))

    def get(self, segment: Segment, header: RecordingHeader) -> RecordedSegment | None:
        """What was read of ``segment``; None where that was another one, its file has changed since, or it
        could not be read: who reads it again hears why."""
        known, work = self._read.get(segment.file, (None, None))
        if work is None or known != segment:
            return None
        try:
            stamp, read_under, recorded = work.result()
            same = (stamp, read_under.device, read_under.procedure)
            return recorded if same == (self._stamp(segment), header.device, header.procedure) else None
        except (OSError, AhrsLabError):
            return None

    def _work(self, segment: Segment) -> _Read:
        stamp, (header, _) = self._stamp(segment), read_header(self._folder)
        return stamp, header, read_segment(FolderSource(self._folder), segment, header)

    def _stamp(self, segment: Segment) -> _Stamp:
        found = (self._folder / segment.file).stat()
        return (found.st_size, found.st_mtime_ns)
