"""A recording as one file: packed for sending, unpacked for going on with."""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from pathlib import Path
from typing import BinaryIO

from ahrs_lab.errors import InputError
from ahrs_lab.recording.bundle_source import HEADER_FILE, ArchiveSource, open_source
from ahrs_lab.recording.folder_lock import LOCK_FILE
from ahrs_lab.recording.journal import SUFFIX
from ahrs_lab.recording.machine_faults import machine_faults, write_atomically
from ahrs_lab.recording.read import read_header

_EPOCH = (1980, 1, 1, 0, 0, 0)
"""The same recording gives the same archive, byte for byte."""


def pack(folder: Path, target: Path) -> None:
    """Write the recording in ``folder`` as the archive ``target`` (``.ahrsrec``), whole or not at all.

    All its files go along, also those it does not know; an open segment does not.
    """
    _, segments = read_header(folder)
    with machine_faults(folder):
        first = [HEADER_FILE, *(segment.file for segment in segments)]
        rest = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())
        names = first + [name for name in rest if name not in first and not _passing(name)]
        for name in names:
            if (folder / name).is_symlink() or not (folder / name).is_file():
                raise InputError(
                    "{file} of {folder} is missing or is a link: copy the file itself there.",
                    file=name,
                    folder=folder,
                )
    with machine_faults(target):
        target.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(target, lambda file: _write_archive(file, folder, names))


def unpack(archive: Path, folder: Path) -> None:
    """Unpack a recording into ``folder``, which is new or empty; whole or not at all."""
    source = open_source(archive)
    try:
        if not isinstance(source, ArchiveSource):
            raise InputError("{path} is a folder, not an archive.", path=archive)
        with machine_faults(folder):
            if folder.exists() and any(folder.iterdir()):
                raise InputError("{folder} is not empty: choose an empty or a new folder.", folder=folder)
            folder.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=folder.parent, prefix=folder.name + ".") as beside:
                whole = Path(beside) / "recording"
                _extract(source, whole)
                if folder.exists():
                    folder.rmdir()
                whole.replace(folder)
    finally:
        source.close()


def _write_archive(file: BinaryIO, folder: Path, names: list[str]) -> None:
    with zipfile.ZipFile(file, "w") as archive:
        for name in names:
            info = zipfile.ZipInfo(name, _EPOCH)
            info.external_attr = 0o100644 << 16
            # Columns of noise in binary do not get smaller, only slower.
            info.compress_type = zipfile.ZIP_STORED if name.endswith(".parquet") else zipfile.ZIP_DEFLATED
            info.file_size = (folder / name).stat().st_size
            with (folder / name).open("rb") as source, archive.open(info, "w") as target:
                shutil.copyfileobj(source, target, 2**20)


def _extract(source: ArchiveSource, folder: Path) -> None:
    for name in source.members:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with source.reading(), source.open(name) as packed, path.open("xb") as target:
            shutil.copyfileobj(packed, target, 2**20)


def _passing(name: str) -> bool:
    """What is there only while somebody writes."""
    return name == LOCK_FILE or name.endswith((SUFFIX, ".part"))
