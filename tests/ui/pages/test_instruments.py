"""The page Instruments on a served bench, in both languages and looks."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any
from xml.etree import ElementTree

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton, QLabel
from pytestqt.qtbot import QtBot

from ahrs_lab.laboratory.instrument_benches import PARTS, InstrumentBenches, table_languages
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.servers.linked_toml import linked_bench
from ahrs_lab.simulation.servers.served_bench import ServedBench, ServeSettings, serve_bench
from ahrs_lab.simulation.settings import simulation_from_toml
from ahrs_lab.ui.frame.stop_bar import StopBar
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.instruments.dialog import InstrumentDialog, NameDialog
from ahrs_lab.ui.pages.instruments.page import InstrumentsPage
from ahrs_lab.ui.pages.widgets.form import TextField
from ahrs_lab.ui.theme import ThemeMode
from tests.laboratory.house_drivers import house_drivers
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.pages.conftest import Screens

PATIENCE_MS = 10_000


@pytest.fixture
def served() -> Iterator[ServedBench]:
    with serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp")) as bench:
        yield bench


@pytest.fixture
def page(screens: Screens, desk: Desk) -> Iterator[InstrumentsPage]:
    """In the window, with no bench yet; no second process."""
    benches = InstrumentBenches(screens.laboratory.home / "benches", house_drivers())
    made = InstrumentsPage(desk, benches, supervised=False)
    screens.window.add_page(made)
    screens.window.show_page("instruments")
    screens.look.settle()
    yield made
    made.close_session()


@pytest.fixture
def filled(page: InstrumentsPage, served: ServedBench) -> InstrumentsPage:
    """A bench whose instruments are served."""
    toml = {key: value for key, value in linked_bench(served).items() if key != "operator"}
    for part in ("supply", "room"):
        if "link" in toml[part]:
            toml[part]["connection"] = {"link": toml[part].pop("link")}
    page.benches.save("Served", toml)
    page.refresh()
    return page


def connect(page: InstrumentsPage, qtbot: QtBot, *parts: Any) -> None:
    for part in parts:
        qtbot.mouseClick(page.rows[part].action, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: all(page.rows[p].state_text() == "connected" for p in parts), timeout=PATIENCE_MS)


def rate_of(served: ServedBench) -> float:
    return abs(served.served.world.table.state().rate_dps)


def test_an_empty_page_says_what_will_be_here(page: InstrumentsPage) -> None:
    labels = [one.text() for one in page.findChildren(QLabel) if one.isVisibleTo(page) and one.text()]
    buttons = [one for one in page.findChildren(QAbstractButton) if one.isVisibleTo(page)]
    assert len(labels) == 2
    assert len(buttons) == 1


def test_readings_come_and_go_with_the_connection(filled: InstrumentsPage, qtbot: QtBot) -> None:
    assert {filled.rows[part].state_text() for part in PARTS} == {"not connected"}
    connect(filled, qtbot, "table", "supply", "room")
    qtbot.waitUntil(lambda: filled.room.temperature.value().startswith("20"), timeout=PATIENCE_MS)
    filled.choose("supply")
    qtbot.mouseClick(filled.supply.on, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: filled.supply.voltage.value() == "12.000", timeout=PATIENCE_MS)
    connect(filled, qtbot, "ahrs")
    filled.choose("ahrs")
    qtbot.waitUntil(lambda: filled.ahrs.line.value("rate") == "100.00 Hz", timeout=PATIENCE_MS)
    assert filled.ahrs.counts.value("lost") == "0"
    qtbot.mouseClick(filled.ahrs.configure, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "every setting" in filled.ahrs.configured.text(), timeout=PATIENCE_MS)
    qtbot.mouseClick(filled.rows["room"].action, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: filled.rows["room"].state_text() == "not connected", timeout=PATIENCE_MS)
    assert filled.room.temperature.value() == "–"


def test_the_table_turns_only_while_the_button_is_held(
    filled: InstrumentsPage, served: ServedBench, qtbot: QtBot
) -> None:
    connect(filled, qtbot, "table")
    qtbot.mouseClick(filled.table.drive, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(filled.table.forth.isEnabled, timeout=PATIENCE_MS)
    qtbot.mousePress(filled.table.forth, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: rate_of(served) > 9.9, timeout=PATIENCE_MS)
    qtbot.wait(800)  # longer than a button that nobody hears of counts as held
    assert rate_of(served) > 9.9
    qtbot.mouseRelease(filled.table.forth, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: rate_of(served) < 0.05, timeout=PATIENCE_MS)


def test_another_page_in_front_lets_the_button_go(
    filled: InstrumentsPage, screens: Screens, served: ServedBench, qtbot: QtBot
) -> None:
    connect(filled, qtbot, "table")
    qtbot.mouseClick(filled.table.drive, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(filled.table.back.isEnabled, timeout=PATIENCE_MS)
    qtbot.mousePress(filled.table.back, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: rate_of(served) > 9.9, timeout=PATIENCE_MS)
    screens.window.show_page("start")
    assert not filled.table.back.held
    qtbot.waitUntil(lambda: rate_of(served) < 0.05, timeout=PATIENCE_MS)


def test_stop_stops_the_table_and_switches_the_supply_off(
    filled: InstrumentsPage, screens: Screens, served: ServedBench, qtbot: QtBot
) -> None:
    connect(filled, qtbot, "table", "supply")
    qtbot.mouseClick(filled.supply.on, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(filled.table.drive, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(filled.table.forth.isEnabled, timeout=PATIENCE_MS)
    supply = served.served.world.supply
    qtbot.waitUntil(lambda: supply.read().output_on, timeout=PATIENCE_MS)
    qtbot.mousePress(filled.table.forth, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: rate_of(served) > 9.9, timeout=PATIENCE_MS)
    bar = screens.window.findChild(StopBar)
    assert bar is not None
    assert bar.run_is_live()
    qtbot.mouseClick(bar.button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not supply.read().output_on, timeout=PATIENCE_MS)
    assert rate_of(served) < 0.1
    qtbot.mouseRelease(filled.table.forth, Qt.MouseButton.LeftButton)
    assert "nothing to stop" not in bar.hint.text()


def test_a_rate_beyond_the_limit_by_hand_is_told_and_does_nothing(
    filled: InstrumentsPage, served: ServedBench, qtbot: QtBot
) -> None:
    connect(filled, qtbot, "table")
    qtbot.mouseClick(filled.table.drive, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(filled.table.forth.isEnabled, timeout=PATIENCE_MS)
    filled.table.jog_rate.set_text("300")
    qtbot.mousePress(filled.table.forth, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "300" in filled.trouble.text(), timeout=PATIENCE_MS)
    qtbot.mouseRelease(filled.table.forth, Qt.MouseButton.LeftButton)
    assert rate_of(served) == 0.0


def test_a_run_that_begins_gets_the_wires(filled: InstrumentsPage, qtbot: QtBot) -> None:
    connect(filled, qtbot, "table")
    filled.workspace.run_starting.emit()
    assert filled.session.desk is None
    assert filled.rows["table"].state_text() == "not connected"


def test_an_instrument_is_added_changed_and_removed(page: InstrumentsPage, qtbot: QtBot) -> None:
    page.benches.save("New", {})
    page.refresh()
    assert page.rows["table"].action.text() == "Add …"
    dialog = InstrumentDialog(page.benches, "table", None, page)
    qtbot.addWidget(dialog)
    dialog.driver.set_key("acutrol")
    dialog._driver_chosen()
    dialog.answered()
    assert dialog.refusal()  # neither serial port nor address
    fields = {field.path: editor for field, editor in dialog._fields}
    values = {"link.host": "10.0.0.9", "limits.max_rate_dps": "120", "limits.max_acceleration_dps2": "60"}
    for path, text in values.items():
        editor = fields[path]
        assert isinstance(editor, TextField)
        editor.set_text(text)
    dialog.answered()
    assert dialog.table == {
        "driver": "acutrol",
        "link": {"host": "10.0.0.9"},
        "limits": {"max_rate_dps": 120.0, "max_acceleration_dps2": 60.0},
    }
    page.save_instrument("table", {"driver": "acutrol", "link": {"host": "10.0.0.9"}})
    assert page.benches.load("New")["table"]["link"]["host"] == "10.0.0.9"
    again = InstrumentDialog(page.benches, "table", page.session.bench["table"], page)
    qtbot.addWidget(again)
    again._remove()
    page.save_instrument("table", again.table)
    assert "table" not in page.benches.load("New")


def test_a_bench_gets_a_name_of_its_own(page: InstrumentsPage, qtbot: QtBot) -> None:
    dialog = NameDialog(page.benches, page)
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.name.set_text("../evil")
    dialog.answered()
    assert dialog.refusal()
    dialog.name.set_text("Hall 3")
    dialog.answered()
    assert page.benches.names() == ("Hall 3",)


def with_language(page: InstrumentsPage) -> None:
    template = table_languages()["example-servo"]
    page.benches.save(
        "Ascii", {"table": {"driver": "ascii", "link": {"host": "h", "port": 1}, "template": template}}
    )
    page.refresh()
    page.choose("table")
    page.tabs.setCurrentIndex(1)


def test_the_language_of_a_table_is_edited_and_checked(page: InstrumentsPage, qtbot: QtBot) -> None:
    with_language(page)
    assert page.language.texts["enable"].text() == "RESET | SERVO ON"
    page.language.texts["rate"].setText("JOG {speed}")
    qtbot.mouseClick(page.language.save, Qt.MouseButton.LeftButton)
    assert "speed" in page.language.refusal.text()
    page.language.texts["rate"].setText("VEL {rate:.2f} | GO")
    with qtbot.waitSignal(page.language.changed):
        qtbot.mouseClick(page.language.save, Qt.MouseButton.LeftButton)
    saved = page.benches.load("Ascii")["table"]["template"]
    assert saved["commands"]["rate"] == ["VEL {rate:.2f}", "GO"]
    assert saved["commands"]["position"] == ["SPEED {rate:.4f}", "MOVE {angle:.4f}"]


@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_text_is_cut_and_none_is_in_the_other_language(
    filled: InstrumentsPage,
    screens: Screens,
    qtbot: QtBot,
    chinese: Callable[[], None],
    language: str,
) -> None:
    if language == "zh":
        chinese()
    filled.refresh()
    sources = own_sources() if language == "zh" else set()
    faults: dict[tuple[str, str], list[str]] = {}
    modes: tuple[ThemeMode, ...] = ("light", "dark")
    for mode in modes:
        screens.look.theme.set_mode(mode)
        for part in PARTS:
            filled.choose(part)
            screens.look.settle()
            faults[mode, part] = _faults(filled, screens, sources)
        with_language(filled)
        filled.bench.set_key("Ascii")
        filled._bench_chosen()
        filled.tabs.setCurrentIndex(1)
        screens.look.settle()
        faults[mode, "language"] = clipped_texts(filled)
        filled.bench.set_key("Served")
        filled._bench_chosen()
    assert {key: found for key, found in faults.items() if found} == {}


def _faults(page: InstrumentsPage, screens: Screens, sources: set[str]) -> list[str]:
    shown = [one.text() for one in page.findChildren(QLabel) if one.isVisibleTo(page)]
    shown += [one.text() for one in page.findChildren(QAbstractButton) if one.isVisibleTo(page)]
    return [
        *clipped_texts(page),
        *(f"outside: {text}" for text in outside(screens.window)),
        *(f"English: {text}" for text in shown if text in sources),
    ]


def own_sources() -> set[str]:
    root = ElementTree.parse(resource_path("translations/ahrs_lab_zh.ts")).getroot()
    pairs = [(m.findtext("source", ""), m.findtext("translation", "")) for m in root.iter("message")]
    return {source for source, chinese in pairs if source != chinese and re.search("[a-z] ", source)}
