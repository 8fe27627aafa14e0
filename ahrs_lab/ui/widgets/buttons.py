"""Buttons by what pressing them means: the one next action, another one, a quiet tool, a danger."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QPushButton, QWidget

from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import STEP, tokens

ICON_SIZE = QSize(18, 18)


def repolish(widget: QWidget) -> None:
    """Make the style sheet look at the widget's properties again."""
    style = widget.style()
    style.unpolish(widget)
    style.polish(widget)
    widget.update()


class _Button(QPushButton):
    kind = ""
    icon_tone = "text"

    def __init__(self, text: str = "", *, icon: str = "") -> None:
        super().__init__()
        self.setProperty("kind", self.kind)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self._icon_name = icon
        self.setText(text)
        if icon:
            self.setIconSize(ICON_SIZE)
            self._draw_icon()

    def set_icon(self, name: str) -> None:
        """Another icon of :mod:`ahrs_lab.ui.icons`."""
        if name != self._icon_name:
            self._icon_name = name
            self.setIconSize(ICON_SIZE)
            self._draw_icon()

    def _draw_icon(self) -> None:
        colour = getattr(tokens(), self.icon_tone)
        self.setIcon(icons.icon(self._icon_name, colour, tokens().accent if self.kind == "quiet" else colour))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.StyleChange and self._icon_name:
            self._draw_icon()
        super().changeEvent(event)


class PrimaryButton(_Button):
    """The one next action of a page, in the accent colour. ``set_caption`` writes the key beside the
    words."""

    kind = "primary"
    icon_tone = "on_accent"

    def __init__(self, text: str = "", *, icon: str = "", large: bool = False) -> None:
        super().__init__(text, icon=icon)
        if large:
            self.setMinimumHeight(11 * STEP)

    def set_caption(self, text: str, key: str = "") -> None:
        """``Mounted   Space``: the words, and the key that does the same."""
        self.setText(f"{text}   {key}" if key else text)


class SecondaryButton(_Button):
    """Another action of the page."""


class DangerButton(_Button):
    """An action that cannot be undone."""

    kind = "danger"
    icon_tone = "bad"


class StopButton(_Button):
    """The one of the STOP bar."""

    kind = "stop"
    icon_tone = "on_stop"


class QuietButton(_Button):
    """A tool that stays in the background until it is used; may be checkable."""

    kind = "quiet"
    icon_tone = "muted"


class LinkButton(_Button):
    """Words that lead on, like a link."""

    kind = "link"
    icon_tone = "accent"


class IconButton(QuietButton):
    """A quiet tool without words: give it a tool tip, which is its accessible name too."""

    def __init__(self, icon: str) -> None:
        super().__init__(icon=icon)
        self.setFixedSize(8 * STEP, 8 * STEP)

    def set_hint(self, text: str, key: QKeySequence | str = "") -> None:
        """The tool tip, with the key that does the same."""
        keys = QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText) if key else ""
        self.setToolTip(f"{text} ({keys})" if keys else text)
        self.setAccessibleName(text)
