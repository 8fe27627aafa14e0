"""The page Start: who has to act, and where its buttons lead."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot

from ahrs_lab.ui.widgets import Label
from tests.ui.pages.conftest import Screens


def press(screens: Screens, qtbot: QtBot, text: str) -> None:
    screens.settle(qtbot)
    button = next(b for b in screens.start.findChildren(QPushButton) if b.text() == text and b.isVisible())
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    screens.settle(qtbot)


def test_each_job_stands_in_its_column(screens: Screens, qtbot: QtBot) -> None:
    shown = {label.text() for label in screens.start.findChildren(Label) if label.isVisible()}
    assert {screens.number(state) for state in ("draft", "ready", "measured", "checked")} <= shown


def test_the_buttons_lead_to_the_job_and_its_page(screens: Screens, qtbot: QtBot) -> None:
    for text, state, page in (
        ("Complete the job", "draft", "jobs"),
        ("Look at the result", "measured", "results"),
        ("Approve", "checked", "certificate"),
    ):
        screens.window.show_page("start")
        press(screens, qtbot, text)
        assert screens.window.current_page() == page
        assert screens.desk.number == screens.number(state)


def test_new_job_opens_an_empty_editor(screens: Screens, qtbot: QtBot) -> None:
    press(screens, qtbot, "New job")
    assert screens.window.current_page() == "jobs"
    assert screens.jobs.editor.number() == ""
    assert screens.window.focusWidget() is screens.jobs.editor.order.customer.line
