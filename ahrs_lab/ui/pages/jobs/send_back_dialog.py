"""The approver returns a checked job; its reason is kept, and the next certificate is a new revision."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import TextField


class SendBackDialog(Question):
    """``reason_text`` is never empty once it is accepted."""

    def __init__(self, number: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.reason = TextField()
        self.reason.set_name(self.tr("Reason"))
        self.body.addWidget(self.reason)
        self.ask(
            self.tr("Send job {number} back").format(number=number),
            self.tr("The signed file stays; the operator lays out and signs a new revision."),
            self.tr("Send back"),
        )
        self.reason.line.setFocus()

    def reason_text(self) -> str:
        """What was typed."""
        return self.reason.text()

    def answered(self) -> None:
        """Only with a reason."""
        if self.reason.text():
            self.accept()
        else:
            self.reason.set_error(self.tr("Give the reason."))
