"""What an empty page shows: what will be here, and the one next action."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, tokens
from ahrs_lab.ui.widgets.buttons import PrimaryButton
from ahrs_lab.ui.widgets.labels import Label

_ICON = 48
_WIDTH, _NARROWEST = 420, 200


class EmptyState(QWidget):
    """``pressed`` is the action's signal."""

    pressed = Signal()

    def __init__(self, icon: str) -> None:
        super().__init__()
        self._icon_name = icon
        column = QVBoxLayout(self)
        column.setSpacing(GAP)
        column.addStretch(1)
        self._icon = QLabel()
        self._title = Label(role="title")
        self._text = Label(tone="muted", wrap=True)
        self._text.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self.setMinimumWidth(_NARROWEST)
        self._action = PrimaryButton(large=True)
        self._action.clicked.connect(self.pressed)
        for widget in (self._icon, self._title, self._text):
            column.addWidget(widget, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addSpacing(CARD_MARGIN)
        column.addWidget(self._action, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(2)
        self._draw_icon()

    def set_content(self, title: str, text: str, action: str = "") -> None:
        """All of it at once; without an action there is no button."""
        self._title.setText(title)
        self._text.setText(text)
        self._action.setText(action)
        self._action.setVisible(bool(action))
        self._fit_text()

    def _fit_text(self) -> None:
        """As wide as is good to read, or as there is room; a layout that centres a label does not ask it how
        high its lines make it."""
        margins = self.contentsMargins()
        width = min(_WIDTH, max(_NARROWEST, self.width()) - 2 * GAP - margins.left() - margins.right())
        self._text.setMinimumSize(0, 0)  # else the height of before is the least that it asks for
        self._text.setFixedSize(width, self._text.heightForWidth(width))

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._fit_text()
        super().resizeEvent(event)

    def _draw_icon(self) -> None:
        self._icon.setPixmap(icons.pixmap(self._icon_name, tokens().faint, _ICON, self.devicePixelRatioF()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._draw_icon()
        super().changeEvent(event)
