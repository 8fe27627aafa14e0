"""The page Instruments: the benches of real instruments at the left, the chosen instrument at the right."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.registry import Kind
from ahrs_lab.laboratory.instrument_benches import PARTS, InstrumentBenches
from ahrs_lab.laboratory.instrument_desk import InstrumentDesk
from ahrs_lab.messages import Message
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.instruments.ahrs_view import AhrsView
from ahrs_lab.ui.pages.instruments.dialog import InstrumentDialog, NameDialog
from ahrs_lab.ui.pages.instruments.language_view import LanguageView
from ahrs_lab.ui.pages.instruments.part_row import PartRow
from ahrs_lab.ui.pages.instruments.power_view import RoomView, SupplyView
from ahrs_lab.ui.pages.instruments.session import InstrumentSession
from ahrs_lab.ui.pages.instruments.table_view import TableView
from ahrs_lab.ui.pages.widgets.form import ChoiceField
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Card, EmptyState, Label, SecondaryButton

_LEFT_PX = 392


class InstrumentsPage(Page):
    """One bench at a time. Close its session (:meth:`close_session`) before the laboratory."""

    key = "instruments"

    def __init__(
        self, desk: Desk, benches: InstrumentBenches | None = None, *, supervised: bool = True
    ) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        home = Path(desk.laboratory.home)
        self.benches = benches or InstrumentBenches(home / "benches")
        self._supervised = supervised
        self._report = home / "supervisor.jsonl"
        self._drivers_known = False
        self.session = InstrumentSession(self._make_desk, self)
        self.session.looked.connect(self._show)
        self.session.told.connect(self._tell)
        self.workspace.stoppable.append(self.session)
        for signal in (self.workspace.run_starting, self.workspace.closing):
            signal.connect(self.close_session)
        self._part: Kind = "table"
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("instruments")
        self._empty.pressed.connect(self.new_bench)
        self._stack.addWidget(self._empty)
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        column.addLayout(self._make_head())
        self.trouble = Banner("bad", closable=True)
        self.trouble.setVisible(False)
        column.addWidget(self.trouble)
        row = QHBoxLayout()
        row.setSpacing(CARD_MARGIN)
        row.addWidget(self._make_list())
        row.addLayout(self._make_detail(), 1)
        column.addLayout(row, 1)
        self._stack.addWidget(whole)
        self.retranslate()

    def _make_desk(self, bench: Mapping[str, Any]) -> InstrumentDesk:
        return InstrumentDesk(
            bench, drivers=self.benches.drivers, supervised=self._supervised, report=self._report
        )

    # layout ───────────────────────────────────────────────────────────────────────────────────────────────

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(GAP)
        words = QVBoxLayout()
        words.setSpacing(0)
        self._title = Label(role="title")
        self._note = Label(tone="muted")
        words.addWidget(self._title)
        words.addWidget(self._note)
        self.bench = ChoiceField()
        self.bench.setFixedWidth(240)
        self.bench.edited.connect(self._bench_chosen)
        self.add_bench = SecondaryButton(icon="add")
        self.add_bench.clicked.connect(self.new_bench)
        self.use = SecondaryButton()
        self.use.clicked.connect(self._use_for_job)
        row.addLayout(words)
        row.addStretch(1)
        row.addWidget(self.bench)
        bottom = Qt.AlignmentFlag.AlignBottom
        row.addWidget(self.add_bench, 0, bottom)
        row.addWidget(self.use, 0, bottom)
        return row

    def _make_list(self) -> Card:
        card = Card()
        card.setFixedWidth(_LEFT_PX)
        self.rows: dict[Kind, PartRow] = {}
        for part in PARTS:
            row = PartRow(part)
            row.chosen.connect(self.choose)
            row.toggled.connect(self._toggle)
            row.edit.connect(self.edit)
            self.rows[part] = row
            card.add(row)
        card.body.addStretch(1)
        return card

    def _make_detail(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(GAP)
        self.tabs = Tabs()
        self.tabs.currentChanged.connect(self._tab_chosen)
        column.addWidget(self.tabs)
        self._detail = QStackedWidget()
        self.table, self.ahrs = TableView(self.session), AhrsView(self.session)
        self.supply, self.room = SupplyView(self.session), RoomView(self.session)
        self.language = LanguageView(self.session, self.benches)
        self.language.changed.connect(self._language_changed)
        self._nothing = EmptyState("add")
        self._nothing.pressed.connect(lambda: self.edit(self._part))
        self._places: dict[str, int] = {}
        for name, view in (
            ("table", self.table),
            ("ahrs", self.ahrs),
            ("supply", self.supply),
            ("room", self.room),
            ("language", self.language),
        ):
            # The language scrolls its texts itself.
            shown = view if view is self.language else _scrolled(view)
            self._places[name] = self._detail.addWidget(shown)
        self._places["nothing"] = self._detail.addWidget(self._nothing)
        column.addWidget(self._detail, 1)
        return column

    # content ──────────────────────────────────────────────────────────────────────────────────────────────

    def entered(self) -> None:
        self.refresh()

    def job_changed(self) -> None:
        self._show()

    def refresh(self) -> None:
        """Look at the bench files again."""
        names = self.benches.names()
        self._stack.setCurrentIndex(1 if names else 0)
        self.bench.set_choices([(name, name) for name in names])
        if names:
            self._open_bench(self.bench.key())

    def _open_bench(self, name: str) -> None:
        try:
            bench = self.benches.load(name)
        except AhrsLabError as error:
            self._tell(error.message)
            return
        if bench != self.session.bench:
            self.session.set_bench(bench)
        self._show_bench()

    def _show_bench(self) -> None:
        bench = self.session.bench
        for part, row in self.rows.items():
            title, place = "", ""
            try:
                driver = self.benches.driver_of(bench, part)
                title = said(driver.title) if driver is not None else ""
            except AhrsLabError as error:
                title = said(error.message)
            if title:
                place = _place(bench[part])
            row.set_instrument(title, place)
        table = bench.get("table", {})
        self.table.set_manual(table.get("driver") == "manual")
        self.room.set_typed(bench.get("room", {}).get("driver") == "typed")
        self.language.show_table(table)
        self.choose(self._part)

    def choose(self, part: str) -> None:
        """Show this instrument at the right."""
        self._part = cast(Kind, part)
        for name, row in self.rows.items():
            row.set_chosen(name == part)
        with_language = part == "table" and self.session.bench.get("table", {}).get("driver") == "ascii"
        self.tabs.setVisible(with_language)
        if not with_language:
            self.tabs.setCurrentIndex(0)
        self._tab_chosen(self.tabs.currentIndex())
        self._show()

    def _tab_chosen(self, tab: int) -> None:
        name: str = "language" if tab == 1 else self._part
        if not self.rows[self._part].there:
            name = "nothing"
        self._detail.setCurrentIndex(self._places[name])
        self._words_of_nothing()

    def _show(self) -> None:
        desk = self.session.desk
        views = desk.views if desk is not None else {}
        running = self.workspace.run.live
        for part, row in self.rows.items():
            row.set_view(views.get(part), not running)
        self.table.refresh(views.get("table"), desk)
        self.ahrs.refresh(views.get("ahrs"), desk)
        self.supply.refresh(views.get("supply"))
        self.room.refresh(views.get("room"))
        self.language.refresh(views.get("table"))
        self.use.setEnabled(self.workspace.job is not None and not running)
        if desk is not None and desk.stop_problems:
            self._tell(desk.stop_problems[0])
            desk.stop_problems = None

    def _tell(self, what: Message) -> None:
        self.trouble.set_content("bad", "", said(what))
        self.trouble.setVisible(True)

    # actions ──────────────────────────────────────────────────────────────────────────────────────────────

    def _bench_chosen(self) -> None:
        self.trouble.setVisible(False)
        self._open_bench(self.bench.key())

    def new_bench(self) -> None:
        """Ask for a name and begin with nothing."""
        dialog = NameDialog(self.benches, self)
        if dialog.exec():
            self.refresh()
            self.bench.set_key(dialog.name.text())
            self._bench_chosen()
        dialog.deleteLater()

    def edit(self, part: str) -> None:
        """Ask for an instrument's driver and settings."""
        kind = cast(Kind, part)
        dialog = InstrumentDialog(self.benches, kind, self.session.bench.get(part), self)
        if dialog.exec():
            self.save_instrument(kind, dialog.table)
        dialog.deleteLater()

    def save_instrument(self, part: Kind, table: Mapping[str, Any] | None) -> None:
        """Into the bench file; None removes it. What is connected is let go."""
        bench = {key: value for key, value in self.session.bench.items() if key != part}
        if table is not None:
            bench[part] = dict(table)
        try:
            self.benches.save(self.bench.key(), bench)
        except AhrsLabError as error:
            self._tell(error.message)
            return
        self._part = part
        self._open_bench(self.bench.key())

    def _language_changed(self, table: object) -> None:
        self.save_instrument("table", cast("dict[str, Any]", table))
        self.session.connect_part("table")

    def _toggle(self, part: str) -> None:
        kind = cast(Kind, part)
        self.trouble.setVisible(False)
        desk = self.session.desk
        if desk is not None and (desk.views[kind].connected or desk.views[kind].state == "connecting"):
            self.session.disconnect_part(kind)
            return
        try:
            self.workspace.run.release()
        except AhrsLabError as error:
            self._tell(error.message)
        self.session.connect_part(kind)
        if kind == "table" and self.session.desk is not None:
            self.table.show_limits(self.session.desk.jog_limits)

    def _use_for_job(self) -> None:
        from dataclasses import replace

        from ahrs_lab.ui.pages.jobs.editor import draft_of

        actor = self._desk.ask_actor(self)
        if actor is None or not self._desk.number:
            return
        try:
            job = self._desk.laboratory.job(self._desk.number)
            text = self.benches.text(self.bench.key())
            self._desk.laboratory.update_job(job.number, replace(draft_of(job), bench_toml=text), actor)
        except AhrsLabError as error:
            self._tell(error.message)
            return
        self._desk.changed()

    def close_session(self) -> None:
        """Let every instrument go: before a run takes them, and at the end."""
        self.session.close()
        self._show()

    # words ────────────────────────────────────────────────────────────────────────────────────────────────

    def _words_of_nothing(self) -> None:
        texts = {
            "table": self.tr("The rate table's readings will be here, and buttons to move it by hand."),
            "ahrs": self.tr("The device's rates, forces and angles will be here, and what its line loses."),
            "supply": self.tr("Voltage and current of the device will be here, and its switch."),
            "room": self.tr("Temperature and humidity of the room will be here."),
        }
        self._nothing.set_content(self.tr("None on this bench yet"), texts[self._part], self.tr("Add …"))

    def retranslate(self) -> None:
        self._title.setText(self.tr("Instruments"))
        self._note.setText(
            self.tr("Connect, look, configure and move by hand; a run connects them by itself.")
        )
        self.bench.set_name(self.tr("Bench of instruments"))
        self.add_bench.setText(self.tr("New bench"))
        self.use.setText(self.tr("Use for the open job"))
        self.tabs.set_texts(self.tr("Now"), self.tr("Language"))
        self._empty.set_content(
            self.tr("No bench of instruments yet"),
            self.tr(
                "The rate table, the device, the power supply and the room sensor will be here, each with "
                "its driver, "
                "its connection and what it reads."
            ),
            self.tr("New bench"),
        )
        self.refresh()


def _scrolled(view: QWidget) -> QScrollArea:
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    view.setObjectName("scrolled")
    area.setWidget(view)
    return area


def _place(table: Mapping[str, Any]) -> str:
    """Where an instrument is, as its settings say."""
    link = table.get("link") or table.get("connection", {}).get("link") or {}
    if link.get("device"):
        return f"{link['device']}, {link['baud']}" if "baud" in link else str(link["device"])
    if link.get("host"):
        return f"{link['host']}:{link['port']}" if link.get("port") else str(link["host"])
    return str(table.get("connection", {}).get("resource", ""))
