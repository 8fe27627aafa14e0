"""A sentence the person has to see: what happened and what to do, with at most one action."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import CARD_MARGIN, FontRole, tokens
from ahrs_lab.ui.widgets.buttons import IconButton, PrimaryButton, SecondaryButton, repolish
from ahrs_lab.ui.widgets.labels import Label

BannerKind = Literal["info", "good", "warn", "bad"]

_PANEL = {"info": "accent", "good": "good", "warn": "warn", "bad": "bad"}
_TONE = {"info": "accent", "good": "good", "warn": "warn", "bad": "bad"}


class Banner(QFrame):
    """Icon, title, text, action. ``pressed`` is the action, ``closed`` the cross (only with ``closable``)."""

    pressed = Signal()
    closed = Signal()

    def __init__(self, kind: BannerKind = "info", *, closable: bool = False, large: bool = False) -> None:
        super().__init__()
        self._kind: BannerKind = kind
        row = QHBoxLayout(self)
        row.setContentsMargins(16, CARD_MARGIN, CARD_MARGIN, CARD_MARGIN)
        row.setSpacing(CARD_MARGIN)
        self._icon = QLabel()
        self._icon_size = 36 if large else 20
        row.addWidget(
            self._icon, 0, Qt.AlignmentFlag.AlignTop if not large else Qt.AlignmentFlag.AlignVCenter
        )
        words = QVBoxLayout()
        words.setSpacing(2)
        title_role: FontRole = "title" if large else "strong"
        self._title = Label(role=title_role, wrap=True)
        self._text = Label(wrap=True)
        words.addWidget(self._title)
        words.addWidget(self._text)
        row.addLayout(words, 1)
        self._action: PrimaryButton | SecondaryButton = PrimaryButton() if large else SecondaryButton()
        self._action.clicked.connect(self.pressed)
        self._action.setVisible(False)
        row.addWidget(self._action, 0, Qt.AlignmentFlag.AlignVCenter)
        self.close_button = IconButton("close")
        self.close_button.clicked.connect(self._closed)
        self.close_button.setVisible(closable)
        row.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        self.set_content(kind, "")

    def set_content(self, kind: BannerKind, title: str, text: str = "", action: str = "") -> None:
        """All of it at once; an empty part is not there."""
        self._kind = kind
        self.setProperty("panel", _PANEL[kind])
        repolish(self)
        self._title.setText(title)
        self._title.setVisible(bool(title))
        self._title.set_tone(_TONE[kind])  # type: ignore[arg-type]
        self._text.setText(text)
        self._text.setVisible(bool(text))
        self._action.setText(action)
        self._action.setVisible(bool(action))
        self._draw_icon()

    def title(self) -> str:
        """The title as it stands there."""
        return self._title.text()

    def text(self) -> str:
        """The text as it stands there."""
        return self._text.text()

    def _draw_icon(self) -> None:
        colour = getattr(tokens(), _TONE[self._kind])
        self._icon.setPixmap(icons.pixmap(self._kind, colour, self._icon_size, self.devicePixelRatioF()))

    def _closed(self) -> None:
        self.setVisible(False)
        self.closed.emit()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._draw_icon()
        super().changeEvent(event)
