"""Where a recording's bytes come from: a folder, or its archive; and their content hash.

An archive is untrusted: no path leaves the recording, no link is followed, and sizes are limited before
anything is unpacked.
"""

from __future__ import annotations

import hashlib
import stat
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import BinaryIO, Protocol

from ahrs_lab.errors import InputError, MachineError

HEADER_FILE = "recording.toml"
ARCHIVE_SUFFIX = ".ahrsrec"

MAX_FILES = 10_000
MAX_TOTAL_BYTES = 16 * 2**30
MAX_RATIO = 200
_RATIO_FREE_BYTES = 2**20
_CHUNK = 2**20


class BundleSource(Protocol):
    """The files of a recording, by their name relative to ``recording.toml``."""

    path: Path

    def has(self, name: str) -> bool: ...
    def open(self, name: str) -> BinaryIO: ...
    def load(self, name: str) -> Path | bytes:
        """What to read the file from: its path, or its bytes where it has none."""
        ...

    def head(self, name: str, size: int) -> bytes:
        """At most ``size`` bytes from the file's beginning."""
        ...

    def close(self) -> None: ...


class FolderSource:
    """A recording's folder. A link that leads out of it is refused."""

    def __init__(self, folder: Path) -> None:
        self.path = folder
        self._root = folder.resolve()

    def has(self, name: str) -> bool:
        return self._inside(name).is_file()

    def open(self, name: str) -> BinaryIO:
        return self._inside(name).open("rb")

    def load(self, name: str) -> Path:
        return self._inside(name)

    def head(self, name: str, size: int) -> bytes:
        with self.open(name) as file:
            return file.read(size)

    def close(self) -> None:
        return None

    def _inside(self, name: str) -> Path:
        try:
            path = (self._root / name).resolve()
        except RuntimeError as error:  # links in a circle
            raise _outside(name, self.path) from error
        if not path.is_relative_to(self._root):
            raise _outside(name, self.path)
        return path


class ArchiveSource:
    """A zipped recording, its ``recording.toml`` at the top or in the one folder at the top."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._zip = zipfile.ZipFile(path)
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise _damaged(path, error) from error
        try:
            self.members = checked_members(self._zip, path)
        except InputError:
            self._zip.close()
            raise

    def has(self, name: str) -> bool:
        return name in self.members

    def open(self, name: str) -> BinaryIO:
        return self._zip.open(self.members[name])  # type: ignore[return-value]

    def load(self, name: str) -> Path | bytes:
        with self.reading(), self.open(name) as file:
            return file.read()

    def head(self, name: str, size: int) -> bytes:
        with self.reading(), self.open(name) as file:
            return file.read(size)

    def close(self) -> None:
        self._zip.close()

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Turns what a damaged archive raises into an :class:`InputError`."""
        try:
            yield
        except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError) as error:
            raise _damaged(self.path, error) from error


def open_source(path: Path) -> FolderSource | ArchiveSource:
    """The recording at ``path``; InputError where there is none, MachineError where it cannot be read."""
    try:
        if path.is_dir():
            if not (path / HEADER_FILE).is_file():
                raise InputError(
                    "{folder} is not a recording: there is no recording.toml in it.", folder=path
                )
            return FolderSource(path)
        if path.name == HEADER_FILE and path.is_file():
            return FolderSource(path.parent)
        if not path.exists():
            raise InputError(
                "{path} does not exist: name the folder or the .ahrsrec file of a recording.", path=path
            )
        if not path.is_file():
            raise InputError(
                "{path} is neither a folder nor an ordinary file: name the folder or the .ahrsrec file of a "
                "recording.",
                path=path,
            )
        return ArchiveSource(path)
    except OSError as error:
        raise MachineError(
            "{path} cannot be read: {error}", path=path, error=error.strerror or error
        ) from error


def checked_members(archive: zipfile.ZipFile, path: Path) -> dict[str, zipfile.ZipInfo]:
    """The files of an archive by their name inside the recording; raises InputError for a hostile one."""
    infos = [info for info in archive.infolist() if not info.is_dir()]
    if len(infos) > MAX_FILES:
        raise InputError(
            "{archive} holds {count} files, more than {limit}: this is not a recording.",
            archive=path,
            count=len(infos),
            limit=MAX_FILES,
        )
    seen: set[str] = set()
    for info in infos:
        _check_member(info, path)
        folded = info.filename.casefold()
        if folded in seen:
            raise InputError(
                "{archive} holds {file} twice: pack the recording again.", archive=path, file=info.filename
            )
        seen.add(folded)
    total = sum(info.file_size for info in infos)
    if total > MAX_TOTAL_BYTES:
        raise InputError(
            "{archive} would unpack to {size} bytes, more than {limit}: this is not a recording.",
            archive=path,
            size=total,
            limit=MAX_TOTAL_BYTES,
        )
    for info in infos:
        for folder in PurePosixPath(info.filename.casefold()).parents:
            if str(folder) in seen:
                raise InputError(
                    "{archive} holds {file} twice: pack the recording again.", archive=path, file=str(folder)
                )
    prefix = _prefix([info.filename for info in infos], path)
    return {info.filename[len(prefix) :]: info for info in infos if info.filename.startswith(prefix)}


def content_sha256(source: BundleSource, files: Iterable[str]) -> str:
    """SHA-256 over ``recording.toml`` and the segment files in its order: of each its name in UTF-8, a zero
    byte, its size as 8 bytes big-endian, and its bytes. As hexadecimal text.

    Of a listed file that is not there nothing enters; name only those that are.
    """
    total = hashlib.sha256()
    for name in (HEADER_FILE, *files):
        with source.open(name) as file:
            size = file.seek(0, 2)
            file.seek(0)
            total.update(name.encode() + b"\0" + size.to_bytes(8, "big"))
            while chunk := file.read(_CHUNK):
                total.update(chunk)
    return total.hexdigest()


def _check_member(info: zipfile.ZipInfo, path: Path) -> None:
    name = info.orig_filename
    parts = PurePosixPath(name).parts
    if name.startswith("/") or "\\" in name or ":" in name or "\0" in name or ".." in parts:
        raise InputError(
            "{archive} holds the file name {file}, which leads out of the recording: do not use it.",
            archive=path,
            file=repr(name),
        )
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputError(
            "{archive} is packed in a way that is not read here: pack the recording again, as an ordinary "
            "zip file.",
            archive=path,
        )
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG):
        raise InputError(
            "{archive} holds {file}, which is a link or a device, not a file: do not use it.",
            archive=path,
            file=name,
        )
    if info.flag_bits & 1:
        raise InputError("{archive} is encrypted: pack the recording without a password.", archive=path)
    if info.file_size > _RATIO_FREE_BYTES and info.file_size > MAX_RATIO * info.compress_size:
        raise InputError(
            "{archive} holds {file}, which would unpack to {ratio} times its size: do not use it.",
            archive=path,
            file=name,
            ratio=round(info.file_size / max(info.compress_size, 1)),
        )


def _prefix(names: list[str], path: Path) -> str:
    if HEADER_FILE in names:
        return ""
    below = [name for name in names if name.count("/") == 1 and name.endswith("/" + HEADER_FILE)]
    if len(below) != 1:
        raise InputError("{archive} is not a recording: there is no recording.toml in it.", archive=path)
    return below[0].removesuffix(HEADER_FILE)


def _outside(name: str, folder: Path) -> InputError:
    return InputError(
        "{file} lies outside the recording {folder}: copy it into the recording.", file=name, folder=folder
    )


def _damaged(path: Path, error: Exception) -> InputError:
    return InputError(
        "{archive} is no archive of a recording, or it is damaged ({error}): copy it again.",
        archive=path,
        error=error,
    )
