"""The pages Bench and Set-up."""

from __future__ import annotations

from datetime import date

import pytest
from PySide6.QtWidgets import QApplication, QLabel
from pytestqt.qtbot import QtBot

from ahrs_lab.metrology.declared_place import DeclaredPlace, place_from_json
from ahrs_lab.metrology.figures_json import figures_from_text
from ahrs_lab.metrology.stated_figures import StatedFigure
from ahrs_lab.records.rows import SignedIn, StandardRow
from ahrs_lab.ui.pages import bench_model
from ahrs_lab.ui.pages.setup_people import PersonDialog
from ahrs_lab.ui.pages.setup_standards import StandardDialog
from ahrs_lab.ui.pages.sign_in import SignInDialog
from tests.ui.pages.conftest import Screens
from tests.ui.pages.fake_laboratory import PASSWORD


def test_the_bench_of_the_open_job_is_shown(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "bench")
    assert screens.bench.limits.value("rate") == "1\u2009000 °/s"
    assert "VU-100" in screens.bench.instruments.value("ahrs")
    assert screens.bench.room.value("temperature").startswith("20.")


def test_a_fault_is_tried_in_the_open_job(screens: Screens, qtbot: QtBot) -> None:
    number = screens.number("ready")
    screens.desk.open(number, "bench")
    screens.bench.faults["ahrs_silent"].click()
    assert bench_model.faults_of(screens.laboratory.job(number).bench_toml) == {"ahrs_silent"}
    assert screens.bench.faults["ahrs_silent"].isChecked()
    screens.bench.faults["ahrs_silent"].click()
    assert bench_model.faults_of(screens.laboratory.job(number).bench_toml) == frozenset()


def test_every_fault_has_its_words(screens: Screens) -> None:
    assert all(box.text() for box in screens.bench.faults.values())


def test_a_measured_job_keeps_its_bench(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("measured"), "bench")
    assert not any(box.isEnabled() for box in screens.bench.faults.values())


def test_a_broken_bench_says_why(screens: Screens, qtbot: QtBot) -> None:
    screens.window.show_page("bench")
    screens.bench.show_bench("seed = ")
    shown = [label.text() for label in screens.bench._refusal.findChildren(QLabel)]
    assert any("TOML" in text for text in shown)


def test_a_preset_is_looked_at_without_a_job(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.workspace.open_job(None)
    screens.window.show_page("bench")
    for name in screens.laboratory.bench_presets():
        screens.bench.preset.set_key(name)
        screens.bench.preset.edited.emit()
        assert not screens.bench._refusal.isVisible(), name


def test_an_administrator_adds_and_changes_people(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    dialog = PersonDialog(screens.desk, actors["operator"], None)
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.name.set_text("新人")
    dialog.roles["verifier"].setChecked(True)
    dialog.action.click()
    qtbot.waitUntil(lambda: bool(dialog.refusal()))
    assert dialog.refusal() == "A password is needed."
    dialog.password.set_text("secret")
    dialog.action.click()
    qtbot.waitUntil(lambda: len(screens.laboratory.people()) == 4)
    qtbot.waitUntil(lambda: not dialog.isVisible())
    assert screens.laboratory.sign_in("新人", "secret").person.roles == {"verifier"}


def test_only_an_administrator_changes_the_laboratory(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    profile = screens.setup.profile
    screens.desk.sign_in(actors["verifier"])
    profile.name.set_text("Another laboratory")
    profile.save()
    assert screens.notices[-1][0] == "bad"
    assert screens.laboratory.profile().name == "演示校准实验室"
    screens.desk.sign_in(actors["operator"])
    profile.name.set_text("Another laboratory")
    profile.save()
    assert screens.laboratory.profile().name == "Another laboratory"


def test_the_place_of_the_table_is_declared(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    profile = screens.setup.profile
    screens.desk.sign_in(actors["operator"])
    assert (profile.earth.text(), profile.foundation.key()) == ("", "")
    for text, key, place in (
        ("1.2", "isolated", DeclaredPlace(1.2, True)),
        ("", "not isolated", DeclaredPlace(None, False)),
        ("0", "", DeclaredPlace(0.0)),
    ):
        profile.earth.set_text(text)
        profile.foundation.set_key(key)
        profile.save()
        assert place_from_json(screens.laboratory.profile().place_json) == place
        profile.refresh()
        assert (profile.earth.text(), profile.foundation.key()) == (text, key)
    for wrong in ("-1", "low"):
        profile.earth.set_text(wrong)
        profile.save()
        assert screens.notices[-1][0] == "bad"
        assert "earth resistance" in screens.notices[-1][1]
    assert place_from_json(screens.laboratory.profile().place_json) == DeclaredPlace(0.0)


def test_a_standard_is_edited_with_its_due_date(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    row = screens.laboratory.standards()[1]
    dialog = StandardDialog(screens.desk, actors["operator"], row)
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.due.set_text("31.3.2027")
    dialog.action.click()
    assert dialog.due.error()
    dialog.due.set_text("2027-03-31")
    dialog.action.click()
    assert screens.laboratory.standards()[1].due == date(2027, 3, 31)
    empty = StandardDialog(screens.desk, actors["operator"], StandardRow(0, "table", ""))
    qtbot.addWidget(empty)
    empty.show()
    empty.action.click()
    assert empty.refusal()


def test_the_figures_of_a_certificate_are_entered_with_their_k(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    row = screens.laboratory.standards()[0]
    dialog = StandardDialog(screens.desk, actors["operator"], row)
    qtbot.addWidget(dialog)
    dialog.show()
    wobble = dialog.figures.rows["wobble_arcsec"]
    assert wobble.value.isVisible()
    assert not dialog.figures.rows["azimuth_arcsec"].value.isVisible()
    wobble.value.set_text("1.2 arcsec")
    dialog.action.click()
    assert "write numbers as" in dialog.refusal()
    wobble.value.set_text("1,2")
    dialog.action.click()
    assert "no coverage factor" in dialog.refusal()
    assert wobble.k.error()
    wobble.k.set_text("0")
    dialog.action.click()
    assert "no coverage factor" in dialog.refusal()
    wobble.k.set_text("2.3")
    wobble.dof.set_text("9")
    number = dialog.fields["certificate_number"].text()
    dialog.fields["certificate_number"].set_text("")
    dialog.action.click()
    assert "enter the number and the due date" in dialog.refusal()
    dialog.fields["certificate_number"].set_text(number)
    dialog.action.click()
    saved = screens.laboratory.standards()[0]
    stated = StatedFigure("wobble_arcsec", 1.2, "arcsec", 2.3, dof=9.0)
    assert figures_from_text(saved.figures_json, "") == (stated,)
    again = StandardDialog(screens.desk, actors["operator"], saved)
    qtbot.addWidget(again)
    again.show()
    assert again.figures.figures() == (stated,)
    again.figures.rows["wobble_arcsec"].known_as.set_key("rectangular")
    again.figures.rows["wobble_arcsec"].known_as.edited.emit()
    assert not again.figures.rows["wobble_arcsec"].k.isEnabled()
    again.action.click()
    limit = StatedFigure("wobble_arcsec", 1.2, "arcsec", distribution="rectangular")
    assert figures_from_text(screens.laboratory.standards()[0].figures_json, "") == (limit,)


def test_a_thermometer_has_no_figures_to_enter(
    screens: Screens, qtbot: QtBot, actors: dict[str, SignedIn]
) -> None:
    dialog = StandardDialog(screens.desk, actors["operator"], screens.laboratory.standards()[0])
    qtbot.addWidget(dialog)
    dialog.show()
    assert dialog.figures.isVisible()
    dialog.kind.set_key("room")
    dialog.kind.edited.emit()
    assert not dialog.figures.isVisible()
    assert dialog.figures.figures() == ()


def test_language_and_look_are_asked_for(screens: Screens, qtbot: QtBot) -> None:
    with qtbot.waitSignal(screens.setup.theme_chosen) as theme:
        screens.setup.theme.changed.emit("dark")
    assert theme.args == ["dark"]
    with qtbot.waitSignal(screens.setup.language_chosen) as chosen:
        screens.setup.language.changed.emit("zh")
    assert chosen.args == ["zh"]


def test_signing_in_names_the_person_at_the_screen(screens: Screens, qtbot: QtBot) -> None:
    dialog = SignInDialog(screens.desk, prefer="演示核验员")
    qtbot.addWidget(dialog)
    dialog.show()
    assert dialog.person.key() == "演示核验员"
    dialog.action.click()
    assert dialog.password.error()
    dialog.password.set_text("wrong")
    dialog.action.click()
    qtbot.waitUntil(lambda: bool(dialog.refusal()))
    dialog.password.set_text(PASSWORD)
    dialog.action.click()
    qtbot.waitUntil(lambda: dialog.actor is not None)
    screens.desk.sign_in(dialog.actor)
    worker = screens.desk.workspace.worker
    assert worker is not None
    assert worker.name_en == "Demo verifier"


def test_going_away_from_the_sign_in_changes_nobody(screens: Screens, qtbot: QtBot) -> None:
    from PySide6.QtCore import QTimer

    def leave() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, SignInDialog)
        dialog.cancel.click()

    before = screens.desk.actor
    QTimer.singleShot(50, leave)
    screens.desk.change_actor(screens.window)
    assert screens.desk.actor is before


@pytest.mark.parametrize("number", range(4))
def test_every_tab_of_the_set_up_opens(screens: Screens, qtbot: QtBot, number: int) -> None:
    screens.window.show_page("setup")
    screens.setup.tabs.setCurrentIndex(number)
    assert screens.setup._stack.currentIndex() == number
