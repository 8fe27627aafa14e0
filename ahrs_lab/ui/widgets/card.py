"""The card: a titled surface that holds one thing; and the panel: a tinted box inside a card."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLayout, QVBoxLayout, QWidget

from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets.buttons import repolish
from ahrs_lab.ui.widgets.labels import ElidedLabel

PanelKind = Literal["plain", "accent", "good", "warn", "bad"]


class Card(QFrame):
    """Title on the left, tools on the right of its head, anything in its body.

    ``add`` puts widgets or layouts into the body; ``add_tool`` into the head. Without a title and tools the
    head is not there.
    """

    def __init__(self, title: str = "") -> None:
        super().__init__()
        self.setObjectName("card")
        outer = QVBoxLayout(self)
        outer.setContentsMargins(16, CARD_MARGIN, 16, CARD_MARGIN)
        outer.setSpacing(GAP)
        self._head = QWidget()
        head = QHBoxLayout(self._head)
        head.setContentsMargins(0, 0, 0, 0)
        head.setSpacing(GAP)
        self._title = ElidedLabel(role="strong")
        head.addWidget(self._title, 1)
        self._tools = head
        outer.addWidget(self._head)
        self.body = QVBoxLayout()
        self.body.setContentsMargins(0, 0, 0, 0)
        self.body.setSpacing(GAP)
        outer.addLayout(self.body, 1)
        self._head.setVisible(False)
        self.set_title(title)

    def set_title(self, title: str) -> None:
        """What the card shows, not "Information"."""
        self._title.setText(title)
        if title:
            self._head.setVisible(True)

    def add_tool(self, widget: QWidget) -> None:
        """A switch, button or short text in the head, at the right."""
        self._tools.addWidget(widget, 0, Qt.AlignmentFlag.AlignVCenter)
        self._head.setVisible(True)

    def add(self, content: QWidget | QLayout, stretch: int = 0) -> None:
        """Below what is in the body already."""
        if isinstance(content, QWidget):
            self.body.addWidget(content, stretch)
        else:
            self.body.addLayout(content, stretch)


class Panel(QFrame):
    """A tinted box without a frame; ``kind`` is its tint."""

    def __init__(self, kind: PanelKind = "plain") -> None:
        super().__init__()
        self.setProperty("panel", kind)
        self.body = QVBoxLayout(self)
        self.body.setContentsMargins(16, CARD_MARGIN, 16, CARD_MARGIN)
        self.body.setSpacing(4)

    def set_kind(self, kind: PanelKind) -> None:
        """Another tint."""
        if self.property("panel") != kind:
            self.setProperty("panel", kind)
            repolish(self)
