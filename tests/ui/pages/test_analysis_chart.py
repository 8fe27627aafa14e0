"""A chart of a report: axes, cursor, zoom, bands and marks, and many points."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from ahrs_lab.analysis.report import Chart, Curve, Mark
from ahrs_lab.messages import Message
from ahrs_lab.ui.pages.analysis.chart_view import ChartView
from ahrs_lab.ui.pages.analysis.curve_looks import curve_looks
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS
from tests.ui.conftest import Look

TITLE, X, Y = Message("operator"), Message("t, s"), Message("ω, °/h")


def chart(*curves: Curve, **more: object) -> Chart:
    return Chart(TITLE, X, Y, curves, **more)  # type: ignore[arg-type]


@pytest.fixture
def view(look: Look, qtbot: QtBot) -> ChartView:
    made = ChartView()
    qtbot.addWidget(made)
    made.resize(640, 360)
    made.show()
    look.settle()
    return made


def point(view: ChartView, look: Look, x: float) -> None:
    """The mouse moves over ``x`` of the chart."""
    place = view.place_on_canvas(x)
    target = view.canvas.viewport()
    everywhere = QPointF(target.mapToGlobal(place.toPoint()))
    none = Qt.MouseButton.NoButton
    event = QMouseEvent(QEvent.Type.MouseMove, place, everywhere, none, none, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(target, event)
    look.settle()


def test_axes_of_the_unit_look_everywhere_the_same_and_a_model_is_told_apart() -> None:
    nothing = np.zeros(1)
    looks = curve_looks(
        [
            *(Curve(axis, nothing, nothing, axis=axis) for axis in ("x", "y", "z")),
            Curve("model", nothing, nothing, axis="y", style="dashed"),
            Curve("points", nothing, nothing, style="points"),
            Curve("other", nothing, nothing),
        ]
    )
    assert [look.colour for look in looks[:3]] == list(AXIS_COLOURS.values())
    assert [look.pen for look in looks[:3]] == list(AXIS_PENS.values())
    assert looks[3].colour == looks[1].colour
    assert looks[3].pen not in AXIS_PENS.values()
    assert looks[4].points
    assert len({look.colour for look in looks}) == 5


def test_the_legend_tells_the_values_under_the_cursor(view: ChartView, look: Look) -> None:
    t_s = np.linspace(0.0, 10.0, 101)
    view.show_chart(chart(Curve("X", t_s, t_s**2, axis="x"), Curve("short", t_s[:20], -1e-7 * t_s[:20])))
    assert view.legend.texts() == ["X", "short"]
    point(view, look, 1.5)
    assert view.legend.texts()[:2] == ["X 2.25", "short −1.5×10−7"]
    # The cursor stands at a sample.
    assert view.legend.texts()[2] == "t, s: 1.5"
    point(view, look, 8.0)
    assert view.legend.texts()[:2] == ["X 64", "short"]
    QApplication.sendEvent(view.canvas, QEvent(QEvent.Type.Leave))
    assert view.legend.texts() == ["X", "short"]


def test_logarithmic_axes_have_decades_and_leave_out_what_is_not_above_zero(
    view: ChartView, look: Look
) -> None:
    tau = np.logspace(-2, 3, 26)
    sigma = 0.3 / np.sqrt(tau)
    sigma[-2] = 0.0
    view.show_chart(chart(Curve("X", tau, sigma, 0.1 - tau, 2 * sigma, "x"), log_x=True, log_y=True))
    look.settle()
    assert view.tick_texts("bottom") == ["0.01", "0.1", "1", "10", "100", "1000"]
    assert "0.1" in view.tick_texts("left")
    ((x, y),) = view.curves()
    assert x[0] == pytest.approx(-2.0)
    assert y[0] == pytest.approx(np.log10(3.0))
    point(view, look, 1.0)
    assert view.legend.texts()[0] == "X 0.3"


def test_marks_outside_the_curves_are_not_shown(view: ChartView, look: Look) -> None:
    t_s = np.linspace(0.0, 10.0, 11)
    marks = (Mark(9.9, "late"), Mark(1.0, Message("operator")), Mark(1.1, "next"), Mark(99.0, "far"))
    view.show_chart(chart(Curve("X", t_s, t_s), marks=marks))
    assert view.mark_names() == ["operator", "next", "late"]


def test_zoom_shows_more_of_a_long_record_and_a_double_click_all_again(view: ChartView, look: Look) -> None:
    t_s = np.arange(300_000) / 100.0
    y = np.zeros_like(t_s)
    y[123_456] = 7.0
    view.show_chart(chart(Curve("X", t_s, y, axis="x")))
    look.settle()
    ((x, drawn),) = view.curves()
    assert len(x) < 4000
    assert drawn.max() == 7.0
    assert not view.whole.isVisible()
    place = view.place_on_canvas(1234.56)
    target = view.canvas.viewport()
    for _ in range(12):
        event = QWheelEvent(
            place,
            QPointF(target.mapToGlobal(place.toPoint())),
            place.toPoint(),
            place.toPoint() * 0 + QPointF(0, 240).toPoint(),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(target, event)
        look.settle()
    assert view.whole.isVisible()
    ((x, drawn),) = view.curves()
    assert np.min(np.diff(np.unique(x))) == pytest.approx(0.01)
    assert x.max() - x.min() < 200.0
    view.whole.click()
    ((x, _),) = view.curves()
    assert (x.min(), x.max()) == (0.0, t_s[-1])
    assert not view.whole.isVisible()


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize("values", [[], [np.nan], [0.0], [-1.0, -1.0], [5.0]])
def test_curves_without_extent_are_shown_without_complaint(
    view: ChartView, look: Look, values: list[float], log: bool
) -> None:
    y = np.array(values, dtype=np.float64)
    view.show_chart(chart(Curve("a", y, y, y, y), log_x=log, log_y=log))
    look.settle()
    assert view.grab().width() > 0
    view.show_chart(chart())
    look.settle()
    assert view.legend.texts() == []


def test_a_gap_breaks_the_curve(view: ChartView) -> None:
    t_s = np.arange(10.0)
    y = np.where(t_s == 5.0, np.nan, t_s)
    view.show_chart(chart(Curve("a", t_s, y)))
    ((_, drawn),) = view.curves()
    assert np.isnan(drawn[5])


def test_a_track_has_one_scale_for_both_axes_and_the_next_chart_its_own(view: ChartView, look: Look) -> None:
    east, north = np.linspace(0.0, 1000.0, 20), np.linspace(0.0, 10.0, 20)

    def pixels() -> tuple[float, float]:
        look.settle()
        size = view.canvas.getPlotItem().getViewBox().viewPixelSize()
        return float(size[0]), float(size[1])

    view.show_chart(chart(Curve("track", east, north), equal=True))
    across, up = pixels()
    assert across == pytest.approx(up)
    view.show_chart(chart(Curve("track", east, north)))
    across, up = pixels()
    assert up < 0.1 * across


def test_what_is_constant_but_for_rounding_is_drawn_as_a_line(view: ChartView, look: Look) -> None:
    t_s = np.linspace(0.0, 90.0, 50)
    view.show_chart(chart(Curve("height", t_s, 50.0 + 1e-8 * np.sin(t_s))))
    view.canvas.grab()
    look.settle()
    texts = view.tick_texts("left")
    assert "50.000\N{THIN SPACE}00" in texts
    assert all("10^" not in text for text in texts)
