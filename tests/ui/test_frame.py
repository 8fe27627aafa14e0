"""The frame around every page: navigation, language, theme, STOP, closing."""

from __future__ import annotations

import sys
from functools import partial

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog, QMessageBox
from pytestqt.qtbot import QtBot

from ahrs_lab.messages import Message
from ahrs_lab.ui.main_window import IDLE_MS, MainWindow
from ahrs_lab.ui.page import Page, PageEntry
from ahrs_lab.ui.workspace import Worker, Workspace
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.conftest import Look, plain_page
from tests.ui.scripted_run import scripted


def test_rail_brings_pages_to_the_front(window: MainWindow, qtbot: QtBot) -> None:
    for key in window.pages:
        qtbot.mouseClick(window.rail.buttons[key], Qt.MouseButton.LeftButton)
        assert window.current_page() == key
        assert [k for k, button in window.rail.buttons.items() if button.isChecked()] == [key]


def test_page_is_asked_for_by_its_key_and_an_unknown_one_changes_nothing(window: MainWindow) -> None:
    window.workspace.go_to("bench")
    assert window.current_page() == "bench"
    window.workspace.go_to("analyse")
    assert window.current_page() == "bench"


def test_language_switches_every_text_and_back(window: MainWindow, look: Look) -> None:
    english = window.stop_bar.button.text()
    look.language.set_language("zh")
    look.settle()
    assert "停止" in window.stop_bar.button.text()
    assert window.rail.buttons["run"].text() == "运行"
    assert window.context.language.current() == "zh"
    look.language.set_language("en")
    look.settle()
    assert window.stop_bar.button.text() == english
    assert window.rail.buttons["run"].text() == "Run"


def test_person_is_named_in_the_language_of_the_screen(window: MainWindow, look: Look) -> None:
    assert window.context.person() == "Demo operator"
    look.language.set_language("zh")
    look.settle()
    assert window.context.person() == "演示校准员"
    window.workspace.set_worker(Worker("2", "张三"))
    look.language.set_language("en")
    look.settle()
    assert window.context.person() == "张三"


def test_language_and_theme_are_asked_for_in_the_context_bar(window: MainWindow, qtbot: QtBot) -> None:
    with qtbot.waitSignal(window.context.language_chosen) as language:
        qtbot.mouseClick(window.context.language.button("zh"), Qt.MouseButton.LeftButton)
    assert language.args == ["zh"]
    with qtbot.waitSignal(window.context.theme_chosen) as theme:
        window.context.theme_action("dark").trigger()
    assert theme.args == ["dark"]


@pytest.mark.parametrize("mode", ["light", "dark"])
def test_theme_reaches_the_window(window: MainWindow, look: Look, mode: str) -> None:
    look.theme.set_mode(mode)  # type: ignore[arg-type]
    look.settle()
    picture = window.grab().toImage()
    corner = picture.pixelColor(picture.width() - 4, picture.height() // 2)
    assert (corner.lightness() < 60) == (mode == "dark")


def test_stop_is_never_disabled_and_says_when_there_is_nothing_to_stop(
    window: MainWindow, qtbot: QtBot, look: Look
) -> None:
    for key in window.pages:
        window.workspace.go_to(key)
        assert window.stop_bar.button.isEnabled()
        assert window.stop_bar.button.isVisible()
    qtbot.mouseClick(window.stop_bar.button, Qt.MouseButton.LeftButton)
    assert "nothing to stop" in window.stop_bar.hint.text()


@pytest.mark.parametrize("key", ["start", "run", "setup"])
def test_escape_stops_the_run_from_every_page(window: MainWindow, key: str, qtbot: QtBot) -> None:
    run = scripted(window.workspace.run)
    window.workspace.go_to(key)
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    assert run.calls == ["start", "abort"]


def test_stop_works_before_the_first_news_of_a_run_has_been_read(window: MainWindow, qtbot: QtBot) -> None:
    run = scripted(window.workspace.run)
    qtbot.mouseClick(window.stop_bar.button, Qt.MouseButton.LeftButton)
    assert run.calls == ["start", "abort"]


def test_escape_in_a_modal_dialog_stops_the_run_and_leaves_the_dialog_open(
    window: MainWindow, look: Look, qtbot: QtBot
) -> None:
    run = scripted(window.workspace.run)
    dialog = QDialog(window)
    dialog.setModal(True)
    dialog.open()
    qtbot.waitUntil(lambda: look.app.focusWindow() is dialog.windowHandle())
    QTest.keyClick(dialog.windowHandle(), Qt.Key.Key_Escape)
    assert run.calls == ["start", "abort"]
    assert dialog.isVisible()
    window.workspace.run.poll()
    QTest.keyClick(dialog.windowHandle(), Qt.Key.Key_Escape)
    assert not dialog.isVisible()
    dialog.deleteLater()


def test_notice_is_shown_over_the_page_until_it_is_closed(window: MainWindow, look: Look) -> None:
    window.workspace.notice("bad", Message("The disk is full."))
    look.settle()
    assert window.notice.isVisible()
    assert window.notice.text() == "The disk is full."
    window.notice.close_button.click()
    assert not window.notice.isVisible()


def test_rail_marks_a_run_that_is_going_on(window: MainWindow) -> None:
    run = scripted(window.workspace.run)
    assert window.rail.buttons["run"].marked
    run.finish("done")
    window.workspace.run.poll()
    assert not window.rail.buttons["run"].marked


def test_health_strip_follows_the_bench(window: MainWindow, look: Look) -> None:
    run = scripted(window.workspace.run)
    run.powered = True
    run.stream(1.0)
    window.workspace.run.poll()
    look.settle()
    dots = window.health.dots
    assert (dots["table"].state(), dots["table"].text()) == ("good", "table ready")
    assert (dots["ahrs"].state(), dots["ahrs"].text()) == ("good", "AHRS 100.0 Hz, 0 lost")
    assert dots["supply"].text() == "supply 12.00 V  0.142 A"
    assert dots["room"].state() == "good"
    run.finish("done")
    window.workspace.run.poll()
    assert dots["idle"].isVisible()
    assert not dots["supply"].isVisible()


@pytest.mark.parametrize("stay", [True, False])
def test_closing_while_a_run_is_going_on_asks_first(
    window: MainWindow, monkeypatch: pytest.MonkeyPatch, stay: bool
) -> None:
    run = scripted(window.workspace.run)

    def answer(box: QMessageBox) -> int:
        wanted = QMessageBox.ButtonRole.RejectRole if stay else QMessageBox.ButtonRole.DestructiveRole
        next(button for button in box.buttons() if box.buttonRole(button) == wanted).click()
        return 0

    monkeypatch.setattr(QMessageBox, "exec", answer)
    assert window.close() is not stay
    assert run.calls == (["start"] if stay else ["start", "abort"])


def test_a_page_that_cannot_be_made_keeps_no_other_from_being_made(
    workspace: Workspace, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    monkeypatch.setattr(sys, "excepthook", lambda _kind, error, _trace: told.append(str(error)))
    tries: list[str] = []

    def broken() -> Page:
        tries.append("bench")
        if len(tries) < 3:
            raise RuntimeError("broken")
        return plain_page(workspace, "bench")

    made = MainWindow(workspace, theme="light")
    qtbot.addWidget(made)
    for key in ("start", "jobs", "setup"):
        made.add_entry(PageEntry(key, partial(plain_page, workspace, key)))
    made.add_entry(PageEntry("bench", broken))
    made.add_entry(PageEntry("results", partial(plain_page, workspace, "results")))
    assert list(made.pages) == ["start"]
    made.make_all_pages()
    assert list(made.pages) == ["start", "jobs", "setup", "results"]
    made.make_all_pages()
    assert not made.make_next_page()
    # Told once, not with every tick of the idle timer; asked for, it is tried again.
    assert (tries, told) == (["bench"], ["broken"])
    with pytest.raises(RuntimeError):
        made.show_page("bench")
    assert made.current_page() == "start"
    made.show_page("bench")
    assert made.current_page() == "bench"


def test_closing_the_window_ends_the_making_of_pages(workspace: Workspace, qtbot: QtBot) -> None:
    made = MainWindow(workspace, theme="light")
    qtbot.addWidget(made)
    for key in ("start", "jobs", "setup"):
        made.add_entry(PageEntry(key, partial(plain_page, workspace, key)))
    made.show()
    made.make_pages_when_idle()
    qtbot.waitUntil(lambda: len(made.pages) == 2)
    made.close()
    qtbot.wait(3 * IDLE_MS)
    assert list(made.pages) == ["start", "jobs"]


def test_closing_without_a_run_does_not_ask(window: MainWindow) -> None:
    assert window.close()


@pytest.mark.parametrize("language", ["en", "zh"])
def test_nothing_of_the_frame_is_cut(window: MainWindow, look: Look, language: str) -> None:
    look.language.set_language(language)  # type: ignore[arg-type]
    window.workspace.notice("warn", Message("The table trips at {rate_dps} °/s", rate_dps=120))
    look.settle()
    assert clipped_texts(window) == []
    assert outside(window) == []


def test_cut_text_is_found() -> None:
    from ahrs_lab.ui.widgets import Label

    window = Label()
    inner = Label("a text that needs more room than there is")
    inner.setParent(window)
    inner.resize(20, 20)
    window.resize(300, 100)
    window.show()
    assert len(clipped_texts(window)) == 1
    window.close()
    window.deleteLater()
