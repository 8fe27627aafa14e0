"""The rail at the left: one button a page, icon over word."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QEnterEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QFrame, QVBoxLayout, QWidget

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import CARD_MARGIN, STEP, font, tokens

WIDTH = 88
_ICON = 24
_RADIUS = 8


class RailButton(QAbstractButton):
    """Icon over word; checked while its page is in front. ``mark`` puts a dot on it: something goes on
    there."""

    def __init__(self, icon: str) -> None:
        super().__init__()
        self._icon_name = icon
        self._marked = False
        self.setCheckable(True)
        self.setFixedSize(WIDTH - 2 * STEP - 1, 58)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setFont(font())

    def set_marked(self, marked: bool) -> None:
        """Dot on or off."""
        self._marked = marked
        self.update()

    @property
    def marked(self) -> bool:
        """The dot is on."""
        return self._marked

    def sizeHint(self) -> QSize:
        return self.size()

    def enterEvent(self, event: QEnterEvent) -> None:
        super().enterEvent(event)
        self.update()

    def leaveEvent(self, event: QEvent) -> None:
        super().leaveEvent(event)
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        look = tokens()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        on = self.isChecked()
        if on or self.underMouse() or self.hasFocus():
            painter.setPen(QPen(look.colour("accent"), 1) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent_soft" if on else "hover"))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), _RADIUS, _RADIUS)
        colour = look.accent if on else look.muted
        picture = icons.pixmap(self._icon_name, colour, _ICON, self.devicePixelRatioF())
        left = (self.width() - _ICON) / 2
        painter.drawPixmap(QPointF(left, 8), picture)
        painter.setPen(QColor(colour))
        chosen = font("strong" if on else "text")
        painter.setFont(chosen)
        painter.drawText(QRectF(0, 34, self.width(), 20), Qt.AlignmentFlag.AlignCenter, self.text())
        if self._marked:
            painter.setPen(QPen(look.colour("rail"), 2))
            painter.setBrush(look.colour("good"))
            painter.drawEllipse(QPointF(left + _ICON, 11), 5, 5)


class Emblem(QWidget):
    """The application's mark: a level horizon in a ring."""

    def __init__(self, size: int = 32) -> None:
        super().__init__()
        self.setFixedSize(size, size)

    def paintEvent(self, _event: QPaintEvent) -> None:
        paint_emblem(QPainter(self), QRectF(self.rect()))


def paint_emblem(painter: QPainter, area: QRectF) -> None:
    """Draw the mark; also the window's icon."""
    look = tokens()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("accent"))
    painter.drawRoundedRect(area, area.width() * 0.22, area.width() * 0.22)
    pen = QPen(look.colour("on_accent"), area.width() * 0.07)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    centre, r = area.center(), area.width() * 0.27
    painter.drawEllipse(centre, r, r)
    painter.drawLine(centre + QPointF(-r * 1.0, r * 0.28), centre + QPointF(r * 1.0, -r * 0.28))


class NavigationRail(QFrame):
    """``chosen`` tells the key of the page that is wanted."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("rail")
        self.setFixedWidth(WIDTH)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(STEP, CARD_MARGIN, STEP + 1, CARD_MARGIN)
        self._column.setSpacing(STEP)
        self._column.addWidget(Emblem(), 0, Qt.AlignmentFlag.AlignHCenter)
        self._column.addSpacing(CARD_MARGIN)
        self._column.addStretch(1)
        self._group = QButtonGroup(self)
        self.buttons: dict[str, RailButton] = {}

    def add(self, key: str) -> None:
        """One more page below the others; its icon has the page's name."""
        button = RailButton(key)
        button.clicked.connect(lambda: self.chosen.emit(key))
        self._group.addButton(button)
        self.buttons[key] = button
        self._column.insertWidget(self._column.count() - 1, button, 0, Qt.AlignmentFlag.AlignHCenter)

    def set_current(self, key: str) -> None:
        """The page that is in front."""
        self.buttons[key].setChecked(True)
