"""The card in the middle: what the operator is asked, or what goes on, or how it ended."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Signal
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.ui.case_drawing import CaseDrawing
from ahrs_lab.ui.run import hand_words, words
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.run.end_view import EndView
from ahrs_lab.ui.run.hand_view import HandView
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.run.now_views import MountView, RecordView, WorkView
from ahrs_lab.ui.run.turn_drawing import TurnDrawing
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, ElidedLabel, EmptyState, Label, Panel, PrimaryButton, QuietButton

_SIDE_PX = 252


class NowCard(Card):
    """``confirmed`` is the operator's "mounted" or "set"; ``pause`` the pause key; ``wanted`` names what an
    end offers."""

    confirmed = Signal()
    pause = Signal()
    wanted = Signal(str)

    def __init__(self, bridge: RunBridge) -> None:
        super().__init__()
        self._bridge = bridge
        self.drawing = CaseDrawing()
        self.mount = MountView()
        self.mount.confirmed.connect(self.confirmed)
        self.table = TurnDrawing()
        self.picture = QStackedWidget()
        self.picture.addWidget(self.drawing)
        self.picture.addWidget(self.table)
        self.hand = HandView()
        self.hand.confirmed.connect(self.confirmed)
        self.work = WorkView()
        self.record = RecordView(bridge)
        self.paused = _PausedView()
        self.paused.button.clicked.connect(self.pause)
        self.side = QStackedWidget()
        self.side.setFixedWidth(_SIDE_PX)
        for view in (self.mount, self.hand, self.work, self.record, self.paused):
            self.side.addWidget(view)
        self._title = ElidedLabel(role="title")
        self._subtitle = Label(tone="muted", wrap=True)
        self.pause_button = QuietButton(icon="pause")
        self.pause_button.clicked.connect(self.pause)
        self.empty = EmptyState("run")
        self.empty.pressed.connect(lambda: self.wanted.emit("jobs"))
        self.end = EndView()
        self.end.wanted.connect(self.wanted)
        self.whole = QStackedWidget()
        for page in (self.empty, self._running_page(), self.end):
            self.whole.addWidget(page)
        self.add(self.whole, 1)
        self.retranslate()

    def _running_page(self) -> QWidget:
        page = QWidget()
        column = QVBoxLayout(page)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        head = QHBoxLayout()
        head.setSpacing(GAP)
        head.addWidget(self._title, 1)
        head.addWidget(self.pause_button)
        column.addLayout(head)
        column.addWidget(self._subtitle)
        column.addSpacing(GAP)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        row.addWidget(self.picture, 1)
        row.addWidget(self.side)
        column.addLayout(row, 1)
        return page

    def refresh(self) -> None:
        """Look at the run."""
        model = self._bridge.model
        phase = model.phase
        if phase == "none":
            self.whole.setCurrentIndex(0)
            return
        if phase in ("done", "aborted", "failed"):
            self.end.refresh(model)
            self.whole.setCurrentIndex(2)
            return
        self.whole.setCurrentIndex(1)
        self._draw_case(model)
        title, subtitle = self._texts(model)
        self._title.setText(title)
        self._subtitle.setText(subtitle)
        view = {
            "mount": self.mount,
            "hand": self.hand,
            "record": self.record,
            "paused": self.paused,
        }.get(phase, self.work)
        if view is not self.paused:
            view.refresh(model)  # type: ignore[attr-defined]
        self.table.show_request(model.hand)
        self.picture.setCurrentWidget(self.table if phase == "hand" else self.drawing)
        self.side.setCurrentWidget(view)
        self._refresh_pause(model)

    def _draw_case(self, model: RunModel) -> None:
        if model.request is not None:
            self.drawing.show_turn(model.request.orientation, model.request.previous)
        else:
            self.drawing.show_still(model.mounted)
            if model.reading is not None:
                self.drawing.set_table_angle(model.reading.table.angle_deg)

    def _texts(self, model: RunModel) -> tuple[str, str]:
        if model.hand is not None:
            return hand_words.title(model.hand), self._hand_subtitle(model, model.hand)
        if model.state == "aborting":
            return self.tr("Stopping"), self.tr("The table comes to rest, then the supply goes off.")
        if model.phase == "paused":
            return self.tr("Paused"), self.tr("The bench waits. What is recorded is on disk.")
        if model.request is not None:
            return self._mount_texts(model)
        step = model.active
        if model.segment is not None:
            segment = model.segment.segment
            return words.segment(segment), words.segment_kind(segment)
        title = said(model.activity.what) if model.activity is not None else self.tr("Getting ready")
        if step is None:
            return title, ""
        return title, f"{words.face(step.step.mounting)}: {words.step(step.step)}"

    def _hand_subtitle(self, model: RunModel, request: HandRequest) -> str:
        if model.state == "aborting":
            return self.tr("The run is stopped. Only you can stop this table; then the supply goes off.")
        return hand_words.how(request)

    def _mount_texts(self, model: RunModel) -> tuple[str, str]:
        assert model.request is not None
        asked = model.request.orientation
        text = (
            self.tr("Mount the case with {axis} pointing up")
            if asked.up_sign > 0
            else self.tr("Mount the case with {axis} pointing down")
        )
        subtitle = (
            self.tr("Power stays on: mind the cable. The table is held at its north mark.")
            if model.powered
            else self.tr(
                "Power is off. Turn the fixture, tighten it, plug in again. The table is held "
                "at its north mark."
            )
        )
        return text.format(axis=asked.up_axis.upper()), subtitle

    def _refresh_pause(self, model: RunModel) -> None:
        self.pause_button.setVisible(model.phase != "paused" and model.state != "aborting")
        self.pause_button.setText(
            self.tr("Pausing after this …") if model.state == "pausing" else self.tr("Pause") + "  P"
        )

    def retranslate(self) -> None:
        """Set every text."""
        self.empty.set_content(
            self.tr("No run yet"),
            self.tr(
                "Here the application leads through a calibration: what to mount, what is "
                "measured, how it goes."
            ),
            self.tr("Choose a job"),
        )
        self.pause_button.setToolTip(self.tr("Pause before the next command (P)"))
        self.refresh()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class _PausedView(QWidget):
    """The run waits for the person."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GAP)
        self._panel = Panel("warn")
        self._text = Label(wrap=True)
        self._panel.body.addWidget(self._text)
        column.addWidget(self._panel)
        column.addStretch(1)
        self.button = PrimaryButton(icon="resume", large=True)
        column.addWidget(self.button)
        self.retranslate()

    def retranslate(self) -> None:
        """Set every text."""
        self._text.setText(self.tr("The table rests and the supply stays on until you go on."))
        self.button.set_caption(self.tr("Go on"), "P")

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)
