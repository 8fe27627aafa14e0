"""State as colour and word: the dot of the health strip, the icon of the step list."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QHBoxLayout, QWidget

from ahrs_lab.ui.run.step_mark import StepMark
from ahrs_lab.ui.theme import tokens
from ahrs_lab.ui.widgets.labels import Label

State = Literal["unknown", "good", "warn", "bad"]

_TOKEN: dict[str, str] = {"unknown": "faint", "good": "good", "warn": "warn", "bad": "bad"}


def paint_state(painter: QPainter, state: State, centre: QPointF, radius: float) -> None:
    """The mark of a state: each differs in form as well as in colour."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    colour = tokens().colour(_TOKEN[state])
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    if state == "warn":
        r = radius * 1.15
        painter.drawPolygon(
            QPolygonF([centre + QPointF(0, -r), centre + QPointF(r, r * 0.8), centre + QPointF(-r, r * 0.8)])
        )
    elif state == "bad":
        r = radius * 0.95
        painter.drawRect(QRectF(centre.x() - r, centre.y() - r, 2 * r, 2 * r))
    elif state == "unknown":
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(colour, 1.5))
        painter.drawEllipse(centre, radius - 0.75, radius - 0.75)
    else:
        painter.drawEllipse(centre, radius, radius)


def paint_step(painter: QPainter, mark: StepMark, centre: QPointF, radius: float = 7.0) -> None:
    """The mark of a step: ring, ring with a dot, tick, cross."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    look = tokens()
    x, y = centre.x(), centre.y()
    if mark in ("pending", "active"):
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(look.colour("accent" if mark == "active" else "faint"), 1.6))
        painter.drawEllipse(centre, radius - 0.8, radius - 0.8)
        if mark == "active":
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent"))
            painter.drawEllipse(centre, radius * 0.45, radius * 0.45)
        return
    colour = {"done": "good", "skipped": "muted", "failed": "bad"}[mark]
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour(colour))
    painter.drawEllipse(centre, radius, radius)
    pen = QPen(QColor(look.card), 1.8)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    if mark == "failed":
        painter.drawLine(QPointF(x - 2.6, y - 2.6), QPointF(x + 2.6, y + 2.6))
        painter.drawLine(QPointF(x - 2.6, y + 2.6), QPointF(x + 2.6, y - 2.6))
    else:
        painter.drawPolyline(
            QPolygonF([QPointF(x - 3.2, y + 0.2), QPointF(x - 0.8, y + 2.6), QPointF(x + 3.4, y - 2.4)])
        )


class StateIcon(QWidget):
    """The mark alone."""

    def __init__(self, state: State = "unknown", size: int = 12) -> None:
        super().__init__()
        self._state: State = state
        self.setFixedSize(size, size)

    def set_state(self, state: State) -> None:
        """Another state."""
        if state != self._state:
            self._state = state
            self.update()

    def state(self) -> State:
        """What it shows."""
        return self._state

    def paintEvent(self, _event: QPaintEvent) -> None:
        middle = QPointF(self.width() / 2, self.height() / 2)
        paint_state(QPainter(self), self._state, middle, self.width() / 3)


class StateDot(QWidget):
    """The mark and its word."""

    def __init__(self, text: str = "", state: State = "unknown") -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        self._mark = StateIcon(state)
        self._text = Label(text, tone="muted")
        row.addWidget(self._mark)
        row.addWidget(self._text)

    def set_state(self, state: State, text: str) -> None:
        """State and word change together."""
        self._mark.set_state(state)
        self._text.setText(text)
        self._text.set_tone({"good": "muted", "unknown": "muted", "warn": "warn", "bad": "bad"}[state])  # type: ignore[arg-type]

    def state(self) -> State:
        """What it shows."""
        return self._mark.state()

    def text(self) -> str:
        """The word."""
        return self._text.text()
