"""Draws a statement of conformity: the bar of limits with its guard band hatched, icon and word."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QFontMetricsF, QPainter, QPen

from ahrs_lab.metrology.conformity import Statement, Verdict
from ahrs_lab.ui import icons
from ahrs_lab.ui.pages.results.limit_bar import LimitBar, limit_bar
from ahrs_lab.ui.theme import font, tokens

VERDICT_TONES: dict[Verdict, str] = {
    "pass": "good",
    "conditional pass": "warn",
    "conditional fail": "bad",
    "fail": "bad",
}
VERDICT_ICONS: dict[Verdict, str] = {
    "pass": "good",
    "conditional pass": "warn",
    "conditional fail": "warn",
    "fail": "bad",
}
ICON_PX = 14
BAR_PX = 84.0
SMALLEST_BAR_PX = 44.0
_GAP = 5.0
_TRACK = 5.0
_DOT = 3.5


def word_width(word: str) -> float:
    """Of icon and word, pixels."""
    return ICON_PX + _GAP + QFontMetricsF(font("text")).horizontalAdvance(word)


def draw_judgement(
    painter: QPainter, place: QRectF, said: Statement, word: str, *, below: bool, widest: float
) -> None:
    """In ``place``: the bar, and ``below`` or beside it icon and word; what has no room is left out, the
    word first. ``widest``: of all words in the card, so that bars of its lines are the same."""
    if below and place.width() >= max(SMALLEST_BAR_PX, widest):
        half = place.height() / 2
        draw_bar(painter, QRectF(place.left(), place.top() + half - 15, place.width(), 14), said)
        _draw_word(painter, QRectF(place.left(), place.top() + half - 1, place.width(), 18), said, word)
        return
    beside = place.width() - widest - 2 * _GAP
    with_word = beside >= SMALLEST_BAR_PX
    bar = beside if with_word else place.width() - ICON_PX - 2 * _GAP
    if bar >= SMALLEST_BAR_PX:
        draw_bar(painter, QRectF(place.left(), place.center().y() - 7, bar, 14), said)
    left = place.left() + bar + 2 * _GAP
    _draw_word(
        painter,
        QRectF(left, place.top(), place.right() - left, place.height()),
        said,
        word if with_word else "",
    )


def _draw_word(painter: QPainter, place: QRectF, said: Statement, word: str) -> None:
    look, tone = tokens(), VERDICT_TONES[said.verdict]
    ratio = painter.device().devicePixelRatio()
    picture = icons.pixmap(VERDICT_ICONS[said.verdict], getattr(look, tone), ICON_PX, ratio)
    painter.drawPixmap(QPointF(place.left(), place.center().y() - ICON_PX / 2), picture)
    painter.setFont(font("text"))
    painter.setPen(look.colour(tone))
    text = place.adjusted(ICON_PX + _GAP, 0, 4, 0)
    painter.drawText(text, int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter), word)


def draw_bar(painter: QPainter, place: QRectF, said: Statement) -> None:
    """Track from limit to limit, guard bands hatched, ± U as a line, the value as a dot."""
    bar, look, y = limit_bar(said), tokens(), place.center().y()

    def x(part: float) -> float:
        return place.left() + part * place.width()

    start, end = x(bar.low if bar.low is not None else 0.0), x(bar.high if bar.high is not None else 1.0)
    track = QRectF(start, y - _TRACK / 2, end - start, _TRACK)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("line"))
    painter.drawRect(track)
    _draw_guard(painter, bar, track, x)
    painter.setPen(QPen(look.colour("muted"), 1.4))
    for limit in (bar.low, bar.high):
        if limit is not None:
            painter.drawLine(QPointF(x(limit), y - 6), QPointF(x(limit), y + 6))
    colour = look.colour(VERDICT_TONES[said.verdict])
    painter.setPen(QPen(colour, 1.6))
    painter.drawLine(QPointF(x(bar.value_low), y), QPointF(x(bar.value_high), y))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawEllipse(QPointF(x(bar.value), y), _DOT, _DOT)


def _draw_guard(painter: QPainter, bar: LimitBar, track: QRectF, x: Callable[[float], float]) -> None:
    painter.setBrush(QBrush(tokens().colour("warn"), Qt.BrushStyle.BDiagPattern))
    if bar.low is not None and bar.accept_low is not None and bar.accept_low > bar.low:
        painter.drawRect(QRectF(track.left(), track.top(), x(bar.accept_low) - track.left(), track.height()))
    if bar.high is not None and bar.accept_high is not None and bar.accept_high < bar.high:
        painter.drawRect(
            QRectF(x(bar.accept_high), track.top(), track.right() - x(bar.accept_high), track.height())
        )
