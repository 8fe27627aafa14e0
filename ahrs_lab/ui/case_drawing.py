"""The drawing of the case on the rate table: how it has to stand, and how it gets there from how it stood."""

from __future__ import annotations

from math import pi, sin

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, QVariantAnimation
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QHideEvent,
    QLinearGradient,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPolygonF,
    QShowEvent,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.ui.case_scene import (
    EDGE,
    FLATTENING,
    RIM_DEPTH,
    Arrow,
    Facet,
    between,
    compass,
    rim_ticks,
    scene,
    seat,
)
from ahrs_lab.ui.theme import AXIS_COLOURS, AXIS_PENS, font, tokens

Array = NDArray[np.float64]

_LOOP_MS = 5200
_MOVE_FROM, _MOVE_TO = 0.16, 0.46
"""The part of the loop in which the case moves; before it stands as it stood, after as it should."""
_LIFT = 0.20
_HALF_WIDTH, _ABOVE, _BELOW = 1.12, 1.34, 0.60
"""What of the scene has to fit, in table radii: to both sides, above and below the table's centre."""


class CaseDrawing(QWidget):
    """Set :meth:`show_turn` while a mounting is asked, :meth:`show_still` else; :meth:`set_table_angle`
    turns all."""

    def __init__(self) -> None:
        super().__init__()
        self._asked: Orientation | None = None
        self._previous: Orientation | None = None
        self._table_deg = 0.0
        self._part = 1.0
        self._words = ("N", "E", "up")
        self._loop = QVariantAnimation(self)
        self._loop.setStartValue(0.0)
        self._loop.setEndValue(1.0)
        self._loop.setDuration(_LOOP_MS)
        self._loop.setLoopCount(-1)
        self._loop.valueChanged.connect(self._move)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(200, 150)
        self.retranslate()

    def sizeHint(self) -> QSize:
        return QSize(380, 260)

    def show_turn(self, asked: Orientation, previous: Orientation | None) -> None:
        """Play how the case gets from ``previous`` to ``asked``, again and again."""
        if (asked, previous) == (self._asked, self._previous) and not self._still:
            return
        self._asked, self._previous = asked, previous
        self._table_deg = 0.0
        self._run()
        self.update()

    def show_still(self, orientation: Orientation | None) -> None:
        """The case as it stands; None: an empty fixture."""
        if orientation != self._asked or self._previous is not None or not self._still:
            self._asked, self._previous = orientation, orientation
            self._run()
            self.update()

    def set_table_angle(self, angle_deg: float) -> None:
        """Where the table is; positive by the right hand about up."""
        if abs(angle_deg - self._table_deg) > 0.02:
            self._table_deg = angle_deg
            self.update()

    @property
    def _still(self) -> bool:
        return self._asked is None or self._asked == self._previous

    @property
    def moving(self) -> bool:
        """The animation is on."""
        return self._loop.state() == QVariantAnimation.State.Running

    def retranslate(self) -> None:
        """The letters of the compass."""
        self._words = (self.tr("N"), self.tr("E"), self.tr("up"))
        self.update()

    def _run(self) -> None:
        if self._still or not self.isVisible():
            self._loop.stop()
            self._part = 1.0
        elif not self.moving:
            self._loop.start()

    def _move(self, value: object) -> None:
        loop = float(value) if isinstance(value, (int, float)) else 1.0
        part = min(1.0, max(0.0, (loop - _MOVE_FROM) / (_MOVE_TO - _MOVE_FROM)))
        part = part * part * (3.0 - 2.0 * part)
        if part != self._part:
            self._part = part
            self.update()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._run()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._run()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    # ── painting ────────────────────────────────────────────────────────────────────────────────────────

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        scale = min(self.width() / (2 * _HALF_WIDTH + 0.5), self.height() / (_ABOVE + _BELOW))
        origin = QPointF(
            self.width() / 2 + 0.15 * scale, _ABOVE * scale + (self.height() - (_ABOVE + _BELOW) * scale) / 2
        )
        sketch = _Sketch(painter, origin, scale)
        sketch.table(self._table_deg)
        if self._asked is not None:
            attitude, lift = self._attitude(self._asked)
            shapes = scene(attitude, lift, self._table_deg)
            sketch.facets(shapes.facets)
            for arrow in sorted(shapes.arrows, key=lambda arrow: not arrow.behind):
                sketch.arrow(arrow)
                sketch.letter(arrow)
        sketch.compass(self._words)

    def _attitude(self, asked: Orientation) -> tuple[Array, float]:
        if self._previous is None:
            return seat(asked), _LIFT * (1.0 - self._part)
        rotation = between(seat(self._previous), seat(asked), self._part)
        return rotation, 0.0 if self._still else _LIFT * sin(pi * self._part)


class _Sketch:
    """Paints shapes given in table radii."""

    def __init__(self, painter: QPainter, origin: QPointF, scale: float) -> None:
        self._painter = painter
        self._origin = origin
        self._scale = scale
        self._look = tokens()

    def _at(self, point: Array) -> QPointF:
        return QPointF(self._origin.x() + point[0] * self._scale, self._origin.y() + point[1] * self._scale)

    def table(self, table_deg: float) -> None:
        painter, look, s = self._painter, self._look, self._scale
        rx, ry, depth = s, s * FLATTENING, RIM_DEPTH * EDGE * s
        cx, cy = self._origin.x(), self._origin.y()
        metal, edge = look.colour("metal"), look.colour("metal_edge")
        painter.setPen(Qt.PenStyle.NoPen)
        side = QLinearGradient(cx - rx, 0, cx + rx, 0)
        side.setColorAt(0.0, metal.darker(118))
        side.setColorAt(0.35, metal.lighter(104))
        side.setColorAt(1.0, metal.darker(140))
        painter.setBrush(side)
        painter.drawEllipse(QPointF(cx, cy + depth), rx, ry)
        painter.drawRect(QRectF(cx - rx, cy, 2 * rx, depth))
        top = QLinearGradient(cx - rx, cy - ry, cx + rx, cy + ry)
        top.setColorAt(0.0, metal.lighter(112 if look.dark else 106))
        top.setColorAt(1.0, metal)
        painter.setBrush(top)
        painter.setPen(QPen(edge, 1))
        painter.drawEllipse(QPointF(cx, cy), rx, ry)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(QPointF(cx, cy), rx * 0.82, ry * 0.82)
        for ends, long in rim_ticks(table_deg):
            painter.setPen(QPen(look.colour("muted"), 1.4 if long else 0.8))
            painter.drawLine(self._at(ends[0]), self._at(ends[1]))
        # The fixed index against which the graduation is read, at north.
        north = compass()["north"]
        tip, foot = self._at(north * 1.01), self._at(north * 1.10)
        across = QPointF(0.03 * s, 0.012 * s)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("accent"))
        painter.drawPolygon(QPolygonF([tip, foot - across, foot + across]))

    def facets(self, facets: tuple[Facet, ...]) -> None:
        for facet in facets:
            colour, line = self._material(facet)
            pen = QPen(line, 1)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
            self._painter.setPen(pen)
            self._painter.setBrush(colour)
            self._painter.drawPolygon(QPolygonF([self._at(point) for point in facet.outline]))

    def _material(self, facet: Facet) -> tuple[QColor, QColor]:
        look = self._look
        base = {
            "case": look.colour("case"),
            "fixture": QColor("#4A5564") if look.dark else QColor("#EEF1F6"),
            "connector": QColor("#20262F") if look.dark else QColor("#3A4352"),
            "label": QColor("#DCE6FF"),
            "screw": QColor("#C8D4F2"),
        }[facet.material]
        shaded = QColor.fromRgbF(*(min(1.0, c * (0.45 + 0.6 * facet.light)) for c in _rgb(base)))
        if facet.material == "fixture":
            return shaded, look.colour("metal_edge")
        return shaded, shaded.darker(125)

    def arrow(self, arrow: Arrow) -> None:
        colour = QColor(AXIS_COLOURS[arrow.axis])
        if arrow.behind:
            # Seen through what is before it: an axis that nobody sees helps nobody.
            colour.setAlphaF(0.5)
        self._line(self._at(arrow.start), self._at(arrow.tip), colour, 2.6, AXIS_PENS[arrow.axis])

    def letter(self, arrow: Arrow) -> None:
        start, tip = self._at(arrow.start), self._at(arrow.tip)
        self._text(tip + _outward(start, tip) * 13.0, arrow.axis.upper(), QColor(AXIS_COLOURS[arrow.axis]))

    def compass(self, words: tuple[str, str, str]) -> None:
        s = self._scale
        foot = QPointF(self._origin.x() - 1.24 * s, self._origin.y() - 0.74 * s)
        colour = self._look.colour("muted")
        for (name, direction), word in zip(
            (("north", compass()["north"]), ("east", compass()["east"]), ("up", compass()["up"])),
            words,
            strict=True,
        ):
            length = 0.34 if name == "up" else 0.40
            tip = foot + QPointF(direction[0], direction[1]) * length * s
            self._line(foot, tip, colour, 1.8, Qt.PenStyle.SolidLine)
            self._text(tip + _outward(foot, tip) * 12.0, word, colour)

    def _line(self, start: QPointF, tip: QPointF, colour: QColor, width: float, style: Qt.PenStyle) -> None:
        out = _outward(start, tip)
        across = QPointF(-out.y(), out.x())
        head = 4.0 + 2.2 * width
        neck = tip - out * head
        pen = QPen(colour, width, style)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        self._painter.setPen(pen)
        self._painter.drawLine(start, neck)
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(colour)
        half = across * head * 0.42
        self._painter.drawPolygon(QPolygonF([tip, neck + half, neck - half]))

    def _text(self, centre: QPointF, text: str, colour: QColor) -> None:
        chosen = font("strong")
        area = QFontMetricsF(chosen).tightBoundingRect(text)
        letters = QPainterPath()
        # Strokes of a Chinese character overlap: by the default rule they would punch holes into each other.
        letters.setFillRule(Qt.FillRule.WindingFill)
        letters.addText(centre - area.center(), chosen, text)
        halo = QPen(self._look.colour("card"), 3)
        halo.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        self._painter.strokePath(letters, halo)
        self._painter.fillPath(letters, colour)


def _outward(start: QPointF, tip: QPointF) -> QPointF:
    line = tip - start
    length = (line.x() ** 2 + line.y() ** 2) ** 0.5
    return line / length if length > 1e-6 else QPointF(0.0, -1.0)


def _rgb(colour: QColor) -> tuple[float, float, float]:
    return colour.redF(), colour.greenF(), colour.blueF()
