"""The page Results: values, units, plots, the raw segment behind a point, and calculating again."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.evaluation import EvaluationSettings
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
