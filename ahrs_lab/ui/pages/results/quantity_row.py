"""One calibrated number as a line that can be chosen: axis colour, symbol, value, ± U."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy

from ahrs_lab.metrology.conformity import Statement
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.pages.results.limit_drawing import BAR_PX, ICON_PX, draw_judgement
from ahrs_lab.ui.theme import AXIS_COLOURS, FontRole, font, tokens

_LOWERED = 0.72
"""Size of an index against its symbol."""
_BLOCK_GAP = 12.0
"""Before the bar of limits."""


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
        self._lead = 0.0
        self._large = large
        self._statement: Statement | None = None
        self._word = ""
        self._widest_word = 0.0
        self.setCheckable(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def set_texts(self, texts: RowTexts) -> None:
        """Also what a screen reader says."""
        self._texts = texts
        self._name()
        self.updateGeometry()
        self.update()

    def set_judgement(self, statement: Statement | None, word: str) -> None:
        """The verdict on this quantity and its word; None: it has no limit."""
        self._statement = statement
        self._word = word
        self.setToolTip(word)
        self._name()
        self.updateGeometry()
        self.update()

    def verdict_word(self) -> str:
        """Empty where there is no limit."""
        return self._word if self._statement is not None else ""

    def _name(self) -> None:
        texts = self._texts
        name = f"{texts.symbol}{texts.index} {texts.value} ± {texts.expanded}"
        self.setAccessibleName(f"{name}, {self._word}" if self._statement is not None else name)

    def texts(self) -> RowTexts:
        """As they stand there."""
        return self._texts

    def tail_width(self) -> float:
        """Of ``± U`` in pixels; a card makes its lines' tails equal, so that the values stand in a column."""
        return QFontMetricsF(font("text")).horizontalAdvance(f"± {self._texts.expanded}")

    def lead_width(self) -> float:
        """Of everything before ``± U`` in pixels."""
        return 24 + self._head_width() + 16 + self._value_width()

    def set_widths(self, tail: float, lead: float, word: float) -> None:
        """The widest of the card's lines: ``± U``, what is before it, icon and word of the verdict."""
        self._tail, self._lead, self._widest_word = tail, lead, word
        self.updateGeometry()
        self.update()

    def _block_width(self) -> float:
        """Of bar and verdict: what is wanted, or what is left; at least the icon."""
        if self._widest_word == 0.0:
            return 0.0
        wanted = max(BAR_PX, self._widest_word) if self._large else BAR_PX + 10 + self._widest_word
        tail = max(self._tail, self.tail_width())
        left = self.width() - max(self._lead, self.lead_width()) - 8 - tail - _BLOCK_GAP - 10
        return max(min(wanted, left), float(ICON_PX))

    def sizeHint(self) -> QSize:
        value = QFontMetricsF(font(self._value_role))
        text = QFontMetricsF(font("text"))
        width = self.lead_width() + 8 + max(self._tail, self.tail_width()) + 16
        if self._widest_word:
            width += ICON_PX + _BLOCK_GAP
        height = max(value.height(), text.height()) + (8 if self._value_role == "title" else 2)
        return QSize(round(width), round(height))

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def _value_width(self) -> float:
        return QFontMetricsF(font(self._value_role)).horizontalAdvance(self._texts.value)

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
        block = self._block_width()
        if block:
            place = QRectF(right - block, whole.top(), block, whole.height())
            if self._statement is not None:
                draw_judgement(
                    painter, place, self._statement, self._word, below=self._large, widest=self._widest_word
                )
            right -= block + _BLOCK_GAP
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
