"""The run page: steps, what is to do now, live plots, readings."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.run.live_card import LiveCard
from ahrs_lab.ui.run.now_card import NowCard
from ahrs_lab.ui.run.readings_card import ReadingsCard
from ahrs_lab.ui.run.repeat_dialog import RepeatDialog
from ahrs_lab.ui.run.steps_card import StepsCard
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.workspace import Workspace

_STEPS_PX = 244
_READINGS_PX = 308
_LOOK_MS = 250


class RunPage(Page):
    """``resume`` starts the last run again where it stopped, ``repeat`` records a segment (name, reason)
    again; without them the bridge does."""

    key = "run"

    def __init__(
        self,
        workspace: Workspace,
        resume: Callable[[], None] | None = None,
        repeat: Callable[[str, str], None] | None = None,
    ) -> None:
        super().__init__(workspace)
        bridge = workspace.run
        self._bridge = bridge
        self._resume = resume or bridge.resume_recording
        self._again = repeat or bridge.repeat
        self.steps = StepsCard()
        self.steps.setFixedWidth(_STEPS_PX)
        self.now = NowCard(bridge)
        self.live = LiveCard(bridge)
        self.readings = ReadingsCard(bridge, workspace.speed)
        self.readings.setFixedWidth(_READINGS_PX)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        middle = QVBoxLayout()
        middle.setSpacing(CARD_MARGIN)
        middle.addWidget(self.now, 6)
        middle.addWidget(self.live, 5)
        row.addWidget(self.steps)
        row.addLayout(middle, 1)
        row.addWidget(self.readings)
        self.outer.addLayout(row)
        self._connect()
        self._keys()
        # Times go on between two events too.
        self._look = QTimer(self)
        self._look.setInterval(_LOOK_MS)
        self._look.timeout.connect(self._refresh_numbers)
        self.refresh()

    def _connect(self) -> None:
        self._bridge.started.connect(self._begin)
        self._bridge.changed.connect(self.refresh)
        self._bridge.ended.connect(self._end)
        self.now.confirmed.connect(self._bridge.confirm)
        self.now.pause.connect(self._bridge.toggle_pause)
        self.now.wanted.connect(self._wanted)

    def _keys(self) -> None:
        mounted = QShortcut(QKeySequence(Qt.Key.Key_Space), self)
        mounted.activated.connect(self._bridge.confirm)
        pause = QShortcut(QKeySequence(Qt.Key.Key_P), self)
        pause.activated.connect(self._bridge.toggle_pause)
        self._space = mounted

    def refresh(self) -> None:
        """Look at the run."""
        # Elsewhere the space bar presses the button that has the focus.
        self._space.setEnabled(self._bridge.model.phase in ("mount", "hand"))
        self.steps.refresh(self._bridge.model)
        self.now.refresh()
        self.readings.refresh()

    def _refresh_numbers(self) -> None:
        if self.isVisible():
            self.readings.refresh()
            if self._bridge.model.phase == "record":
                self.now.record.refresh(self._bridge.model)

    def _begin(self) -> None:
        self.live.begin()
        self._look.start()
        self.refresh()

    def _end(self) -> None:
        self._look.stop()
        self.live.end()
        self.refresh()

    def _wanted(self, what: str) -> None:
        if what in ("jobs", "results"):
            self.workspace.go_to(what)
        elif what == "resume":
            self._try(self._resume)
        elif what == "repeat":
            self._repeat()

    def _repeat(self) -> None:
        dialog = RepeatDialog(self._bridge.model.on_disk, self)
        accepted = dialog.exec()
        segment, reason = dialog.segment, dialog.reason
        dialog.deleteLater()
        if accepted:
            self._try(lambda: self._again(segment, reason))

    def _try(self, action: Callable[[], None]) -> None:
        try:
            action()
        except AhrsLabError as error:
            self.workspace.notice("bad", error.message)
