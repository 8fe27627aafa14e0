"""The table seen from above, with what a person has to do to it: an arrow in the sense of rotation, or the
mark to turn to, around the number to set."""

from __future__ import annotations

from math import cos, radians, sin

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPainterPath, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.ui.run import hand_words
from ahrs_lab.ui.theme import NUMBER_PX, TEXT_PX, font, tokens

_NUMBER_PX = round(1.6 * NUMBER_PX)
_RIM, _ARROW = 0.80, 0.94
"""Radii of the platform and of the arrow, as parts of what there is."""
_ARC_FROM_DEG, _ARC_DEG, _HEAD_DEG = 20.0, 140.0, 10.0


class TurnDrawing(QWidget):
    """:meth:`show_request` says what is drawn."""

    def __init__(self) -> None:
        super().__init__()
        self._request: HandRequest | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(200, 150)

    def sizeHint(self) -> QSize:
        return QSize(380, 260)

    def show_request(self, request: HandRequest | None) -> None:
        """What has to be done; None draws nothing."""
        if request != self._request:
            self._request = request
            self.setAccessibleName("" if request is None else " ".join(hand_words.figure(request)))
            self.update()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.update()
        super().changeEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        if self._request is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        radius = min(self.width(), self.height()) / 2.0 - 2.0
        middle = QPointF(self.width() / 2.0, self.height() / 2.0)
        self._draw_platform(painter, middle, _RIM * radius)
        turn = hand_words.turning(self._request)
        if turn:
            self._draw_arrow(painter, middle, _ARROW * radius, turn)
        if self._request.kind in ("angle", "switch_on"):
            self._draw_mark(painter, middle, radius, self._request.angle_deg)
        self._draw_number(painter, middle)
        painter.end()

    def _draw_platform(self, painter: QPainter, middle: QPointF, radius: float) -> None:
        look = tokens()
        painter.setPen(QPen(look.colour("metal_edge"), 2.0))
        painter.setBrush(look.colour("metal"))
        painter.drawEllipse(middle, radius, radius)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("card"))
        painter.drawEllipse(middle, 0.86 * radius, 0.86 * radius)
        painter.setPen(QPen(look.colour("metal_edge"), 1.5))
        for degrees in range(0, 360, 30):
            painter.drawLine(_at(middle, 0.87 * radius, degrees), _at(middle, 0.97 * radius, degrees))

    def _draw_arrow(self, painter: QPainter, middle: QPointF, radius: float, turn: int) -> None:
        """Over the top: from right to left where the table turns anticlockwise."""
        colour = tokens().colour("accent")
        box = QRectF(middle.x() - radius, middle.y() - radius, 2.0 * radius, 2.0 * radius)
        start, span = _ARC_FROM_DEG, _ARC_DEG
        if turn < 0:
            start, span = 180.0 - _ARC_FROM_DEG, -_ARC_DEG
        path = QPainterPath()
        path.arcMoveTo(box, start)
        path.arcTo(box, start, span)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(colour, 5.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPath(path)
        end = start + span
        tip = _at(middle, radius, end + turn * _HEAD_DEG - 90.0)
        self._fill(
            painter,
            colour,
            tip,
            _at(middle, radius * 1.07, end - 90.0),
            _at(middle, radius * 0.93, end - 90.0),
        )

    def _draw_mark(self, painter: QPainter, middle: QPointF, radius: float, angle_deg: float) -> None:
        """Outside the rim, pointing at the angle on the table's scale; 0 is at the top."""
        self._fill(
            painter,
            tokens().colour("accent"),
            _at(middle, (_RIM + 0.02) * radius, angle_deg),
            _at(middle, 0.99 * radius, angle_deg - 5.0),
            _at(middle, 0.99 * radius, angle_deg + 5.0),
        )

    @staticmethod
    def _fill(painter: QPainter, colour: QColor, *corners: QPointF) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPolygon(QPolygonF(corners))

    def _draw_number(self, painter: QPainter, middle: QPointF) -> None:
        assert self._request is not None
        number, unit = hand_words.figure(self._request)
        large = font("number")
        large.setPixelSize(_NUMBER_PX)
        self._write(painter, large, "text", middle, -0.62 * _NUMBER_PX, number)
        self._write(painter, font("text"), "muted", middle, 0.5 * _NUMBER_PX, unit)

    def _write(
        self, painter: QPainter, with_font: QFont, tone: str, middle: QPointF, down: float, text: str
    ) -> None:
        height = 2.0 * max(with_font.pixelSize(), TEXT_PX)
        box = QRectF(0.0, middle.y() + down - height / 2.0 + 6.0, self.width(), height)
        painter.setFont(with_font)
        painter.setPen(tokens().colour(tone))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def _at(middle: QPointF, radius: float, degrees: float) -> QPointF:
    """Anticlockwise from the top of the drawing."""
    return QPointF(middle.x() - radius * sin(radians(degrees)), middle.y() - radius * cos(radians(degrees)))
