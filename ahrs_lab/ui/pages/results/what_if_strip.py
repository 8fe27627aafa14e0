"""The line that says a budget is a question and not the result; or why what was typed cannot be."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import GAP, STEP, tokens
from ahrs_lab.ui.widgets import Label, QuietButton
from ahrs_lab.ui.widgets.buttons import repolish

_ICON_PX = 18


class WhatIfStrip(QFrame):
    """Not there while there is nothing to say."""

    reset_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._kind = "warn"
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * STEP, 0, 2 * STEP, 0)
        row.setSpacing(GAP)
        self._icon = QLabel()
        self._text = Label(wrap=True)
        self._text.setMinimumHeight(8 * STEP)
        self.reset_button = QuietButton(icon="repeat")
        self.reset_button.clicked.connect(self.reset_wanted)
        row.addWidget(self._icon)
        row.addWidget(self._text, 1)
        row.addWidget(self.reset_button)
        self._asked = ""
        self.setVisible(False)

    def say(self, expanded: str, instead_of: str, k: str) -> None:
        """U as it would be, and as it is."""
        self._asked = self.tr(
            "What if: U = {expanded} (k = {k}) instead of {before}. Not the result; nothing is stored."
        ).format(expanded=expanded, before=instead_of, k=k)
        self._show("warn", self._asked)

    def say_unchanged(self, expanded: str, k: str) -> None:
        """U would be the same."""
        self._asked = self.tr(
            "What if: U = {expanded} (k = {k}), unchanged. Not the result; nothing is stored."
        ).format(expanded=expanded, k=k)
        self._show("warn", self._asked)

    def refuse(self, why: str) -> None:
        """What was typed cannot be; what was asked before stands."""
        self._show("bad", f"{why}\n{self._asked}".rstrip())

    def clear(self) -> None:
        """Nothing is asked."""
        self._asked = ""
        self.setVisible(False)

    def text(self) -> str:
        """What is said, "" where nothing is."""
        return "" if self.isHidden() else self._text.text()

    def _show(self, kind: str, text: str) -> None:
        self._kind = kind
        self.setProperty("panel", kind)
        repolish(self)
        self._text.set_sentence(text)
        self.reset_button.setText(self.tr("Reset"))
        self._draw_icon()
        self.setVisible(True)

    def _draw_icon(self) -> None:
        colour = getattr(tokens(), self._kind)
        self._icon.setPixmap(icons.pixmap(self._kind, colour, _ICON_PX, self.devicePixelRatioF()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._draw_icon()
        super().changeEvent(event)
