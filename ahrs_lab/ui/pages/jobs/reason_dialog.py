"""Clause 6 is violated: a second person gives a reason and signs in for it, or the job does not start."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.messages import Message
from ahrs_lab.records.rows import SignedIn
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.people import shown_name
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from ahrs_lab.ui.translation import language, said
from ahrs_lab.ui.widgets import Banner


class ReasonDialog(Question):
    """``second`` is who stands for it, None as long as nobody does."""

    def __init__(
        self, desk: Desk, first: SignedIn, violations: Sequence[Message], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._desk = desk
        self.second: SignedIn | None = None
        listed = Banner("warn")
        listed.set_content("warn", "", "\n".join(said(message) for message in violations))
        self.reason = TextField()
        self.reason.set_name(self.tr("Reason"), self.tr("It goes into the record and onto the certificate."))
        self.person = ChoiceField()
        self.person.set_name(self.tr("Second person"))
        able = [
            (p.name, shown_name(p, language()))
            for p in desk.laboratory.people()
            if p.active and p.id != first.person.id and p.roles & {"verifier", "approver"}
        ]
        self.person.set_choices(able)
        self.password = TextField(secret=True)
        self.password.set_name(self.tr("Password of the second person"))
        for widget in (listed, self.reason, self.person, self.password):
            self.body.addWidget(widget)
        self.ask(
            self.tr("The bench violates clause 6"),
            self.tr("The job starts only when a second person gives a reason."),
            self.tr("Accept and start"),
        )
        self.reason.line.setFocus()

    def reason_text(self) -> str:
        """What was typed."""
        return self.reason.text()

    def answered(self) -> None:
        """The reason is checked here, the password in the worker."""
        self.reason.set_error("" if self.reason.text() else self.tr("Give the reason."))
        self.password.set_error("" if self.password.text() else self.tr("Enter the password."))
        if not self.reason.text() or not self.password.text():
            return
        name, password = self.person.key(), self.password.text()
        self.set_busy(True)
        self._desk.run(
            self,
            lambda: self._desk.laboratory.sign_in(name, password),
            self._signed_in,
            self._refused,
        )

    def _signed_in(self, second: SignedIn) -> None:
        self.second = second
        self.set_busy(False)
        self.accept()

    def _refused(self, error: AhrsLabError) -> None:
        self.refuse(said(error.message))
