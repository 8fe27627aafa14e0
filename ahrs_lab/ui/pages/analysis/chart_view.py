"""One chart of a report on the screen: curves with their bands, linear or logarithmic axes, marks with their
names, values under the cursor; wheel and mouse zoom, a double click shows all again.

pyqtgraph is imported with this module: import it when the first chart is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPen
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.analysis.curve_thinning import thinned
from ahrs_lab.analysis.report import Cell, Chart, Curve
from ahrs_lab.analysis.report_cells import readable
from ahrs_lab.certificates.axis_scale import air_around
from ahrs_lab.ui.pages.analysis.chart_axis import ChartAxis
from ahrs_lab.ui.pages.analysis.curve_looks import CurveLook, curve_looks
from ahrs_lab.ui.pages.analysis.legend import Entry, Legend
from ahrs_lab.ui.theme import STEP, TEXT_PX, font, tokens
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import IconButton, rich_text

Array = NDArray[np.float64]

_PLACES = 1600
"""Points kept across the axis: more than a screen has."""
_MARGIN_X, _MARGIN_Y = 0.015, 0.06
_POINT_PX = 6
_NAME_PX = 17
"""Height of a mark's name."""


class _Canvas(pg.PlotWidget):  # type: ignore[misc]
    pointed = Signal(object)
    whole_wanted = Signal()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        super().mouseMoveEvent(event)
        self.pointed.emit(event.position())

    def leaveEvent(self, event: QEvent) -> None:
        super().leaveEvent(event)
        self.pointed.emit(None)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.whole_wanted.emit()
        event.accept()


class ChartView(QWidget):
    """``show_chart`` draws another chart; a change of theme draws the same one again."""

    def __init__(self) -> None:
        super().__init__()
        self._chart: Chart | None = None
        self._drawn: tuple[Curve, ...] = ()
        self._looks: tuple[CurveLook, ...] = ()
        self._items: list[tuple[pg.PlotDataItem, Curve]] = []
        self._marks: list[tuple[float, pg.TextItem]] = []
        self._dense = False
        self._setting = False
        self.legend = Legend()
        self.whole = IconButton("zoom_out")
        self.whole.clicked.connect(self.show_whole)
        self._axes = {side: ChartAxis(side) for side in ("left", "bottom")}
        self.canvas = _Canvas(axisItems=self._axes, enableMenu=False)
        self.canvas.setFrameShape(self.canvas.Shape.NoFrame)
        self.canvas.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.canvas.setMouseTracking(True)
        self.canvas.pointed.connect(self._pointed)
        self.canvas.whole_wanted.connect(self.show_whole)
        self._plot = self.canvas.getPlotItem()
        self._plot.hideButtons()
        # pyqtgraph makes this menu all the same, as a window of nobody's: it has to go with the plot.
        self._plot.ctrlMenu.setParent(self, self._plot.ctrlMenu.windowFlags())
        self._plot.setContentsMargins(0, STEP, 3 * STEP, 0)
        for axis in self._axes.values():
            axis.setZValue(-1000)  # the grid lies below the curves
        self._box = self._plot.getViewBox()
        self._box.setDefaultPadding(0.0)
        self._box.disableAutoRange()
        self._box.sigRangeChanged.connect(self._range_changed)
        self._box.sigResized.connect(self._place_marks)
        self._box.sigRangeChangedManually.connect(lambda _sides: self.whole.setVisible(True))
        self._cursor = pg.InfiniteLine(angle=90, movable=False)
        self._lay_out()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(STEP)
        head = QHBoxLayout()
        head.setContentsMargins(STEP, 0, 0, 0)
        head.addWidget(self.legend, 1)
        head.addWidget(self.whole, 0, Qt.AlignmentFlag.AlignTop)
        policy = self.whole.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.whole.setSizePolicy(policy)
        self.whole.setFixedSize(6 * STEP, 5 * STEP)
        self.whole.setVisible(False)
        column.addLayout(head)
        column.addWidget(self.canvas, 1)
        self.setMinimumHeight(150)

    # content --------------------------------------------------------------------------------------------

    def show_chart(self, chart: Chart) -> None:
        """All of it, in the language and the theme that are on."""
        self._chart = chart
        self._looks = curve_looks(chart.curves)
        self._plot.clear()
        self._items, self._marks = [], []
        self._style(chart)
        for name, on in (("bottom", chart.log_x), ("left", chart.log_y)):
            self._axes[name].set_log(on)
            self._axes[name].setGrid(255 if name == "left" or on else False)
        self._drawn = tuple(thinned(curve, _PLACES, log_x=chart.log_x) for curve in chart.curves)
        self._dense = any(
            len(thin.x) < len(curve.x) for thin, curve in zip(self._drawn, chart.curves, strict=True)
        )
        for curve, look in zip(self._drawn, self._looks, strict=True):
            self._add_band(curve, look)
        for curve, thin, look in zip(chart.curves, self._drawn, self._looks, strict=True):
            self._items.append((self._add_curve(thin, look), curve))
        self._add_marks(chart)
        self._cursor.setVisible(False)
        self._plot.addItem(self._cursor, ignoreBounds=True)
        self.legend.set_entries(
            [Entry(_shown(c.label), look) for c, look in zip(chart.curves, self._looks, strict=True)],
            _widest(self._drawn),
        )
        self.show_whole()

    def show_whole(self) -> None:
        """Everything there is, with a little air."""
        if self._chart is None:
            return
        x, y = self._spans(self._chart)
        self._box.setAspectLocked(self._chart.equal)
        self._box.setRange(xRange=x, yRange=y, padding=0.0)
        self.whole.setVisible(False)
        self._refine()
        self._place_marks()

    def curves(self) -> list[tuple[Array, Array]]:
        """What is drawn of each curve, in the coordinates of the view."""
        return [item.getData() for item, _ in self._items]

    def mark_names(self) -> list[str]:
        """The names of the marks within the range that is shown, from left to right."""
        return [text.toPlainText() for _, text in self._marks if text.isVisible()]

    def tick_texts(self, side: str) -> list[str]:
        """The numbers beside (``left``) or below (``bottom``) the chart."""
        axis = self._axes[side]
        return [text for text in axis._texts.values() if text]

    def place_on_canvas(self, x: float) -> QPointF:
        """Where ``x``, in the chart's own numbers, is in the canvas."""
        low, high = self._box.viewRange()[1]
        scene = self._box.mapViewToScene(QPointF(self._x(x), (low + high) / 2))
        return QPointF(self.canvas.mapFromScene(scene))

    # drawing --------------------------------------------------------------------------------------------

    def _style(self, chart: Chart) -> None:
        look = tokens()
        self.canvas.setBackground(look.card)
        for side, label in (("bottom", chart.x_label), ("left", chart.y_label)):
            self._axes[side].restyle()
            style = {"color": look.muted, "font-size": f"{TEXT_PX}px"}
            self._axes[side].setLabel(_html(_shown(label)), **style)
        pen = QPen(look.colour("faint"), 1)
        pen.setCosmetic(True)
        self._cursor.setPen(pen)

    def _x(self, value: float) -> float:
        log = self._chart is not None and self._chart.log_x
        return float(_scaled(np.array([value]), log=log)[0])

    def _points(self, curve: Curve) -> tuple[Array, Array]:
        chart = self._chart
        assert chart is not None
        return _scaled(curve.x, log=chart.log_x), _scaled(curve.y, log=chart.log_y)

    def _add_curve(self, curve: Curve, look: CurveLook) -> pg.PlotDataItem:
        x, y = self._points(curve)
        if look.points:
            item = pg.PlotDataItem(
                x, y, pen=None, symbol="o", symbolSize=_POINT_PX, symbolPen=None, symbolBrush=look.colour
            )
        else:
            item = pg.PlotDataItem(x, y, pen=_pen(look), connect="finite", antialias=not self._dense)
        self._plot.addItem(item)
        return item

    def _add_band(self, curve: Curve, look: CurveLook) -> None:
        chart = self._chart
        if curve.low is None or curve.high is None or chart is None:
            return
        low, high = np.asarray(curve.low, dtype=np.float64), np.asarray(curve.high, dtype=np.float64)
        if chart.log_y:  # a band that reaches down to zero ends far below the picture
            low = np.where(low <= 0.0, np.finfo(np.float64).tiny, low)
        x = _scaled(curve.x, log=chart.log_x)
        low, high = _scaled(low, log=chart.log_y), _scaled(high, log=chart.log_y)
        good = np.isfinite(x) & np.isfinite(low) & np.isfinite(high)
        if good.sum() < 2:
            return
        tint = QColor(look.colour)
        tint.setAlphaF(0.2 if tokens().dark else 0.15)
        edges = [pg.PlotCurveItem(x=x[good], y=edge[good], pen=pg.mkPen(None)) for edge in (low, high)]
        for edge in edges:
            self._plot.addItem(edge)
        self._plot.addItem(pg.FillBetweenItem(*edges, brush=pg.mkBrush(tint)))

    def _add_marks(self, chart: Chart) -> None:
        look = tokens()
        back = look.colour("card")
        back.setAlphaF(0.8)
        for mark in sorted(chart.marks, key=lambda one: one.x):
            x = self._x(mark.x)
            if not np.isfinite(x):
                continue
            line = pg.InfiniteLine(
                pos=x, angle=90, pen=pg.mkPen(look.muted, width=1, style=Qt.PenStyle.DashLine)
            )
            name = pg.TextItem(html=_html(_shown(mark.label), look.text), fill=pg.mkBrush(back))
            name.textItem.document().setDocumentMargin(2)
            name.setFont(font())
            name.setZValue(10)
            self._plot.addItem(line, ignoreBounds=True)
            self._plot.addItem(name, ignoreBounds=True)
            self._marks.append((x, name))

    def _place_marks(self, *_: object) -> None:
        """Names at the top beside their lines; one lower where two would meet, left of the line at the
        edge."""
        (left, right), (bottom, top) = self._box.viewRange()
        if not self._marks or self._box.width() <= 0 or self._box.height() <= 0:
            return
        across, up = (right - left) / self._box.width(), (top - bottom) / self._box.height()
        ends: list[float] = []
        for x, name in self._marks:
            name.setVisible(left <= x <= right)
            if not name.isVisible():
                continue
            width = (name.textItem.boundingRect().width() + 4) * across
            beside = x + 3 * across
            start = beside if beside + width <= right else x - width
            row = next((row for row, end in enumerate(ends) if end <= start), len(ends))
            ends[row : row + 1] = [start + width]
            name.setPos(start, top - (2 + row * _NAME_PX) * up)

    def _spans(self, chart: Chart) -> tuple[tuple[float, float], tuple[float, float]]:
        xs, ys = [np.empty(0)], [np.empty(0)]
        for curve in self._drawn:
            x, y = self._points(curve)
            xs.append(x[np.isfinite(y)])
            ys.append(y)
            if curve.low is not None and curve.high is not None and not chart.log_y:
                ys += [np.asarray(curve.low, dtype=np.float64), np.asarray(curve.high, dtype=np.float64)]
        return (
            _span(np.concatenate(xs), _MARGIN_X, log=chart.log_x),
            _span(np.concatenate(ys), _MARGIN_Y, log=chart.log_y),
        )

    # zoom and cursor ------------------------------------------------------------------------------------

    def _range_changed(self, *_: object) -> None:
        self._place_marks()
        if self._dense and self.whole.isVisible():
            self._refine()

    def _refine(self) -> None:
        """Curves with more points than places show those of the range that is in front."""
        if not self._dense or self._chart is None:
            return
        left, right = self._box.viewRange()[0]
        for item, curve in self._items:
            x = _scaled(curve.x, log=self._chart.log_x)
            if len(x) <= 2 * _PLACES or not np.isfinite(x).all() or (np.diff(x) < 0.0).any():
                continue
            first = max(0, int(np.searchsorted(x, left)) - 1)
            last = int(np.searchsorted(x, right)) + 1
            part = replace(curve, x=curve.x[first:last], y=curve.y[first:last], low=None, high=None)
            item.setData(*self._points(thinned(part, _PLACES, log_x=self._chart.log_x)))

    def _pointed(self, position: QPointF | None) -> None:
        chart = self._chart
        inside = position is not None and self._box.sceneBoundingRect().contains(
            self.canvas.mapToScene(position.toPoint())
        )
        if chart is None or position is None or not inside or not chart.curves:
            self._cursor.setVisible(False)
            self.legend.set_values("", ())
            return
        pointed = self._box.mapSceneToView(self.canvas.mapToScene(position.toPoint())).x()
        near = [_nearest(*self._points(curve), pointed) for curve in chart.curves]
        x = min(
            (place for place in near if place is not None), key=lambda p: abs(p - pointed), default=pointed
        )
        self._cursor.setPos(x)
        self._cursor.setVisible(True)
        values = [_value_at(*self._points(curve), np.asarray(curve.y), x) for curve in chart.curves]
        place = 10.0**x if chart.log_x else x
        self.legend.set_values(f"{_shown(chart.x_label)}: {readable(f'{place:.4g}')}", values)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange and self._chart is not None and not self._setting:
            self._setting = True
            self.show_chart(self._chart)
            self._setting = False
        super().changeEvent(event)


def _pen(look: CurveLook) -> QPen:
    pen = QPen(QColor(look.colour), look.width, look.pen)
    # Without it the pen would be one unit of the axis wide.
    pen.setCosmetic(True)
    return pen


def _shown(text: Cell) -> str:
    return readable(said(text))


def _html(text: str, colour: str = "") -> str:
    shifts = {"sup": "<sup>{}</sup>", "sub": "<sub>{}</sub>", "": "{}"}
    words = "".join(
        shifts[run.shift].format(run.text.replace("&", "&amp;").replace("<", "&lt;"))
        for run in rich_text.parts(text)
    )
    return f'<span style="color: {colour}">{words}</span>' if colour else words


def _scaled(values: Array, *, log: bool) -> Array:
    values = np.asarray(values, dtype=np.float64)
    if not log:
        return values
    return np.log10(np.where(values > 0.0, values, np.nan))


def _span(values: Array, margin: float, *, log: bool) -> tuple[float, float]:
    good = values[np.isfinite(values)]
    if not good.size:
        return (0.0, 1.0)
    low, high = float(good.min()), float(good.max())
    air = air_around(low, high, margin, log=log)
    return low - air, high + air


def _widest(curves: Sequence[Curve]) -> str:
    """A text as wide as the widest value of the curves."""
    texts = [
        readable(f"{value:.4g}")
        for curve in curves
        for value in (np.asarray(curve.y)[np.isfinite(curve.y)][:: max(1, len(curve.y) // 50)]).tolist()
    ]
    powers = any("^" in text for text in texts)
    sign = "−" if any(text.startswith("−") for text in texts) else ""
    return sign + ("0.000×10^{−00}" if powers else max((t.lstrip("−") for t in texts), key=len, default=""))


def _nearest(x: Array, y: Array, place: float) -> float | None:
    """Where the point nearest to ``place`` is that has a value."""
    good = x[np.isfinite(x) & np.isfinite(y)]
    return float(good[np.argmin(np.abs(good - place))]) if good.size else None


def _value_at(x: Array, y: Array, values: Array, place: float) -> str:
    """The value of the point nearest to ``place`` that has one; nothing outside the curve."""
    good = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    if not good.size:
        return ""
    near = good[int(np.argmin(np.abs(x[good] - place)))]
    step = (x[good].max() - x[good].min()) / max(1, good.size - 1)
    if not x[good].min() - step <= place <= x[good].max() + step:
        return ""
    return readable(f"{values[near]:.4g}")
