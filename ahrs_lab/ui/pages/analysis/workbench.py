"""The page's content: the list of analyses, the form of the one in front, and its outcome."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QMessageBox, QStackedWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.laboratory.analyses.files import file_names, write_outcome
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.kind_form import Asked, KindForm
from ahrs_lab.ui.pages.analysis.kind_list import KindList
from ahrs_lab.ui.pages.analysis.outcome_card import OutcomeCard
from ahrs_lab.ui.pages.analysis.recordings import RecordingShelf, dropped
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.words import listed
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, Label, PrimaryButton

LIVE_MS = 150
"""So long after the last change a live analysis is done again."""
_LIST_PX, _FORM_PX = (168, 216), (272, 330)
"""Least and greatest widths; what is left is the outcome's."""


class Workbench(Translated):
    """Knows analyses only as :class:`~ahrs_lab.laboratory.analyses.kinds.AnalysisKind`."""

    def __init__(self, desk: Desk, kinds: Sequence[AnalysisKind]) -> None:
        super().__init__()
        self._desk = desk
        self._kinds = {kind.key: kind for kind in kinds}
        self._shelf = RecordingShelf(desk, self.refresh)
        self._forms: dict[str, KindForm] = {}
        self.form: KindForm | None = None
        self.kinds = KindList(kinds)
        self.kinds.chosen.connect(self.choose)
        self.outcome = OutcomeCard()
        self.outcome.save_wanted.connect(self._ask_folder)
        self.outcome.error_closed.connect(self._forget_error)
        self.run = PrimaryButton(icon="resume")
        self.run.clicked.connect(self.start)
        self._live_note = Label(tone="muted", wrap=True)
        self._debounce = QTimer(self)
        self._debounce.setSingleShot(True)
        self._debounce.timeout.connect(self.start)
        self.setAcceptDrops(True)
        self._lay_out()
        desk.background.busy_changed.connect(self._busy_changed)
        self.retranslate()
        if self._kinds:
            self.choose(next(iter(self._kinds)))

    def _lay_out(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        self._list_card, self._form_card = Card(), Card()
        for card, (least, most) in ((self._list_card, _LIST_PX), (self._form_card, _FORM_PX)):
            card.setMinimumWidth(least)
            card.setMaximumWidth(most)
        self._list_card.add(self.kinds, 1)
        self._stack = QStackedWidget()
        self._form_card.add(self._stack, 1)
        self._form_card.add(self._live_note)
        self._form_card.add(self.run)
        row.addWidget(self._list_card, 3)
        row.addWidget(self._form_card, 5)
        row.addWidget(self.outcome, 10)

    # content --------------------------------------------------------------------------------------------

    def choose(self, key: str) -> None:
        """Bring an analysis to the front, as it was left."""
        self._debounce.stop()
        form = self._forms.get(key)
        if form is None:
            form = self._forms[key] = KindForm(self._kinds[key], self._shelf)
            form.edited.connect(self._edited)
            form.submitted.connect(self.start)
            self._stack.addWidget(form)
        self.form = form
        form.refresh()
        self._stack.setCurrentWidget(form)
        self.kinds.set_current(key)
        self._form_card.set_title(said(form.kind.name))
        self._show()
        new = form.outcome is None and form.error is None
        if form.kind.live and not form.running and (new or form.again):
            self.start()

    def refresh(self) -> None:
        """Other recordings may be on offer."""
        for form in self._forms.values():
            form.refresh()
        if self.form is not None:
            self.outcome.mark_changed(self.form.changed())

    def _show(self) -> None:
        form = self.form
        if form is None:
            return
        self.outcome.set_running(False)
        self.outcome.show_outcome(form.kind, form.outcome, form.error, changed=form.changed())
        self.outcome.set_running(form.running)
        self.run.setVisible(not form.kind.live)
        self._live_note.setVisible(form.kind.live)
        self.run.setEnabled(not form.running)

    def _edited(self) -> None:
        form = self.form
        if form is None:
            return
        if form.kind.live:
            form.again = form.running
            self._debounce.start(LIVE_MS)
        self.outcome.mark_changed(form.changed() and not form.kind.live)

    # work -----------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Do the analysis in front, unless something in its form is missing or wrong."""
        form = self.form
        if form is None:
            return
        if form.running:
            form.again = form.kind.live
            return
        asked = form.asked()
        if asked is None:
            return
        form.again = False
        kind = form.kind

        def done(outcome: Outcome) -> None:
            form.outcome, form.answered, form.error = outcome, asked, None
            if form is self.form:
                self._show()

        def failed(error: AhrsLabError) -> None:
            form.error = error.message
            if form is self.form:
                self._show()

        self._desk.run(form, lambda: kind.run(asked.bundles, asked.settings), done, failed)

    def _busy_changed(self, owner: object, busy: bool) -> None:
        """Also where the work ended in a fault of ours, which nobody else tells."""
        form = owner
        if not isinstance(form, KindForm) or form not in self._forms.values():
            return
        form.running = busy
        if form is self.form:
            self.run.setEnabled(not busy)
            self.outcome.set_running(busy)
            if not busy and form.again:
                self._debounce.start(0)

    def _forget_error(self) -> None:
        if self.form is not None:
            self.form.error = None

    # files ----------------------------------------------------------------------------------------------

    def _ask_folder(self) -> None:
        form = self.form
        if form is None or form.outcome is None:
            return
        chosen = QFileDialog.getExistingDirectory(self, self.tr("Folder for the files"), str(Path.home()))
        if not chosen:
            return
        folder = Path(chosen)
        there = [name for name in file_names(form.outcome) if (folder / name).exists()]
        kept = [name for name in there if (folder / name).is_dir() and any((folder / name).iterdir())]
        if kept:
            self._desk.workspace.notice(
                "warn",
                self.tr("The folder holds a recording {names} already: choose another.").format(
                    names=listed(kept)
                ),
            )
        elif not there or self._may_replace(there):
            self.save(folder)

    def _may_replace(self, names: Sequence[str]) -> bool:
        box = QMessageBox(self)
        box.setIcon(QMessageBox.Icon.Warning)
        box.setWindowTitle(self.tr("Replace files"))
        box.setText(self.tr("The folder holds already: {names}.").format(names=listed(names)))
        replace = box.addButton(self.tr("Replace"), QMessageBox.ButtonRole.DestructiveRole)
        box.setDefaultButton(box.addButton(self.tr("Cancel"), QMessageBox.ButtonRole.RejectRole))
        box.exec()
        return box.clickedButton() is replace

    def save(self, folder: Path) -> None:
        """Write the outcome in front into ``folder``."""
        form = self.form
        if form is None or form.outcome is None or form.answered is None:
            return
        outcome, answered = form.outcome, form.answered
        self._desk.run(self, lambda: write_outcome(outcome, folder, answered.bundles), self._saved)

    def _saved(self, files: dict[str, Path]) -> None:
        folder = next(iter(files.values())).parent
        names = listed(path.name for path in files.values())
        self._desk.workspace.notice(
            "good", self.tr("Saved in {folder}: {names}.").format(folder=folder, names=names)
        )

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if self.form is not None and self.form.recordings and any(dropped(event.mimeData())):
            event.setDropAction(Qt.DropAction.CopyAction)
            event.accept()

    def dropEvent(self, event: QDropEvent) -> None:
        if self.form is None:
            return
        found, others = dropped(event.mimeData())
        self.form.take(found)
        event.accept()
        if others:
            self._desk.workspace.notice(
                "warn",
                self.tr(
                    "No recording: {names}. A recording is a folder with recording.toml in it, or an "
                    ".ahrsrec file."
                ).format(names=listed(others)),
            )

    # words ----------------------------------------------------------------------------------------------

    def retranslate(self) -> None:
        self._list_card.set_title(self.tr("Analyses"))
        self.run.setText(self.tr("Run"))
        self._live_note.setText(self.tr("The charts follow the settings."))
        if self.form is not None:
            self._form_card.set_title(said(self.form.kind.name))


__all__ = ["Asked", "Workbench"]
