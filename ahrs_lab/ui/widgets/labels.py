"""Labels by role and tone, a label that shortens its text, and the thin line between groups."""

from __future__ import annotations

from math import ceil
from typing import Literal

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QWidget

from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, FontRole, font
from ahrs_lab.ui.widgets import rich_text
from ahrs_lab.ui.widgets.buttons import repolish

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

    def set_sentence(self, text: str) -> None:
        """A text whose parts in ``^{…}`` and ``_{…}`` are raised and lowered."""
        marked = rich_text.is_marked(text)
        self.setTextFormat(Qt.TextFormat.RichText if marked else Qt.TextFormat.PlainText)
        self.setText(rich_text.as_html(text) if marked else text)

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


class MarkedLabel(ElidedLabel):
    """An :class:`ElidedLabel` as wide as its text; what stands in ``_{…}`` is drawn small and lowered, in
    ``^{…}`` raised."""

    def __init__(self, *, role: FontRole = "text", tone: Tone = "text") -> None:
        super().__init__(role=role, tone=tone)
        self._marked = ""
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def set_marked(self, text: str) -> None:
        """The text with its marks; :meth:`text` has none."""
        self._marked = text
        self.setText(rich_text.plain(text))
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(ceil(rich_text.width(self._marked, self.font())) + 2, super().sizeHint().height())

    def paintEvent(self, _event: QPaintEvent) -> None:
        room = self.contentsRect()
        self.setToolTip(self.text() if self.sizeHint().width() > room.width() + 2 else "")
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        for run in rich_text.parts(self._marked):
            painter.setFont(rich_text.run_font(self.font(), run.shift))
            metrics = painter.fontMetrics()
            shown = metrics.elidedText(run.text, self._mode, max(0, room.width()))
            painter.drawText(
                room.translated(0, round(rich_text.RAISE[run.shift] * self.font().pixelSize())),
                int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter),
                shown,
            )
            room.setLeft(room.left() + metrics.horizontalAdvance(shown))
            if shown != run.text:
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
