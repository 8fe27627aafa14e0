"""What the machine did not let us do, in words that say what to do about it."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from ahrs_lab.errors import MachineError


@contextmanager
def machine_faults(folder: Path) -> Iterator[None]:
    """Turns an OSError into a :class:`MachineError` about ``folder``."""
    try:
        yield
    except OSError as error:
        raise machine_error(error, folder) from error


def machine_error(error: OSError, folder: Path) -> MachineError:
    """The error of the operating system as a :class:`MachineError`."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return MachineError(
            "The disk with {folder} is full. What was recorded is kept: make room and resume.", folder=folder
        )
    if error.errno in (errno.EROFS, errno.EACCES, errno.EPERM):
        return MachineError(
            "{folder} may not be written: change its permissions or choose another folder.", folder=folder
        )
    if error.errno == errno.ENOENT:
        return MachineError(
            "{folder} is not there: was it moved, deleted, its drive unplugged, or its path mistyped? Bring "
            "it back and resume, or choose another folder.",
            folder=folder,
        )
    if error.errno in (errno.ENOTDIR, errno.EEXIST):
        return MachineError("{folder} is a file, not a folder: choose another folder.", folder=folder)
    return MachineError(
        "{folder} cannot be written: {error}.", folder=folder, error=error.strerror or str(error)
    )


def write_atomically(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """The file appears whole or not at all: written beside its place, on the disk, then renamed."""
    beside = path.with_name(path.name + ".part")
    try:
        with beside.open("wb") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except BaseException:
        # Gives a full disk its room back.
        beside.unlink(missing_ok=True)
        raise
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Have the folder's entries on the disk, where the system can."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
