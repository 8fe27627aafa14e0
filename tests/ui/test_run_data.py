"""The run's view model, its samples, and the bridge to another thread."""

from __future__ import annotations

import threading
from typing import cast

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import StateChanged, StepFinished, StepStarted
from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.run.bridge import RunBridge
from ahrs_lab.ui.run.live_data import LiveData
from ahrs_lab.ui.run.model import RunModel
from tests.ui.conftest import Look
from tests.ui.scripted_run import ScriptedRun, plan_steps, scripted


def block(start: int, n: int, *, rate_hz: float = 100.0, offset_s: float = 500.0) -> Samples:
    t_s = (start + np.arange(1, n + 1)) / rate_hz
    gyro = {f"gyro_{axis}": np.full(n, float(i)) for i, axis in enumerate("xyz")}
    return Samples({"t_s": t_s, "host_t_s": t_s + offset_s, **gyro})


def test_steps_are_grouped_by_mounting() -> None:
    model = RunModel(plan_steps())
    assert [group.mounting for group in model.groups] == ["x+", "y+", "z+"]
    assert [group.mark for group in model.groups] == ["pending"] * 3
    assert model.next_mounting == "x+"
    assert model.progress == 0.0


def test_progress_counts_estimates_and_skipped_steps_are_done() -> None:
    steps = plan_steps()
    model = RunModel(steps)
    for step in steps[:7]:
        model.apply(StepStarted(step, 0.0))
        model.apply(StepFinished(step, 0.0, skipped=True))
    assert model.groups[0].mark == "skipped"
    assert model.progress == pytest.approx(1 / 3)
    assert model.next_mounting == "y+"


def test_a_step_nobody_announced_is_listed() -> None:
    model = RunModel()
    model.apply(StepStarted(plan_steps()[0], 1.0))
    assert [group.mounting for group in model.groups] == ["x+"]


def test_what_breaks_off_is_marked_and_nothing_is_live_any_more() -> None:
    steps = plan_steps()
    model = RunModel(steps)
    lives: list[bool] = []
    for event in (
        StateChanged("running"),
        StepStarted(steps[0], 0.0),
        StateChanged("failed", Message("why")),
    ):
        model.apply(event)
        lives.append(model.live)
    assert lives == [True, True, False]
    assert model.phase == "failed"
    assert model.groups[0].mark == "failed"
    assert model.active is None


def test_samples_of_a_recording_are_counted_with_the_lost_ones() -> None:
    data = LiveData(100.0)
    data.add(block(0, 50))
    assert data.samples == 0
    data.begin_segment("y")
    data.add(block(50, 100))
    data.add(block(153, 97))
    assert (data.samples, data.lost) == (197, 3)
    assert data.running.look().mean == 1.0
    data.end_segment(200, 3)
    data.add(block(250, 10))
    assert (data.samples, data.lost) == (200, 3)


def test_samples_stand_at_bench_time_and_a_restarted_device_is_put_there_again() -> None:
    data = LiveData(100.0)
    data.add(block(0, 10))
    assert data.gyro.newest_s == pytest.approx(500.1)
    data.add(block(0, 10, offset_s=503.0))
    assert data.gyro.newest_s == pytest.approx(503.1)


def test_mean_of_the_last_second_of_each_axis() -> None:
    data = LiveData(100.0)
    assert data.gyro_now("x") is None
    data.add(block(0, 250))
    assert [data.gyro_now(axis) for axis in "xyz"] == [0.0, 1.0, 2.0]


def test_news_and_samples_of_another_thread_reach_the_model(look: Look, qtbot: QtBot) -> None:
    bridge = RunBridge()

    class Threaded(ScriptedRun):
        def start(self) -> None:
            self.thread = threading.Thread(target=self.work)
            self.thread.start()

        def work(self) -> None:
            self.on_event(StateChanged("running"))
            for step in self.steps:
                self.done(step.key)
                self.stream(0.5)
            self.finish("done")

        def join(self, timeout_s: float | None = None) -> bool:
            self.thread.join(timeout_s)
            return not self.thread.is_alive()

    with qtbot.waitSignal(bridge.ended, timeout=5000):
        bridge.start(lambda to: cast(LiveRun, Threaded(to.on_event, to.on_samples)))
    assert bridge.model.phase == "done"
    assert [group.mark for group in bridge.model.groups] == ["done"] * 3
    assert bridge.data.gyro.newest_s > 1000.0
    assert not bridge.live
    assert bridge.close()


def test_run_that_ends_without_a_word_is_called_failed(look: Look, qtbot: QtBot) -> None:
    bridge = RunBridge()
    run = scripted(bridge)
    run.over = True
    with qtbot.waitSignal(bridge.ended, timeout=5000):
        pass
    assert bridge.model.state == "failed"
    assert "without saying why" in str(bridge.model.reason)


def test_stop_without_a_run_says_no(look: Look) -> None:
    bridge = RunBridge()
    assert not bridge.stop()
    assert bridge.close()
