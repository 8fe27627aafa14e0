"""Fixtures of every test: nothing a test starts may outlive it, and nothing it writes may leave its folder.

A thread, timer, animation or window that outlives its test does its damage in another one, where nobody looks
for it. So each test is asked at its end, and the one that left something behind fails.
"""

from __future__ import annotations

import gc
import os
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from PySide6.QtCore import QCoreApplication, QTimer

# Before anything imports Qt. A person who wants to watch sets QT_QPA_PLATFORM; the binding is not a choice.
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["QT_API"] = "pyside6"
os.environ["PYQTGRAPH_QT_LIB"] = "PySide6"

# A deadline measures the machine's load; a slow example is stopped by the test's own time limit.
settings.register_profile(
    "ahrs-lab",
    deadline=None,
    derandomize=bool(os.environ.get("CI")),
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("ahrs-lab")

THREAD_GRACE_S = 2.0
QT_GRACE_S = 0.5


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of references beside the repository: sample recordings, captures, schemas."""
    folder = Path(__file__).resolve().parents[2] / "shared"
    if not folder.is_dir():
        pytest.skip(f"the reference data are not here: {folder} does not exist")
    return folder


@pytest.fixture(autouse=True)
def isolated_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The application's data folder during a test, so that none ever reads or writes a person's records."""
    home = tmp_path / "ahrs-lab-home"
    monkeypatch.setenv("AHRS_LAB_HOME", str(home))
    return home


@pytest.fixture(autouse=True)
def no_thread_left() -> Iterator[None]:
    """Fail a test that leaves a thread running, daemon or not."""
    before = set(threading.enumerate())
    yield
    deadline = time.monotonic() + THREAD_GRACE_S
    left = [thread for thread in threading.enumerate() if thread not in before and is_python_thread(thread)]
    for thread in left:
        thread.join(max(0.0, deadline - time.monotonic()))
    left = [thread for thread in left if thread.is_alive()]
    if left:
        pytest.fail("the test left threads running: " + ", ".join(map(repr, left)), pytrace=False)


def is_python_thread(thread: threading.Thread) -> bool:
    """Whether Python started it. Foreign threads that once ran Python code stay listed after their end."""
    return not isinstance(thread, threading._DummyThread)


@pytest.fixture(autouse=True)
def nothing_of_qt_left() -> Iterator[None]:
    """Fail a test that leaves an active timer, a running animation or thread of Qt's, or a window behind."""
    before = qt_left_behind()
    yield
    left = settled_qt(before)
    if left:
        pytest.fail("the test left behind: " + "; ".join(left.values()), pytrace=False)


def settled_qt(before: dict[int, str]) -> dict[int, str]:
    """What Qt still has running or open after deferred deletions, garbage collection and a short grace."""
    app = qt_application()
    if app is None:
        return {}
    from PySide6.QtCore import QEvent

    deadline = time.monotonic() + QT_GRACE_S
    collected = False
    while True:
        app.processEvents()
        app.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        left = {key: what for key, what in qt_left_behind().items() if key not in before}
        if not left or (collected and time.monotonic() > deadline):
            return left
        # A window nobody refers to any more may be waiting for the collector in a reference cycle.
        if not collected:
            gc.collect()
            collected = True
        time.sleep(0.005)


def qt_application() -> QCoreApplication | None:
    """The running Qt application, without bringing Qt into tests that do not use it."""
    widgets = sys.modules.get("PySide6.QtWidgets")
    return None if widgets is None else widgets.QApplication.instance()


def qt_left_behind() -> dict[int, str]:
    """Address and description of every active timer, running animation or thread, and window there is."""
    app = qt_application()
    if app is None:
        return {}
    from PySide6.QtCore import QAbstractAnimation, QThread, QTimer
    from PySide6.QtWidgets import QApplication
    from shiboken6 import Shiboken

    left: dict[int, str] = {}
    for wrapper in Shiboken.getAllValidWrappers():
        if (
            (isinstance(wrapper, QTimer) and will_call_somebody(wrapper))
            or (isinstance(wrapper, QAbstractAnimation) and wrapper.state() != wrapper.State.Stopped)
            or (isinstance(wrapper, QThread) and wrapper.isRunning() and wrapper is not app.thread())
        ):
            left[Shiboken.getCppPointer(wrapper)[0]] = f"running {wrapper!r}"
    if isinstance(app, QApplication):
        for widget in QApplication.topLevelWidgets():
            # Pop-ups of combo boxes and menus are windows too; they go with the widget they belong to.
            if widget.parent() is None:
                left[Shiboken.getCppPointer(widget)[0]] = f"window {widget!r} titled {widget.windowTitle()!r}"
    return left


def will_call_somebody(timer: QTimer) -> bool:
    """Whether the timer is active and not merely what is left of a `QTimer.singleShot` to a deleted object.

    PySide keeps such a timer, which nobody owns, until its time; then only its own deletion listens to it.
    """
    from PySide6.QtCore import SIGNAL
    from shiboken6 import Shiboken

    if timer.isSingleShot() and timer.parent() is None and not Shiboken.ownedByPython(timer):
        return timer.isActive() and timer.receivers(SIGNAL("timeout()")) > 1
    return timer.isActive()
