"""Every page at 1366×768 in both languages and looks: nothing is cut off, nothing out of reach, nothing in
English on a Chinese screen."""

from __future__ import annotations

from collections.abc import Callable
from xml.etree import ElementTree

import pytest
from PySide6.QtWidgets import QAbstractButton, QLabel
from pytestqt.qtbot import QtBot

from ahrs_lab.resource_files import resource_path
from ahrs_lab.ui.theme import ThemeMode
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.pages.conftest import Screens

PAGES = ("start", "jobs", "results", "certificate", "bench", "setup")


def scenes(screens: Screens) -> dict[str, Callable[[], None]]:
    """Name and how to bring it to the front."""
    s, editor = screens, screens.jobs.editor

    def job(state: str, page: str, then: Callable[[], None] = lambda: None) -> Callable[[], None]:
        def go() -> None:
            s.desk.open(s.number(state), page)
            then()

        return go

    def tab(tabs: object, number: int) -> Callable[[], None]:
        return lambda: tabs.setCurrentIndex(number)  # type: ignore[attr-defined]

    def diagnosis(key: str) -> Callable[[], None]:
        def go() -> None:
            s.results.choose(key)
            s.results.tabs.setCurrentIndex(3)

        return go

    def show_list() -> None:
        s.window.show_page("jobs")
        s.jobs.show_list()

    def setup(number: int) -> Callable[[], None]:
        def go() -> None:
            s.window.show_page("setup")
            s.setup.tabs.setCurrentIndex(number)

        return go

    return {
        "start": lambda: s.window.show_page("start"),
        "order": job("draft", "jobs", tab(editor.tabs, 0)),
        "standards": job("draft", "jobs", tab(editor.tabs, 1)),
        "plan": job("draft", "jobs", tab(editor.tabs, 2)),
        "job's bench": job("draft", "jobs", tab(editor.tabs, 3)),
        "list": show_list,
        "plot K": job("measured", "results", lambda: s.results.choose("K.x")),
        "plot B": job("measured", "results", lambda: s.results.choose("B.y")),
        "plot L": job("measured", "results", lambda: s.results.choose("L.zy")),
        "values": job("measured", "results", tab(s.results.tabs, 1)),
        "budget": job("measured", "results", tab(s.results.tabs, 2)),
        "diagnosis K": job("measured", "results", diagnosis("K.x")),
        "diagnosis B": job("measured", "results", diagnosis("B.x")),
        "diagnosis L": job("measured", "results", diagnosis("L.yx")),
        "findings": job("measured", "results", tab(s.results.tabs, 4)),
        "certificate": job("measured", "certificate"),
        "signed": job("checked", "certificate"),
        "bench": job("ready", "bench"),
        **{f"setup {number}": setup(number) for number in range(4)},
    }


@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_text_is_cut_and_no_button_out_of_reach(
    screens: Screens, qtbot: QtBot, chinese: Callable[[], None], language: str
) -> None:
    if language == "zh":
        chinese()
    faults = {}
    for name, go in scenes(screens).items():
        go()
        screens.settle(qtbot)
        page = screens.window.stack.currentWidget()
        assert page is not None
        found = clipped_texts(page)
        if name != "signed":
            found += [f"outside: {text}" for text in outside(screens.window)]
        if found:
            faults[name] = found
    assert faults == {}


@pytest.mark.parametrize("language", ["en", "zh"])
def test_an_empty_laboratory_says_what_will_be_here(
    empty_screens: Screens, qtbot: QtBot, chinese: Callable[[], None], language: str
) -> None:
    if language == "zh":
        chinese()
    for key in ("start", "jobs", "results", "certificate"):
        empty_screens.window.show_page(key)
        empty_screens.settle(qtbot)
        page = empty_screens.window.stack.currentWidget()
        assert page is not None
        texts = [
            label.text() for label in page.findChildren(QLabel) if label.isVisibleTo(page) and label.text()
        ]
        actions = [b for b in page.findChildren(QAbstractButton) if b.isVisibleTo(page) and b.isEnabled()]
        assert len(texts) == 2, (key, texts)
        assert len(actions) == 1, key
        assert clipped_texts(page) == []


def test_every_theme_paints_every_page(screens: Screens, qtbot: QtBot) -> None:
    modes: tuple[tuple[ThemeMode, int, int], ...] = (("light", 256, 200), ("dark", 60, -1))
    for mode, lightest, darkest in modes:
        screens.look.theme.set_mode(mode)
        for name, go in scenes(screens).items():
            go()
            screens.settle(qtbot)
            picture = screens.window.grab().toImage()
            # A corner of the page is the page's own colour in either theme.
            assert lightest > picture.pixelColor(picture.width() - 4, 60).lightness() > darkest, (mode, name)


def test_the_chinese_screen_has_no_english_sentences(
    screens: Screens, qtbot: QtBot, chinese: Callable[[], None]
) -> None:
    chinese()
    sources = own_sources()
    for name, go in scenes(screens).items():
        go()
        screens.settle(qtbot)
        page = screens.window.stack.currentWidget()
        assert page is not None
        shown = [label.text() for label in page.findChildren(QLabel) if label.isVisibleTo(page)]
        shown += [button.text() for button in page.findChildren(QAbstractButton) if button.isVisibleTo(page)]
        assert [text for text in shown if text in sources] == [], name


def own_sources() -> set[str]:
    """English texts of the screens that have words, and another Chinese text."""
    root = ElementTree.parse(resource_path("translations/ahrs_lab_zh.ts")).getroot()
    pairs = [(m.findtext("source", ""), m.findtext("translation", "")) for m in root.iter("message")]
    assert len(pairs) > 400
    return {source for source, translation in pairs if source != translation and " " in source}


def test_the_language_changes_while_the_pages_are_there(
    screens: Screens, qtbot: QtBot, chinese: Callable[[], None]
) -> None:
    screens.desk.open(screens.number("measured"), "results")
    before = screens.results.tabs.tabText(2)
    chinese()
    assert before == "Uncertainty budget"
    assert "不确定度" in screens.results.tabs.tabText(2)
    assert screens.window.rail.buttons["start"].text() == "首页"
