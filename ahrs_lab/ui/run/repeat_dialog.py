"""Which segment to record again, and why: the reason goes into the record."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QComboBox, QDialog, QHBoxLayout, QLineEdit, QVBoxLayout, QWidget

from ahrs_lab.recording.segment import Segment
from ahrs_lab.ui.run import words
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Label, PrimaryButton, SecondaryButton

_WIDTH = 460


class RepeatDialog(QDialog):
    """``segment`` and ``reason`` after it was accepted."""

    def __init__(self, segments: Sequence[Segment], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Repeat a segment"))
        self.setMinimumWidth(_WIDTH)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 20)
        column.setSpacing(GAP)
        column.addWidget(Label(self.tr("Repeat a segment"), role="title"))
        column.addWidget(Label(self.tr("Both takes are kept; the new one counts."), tone="muted", wrap=True))
        column.addSpacing(GAP)
        column.addWidget(Label(self.tr("Segment"), tone="muted"))
        self.choice = QComboBox()
        for segment in segments:
            self.choice.addItem(f"{words.segment(segment)}  ({segment.name})", segment.name)
        self.choice.setAccessibleName(self.tr("Segment"))
        column.addWidget(self.choice)
        column.addWidget(Label(self.tr("Reason"), tone="muted"))
        self.why = QLineEdit()
        self.why.setPlaceholderText(self.tr("for example: somebody leant on the table"))
        self.why.setAccessibleName(self.tr("Reason"))
        self.why.textChanged.connect(self._check)
        column.addWidget(self.why)
        column.addSpacing(CARD_MARGIN)
        row = QHBoxLayout()
        row.setSpacing(GAP)
        row.addStretch(1)
        cancel = SecondaryButton(self.tr("Cancel"))
        cancel.clicked.connect(self.reject)
        self.go = PrimaryButton(self.tr("Record it again"))
        self.go.clicked.connect(self.accept)
        self.go.setDefault(True)
        row.addWidget(cancel)
        row.addWidget(self.go)
        column.addLayout(row)
        self._check()
        self.why.setFocus()

    def _check(self) -> None:
        self.go.setEnabled(bool(self.reason) and self.choice.count() > 0)

    @property
    def segment(self) -> str:
        """The chosen segment's name."""
        return str(self.choice.currentData())

    @property
    def reason(self) -> str:
        """Why."""
        return self.why.text().strip()
