"""The page Start: what the laboratory has to do now, each job with its one next action."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QDate, QLocale, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.records.rows import JobRow
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.people import device_line, shown_name
from ahrs_lab.ui.pages.start_model import COLUMNS, Action, Agenda, Column, Task, agenda
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.pages.words import STATE_LOOKS, state_names
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import (
    Banner,
    Card,
    ElidedLabel,
    EmptyState,
    Label,
    Panel,
    PrimaryButton,
    SecondaryButton,
)

_PAGE_OF: dict[Action, str] = {
    "complete": "jobs",
    "start": "jobs",
    "watch": "run",
    "certify": "results",
    "check": "results",
    "approve": "certificate",
}


class StartPage(Page):
    """The agenda."""

    key = "start"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("jobs")
        self._empty.pressed.connect(self._new_job)
        self._stack.addWidget(self._empty)
        board = QWidget()
        column = QVBoxLayout(board)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        column.addLayout(self._make_head())
        columns = QHBoxLayout()
        columns.setSpacing(CARD_MARGIN)
        self._columns: dict[Column, _TaskColumn] = {}
        for key in COLUMNS:
            card = _TaskColumn()
            card.acted.connect(self._act)
            self._columns[key] = card
            columns.addWidget(card, 1)
        column.addLayout(columns, 3)
        self._issued = _IssuedCard()
        self._issued.opened.connect(lambda number: self._desk.open(number, "certificate"))
        column.addWidget(self._issued)
        self._hint = Banner("info")
        self._hint.pressed.connect(lambda: self.workspace.go_to("bench"))
        column.addWidget(self._hint)
        self._stack.addWidget(board)
        desk.jobs_changed.connect(self.refresh)
        self.retranslate()

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        words = QVBoxLayout()
        words.setSpacing(0)
        self._title = Label(role="title")
        self._day = Label(tone="muted")
        words.addWidget(self._title)
        words.addWidget(self._day)
        row.addLayout(words, 1)
        self.new_button = PrimaryButton(icon="add")
        self.new_button.clicked.connect(self._new_job)
        row.addWidget(self.new_button, 0, Qt.AlignmentFlag.AlignVCenter)
        return row

    def entered(self) -> None:
        self.refresh()

    def refresh(self) -> None:
        """Look at the jobs again."""
        laboratory = self._desk.laboratory
        jobs = laboratory.jobs()
        signed = {
            job.number: len(laboratory.signatures(job.number)) for job in jobs if job.state == "measured"
        }
        self._show(agenda(jobs, signed))

    def _show(self, found: Agenda) -> None:
        self._stack.setCurrentIndex(0 if found.empty else 1)
        for key, card in self._columns.items():
            card.show_tasks(found.tasks[key])
        self._issued.show_jobs(found.issued)

    def _new_job(self) -> None:
        self.workspace.go_to("jobs")
        self._desk.new_job.emit()

    def _act(self, number: str, page: str) -> None:
        self._desk.open(number, page)

    def retranslate(self) -> None:
        self._empty.set_content(
            self.tr("No jobs yet"),
            self.tr(
                "What the laboratory has to do will be here: devices to measure, results to verify, "
                "certificates to approve."
            ),
            self.tr("New job"),
        )
        self._title.setText(self.tr("To do"))
        locale = QLocale(QLocale.Language.Chinese if language() == "zh" else QLocale.Language.English)
        self._day.setText(locale.toString(QDate.currentDate(), QLocale.FormatType.LongFormat))
        self.new_button.setText(self.tr("New job"))
        self._columns["measure"].set_words(self.tr("To measure"), self.tr("Nothing waits for the bench."))
        self._columns["verify"].set_words(self.tr("To verify"), self.tr("No result waits for its check."))
        self._columns["approve"].set_words(
            self.tr("To approve"), self.tr("No certificate waits for approval.")
        )
        self._issued.set_words(self.tr("Issued last"))
        self._hint.set_content(
            "info",
            self.tr("Simulated bench"),
            self.tr(
                "The demonstration's table, supply, room and unit are simulated: "
                "each of its results and certificates says so."
            ),
            self.tr("Look at the bench"),
        )
        self.refresh()


class _TaskColumn(Card):
    """The jobs of one column."""

    acted = Signal(str, str)

    def __init__(self) -> None:
        super().__init__()
        self._count = Label(tone="muted")
        self.add_tool(self._count)
        self._nothing = Label(tone="faint", wrap=True)
        self.add(self._nothing)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(0, 0, 0, 0)
        self._list.setSpacing(GAP)
        self._list.addStretch(1)
        area.setWidget(inside)
        self.add(area, 1)

    def set_words(self, title: str, nothing: str) -> None:
        self.set_title(title)
        self._nothing.setText(nothing)

    def show_tasks(self, tasks: tuple[Task, ...]) -> None:
        while self._list.count() > 1:
            item = self._list.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        for place, task in enumerate(tasks):
            panel = _TaskPanel(task)
            panel.button.clicked.connect(
                lambda _on=False, task=task: self.acted.emit(task.job.number, _PAGE_OF[task.action])
            )
            self._list.insertWidget(place, panel)
        self._count.setText(str(len(tasks)) if tasks else "")
        self._nothing.setVisible(not tasks)


class _TaskPanel(Panel):
    """One job: what it is, how far it is, and the button that goes on with it."""

    def __init__(self, task: Task) -> None:
        super().__init__("plain")
        job = task.job
        head = QHBoxLayout()
        head.setSpacing(GAP)
        number = Label(job.number, role="strong")
        chip = Chip()
        kind, icon = STATE_LOOKS[job.state]
        chip.set_content(kind, icon, state_names()[job.state])
        head.addWidget(number, 1)
        head.addWidget(chip)
        self.body.addLayout(head)
        self.body.addWidget(ElidedLabel(device_line(job, language())))
        self.body.addWidget(ElidedLabel(shown_name(job.customer, language()), tone="muted"))
        foot = QHBoxLayout()
        foot.addWidget(
            ElidedLabel(self.tr("received {date}").format(date=job.received.isoformat()), tone="muted"), 1
        )
        self.button = SecondaryButton(_action_words()[task.action])
        foot.addWidget(self.button)
        self.body.addLayout(foot)


def _action_words() -> dict[Action, str]:
    translate = QCoreApplication.translate
    return {
        "complete": translate("StartPage", "Complete the job"),
        "start": translate("StartPage", "Prepare and start"),
        "watch": translate("StartPage", "Go to the run"),
        "certify": translate("StartPage", "Look at the result"),
        "check": translate("StartPage", "Check and sign"),
        "approve": translate("StartPage", "Approve"),
    }


class _IssuedCard(Card):
    """The certificates issued last, one line each."""

    opened = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._row = QHBoxLayout()
        self._row.setSpacing(GAP)
        self.add(self._row)

    def set_words(self, title: str) -> None:
        self.set_title(title)

    def show_jobs(self, jobs: tuple[JobRow, ...]) -> None:
        self.setVisible(bool(jobs))
        while self._row.count():
            item = self._row.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        for job in jobs[:4]:
            button = SecondaryButton(f"{job.number} · {device_line(job, language())}", icon="good")
            button.clicked.connect(lambda _on=False, number=job.number: self.opened.emit(number))
            self._row.addWidget(button)
        self._row.addStretch(1)
