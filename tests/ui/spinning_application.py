"""The application that will be killed: ``python spinning_application.py`` opens the real one with the
demonstration's operator signed in, and a hand on its screen that connects the table of the first bench,
switches its drive on and holds a button; prints ``spinning`` and the supervisor's process number once the
screen shows that it turns.

Anything that is not there in time ends it with a traceback.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Iterator
from typing import TypeVar

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from ahrs_lab.cli import main

LOOK_MS = 50
LOOKS = 800
RATE_DPS = 20.0

_W = TypeVar("_W", bound=QWidget)


class Hand:
    """Goes on with ``steps`` at every look; each gives what has to be true before the next."""

    def __init__(self, app: QApplication) -> None:
        self._steps = spin()
        self._condition: Callable[[], bool] = lambda: True
        self._looks = 0
        self.timer = QTimer(app)
        self.timer.timeout.connect(self.look)
        self.timer.start(LOOK_MS)

    def look(self) -> None:
        try:
            self._looks += 1
            if self._looks > LOOKS:
                raise TimeoutError("the screen has not come that far")
            if self._condition():
                self._condition = next(self._steps)
                self._looks = 0
        except StopIteration:
            self.timer.stop()
        except Exception:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)


def found(kind: type[_W]) -> _W | None:
    """The first of its kind in the windows there are."""
    for window in QApplication.topLevelWidgets():
        widget = window if isinstance(window, kind) else window.findChild(kind)
        if widget is not None:
            return widget
    return None


def spin() -> Iterator[Callable[[], bool]]:
    """The steps of the hand."""
    from ahrs_lab.ui.main_window import MainWindow
    from ahrs_lab.ui.pages.instruments.page import InstrumentsPage

    yield lambda: found(MainWindow) is not None
    window = found(MainWindow)
    assert window is not None
    yield window.isVisible
    window.activateWindow()
    window.show_page("instruments")
    page = found(InstrumentsPage)
    assert page is not None
    yield lambda: page.isVisible() and page.rows["table"].there
    left = Qt.MouseButton.LeftButton
    QTest.mouseClick(page.rows["table"].action, left)
    yield lambda: page.rows["table"].state_text() == "connected"
    assert page.session.desk is not None
    supervisor = page.session.desk._supervisor
    assert supervisor is not None
    QTest.mouseClick(page.table.drive, left)
    yield page.table.forth.isEnabled
    page.table.jog_rate.set_text(str(RATE_DPS))
    QTest.mousePress(page.table.forth, left)
    yield (
        lambda: page.table.rate.value() not in ("", "–") and float(page.table.rate.value()) > 0.95 * RATE_DPS
    )
    print("spinning", supervisor.process_id, flush=True)


if __name__ == "__main__":
    application = QApplication(sys.argv[:1])
    hand = Hand(application)
    sys.exit(main(["demo", "--language", "en"]))
