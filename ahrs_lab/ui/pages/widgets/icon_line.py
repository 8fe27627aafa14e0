"""A sentence with the icon of its state in front."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import GAP, tokens
from ahrs_lab.ui.widgets import Label

_TONE = {"good": "good", "warn": "warn", "bad": "bad", "info": "accent"}


class IconLine(QWidget):
    """``state`` is good, warn, bad or info."""

    def __init__(self, state: str, text: str) -> None:
        super().__init__()
        self._state = state
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(GAP)
        self._icon = QLabel()
        self._text = Label(wrap=True)
        self._text.set_sentence(text)
        row.addWidget(self._icon, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self._text, 1)
        self._draw()

    def set_content(self, state: str, text: str) -> None:
        """Another state and sentence."""
        self._state = state
        self._text.set_sentence(text)
        self._draw()

    def text(self) -> str:
        """The sentence."""
        return self._text.text()

    def _draw(self) -> None:
        colour = getattr(tokens(), _TONE[self._state])
        self._icon.setPixmap(icons.pixmap(self._state, colour, 16, self.devicePixelRatioF()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._draw()
        super().changeEvent(event)
