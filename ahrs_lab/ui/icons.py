"""Icons by what they mean. They are drawn from qtawesome's Phosphor font in the colours of the theme that
is on."""

from __future__ import annotations

from functools import cache

from PySide6.QtCore import QSize
from PySide6.QtGui import QIcon, QPixmap

_GLYPHS = {
    "start": "ph.house",
    "jobs": "ph.list-bullets",
    "run": "ph.play-circle",
    "results": "ph.chart-bar",
    "certificate": "ph.file-text",
    "analyse": "ph.chart-line",
    "bench": "ph.disc",
    "setup": "ph.gear-six",
    "instruments": "ph.gauge",
    "theme": "ph.circle-half",
    "light": "ph.sun",
    "dark": "ph.moon",
    "system": "ph.desktop",
    "language": "ph.translate",
    "person": "ph.user-circle",
    "stop": "ph.stop-fill",
    "pause": "ph.pause-fill",
    "resume": "ph.play-fill",
    "repeat": "ph.arrow-counter-clockwise",
    "hold": "ph.snowflake",
    "help": "ph.question",
    "info": "ph.info",
    "good": "ph.check-circle-fill",
    "warn": "ph.warning-fill",
    "bad": "ph.x-circle-fill",
    "close": "ph.x",
    "add": "ph.plus",
    "edit": "ph.pencil-simple",
    "remove": "ph.trash",
    "search": "ph.magnifying-glass",
    "folder": "ph.folder-open",
    "file": "ph.file",
    "export": "ph.export",
    "import": "ph.download-simple",
    "sign": "ph.pen-nib",
    "verify": "ph.shield-check",
    "lock": "ph.lock-simple",
    "device": "ph.cube",
    "customer": "ph.buildings",
    "standard": "ph.ruler",
    "plan": "ph.clipboard-text",
    "record": "ph.record-fill",
    "clock": "ph.clock",
    "thermometer": "ph.thermometer",
    "supply": "ph.lightning",
    "next": "ph.arrow-right",
    "back": "ph.arrow-left",
    "more": "ph.dots-three",
    "print": "ph.printer",
    "zoom_in": "ph.magnifying-glass-plus",
    "zoom_out": "ph.magnifying-glass-minus",
}


def icon(name: str, colour: str, active: str | None = None) -> QIcon:
    """The icon called ``name`` in ``colour`` (#RRGGBB); ``active`` is its colour while it is checked."""
    import qtawesome

    options: dict[str, str] = {"color": colour, "color_disabled": colour}
    if active is not None:
        options.update(color_on=active, color_active=active)
    result: QIcon = qtawesome.icon(_GLYPHS[name], **options)
    return result


@cache
def _pixmap(name: str, colour: str, size: int, ratio: float) -> QPixmap:
    return icon(name, colour).pixmap(QSize(size, size), ratio, QIcon.Mode.Normal, QIcon.State.Off)


def pixmap(name: str, colour: str, size: int, ratio: float = 1.0) -> QPixmap:
    """The icon as a picture of ``size`` logical pixels."""
    return _pixmap(name, colour, size, ratio)


def names() -> tuple[str, ...]:
    """All that :func:`icon` knows."""
    return tuple(_GLYPHS)
