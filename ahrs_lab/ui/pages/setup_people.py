"""Who works here and what they may do."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.records.rows import ROLES, PersonRow, Role, SignedIn
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import TextField, TickField, grid
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.pages.words import listed, role_names
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Label, PrimaryButton, SecondaryButton


class PeoplePanel(Translated):
    """A table; adding and changing is an administrator's."""

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
        names = role_names()
        columns = (
            Column(self.tr("Name")),
            Column(self.tr("Name in English")),
            Column(self.tr("Position"), stretch=True),
            Column(self.tr("Roles"), stretch=True),
            Column(self.tr("State")),
        )
        people = self._desk.laboratory.people()
        rows = [
            (
                Cell(person.name, strong=True),
                Cell(person.name_en),
                Cell(" / ".join(text for text in (person.position, person.position_en) if text), "muted"),
                Cell(listed(names[role] for role in ROLES if role in person.roles)),
                Cell(
                    self.tr("active") if person.active else self.tr("left"),
                    "good" if person.active else "muted",
                ),
            )
            for person in people
        ]
        self.table.set_content(columns, rows, [str(person.id) for person in people])
        self.edit_button.setEnabled(bool(self.table.current_key()))

    def _edit(self, key: str) -> None:
        actor = self._desk.ask_actor(self)
        if actor is None:
            return
        known = {str(person.id): person for person in self._desk.laboratory.people()}
        dialog = PersonDialog(self._desk, actor, known.get(key), self)
        dialog.exec()
        dialog.deleteLater()
        self.refresh()

    def retranslate(self) -> None:
        self._hint.setText(
            self.tr("Three different people sign a certificate: operator, verifier, approver.")
        )
        self.edit_button.setText(self.tr("Edit"))
        self.add_button.setText(self.tr("New person"))
        self.refresh()


class PersonDialog(Question):
    """Adds (``person`` None) or changes somebody; a new password comes with a new signing key."""

    def __init__(
        self, desk: Desk, actor: SignedIn, person: PersonRow | None, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._desk, self._actor, self._person = desk, actor, person
        self.setMinimumWidth(560)
        self.name, self.name_en = TextField(), TextField()
        self.position, self.position_en = TextField(), TextField()
        self.password = TextField(secret=True)
        self.roles: dict[Role, TickBox] = {role: TickBox(text) for role, text in role_names().items()}
        self.active = TickField()
        self.name.set_name(self.tr("Name"))
        self.name_en.set_name(self.tr("Name in English"))
        self.position.set_name(self.tr("Position"))
        self.position_en.set_name(self.tr("Position in English"))
        hint = self.tr("Empty: the password stays.") if person else self.tr("It also locks the signing key.")
        self.password.set_name(self.tr("Password"), hint)
        self.active.setText(self.tr("works here"))
        row = QHBoxLayout()
        for box in self.roles.values():
            row.addWidget(box)
        row.addStretch(1)
        self.body.addLayout(grid((self.name, self.name_en), (self.position, self.position_en)))
        self.body.addLayout(row)
        self.body.addLayout(grid((self.password,)))
        self.body.addWidget(self.active)
        self._show(person or PersonRow(0, ""))
        self.ask(self.tr("Edit person") if person else self.tr("New person"), "", self.tr("Save"))

    def _show(self, person: PersonRow) -> None:
        self.name.set_text(person.name)
        self.name_en.set_text(person.name_en)
        self.position.set_text(person.position)
        self.position_en.set_text(person.position_en)
        for role, box in self.roles.items():
            box.setChecked(role in person.roles)
        self.active.setChecked(person.active)
        self.active.setVisible(person.id != 0)

    def answered(self) -> None:
        """Hashing and making a key take a moment: in the worker."""
        row = PersonRow(
            id=self._person.id if self._person else 0,
            name=self.name.text(),
            name_en=self.name_en.text(),
            position=self.position.text(),
            position_en=self.position_en.text(),
            roles=frozenset(role for role, box in self.roles.items() if box.isChecked()),
            active=self.active.isChecked(),
        )
        password, laboratory, actor = self.password.text(), self._desk.laboratory, self._actor
        self.set_busy(True)

        def work() -> None:
            if row.id:
                laboratory.change_person(row, actor, password or None)
            else:
                laboratory.add_person(row, password, actor)

        self._desk.run(self, work, lambda _none: self.accept(), self._refused)

    def _refused(self, error: AhrsLabError) -> None:
        self.refuse(said(error.message))
