"""The plot of the last minute: panels over one time axis, drawn from envelopes 30 times a second while
visible.

The settings are measured ones (see ``benchmarks/live_plot.py``): axes are painted once into the device's
cache, the time axis never moves, curves are one pixel wide and not smoothed, the value axis goes in steps,
and nothing is drawn with OpenGL.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QHideEvent, QPen, QPixmapCache, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QGraphicsItem, QVBoxLayout, QWidget

from ahrs_lab.ui.formatting import MINUS
from ahrs_lab.ui.plots.envelope import Envelope, EnvelopeRing
from ahrs_lab.ui.plots.scale import SteppedRange, ticks
from ahrs_lab.ui.theme import STEP, font, tokens
from ahrs_lab.ui.widgets.labels import Label

Array = NDArray[np.float64]

FRAME_MS = 33
_CACHE_KB = 256 * 1024
_LEFT_AXIS_PX = 58
_CAPTION_PX = 20
"""Above the axes, so that the caption covers no curve."""
_TIME_AXIS_PX, _NO_AXIS_PX = 24, 4
_PADDING = 0.12
_LINE_PX, _LEAST_PX = 20, 44
_TICK_PX = 22
"""At least so far from each other are two numbers at the value axis."""
_DIVISIONS = 5
_HALF_NUMBER_PX = 0.4 * _LINE_PX
"""pyqtgraph leaves a number out that stands nearer to an end of its axis."""


@dataclass(frozen=True)
class Channel:
    """One curve: row ``row`` of the ring, its colour and line."""

    row: int
    colour: str
    style: Qt.PenStyle = Qt.PenStyle.SolidLine


@dataclass(frozen=True)
class PanelSpec:
    """One set of axes: where its data come from, its curves, its smallest height in values, its share of
    the room, and from how many seconds without data a curve has a gap."""

    ring: EnvelopeRing
    channels: tuple[Channel, ...]
    smallest: float = 0.02
    stretch: int = 1
    gap_s: float = 1.0


@dataclass(frozen=True)
class Readout:
    """What stands under the cursor: seconds before now, and per panel the mean of each curve (NaN:
    nothing)."""

    t_s: float
    values: tuple[tuple[float, ...], ...]


class LivePlot(QWidget):
    """``hold`` freezes the picture while data go on coming; ``pointed`` tells a :class:`Readout`, or None
    when the cursor leaves. ``now_s`` is the latest time of all rings."""

    pointed = Signal(object)

    def __init__(self, panels: Sequence[PanelSpec], *, span_s: float = 60.0) -> None:
        super().__init__()
        QPixmapCache.setCacheLimit(max(QPixmapCache.cacheLimit(), _CACHE_KB))
        self._span_s = span_s
        self._held = False
        self._wanted = True
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(STEP)
        self.panels: list[_Panel] = []
        for number, spec in enumerate(panels):
            panel = _Panel(spec, span_s, last=number == len(panels) - 1)
            panel.pointed.connect(self.point_at)
            column.addWidget(panel, spec.stretch)
            self.panels.append(panel)
        self._timer = QTimer(self)
        self._timer.setInterval(FRAME_MS)
        self._timer.timeout.connect(self.draw)

    def set_rings(self, rings: Sequence[EnvelopeRing]) -> None:
        """Other data for the same panels: a new run."""
        for panel, ring in zip(self.panels, rings, strict=True):
            panel.set_ring(ring)
        self._held = False
        self.draw()

    def set_captions(self, captions: Sequence[str]) -> None:
        """What each panel shows, with its unit."""
        for panel, caption in zip(self.panels, captions, strict=True):
            panel.set_caption(caption)

    def set_running(self, running: bool) -> None:
        """Nothing has to be drawn again where no data come."""
        self._wanted = running
        self._run()

    def set_hold(self, held: bool) -> None:
        """Freeze or go on."""
        self._held = held

    @property
    def held(self) -> bool:
        """The picture is frozen."""
        return self._held

    def draw(self) -> None:
        """One frame."""
        if self._held:
            return
        now_s = max(panel.ring.newest_s for panel in self.panels)
        if np.isfinite(now_s):
            for panel in self.panels:
                panel.draw(now_s)
        else:
            for panel in self.panels:
                panel.show_nothing()

    @property
    def drawing(self) -> bool:
        """It draws by itself."""
        return self._timer.isActive()

    def point_at(self, t_s: float | None) -> None:
        """The cursor is ``t_s`` seconds before now (negative), None: nowhere."""
        for panel in self.panels:
            panel.set_cursor(t_s)
        if t_s is None:
            self.pointed.emit(None)
        else:
            self.pointed.emit(Readout(t_s, tuple(panel.values_at(t_s) for panel in self.panels)))

    def _run(self) -> None:
        if self._wanted and self.isVisible():
            self._timer.start()
        else:
            self._timer.stop()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.draw()
        self._run()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._timer.stop()


class _Axis(pg.AxisItem):  # type: ignore[misc]
    """Ticks with a true minus."""

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        return [text.replace("-", MINUS) for text in super().tickStrings(values, scale, spacing)]


class _ValueAxis(_Axis):
    """As many numbers as have room."""

    def tickValues(self, minVal: float, maxVal: float, size: float) -> list[tuple[float, list[float]]]:
        per_px = (maxVal - minVal) / size
        inset = _HALF_NUMBER_PX * per_px
        if not 2.0 * inset < maxVal - minVal:
            return []
        return [ticks(minVal + inset, maxVal - inset, _TICK_PX * per_px, _DIVISIONS)]


class _TimeAxis(_Axis):
    """Ticks in seconds, the last one with the unit."""

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        texts = super().tickStrings(values, scale, spacing)
        return [f"{text} s" if value == 0.0 else text for text, value in zip(texts, values, strict=True)]


class _Panel(pg.PlotWidget):  # type: ignore[misc]
    pointed = Signal(object)

    def __init__(self, spec: PanelSpec, span_s: float, *, last: bool) -> None:
        axes = {"left": _ValueAxis("left"), "bottom": _TimeAxis("bottom")}
        super().__init__(axisItems=axes, enableMenu=False)
        self.ring = spec.ring
        self._spec = spec
        self._span_s = span_s
        self._axes = axes
        self._range = SteppedRange(spec.smallest)
        self._shown: Envelope | None = None
        self._shown_now_s = 0.0
        self.setMouseEnabled(False, False)
        self.hideButtons()
        self.setFrameShape(self.Shape.NoFrame)
        self.setAntialiasing(False)
        self.setMouseTracking(True)
        self._around_px = _CAPTION_PX + (_TIME_AXIS_PX if last else _NO_AXIS_PX)
        self.setMinimumHeight(self._around_px + _LEAST_PX)
        plot = self.getPlotItem()
        # pyqtgraph makes this menu all the same, as a window of nobody's: it has to go with the panel.
        plot.ctrlMenu.setParent(self, plot.ctrlMenu.windowFlags())
        plot.setContentsMargins(0, _CAPTION_PX, 16, 0)
        plot.getViewBox().setDefaultPadding(0.0)
        plot.getViewBox().disableAutoRange()
        plot.setXRange(-span_s, 0.0, padding=0.0)
        self._fit()
        axes["bottom"].setTickSpacing(10.0, 10.0)
        axes["left"].setWidth(_LEFT_AXIS_PX)
        axes["bottom"].setStyle(showValues=last)
        axes["bottom"].setHeight(_TIME_AXIS_PX if last else _NO_AXIS_PX)
        self._curves = [pg.PlotCurveItem(skipFiniteCheck=True, antialias=False) for _ in spec.channels]
        for curve in self._curves:
            curve.setVisible(False)
            plot.addItem(curve)
        self._cursor = pg.InfiniteLine(angle=90, movable=False)
        self._cursor.setVisible(False)
        plot.addItem(self._cursor, ignoreBounds=True)
        for axis in axes.values():
            axis.setZValue(-1000)
            axis.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)
        self._caption = Label(tone="muted")
        self._caption.setParent(self)
        self._caption.move(_LEFT_AXIS_PX, 0)
        self._dress()

    def set_caption(self, caption: str) -> None:
        self._caption.setText(caption)
        self._caption.adjustSize()

    def _fit(self) -> None:
        room = max(_LEAST_PX, self.height() - self._around_px)
        # Room for half a line of text, else the outermost numbers are left out.
        self.setYRange(
            self._range.low, self._range.high, padding=max(_PADDING, 0.5 * _LINE_PX / (room - _LINE_PX))
        )

    def _dress(self) -> None:
        look = tokens()
        self.setBackground(look.card)
        for axis in self._axes.values():
            axis.setPen(QPen(look.colour("line"), 1))
            axis.setTextPen(look.colour("muted"))
            axis.setStyle(tickFont=font(), tickLength=0, tickTextOffset=6, hideOverlappingLabels=False)
        grid = 255 if not look.dark else 210
        self._axes["left"].setGrid(grid)
        self._axes["bottom"].setGrid(False)
        cursor = QPen(look.colour("muted"), 1, Qt.PenStyle.DashLine)
        cursor.setCosmetic(True)
        self._cursor.setPen(cursor)
        for curve, channel in zip(self._curves, self._spec.channels, strict=True):
            pen = QPen(QColor(channel.colour), 1, channel.style)
            # Without it the pen would be one second wide.
            pen.setCosmetic(True)
            curve.setPen(pen)

    def set_ring(self, ring: EnvelopeRing) -> None:
        self.ring = ring
        self.show_nothing()

    def show_nothing(self) -> None:
        # Not called clear: PlotWidget puts its own, which takes the curves away, over that of a subclass.
        self._shown = None
        for curve in self._curves:
            curve.setVisible(False)

    def draw(self, now_s: float) -> None:
        seen = self.ring.look()
        self._shown, self._shown_now_s = seen, now_s
        if len(seen.t_s):
            rows = [channel.row for channel in self._spec.channels]
            with np.errstate(all="ignore"):
                low, high = (
                    np.nanmin(seen.low[rows], initial=np.inf),
                    np.nanmax(seen.high[rows], initial=-np.inf),
                )
            if np.isfinite(low) and np.isfinite(high) and self._range.follow(float(low), float(high)):
                self._fit()
        for curve, channel in zip(self._curves, self._spec.channels, strict=True):
            x, y, connect = polyline(seen, channel.row, now_s, gap_s=self._spec.gap_s)
            curve.setVisible(len(x) > 0)
            if len(x):
                curve.setData(x, y, connect=connect, skipFiniteCheck=True)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        # pyqtgraph resizes once before this class has its parts.
        if hasattr(self, "_caption"):
            self._fit()

    def set_cursor(self, t_s: float | None) -> None:
        self._cursor.setVisible(t_s is not None)
        if t_s is not None:
            self._cursor.setPos(t_s)

    def values_at(self, t_s: float) -> tuple[float, ...]:
        """Mean of each curve in the bin nearest to ``t_s`` seconds before now; NaN farther than a second."""
        seen = self._shown
        if seen is None or not len(seen.t_s):
            return tuple(float("nan") for _ in self._spec.channels)
        nearest = int(np.argmin(np.abs(seen.t_s - self._shown_now_s - t_s)))
        if abs(seen.t_s[nearest] - self._shown_now_s - t_s) > 1.0:
            return tuple(float("nan") for _ in self._spec.channels)
        return tuple(float(seen.mean[channel.row, nearest]) for channel in self._spec.channels)

    def mouseMoveEvent(self, event: object) -> None:
        position = event.position()  # type: ignore[attr-defined]
        x = self.getViewBox().mapSceneToView(self.mapToScene(position.toPoint())).x()
        self.pointed.emit(float(x) if -self._span_s <= x <= 0.0 else None)

    def leaveEvent(self, event: QEvent) -> None:
        super().leaveEvent(event)
        self.pointed.emit(None)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_curves"):
            self._dress()
        super().changeEvent(event)

    def wheelEvent(self, event: QEvent) -> None:
        event.ignore()


def polyline(seen: Envelope, row: int, now_s: float, gap_s: float) -> tuple[Array, Array, object]:
    """Down and up through the bins of one channel: x seconds before ``now_s``, y, and which points are
    joined: ``"all"``, or an array with 0 before a gap longer than ``gap_s``."""
    there = seen.count[row] > 0
    t_s = seen.t_s[there] - now_s
    y = np.empty(2 * len(t_s))
    y[0::2] = seen.low[row][there]
    y[1::2] = seen.high[row][there]
    gaps = np.diff(t_s) > gap_s
    if not gaps.any():
        return np.repeat(t_s, 2), y, "all"
    joined = np.ones(len(y), dtype=np.int32)
    joined[1:-1:2] = ~gaps
    return np.repeat(t_s, 2), y, joined


__all__ = ["Channel", "LivePlot", "PanelSpec", "Readout", "polyline"]
