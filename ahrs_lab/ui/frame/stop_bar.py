"""The STOP bar: always there, never disabled, Esc from wherever the keyboard is."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QGuiApplication, QKeyEvent, QWindow
from PySide6.QtWidgets import QFrame, QHBoxLayout

from ahrs_lab.ui.theme import CARD_MARGIN, STEP
from ahrs_lab.ui.widgets import Label
from ahrs_lab.ui.widgets.buttons import StopButton
from ahrs_lab.ui.workspace import Workspace

HEIGHT = 56
_ANSWER_MS = 4000


class StopBar(QFrame):
    """Stops the run and what is moved by hand; when nothing runs it says so."""

    pressed = Signal()

    def __init__(self, workspace: Workspace) -> None:
        super().__init__()
        self._workspace = workspace
        self._answer = ""
        self.setObjectName("stopBar")
        self.setFixedHeight(HEIGHT)
        row = QHBoxLayout(self)
        row.setContentsMargins(CARD_MARGIN, 0, 5 * STEP, 0)
        row.setSpacing(4 * STEP)
        self.button = StopButton(icon="stop")
        self.button.setFixedSize(200, 40)
        self.button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.button.clicked.connect(self.stop)
        self.hint = Label(tone="muted")
        row.addWidget(self.button)
        row.addWidget(self.hint, 1)
        self._back = QTimer(self)
        self._back.setSingleShot(True)
        self._back.setInterval(_ANSWER_MS)
        self._back.timeout.connect(self._quiet)
        self._key = StopKey(self)
        workspace.run.changed.connect(self.retranslate)
        workspace.run.started.connect(self._quiet)
        self.retranslate()

    def stop(self) -> None:
        """Table, then supply; from the button or Esc."""
        self.pressed.emit()
        stopped = [self._workspace.run.stop(), *(one.stop() for one in self._workspace.stoppable)]
        if any(stopped):
            self._quiet()
        else:
            self._answer = "idle"
            self._back.start()
            self.retranslate()

    def run_is_live(self) -> bool:
        """There is something to stop."""
        return self._workspace.run.live or any(one.live for one in self._workspace.stoppable)

    def _quiet(self) -> None:
        self._answer = ""
        self._back.stop()
        self.retranslate()

    def retranslate(self) -> None:
        """Set every text."""
        self.button.setText(self.tr("STOP") + "   " + self.tr("Esc"))
        model = self._workspace.run.model
        if model.state == "aborting" and model.by_hand:
            self.hint.setText(self.tr("Bring the table to rest by hand; then the supply is switched off …"))
            self.hint.set_tone("bad")
        elif model.state == "aborting":
            self.hint.setText(self.tr("Stopping the table, then switching the supply off …"))
            self.hint.set_tone("bad")
        elif self._answer == "idle":
            self.hint.setText(self.tr("No run is going on: there is nothing to stop."))
            self.hint.set_tone("text")
        elif model.live and model.by_hand:
            self.hint.setText(
                self.tr("Ends the run, then switches the supply off. This table only you can bring to rest.")
            )
            self.hint.set_tone("warn")
        else:
            self.hint.setText(
                self.tr(
                    "Stops the table, then switches the supply off. This is not the hardware emergency stop."
                )
            )
            self.hint.set_tone("muted")

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class StopKey(QObject):
    """Esc in whichever window has the keyboard, dialogs and menus too: while a run is going on it stops,
    and does nothing else. A shortcut would not do: a modal dialog blocks it."""

    def __init__(self, bar: StopBar) -> None:
        super().__init__(bar)
        self._bar = bar
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.focusWindowChanged.connect(self._watch)
            self._watch(QGuiApplication.focusWindow())

    def _watch(self, window: QWindow | None) -> None:
        # Installing again only moves the filter to the front.
        if window is not None:
            window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if (
            event.type() == QEvent.Type.KeyPress
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_Escape
            and self._bar.run_is_live()
        ):
            self._bar.stop()
            return True
        return super().eventFilter(watched, event)
