"""The AHRS: rates, forces and angles as they come, what the line does, settings that differ, and pulling the
plug."""

from __future__ import annotations

from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout

from ahrs_lab.instruments.settings import Difference
from ahrs_lab.laboratory.instrument_desk import InstrumentDesk
from ahrs_lab.laboratory.instrument_live import AhrsLive
from ahrs_lab.laboratory.instrument_station import StationView
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.ui.formatting import DASH, count, number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.instruments.session import InstrumentSession
from ahrs_lab.ui.pages.instruments.words import count_names
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Card, KeyValueTable, Label, SecondaryButton, Swatch, ValueLabel

AXES: tuple[Axis, ...] = ("x", "y", "z")
LINE = ("samples", "rate", "bits", "offset", "drift", "jitter", "temperature")


class AhrsView(Translated):
    """Readings at the left, the line at the right, tests below."""

    def __init__(self, session: InstrumentSession) -> None:
        super().__init__()
        self._session = session
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        row.addWidget(self._make_readings(), 1)
        row.addWidget(self._make_line(), 1)
        column.addLayout(row)
        column.addWidget(self._make_settings())
        column.addWidget(self._make_unplug())
        column.addStretch(1)
        self.retranslate()

    def _make_readings(self) -> Card:
        self._readings = Card()
        grid = QGridLayout()
        grid.setVerticalSpacing(GAP)
        grid.setHorizontalSpacing(CARD_MARGIN)
        self._heads = [Label(tone="muted") for _ in range(3)]
        self.values: dict[tuple[str, int], ValueLabel] = {}
        for place, axis in enumerate(AXES):
            grid.addWidget(Swatch(axis), place + 1, 0)
            name = Label(axis.upper(), role="strong")
            grid.addWidget(name, place + 1, 1)
        for column, kind in enumerate(("rate", "force", "angle")):
            grid.addWidget(self._heads[column], 0, column + 2)
            grid.setColumnStretch(column + 2, 1)
            for place in range(3):
                value = ValueLabel()
                self.values[kind, place] = value
                grid.addWidget(value, place + 1, column + 2)
        self._readings.add(grid)
        self.fault = IconLine("bad", "")
        self.fault.setVisible(False)
        self._readings.add(self.fault)
        self._readings.body.addStretch(1)
        return self._readings

    def _make_line(self) -> Card:
        self._line_card = Card()
        self.line = KeyValueTable(LINE, row_gap=4)
        self.counts = KeyValueTable(tuple(count_names()), row_gap=4)
        row = QHBoxLayout()
        row.setSpacing(4 * GAP)
        for table in (self.line, self.counts):
            inner = QVBoxLayout()
            inner.addWidget(table)
            inner.addStretch(1)
            row.addLayout(inner, 1)
        self._line_card.add(row)
        return self._line_card

    def _make_settings(self) -> Card:
        self._settings_card = Card()
        self.configure = SecondaryButton()
        self.configure.clicked.connect(self._configure)
        self._settings_card.add_tool(self.configure)
        self.configured = IconLine("info", "")
        self._settings_card.add(self.configured)
        return self._settings_card

    def _make_unplug(self) -> Card:
        self._unplug_card = Card()
        self.unplug = SecondaryButton()
        self.unplug.clicked.connect(self._begin_unplug)
        self._unplug_card.add_tool(self.unplug)
        self.unplugged = IconLine("info", "")
        self._unplug_card.add(self.unplugged)
        return self._unplug_card

    # content ──────────────────────────────────────────────────────────────────────────────────────────────

    def refresh(self, view: StationView | None, desk: InstrumentDesk | None) -> None:
        """What is known now."""
        found = view.live if view is not None else None
        live = found if isinstance(found, AhrsLive) else AhrsLive()
        self._show("rate", live.rates, 3, live.rate_unit)
        self._show("force", live.specific_force, 3, live.force_unit.replace("m/s^2", "m/s²"))
        self._show("angle", live.angles_deg, 2, "°")
        self._show_line(live)
        fault = said(view.problem) if view is not None and view.problem is not None else ""
        if fault != self.fault.text():
            self.fault.set_content("bad", fault)
        self.fault.setVisible(bool(fault))
        connected = view is not None and view.connected
        self.configure.setEnabled(connected and view is not None and not view.busy)
        self._show_differences(view.differences if view is not None else None)
        self._show_unplug(desk, connected)

    def _show(self, kind: str, values: tuple[float, ...], decimals: int, unit: str) -> None:
        for place in range(3):
            value = values[place] if place < len(values) else None
            self.values[kind, place].set_value(number(value, decimals), unit if value is not None else "")

    def _show_line(self, live: AhrsLive) -> None:
        line = self.line
        line.set_value("samples", count(live.samples) if live.samples else DASH)
        line.set_value("rate", f"{number(live.sample_rate_hz, 2)} Hz")
        bits = number(live.bits_per_second, 0)
        if live.line_bits_per_second:
            bits = f"{bits} / {count(live.line_bits_per_second)}"
        line.set_value("bits", bits)
        milli = None if live.offset_s is None else live.offset_s
        line.set_value("offset", f"{number(milli, 4)} s")
        line.set_value("drift", f"{number(live.rate_ppm, 1, plus=True)} ppm")
        line.set_value("jitter", f"{number(None if live.jitter_s is None else 1e3 * live.jitter_s, 1)} ms")
        line.set_value("temperature", f"{number(live.temperature_c, 1)} °C")
        for key in count_names():
            value = live.counts.get(key)
            bad = bool(value) and key != "frames"
            self.counts.set_value(key, DASH if value is None else count(value), "warn" if bad else "text")

    def _show_differences(self, differences: tuple[Difference, ...] | None) -> None:
        if differences is None:
            state, text = (
                "info",
                self.tr(
                    "The stream is paused, the settings of the bench file are set and read back; what "
                    "differs is shown."
                ),
            )
        elif not differences:
            state, text = "good", self.tr("The device has taken every setting.")
        else:
            state, text = "warn", "\n".join(said(difference.message) for difference in differences)
        if text != self.configured.text():
            self.configured.set_content(state, text)

    def _show_unplug(self, desk: InstrumentDesk | None, connected: bool) -> None:
        test = desk.unplug_test if desk is not None else None
        phase = test.phase if test is not None else "idle"
        verdict = test.verdict if test is not None else None
        state, text = "info", self.tr("Shows how soon a pulled data cable is noticed and the stream is back.")
        if phase == "pull":
            state, text = "warn", self.tr("Pull the device's data cable now.")
        elif phase == "plug":
            state, text = "warn", self.tr("The loss was noticed. Plug the cable in again.")
        elif verdict is not None:
            state, text = "good", said(verdict)
        if text != self.unplugged.text():
            self.unplugged.set_content(state, text)
        self.unplug.setEnabled(connected)
        self.unplug.setText(self.tr("Cancel") if phase in ("pull", "plug") else self.tr("Begin the test"))

    # actions ──────────────────────────────────────────────────────────────────────────────────────────────

    def _configure(self) -> None:
        self._session.attempt(lambda desk: desk.configure("ahrs"))

    def _begin_unplug(self) -> None:
        desk = self._session.desk
        if desk is not None:
            test = desk.unplug_test
            if test.phase in ("pull", "plug"):
                test.cancel()
            else:
                test.begin()

    def retranslate(self) -> None:
        self._readings.set_title(self.tr("Readings, mean of one second"))
        for label, text in zip(
            self._heads,
            (self.tr("Rate"), self.tr("Specific force"), self.tr("Heading, pitch, roll")),
            strict=True,
        ):
            label.setText(text)
        self._line_card.set_title(self.tr("The line"))
        for key, text in {
            "samples": self.tr("Samples"),
            "rate": self.tr("Sample rate"),
            "bits": self.tr("Bits per second"),
            "offset": self.tr("Host − device time"),
            "drift": self.tr("Clock rate"),
            "jitter": self.tr("Late by (95 %)"),
            "temperature": self.tr("Temperature"),
        }.items():
            self.line.set_name(key, text)
        for key, text in count_names().items():
            self.counts.set_name(key, text)
        self._settings_card.set_title(self.tr("Settings of the device"))
        self.configure.setText(self.tr("Configure and read back"))
        self._unplug_card.set_title(self.tr("Unplugging"))
        self.configured.set_content("info", "")
        self.unplugged.set_content("info", "")
        self.refresh(None, None)
