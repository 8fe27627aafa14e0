"""The discrete IMU calibration on the screen: the plan's form, the steps' words, the result's matrices."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytestqt.qtbot import QtBot

from ahrs_lab.procedures import course
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.ui.pages.jobs.plan_form import PlanForm
from ahrs_lab.ui.pages.jobs.plan_model import (
    EntryName,
    default_plan,
    entries_of,
    plan_of_text,
    text_of_plan,
    view,
)
from ahrs_lab.ui.pages.results.imu_rows import accel_matrices, gyro_matrices, residual_rows
from ahrs_lab.ui.pages.results.imu_view import ImuView
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from ahrs_lab.ui.run import words
from tests.certificates.imu_sample import sample_imu_result
from tests.ui.conftest import Look

IMU = default_plan("imu-discrete")


@pytest.mark.parametrize(
    ("name", "text"),
    [("imu_dwell", "1"), ("imu_rate", "0"), ("imu_turns", "0"), ("own", "UEN, DES"), ("own", "here")],
)
def test_a_refusal_stands_at_the_entry_that_causes_it(name: EntryName, text: str) -> None:
    entries = {**entries_of(IMU), name: text}
    if name == "own":
        entries["scheme"] = "own"
    found = view(entries, IMU)
    assert not found.runnable
    assert list(found.refusals) == [name]


def test_the_form_makes_the_plan_it_shows() -> None:
    own = replace(IMU, imu=replace(IMU.imu, scheme="own", positions=("UEN", "DES", "SUW", "NDW", "NWU@30")))
    for plan in (IMU, own, Plan()):
        found = view(entries_of(plan), plan)
        assert found.runnable
        assert found.plan == plan
        assert plan_of_text(text_of_plan(plan)) == plan


def test_a_list_is_kept_while_another_scheme_is_chosen() -> None:
    found = view({**entries_of(IMU), "own": "UEN, DES", "scheme": "24"}, IMU)
    assert found.plan is not None
    assert (found.plan.imu.scheme, found.plan.imu.positions) == ("24", ())


def test_choosing_the_procedure_changes_the_form_and_the_plan(look: Look, qtbot: QtBot) -> None:
    form = PlanForm()
    qtbot.addWidget(form)
    form.set_text("[power]\nvoltage_v = 9.0\n[settling]\nhold_s = 1.5\n")
    form.show()
    assert form.fields["rates"].isVisible()
    assert not form.fields["scheme"].isVisible()
    form.procedure.set_key("imu-discrete")
    form.procedure.edited.emit()
    assert not form.fields["rates"].isVisible()
    assert form.fields["scheme"].isVisible()
    assert not form.fields["own"].isVisible()
    plan = plan_of_text(form.plan_text())
    assert (plan.procedure, plan.name) == ("imu-discrete", IMU.name)
    assert (plan.power.voltage_v, plan.settling.hold_s) == (9.0, 1.5)
    assert not plan.power.off_between_mountings
    scheme, own = form.fields["scheme"], form.fields["own"]
    assert isinstance(scheme, ChoiceField)
    assert isinstance(own, TextField)
    scheme.set_key("own")
    scheme.edited.emit()
    assert own.isVisible()
    assert "rank 0 of 4" in own.error()
    form.procedure.set_key("jjf1536-2015")
    form.procedure.edited.emit()
    back = plan_of_text(form.plan_text())
    assert back.procedure == "jjf1536-2015"
    assert back.power.off_between_mountings
    assert form.fields["rates"].isVisible()


def test_steps_and_segments_have_their_words(look: Look) -> None:
    said = [words.step(step) for step in course.steps(IMU)]
    assert said[2:5] == ["X turns ±10", "at rest, UEN", "at rest, UWS"]
    recorded = [take.segment for s in course.sessions_of(IMU) for b in s.blocks for take in b.takes]
    assert words.segment(recorded[0]) == "10 turns about X at 100 °/s"
    assert words.segment_kind(recorded[0]).startswith("Rates of the IMU")
    assert words.segment(recorded[2]) == "Position 9 at rest"
    look.language.set_language("zh")
    assert words.step(course.steps(IMU)[3]) == "静置，天东北"


def test_cells_are_value_and_twice_the_combined_uncertainty() -> None:
    result = sample_imu_result()
    by_key = {matrix.key: matrix for matrix in (*gyro_matrices(result), *accel_matrices(result))}
    assert by_key["E1"].cells[0] == ("1.002\u200934 ± 0.000\u200910",)
    assert by_key["B0"].cells[0] == ("11.1 ± 3.6",)
    assert by_key["Bf"].cells[0] == ("4.36 ± 0.35", "0.71 ± 0.35", "−1.17 ± 0.35")
    assert by_key["E"].cells[1] == ("−268 ± 10", "0", "878 ± 10")
    assert by_key["K0"].cells[1] == ("−10.3 ± 1.0",)
    assert by_key["K"].unit == "µrad"
    assert [len(by_key[key].columns) for key in ("E1", "B0", "Bf", "E", "K1", "K0", "K")] == [
        1,
        1,
        3,
        3,
        1,
        1,
        3,
    ]


def test_residuals_name_position_and_direction() -> None:
    name, stood, texts = list(residual_rows(sample_imu_result()))[2]
    assert (name, stood) == ("pos_03", "UWS")
    assert len(texts) == 6


def test_the_view_shows_every_coefficient_in_both_languages(look: Look, qtbot: QtBot) -> None:
    shown = ImuView()
    qtbot.addWidget(shown)
    shown.show()
    shown.show_result(sample_imu_result())
    assert shown.gyros.model().rowCount() == 12
    assert shown.accelerometers.model().rowCount() == 9
    assert shown.positions.model().rowCount() == 12
    assert "12 positions" in shown.verdict.title()
    assert any("The unit was warm" in text for text in shown.findings.texts)
    assert shown.tabs.tabText(0) == "Gyros"
    look.language.set_language("zh")
    look.settle()
    assert shown.tabs.tabText(0) == "陀螺"
    assert "12 个位置" in shown.verdict.title()
    with qtbot.waitSignal(shown.certificate_wanted):
        shown.verdict.pressed.emit()
