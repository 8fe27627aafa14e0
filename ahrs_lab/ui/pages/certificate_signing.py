"""The three signature fields beside the preview, and the password that signs."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QWidget

from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.errors import AhrsLabError
from ahrs_lab.records.rows import SignedIn, SigningRole
from ahrs_lab.ui.pages.certificate_model import SigningPlace
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.people import shown_name, shown_position
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import TextField
from ahrs_lab.ui.pages.words import role_names
from ahrs_lab.ui.translation import language, said
from ahrs_lab.ui.widgets import ElidedLabel, Label, Panel, PrimaryButton, SecondaryButton


class SignPanel(Panel):
    """``sign_wanted`` and ``sign_in_wanted`` tell the role."""

    sign_wanted = Signal(str)
    sign_in_wanted = Signal(str)

    def __init__(self, role: SigningRole) -> None:
        super().__init__("plain")
        self.body.setContentsMargins(12, 8, 12, 10)
        self.body.setSpacing(2)
        self.role: SigningRole = role
        self._place: SigningPlace | None = None
        head = QHBoxLayout()
        self._role = Label(tone="muted")
        self.chip = Chip()
        head.addWidget(self._role, 1)
        head.addWidget(self.chip)
        self._name = ElidedLabel(role="strong")
        self._details = ElidedLabel(tone="muted")
        self.sign = PrimaryButton(icon="sign")
        self.sign.clicked.connect(lambda: self.sign_wanted.emit(self.role))
        self.change = SecondaryButton(icon="person")
        self.change.clicked.connect(lambda: self.sign_in_wanted.emit(self.role))
        self.body.addLayout(head)
        for widget in (self._name, self._details, self.sign, self.change):
            self.body.addWidget(widget)

    def show_place(self, place: SigningPlace) -> None:
        """Who, and what the field waits for."""
        self._place = place
        self._role.setText(role_names()[place.role])
        person = place.person
        self._name.setText(shown_name(person, language()) if person else self.tr("not chosen"))
        words = {
            "signed": ("good", "good", self.tr("signed")),
            "yours": ("accent", "sign", self.tr("your turn")),
            "theirs": ("warn", "clock", self.tr("waits")),
            "later": ("plain", "clock", self.tr("later")),
            "unmeasured": ("plain", "clock", self.tr("Finish the run first")),
            "nobody": ("bad", "bad", self.tr("missing")),
        }
        kind, icon, text = words[place.turn]
        self.chip.set_content(kind, icon, text)  # type: ignore[arg-type]
        when = local_time(place.signature.utc) if place.signature else ""
        position = shown_position(person, language()) if person else ""
        self._details.setText("  ·  ".join(text for text in (position, when) if text))
        self._details.setVisible(bool(self._details.text()))
        self.sign.setVisible(place.turn == "yours")
        self.change.setVisible(place.turn == "theirs")
        self.set_kind("good" if place.turn == "signed" else "accent" if place.turn == "yours" else "plain")
        actions = {
            "operator": self.tr("Certify and sign"),
            "verifier": self.tr("Checked: sign"),
            "approver": self.tr("Approve and issue"),
        }
        self.sign.setText(actions[place.role])
        self.change.setText(self.tr("Sign in as this person"))


def local_time(utc: str) -> str:
    """An ISO time of the records on the laboratory's own clock, to the minute."""
    return datetime.fromisoformat(utc).astimezone().strftime("%Y-%m-%d %H:%M")


class SignDialog(Question):
    """Asks for the password once more: it opens the person's own key. ``file`` is the signed certificate."""

    def __init__(
        self,
        desk: Desk,
        number: str,
        role: SigningRole,
        actor: SignedIn,
        certificate_language: CertificateLanguage,
        parent: QWidget | None = None,
        *,
        budget_annex: bool = False,
    ) -> None:
        super().__init__(parent)
        self._desk = desk
        self._call = (number, role, actor, certificate_language)
        self._budget_annex = budget_annex
        self.file: Path | None = None
        self.password = TextField(secret=True)
        self.password.set_name(
            self.tr("Password of {name}").format(name=shown_name(actor.person, language()))
        )
        self.body.addWidget(self.password)
        texts = {
            "operator": self.tr("Your signature fixes the content of the certificate."),
            "verifier": self.tr("You confirm that you have checked the result, its deviations and its data."),
            "approver": self.tr("Your signature issues the certificate; nothing can be added afterwards."),
        }
        self.ask(
            self.tr("Sign as {role}").format(role=role_names()[role].lower()), texts[role], self.tr("Sign")
        )
        self.password.line.setFocus()

    def answered(self) -> None:
        """Lay out and sign in the worker."""
        password = self.password.text()
        if not password:
            self.password.set_error(self.tr("Enter the password."))
            return
        self.password.set_error("")
        self.set_busy(True)
        number, role, actor, chosen = self._call
        self._desk.run(
            self,
            lambda: self._desk.laboratory.sign(
                number, role, actor, password, chosen, budget_annex=self._budget_annex
            ),
            self._signed,
            self._refused,
        )

    def _signed(self, file: Path) -> None:
        self.file = file
        self.set_busy(False)
        self.accept()

    def _refused(self, error: AhrsLabError) -> None:
        self.refuse(said(error.message))
        self.password.line.selectAll()
        self.password.line.setFocus()
