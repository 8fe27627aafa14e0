"""Who works: choose a name, give the password."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.records.rows import PersonRow, SignedIn
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.people import shown_name, shown_position
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from ahrs_lab.ui.pages.words import listed, role_names
from ahrs_lab.ui.translation import language, said


class SignInDialog(Question):
    """``actor`` is who signed in, None as long as nobody did; ``prefer`` is the name chosen at first."""

    def __init__(self, desk: Desk, parent: QWidget | None = None, *, prefer: str = "") -> None:
        super().__init__(parent)
        self._desk = desk
        self.actor: SignedIn | None = None
        self.person = ChoiceField()
        self.password = TextField(secret=True)
        self.person.set_name(self.tr("Name"))
        self.password.set_name(self.tr("Password"))
        self.body.addWidget(self.person)
        self.body.addWidget(self.password)
        people = [person for person in desk.laboratory.people() if person.active]
        self.person.set_choices([(person.name, _line(person)) for person in people])
        self.person.set_key(prefer or desk.laboratory.settings.last_person)
        self.ask(self.tr("Sign in"), "", self.tr("Sign in"))
        self.password.line.setFocus()

    def answered(self) -> None:
        """Check the password in the worker: hashing is slow by design."""
        name, password = self.person.key(), self.password.text()
        if not password:
            self.password.set_error(self.tr("Enter the password."))
            return
        self.password.set_error("")
        self.set_busy(True)
        self._desk.run(
            self, lambda: self._desk.laboratory.sign_in(name, password), self._signed_in, self._refused
        )

    def _signed_in(self, actor: SignedIn) -> None:
        self.actor = actor
        self.set_busy(False)
        self.accept()

    def _refused(self, error: AhrsLabError) -> None:
        self.refuse(said(error.message))
        self.password.line.selectAll()
        self.password.line.setFocus()


def _line(person: PersonRow) -> str:
    """``Demo operator · Calibration engineer``."""
    position = shown_position(person, language()) or listed(
        text for role, text in role_names().items() if role in person.roles
    )
    name = shown_name(person, language())
    return f"{name} · {position}" if position else name
