"""One calibrated number as a line that can be chosen: axis colour, symbol, value, ± U."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy

from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.theme import AXIS_COLOURS, FontRole, font, tokens

_LOWERED = 0.72
"""Size of an index against its symbol."""


@dataclass(frozen=True)
class RowTexts:
    """What stands in the line; ``index`` is drawn lowered behind ``symbol``."""

    symbol: str
    index: str
    name: str
    value: str
    expanded: str


class QuantityRow(QAbstractButton):
    """Checkable and reachable by Tab; arrows move within a button group."""

    def __init__(self, axis: Axis, *, large: bool) -> None:
        super().__init__()
        self._axis = axis
        self._value_role: FontRole = "title" if large else "strong"
        self._texts = RowTexts("", "", "", "", "")
        self._tail = 0.0
        self.setCheckable(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def set_texts(self, texts: RowTexts) -> None:
        """Also what a screen reader says."""
        self._texts = texts
        self.setAccessibleName(f"{texts.symbol}{texts.index} {texts.value} ± {texts.expanded}")
        self.updateGeometry()
        self.update()

    def texts(self) -> RowTexts:
        """As they stand there."""
        return self._texts

    def tail_width(self) -> float:
        """Of ``± U`` in pixels; a card makes its lines' tails equal, so that the values stand in a column."""
        return QFontMetricsF(font("text")).horizontalAdvance(f"± {self._texts.expanded}")

    def set_tail_width(self, width: float) -> None:
        """See :meth:`tail_width`."""
        self._tail = width
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        value = QFontMetricsF(font(self._value_role))
        text = QFontMetricsF(font("text"))
        width = (
            28 + self._head_width() + 16 + value.horizontalAdvance(self._texts.value) + 8
            + max(self._tail, self.tail_width()) + 12
        )  # fmt: skip
        height = max(value.height(), text.height()) + (8 if self._value_role == "title" else 2)
        return QSize(round(width), round(height))

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def _head_width(self) -> float:
        text = QFontMetricsF(font("text"))
        name = text.horizontalAdvance(self._texts.name) + 8 if self._texts.name else 0.0
        return (
            name
            + text.horizontalAdvance(self._texts.symbol)
            + QFontMetricsF(_lowered(font("text"))).horizontalAdvance(self._texts.index)
        )

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look = tokens()
        whole = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        if self.isChecked() or self.underMouse():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent_soft" if self.isChecked() else "hover"))
            painter.drawRoundedRect(whole, 5, 5)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(look.colour("accent"), 1))
            painter.drawRoundedRect(whole, 5, 5)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(AXIS_COLOURS[self._axis]))
        painter.drawRoundedRect(QRectF(10, whole.center().y() - 6, 4, 12), 2, 2)
        self._paint_texts(painter, whole)

    def _paint_texts(self, painter: QPainter, whole: QRectF) -> None:
        look, texts = tokens(), self._texts
        left = 24.0
        middle = Qt.AlignmentFlag.AlignVCenter
        for text, tone, lowered in (
            (texts.symbol, "text", False),
            (texts.index, "text", True),
            (texts.name, "muted", False),
        ):
            chosen = _lowered(font("text")) if lowered else font("text")
            painter.setFont(chosen)
            painter.setPen(look.colour(tone))
            width = QFontMetricsF(chosen).horizontalAdvance(text)
            gap = 8.0 if tone == "muted" else 0.0
            place = QRectF(left + gap, whole.top() + (4 if lowered else 0), width + 2, whole.height())
            painter.drawText(place, int(middle | Qt.AlignmentFlag.AlignLeft), text)
            left += width + gap
        right = whole.right() - 10
        tail = max(self._tail, self.tail_width())
        painter.setFont(font("text"))
        painter.setPen(look.colour("muted"))
        place = QRectF(right - tail, whole.top(), tail, whole.height())
        painter.drawText(place, int(middle | Qt.AlignmentFlag.AlignLeft), f"± {texts.expanded}")
        painter.setFont(font(self._value_role))
        painter.setPen(look.colour("text"))
        place = QRectF(left, whole.top(), right - tail - 8 - left, whole.height())
        painter.drawText(place, int(middle | Qt.AlignmentFlag.AlignRight), texts.value)


def _lowered(of: QFont) -> QFont:
    small = QFont(of)
    small.setPixelSize(round(of.pixelSize() * _LOWERED + 0.5))
    return small
