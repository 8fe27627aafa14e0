"""Which recordings an analysis may take: the open job's first, then those that the person has found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QMimeData

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.ui.pages.desk import Desk

HEADER = "recording.toml"
ARCHIVE = ".ahrsrec"


class RecordingShelf:
    """Shared by all analyses of a page. ``changed`` is called when there is another one to offer."""

    def __init__(self, desk: Desk, changed: Callable[[], None]) -> None:
        self._desk = desk
        self._changed = changed
        self._found: list[Path] = []

    def offered(self) -> list[tuple[Path, str]]:
        """Path and what a person reads of it."""
        own = [(path, text) for path, text in self._of_job() if path not in self._found]
        return [*own, *((path, _name(path)) for path in self._found)]

    def _of_job(self) -> list[tuple[Path, str]]:
        number = self._desk.number
        if not number:
            return []
        try:
            path = self._desk.laboratory.bundle(number)
        except AhrsLabError:
            return []
        words = QCoreApplication.translate("Recordings", "Job {number}").format(number=number)
        return [(path, words)] if (path / HEADER).is_file() else []

    def add(self, path: Path) -> None:
        """The person has found one."""
        if path not in self._found:
            self._found.insert(0, path)
            self._changed()


def _name(path: Path) -> str:
    """The folder above too where the name alone says nothing."""
    return f"{path.parent.name}/{path.name}" if path.name in ("recording", "bundle") else path.name


def recording_of(path: Path) -> Path | None:
    """The recording that somebody means by this path: folder, archive, or the header within the folder."""
    if path.name == HEADER and path.is_file():
        return path.parent
    if path.suffix.lower() == ARCHIVE or (path / HEADER).is_file():
        return path
    return None


def dropped(data: QMimeData) -> tuple[list[Path], list[str]]:
    """The recordings among what was dropped, and the names of what is none."""
    paths = [Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile()]
    found = [recording_of(path) for path in paths]
    others = [path.name for path, recording in zip(paths, found, strict=True) if recording is None]
    return [recording for recording in found if recording is not None], others
