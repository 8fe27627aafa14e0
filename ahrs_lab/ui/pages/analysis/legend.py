"""The legend above a chart: each curve's line and name, and under the cursor its value; broken into lines
where it is long."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from ahrs_lab.ui.pages.analysis.curve_looks import CurveLook
from ahrs_lab.ui.theme import STEP, font, tokens
from ahrs_lab.ui.widgets import rich_text

_LINE_PX = 20
_SWATCH_PX = 24
_GAP_PX = 16
_BESIDE_PX = 6


@dataclass(frozen=True)
class Entry:
    """A curve's name, as markup."""

    name: str
    look: CurveLook


class Legend(QWidget):
    """As high as its lines at the width that it has."""

    def __init__(self) -> None:
        super().__init__()
        self._entries: tuple[Entry, ...] = ()
        self._values: tuple[str, ...] = ()
        self._room = ""
        self._place = ""
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def set_entries(self, entries: Sequence[Entry], room: str) -> None:
        """Other curves; nothing is under the cursor. ``room`` is the widest value, so that nothing moves
        while the cursor does."""
        self._entries = tuple(entries)
        self._room = room
        self.set_values("", ())
        self._fit()

    def set_values(self, place: str, values: Sequence[str]) -> None:
        """Where the cursor is, and each curve's value there; empty: nowhere."""
        self._place, self._values = place, tuple(values)
        self.update()

    def texts(self) -> list[str]:
        """What can be read there: names with their values, and last the place of the cursor."""
        values = self._values or ("",) * len(self._entries)
        found = [
            rich_text.plain(f"{entry.name} {value}").strip()
            for entry, value in zip(self._entries, values, strict=True)
        ]
        return [*found, rich_text.plain(self._place)] if self._place else found

    def _spots(self) -> list[QPointF]:
        """Upper left corners of the entries, and last of the cursor's place."""
        value = rich_text.width(self._room, font()) + STEP
        widths = [
            _SWATCH_PX + _BESIDE_PX + rich_text.width(entry.name, font()) + STEP + value + _GAP_PX
            for entry in self._entries
        ]
        spots: list[QPointF] = []
        x, line = 0.0, 0
        for wide in [*widths, 3 * value]:
            if x and x + wide - _GAP_PX > self.width():
                x, line = 0.0, line + 1
            spots.append(QPointF(x, line * _LINE_PX))
            x += wide
        return spots

    def _fit(self) -> None:
        spots = self._spots()
        self.setFixedHeight(round(spots[-1].y()) + _LINE_PX)

    def sizeHint(self) -> QSize:
        return QSize(200, self.height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        *spots, last = self._spots()
        left = Qt.AlignmentFlag.AlignLeft
        for number, (entry, spot) in enumerate(zip(self._entries, spots, strict=True)):
            middle = spot.y() + _LINE_PX / 2
            _paint_swatch(painter, entry.look, QPointF(spot.x(), middle))
            x = spot.x() + _SWATCH_PX + _BESIDE_PX
            name = rich_text.width(entry.name, font())
            painter.setPen(tokens().colour("muted"))
            rich_text.draw(painter, QRectF(x, spot.y(), name, _LINE_PX), left, entry.name, font())
            if self._values:
                painter.setPen(tokens().colour("text"))
                area = QRectF(x + name + STEP, spot.y(), 200, _LINE_PX)
                rich_text.draw(painter, area, left, self._values[number], font())
        if self._place:
            painter.setPen(tokens().colour("muted"))
            rich_text.draw(painter, QRectF(last.x(), last.y(), 300, _LINE_PX), left, self._place, font())


def _paint_swatch(painter: QPainter, look: CurveLook, start: QPointF) -> None:
    colour = QColor(look.colour)
    if look.points:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(start + QPointF(_SWATCH_PX / 2, 0), 3.5, 3.5)
        return
    pen = QPen(colour, 2, look.pen)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    painter.setPen(pen)
    painter.drawLine(start, start + QPointF(_SWATCH_PX, 0))
