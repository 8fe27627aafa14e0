"""The tab Diagnosis: the chosen quantity's plot, each finding as a sentence with its state, and the raw
segments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.procedures.reduction import reduce_recording
from ahrs_lab.ui.pages.results.diagnosis_view import DiagnosisView
from ahrs_lab.ui.pages.results.quantities import quantities
from tests.procedures.virtual_unit import VirtualUnit, changed
from tests.ui.pages.conftest import Screens


@pytest.fixture(scope="module")
def result() -> CalibrationResult:
    """X of a unit whose sixth rate stands apart, with the multi-position method and its turns."""
    unit = VirtualUnit(density=2.5e-4, rng=np.random.default_rng(5))
    rates = unit.rates("x")
    rates[6] = changed(rates[6], gyro_x=rates[6].samples["gyro_x"] + 0.02)
    return reduce_recording(
        unit.recording([*rates, *unit.turns("x"), *unit.azimuths("x", 12, 180.0), *unit.positions("y", 60.0)])
    )


@pytest.fixture
def view(qtbot: QtBot) -> DiagnosisView:
    shown = DiagnosisView()
    qtbot.addWidget(shown)
    shown.resize(1100, 300)
    shown.show()
    return shown


def choose(view: DiagnosisView, result: CalibrationResult, key: str) -> None:
    view.show_quantity(next(one for one in quantities(result) if one.key == key), result)


def places(view: DiagnosisView) -> list[float]:
    assert view.plot is not None
    return [x for x, _ in view.plot.points()]


def test_residuals_stand_against_rate_order_and_time(view: DiagnosisView, result: CalibrationResult) -> None:
    choose(view, result, "K.x")
    assert view.against.isVisible()
    assert not view.what.isVisible()
    assert places(view) == list(result.scale_factor["x"].rates_dps)
    view.against.button("order").click()
    assert places(view) == [1, 2, 3, 4, 5, 6, 7, 8]
    view.against.button("time").click()
    assert places(view) == pytest.approx([0.6 * n for n in range(8)])


def test_the_warning_stands_first_and_names_its_rate(view: DiagnosisView, result: CalibrationResult) -> None:
    choose(view, result, "K.x")
    assert view.texts[0].startswith("At 100 °/s the mean lies")
    assert len(view.texts) == 4


def test_the_zero_offset_has_allan_recordings_and_the_earths_rate(
    view: DiagnosisView, result: CalibrationResult
) -> None:
    choose(view, result, "B.x")
    assert view.what.current() == "allan"
    assert places(view) == pytest.approx([np.log10(2.0**n) for n in range(7)])
    view.what.button("harmonic").click()
    assert places(view) == [30.0 * n for n in range(12)]
    view.what.button("positions").click()
    assert len(places(view)) == 12
    assert any("ω_ie·cos φ" in text for text in view.texts)


def test_four_positions_offer_no_earths_rate(view: DiagnosisView, result: CalibrationResult) -> None:
    choose(view, result, "B.x")
    view.what.button("harmonic").click()
    choose(view, result, "B.y")
    assert not view.what.button("harmonic").isVisible()
    assert view.what.current() == "allan"


def test_a_misalignment_shows_both_senses(view: DiagnosisView, result: CalibrationResult) -> None:
    choose(view, result, "L.yx")
    assert places(view) == [1.0, 2.0]
    assert not view.against.isVisible()
    assert not view.what.isVisible()
    assert "Both senses lasted equally long, 38 s." in view.texts


def test_a_click_on_a_point_asks_for_its_segment(
    view: DiagnosisView, result: CalibrationResult, qtbot: QtBot
) -> None:
    choose(view, result, "K.x")
    plot = view.plot
    assert plot is not None
    qtbot.waitUntil(lambda: plot.canvas().width() > 100)
    place = plot.point_on_screen(*plot.points()[2]).toPoint()
    with qtbot.waitSignal(view.segment_wanted) as asked:
        QTest.mouseClick(plot.canvas(), Qt.MouseButton.LeftButton, pos=place)
    assert asked.args == ["sf_x_02"]


def test_an_older_result_says_that_it_has_none(view: DiagnosisView, result: CalibrationResult) -> None:
    choose(view, replace(result, diagnosis=None), "K.x")
    assert "an earlier version" in view._none.text()
    assert view._none.isVisible()
    assert view.texts == []


def test_a_segment_asked_for_opens_beside_the_plot(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("measured"), "results")
    screens.settle(qtbot)
    screens.results.tabs.setCurrentIndex(3)
    screens.results.diagnosis.segment_wanted.emit("sf_x_100")
    qtbot.waitUntil(lambda: screens.results.plot.shows_segment() == "sf_x_100")
    assert screens.results.tabs.currentIndex() == 0
