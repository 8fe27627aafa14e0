"""Power supply and room: what they read, and what can be set."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from ahrs_lab.instruments.interfaces import RoomReading, SupplyReading
from ahrs_lab.laboratory.instrument_station import StationView
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.instruments.numbers import NumberField
from ahrs_lab.ui.pages.instruments.session import InstrumentSession
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import BigNumber, Card, SecondaryButton, StateDot


class SupplyView(Translated):
    """Voltage, current, on and off."""

    def __init__(self, session: InstrumentSession) -> None:
        super().__init__()
        self._session = session
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._card = Card()
        self._output = StateDot()
        self._card.add_tool(self._output)
        row = QHBoxLayout()
        row.setSpacing(4 * GAP)
        self.voltage, self.current = BigNumber(unit="V"), BigNumber(unit="A")
        for big in (self.voltage, self.current):
            big.setMinimumWidth(170)
            row.addWidget(big)
        row.addStretch(1)
        self._card.add(row)
        self.fault = IconLine("bad", "")
        self.fault.setVisible(False)
        self._card.add(self.fault)
        column.addWidget(self._card)
        self._set_card = Card()
        setting = QHBoxLayout()
        setting.setSpacing(CARD_MARGIN)
        self.set_voltage, self.set_limit = NumberField(12.0), NumberField(1.0)
        self.on, self.off = SecondaryButton(), SecondaryButton()
        self.on.clicked.connect(self._switch_on)
        self.off.clicked.connect(lambda: self._session.attempt(lambda desk: desk.power_off()))
        for widget in (self.set_voltage, self.set_limit, self.on, self.off):
            setting.addWidget(widget, 0, Qt.AlignmentFlag.AlignBottom)
        setting.addStretch(1)
        self._set_card.add(setting)
        column.addWidget(self._set_card)
        column.addStretch(1)
        self.retranslate()

    def refresh(self, view: StationView | None) -> None:
        """What is known now."""
        live = view.live if view is not None else None
        reading = live if isinstance(live, SupplyReading) else None
        self.voltage.set_value(number(reading.voltage_v if reading else None, 3))
        self.current.set_value(number(reading.current_a if reading else None, 4))
        if reading is None:
            self._output.set_state("unknown", self.tr("not connected"))
        elif reading.output_on:
            self._output.set_state("good", self.tr("output on"))
        else:
            self._output.set_state("unknown", self.tr("output off"))
        connected = view is not None and view.connected
        self.on.setEnabled(connected)
        self.off.setEnabled(connected)
        _show_fault(self.fault, view)

    def _switch_on(self) -> None:
        voltage, limit = self.set_voltage.value(), self.set_limit.value()
        if voltage is not None and limit is not None:
            self._session.attempt(lambda desk: desk.power_on(voltage, limit))

    def retranslate(self) -> None:
        self._card.set_title(self.tr("Power supply now"))
        self.voltage.set_caption(self.tr("Voltage"))
        self.current.set_caption(self.tr("Current"))
        self._set_card.set_title(self.tr("Power of the device"))
        self.set_voltage.set_name(self.tr("Voltage, V"))
        self.set_limit.set_name(self.tr("Current limit, A"))
        self.on.setText(self.tr("Switch on"))
        self.off.setText(self.tr("Switch off"))


class RoomView(Translated):
    """Temperature and humidity; typed in where there is no sensor."""

    def __init__(self, session: InstrumentSession) -> None:
        super().__init__()
        self._session = session
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._card = Card()
        row = QHBoxLayout()
        row.setSpacing(4 * GAP)
        self.temperature, self.humidity = BigNumber(unit="°C"), BigNumber(unit="%RH")
        for big in (self.temperature, self.humidity):
            big.setMinimumWidth(170)
            row.addWidget(big)
        row.addStretch(1)
        self._card.add(row)
        self.fault = IconLine("bad", "")
        self.fault.setVisible(False)
        self._card.add(self.fault)
        column.addWidget(self._card)
        self._typed = Card()
        typing = QHBoxLayout()
        typing.setSpacing(CARD_MARGIN)
        self.typed_temperature, self.typed_humidity = NumberField(20.0), NumberField(50.0)
        self.enter = SecondaryButton()
        self.enter.clicked.connect(self._enter)
        for widget in (self.typed_temperature, self.typed_humidity, self.enter):
            typing.addWidget(widget, 0, Qt.AlignmentFlag.AlignBottom)
        typing.addStretch(1)
        self._typed.add(typing)
        column.addWidget(self._typed)
        column.addStretch(1)
        self.retranslate()

    def set_typed(self, typed: bool) -> None:
        """Values are read off and typed in."""
        self._typed.setVisible(typed)

    def refresh(self, view: StationView | None) -> None:
        """What is known now."""
        live = view.live if view is not None else None
        reading = live if isinstance(live, RoomReading) else None
        self.temperature.set_value(number(reading.temperature_c if reading else None, 1))
        self.humidity.set_value(number(reading.humidity_percent if reading else None, 0))
        self.enter.setEnabled(view is not None and view.connected)
        _show_fault(self.fault, view)

    def _enter(self) -> None:
        temperature, humidity = self.typed_temperature.value(), self.typed_humidity.value()
        if temperature is not None and humidity is not None:
            self._session.attempt(lambda desk: desk.enter_room(temperature, humidity))

    def retranslate(self) -> None:
        self._card.set_title(self.tr("Room now"))
        self.temperature.set_caption(self.tr("Temperature"))
        self.humidity.set_caption(self.tr("Humidity"))
        self._typed.set_title(self.tr("Read off and typed in"))
        self.typed_temperature.set_name(self.tr("Temperature, °C"))
        self.typed_humidity.set_name(self.tr("Humidity, %RH"))
        self.enter.setText(self.tr("Enter"))


def _show_fault(line: IconLine, view: StationView | None) -> None:
    text = said(view.problem) if view is not None and view.problem is not None else ""
    if text != line.text():
        line.set_content("bad", text)
    line.setVisible(bool(text))
