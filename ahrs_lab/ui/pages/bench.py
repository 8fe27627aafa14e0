"""The page Bench: who the instruments are, what they may do, how the room is; and faults to try."""

from __future__ import annotations

import math
from dataclasses import replace

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.metrology.conditions import RoomLimits
from ahrs_lab.records.rows import JobRow
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.bench_model import FAULTS, BenchView, faults_of, look_at, with_fault
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.editor import draft_of
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.pages.widgets.form import ChoiceField
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.pages.words import fault_names, instrument_name
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Card, EmptyState, KeyValueTable, Label

INSTRUMENTS = ("table", "ahrs", "supply", "stream")
LIMITS = ("rate", "acceleration", "north", "site")
CHANGEABLE = ("draft", "ready")


class BenchPage(Page):
    """The open job's bench; without a job, one of the presets to look at."""

    key = "bench"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._job: JobRow | None = None
        self._text = ""
        self._view: BenchView | None = None
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("bench")
        self._empty.pressed.connect(lambda: self.workspace.go_to("jobs"))
        self._stack.addWidget(self._empty)
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        column.addLayout(self._make_head())
        self._refusal = Banner("bad")
        self._refusal.setVisible(False)
        column.addWidget(self._refusal)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        row.addLayout(self._make_facts(), 10)
        row.addWidget(self._make_faults(), 7)
        row.addWidget(self._make_settings(), 13)
        column.addLayout(row, 1)
        self._stack.addWidget(whole)
        desk.jobs_changed.connect(self.refresh)
        self.retranslate()

    # layout ---------------------------------------------------------------------------------------------

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(GAP)
        words = QVBoxLayout()
        words.setSpacing(0)
        self._title = Label(role="title")
        self._whose = Label(tone="muted")
        words.addWidget(self._title)
        words.addWidget(self._whose)
        self._chip = Chip()
        self.preset = ChoiceField()
        self.preset.setFixedWidth(280)
        self.preset.edited.connect(self._preset_chosen)
        row.addLayout(words)
        row.addWidget(self._chip, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addStretch(1)
        row.addWidget(self.preset)
        return row

    def _make_facts(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(CARD_MARGIN)
        self._instruments_card, self._limits_card, self._room_card = Card(), Card(), Card()
        self.instruments = KeyValueTable(INSTRUMENTS, numbers=False)
        self.limits = KeyValueTable(LIMITS)
        self._instruments_card.add(self.instruments)
        self._limits_card.add(self.limits)
        self.room = KeyValueTable(("temperature", "humidity"))
        self._room_chip = Chip()
        self._room_card.add_tool(self._room_chip)
        self._room_card.add(self.room)
        for card in (self._instruments_card, self._limits_card, self._room_card):
            column.addWidget(card)
        column.addStretch(1)
        return column

    def _make_faults(self) -> Card:
        self._faults_card = Card()
        self._faults_text = Label(tone="muted", wrap=True)
        self._faults_card.add(self._faults_text)
        self.faults: dict[str, TickBox] = {}
        inside = QWidget()
        inside.setObjectName("scrolled")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GAP)
        for name in FAULTS:
            box = TickBox()
            box.clicked.connect(lambda on, name=name: self._switch_fault(name, on))
            self.faults[name] = box
            column.addWidget(box)
        column.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(inside)
        self._faults_card.add(area, 1)
        return self._faults_card

    def _make_settings(self) -> Card:
        self._settings_card = Card()
        self.settings = TextTable(selectable=False, compact=True)
        self._settings_card.add(self.settings, 1)
        return self._settings_card

    # content --------------------------------------------------------------------------------------------

    def entered(self) -> None:
        self.refresh()

    def job_changed(self) -> None:
        if self.isVisible():
            self.refresh()

    def refresh(self) -> None:
        """Look at the open job's bench again."""
        laboratory = self._desk.laboratory
        self._job = None
        if self._desk.number:
            try:
                self._job = laboratory.job(self._desk.number)
            except AhrsLabError as error:
                self._desk.tell(error)
        self._whose.setText(
            self.tr("of job {number}").format(number=self._job.number)
            if self._job is not None
            else self.tr("a preset to look at")
        )
        presets = laboratory.bench_presets()
        own = [("", self.tr("settings of the job"))] if self._job is not None else []
        self.preset.set_choices([*own, *((name, name) for name in presets)])
        if self._job is not None:
            matching = next((name for name, text in presets.items() if text == self._job.bench_toml), "")
            self.preset.set_key(matching)
            self.show_bench(self._job.bench_toml)
        else:
            self.show_bench(presets.get(self.preset.key(), ""))

    def show_bench(self, text: str) -> None:
        """Build it and show what it says of itself."""
        self._text = text
        self._stack.setCurrentIndex(1 if text.strip() else 0)
        if not text.strip():
            return
        refusal = ""
        try:
            self._view = look_at(text)
        except AhrsLabError as error:
            self._view = None
            refusal = said(error.message)
        self._refusal.set_content("bad", "", refusal)
        self._refusal.setVisible(bool(refusal))
        if self._view is not None:
            self._show_view(self._view)
        self._show_faults()

    def _show_view(self, view: BenchView) -> None:
        self._chip.set_content(
            "warn" if view.simulated else "good",
            "info" if view.simulated else "good",
            self.tr("simulated") if view.simulated else self.tr("instruments"),
        )
        self.instruments.set_value("table", instrument_name(said(view.table)))
        self.instruments.set_value("ahrs", instrument_name(said(view.ahrs)))
        self.instruments.set_value("supply", instrument_name(said(view.supply)))
        device = view.device
        unit = device.rate_unit.replace("deg/s", "°/s")
        self.instruments.set_value("stream", f"{number(device.sample_rate_hz, 0)} Hz, {unit}")
        self.limits.set_value("rate", f"{number(view.limits.max_rate_dps, 0)} °/s")
        self.limits.set_value("acceleration", f"{number(view.limits.max_acceleration_dps2, 0)} °/s²")
        self.limits.set_value("north", f"{number(view.north_deg, 3)}°")
        self.limits.set_value(
            "site", f"{number(view.site.latitude_deg, 4)}°, {number(view.site.altitude_m, 0)} m"
        )
        self._show_room(view)
        self.settings.set_content(
            (Column(self.tr("Setting")), Column(self.tr("Value"), stretch=True)),
            [
                (Cell(f"{part}.{name}".lstrip("."), "muted"), Cell(value))
                for part, name, value in view.settings
            ],
        )

    def _show_room(self, view: BenchView) -> None:
        limits = RoomLimits()
        (cold, warm), (dry, damp) = limits.temperature_c, limits.humidity_percent
        well = cold <= view.temperature_c <= warm and dry <= view.humidity_percent <= damp
        self.room.set_value("temperature", f"{number(view.temperature_c, 1)} °C   ({cold:g}–{warm:g})")
        self.room.set_value("humidity", f"{number(view.humidity_percent, 0)} %RH   ({dry:g}–{damp:g})")
        if math.isnan(view.temperature_c):
            self._room_chip.set_content("plain", "info", self.tr("not connected"))
        elif well:
            self._room_chip.set_content("good", "good", self.tr("within clause 6"))
        else:
            self._room_chip.set_content("bad", "bad", self.tr("outside clause 6"))

    def _show_faults(self) -> None:
        changeable = self._job is not None and self._job.state in CHANGEABLE
        self._faults_card.setVisible(self._view is None or self._view.simulated)
        on: frozenset[str] = frozenset()
        try:
            on = faults_of(self._text)
        except AhrsLabError:
            changeable = False  # said in the banner already
        for name, box in self.faults.items():
            box.setChecked(name in on)
            box.setEnabled(changeable)
        self._faults_text.setText(
            self.tr("What is ticked goes wrong during this job's run, from its start.")
            if changeable
            else self.tr("Open a job that is not measured yet to try faults in its run.")
        )
        self.preset.editor.setEnabled(self._job is None or changeable)

    # actions --------------------------------------------------------------------------------------------

    def _preset_chosen(self) -> None:
        presets = self._desk.laboratory.bench_presets()
        text = presets.get(self.preset.key())
        if text is None:
            return
        if self._job is None:
            self.show_bench(text)
        else:
            self._save(text)

    def _switch_fault(self, name: str, on: bool) -> None:
        try:
            self._save(with_fault(self._text, name, on))
        except AhrsLabError as error:
            self._desk.tell(error)
            self._show_faults()

    def _save(self, text: str) -> None:
        actor = self._desk.ask_actor(self)
        if actor is not None and self._job is not None:
            try:
                self._desk.laboratory.update_job(
                    self._job.number, replace(draft_of(self._job), bench_toml=text), actor
                )
            except AhrsLabError as error:
                self._desk.tell(error)
        self._desk.changed()
        self.refresh()

    # words ----------------------------------------------------------------------------------------------

    def retranslate(self) -> None:
        self._empty.set_content(
            self.tr("No bench yet"),
            self.tr("The instruments of the open job's bench will be here, with what they may do."),
            self.tr("Choose a job"),
        )
        self._title.setText(self.tr("Bench"))
        self.preset.set_name(self.tr("Preset"))
        self._instruments_card.set_title(self.tr("Instruments"))
        self._limits_card.set_title(self.tr("Table limits and site"))
        self._room_card.set_title(self.tr("Room"))
        self._faults_card.set_title(self.tr("Faults to try"))
        self._settings_card.set_title(self.tr("Settings of the simulation"))
        for table, names in (
            (
                self.instruments,
                {
                    "table": self.tr("Rate table"),
                    "ahrs": self.tr("Device"),
                    "supply": self.tr("Supply"),
                    "stream": self.tr("Data stream"),
                },
            ),
            (
                self.limits,
                {
                    "rate": self.tr("Highest rate"),
                    "acceleration": self.tr("Highest acceleration"),
                    "north": self.tr("North at table angle"),
                    "site": self.tr("Latitude, altitude"),
                },
            ),
            (self.room, {"temperature": self.tr("Temperature"), "humidity": self.tr("Humidity")}),
        ):
            for key, text in names.items():
                table.set_name(key, text)
        for name, text in fault_names().items():
            if name in self.faults:
                self.faults[name].setText(text)
        if self.isVisible():  # looking for drivers takes 0.1 s: not before somebody looks here
            self.refresh()
