"""One writer a folder: a lock of the operating system's, so that a dead process never leaves one behind."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path
from typing import BinaryIO

from ahrs_lab.errors import InputError

LOCK_FILE = ".writing"
_LOCKED_BYTE = 1 << 20
"""Beyond the text, which another process has to be able to read on Windows too."""


class FolderLock:
    """Held from construction to :meth:`release`; raises InputError where another writer holds it."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / LOCK_FILE
        self._file = self._acquire(folder)

    def release(self) -> None:
        """Give the folder free; a second call does nothing."""
        if self._file.closed:
            return
        if sys.platform != "win32":
            # While it is locked: whoever opened it meanwhile sees that it is gone and starts anew.
            self._path.unlink(missing_ok=True)
            self._file.close()
        else:
            self._file.close()
            self._path.unlink(missing_ok=True)

    def _acquire(self, folder: Path) -> BinaryIO:
        while True:
            file = self._path.open("a+b")
            try:
                _lock(file)
            except OSError as error:
                owner = _owner(self._path)
                file.close()
                raise InputError(
                    "{folder} is being written by another instance ({owner}): "
                    "choose another folder, or close it.",
                    folder=folder,
                    owner=owner,
                ) from error
            if _still_there(self._path, file):
                file.truncate(0)
                file.write(f"process {os.getpid()} on {socket.gethostname()}".encode())
                file.flush()
                return file
            file.close()


def _lock(file: BinaryIO) -> None:
    if sys.platform == "win32":
        import msvcrt

        file.seek(_LOCKED_BYTE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        file.seek(0)
    else:
        import fcntl

        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)


def _still_there(path: Path, file: BinaryIO) -> bool:
    """Whether the locked file is the one at the path: its last owner may have removed it in between."""
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


def _owner(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace") or "?"
    except OSError:
        return "?"
