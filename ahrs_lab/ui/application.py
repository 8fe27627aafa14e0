"""The application: one event loop around one window, and what has to hold while it runs.

The window opens with its first page alone, so that it is there within 1.5 s; the other pages are made when
they are asked for, or while nobody asks for anything.
"""

from __future__ import annotations

import gc
import logging
import sys
import traceback
from collections.abc import Callable
from logging.handlers import RotatingFileHandler
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QApplication, QMessageBox, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.ui.theme import ThemeSwitch
from ahrs_lab.ui.translation import LanguageSwitch, said

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory
    from ahrs_lab.records.rows import SignedIn
    from ahrs_lab.ui.main_window import MainWindow
    from ahrs_lab.ui.pages.desk import Desk
    from ahrs_lab.ui.workspace import Workspace

COLLECT_MS = 5000
LOG_BYTES = 1_000_000

log = logging.getLogger("ahrs_lab")


def run_application(
    laboratory: Laboratory,
    *,
    language: str | None = None,
    speed: float | None = 1.0,
    demo: bool = False,
    operator: SignedIn | None = None,
) -> int:
    """Open the window on ``laboratory`` and stay until it is closed; returns the exit code.

    ``language`` ("en", "zh") overrides what the person chose last; ``speed`` is bench time over wall time
    of a simulated bench, None: as fast as it goes; ``demo`` marks all pages and signs the demonstration's
    operator in, unless ``operator`` is signed in already.
    """
    existing = QApplication.instance()
    app = existing if isinstance(existing, QApplication) else QApplication(sys.argv[:1])
    app.setApplicationName("ahrs-lab")
    log_to(laboratory.home / "ahrs-lab.log")
    keeper = FaultKeeper(app)
    screen = Screen(app, laboratory, language=language, speed=speed, demo=demo, operator=operator)
    keeper.parent_window = screen.window
    screen.window.show()
    collector = GuiCollector(app)
    screen.window.make_pages_when_idle()
    try:
        return app.exec()
    finally:
        collector.stop()
        screen.close()
        keeper.restore()


class Screen:
    """The window with its pages, and the switches of theme and language; tests make one without an event
    loop."""

    def __init__(
        self,
        app: QApplication,
        laboratory: Laboratory,
        *,
        language: str | None = None,
        speed: float | None = 1.0,
        demo: bool = False,
        operator: SignedIn | None = None,
    ) -> None:
        settings = laboratory.settings
        self._laboratory = laboratory
        self.theme = ThemeSwitch(app, settings.theme)
        self.language = LanguageSwitch(app, "zh" if (language or settings.language) == "zh" else "en")
        from ahrs_lab.ui.main_window import MainWindow
        from ahrs_lab.ui.pages.all_pages import page_entries
        from ahrs_lab.ui.pages.desk import Desk
        from ahrs_lab.ui.workspace import Workspace

        self.workspace: Workspace = Workspace(laboratory, settings, speed=speed)
        self.desk: Desk = Desk(self.workspace, self.workspace)
        self.window: MainWindow = MainWindow(self.workspace, theme=settings.theme)
        for entry in page_entries(self.desk):
            self.window.add_entry(entry)
        for chooser in (self.window.context, self.workspace):
            chooser.theme_chosen.connect(self.choose_theme)
            chooser.language_chosen.connect(self.choose_language)
        self.window.context.set_demonstration(demo)
        if demo and operator is None:
            operator = laboratory.open_demo()
        if operator is not None:
            self.desk.sign_in(operator)

    def choose_theme(self, mode: str) -> None:
        """Switch and remember."""
        if mode in ("light", "dark", "system"):
            self.theme.set_mode(mode)  # type: ignore[arg-type]
            self._laboratory.settings.theme = mode  # type: ignore[assignment]
            self.window.context.set_theme(mode)
            self._remember()

    def choose_language(self, language: str) -> None:
        """Switch and remember."""
        if language in ("en", "zh"):
            self.language.set_language(language)  # type: ignore[arg-type]
            self._laboratory.settings.language = language  # type: ignore[assignment]
            self._remember()

    def _remember(self) -> None:
        try:
            self._laboratory.settings.save()
        except OSError:
            log.warning("the settings of the screen were not kept", exc_info=True)

    def close(self) -> None:
        """Nothing of the screen works on after this."""
        self.workspace.run.close()
        self.workspace.closing.emit()
        self.desk.close()


class GuiCollector(QObject):
    """Garbage is collected in the GUI thread only.

    Python may collect in whichever thread allocates; in a run's thread it would delete Qt objects there and
    crash.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        gc.collect()
        gc.freeze()
        gc.disable()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._collect)
        self._timer.start(COLLECT_MS)

    def _collect(self) -> None:
        gc.collect(1)

    def stop(self) -> None:
        """Python collects by itself again."""
        self._timer.stop()
        gc.unfreeze()
        gc.enable()


class FaultKeeper(QObject):
    """Faults that nobody caught: logged, and shown with their details, instead of ending the application."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.parent_window: QWidget | None = None
        self._before: Callable[..., object] = sys.excepthook
        self._open = False
        sys.excepthook = self.caught

    def restore(self) -> None:
        """As it was before."""
        sys.excepthook = self._before

    def caught(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            QApplication.quit()
            return
        log.error("not caught", exc_info=(kind, error, trace))
        # One at a time: a fault in a timer comes thirty times a second.
        if self._open:
            return
        self._open = True
        try:
            self.dialog(error, "".join(traceback.format_exception(kind, error, trace))).exec()
        finally:
            self._open = False

    def dialog(self, error: BaseException, details: str) -> QMessageBox:
        """The message for a person, with the traceback behind a button."""
        box = QMessageBox(self.parent_window)
        box.setIcon(QMessageBox.Icon.Critical)
        if isinstance(error, AhrsLabError):
            box.setWindowTitle(self.tr("That did not work"))
            box.setText(said(error.message))
        else:
            box.setWindowTitle(self.tr("A fault of the application"))
            box.setText(
                self.tr(
                    "Something went wrong that should not. A run that is going on is not "
                    "touched by it, and what "
                    "is recorded is on disk."
                )
            )
            box.setInformativeText(self.tr("The details are in the log; please pass them on."))
        box.setDetailedText(details)
        return box


def log_to(path: Path) -> None:
    """Warnings and worse go to ``path`` too; a folder that cannot be written is not a reason to stay
    closed."""
    if any(isinstance(handler, RotatingFileHandler) for handler in log.handlers):
        return
    try:
        handler = RotatingFileHandler(path, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8", delay=True)
    except OSError:
        return
    handler.setLevel(logging.WARNING)
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    log.addHandler(handler)
