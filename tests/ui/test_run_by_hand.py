"""The run page at a table without a wire: what it asks, what it refuses, and what STOP does to a question.

The run, the bench and the checks are the application's; the test is the hand at the virtual table.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from ahrs_lab.instruments.by_hand import HandKind, HandRequest
from ahrs_lab.laboratory.header import recording_header
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.run.model import RunModel
from ahrs_lab.ui.run.page import RunPage
from ahrs_lab.ui.widgets import Label
from tests.laboratory.by_hand import bench_without_wire, obey
from tests.laboratory.short_run import SEGMENTS, counted, write_bench, write_plan
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.conftest import Look
from tests.ui.playing import Hands

_SPEED = 80.0


class Operator:
    """Reads the page, turns the virtual table, presses the space bar."""

    def __init__(self, window: MainWindow, folder: Path, look: Look, qtbot: QtBot) -> None:
        self.window, self.look, self.qtbot = window, look, qtbot
        page = window.pages["run"]
        assert isinstance(page, RunPage)
        self.page = page
        self.hands = Hands(window, "by-hand-")
        plan = load_plan(write_plan(folder))
        bench, self.table = bench_without_wire(write_bench(folder).read_text(encoding="utf-8"), _SPEED)
        self.bundle = folder / "recording"

        def make(bridge: RunBridge) -> LiveRun:
            return LiveRun(
                bench,
                plan,
                self.bundle,
                recording_header(bench, plan),
                on_event=bridge.on_event,
                on_samples=bridge.on_samples,
            )

        self.supply = bench.supply
        window.workspace.start_run(make)

    @property
    def model(self) -> RunModel:
        return self.page.workspace.run.model

    def space(self) -> None:
        self.qtbot.keyClick(self.window, Qt.Key.Key_Space)

    def answered(self) -> bool:
        """The question was taken up: it is over, or asked again with a reason."""
        return self.model.hand is None or not self.model.confirmed

    def does(self, request: HandRequest) -> None:
        """What is asked, and says so when it is done."""
        obey(self.table, request)
        self.hands.until(lambda: self.still(request), "the table to do it")
        self.space()
        self.hands.until(self.answered, "the check")

    def still(self, request: HandRequest) -> bool:
        """The table has come to what is asked, and the device has felt a second of it."""
        felt = self.model.felt
        return felt is None or felt.rate_dps is None or felt.holds or request.kind == "switch_on"

    def goes_on_until(self, kind: HandKind | None, rate_dps: float | None = None) -> HandRequest | None:
        """Mounts and sets what is asked, up to that question; None: to the end of the run."""
        bridge = self.page.workspace.run
        while True:
            self.hands.until(
                lambda: (
                    (self.model.hand is not None or self.model.request is not None or not bridge.live)
                    and not self.model.confirmed
                ),
                "the next question",
            )
            if not bridge.live:
                return None
            request = self.model.hand
            if request is None:
                self.space()
                self.hands.until(lambda: self.model.request is None, "the run to take it up")
            elif request.kind == kind and rate_dps in (None, request.rate_dps):
                return request
            else:
                self.does(request)

    def text(self) -> str:
        self.look.settle()
        texts = (label.text() for label in self.page.findChildren(Label) if label.isVisible())
        # What only keeps a line from ending there is left out.
        return "\n".join(texts).replace("\u00a0", " ").replace("\u2060", "")


@pytest.fixture
def operator(window: MainWindow, look: Look, tmp_path: Path, qtbot: QtBot) -> Operator:
    return Operator(window, tmp_path, look, qtbot)


def test_an_operator_sets_every_rate_by_hand_and_a_wrong_sense_is_refused(operator: Operator) -> None:
    request = operator.goes_on_until("rate", 50.0)
    assert request is not None
    told = operator.text()
    assert "Set the rate by hand" in told
    assert "Anticlockwise seen from above" in told
    assert operator.page.now.table.accessibleName() == "+50 °/s"
    operator.table.set_rate(-50.0)
    operator.hands.until(
        lambda: operator.model.felt is not None and (operator.model.felt.rate_dps or 0.0) < -49.0,
        "the device to feel it",
    )
    assert "not yet within ±2.5 °/s" in operator.text()
    assert "\u221250.1" in operator.text()
    operator.space()
    operator.hands.until(lambda: operator.model.hand_refused is not None, "the refusal")
    told = operator.text()
    assert "the table turns the wrong way. Set it to +50 °/s" in told
    operator.hands.picture("refused")
    assert "sf_x_04" not in {entry.segment.name for entry in read_bundle(operator.bundle).segments}
    assert clipped_texts(operator.window) == []
    assert outside(operator.window) == []
    operator.goes_on_until(None)
    assert operator.model.state == "done", operator.model.reason
    assert counted(operator.bundle) == SEGMENTS
    assert not operator.supply.read().output_on


def test_stop_during_a_question_ends_it_and_says_who_has_to_stop_the_table(operator: Operator) -> None:
    request = operator.goes_on_until("rate", 50.0)
    assert request is not None
    operator.table.set_rate(50.0)
    operator.hands.until(
        lambda: operator.model.felt is not None and operator.model.felt.holds, "the device to feel it"
    )
    assert "as asked, within ±2.5 °/s" in operator.text()
    operator.qtbot.keyClick(operator.window, Qt.Key.Key_Escape)
    operator.hands.wait_for("Only you can stop this table")
    assert "Bring the table to rest" in operator.text()
    assert not operator.page.now.hand.button.isVisible()
    operator.table.stop()
    operator.hands.wait_for("The run was stopped")
    assert "The table rests, the supply is off." in operator.text()
    assert "sf_x_04" not in {entry.segment.name for entry in read_bundle(operator.bundle).segments}
    assert not operator.supply.read().output_on


def test_the_end_does_not_claim_rest_where_the_table_was_left_turning(operator: Operator) -> None:
    operator.goes_on_until("rate", 50.0)
    operator.table.set_rate(50.0)
    operator.hands.until(
        lambda: operator.model.felt is not None and operator.model.felt.holds, "the device to feel it"
    )
    operator.qtbot.keyClick(operator.window, Qt.Key.Key_Escape)
    operator.hands.wait_for("The run was stopped")
    told = operator.text()
    assert "bring it to rest by hand" in told
    assert "The table rests" not in told


def test_the_question_stands_in_chinese_and_in_the_dark(operator: Operator, look: Look) -> None:
    operator.goes_on_until("rate", -50.0)
    operator.hands.picture("rate-en-light")
    look.language.set_language("zh")
    look.theme.set_mode("dark")
    look.settle()
    told = operator.text()
    assert "手动设置转速" in told
    assert "俯视顺时针" in told
    operator.hands.picture("rate-zh-dark")
    assert clipped_texts(operator.window) == []
    operator.qtbot.keyClick(operator.window, Qt.Key.Key_Escape)
    operator.table.stop()
    operator.hands.until(lambda: not operator.page.workspace.run.live, "the run's end")
