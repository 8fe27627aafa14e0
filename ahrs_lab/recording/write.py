"""Writing a recording as the run goes: a kill loses at most the last second, a crash no sealed segment.

The open segment grows in a journal. Finished, it is sealed into its file (written beside its place, on the
disk, renamed), then ``recording.toml`` is replaced, then the journal goes. So at every moment the folder is a
valid recording of the segments that ``recording.toml`` lists.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path, PurePosixPath
from types import TracebackType
from typing import Any, Literal, Self

from ahrs_lab.errors import InputError, InstrumentError, MachineError
from ahrs_lab.messages import Message
from ahrs_lab.recording.bundle_source import HEADER_FILE
from ahrs_lab.recording.bundle_toml import compose, parse, segment_to_table
from ahrs_lab.recording.csv_file import write_csv
from ahrs_lab.recording.folder_lock import LOCK_FILE, FolderLock
from ahrs_lab.recording.journal import SUFFIX, Journal, recover
from ahrs_lab.recording.machine_faults import machine_faults, write_atomically
from ahrs_lab.recording.parquet_file import write_parquet
from ahrs_lab.recording.samples import Samples, concatenate
from ahrs_lab.recording.segment import RecordingHeader, Segment

FileFormat = Literal["parquet", "csv"]
SEGMENT_FOLDER = "segments"

AGAIN = Message("recorded again")
ENDED = Message("the program ended while it was recorded")
CLOSED = Message("closed while recording")

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_+.-]{0,99}")


class BundleWriter:
    """A recording's folder while it is written; use it as a context manager, from one thread.

    Raises InputError for a folder that holds something else or that another instance writes, MachineError for
    what the machine does not let us do: what was recorded until then is kept, :meth:`resume` finds it.
    """

    folder: Path
    _lock: FolderLock
    _header: RecordingHeader
    _segments: list[Segment]
    _listed: list[tuple[Segment, str]]
    """Each segment as it stands in ``recording.toml``: it is written as often as there are segments."""
    _journal: Journal | None

    def __init__(self, folder: Path, header: RecordingHeader, *, file_format: FileFormat = "parquet") -> None:
        self._open_folder(folder, file_format)
        try:
            self._refuse_foreign()
            self._header = header
            with machine_faults(folder):
                (folder / SEGMENT_FOLDER).mkdir(exist_ok=True)
                self._write_header()
        except BaseException:
            self._lock.release()
            raise

    @classmethod
    def resume(cls, folder: Path, *, file_format: FileFormat = "parquet") -> Self:
        """Go on with a recording that was begun: its segments are :attr:`segments`.

        What a kill left of an open segment is sealed and marked ``interrupted``.
        """
        if not (folder / HEADER_FILE).is_file():
            raise InputError("{folder} holds no recording to go on with.", folder=folder)
        writer = cls.__new__(cls)
        writer._open_folder(folder, file_format)
        try:
            with machine_faults(folder):
                path = folder / HEADER_FILE
                writer._header, segments = parse(path.read_bytes(), str(path))
                writer._segments = list(segments)
                (folder / SEGMENT_FOLDER).mkdir(exist_ok=True)
                writer._recover()
        except BaseException:
            writer._lock.release()
            raise
        return writer

    @property
    def header(self) -> RecordingHeader:
        """As it is on the disk, with the notes made so far."""
        return self._header

    @property
    def notes(self) -> Mapping[str, Any]:
        """The header's notes, those of earlier runs with them."""
        return self._header.notes

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Sealed so far, in the order of recording, superseded and interrupted ones with them."""
        return tuple(self._segments)

    @property
    def recording(self) -> Segment | None:
        """The segment that is open."""
        return None if self._journal is None else self._journal.segment

    def begin(self, segment: Segment) -> None:
        """Open a segment. One of a name that is there already becomes its next take."""
        if self._journal is not None:
            raise ValueError(f"{self._journal.segment.name} is still being recorded")
        if not _NAME.fullmatch(segment.name):
            raise ValueError(f"{segment.name!r} cannot be a file's name")
        segment = replace(segment, file=self._free_file(segment.name))
        with machine_faults(self.folder):
            self._journal = Journal(self._journal_path(segment), segment)

    def append(self, samples: Samples) -> None:
        """Add a block to the open segment. All its blocks have the same columns."""
        journal = self._open_journal()
        with machine_faults(self.folder):
            journal.append(samples)

    def finish(self) -> Segment:
        """Seal the open segment: its file and ``recording.toml`` are on the disk when this returns.

        Earlier takes of the same name are superseded. Raises InstrumentError where no sample came (the
        segment is dropped) and MachineError where it cannot be sealed: it stays open, in its journal.
        """
        journal = self._open_journal()
        if not len(journal):
            self._drop_journal()
            raise InstrumentError(
                "No sample of the segment {name} came: "
                "look at the unit's cable and settings, then record it again.",
                name=journal.segment.name,
            )
        with machine_faults(self.folder):
            journal.end()
        return self._seal(journal, journal.segment)

    def interrupt(self, reason: str) -> Segment | None:
        """Seal the open segment as interrupted: kept, never evaluated. None where no sample came."""
        journal = self._open_journal()
        if not len(journal):
            self._drop_journal()
            return None
        return self._seal(journal, replace(journal.segment, interrupted=True, reason=reason))

    def discard(self, reason: str) -> None:
        """Drop the open segment's samples; that and why stays in the notes under ``discarded``."""
        name = self._open_journal().segment.name
        self._drop_journal()
        discarded = [*self._header.notes.get("discarded", []), {"segment": name, "reason": reason}]
        self.update_notes({"discarded": discarded})

    def supersede(self, name: str, reason: str) -> None:
        """Set the last valid take of a segment aside, with the reason: it will be recorded again."""
        for index in reversed(self._takes(name)):
            if not self._segments[index].superseded:
                self._segments[index] = replace(self._segments[index], superseded=True, reason=reason)
                with machine_faults(self.folder):
                    self._write_header()
                return
        raise InputError("The recording has no segment {name} to set aside.", name=name)

    def update_notes(self, notes: Mapping[str, Any]) -> None:
        """Add to the header's notes, or replace those of the same name."""
        self._header = replace(self._header, notes={**self._header.notes, **notes})
        with machine_faults(self.folder):
            self._write_header()

    def close(self) -> None:
        """Give the folder free; an open segment is interrupted. A second call does nothing."""
        try:
            if self._journal is not None:
                self.interrupt(CLOSED.text())
        finally:
            if self._journal is not None:
                self._journal.close()
                self._journal = None
            self._lock.release()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
            return
        # The error on its way is the one to be seen; what cannot be sealed now waits in its journal.
        with suppress(MachineError):
            if self._journal is not None:
                self.interrupt(f"{type(error).__name__}: {error}")
        with suppress(MachineError):
            self.close()

    def _open_folder(self, folder: Path, file_format: FileFormat) -> None:
        self.folder = folder
        self._format = file_format
        self._segments, self._listed = [], []
        self._journal = None
        with machine_faults(folder):
            folder.mkdir(parents=True, exist_ok=True)
            self._lock = FolderLock(folder)

    def _refuse_foreign(self) -> None:
        with machine_faults(self.folder):
            entries = {path.name for path in self.folder.iterdir()} - {LOCK_FILE}
        if HEADER_FILE in entries:
            raise InputError(
                "{folder} holds a recording already: go on with it, or choose another folder.",
                folder=self.folder,
            )
        if entries:
            raise InputError("{folder} is not empty: choose an empty or a new folder.", folder=self.folder)

    def _open_journal(self) -> Journal:
        if self._journal is None:
            raise ValueError("no segment is being recorded")
        return self._journal

    def _drop_journal(self) -> None:
        journal = self._open_journal()
        journal.close()
        self._journal = None
        with machine_faults(self.folder):
            journal.path.unlink(missing_ok=True)

    def _seal(self, journal: Journal, segment: Segment) -> Segment:
        with machine_faults(self.folder):
            try:
                self._seal_samples(segment, concatenate(journal.blocks))
            except OSError:
                # What a short segment has only in memory may still fit.
                with suppress(OSError):
                    journal.write()
                raise
        self._drop_journal()
        return segment

    def _seal_samples(self, segment: Segment, samples: Samples) -> None:
        write = write_csv if segment.file.endswith(".csv") else write_parquet
        write_atomically(self.folder / segment.file, lambda file: write(samples, file))
        before = self._segments
        earlier = before if segment.interrupted else [_superseded_by(segment, take) for take in before]
        self._segments = [*earlier, segment]
        try:
            self._write_header()
        except OSError:
            self._segments = before
            raise

    def _write_header(self) -> None:
        import tomli_w

        parts = [tomli_w.dumps(compose(self._header, ()))]
        for index, segment in enumerate(self._segments):
            if index == len(self._listed) or self._listed[index][0] is not segment:
                text = "\n" + tomli_w.dumps({"segment": [segment_to_table(segment)]})
                assert text.startswith("\n[[segment]]"), "else it would belong to the table above"
                self._listed[index : index + 1] = [(segment, text)]
            parts.append(self._listed[index][1])
        document = "".join(parts).encode()
        write_atomically(self.folder / HEADER_FILE, lambda file: file.write(document))

    def _recover(self) -> None:
        """Seal what journals hold; take away what a kill left half written."""
        folder = self.folder / SEGMENT_FOLDER
        listed = {segment.file for segment in self._segments}
        for part in [*self.folder.glob("*.part"), *folder.glob("*.part")]:
            part.unlink()
        for path in sorted(folder.glob("*" + SUFFIX)):
            left = recover(path)
            if left is not None and left.segment.file not in listed:
                segment = left.segment
                if not left.complete:
                    segment = replace(segment, interrupted=True, reason=ENDED.text())
                self._seal_samples(segment, left.samples)
            path.unlink()

    def _takes(self, name: str) -> Sequence[int]:
        return [index for index, segment in enumerate(self._segments) if segment.name == name]

    def _free_file(self, name: str) -> str:
        taken = {segment.file for segment in self._segments}
        for take in range(1, len(taken) + 2):
            stem = name if take == 1 else f"{name}.{take}"
            names = {f"{SEGMENT_FOLDER}/{stem}.{suffix}" for suffix in ("parquet", "csv")}
            if not names & taken:
                return f"{SEGMENT_FOLDER}/{stem}.{self._format}"
        raise AssertionError("more takes than files")

    def _journal_path(self, segment: Segment) -> Path:
        return self.folder / SEGMENT_FOLDER / (PurePosixPath(segment.file).name + SUFFIX)


def _superseded_by(segment: Segment, take: Segment) -> Segment:
    """A take as it stands once ``segment`` has been recorded."""
    if take.name != segment.name or take.superseded or take.interrupted:
        return take
    return replace(take, superseded=True, reason=segment.reason or AGAIN.text())
