"""The page Jobs: finding, editing, saving, and what stands before a run."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QInputMethodEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from ahrs_lab.messages import Message
from ahrs_lab.records.rows import SignedIn
from ahrs_lab.ui.pages.jobs.plan_model import plan_of_text
from ahrs_lab.ui.pages.jobs.reason_dialog import ReasonDialog
from ahrs_lab.ui.pages.sign_in import SignInDialog
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from tests.ui.pages.conftest import Screens
from tests.ui.pages.fake_laboratory import PASSWORD


def line(screens: Screens, name: str) -> TextField:
    field = screens.jobs.editor.plan.fields[name]  # type: ignore[index]
    assert isinstance(field, TextField)
    return field


def type_into(qtbot: QtBot, field: TextField, text: str) -> None:
    field.line.selectAll()
    if text.isascii():
        QTest.keyClicks(field.line, text)
    else:  # as an input method would
        event = QInputMethodEvent()
        event.setCommitString(text)
        QApplication.sendEvent(field.line, event)


def test_typing_narrows_the_list(screens: Screens, qtbot: QtBot) -> None:
    screens.window.show_page("jobs")
    assert len(screens.jobs.table.keys()) == 5
    QTest.keyClicks(screens.jobs.search, "vn-100")
    assert screens.jobs.table.keys() == [screens.number("ready")]
    screens.jobs.search.clear()
    QTest.keyClicks(screens.jobs.search, "nothing like it")
    assert screens.jobs.table.keys() == []


def test_enter_opens_the_chosen_job(screens: Screens, qtbot: QtBot) -> None:
    screens.window.show_page("jobs")
    screens.jobs.table.choose(screens.number("checked"))
    QTest.keyClick(screens.jobs.table, Qt.Key.Key_Return)
    assert screens.desk.number == screens.number("checked")
    assert screens.jobs.editor.isVisible()


def test_the_list_sorts_by_any_column(screens: Screens, qtbot: QtBot) -> None:
    screens.window.show_page("jobs")
    table = screens.jobs.table
    table.sort_by(5, Qt.SortOrder.AscendingOrder)
    assert [table.texts(row)[5] for row in range(5)] == sorted(table.texts(row)[5] for row in range(5))


def test_a_new_job_is_saved_with_what_was_typed(screens: Screens, qtbot: QtBot) -> None:
    screens.jobs.new_job()
    screens.window.show_page("jobs")
    editor = screens.jobs.editor
    texts = editor.before_run.texts()
    assert "Enter the customer." in texts
    assert "Enter the device's name or model." in texts
    type_into(qtbot, editor.order.customer, "New customer")
    type_into(qtbot, editor.order.model, "AH-1")
    qtbot.waitUntil(lambda: "Enter the customer." not in editor.before_run.texts())
    QTest.mouseClick(editor.save_button, Qt.MouseButton.LeftButton)
    made = screens.laboratory.job(editor.number())
    assert (made.customer.name, made.device.model, made.state) == ("New customer", "AH-1", "draft")
    assert made.received == date.today()  # noqa: DTZ011
    assert [person.name_en for person in (made.operator, made.verifier, made.approver) if person] == [
        "Demo operator",
        "Demo verifier",
        "Demo approver",
    ]
    assert len(made.standards) == 4
    assert screens.desk.number == made.number
    assert not editor.save_button.isEnabled()


def test_a_known_customer_brings_its_address(screens: Screens, qtbot: QtBot) -> None:
    screens.jobs.new_job()
    order = screens.jobs.editor.order
    type_into(qtbot, order.customer, "海洋测绘中心")
    order.customer.line.editingFinished.emit()
    assert order.customer_en.text() == "Centre for Marine Surveying"
    assert order.order().customer.id > 0


def test_another_name_is_another_customer(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    order = screens.jobs.editor.order
    assert order.order().customer.id > 0
    type_into(qtbot, order.customer, "Somebody else")
    assert order.order().customer.id == 0


def test_a_refused_setting_says_so_at_its_field_and_stops_the_start(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    editor = screens.jobs.editor
    editor.tabs.setCurrentIndex(3)
    type_into(qtbot, line(screens, "dwell"), "12")
    assert "20" in line(screens, "dwell").error()
    assert line(screens, "turns").error() == ""
    qtbot.waitUntil(lambda: any("cannot be run" in text for text in editor.before_run.texts()))
    QTest.mouseClick(editor.start_button, Qt.MouseButton.LeftButton)
    assert screens.notices
    assert screens.laboratory.job(screens.number("ready")).state == "ready"


def test_limits_that_no_imu_calibration_is_held_against_are_told_before_the_run(
    screens: Screens, qtbot: QtBot
) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    editor = screens.jobs.editor

    def told() -> bool:
        return any("No conformity is stated" in text for text in editor.before_run.texts())

    if not editor.limits.lines:
        editor.limits.add_button.click()
    qtbot.wait(300)
    assert not told()
    editor.plan.procedure.set_key("imu-discrete")
    editor.plan.procedure.edited.emit()
    qtbot.waitUntil(told)


def test_a_deviation_is_a_sentence_before_the_run(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    type_into(qtbot, line(screens, "duration"), "600")
    qtbot.waitUntil(lambda: any("600" in text for text in screens.jobs.editor.before_run.texts()))
    QTest.mouseClick(screens.jobs.editor.save_button, Qt.MouseButton.LeftButton)
    saved = plan_of_text(screens.laboratory.job(screens.number("ready")).plan_toml)
    assert saved.zero_offset.duration_s == 600.0


def test_the_form_and_the_text_are_one_plan(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    plan = screens.jobs.editor.plan
    type_into(qtbot, line(screens, "turns"), "12")
    plan.switch.click()
    assert "turns = 12" in plan.text.toPlainText()
    plan.text.setPlainText(plan.text.toPlainText().replace("turns = 12", "turns = 14"))
    plan.switch.click()
    assert line(screens, "turns").text() == "14"


def test_a_broken_text_stays_open_until_it_is_mended(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    plan = screens.jobs.editor.plan
    plan.switch.click()
    plan.text.setPlainText("[misalignment\nturns = 3")
    assert not plan.view().runnable
    plan.switch.click()
    assert plan.text.isVisibleTo(plan)
    plan.text.setPlainText("[misalignment]\nturns = 11")
    plan.switch.click()
    assert line(screens, "turns").text() == "11"


def test_multi_position_shows_its_number_of_positions(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    plan = screens.jobs.editor.plan
    assert not plan.fields["positions"].isVisibleTo(plan)
    schedule = plan.fields["schedule"]
    assert isinstance(schedule, ChoiceField)
    schedule.set_key("multi-position")
    schedule.edited.emit()
    assert plan.fields["positions"].isVisibleTo(plan)


def test_a_measured_job_keeps_its_plan_and_bench(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("measured"), "jobs")
    editor = screens.jobs.editor
    assert not line(screens, "turns").line.isEnabled()
    assert editor.bench.text.isReadOnly()
    assert editor.order.customer.line.isEnabled()


def test_an_issued_job_only_shows(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("issued"), "jobs")
    editor = screens.jobs.editor
    assert not editor.order.customer.line.isEnabled()
    assert not editor.save_button.isVisible()
    assert not editor.start_button.isVisible()


def test_an_expired_standard_is_said_in_words(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    from dataclasses import replace

    table = screens.laboratory.standards()[0]
    screens.laboratory.save_standard(replace(table, due=date(2026, 1, 31)), actors["operator"])
    screens.desk.open(screens.number("ready"), "jobs")
    editor = screens.jobs.editor
    assert any("2026-01-31" in text for text in editor.before_run.texts())
    from ahrs_lab.ui.pages.widgets.chip import Chip

    assert "expired 2026-01-31" in [chip.text() for chip in editor.standards.findChildren(Chip)]


def test_clause_6_needs_a_second_person_with_a_reason(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    dialog = ReasonDialog(screens.desk, actors["operator"], [Message("The supply is overdue.")])
    qtbot.addWidget(dialog)
    dialog.show()
    names = [dialog.person.combo.itemData(i) for i in range(dialog.person.combo.count())]
    assert names == ["演示核验员", "演示签发人"]
    dialog.action.click()
    assert dialog.reason.error()
    assert dialog.password.error()
    dialog.reason.set_text("certificate is in the post")
    dialog.password.set_text("wrong")
    dialog.action.click()
    qtbot.waitUntil(lambda: bool(dialog.refusal()))
    assert dialog.second is None
    dialog.password.set_text(PASSWORD)
    dialog.action.click()
    qtbot.waitUntil(lambda: dialog.second is not None)
    assert dialog.reason_text() == "certificate is in the post"


def test_saving_asks_who_it_is(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    screens.desk.sign_in(None)
    type_into(qtbot, line(screens, "turns"), "12")

    def answer() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, SignInDialog)
        dialog.person.set_key("演示校准员")
        dialog.password.set_text(PASSWORD)
        dialog.action.click()

    QTimer.singleShot(50, answer)
    screens.jobs.editor.save_button.click()
    assert screens.desk.actor is not None
    assert plan_of_text(screens.laboratory.job(screens.number("ready")).plan_toml).misalignment.turns == 12


def test_a_verifier_may_not_change_a_job(screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]) -> None:
    screens.desk.open(screens.number("ready"), "jobs")
    screens.desk.sign_in(actors["verifier"])
    type_into(qtbot, line(screens, "turns"), "12")
    screens.jobs.editor.save_button.click()
    assert screens.notices[-1][0] == "bad"
    assert line(screens, "turns").text() == "12"


def test_importing_refuses_what_is_no_recording(
    screens: Screens, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from PySide6.QtWidgets import QFileDialog

    from ahrs_lab.errors import InputError

    def refuse(bundle: Path, actor: SignedIn) -> str:
        raise InputError("{path} is not a recording.", path=bundle)

    monkeypatch.setattr(screens.laboratory, "import_bundle", refuse, raising=False)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "recording.toml"), ""))
    screens.window.show_page("jobs")
    screens.jobs.import_button.click()
    qtbot.waitUntil(lambda: bool(screens.notices))
    assert screens.notices[-1] == ("bad", f"{tmp_path} is not a recording.")
    assert screens.jobs.import_button.isEnabled()
