"""The field for one recording: those on offer, and a button to look for another."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QMenu, QVBoxLayout

from ahrs_lab.messages import Message
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.recordings import RecordingShelf, recording_of
from ahrs_lab.ui.pages.analysis.setting_values import titled
from ahrs_lab.ui.pages.widgets.form import ChoiceField
from ahrs_lab.ui.theme import STEP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import ElidedLabel, IconButton, Label


class RecordingField(Translated):
    """``edited`` tells that the person chose another one."""

    edited = Signal()

    def __init__(self, label: Message, shelf: RecordingShelf, *, offer: bool) -> None:
        super().__init__()
        self._label = label
        self._shelf = shelf
        self._offer = offer
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        self._name = Label(tone="muted", wrap=True)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.field = ChoiceField()
        self.field.show_name(False)
        self.field.edited.connect(self._chosen)
        self.seek = IconButton("folder")
        self.seek.clicked.connect(self._ask)
        row.addWidget(self.field, 1)
        row.addWidget(self.seek, 0, Qt.AlignmentFlag.AlignTop)
        self._where = ElidedLabel(tone="faint", mode=Qt.TextElideMode.ElideMiddle)
        column.addWidget(self._name)
        column.addLayout(row)
        column.addWidget(self._where)
        self._menu = QMenu(self)
        self._folder = self._menu.addAction("", self.find_folder)
        self._file = self._menu.addAction("", self.find_file)
        self.retranslate()
        self.refresh()

    def refresh(self) -> None:
        """There may be others on offer; the chosen one stays. The first recording takes what is offered
        first."""
        offered = self._shelf.offered()
        kept = self.field.key()
        blank = [] if self._offer and offered else [("", self.tr("none chosen"))]
        self.field.set_choices([*blank, *((str(path), text) for path, text in offered)])
        if kept and kept in {str(path) for path, _ in offered}:
            self.field.set_key(kept)
        self._tell()

    def path(self) -> Path | None:
        """The chosen recording."""
        return Path(self.field.key()) if self.field.key() else None

    def choose(self, path: Path) -> None:
        """Take this one; a folder that holds no recording is the analysis' to refuse."""
        path = recording_of(path) or path
        self._shelf.add(path)
        self.refresh()
        self.field.set_key(str(path))
        self._chosen()

    def missing(self) -> bool:
        """Whether none is chosen, which is then said below."""
        missing = self.path() is None
        self.field.set_error(self.tr("Choose a recording.") if missing else "")
        return missing

    def _chosen(self) -> None:
        self.field.set_error("")
        self._tell()
        self.edited.emit()

    def _tell(self) -> None:
        self._where.setText(self.field.key())
        self._where.setVisible(bool(self.field.key()))

    def _ask(self) -> None:
        self._menu.popup(self.seek.mapToGlobal(QPoint(0, self.seek.height())))

    def find_folder(self) -> None:
        """Look for a folder."""
        path = QFileDialog.getExistingDirectory(self, self.tr("Recording folder"), self._start())
        if path:
            self.choose(Path(path))

    def find_file(self) -> None:
        """Look for an archive."""
        path, _ = QFileDialog.getOpenFileName(
            self, self.tr("Recording file"), self._start(), self.tr("Recordings (*.ahrsrec recording.toml)")
        )
        if path:
            self.choose(Path(path))

    def _start(self) -> str:
        chosen = self.path()
        return str(chosen.parent if chosen is not None else Path.home())

    def retranslate(self) -> None:
        self._name.setText(titled(said(self._label)))
        self.field.set_name(said(self._label))
        self.seek.set_hint(self.tr("Look for a recording"))
        self._folder.setText(self.tr("Folder…"))
        self._file.setText(self.tr("File (.ahrsrec)…"))
        if self.field.error():
            self.missing()
        self.refresh()
