"""The raw bytes of a run: what came over the wire, unchanged, with a small index of when.

``<name>.bin`` holds the bytes. ``<name>.idx`` begins with ``AHRSRAW1`` and has one entry of 17 bytes for each
block that arrived: time (float64, s), offset of its first byte (uint64), kind (uint8: 0 bytes, 1 the link was
lost, 2 it came back), little-endian. A file that a kill cut short is read as far as it goes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from types import TracebackType

from ahrs_lab.errors import InputError, MachineError

MAGIC = b"AHRSRAW1"
_ENTRY = struct.Struct("<dQB")
_FLUSH_S = 1.0


class BlockKind(IntEnum):
    """What an entry tells."""

    BYTES = 0
    LOST = 1
    BACK = 2


@dataclass(frozen=True)
class Block:
    """Bytes that arrived together. ``t_s`` is the host's time of arrival; empty with a kind other than
    BYTES."""

    t_s: float
    data: bytes
    kind: BlockKind = BlockKind.BYTES


class RawLog:
    """Writes the two files; not for several threads. On disk within a second of the stream's own time."""

    def __init__(self, stem: Path) -> None:
        """``stem``: path without suffix. Raises InputError where the files are there already, MachineError
        where they cannot be made."""
        self.bytes_path, self.index_path = _paths(stem)
        try:
            stem.parent.mkdir(parents=True, exist_ok=True)
            self._bytes = self.bytes_path.open("xb")
        except FileExistsError as error:
            raise InputError(
                "{path} is there already: raw bytes are never written over.", path=self.bytes_path
            ) from error
        except OSError as error:
            raise _disk(self.bytes_path, error) from error
        try:
            self._index = self.index_path.open("wb")
            self._index.write(MAGIC)
        except OSError as error:
            self._bytes.close()
            raise _disk(self.index_path, error) from error
        self._offset = 0
        self._flushed_s = float("-inf")

    def add(self, block: Block) -> None:
        """Append a block. Raises MachineError (disk full)."""
        try:
            self._index.write(_ENTRY.pack(block.t_s, self._offset, block.kind))
            self._bytes.write(block.data)
            self._offset += len(block.data)
            if not block.t_s - self._flushed_s < _FLUSH_S:
                self._bytes.flush()
                self._index.flush()
                self._flushed_s = block.t_s
        except OSError as error:
            raise _disk(self.bytes_path, error) from error

    def close(self) -> None:
        """Raises MachineError where the last bytes cannot be written."""
        try:
            try:
                self._bytes.close()
            finally:
                self._index.close()
        except OSError as error:
            raise _disk(self.bytes_path, error) from error

    def __enter__(self) -> RawLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def read_raw(path: Path) -> Iterator[Block]:
    """The blocks of ``<name>.bin`` (or its stem) in order. Without an index, or with a part of it gone, the
    bytes that no entry covers come as blocks without a time (``t_s`` NaN)."""
    bytes_path, index_path = _paths(path.with_suffix("") if path.suffix in (".bin", ".idx") else path)
    try:
        size = bytes_path.stat().st_size
        entries = _entries(index_path.read_bytes() if index_path.exists() else b"", size, index_path)
        ends = [offset for _, offset, _ in entries[1:]] + [size]
        with bytes_path.open("rb") as file:
            for (t_s, offset, kind), following in zip(entries, ends, strict=False):
                file.seek(offset)
                yield Block(t_s, file.read(following - offset), kind)
    except OSError as error:
        raise InputError(
            "{path} cannot be read ({reason}).", path=bytes_path, reason=error.strerror or str(error)
        ) from error


def _entries(index: bytes, size: int, path: Path) -> list[tuple[float, int, BlockKind]]:
    if index and not index.startswith(MAGIC):
        raise InputError("{path} is not an index of raw bytes.", path=path)
    body = index[len(MAGIC) :]
    body = body[: len(body) - len(body) % _ENTRY.size]
    entries: list[tuple[float, int, BlockKind]] = []
    last = 0
    for t_s, offset, kind in _ENTRY.iter_unpack(body):
        if not last <= offset <= size or kind > BlockKind.BACK:
            break  # beyond what reached the disk
        entries.append((t_s, offset, BlockKind(kind)))
        last = offset
    if size and (not entries or entries[0][1] > 0):
        entries.insert(0, (float("nan"), 0, BlockKind.BYTES))
    return entries


def _paths(stem: Path) -> tuple[Path, Path]:
    return stem.with_name(stem.name + ".bin"), stem.with_name(stem.name + ".idx")


def _disk(path: Path, error: OSError) -> MachineError:
    return MachineError(
        "{path} cannot be written ({reason}): free space on the disk or choose another folder.",
        path=path,
        reason=error.strerror or str(error),
    )
