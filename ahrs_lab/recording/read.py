"""Reading a recording back, with all its checks: the header strictly, the segments as far as they go.

A fault of ``recording.toml``, or no file at all of those it lists, is an InputError. What is wrong with the
samples, and that single files are not there, becomes a :class:`~ahrs_lab.recording.finding.Finding` with file
and line; the reduction decides.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.messages import Message
from ahrs_lab.recording.bundle_source import (
    HEADER_FILE,
    BundleSource,
    FolderSource,
    content_sha256,
    open_source,
)
from ahrs_lab.recording.bundle_toml import MAX_BYTES, entry_lines, parse
from ahrs_lab.recording.clean_rows import CleanRows, clean_rows
from ahrs_lab.recording.completeness import PROCEDURE, missing_segments
from ahrs_lab.recording.csv_file import read_csv
from ahrs_lab.recording.finding import Finding, Kind
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.gravity_check import check_gravity
from ahrs_lab.recording.minimum_check import check_axis, check_minimum
from ahrs_lab.recording.parquet_file import read_parquet
from ahrs_lab.recording.raw_segment import RawSegment, SegmentFileError
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment
from ahrs_lab.recording.table_check import check_table

_READERS = 3


@dataclass(frozen=True)
class RecordedSegment:
    """A segment with its samples.

    ``samples`` are the rows that count: times rise strictly, time and rate are finite. ``lines``, shape (n,),
    is the line of each in the file. ``lost`` counts samples known to be missing or left out.
    """

    segment: Segment
    samples: Samples
    findings: tuple[Finding, ...]
    lines: NDArray[np.int64]
    lost: int = 0
    step_s: float = 0.0

    @property
    def counts(self) -> bool:
        """Neither superseded nor interrupted."""
        return not self.segment.superseded and not self.segment.interrupted

    @property
    def usable(self) -> bool:
        """It counts, and nothing in it falls below the standard's minimum."""
        return self.counts and not any(finding.severity == "unusable" for finding in self.findings)

    @property
    def seen_s(self) -> float:
        """How long it was really sampled: gaps do not count."""
        return len(self.lines) * self.step_s


@dataclass(frozen=True)
class Recording:
    """All of a bundle. ``general`` are the findings that belong to no file (segments that are missing);
    ``sha256`` is :func:`~ahrs_lab.recording.bundle_source.content_sha256`."""

    header: RecordingHeader
    segments: tuple[RecordedSegment, ...]
    sha256: str
    general: tuple[Finding, ...] = field(default=())
    path: Path | None = None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings: those of the whole recording, then each segment's in its order."""
        return (*self.general, *(finding for segment in self.segments for finding in segment.findings))


class ReadAhead:
    """Segments of a recording's folder, read with all their checks while the rest is still being made.

    Each counts only while it is what it was: one whose description or file has changed since is read again.
    """

    def __init__(self, folder: Path) -> None:
        self._source = FolderSource(folder)
        self._read: dict[str, tuple[tuple[object, ...], RecordedSegment]] = {}

    def read(self, segment: Segment, header: RecordingHeader) -> None:
        """Read a segment that is sealed. Raises OSError."""
        known = self._identity(segment, header)
        self._read[segment.file] = known, _read_segment(self._source, segment, header)

    def get(self, segment: Segment, header: RecordingHeader) -> RecordedSegment | None:
        """What was read of it; None where it has to be read now."""
        known, recorded = self._read.get(segment.file, ((), None))
        return recorded if known == self._identity(segment, header) else None

    def _identity(self, segment: Segment, header: RecordingHeader) -> tuple[object, ...]:
        file = self._source.load(segment.file).stat()
        return segment, header.device, header.procedure, file.st_size, file.st_mtime_ns


def read_bundle(path: Path, ahead: ReadAhead | None = None) -> Recording:
    """The recording in a folder (or its ``recording.toml``) or an ``.ahrsrec`` archive; ``ahead``: what was
    read of this folder before.

    Raises InputError for what is no recording, MachineError for what the machine does not let us read.
    """
    source = open_source(path)
    try:
        return _read(source, ahead)
    except OSError as error:
        raise MachineError(
            "{path} cannot be read: {error}", path=path, error=error.strerror or error
        ) from error
    finally:
        source.close()


def read_header(path: Path) -> tuple[RecordingHeader, tuple[Segment, ...]]:
    """Header and segments without the samples; the files need not be there."""
    source = open_source(path)
    try:
        return _header(source)
    except OSError as error:
        raise MachineError(
            "{path} cannot be read: {error}", path=path, error=error.strerror or error
        ) from error
    finally:
        source.close()


def check_samples(
    segment: Segment, raw: RawSegment, device: DeviceDescription, procedure: str = PROCEDURE
) -> RecordedSegment:
    """All checks of one segment; also for samples that never were in a file (line = row + 2)."""
    found = FindingList(segment)
    try:
        rows = clean_rows(raw, device.sample_rate_hz, found)
        if not len(rows.lines):
            raise SegmentFileError(Message("no row of the file counts: record the segment again."), line=2)
    except SegmentFileError as error:
        return _unreadable(segment, found, error)
    _check_rows(segment, rows, device, procedure, found)
    return RecordedSegment(segment, rows.samples, found.finished(), rows.lines, rows.lost, rows.step_s)


def _check_rows(
    segment: Segment, rows: CleanRows, device: DeviceDescription, procedure: str, found: FindingList
) -> None:
    if segment.superseded or segment.interrupted:
        found.add("set_aside", _set_aside(segment))
        return
    if segment.item != "dynamic":
        check_gravity(segment, rows, device.accel_unit, found)
    if procedure == PROCEDURE:
        check_axis(segment, found)
        check_minimum(segment, rows, found)
        check_table(segment, rows, device.rate_unit, found)


def _read(source: BundleSource, ahead: ReadAhead | None) -> Recording:
    header, segments = _header(source)
    if not segments:
        raise InputError("{where} lists no segment: nothing was recorded.", where=source.path / HEADER_FILE)
    absent = _absent(source, segments)
    general = missing_segments(segments) if header.procedure == PROCEDURE else ()
    with ThreadPoolExecutor(max_workers=_READERS, thread_name_prefix="recording-read") as pool:
        there = [segment.file for segment in segments if segment.file not in absent]
        digest = pool.submit(_digest, source.path, there)
        # An archive's handle is not for two threads.
        each = pool.map if isinstance(source, FolderSource) else map
        recorded = tuple(each(partial(_segment, source, ahead, header, absent), segments))
        return Recording(header, recorded, digest.result(), general, source.path)


def _absent(source: BundleSource, segments: tuple[Segment, ...]) -> dict[str, RecordedSegment]:
    """The segments whose file is not there, by file; raises InputError where none of the files is."""
    gone = [index for index, segment in enumerate(segments) if not source.has(segment.file)]
    if not gone:
        return {}
    if len(gone) == len(segments):
        raise InputError(
            "{where} lists {file}, which is not there, nor is any other file that it lists: copy them into "
            "the recording.",
            where=source.path / HEADER_FILE,
            file=segments[0].file,
        )
    lines = entry_lines(source.head(HEADER_FILE, MAX_BYTES), len(segments))
    return {segments[index].file: _without_file(segments[index], lines[index]) for index in gone}


def _without_file(segment: Segment, line: int) -> RecordedSegment:
    """``line``: of its entry in ``recording.toml``, 0 where that is not known."""
    what = (
        Message(
            "the file is not there, though recording.toml lists it (line {line}): "
            "copy it into the recording.",
            line=line,
        )
        if line
        else Message("the file is not there, though recording.toml lists it: copy it into the recording.")
    )
    return _without_samples(segment, FindingList(segment), "absent", what)


def _digest(path: Path, files: list[str]) -> str:
    """Through its own handle: an archive's is not for two threads."""
    source = open_source(path)
    try:
        return content_sha256(source, files)
    finally:
        source.close()


def _header(source: BundleSource) -> tuple[RecordingHeader, tuple[Segment, ...]]:
    if not source.has(HEADER_FILE):
        raise InputError("{folder} is not a recording: there is no recording.toml in it.", folder=source.path)
    data = source.head(HEADER_FILE, MAX_BYTES + 1)
    return parse(data, str(source.path / HEADER_FILE))


def _segment(
    source: BundleSource,
    ahead: ReadAhead | None,
    header: RecordingHeader,
    absent: Mapping[str, RecordedSegment],
    segment: Segment,
) -> RecordedSegment:
    if segment.file in absent:
        return absent[segment.file]
    found = None if ahead is None else ahead.get(segment, header)
    return _read_segment(source, segment, header) if found is None else found


def _read_segment(source: BundleSource, segment: Segment, header: RecordingHeader) -> RecordedSegment:
    reader: Callable[[Path | bytes], RawSegment]
    reader = read_parquet if segment.file.lower().endswith(".parquet") else _read_csv
    try:
        raw = reader(source.load(segment.file))
    except SegmentFileError as error:
        return _unreadable(segment, FindingList(segment), error)
    return check_samples(segment, raw, header.device, header.procedure)


def _read_csv(source: Path | bytes) -> RawSegment:
    return read_csv(source if isinstance(source, bytes) else source.read_bytes())


def _unreadable(segment: Segment, found: FindingList, error: SegmentFileError) -> RecordedSegment:
    return _without_samples(segment, found, "file", error.message, error.line)


def _without_samples(
    segment: Segment, found: FindingList, kind: Kind, what: Message, line: int = 0
) -> RecordedSegment:
    found.add(kind, what, line, "unusable")
    return RecordedSegment(segment, Samples(), found.finished(), np.empty(0, dtype=np.int64))


def _set_aside(segment: Segment) -> Message:
    reason = Message(segment.reason) if segment.reason else Message("no reason given")
    if segment.interrupted:
        return Message("the recording was interrupted and is not evaluated ({reason}).", reason=reason)
    return Message("the segment was recorded again and is not evaluated ({reason}).", reason=reason)
