"""A check box whose mark can be seen in both themes."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QCheckBox

from ahrs_lab.ui.theme import GAP, tokens

_BOX = 16.0


class TickBox(QCheckBox):
    """Text behind a rounded box; the accent fills it when it is on."""

    def sizeHint(self) -> QSize:
        metrics = self.fontMetrics()
        width = _BOX + (GAP + metrics.horizontalAdvance(self.text()) if self.text() else 0) + 2
        return QSize(round(width), max(round(_BOX) + 4, metrics.height() + 2))

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def hitButton(self, pos: object) -> bool:
        del pos
        return True

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look = tokens()
        middle = self.height() / 2
        box = QRectF(1, middle - _BOX / 2, _BOX, _BOX).adjusted(0.5, 0.5, -0.5, -0.5)
        on, usable = self.isChecked(), self.isEnabled()
        edge = "accent" if (on or self.hasFocus() or self.underMouse()) and usable else "faint"
        painter.setPen(QPen(look.colour(edge if usable else "line"), 2.0 if self.hasFocus() else 1.2))
        painter.setBrush(look.colour(("accent" if usable else "line") if on else "card"))
        painter.drawRoundedRect(box, 4, 4)
        if on:
            pen = QPen(look.colour("on_accent" if usable else "faint"), 1.9)
            pen.setCapStyle(Qt.PenCapStyle.RoundCap)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
            painter.setPen(pen)
            x, y = box.center().x(), box.center().y()
            painter.drawPolyline(
                QPolygonF([QPointF(x - 3.6, y + 0.2), QPointF(x - 1.0, y + 2.9), QPointF(x + 3.9, y - 2.9)])
            )
        painter.setPen(look.colour("text" if usable else "muted"))
        text = QRectF(_BOX + GAP, 0, max(0.0, self.width() - _BOX - GAP), self.height())
        painter.drawText(text, int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft), self.text())
