"""The page Results: values, units, plots, the raw segment behind a point, and calculating again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QLineEdit
from pytestqt.qtbot import QtBot

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.evaluation import EvaluationSettings
from ahrs_lab.metrology.result import MonteCarloCheck
from ahrs_lab.ui.pages.results.quantities import Quantity, units
from tests.ui.pages.conftest import Screens


def open_result(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("measured"), "results")
    screens.settle(qtbot)


def test_all_twelve_values_stand_with_their_uncertainty(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    rows = {key: row.texts() for card in screens.results.cards.values() for key, row in card.rows.items()}
    assert len(rows) == 12
    assert (rows["K.x"].value, rows["K.x"].expanded) == ("1.002\u2009335", "0.000\u2009021")
    assert (rows["B.y"].value, rows["B.y"].expanded) == ("−8.46", "0.35")
    assert (rows["L.yx"].value, rows["L.yx"].name) == ("−0.924", "X→Y")


def test_a_unit_is_switched_for_card_and_details(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    card = screens.results.cards["misalignment"]
    screens.results.choose("L.yz")
    card.switch_unit("arcsec")
    assert card.rows["L.yz"].texts().value == "181.27"
    screens.results.tabs.setCurrentIndex(2)
    assert "181.27" in screens.results.budget._sum.text()


def test_no_limits_are_set_and_that_is_said(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    assert screens.results.verdict.title() == "Measured; no limits are set"
    assert "deviations from the standard: 1" in screens.results.verdict.text()
    screens.results.verdict.pressed.emit()
    assert screens.window.current_page() == "certificate"
    screens.settle(qtbot)


def test_rows_are_chosen_by_the_keyboard(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    row = screens.results.cards["zero_offset"].rows["B.z"]
    row.setFocus()
    QTest.keyClick(row, Qt.Key.Key_Space)
    assert row.isChecked()
    assert not screens.results.cards["scale_factor"].rows["K.x"].isChecked()


@pytest.mark.parametrize(
    ("key", "point", "segment"), [("K.x", 2, "sf_x_-100"), ("B.y", 3, "zo_y_4"), ("L.zy", 1, "ma_y_minus")]
)
def test_a_click_on_a_point_opens_its_raw_segment(
    screens: Screens, qtbot: QtBot, key: str, point: int, segment: str
) -> None:
    open_result(screens, qtbot)
    screens.results.choose(key)
    plot = screens.results.plot.plot
    assert plot is not None
    qtbot.waitUntil(lambda: plot.canvas().width() > 100)
    place = plot.points()[point]
    QTest.mouseClick(plot.canvas(), Qt.MouseButton.LeftButton, pos=plot.point_on_screen(*place).toPoint())
    qtbot.waitUntil(lambda: screens.results.plot.shows_segment() == segment)
    screens.results.plot.back.click()
    assert screens.results.plot.shows_segment() == ""


def test_a_segment_that_is_gone_is_said(
    screens: Screens, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    def gone(number: str, file: str) -> None:
        raise InputError("The recording of job {number} has no segment {file}.", number=number, file=file)

    open_result(screens, qtbot)
    monkeypatch.setattr(screens.laboratory, "segment_samples", gone)
    screens.results.plot.segment_wanted.emit("sf_x_100")
    qtbot.waitUntil(lambda: bool(screens.notices))
    assert "has no segment sf_x_100" in screens.notices[-1][1]
    assert screens.results.again.isEnabled()


def test_the_budget_lists_every_source_the_largest_first(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    screens.results.choose("B.x")
    table = screens.results.budget.table
    first = table.texts(0)
    assert first[0] == "table rate, 10–1000 °/s band"
    assert first[-1] == "71.0 %"
    assert [table.texts(row)[-1] for row in range(7)] == [
        "71.0 %", "17.0 %", "7.0 %", "3.0 %", "1.5 %", "0.4 %", "0.1 %",
    ]  # fmt: skip


def with_check(screens: Screens, qtbot: QtBot, *, validated: bool = True) -> Quantity:
    """The zero offset of axis x, with a Monte Carlo check, shown on the tab of its budget."""
    open_result(screens, qtbot)
    screens.results.choose("B.x")
    screens.results.tabs.setCurrentIndex(2)
    found = screens.results._quantities["B.x"]
    low, high = found.value - 1e-4, found.value + 1e-4
    check = MonteCarloCheck(
        200_000, 1, found.value, 5e-5, (low, high), (low, high), 1, 5e-6, validated, (low, high), (1, 4, 1)
    )
    checked = replace(found, uncertainty=replace(found.uncertainty, monte_carlo=check))
    screens.results.budget.show_quantity(checked, units(checked)[0])
    screens.settle(qtbot)
    return checked


def typed(screens: Screens, qtbot: QtBot, key: str, text: str, end: Qt.Key = Qt.Key.Key_Return) -> None:
    """Into the cell u(x) of a row, as a person does it."""
    table = screens.results.budget.table
    table.choose(key)
    QTest.keyClick(table, Qt.Key.Key_F2)
    (editor,) = [editor for editor in table.findChildren(QLineEdit) if editor.isVisible()]
    editor.setText(text)
    QTest.keyClick(editor, end)
    screens.settle(qtbot)


def test_what_if_says_what_u_would_be_and_touches_nothing(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    screens.results.choose("B.x")
    screens.results.tabs.setCurrentIndex(2)
    budget = screens.results.budget
    before, total = screens.results._judged, budget._sum.text()
    rows = [budget.table.texts(row) for row in range(7)]
    assert budget.strip.text() == ""
    typed(screens, qtbot, budget.table.keys()[0], "0")
    assert "instead of 0.350 °/h" in budget.strip.text()
    assert "Not the result" in budget.strip.text()
    assert "→ 0 °/s" in budget.table.texts(0)[2]
    assert budget.table.texts(0)[-1] == "0.0 %"
    assert budget._sum.text() == total
    typed(screens, qtbot, budget.table.keys()[0], "")
    assert budget.strip.text() == ""
    typed(screens, qtbot, budget.table.keys()[1], "1E−5")
    budget.strip.reset_button.click()
    screens.settle(qtbot)
    assert [budget.table.texts(row) for row in range(7)] == rows
    assert screens.results._judged == before
    assert before is not None
    assert before.computed == screens.laboratory.result(screens.number("measured"))


def test_what_is_no_uncertainty_is_said_and_escape_restores(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    budget = screens.results.budget
    screens.results.tabs.setCurrentIndex(2)
    key = budget.table.keys()[0]
    typed(screens, qtbot, key, "much")
    assert "“much” is not a number" in budget.strip.text()
    typed(screens, qtbot, key, "-1")
    assert "has to be 0 or more" in budget.strip.text()
    budget.strip.reset_button.click()
    typed(screens, qtbot, key, "5", Qt.Key.Key_Escape)
    assert budget.strip.text() == ""


def test_a_double_click_or_the_button_edits(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    budget = screens.results.budget
    screens.results.tabs.setCurrentIndex(2)
    budget.ask_button.click()
    editor = budget.table.findChild(QLineEdit)
    assert editor is not None
    QTest.keyClick(editor, Qt.Key.Key_Escape)
    screens.settle(qtbot)
    budget.table.opened.emit(budget.table.keys()[2])
    assert budget.table.current_key() == budget.table.keys()[2]
    screens.settle(qtbot)


def test_another_quantity_forgets_what_was_asked(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    budget = screens.results.budget
    budget.change(budget.table.keys()[0], "0")
    screens.results.cards["scale_factor"].switch_unit("ppm")
    assert "ppm" in budget.strip.text()  # another unit is the same question
    screens.results.choose("B.y")
    screens.results.choose("K.x")
    assert budget.strip.text() == ""


@pytest.mark.parametrize(("validated", "words"), [(True, "is validated"), (False, "is not validated")])
def test_the_monte_carlo_check_stands_beside_the_budget(
    screens: Screens, qtbot: QtBot, validated: bool, words: str
) -> None:
    with_check(screens, qtbot, validated=validated)
    check = screens.results.budget.check
    assert check.plot is not None
    assert check.plot.isVisible()
    assert words in check.verdict.text()
    assert "200\u2009000 trials, u = 0.18 °/h" in check.verdict.text()
    assert "δ = 0.018 °/h" in check.verdict.text()
    assert check.ends["gum"].text() == "[10.76, 11.46] °/h"
    assert check.ends["symmetric"].text() == "[10.75, 11.47] °/h"
    screens.results.budget.check_button.click()
    assert not check.isVisible()


def test_a_result_without_a_check_says_so(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    screens.results.tabs.setCurrentIndex(2)
    check = screens.results.budget.check
    assert "no Monte Carlo check" in check.nothing.text()
    assert check.nothing.isVisible()
    found = screens.results._quantities["K.x"]
    annex = replace(found, uncertainty=replace(found.uncertainty, method="annex-a"))
    check.show_quantity(annex, units(annex)[0])
    assert "Annex A" in check.nothing.text()


def test_the_budgets_are_saved_for_a_spreadsheet(
    screens: Screens, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    open_result(screens, qtbot)
    target = tmp_path / "budget.csv"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    screens.results.budget.save_button.click()
    screens.settle(qtbot)
    assert "table rate" in target.read_text(encoding="utf-8-sig")
    assert screens.notices[-1][0] == "good"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(target / "no" / "b.csv"), ""))
    screens.results.budget.save_button.click()
    screens.settle(qtbot)
    assert screens.notices[-1][0] == "bad"


def test_the_sheet_has_both_usual_units(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    texts = screens.results.values.table.texts(3)
    assert texts[0] == "Zero offset of axis X (heading)"
    assert texts[2:8] == ["0.003\u2009087", "0.000\u2009097", "°/s", "11.11", "0.35", "°/h"]


def test_warnings_and_deviations_are_sentences(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    texts = screens.results.findings.texts
    assert "The table did not hold the rate. (segment sf_x_plus_100, line 1204)" in texts
    assert "(20.4 ± 0.3) °C, (48 ± 2) %RH" in texts


def test_calculating_again_runs_in_the_worker_and_stores(
    screens: Screens, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[EvaluationSettings] = []
    real = screens.laboratory.recalculate

    def recalculate(number: str, settings: EvaluationSettings, actor: object) -> object:
        asked.append(settings)
        return real(number, settings, actor)  # type: ignore[arg-type]

    open_result(screens, qtbot)
    monkeypatch.setattr(screens.laboratory, "recalculate", recalculate)
    screens.results._ways[EvaluationSettings("table", "annex-a")].trigger()
    assert not screens.results.again.isEnabled()
    screens.settle(qtbot)
    assert asked == [EvaluationSettings("table", "annex-a")]
    assert screens.results.again.isEnabled()


def test_a_signed_result_is_not_calculated_again(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("checked"), "results")
    assert not screens.results.again.isVisible()


def test_a_job_without_a_result_says_what_comes(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("ready"), "results")
    assert not screens.results.verdict.isVisible()
    screens.results._empty.pressed.emit()
    assert screens.window.current_page() == "jobs"


def test_evaluation_is_waited_for_with_a_sign(screens: Screens, qtbot: QtBot) -> None:
    open_result(screens, qtbot)
    screens.desk.evaluating.emit(True)
    assert not screens.results.verdict.isVisible()
    screens.desk.evaluating.emit(False)
    assert screens.results.verdict.isVisible()
