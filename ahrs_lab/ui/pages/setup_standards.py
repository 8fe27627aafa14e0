"""The laboratory's measurement standards with their certificates."""

from __future__ import annotations

from datetime import date

from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.metrology.figures_json import figures_from_text, figures_text
from ahrs_lab.records.rows import SignedIn, StandardRow
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.figures_form import FiguresForm
from ahrs_lab.ui.pages.jobs.checks import overdue
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField, grid
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.words import standard_kinds
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.translation import language, said
from ahrs_lab.ui.widgets import Label, PrimaryButton, SecondaryButton


class StandardsPanel(Translated):
    """A table; adding and changing is an operator's or an administrator's."""

    def __init__(self, desk: Desk) -> None:
        super().__init__()
        self._desk = desk
        column = QVBoxLayout(self)
        column.setContentsMargins(0, CARD_MARGIN, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self.table = TextTable()
        head = QHBoxLayout()
        self._hint = Label(tone="muted", wrap=True)
        self.edit_button = SecondaryButton(icon="edit")
        self.edit_button.clicked.connect(lambda: self._edit(self.table.current_key()))
        self.add_button = PrimaryButton(icon="add")
        self.add_button.clicked.connect(lambda: self._edit(""))
        head.addWidget(self._hint, 1)
        head.addWidget(self.edit_button)
        head.addWidget(self.add_button)
        column.addLayout(head)
        self.table.opened.connect(self._edit)
        self.table.chosen.connect(lambda _key: self.edit_button.setEnabled(True))
        column.addWidget(self.table, 1)
        self.retranslate()

    def refresh(self) -> None:
        """As the records have them."""
        columns = (
            Column(self.tr("Name"), stretch=True),
            Column(self.tr("Model")),
            Column(self.tr("Serial number")),
            Column(self.tr("Accuracy"), stretch=True),
            Column(self.tr("Certificate")),
            Column(self.tr("Due")),
        )
        standards = self._desk.laboratory.standards()
        self.table.set_content(
            columns, [self._cells(row) for row in standards], [str(row.id) for row in standards]
        )
        self.edit_button.setEnabled(bool(self.table.current_key()))

    def _cells(self, row: StandardRow) -> tuple[Cell, ...]:
        chinese = language() == "zh"
        today = date.today()  # noqa: DTZ011  due dates are the laboratory's own
        due = row.due.isoformat() if row.due else self.tr("no due date")
        if overdue(row, today):
            due = self.tr("{date} expired").format(date=due)
        return (
            Cell(row.name_zh if chinese and row.name_zh else row.name, strong=True),
            Cell(row.model),
            Cell(row.serial_number),
            Cell(_plain(row.accuracy_zh if chinese and row.accuracy_zh else row.accuracy), "muted"),
            Cell(row.certificate_number),
            Cell(due, "bad" if overdue(row, today) else "text" if row.due else "warn"),
        )

    def _edit(self, key: str) -> None:
        actor = self._desk.ask_actor(self)
        if actor is None:
            return
        known = {str(row.id): row for row in self._desk.laboratory.standards()}
        dialog = StandardDialog(self._desk, actor, known.get(key) or StandardRow(0, "table", ""), self)
        dialog.exec()
        dialog.deleteLater()
        self.refresh()

    def retranslate(self) -> None:
        self._hint.setText(self.tr("What the bench is traceable to; jobs choose from these."))
        self.edit_button.setText(self.tr("Edit"))
        self.add_button.setText(self.tr("New standard"))
        self.refresh()


class StandardDialog(Question):
    """Adds (id 0) or changes a standard."""

    def __init__(self, desk: Desk, actor: SignedIn, row: StandardRow, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._desk, self._actor, self._row = desk, actor, row
        self.setMinimumWidth(820)
        self.kind = ChoiceField()
        self.kind.set_choices(list(standard_kinds().items()))
        self.fields = {name: TextField() for name in _NAMES}
        self.due = TextField()
        f = self.fields
        self.body.addLayout(
            grid(
                (self.kind, f["name"], f["name_zh"]),
                (f["manufacturer"], f["model"], f["serial_number"]),
                (f["accuracy"], None, f["accuracy_zh"]),
                (f["certificate_number"], self.due, f["traceability"]),
            )
        )
        self.figures = FiguresForm()
        self.body.addWidget(self.figures)
        self._name()
        self.kind.set_key(row.kind)
        self.figures.set_kind(self.kind.key())
        self.kind.edited.connect(self._kind_chosen)
        for name, field in self.fields.items():
            field.set_text(str(getattr(row, name)))
        self.due.set_text(row.due.isoformat() if row.due else "")
        try:
            self.figures.set_figures(figures_from_text(row.figures_json, row.name))
        except AhrsLabError as error:
            self.refuse(said(error.message))
        self.ask(self.tr("Edit standard") if row.id else self.tr("New standard"), "", self.tr("Save"))

    def _name(self) -> None:
        self.kind.set_name(self.tr("Kind"))
        names = {
            "name": self.tr("Name in English"),
            "name_zh": self.tr("Name in Chinese"),
            "manufacturer": self.tr("Manufacturer"),
            "model": self.tr("Model"),
            "serial_number": self.tr("Serial number"),
            "accuracy": self.tr("Accuracy (English)"),
            "accuracy_zh": self.tr("Accuracy (Chinese)"),
            "certificate_number": self.tr("Certificate number"),
            "traceability": self.tr("Traceable to"),
        }
        for name, text in names.items():
            self.fields[name].set_name(text)
        self.due.set_name(self.tr("Due date"), self.tr("year-month-day; empty: none"))

    def _kind_chosen(self) -> None:
        self.figures.set_kind(self.kind.key())
        self.adjustSize()

    def answered(self) -> None:
        """Save it, or say what is wrong."""
        text = self.due.text()
        try:
            due = date.fromisoformat(text) if text else None
        except ValueError:
            self.due.set_error(self.tr("Write the date as 2027-03-31."))
            return
        self.due.set_error("")
        values = {name: field.text() for name, field in self.fields.items()}
        try:
            stated = figures_text(self.figures.figures())
        except ValueError as error:
            self.refuse(str(error))
            return
        row = StandardRow(id=self._row.id, kind=self.kind.key(), due=due, figures_json=stated, **values)
        try:
            self._desk.laboratory.save_standard(row, self._actor)
        except AhrsLabError as error:
            self.refuse(said(error.message))
            return
        self.accept()


_NAMES = (
    "name", "name_zh", "manufacturer", "model", "serial_number", "accuracy", "accuracy_zh",
    "certificate_number", "traceability",
)  # fmt: skip


def _plain(text: str) -> str:
    """The certificate's markup (raised ``10^{−4}``, lowered ``U_rel``) as a table can show it."""
    return text.replace("×10^{", "E").replace("^{", "^").replace("_{", "").replace("}", "").replace("U_", "U")
