"""One line of text with raised and lowered parts (``10^{−5}``, ``φ_{E}``), measured and painted: for what
paints itself. The fonts lack most Unicode superscripts."""

from __future__ import annotations

import html
import re
from functools import lru_cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainter

from ahrs_lab.certificates.richtext import RichText, markup

_MARKS = re.compile(r"[_^]\{(.*?)\}")
_SMALL = 0.76
RAISE = {"": 0.0, "sup": -0.3, "sub": 0.16}
"""Of a run's baseline, downwards, in heights of the type."""


@lru_cache(maxsize=4096)
def parts(text: str) -> RichText:
    """The text in runs of one appearance."""
    return markup(text)


def plain(text: str) -> str:
    """Without its marks: for a tool tip, or what a reader of the screen says."""
    return _MARKS.sub(r"\1", text)


def is_marked(text: str) -> bool:
    """Something in it is raised or lowered."""
    return _MARKS.search(text) is not None


def as_html(text: str) -> str:
    """For a widget that breaks lines itself."""
    tags = {"": "{}", "sup": "<sup>{}</sup>", "sub": "<sub>{}</sub>"}
    return "".join(tags[run.shift].format(html.escape(run.text)) for run in parts(text)).replace("\n", "<br>")


def run_font(base: QFont, shift: str) -> QFont:
    """Of a run beside text in ``base``."""
    if not shift:
        return base
    small = QFont(base)
    small.setPixelSize(max(8, round(_SMALL * base.pixelSize())))
    return small


def width(text: str, base: QFont) -> float:
    """Pixels."""
    return sum(QFontMetricsF(run_font(base, run.shift)).horizontalAdvance(run.text) for run in parts(text))


def draw(painter: QPainter, area: QRectF, align: Qt.AlignmentFlag, text: str, base: QFont) -> None:
    """In the painter's pen, on one line in the middle of ``area``'s height."""
    metrics = QFontMetricsF(base)
    wide = width(text, base)
    x = area.left()
    if align & Qt.AlignmentFlag.AlignRight:
        x = area.right() - wide
    elif align & Qt.AlignmentFlag.AlignHCenter:
        x = area.center().x() - wide / 2
    baseline = area.center().y() + (metrics.ascent() - metrics.descent()) / 2
    if align & Qt.AlignmentFlag.AlignTop:
        baseline = area.top() + metrics.ascent()
    for run in parts(text):
        font = run_font(base, run.shift)
        painter.setFont(font)
        painter.drawText(QPointF(x, baseline + RAISE[run.shift] * base.pixelSize()), run.text)
        x += QFontMetricsF(font).horizontalAdvance(run.text)
