"""The live plot draws what the rings hold, only while it is seen."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QPainter, QPixmap
from pytestqt.qtbot import QtBot

from ahrs_lab.ui.plots.envelope import EnvelopeRing
from ahrs_lab.ui.plots.live_plot import Channel, LivePlot, PanelSpec, Readout
from tests.ui.conftest import Look

COLOURS = ("#d55e00", "#009e73", "#0072b2")


@pytest.fixture
def ring() -> EnvelopeRing:
    return EnvelopeRing(3)


@pytest.fixture
def plot(look: Look, qtbot: QtBot, ring: EnvelopeRing) -> LivePlot:
    made = LivePlot([PanelSpec(ring, tuple(Channel(i, colour) for i, colour in enumerate(COLOURS)))])
    qtbot.addWidget(made)
    made.resize(600, 300)
    made.show()
    look.settle()
    return made


def fill(ring: EnvelopeRing, level: float = 0.0) -> None:
    t_s = np.arange(0.0, 60.0, 0.01)
    ring.append(t_s, np.vstack([np.full_like(t_s, level + i) for i in range(3)]))


def painted(plot: LivePlot) -> set[str]:
    picture = plot.grab().toImage()
    width, height = picture.width(), picture.height()
    return {QColor(picture.pixel(width * 3 // 4, y)).name() for y in range(height)} & set(COLOURS)


def test_curves_appear_when_data_come_after_the_plot_was_shown_empty(
    plot: LivePlot, ring: EnvelopeRing
) -> None:
    assert painted(plot) == set()
    fill(ring)
    plot.draw()
    assert painted(plot) == set(COLOURS)


def test_hold_keeps_the_picture(plot: LivePlot, ring: EnvelopeRing) -> None:
    fill(ring)
    plot.draw()
    before = plot.grab().toImage()
    plot.set_hold(True)
    ring.append(np.array([61.0]), np.full((3, 1), 40.0))
    plot.draw()
    assert plot.grab().toImage() == before
    plot.set_hold(False)
    plot.draw()
    assert plot.grab().toImage() != before


def test_timer_runs_only_while_data_come_and_the_plot_is_seen(plot: LivePlot) -> None:
    def drawing() -> bool:
        return plot.drawing

    assert drawing()
    plot.hide()
    assert not drawing()
    plot.show()
    assert drawing()
    plot.set_running(False)
    assert not drawing()


def test_cursor_reads_the_mean_of_each_curve(plot: LivePlot, ring: EnvelopeRing, qtbot: QtBot) -> None:
    fill(ring, 2.0)
    plot.draw()
    with qtbot.waitSignal(plot.pointed) as told:
        plot.point_at(-30.0)
    readout = told.args[0]
    assert isinstance(readout, Readout)
    assert readout.t_s == -30.0
    assert readout.values[0] == pytest.approx((2.0, 3.0, 4.0))
    with qtbot.waitSignal(plot.pointed) as told:
        plot.point_at(None)
    assert told.args == [None]


def test_another_run_starts_with_an_empty_picture(plot: LivePlot, ring: EnvelopeRing) -> None:
    fill(ring)
    plot.draw()
    plot.set_rings([EnvelopeRing(3)])
    assert painted(plot) == set()


def numbers(plot: LivePlot) -> list[tuple[str, QRectF]]:
    """What stands at the value axis, and where."""
    sheet = QPixmap(100, 100)
    painter = QPainter(sheet)
    try:
        texts = plot.panels[0].getAxis("left").generateDrawSpecs(painter)[2]
    finally:
        painter.end()
    return [(text, rect) for rect, _, text in texts]


def show_at(plot: LivePlot, look: Look, axis_px: int) -> None:
    """Make the value axis that long."""
    panel = plot.panels[0]
    around = panel.height() - round(panel.getAxis("left").geometry().height())
    panel.setFixedHeight(axis_px + around)
    look.settle()
    assert panel.getAxis("left").geometry().height() == pytest.approx(axis_px, abs=1.0)


@pytest.mark.parametrize("span", [1.0, 200.0, 1e-3])
@pytest.mark.parametrize("lowest", [-0.5, -1.0, 0.0, -0.13, 0.31, -2.9, 7.77])
def test_numbers_of_an_axis_never_overlap(look: Look, qtbot: QtBot, span: float, lowest: float) -> None:
    ring = EnvelopeRing(1)
    t_s = np.arange(0.0, 60.0, 0.01)
    ring.append(t_s, span * (lowest + np.where(t_s < 30.0, 0.0, 1.0))[None])
    plot = LivePlot([PanelSpec(ring, (Channel(0, COLOURS[0]),), smallest=span / 100.0)])
    qtbot.addWidget(plot)
    plot.resize(600, 300)
    plot.show()
    look.settle()
    plot.draw()
    for axis_px in (*range(30, 80, 3), *range(80, 201, 20)):
        show_at(plot, look, axis_px)
        shown = numbers(plot)
        assert shown, f"no number on {axis_px} px"
        assert len({text for text, _ in shown}) == len(shown)
        for (a, over), (b, under) in itertools.pairwise(sorted(shown, key=lambda number: number[1].top())):
            assert not over.intersects(under), f"{a} over {b} on {axis_px} px"
        assert len(shown) >= 2 or axis_px < 80


@pytest.mark.parametrize(
    ("axis_px", "texts"), [(30, {"0"}), (45, {"−200", "200"}), (160, {"−200", "−100", "0", "100", "200"})]
)
def test_a_low_axis_has_fewer_numbers(
    look: Look, plot: LivePlot, ring: EnvelopeRing, axis_px: int, texts: set[str]
) -> None:
    fill(ring, -200.0)
    ring.append(np.array([59.9]), np.full((3, 1), 200.0))
    plot.draw()
    show_at(plot, look, axis_px)
    assert {text for text, _ in numbers(plot)} == texts
