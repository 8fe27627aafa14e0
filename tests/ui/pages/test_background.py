"""The worker: results come back in the GUI thread, late ones are dropped, none outlives its owner."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from ahrs_lab.errors import AhrsLabError, InputError
from ahrs_lab.ui.pages.background import Background


def no_error(error: AhrsLabError) -> None:
    pytest.fail(str(error))


@pytest.fixture
def background(qtbot: QtBot) -> Iterator[Background]:
    made = Background()
    yield made
    made.close()


def test_work_is_done_elsewhere_and_delivered_here(qtbot: QtBot, background: Background) -> None:
    owner, seen = QObject(), []
    background.run(
        owner,
        lambda: threading.current_thread().name,
        lambda name: seen.append((name, threading.current_thread() is threading.main_thread())),
        no_error,
    )
    assert background.is_busy(owner)
    qtbot.waitUntil(lambda: bool(seen))
    assert seen[0][0].startswith("ahrs-lab-pages")
    assert seen[0][1]
    assert not background.is_busy(owner)


def test_an_error_for_people_goes_to_whoever_asked(qtbot: QtBot, background: Background) -> None:
    owner = QObject()
    errors: list[AhrsLabError] = []

    def fail() -> None:
        raise InputError("Wrong.")

    background.run(owner, fail, lambda _none: pytest.fail("delivered"), errors.append)
    qtbot.waitUntil(lambda: bool(errors))
    assert str(errors[0]) == "Wrong."


def test_a_defect_of_ours_is_not_swallowed(qtbot: QtBot, background: Background) -> None:
    owner = QObject()

    def fail() -> None:
        raise ZeroDivisionError("ours")

    with qtbot.captureExceptions() as caught:
        background.run(owner, fail, lambda _none: None, lambda _error: pytest.fail("not a message"))
        qtbot.waitUntil(lambda: bool(caught))
    assert caught[0][0] is ZeroDivisionError


def test_only_the_newest_of_a_topic_is_delivered(qtbot: QtBot, background: Background) -> None:
    owner, seen, gate = QObject(), list[int](), threading.Event()

    def slow() -> int:
        gate.wait(5.0)
        return 1

    background.run(owner, slow, seen.append, no_error, topic="page")
    background.run(owner, lambda: 2, seen.append, no_error, topic="page")
    gate.set()
    qtbot.waitUntil(lambda: not background.is_busy(owner))
    assert seen == [2]


def test_nothing_reaches_an_owner_that_is_gone(qtbot: QtBot, background: Background) -> None:
    from shiboken6 import Shiboken

    owner, seen, gate = QObject(), list[int](), threading.Event()

    def slow() -> int:
        gate.wait(5.0)
        return 1

    background.run(owner, slow, seen.append, no_error)
    Shiboken.delete(owner)
    gate.set()
    last, done = QObject(), list[int]()
    background.run(last, lambda: 3, done.append, no_error)
    qtbot.waitUntil(lambda: bool(done))
    assert seen == []


def test_closing_waits_and_refuses_more(qtbot: QtBot) -> None:
    made, owner, ended = Background(), QObject(), threading.Event()
    made.run(owner, ended.set, lambda _none: pytest.fail("delivered after close"), no_error)
    made.close()
    assert ended.is_set()
    made.run(owner, lambda: pytest.fail("ran after close"), lambda _none: None, no_error)
    qtbot.wait(20)
