"""Tabs as wide as their bold text from the start: nothing moves when another one is chosen."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QTabBar

from ahrs_lab.ui.theme import font

_PADDING_PX = 26


class Tabs(QTabBar):
    """``set_texts`` names all tabs, making them the first time."""

    def __init__(self) -> None:
        super().__init__()
        self.setDrawBase(False)
        self.setExpanding(False)
        self.setUsesScrollButtons(False)
        self.setElideMode(Qt.TextElideMode.ElideNone)

    def set_texts(self, *texts: str) -> None:
        """In their order."""
        for place, text in enumerate(texts):
            if place < self.count():
                self.setTabText(place, text)
            else:
                self.addTab(text)

    def tabSizeHint(self, index: int) -> QSize:
        width = QFontMetrics(font("strong")).horizontalAdvance(self.tabText(index)) + _PADDING_PX
        return QSize(width, super().tabSizeHint(index).height())

    def minimumTabSizeHint(self, index: int) -> QSize:
        return self.tabSizeHint(index)
