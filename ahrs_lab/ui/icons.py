"""Icons by what they mean. They are drawn from qtawesome's Phosphor font in the colours of the theme that is
on.

The font is read from where qtawesome is installed, without importing it: its imports of all of Qt would take
a third of the time until the first window.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontDatabase, QIcon, QIconEngine, QPainter, QPixmap

from ahrs_lab.errors import MachineError

_PHOSPHOR = "1.3.0"
_GLYPH_SHARE = 0.875
"""Of the icon's height: the rest is the font's bearing."""

_GLYPHS = {
    "start": "house",
    "jobs": "list-bullets",
    "run": "play-circle",
    "results": "chart-bar",
    "certificate": "file-text",
    "analyse": "chart-line",
    "bench": "disc",
    "setup": "gear-six",
    "instruments": "gauge",
    "theme": "circle-half",
    "light": "sun",
    "dark": "moon",
    "system": "desktop",
    "language": "translate",
    "person": "user-circle",
    "stop": "stop-fill",
    "pause": "pause-fill",
    "resume": "play-fill",
    "repeat": "arrow-counter-clockwise",
    "hold": "snowflake",
    "help": "question",
    "info": "info",
    "good": "check-circle-fill",
    "warn": "warning-fill",
    "bad": "x-circle-fill",
    "close": "x",
    "add": "plus",
    "edit": "pencil-simple",
    "remove": "trash",
    "search": "magnifying-glass",
    "folder": "folder-open",
    "file": "file",
    "export": "export",
    "import": "download-simple",
    "sign": "pen-nib",
    "verify": "shield-check",
    "lock": "lock-simple",
    "device": "cube",
    "customer": "buildings",
    "standard": "ruler",
    "plan": "clipboard-text",
    "record": "record-fill",
    "clock": "clock",
    "thermometer": "thermometer",
    "supply": "lightning",
    "next": "arrow-right",
    "back": "arrow-left",
    "more": "dots-three",
    "print": "printer",
    "copy": "copy",
    "zoom_in": "magnifying-glass-plus",
    "zoom_out": "magnifying-glass-minus",
}


class _GlyphEngine(QIconEngine):
    """Draws one glyph at any size, in the colour of its state."""

    def __init__(self, glyph: str, colour: str, active: str) -> None:
        super().__init__()
        self._glyph, self._colour, self._active = glyph, colour, active

    def clone(self) -> QIconEngine:
        return _GlyphEngine(self._glyph, self._colour, self._active)

    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:
        on = mode == QIcon.Mode.Active or (state == QIcon.State.On and mode != QIcon.Mode.Disabled)
        font = QFont(_family())
        font.setPixelSize(max(1, round(_GLYPH_SHARE * rect.height())))
        painter.save()
        painter.setFont(font)
        painter.setPen(QColor(self._active if on else self._colour))
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, self._glyph)
        painter.restore()

    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        picture = QPixmap(size)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        self.paint(painter, picture.rect(), mode, state)
        painter.end()
        return picture


def _font_folder() -> Path:
    spec = find_spec("qtawesome")
    if spec is None or spec.origin is None:
        raise MachineError(
            "The icons are not installed: qtawesome is missing. Install the application again."
        )
    return Path(spec.origin).parent / "fonts"


@cache
def _family() -> str:
    number = QFontDatabase.addApplicationFont(str(_font_folder() / f"phosphor-{_PHOSPHOR}.ttf"))
    return QFontDatabase.applicationFontFamilies(number)[0]


@cache
def _characters() -> dict[str, str]:
    text = (_font_folder() / f"phosphor-charmap-{_PHOSPHOR}.json").read_text(encoding="utf-8")
    return {name: chr(int(code, 16)) for name, code in json.loads(text).items()}


def icon(name: str, colour: str, active: str | None = None) -> QIcon:
    """The icon called ``name`` in ``colour`` (#RRGGBB); ``active`` is its colour while it is checked."""
    return QIcon(_GlyphEngine(_characters()[_GLYPHS[name]], colour, active or colour))


@cache
def _pixmap(name: str, colour: str, size: int, ratio: float) -> QPixmap:
    return icon(name, colour).pixmap(QSize(size, size), ratio, QIcon.Mode.Normal, QIcon.State.Off)


def pixmap(name: str, colour: str, size: int, ratio: float = 1.0) -> QPixmap:
    """The icon as a picture of ``size`` logical pixels."""
    return _pixmap(name, colour, size, ratio)


def names() -> tuple[str, ...]:
    """All that :func:`icon` knows."""
    return tuple(_GLYPHS)
