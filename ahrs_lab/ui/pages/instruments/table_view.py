"""The rate table: what it does now, and moving it by hand within limits."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.laboratory.instrument_desk import InstrumentDesk, JogLimits
from ahrs_lab.laboratory.instrument_live import TableLive
from ahrs_lab.laboratory.instrument_station import StationView
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.instruments.hold_button import HoldButton
from ahrs_lab.ui.pages.instruments.numbers import NumberField
from ahrs_lab.ui.pages.instruments.session import InstrumentSession
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import BigNumber, Card, Label, Panel, PrimaryButton, SecondaryButton, StateDot


class TableView(Translated):
    """Readings above, the hand's buttons below."""

    def __init__(self, session: InstrumentSession) -> None:
        super().__init__()
        self._session = session
        self._manual = False
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        column.addWidget(self._make_readings())
        column.addWidget(self._make_request())
        self._jog_card, self._hand_card = self._make_jog(), self._make_hand()
        column.addWidget(self._jog_card)
        column.addWidget(self._hand_card)
        column.addStretch(1)
        self.retranslate()

    def _make_readings(self) -> Card:
        self._readings = Card()
        self._watch = StateDot()
        self._readings.add_tool(self._watch)
        row = QHBoxLayout()
        row.setSpacing(4 * GAP)
        self.rate, self.demanded, self.angle = (BigNumber(unit=unit) for unit in ("°/s", "°/s", "°"))
        for big in (self.rate, self.demanded, self.angle):
            big.setMinimumWidth(170)
            row.addWidget(big)
        row.addStretch(1)
        self._readings.add(row)
        self.fault = IconLine("bad", "")
        self.fault.setVisible(False)
        self._readings.add(self.fault)
        return self._readings

    def _make_request(self) -> Panel:
        self.request = Panel("accent")
        self._asked = Label(role="strong", wrap=True)
        self.done = PrimaryButton(large=True)
        self.done.clicked.connect(self._confirm)
        self.request.body.addWidget(self._asked)
        self.request.body.addWidget(self.done, 0, Qt.AlignmentFlag.AlignLeft)
        self.request.setVisible(False)
        return self.request

    def _make_jog(self) -> Card:
        card = Card()
        self.drive = SecondaryButton()
        self.drive.clicked.connect(self._switch_drive)
        card.add_tool(self.drive)
        grid = QGridLayout()
        grid.setHorizontalSpacing(CARD_MARGIN)
        grid.setVerticalSpacing(GAP)
        self.jog_rate = NumberField(10.0)
        self.back, self.forth = HoldButton(icon="back"), HoldButton(icon="next")
        self.back.beat.connect(lambda: self._hold(-1.0))
        self.forth.beat.connect(lambda: self._hold(1.0))
        for button in (self.back, self.forth):
            button.let_go.connect(self._release)
        self.to_angle, self.to_rate = NumberField(0.0), NumberField(10.0)
        self.go = SecondaryButton()
        self.go.clicked.connect(self._go)
        bottom = Qt.AlignmentFlag.AlignBottom
        grid.addWidget(self.jog_rate, 0, 0)
        grid.addWidget(self.back, 0, 1, bottom)
        grid.addWidget(self.forth, 0, 2, bottom)
        grid.addWidget(self.to_angle, 1, 0)
        grid.addWidget(self.to_rate, 1, 1)
        grid.addWidget(self.go, 1, 2, bottom)
        for place in range(3):
            grid.setColumnStretch(place, 1)
        card.add(grid)
        card.add(self._make_limits())
        self.note = IconLine("warn", "")
        card.add(self.note)
        return card

    def _make_limits(self) -> QWidget:
        whole = QWidget()
        row = QHBoxLayout(whole)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        self.max_rate, self.low, self.high = NumberField(30.0), NumberField(None), NumberField(None)
        self.apply = SecondaryButton()
        self.apply.clicked.connect(self._apply_limits)
        for field in (self.max_rate, self.low, self.high):
            row.addWidget(field, 1)
        row.addWidget(self.apply, 0, Qt.AlignmentFlag.AlignBottom)
        return whole

    def _make_hand(self) -> Card:
        card = Card()
        self._hand_text = Label(tone="muted", wrap=True)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        self.hand_rate = NumberField(10.0)
        self.ask_rate = SecondaryButton()
        self.ask_rate.clicked.connect(self._ask_rate)
        row.addWidget(self.hand_rate)
        row.addWidget(self.ask_rate, 0, Qt.AlignmentFlag.AlignBottom)
        row.addStretch(1)
        card.add(self._hand_text)
        card.add(row)
        return card

    # content ──────────────────────────────────────────────────────────────────────────────────────────────

    def set_manual(self, manual: bool) -> None:
        """A table that the operator sets by hand has no buttons."""
        self._manual = manual
        self._jog_card.setVisible(not manual)
        self._hand_card.setVisible(manual)

    def refresh(self, view: StationView | None, desk: InstrumentDesk | None) -> None:
        """What is known now."""
        live = view.live if view is not None else None
        connected = view is not None and view.connected
        state = live.state if isinstance(live, TableLive) else None
        self.rate.set_value(number(state.rate_dps if state else None, 3))
        self.demanded.set_value(number(state.demanded_rate_dps if state else None, 3))
        self.angle.set_value(number(state.angle_deg if state else None, 3))
        fault = said(view.problem) if view is not None and view.problem is not None else ""
        fault = fault or (state.fault if state is not None else "")
        if fault != self.fault.text():
            self.fault.set_content("bad", fault)
        self.fault.setVisible(bool(fault))
        enabled = state is not None and state.enabled and not fault
        for widget in (self.back, self.forth, self.go):
            widget.setEnabled(enabled)
        self.drive.setEnabled(connected)
        self.apply.setEnabled(connected)
        self.drive.setText(self.tr("Switch the drive off") if enabled else self.tr("Switch the drive on"))
        self.ask_rate.setEnabled(connected and (desk is None or desk.hand_request is None))
        self._show_watch(connected, desk)
        pending = desk.hand_request if desk is not None else None
        self.request.setVisible(pending is not None)
        if pending is not None:
            self._asked.setText(said(pending.message))

    def _show_watch(self, connected: bool, desk: InstrumentDesk | None) -> None:
        if not connected:
            self._watch.set_state("unknown", self.tr("not connected"))
        elif self._manual:
            self._watch.set_state("unknown", self.tr("set by hand: nothing can stop it but you"))
        elif desk is not None and desk.supervised:
            self._watch.set_state("good", self.tr("supervisor watches"))
        else:
            self._watch.set_state("warn", self.tr("no supervisor: a crash leaves the table turning"))

    # actions ──────────────────────────────────────────────────────────────────────────────────────────────

    def _switch_drive(self) -> None:
        live = self._session.desk.views["table"].live if self._session.desk is not None else None
        on = isinstance(live, TableLive) and live.state.enabled and not live.state.fault
        problem = self.fault.isVisibleTo(self)
        self._session.attempt(lambda desk: desk.drive_off() if on and not problem else desk.drive_on())

    def _hold(self, sign: float) -> None:
        rate = self.jog_rate.value()
        if rate is not None:
            self._session.attempt(lambda desk: desk.hold(sign * abs(rate)))

    def _release(self) -> None:
        self._session.attempt(lambda desk: desk.release())

    def _go(self) -> None:
        angle, rate = self.to_angle.value(), self.to_rate.value()
        if angle is not None and rate is not None:
            self._session.attempt(lambda desk: desk.move_to(angle, rate))

    def _apply_limits(self) -> None:
        rate = self.max_rate.value()
        if rate is not None:
            limits = JogLimits(rate, self.low.value(), self.high.value())
            self._session.attempt(lambda desk: desk.set_jog_limits(limits))

    def show_limits(self, limits: JogLimits) -> None:
        """Those that are in force."""
        self.max_rate.set_value(limits.max_rate_dps)
        self.low.set_value(limits.min_angle_deg)
        self.high.set_value(limits.max_angle_deg)

    def _ask_rate(self) -> None:
        rate = self.hand_rate.value()
        if rate is not None:
            self._session.attempt(lambda desk: desk.set_rate(rate))

    def _confirm(self) -> None:
        self._session.attempt(lambda desk: desk.confirm_set())

    def retranslate(self) -> None:
        self._readings.set_title(self.tr("Rate table now"))
        self.rate.set_caption(self.tr("Rate"))
        self.demanded.set_caption(self.tr("Demanded"))
        self.angle.set_caption(self.tr("Angle"))
        self._jog_card.set_title(self.tr("Move by hand"))
        self._hand_card.set_title(self.tr("Table set by hand"))
        self._hand_text.setText(
            self.tr(
                "You set the rate at the table itself; during a run the device on it checks that it is right."
            )
        )
        self.hand_rate.set_name(self.tr("Rate to set, °/s"))
        self.ask_rate.setText(self.tr("Ask for it"))
        self.done.setText(self.tr("Done: the table does that"))
        self.jog_rate.set_name(self.tr("Rate while held, °/s"))
        self.back.setText(self.tr("Hold: clockwise"))
        self.forth.setText(self.tr("Hold: anticlockwise"))
        self.to_angle.set_name(self.tr("Go to angle, °"))
        self.to_rate.set_name(self.tr("with at most, °/s"))
        self.go.setText(self.tr("Go"))
        self.max_rate.set_name(self.tr("Limit by hand, °/s"))
        self.low.set_name(self.tr("Angle from, °"))
        self.high.set_name(self.tr("to, °"))
        for field in (self.low, self.high):
            field.line.setPlaceholderText(self.tr("no end"))
        self.apply.setText(self.tr("Set limits"))
        self.note.set_content(
            "warn",
            self.tr(
                "The table stops when the button is let go, and by STOP (Esc). Neither is the hardware "
                "emergency "
                "stop: keep that one within reach."
            ),
        )
        self.drive.setText(self.tr("Switch the drive on"))
