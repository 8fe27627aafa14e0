"""The application around its window: choices are remembered, faults are shown and logged, garbage is
collected in one thread."""

from __future__ import annotations

import gc
import logging
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QMessageBox

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.laboratory.settings import Settings
from ahrs_lab.ui.application import FaultKeeper, GuiCollector, Screen, log_to, run_application
from ahrs_lab.ui.theme import ThemeSwitch
from ahrs_lab.ui.translation import LanguageSwitch
from tests.ui.conftest import Look


@pytest.fixture
def laboratory(tmp_path: Path) -> Iterator[Laboratory]:
    home = tmp_path / "home"
    home.mkdir()
    with Laboratory(home) as made:
        made.prepare_demo()
        yield made


@pytest.fixture
def keeper(look: Look) -> Iterator[FaultKeeper]:
    made = FaultKeeper(look.app)
    yield made
    made.restore()
    made.deleteLater()


@pytest.fixture(autouse=True)
def own_log() -> Iterator[None]:
    yield
    for handler in logging.getLogger("ahrs_lab").handlers[:]:
        logging.getLogger("ahrs_lab").removeHandler(handler)
        handler.close()


def close(look: Look, screen: Screen) -> None:
    screen.close()
    screen.window.close()
    screen.window.deleteLater()
    for switch in (screen.theme, screen.language):
        switch.deleteLater()
    look.settle()


def test_choices_of_the_person_are_remembered(look: Look, laboratory: Laboratory) -> None:
    screen = Screen(look.app, laboratory, demo=True)
    screen.choose_theme("dark")
    screen.choose_language("zh")
    screen.choose_theme("no such theme")
    kept = Settings.load(laboratory.home / "settings.toml")
    assert (kept.theme, kept.language) == ("dark", "zh")
    screen.choose_language("en")
    close(look, screen)


def test_demonstration_has_every_page_and_its_operator_signed_in(look: Look, laboratory: Laboratory) -> None:
    screen = Screen(look.app, laboratory, demo=True)
    keys = ["start", "jobs", "run", "results", "certificate", "analyse", "bench", "instruments", "setup"]
    assert list(screen.window.rail.buttons) == keys
    assert list(screen.window.pages) == ["start"]
    screen.window.make_all_pages()
    assert list(screen.window.pages) == keys
    assert screen.window.context.person() == "Demo operator"
    close(look, screen)


def test_application_opens_its_window_and_ends_with_it(look: Look, laboratory: Laboratory) -> None:
    seen: list[str] = []

    def look_and_close() -> None:
        window = next(w for w in look.app.topLevelWidgets() if w.windowTitle().startswith("AHRS Lab"))
        seen.append(window.windowTitle())
        assert not gc.isenabled()
        window.close()

    timer = QTimer()
    timer.setSingleShot(True)
    timer.timeout.connect(look_and_close)
    timer.start(50)
    assert run_application(laboratory, language="en", speed=None, demo=True) == 0
    assert len(seen) == 1
    assert gc.isenabled()
    for kind in (FaultKeeper, GuiCollector, ThemeSwitch, LanguageSwitch):
        for left in look.app.findChildren(kind):
            if left not in (look.theme, look.language):
                left.deleteLater()


def test_garbage_is_collected_by_the_screen_only(look: Look) -> None:
    owner = QObject()
    collector = GuiCollector(owner)
    assert not gc.isenabled()
    collector.stop()
    assert gc.isenabled()


def test_unexpected_fault_is_shown_with_its_details_and_logged(
    keeper: FaultKeeper, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    shown: list[QMessageBox] = []

    def answer(box: QMessageBox) -> int:
        shown.append(box)
        return 0

    monkeypatch.setattr(QMessageBox, "exec", answer)
    error = ValueError("a defect")
    with caplog.at_level(logging.ERROR):
        keeper.caught(ValueError, error, None)
    assert "ValueError: a defect" in shown[0].detailedText()
    assert "defect" not in shown[0].text()
    assert "not caught" in caplog.text
    shown[0].deleteLater()


def test_error_made_for_a_person_is_shown_in_its_own_words(
    keeper: FaultKeeper, monkeypatch: pytest.MonkeyPatch
) -> None:
    box = keeper.dialog(InputError("The folder {path} is in use.", path="x"), "details")
    assert box.text() == "The folder x is in use."
    box.deleteLater()


def test_warnings_go_to_the_log_file(tmp_path: Path) -> None:
    log_to(tmp_path / "ahrs-lab.log")
    logging.getLogger("ahrs_lab").warning("something odd")
    assert "something odd" in (tmp_path / "ahrs-lab.log").read_text(encoding="utf-8")
