"""A quiet plot for evaluated data: few grid lines, axes in the theme's colours, points that can be clicked.

pyqtgraph is imported with this module: import it when the first plot is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QVBoxLayout, QWidget

from ahrs_lab.ui.formatting import MINUS
from ahrs_lab.ui.theme import TEXT_PX, font, tokens

Array = NDArray[np.float64]
_POINT_PX = 9


class _Axis(pg.AxisItem):  # type: ignore[misc]
    """Numbers with a true minus."""

    def tickStrings(self, values: list[float], scale: float, spacing: float) -> list[str]:
        return [text.replace("-", MINUS) for text in super().tickStrings(values, scale, spacing)]


class Plot(QWidget):
    """``picked`` tells the number of the clicked point of the last :meth:`add_points`.

    Content is described again after a change of theme by whoever listens to ``restyled``.
    """

    picked = Signal(int)
    restyled = Signal()

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        self._view = pg.PlotWidget(
            axisItems={side: _Axis(side) for side in ("left", "bottom")}, enableMenu=False
        )
        self._view.setFrameShape(self._view.Shape.NoFrame)
        self._view.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._item = self._view.getPlotItem()
        self._item.hideButtons()
        # pyqtgraph makes this menu all the same, as a window of nobody's: it has to go with the plot.
        self._item.ctrlMenu.setParent(self, self._item.ctrlMenu.windowFlags())
        self._item.setMouseEnabled(x=False, y=False)
        self._item.showGrid(x=False, y=True, alpha=0.18)
        for side in ("left", "bottom"):
            axis = self._item.getAxis(side)
            axis.setStyle(tickFont=font("text"), tickLength=0, maxTickLevel=1)
            axis.enableAutoSIPrefix(False)
        self._labels = ("", "")
        self._points: list[tuple[float, float]] = []
        column.addWidget(self._view)
        self._style()

    def clear(self, x_label: str, y_label: str) -> None:
        """An empty plot with these axis titles, units included."""
        self._item.clear()
        for side in ("left", "bottom"):
            self._item.getAxis(side).setTicks(None)
        self._labels = (x_label, y_label)
        self._style()
        self._item.enableAutoRange()

    def set_ranges(self, x: tuple[float, float] | None, y: tuple[float, float] | None) -> None:
        """Fixed ranges; None leaves the axis to the data."""
        if x is not None:
            self._item.setXRange(*x, padding=0.0)
        if y is not None:
            self._item.setYRange(*y, padding=0.0)

    def set_names(self, positions: Sequence[float], names: Sequence[str], side: str = "bottom") -> None:
        """Words instead of numbers below the horizontal axis, or beside the vertical one (``left``)."""
        self._item.getAxis(side).setTicks([list(zip(positions, names, strict=True))])

    def add_points(
        self, x: Array, y: Array, colour: str, errors: Array | None = None, *, hollow: bool = False
    ) -> None:
        """Points with error bars; they can be clicked."""
        if errors is not None and np.any(errors > 0.0):
            span = float(np.ptp(x)) if x.size > 1 else 1.0
            self._item.addItem(
                pg.ErrorBarItem(
                    x=x, y=y, height=2.0 * errors, beam=0.012 * (span or 1.0), pen=pg.mkPen(colour, width=1.5)
                )
            )
        brush = tokens().card if hollow else colour
        points = pg.ScatterPlotItem(
            x=x, y=y, size=_POINT_PX, pen=pg.mkPen(colour, width=1.5), brush=pg.mkBrush(brush),
            hoverable=True, hoverSize=_POINT_PX + 4, data=np.arange(x.size), tip=None,
        )  # fmt: skip
        self._points = [(float(a), float(b)) for a, b in zip(x, y, strict=True)]
        points.sigClicked.connect(self._clicked)
        self._item.addItem(points)

    def add_curve(
        self,
        x: Array,
        y: Array,
        colour: str,
        *,
        width: float = 1.0,
        style: Qt.PenStyle = Qt.PenStyle.SolidLine,
    ) -> None:
        """A line through the values."""
        self._item.addItem(pg.PlotCurveItem(x=x, y=y, pen=pg.mkPen(colour, width=width, style=style)))

    def add_bars(self, edges: Array, heights: Array, colour: str) -> None:
        """A histogram: ``edges``, shape (n + 1,), about ``heights``, shape (n,)."""
        tint = QColor(colour)
        tint.setAlphaF(0.35)
        self._item.addItem(
            pg.PlotCurveItem(
                x=edges,
                y=heights,
                stepMode="center",
                fillLevel=0.0,
                brush=pg.mkBrush(tint),
                pen=pg.mkPen(None),
            )
        )

    def hide_heights(self) -> None:
        """No vertical axis: heights only compare with each other."""
        self._item.hideAxis("left")
        self._item.showGrid(x=False, y=False)

    def add_level(self, y: float, colour: str, *, dashed: bool = False) -> None:
        """A horizontal line across."""
        style = Qt.PenStyle.DashLine if dashed else Qt.PenStyle.SolidLine
        self._item.addItem(pg.InfiniteLine(pos=y, angle=0, pen=pg.mkPen(colour, width=1, style=style)))

    def add_band(self, low: float, high: float, colour: str) -> None:
        """A tinted band across, for an interval."""
        tint = QColor(colour)
        tint.setAlphaF(0.12)
        self._item.addItem(
            pg.LinearRegionItem(
                (low, high),
                orientation="horizontal",
                movable=False,
                brush=pg.mkBrush(tint),
                pen=pg.mkPen(None),
            )
        )

    def add_upright(self, x: float, colour: str) -> None:
        """A dashed vertical line."""
        pen = pg.mkPen(colour, width=1, style=Qt.PenStyle.DashLine)
        self._item.addItem(pg.InfiniteLine(pos=x, angle=90, pen=pen))

    def add_area(self, x: Array, low: Array, high: Array, colour: str) -> None:
        """A tinted area between two curves."""
        tint = QColor(colour)
        tint.setAlphaF(0.16)
        edges = [pg.PlotCurveItem(x=x, y=y, pen=pg.mkPen(None)) for y in (low, high)]
        for edge in edges:
            self._item.addItem(edge)
        self._item.addItem(pg.FillBetweenItem(*edges, brush=pg.mkBrush(tint)))

    def add_rings(self, x: Array, y: Array, colour: str) -> None:
        """Rings round points that a person is to look at."""
        self._item.addItem(
            pg.ScatterPlotItem(
                x=x, y=y, size=_POINT_PX + 12, pen=pg.mkPen(colour, width=2.0), brush=pg.mkBrush(None)
            )
        )

    def add_note(self, x: float, y: float, text: str, colour: str, *, above: bool = True) -> None:
        """A short text at a place of the plot."""
        note = pg.TextItem(text, color=QColor(colour), anchor=(0.5, 1.25 if above else -0.25))
        note.setFont(font("text"))
        note.setPos(x, y)
        self._item.addItem(note)

    def points(self) -> list[tuple[float, float]]:
        """Where the points of the last :meth:`add_points` are."""
        return self._points

    def point_on_screen(self, x: float, y: float) -> QPointF:
        """Where a place of the plot is in the widget."""
        scene = self._item.vb.mapViewToScene(QPointF(x, y))
        return QPointF(self._view.mapFromScene(scene))

    def canvas(self) -> QWidget:
        """The widget that takes the mouse."""
        viewport: QWidget = self._view.viewport()
        return viewport

    def _clicked(self, _scatter: object, points: Sequence[Any], _event: object = None) -> None:
        if len(points):
            self.picked.emit(int(points[0].data()))

    def _style(self) -> None:
        look = tokens()
        self._view.setBackground(look.card)
        for side, label in zip(("bottom", "left"), self._labels, strict=True):
            axis = self._item.getAxis(side)
            axis.setPen(pg.mkPen(look.line))
            axis.setTextPen(pg.mkPen(look.muted))
            axis.setLabel(label, **{"color": look.muted, "font-size": f"{TEXT_PX}px"})

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self._style()
            self.restyled.emit()
        super().changeEvent(event)
