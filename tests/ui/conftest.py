"""Fixtures of the screens: one look for all tests, a workspace without a laboratory, the window."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

import translations
from ahrs_lab.laboratory.settings import Settings
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.run.page import RunPage
from ahrs_lab.ui.theme import ThemeSwitch
from ahrs_lab.ui.translation import LanguageSwitch
from ahrs_lab.ui.workspace import OpenJob, Worker, Workspace


@dataclass
class Look:
    """The application's two switches."""

    app: QApplication
    theme: ThemeSwitch
    language: LanguageSwitch

    def settle(self) -> None:
        """Let Qt do what it has put off."""
        for _ in range(4):
            self.app.processEvents()


@pytest.fixture(scope="session")
def one_look(qapp: QApplication) -> Look:
    """Theme and language are the application's, and there is one application for all tests."""
    if translations.stale():
        translations.compile_all()
    return Look(qapp, ThemeSwitch(qapp, "light"), LanguageSwitch(qapp, "en"))


@pytest.fixture
def look(one_look: Look) -> Iterator[Look]:
    """Light and English; whatever a test switches is switched back."""
    yield one_look
    one_look.theme.set_mode("light")
    one_look.language.set_language("en")


@pytest.fixture
def workspace(look: Look, tmp_path: Path) -> Iterator[Workspace]:
    """Without a laboratory; a run that a test leaves is closed."""
    made = Workspace(None, Settings(tmp_path / "settings.toml"), speed=20.0)
    yield made
    made.run.close(0.0)
    made.deleteLater()


def close_run(workspace: Workspace) -> None:
    """Whatever a test has left going on."""
    workspace.run.close(0.0)


def plain_page(workspace: Workspace, key: str) -> Page:
    """A page that only has its place in the rail."""
    made = type("PlainPage_" + key, (Page,), {"key": key})(workspace)
    assert isinstance(made, Page)
    return made


@pytest.fixture
def window(look: Look, workspace: Workspace, qtbot: QtBot) -> MainWindow:
    """At 1366×768 with the run page in front."""
    made = MainWindow(workspace, theme="light")
    # A window whose run is going on would ask before it closes.
    qtbot.addWidget(made, before_close_func=lambda _: close_run(workspace))
    for key in ("start", "jobs", "run", "results", "certificate", "bench", "setup"):
        made.add_page(RunPage(workspace) if key == "run" else plain_page(workspace, key))
    workspace.open_job(OpenJob("1", "2026-0142", "VN-100", "0100012345", "Demonstration customer"))
    workspace.set_worker(Worker("1", "演示校准员", "Demo operator"))
    made.context.set_demonstration(True)
    made.resize(1366, 768)
    made.show()
    workspace.go_to("run")
    look.settle()
    return made


@pytest.fixture
def run_page(window: MainWindow) -> RunPage:
    """The run page in its window."""
    page = window.pages["run"]
    assert isinstance(page, RunPage)
    return page
