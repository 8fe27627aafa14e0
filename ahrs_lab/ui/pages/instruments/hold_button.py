"""A button that acts only as long as it is held."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent

from ahrs_lab.ui.widgets import SecondaryButton

BEAT_MS = 100


class HoldButton(SecondaryButton):
    """``beat`` comes ten times a second while it is held, ``let_go`` when it is not any more: by the mouse,
    the space bar, or because the window, the page or the keyboard went elsewhere."""

    beat = Signal()
    let_go = Signal()

    def __init__(self, *, icon: str = "") -> None:
        super().__init__(icon=icon)
        self.setMinimumHeight(44)
        self._timer = QTimer(self)
        self._timer.setInterval(BEAT_MS)
        self._timer.timeout.connect(self._beat)
        self.pressed.connect(self._begin)
        self.released.connect(self._end)

    @property
    def held(self) -> bool:
        """Whether it is held now."""
        return self._timer.isActive()

    def _begin(self) -> None:
        self._timer.start()
        self.beat.emit()

    def _beat(self) -> None:
        if self.isDown() and self.isEnabled():
            self.beat.emit()
        else:
            self._end()

    def _end(self) -> None:
        if self._timer.isActive():
            self._timer.stop()
            self.let_go.emit()

    def hideEvent(self, event: QHideEvent) -> None:
        self._release()
        super().hideEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self._release()
        super().focusOutEvent(event)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() in (QEvent.Type.ActivationChange, QEvent.Type.EnabledChange) and (
            not self.isActiveWindow() or not self.isEnabled()
        ):
            self._release()
        super().changeEvent(event)

    def _release(self) -> None:
        if getattr(self, "_timer", None) is not None and self._timer.isActive():
            self.setDown(False)
            self._end()
