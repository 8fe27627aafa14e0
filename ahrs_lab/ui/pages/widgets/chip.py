"""A state as icon and word on its tint: small enough for a table's cell, never colour alone."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import STEP, tokens
from ahrs_lab.ui.widgets import Label, repolish

ChipKind = Literal["plain", "accent", "good", "warn", "bad"]
_TONE = {"plain": "muted", "accent": "accent", "good": "good", "warn": "warn", "bad": "bad"}
_ICON = 14


class Chip(QFrame):
    """``set_content`` gives kind, icon name and word at once."""

    def __init__(self) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * STEP, 2, 2 * STEP + 2, 2)
        row.setSpacing(STEP + 1)
        self._icon = QLabel()
        self._text = Label()
        row.addWidget(self._icon, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self._text, 0, Qt.AlignmentFlag.AlignVCenter)
        self._content: tuple[ChipKind, str] = ("plain", "")

    def set_content(self, kind: ChipKind, icon: str, text: str) -> None:
        """``icon`` is a name of :mod:`ahrs_lab.ui.icons`."""
        self._content = (kind, icon)
        self.setProperty("panel", kind)
        repolish(self)
        self._text.setText(text)
        self._text.set_tone(_TONE[kind])  # type: ignore[arg-type]
        self._draw()

    def text(self) -> str:
        """The word."""
        return self._text.text()

    def _draw(self) -> None:
        kind, icon = self._content
        if icon:
            colour = getattr(tokens(), _TONE[kind])
            self._icon.setPixmap(icons.pixmap(icon, colour, _ICON, self.devicePixelRatioF()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._draw()
        super().changeEvent(event)
