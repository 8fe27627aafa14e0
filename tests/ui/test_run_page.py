"""The run page plays a run that is told to it: what the operator sees and what their keys do."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import Activity, SegmentFinished, StateChanged, StepFinished, Warned
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import Segment
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.run.page import RunPage
from ahrs_lab.ui.run.repeat_dialog import RepeatDialog
from ahrs_lab.ui.widgets import Label
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.conftest import Look
from tests.ui.scripted_run import ScriptedRun, scripted

RATE = Segment("sf_x_02", Orientation("UEN"), "scale_factor", "x", "rate", rate_dps=-100.0)
WRONG = Message("Asked: Y up. The sensor feels X up (tilt 88.7°). Turn the case so that Y points up.")


@pytest.fixture
def play(window: MainWindow, look: Look) -> ScriptedRun:
    """A run that has just started."""
    run = scripted(window.workspace.run)
    window.workspace.run.poll()
    look.settle()
    return run


def shown(page: RunPage, look: Look) -> str:
    """Every text of the page that can be seen."""
    page.workspace.run.poll()
    look.settle()
    return "\n".join(label.text() for label in page.findChildren(Label) if label.isVisible())


def test_without_a_run_the_page_says_what_will_be_here(run_page: RunPage, look: Look) -> None:
    assert "No run yet" in shown(run_page, look)


def test_mounting_is_asked_with_drawing_and_where_each_axis_points(
    run_page: RunPage, play: ScriptedRun, look: Look
) -> None:
    play.begin("m1.mount")
    play.ask("NUE", "UEN")
    text = shown(run_page, look)
    assert "Mount the case with Y pointing up" in text
    assert "Power is off" in text
    assert run_page.now.drawing.moving
    for where in ("north", "up", "east"):
        assert where in text.split("\n")


def test_mounting_with_power_on_warns_of_the_cable(run_page: RunPage, play: ScriptedRun, look: Look) -> None:
    model = run_page.workspace.run.model
    model._power_off_between = False
    play.ask("NUE", "UEN")
    assert "Power stays on" in shown(run_page, look)


def test_space_says_mounted_once(
    window: MainWindow, run_page: RunPage, play: ScriptedRun, look: Look, qtbot: QtBot
) -> None:
    play.ask("NUE", "UEN")
    shown(run_page, look)
    qtbot.keyClick(window, Qt.Key.Key_Space)
    assert play.calls == ["start", "mounted"]
    shown(run_page, look)
    assert not run_page.now.drawing.moving
    qtbot.keyClick(window, Qt.Key.Key_Space)
    assert play.calls == ["start", "mounted"]


def test_button_says_mounted(run_page: RunPage, play: ScriptedRun, look: Look, qtbot: QtBot) -> None:
    play.ask("NUE", "UEN")
    shown(run_page, look)
    qtbot.mouseClick(run_page.now.mount.button, Qt.MouseButton.LeftButton)
    assert play.calls == ["start", "mounted"]


def test_refused_mounting_shows_what_the_sensor_feels(
    run_page: RunPage, play: ScriptedRun, look: Look
) -> None:
    play.begin("m2.power")
    play.check("NUE", "x+", 88.7, False, WRONG)
    play.ask("NUE", "UEN")
    text = shown(run_page, look)
    assert "X up" in text
    assert str(WRONG) in text
    assert run_page.now.mount.feels.property("panel") == "bad"


def test_accepted_mounting_shows_tilt(run_page: RunPage, play: ScriptedRun, look: Look) -> None:
    play.begin("m2.power")
    play.powered = True
    play.check("NUE", "y+", 0.413, True, Message("ok"))
    play.on_event(Activity(Message("Warm-up of the device"), 0.4, 36.0))
    text = shown(run_page, look)
    assert "Warm-up of the device" in text
    assert "0.41° off level, still" in text
    assert "36\u00a0s left" in text


def test_recording_shows_running_mean_and_its_error(run_page: RunPage, play: ScriptedRun, look: Look) -> None:
    play.powered = True
    play.rate_dps = -100.0
    play.begin("m1.rates")
    play.record(RATE, 23.4, 14.2)
    text = shown(run_page, look)
    assert "X at −100 °/s" in text
    assert run_page.now.record.mean.value().startswith("−100.0")
    assert "±" in run_page.now.record.error.value()
    assert run_page.readings.demanded.value() == "−100.000"
    assert run_page.readings.bench.value("samples") == "1\u2009420"
    assert run_page.readings.times.value("step") == "10\u00a0s"
    play.on_event(SegmentFinished(RATE, 2340, 0))
    play.on_event(StepFinished(play.step("m1.rates"), play.t_s))
    shown(run_page, look)
    assert run_page.workspace.run.model.segments == (RATE,)


def test_steps_show_what_is_done_going_on_and_to_come(
    run_page: RunPage, play: ScriptedRun, look: Look
) -> None:
    play.done("m1.mount", "m1.power")
    play.begin("m1.before")
    shown(run_page, look)
    assert run_page.steps.list.row_texts()[:4] == ["X up", "mount", "power on, warm up", "X at rest"]
    assert run_page.steps.list.row_texts()[-2:] == ["Y up", "Z up"]
    assert run_page.steps.list.active_row() == 3


def test_pause_and_going_on_by_key(
    window: MainWindow, run_page: RunPage, play: ScriptedRun, look: Look, qtbot: QtBot
) -> None:
    qtbot.keyClick(window, Qt.Key.Key_P)
    assert "Paused" in shown(run_page, look)
    qtbot.mouseClick(run_page.now.paused.button, Qt.MouseButton.LeftButton)
    assert play.calls == ["start", "pause", "resume"]
    assert "Paused" not in shown(run_page, look)


def test_end_shows_warnings_and_leads_to_the_results(
    window: MainWindow, run_page: RunPage, play: ScriptedRun, look: Look, qtbot: QtBot
) -> None:
    play.record(RATE, 10.0, 10.0, whole=True)
    play.on_event(Warned(Message("3 samples are missing")))
    play.finish("done")
    text = shown(run_page, look)
    assert "The run is complete" in text
    assert "3 samples are missing" in text
    qtbot.mouseClick(run_page.now.end.main, Qt.MouseButton.LeftButton)
    assert window.current_page() == "results"


def test_failed_run_says_why_and_can_be_resumed(
    run_page: RunPage, play: ScriptedRun, look: Look, qtbot: QtBot
) -> None:
    play.begin("m1.before")
    play.finish("failed", Message("The table tripped."))
    text = shown(run_page, look)
    assert "The table tripped." in text
    assert run_page.workspace.run.model.groups[0].lines[2].mark == "failed"
    qtbot.mouseClick(run_page.now.end.main, Qt.MouseButton.LeftButton)
    assert play.calls == ["start", "start"]
    assert "The table tripped." not in shown(run_page, look)


def test_segment_is_repeated_with_a_reason(
    run_page: RunPage, play: ScriptedRun, look: Look, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    play.record(RATE, 10.0, 10.0, whole=True)
    play.finish("done")
    shown(run_page, look)

    def answer(dialog: RepeatDialog) -> int:
        assert not dialog.go.isEnabled(), "without a reason"
        dialog.why.setText("  door opened ")
        assert dialog.go.isEnabled()
        return int(QDialog.DialogCode.Accepted)

    monkeypatch.setattr(RepeatDialog, "exec", answer)
    qtbot.mouseClick(run_page.now.end.repeat, Qt.MouseButton.LeftButton)
    assert play.calls[-1] == "repeat sf_x_02: door opened"


def test_refusal_to_resume_is_shown_and_the_old_picture_stays(
    window: MainWindow, run_page: RunPage, play: ScriptedRun, look: Look, monkeypatch: pytest.MonkeyPatch
) -> None:
    play.finish("failed", Message("The table tripped."))
    shown(run_page, look)

    def refuse() -> None:
        raise InputError("The folder is in use.")

    monkeypatch.setattr(play, "start", refuse)
    run_page.now.end.main.click()
    assert window.notice.isVisible()
    assert window.notice.text() == "The folder is in use."
    assert "The table tripped." in shown(run_page, look)


def test_help_opens_and_closes(run_page: RunPage, play: ScriptedRun, look: Look) -> None:
    play.ask("NUE", "UEN")
    shown(run_page, look)
    popup = run_page.now.mount.show_help()
    look.settle()
    assert popup.isVisible()
    popup.close()


@pytest.mark.parametrize("language", ["en", "zh"])
@pytest.mark.parametrize("phase", ["mount", "refused", "warm", "record", "paused", "failed", "done"])
def test_nothing_is_cut_and_every_button_is_reached_at_1366_by_768(
    window: MainWindow, run_page: RunPage, play: ScriptedRun, look: Look, phase: str, language: str
) -> None:
    to_phase(play, phase)
    look.language.set_language(language)  # type: ignore[arg-type]
    shown(run_page, look)
    assert clipped_texts(window) == []
    assert outside(window) == []


def to_phase(play: ScriptedRun, phase: str) -> None:
    """Play until there."""
    play.begin("m1.mount")
    play.ask("NUE", "UEN")
    if phase == "mount":
        return
    if phase == "refused":
        play.begin("m1.power")
        play.check("NUE", "x+", 88.7, False, WRONG)
        play.ask("NUE", "UEN")
        return
    play.confirm_mounted()
    play.powered = True
    if phase == "warm":
        play.check("NUE", "y+", 0.4, True, Message("ok"))
        play.on_event(Activity(Message("Warm-up of the device"), None, 36.0))
        return
    play.record(RATE, 20.0, 15.0)
    if phase == "paused":
        play.on_event(StateChanged("paused"))
    if phase in ("failed", "done"):
        play.on_event(Warned(Message("3 samples of sf_x_02 are missing")))
        play.finish(phase, WRONG if phase == "failed" else None)


def test_times_are_those_of_the_wall_clock(run_page: RunPage, play: ScriptedRun, look: Look) -> None:
    play.begin("m1.mount")
    play.ask("UEN", None)
    shown(run_page, look)
    # What follows this mounting: 75 + 64 + 260 + 64 + 96 + 1804 s.
    assert run_page.readings.times.value("mounting") == "now"
