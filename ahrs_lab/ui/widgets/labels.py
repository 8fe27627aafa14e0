"""Labels by role and tone, a label that shortens its text, and the thin line between groups."""

from __future__ import annotations

import re
from typing import Literal

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QWidget

from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, FontRole, font
from ahrs_lab.ui.widgets.buttons import repolish

_LOWERED_MARK = re.compile(r"_\{(.*?)\}")

Tone = Literal["text", "muted", "faint", "accent", "good", "warn", "bad", "axis_x", "axis_y", "axis_z"]


class Label(QLabel):
    """Plain text in one of the font roles and tones; ``wrap`` breaks lines."""

    def __init__(
        self, text: str = "", *, role: FontRole = "text", tone: Tone = "text", wrap: bool = False
    ) -> None:
        super().__init__(text)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setFont(font(role))
        self.setProperty("tone", tone)
        self.setWordWrap(wrap)

    def set_tone(self, tone: Tone) -> None:
        """Another tone from now on."""
        if self.property("tone") != tone:
            self.setProperty("tone", tone)
            repolish(self)


class ElidedLabel(Label):
    """One line that ends in … where there is no room; the whole text is its tool tip then."""

    def __init__(
        self,
        text: str = "",
        *,
        role: FontRole = "text",
        tone: Tone = "text",
        mode: Qt.TextElideMode = Qt.TextElideMode.ElideRight,
    ) -> None:
        super().__init__(text, role=role, tone=tone)
        self._mode = mode
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def minimumSizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance("…"), super().minimumSizeHint().height())

    def paintEvent(self, _event: QPaintEvent) -> None:
        shown = self.fontMetrics().elidedText(self.text(), self._mode, self.contentsRect().width())
        self.setToolTip(self.text() if shown != self.text() else "")
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        painter.drawText(self.contentsRect(), int(self.alignment() | Qt.AlignmentFlag.AlignVCenter), shown)


class LoweredLabel(ElidedLabel):
    """An :class:`ElidedLabel` as wide as its text; what stands in ``_{…}`` is drawn small and lowered."""

    def __init__(self, *, role: FontRole = "text", tone: Tone = "text") -> None:
        super().__init__(role=role, tone=tone)
        self._parts: list[str] = []
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def set_marked(self, text: str) -> None:
        """The text with its marks; :meth:`text` has none."""
        self._parts = _LOWERED_MARK.split(text)
        self.setText("".join(self._parts))
        self.updateGeometry()
        self.update()

    def _small(self) -> QFont:
        small = QFont(self.font())
        small.setPixelSize(round(0.75 * small.pixelSize()))
        return small

    def sizeHint(self) -> QSize:
        plain, small = self.fontMetrics(), QFontMetrics(self._small())
        width = sum(
            (small if place % 2 else plain).horizontalAdvance(part) for place, part in enumerate(self._parts)
        )
        return QSize(width + 2, super().sizeHint().height())

    def paintEvent(self, _event: QPaintEvent) -> None:
        room = self.contentsRect()
        self.setToolTip(self.text() if self.sizeHint().width() > room.width() + 2 else "")
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        for place, part in enumerate(self._parts):
            lowered = place % 2 == 1
            painter.setFont(self._small() if lowered else self.font())
            metrics = painter.fontMetrics()
            shown = metrics.elidedText(part, self._mode, max(0, room.width()))
            painter.drawText(
                room.translated(0, 4 if lowered else 0),
                int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter),
                shown,
            )
            room.setLeft(room.left() + metrics.horizontalAdvance(shown))
            if shown != part:
                break


class Line(QFrame):
    """A hairline, horizontal or vertical."""

    def __init__(self, orientation: Qt.Orientation = Qt.Orientation.Horizontal) -> None:
        super().__init__()
        self.setObjectName("line")
        if orientation == Qt.Orientation.Horizontal:
            self.setFixedHeight(1)
        else:
            self.setFixedWidth(1)


class LineSwatch(QWidget):
    """A short piece of a curve's line: its colour and its dashes."""

    def __init__(self, colour: str, style: Qt.PenStyle = Qt.PenStyle.SolidLine, width: int = 24) -> None:
        super().__init__()
        self._colour = colour
        self._style = style
        self.setFixedSize(width, 8)

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        pen = QPen(QColor(self._colour), 2, self._style)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        painter.setPen(pen)
        painter.drawLine(0, 4, self.width(), 4)


class Swatch(LineSwatch):
    """A short piece of an axis' line."""

    def __init__(self, axis: Axis, width: int = 24) -> None:
        super().__init__(AXIS_COLOURS[axis], AXIS_PENS[axis], width)
