"""A thin progress bar; without a value it runs."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, QTimerEvent
from PySide6.QtGui import QHideEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from ahrs_lab.ui.theme import tokens

_FRAME_MS = 40
_STEP = 0.02


class ProgressBar(QWidget):
    """``set_value`` takes 0…1, or None for "busy, nobody knows how long"; ``tone`` names a colour."""

    def __init__(self, tone: str = "accent", height: int = 4) -> None:
        super().__init__()
        self._tone = tone
        self._value: float | None = 0.0
        self._phase = 0.0
        self._timer = 0
        self.setFixedHeight(height)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        return QSize(120, self.height())

    def set_value(self, value: float | None) -> None:
        """Clipped to 0…1."""
        self._value = None if value is None else min(1.0, max(0.0, value))
        self._run()
        self.update()

    def set_tone(self, tone: str) -> None:
        """Another colour of the theme."""
        self._tone = tone
        self.update()

    def value(self) -> float | None:
        """What it shows."""
        return self._value

    def _run(self) -> None:
        wanted = self._value is None and self.isVisible()
        if wanted and not self._timer:
            self._timer = self.startTimer(_FRAME_MS)
        elif not wanted and self._timer:
            self.killTimer(self._timer)
            self._timer = 0

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._run()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._run()

    def timerEvent(self, _event: QTimerEvent) -> None:
        self._phase = (self._phase + _STEP) % 1.0
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        whole = QRectF(self.rect())
        radius = whole.height() / 2
        painter.setBrush(tokens().colour("line"))
        painter.drawRoundedRect(whole, radius, radius)
        painter.setBrush(tokens().colour(self._tone))
        if self._value is None:
            width = whole.width() * 0.25
            left = self._phase * (whole.width() + width) - width
            part = QRectF(left, 0, width, whole.height()).intersected(whole)
        else:
            part = QRectF(0, 0, whole.width() * self._value, whole.height())
            if 0 < part.width() < whole.height():
                part.setWidth(whole.height())
        if part.width() > 0:
            painter.drawRoundedRect(part, radius, radius)
