"""The guards of tests/conftest.py: each fails the test that offends it, and leaves the others alone."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

CONFIGURATION = """
[pytest]
qt_api = pyside6
filterwarnings = error
addopts = -p no:cacheprovider
"""


@pytest.fixture
def guarded(pytester: pytest.Pytester) -> pytest.Pytester:
    """An empty test folder under this project's root fixtures."""
    pytester.makeconftest((ROOT / "tests" / "conftest.py").read_text(encoding="utf-8"))
    pytester.makeini(CONFIGURATION)
    return pytester


def outcomes(guarded: pytest.Pytester, tests: str) -> tuple[dict[str, int], str]:
    """Run the tests in a process of their own, where no Qt application exists yet."""
    guarded.makepyfile(tests)
    result = guarded.runpytest_subprocess("-p", "no:xdist", "-v")
    return result.parseoutcomes(), result.stdout.str()


THREADS = """
import threading

stop = threading.Event()

def test_daemon_thread_left():
    threading.Thread(target=stop.wait, name="forgotten daemon", daemon=True).start()

def test_thread_left_by_the_test_before_is_not_held_against_this_one():
    pass

def test_thread_that_ends_soon():
    threading.Thread(target=threading.Event().wait, args=(0.2,)).start()

def test_thread_left():
    threading.Timer(5.0, print).start()
"""


def test_thread_left_behind_fails_its_own_test(guarded: pytest.Pytester) -> None:
    counted, output = outcomes(guarded, THREADS)
    assert counted == {"passed": 4, "errors": 2}
    assert "forgotten daemon" in output
    assert "ERROR at teardown of test_daemon_thread_left" in output
    assert "ERROR at teardown of test_thread_left " in output


OFFENDERS = """
from PySide6.QtCore import QObject, QPropertyAnimation, QThread, QTimer
from PySide6.QtWidgets import QLabel, QWidget

kept = []

def test_timer(qapp):
    timer = QTimer(qapp)
    timer.start(10_000)

def test_single_shot(qapp):
    QTimer.singleShot(10_000, print)

def test_single_shot_with_context(qapp):
    QTimer.singleShot(10_000, qapp, print)

def test_animation(qapp):
    animation = QPropertyAnimation(qapp, b"objectName", qapp)
    animation.setDuration(10_000)
    animation.setStartValue(0)
    animation.setEndValue(1)
    animation.start()

def test_qt_thread(qapp):
    kept.append(QThread())
    kept[-1].start()

def test_hidden_window(qapp):
    kept.append(QWidget())
    kept[-1].setWindowTitle("forgotten window")

def test_shown_window(qapp):
    kept.append(QLabel("left"))
    kept[-1].show()

def test_nothing_new(qapp):
    pass

def test_end(qapp):
    for thing in kept:
        if isinstance(thing, QThread):
            thing.quit()
            thing.wait()
"""


def test_everything_of_qt_left_behind_fails_its_own_test(guarded: pytest.Pytester) -> None:
    counted, output = outcomes(guarded, OFFENDERS)
    assert counted == {"passed": 9, "errors": 7}
    for name in (
        "timer",
        "single_shot",
        "single_shot_with_context",
        "animation",
        "qt_thread",
        "hidden_window",
        "shown_window",
    ):
        assert f"ERROR at teardown of test_{name} " in output
    assert "forgotten window" in output


TIDY = """
import pyqtgraph
from PySide6.QtCore import QObject, QThread, QTimer
from PySide6.QtWidgets import QComboBox, QMenu, QVBoxLayout, QWidget

class Cyclic(QWidget):
    def __init__(self):
        super().__init__()
        self.again = self
        self.timer = QTimer(self)
        self.timer.start(10)
        QTimer.singleShot(10_000, self.close)

def test_registered_window(qtbot):
    window = QWidget()
    qtbot.addWidget(window)
    layout = QVBoxLayout(window)
    layout.addWidget(QComboBox())
    window.show()
    window.findChild(QComboBox).showPopup()

def test_window_dropped_in_a_cycle(qapp):
    Cyclic().show()

def test_window_deleted_later(qapp):
    Cyclic().deleteLater()

def test_plot(qtbot):
    plot = pyqtgraph.PlotWidget()
    qtbot.addWidget(plot)
    plot.plot([1.0, 2.0, 3.0])
    plot.show()
    qtbot.waitExposed(plot)

def test_single_shot_that_comes_soon(qapp):
    QTimer.singleShot(0, lambda: None)

def test_single_shot_of_an_object_that_is_gone(qapp):
    holder = QObject()
    QTimer.singleShot(10_000, holder, lambda: None)

def test_thread_that_was_waited_for(qapp):
    thread = QThread()
    thread.start()
    thread.quit()
    assert thread.wait(5_000)
"""


def test_tidy_tests_pass(guarded: pytest.Pytester) -> None:
    counted, _ = outcomes(guarded, TIDY)
    assert counted == {"passed": 7}


def test_qt_guard_stays_away_where_qt_is_not_used(guarded: pytest.Pytester) -> None:
    guarded.makepyfile(
        """
        import sys

        def test_no_qt():
            assert not any(name.startswith("PySide6") for name in sys.modules)
        """
    )
    guarded.makeini("[pytest]\nfilterwarnings = error")
    result = guarded.runpytest_subprocess("-p", "no:xdist", "-p", "no:pytest-qt")
    assert result.parseoutcomes() == {"passed": 1}


def test_application_data_go_to_the_tests_own_folder(isolated_home: Path, tmp_path: Path) -> None:
    import os

    assert os.environ["AHRS_LAB_HOME"] == str(isolated_home)
    assert isolated_home.is_relative_to(tmp_path)


def test_reference_data_absent_is_a_skip_with_a_reason(guarded: pytest.Pytester) -> None:
    counted, output = outcomes(guarded, "def test_needs_references(shared): pass")
    assert counted == {"skipped": 1}
    assert "the reference data are not here" in output or "SKIPPED" in output
