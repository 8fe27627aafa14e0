"""Small questions: a title, a sentence, a few fields, one action. What is wrong is said inside the dialog."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Banner, Label, PrimaryButton, ProgressBar, SecondaryButton

_WIDTH = 440


class Question(QDialog):
    """Subclasses put fields into ``body`` and override :meth:`answered`: accept or :meth:`refuse`."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(True)
        self.setMinimumWidth(_WIDTH)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 20)
        column.setSpacing(CARD_MARGIN)
        self._title = Label(role="title", wrap=True)
        self._text = Label(tone="muted", wrap=True)
        self._text.setVisible(False)
        self._refusal = Banner("bad")
        self._refusal.setVisible(False)
        self.body = QVBoxLayout()
        self.body.setSpacing(CARD_MARGIN)
        self._progress = ProgressBar()
        self._progress.setVisible(False)
        buttons = QHBoxLayout()
        buttons.setSpacing(GAP)
        self.cancel = SecondaryButton()
        self.cancel.setAutoDefault(False)
        self.cancel.clicked.connect(self.reject)
        self.action = PrimaryButton()
        self.action.setDefault(True)
        self.action.clicked.connect(self.answered)
        buttons.addStretch(1)
        buttons.addWidget(self.cancel)
        buttons.addWidget(self.action)
        column.addWidget(self._title)
        column.addWidget(self._text)
        column.addLayout(self.body)
        column.addWidget(self._refusal)
        column.addWidget(self._progress)
        column.addLayout(buttons)
        self.cancel.setText(self.tr("Cancel"))

    def ask(self, title: str, text: str, action: str) -> None:
        """What the dialog is about, and the word on its button."""
        self.setWindowTitle(title)
        self._title.setText(title)
        self._text.setText(text)
        self._text.setVisible(bool(text))
        self.action.setText(action)

    def answered(self) -> None:
        """The action was pressed."""
        self.accept()

    def refuse(self, text: str) -> None:
        """Say what is wrong and stay open."""
        self.set_busy(False)
        self._refusal.set_content("bad", "", text)
        self._refusal.setVisible(True)
        self.fit()

    def fit(self) -> None:
        """As high as what is said now: wrapped texts do not make room for themselves in a dialog."""
        layout = self.layout()
        if layout is None:
            return
        layout.activate()
        needed = max(layout.totalHeightForWidth(self.width()), layout.totalMinimumSize().height())
        if self.height() < needed:
            self.resize(self.width(), needed)

    def refusal(self) -> str:
        """What is said to be wrong, "" where nothing is."""
        return self._refusal.text() if self._refusal.isVisibleTo(self) else ""

    def set_busy(self, busy: bool) -> None:
        """While the answer is worked on nothing else can be pressed."""
        self._progress.set_value(None if busy else 0.0)
        self._progress.setVisible(busy)
        self.action.setEnabled(not busy)
        if busy:
            self._refusal.setVisible(False)
            self.setCursor(Qt.CursorShape.BusyCursor)
        else:
            self.unsetCursor()
