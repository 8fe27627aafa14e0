"""The page Jobs: the list of all jobs, and behind each line its editor."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.records.rows import JobRow
from ahrs_lab.ui import icons
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.editor import JobEditor
from ahrs_lab.ui.pages.jobs.list_model import matching
from ahrs_lab.ui.pages.people import shown_name
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.words import STATE_LOOKS, state_names
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, tokens
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import Card, EmptyState, Label, PrimaryButton, SecondaryButton

_SEARCH_PX = 320


class JobsPage(Page):
    """Comes to the front with the open job's editor when another page asks for it, else with the list."""

    key = "jobs"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("jobs")
        self._empty.pressed.connect(self.new_job)
        desk.new_job.connect(self.new_job)
        self.editor = JobEditor(desk)
        self.editor.left.connect(self.show_list)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self._make_list())
        self._stack.addWidget(self.editor)
        desk.jobs_changed.connect(self._jobs_changed)
        QShortcut(QKeySequence.StandardKey.New, self, self.new_job)
        QShortcut(QKeySequence.StandardKey.Find, self, self._find)
        self.retranslate()

    def _make_list(self) -> QWidget:
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        head = QHBoxLayout()
        head.setSpacing(GAP)
        self._title = Label(role="title")
        self.search = QLineEdit()
        self.search.setFixedWidth(_SEARCH_PX)
        self.search.setClearButtonEnabled(True)
        self.search.addAction(icons.icon("search", tokens().muted), QLineEdit.ActionPosition.LeadingPosition)
        self.search.textChanged.connect(lambda _text: self._fill())
        self.import_button = SecondaryButton(icon="import")
        self.import_button.clicked.connect(self._import)
        self.new_button = PrimaryButton(icon="add")
        self.new_button.clicked.connect(self.new_job)
        head.addWidget(self._title)
        head.addStretch(1)
        for widget in (self.search, self.import_button, self.new_button):
            head.addWidget(widget, 0, Qt.AlignmentFlag.AlignVCenter)
        column.addLayout(head)
        card = Card()
        self.table = TextTable(sortable=True)
        self.table.opened.connect(self._open)
        self._nothing = Label(tone="muted")
        card.add(self.table, 1)
        card.add(self._nothing)
        column.addWidget(card, 1)
        return whole

    def entered(self) -> None:
        """With the open job, unless the list was left open on purpose."""
        self._fill()
        if self._desk.number and self._stack.currentWidget() is not self.editor:
            self._edit(self._desk.number)

    def job_changed(self) -> None:
        if self.isVisible() or not self._desk.number:
            return
        self._edit(self._desk.number)

    def new_job(self) -> None:
        """An empty editor."""
        self.editor.new()
        self._stack.setCurrentWidget(self.editor)

    def show_list(self) -> None:
        """Back to all jobs."""
        self._fill(to_front=True)
        self.table.setFocus()

    def _open(self, number: str) -> None:
        self._desk.open(number)
        self._edit(number)

    def _edit(self, number: str) -> None:
        try:
            self.editor.edit(self._desk.laboratory.job(number))
        except AhrsLabError as error:
            self._desk.tell(error)
            return
        self._stack.setCurrentWidget(self.editor)

    def _jobs_changed(self) -> None:
        if self._stack.currentWidget() is self.editor and self.editor.number():
            self._edit(self.editor.number())
        else:
            self._fill()

    def _fill(self, *, to_front: bool = False) -> None:
        jobs = self._desk.laboratory.jobs()
        found = matching(jobs, self.search.text())
        columns = (
            Column(self.tr("Number")),
            Column(self.tr("State")),
            Column(self.tr("Customer"), stretch=True),
            Column(self.tr("Device"), stretch=True),
            Column(self.tr("Serial number")),
            Column(self.tr("Received")),
        )
        self.table.set_content(columns, [_cells(job) for job in found], [job.number for job in found])
        self.table.sort_by(0, Qt.SortOrder.DescendingOrder)
        self._nothing.setVisible(bool(jobs) and not found)
        if to_front or self._stack.currentWidget() is not self.editor:
            self._stack.setCurrentIndex(1 if jobs else 0)

    def _find(self) -> None:
        if self._stack.currentIndex() == 1:
            self.search.setFocus()

    def _import(self) -> None:
        actor = self._desk.ask_actor(self)
        if actor is None:
            return
        path, _ = QFileDialog.getOpenFileName(
            self, self.tr("Import a recording"), "", self.tr("Recordings (*.ahrsrec recording.toml)")
        )
        if not path:
            return
        chosen = Path(path)
        bundle = chosen.parent if chosen.name == "recording.toml" else chosen
        self.import_button.setEnabled(False)
        self._desk.run(
            self,
            lambda: self._desk.laboratory.import_bundle(bundle, actor),
            self._imported,
            self._not_imported,
        )

    def _imported(self, number: str) -> None:
        self.import_button.setEnabled(True)
        self._desk.open(number)
        self._desk.changed()
        self._desk.workspace.go_to("results")

    def _not_imported(self, error: AhrsLabError) -> None:
        self.import_button.setEnabled(True)
        self._desk.tell(error)

    def retranslate(self) -> None:
        self._empty.set_content(
            self.tr("No jobs yet"),
            self.tr("Each device that is received becomes a job here, from its order to its certificate."),
            self.tr("New job"),
        )
        self._title.setText(self.tr("Jobs"))
        self.search.setPlaceholderText(self.tr("Search number, customer, device"))
        self.search.setAccessibleName(self.tr("Search"))
        self.import_button.setText(self.tr("Import a recording …"))
        self.new_button.setText(self.tr("New job"))
        self._nothing.setText(self.tr("No job has these words."))
        self._fill()


def _cells(job: JobRow) -> tuple[Cell, ...]:
    kind, _ = STATE_LOOKS[job.state]
    tone = {"plain": "muted", "accent": "accent", "warn": "warn", "good": "good", "bad": "bad"}[kind]
    model = job.device.model or shown_name(job.device, language())
    return (
        Cell(job.number, strong=True),
        Cell(state_names()[job.state], tone),
        Cell(shown_name(job.customer, language())),
        Cell(" ".join(part for part in (job.device.manufacturer, model) if part)),
        Cell(job.device.serial_number),
        Cell(job.received.isoformat(), "muted"),
    )
