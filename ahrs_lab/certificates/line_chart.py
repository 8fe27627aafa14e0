"""A chart of curves drawn as vectors: linear or logarithmic axes, bands, marks with their names, a legend."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ahrs_lab.certificates.axis_scale import Ticks, air_around, axis_ticks
from ahrs_lab.certificates.boxes import one_line
from ahrs_lab.certificates.documents import Line, LineChart
from ahrs_lab.certificates.drawing import (
    ACCENT,
    AXIS_COLOURS,
    AXIS_DASHES,
    GREY,
    INK,
    RULE,
    Colour,
    Pen,
    colour,
    text_width,
)
from ahrs_lab.certificates.richtext import markup

_TICK_SIZE = 6.5
_LABEL_SIZE = 7.0
_LEGEND_LINE = 11.0
_SWATCH = 18.0
_BELOW = 28.0
_ABOVE = 12.0
_MARGIN_X, _MARGIN_Y = 0.01, 0.05
_FINE = colour("#E4E8EE")
"""Lines of the grid without a number."""
_BAND_ALPHA = 0.15
_OWN_COLOURS = (ACCENT, colour("#CC79A7"), colour("#B87700"), colour("#3A9BD1"), INK)
"""Of curves that belong to no axis of the unit; the first is left out beside the axes' own blue."""
_REFERENCE_DASH = (5.0, 1.5, 1.0, 1.5)
_DASH = (4.0, 2.0)
Look = tuple[Colour, Sequence[float]]


def looks(lines: Sequence[Line]) -> tuple[Look, ...]:
    """Colour and dash of each line: an axis has its own; what is ``dashed`` differs from it in dash."""
    has_axes = any(line.axis for line in lines)
    own = _OWN_COLOURS[1:] if has_axes else _OWN_COLOURS
    found: list[Look] = []
    count = 0
    for line in lines:
        if line.axis:
            ink, dash = AXIS_COLOURS[line.axis], AXIS_DASHES[line.axis]
            found.append((ink, _REFERENCE_DASH if line.style == "dashed" else dash))
        else:
            found.append((own[count % len(own)], _DASH if line.style == "dashed" else ()))
            count += 1
    return tuple(found)


class _Span:
    """What an axis shows, and where a value stands on it: 0 … 1."""

    def __init__(self, values: Sequence[float], margin: float, *, log: bool) -> None:
        self.log = log
        good = [value for value in values if math.isfinite(value) and (value > 0.0 or not log)]
        low, high = self._scale(min(good, default=1.0)), self._scale(max(good, default=1.0))
        air = air_around(low, high, margin, log=log)
        self._low, self._high = low - air, high + air

    def _scale(self, value: float) -> float:
        return math.log10(value) if self.log else value

    @property
    def width(self) -> float:
        """In the axis' unit; decades where it is logarithmic."""
        return self._high - self._low

    def widen(self, width: float) -> None:
        """To at least this width, about its middle."""
        more = 0.5 * max(0.0, width - self.width)
        self._low, self._high = self._low - more, self._high + more

    def ticks(self, most: int) -> Ticks:
        low, high = (10.0**end if self.log else end for end in (self._low, self._high))
        return axis_ticks(low, high, most, log=self.log)

    def place(self, value: float) -> float | None:
        """None: it has no place (not finite, or not above zero on a logarithmic axis)."""
        if not math.isfinite(value) or (self.log and value <= 0.0):
            return None
        return (self._scale(value) - self._low) / (self._high - self._low)


class LineChartBox:
    """Over the whole width; the legend stands above, broken into lines where it is long."""

    space_before = 6.0
    keep_with_next = False

    def __init__(self, chart: LineChart) -> None:
        self._chart = chart
        self._looks = looks(chart.lines)
        xs = [x for line in chart.lines for x, _ in line.points]
        ys = [v for line in chart.lines for v in (*(y for _, y in line.points), *line.low, *line.high)]
        if chart.log_y:  # a band that reaches down to zero shall not open ten decades
            ys = [y for line in chart.lines for _, y in line.points]
        self._x = _Span(xs, _MARGIN_X, log=chart.log_x)
        self._y = _Span(ys, _MARGIN_Y, log=chart.log_y)

    def _legend(self, width: float) -> list[list[tuple[float, int]]]:
        """Lines of (left, number of the curve)."""
        rows: list[list[tuple[float, int]]] = [[]]
        x = 0.0
        for number, line in enumerate(self._chart.lines):
            wide = _SWATCH + 5.0 + text_width(one_line(line.label), _LABEL_SIZE) + 14.0
            if rows[-1] and x + wide > width:
                rows.append([])
                x = 0.0
            rows[-1].append((x, number))
            x += wide
        return rows if self._chart.lines else []

    def _head(self, width: float) -> float:
        return _ABOVE + len(self._legend(width)) * _LEGEND_LINE + 3.0

    def height(self, width: float) -> float:
        return self._head(width) + self._chart.height + _BELOW

    def cut(self, width: float, room: float) -> None:  # noqa: ARG002 - a picture is not cut
        return None

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        self._draw_legend(pen, x, top, width)
        y_ticks = self._y.ticks(6)
        texts = [markup(text) for text in y_ticks.texts]
        gutter = max((text_width(text, _TICK_SIZE) for text in texts), default=0.0) + 6.0
        left, wide = x + gutter, width - gutter
        if self._chart.equal:
            per_point = max(self._x.width / wide, self._y.width / self._chart.height)
            self._x.widen(per_point * wide)
            self._y.widen(per_point * self._chart.height)
            y_ticks = self._y.ticks(6)
        bottom = top - self._head(width) - self._chart.height
        pen.text(x, top - self._head(width) + 5.0, one_line(self._chart.y_label), _LABEL_SIZE, ink=GREY)
        self._grid(pen, (left, bottom, wide), y_ticks)
        canvas = pen.canvas
        canvas.saveState()
        clip = canvas.beginPath()
        clip.rect(left, bottom, wide, self._chart.height)
        canvas.clipPath(clip, stroke=0, fill=0)
        for line, look in zip(self._chart.lines, self._looks, strict=True):
            self._band(pen, line, look[0], (left, bottom, wide))
        for line, look in zip(self._chart.lines, self._looks, strict=True):
            self._curve(pen, line, look, (left, bottom, wide))
        canvas.restoreState()
        self._marks(pen, (left, bottom, wide))
        pen.box(left, bottom, wide, self._chart.height, edge=RULE, line=0.5)
        name = one_line(self._chart.x_label)
        pen.text(left + wide / 2, bottom - 20.0, name, _LABEL_SIZE, ink=GREY, align="centre")

    def _draw_legend(self, pen: Pen, x: float, top: float, width: float) -> None:
        for row, entries in enumerate(self._legend(width)):
            y = top - _LEGEND_LINE * (row + 1) + 3.0
            for start, number in entries:
                line, (ink, dash) = self._chart.lines[number], self._looks[number]
                if line.style == "points":
                    pen.dot(x + start + _SWATCH / 2, y + 2.4, 1.9, ink=ink)
                else:
                    pen.polyline(
                        [(x + start, y + 2.4), (x + start + _SWATCH, y + 2.4)], ink=ink, width=1.2, dash=dash
                    )
                pen.text(x + start + _SWATCH + 5.0, y, one_line(line.label), _LABEL_SIZE)

    def _grid(self, pen: Pen, area: tuple[float, float, float], y_ticks: Ticks) -> None:
        left, bottom, wide = area
        height = self._chart.height
        for value in y_ticks.minor:
            self._level(pen, value, area, _FINE)
        for value, text in zip(y_ticks.values, y_ticks.texts, strict=True):
            y = self._level(pen, value, area, RULE)
            pen.text(left - 4.0, y - _TICK_SIZE * 0.35, markup(text), _TICK_SIZE, ink=GREY, align="right")
        x_ticks = self._x.ticks(8)
        for value in x_ticks.minor:
            place = left + (self._x.place(value) or 0.0) * wide
            pen.rule(place, bottom, place, bottom + height, ink=_FINE, width=0.3)
        for value, text in zip(x_ticks.values, x_ticks.texts, strict=True):
            place = left + (self._x.place(value) or 0.0) * wide
            pen.rule(place, bottom, place, bottom + height, width=0.3)
            pen.text(place, bottom - 9.5, markup(text), _TICK_SIZE, ink=GREY, align="centre")

    def _level(self, pen: Pen, value: float, area: tuple[float, float, float], ink: Colour) -> float:
        left, bottom, wide = area
        y = bottom + (self._y.place(value) or 0.0) * self._chart.height
        zero = value == 0.0 and not self._chart.log_y
        pen.rule(left, y, left + wide, y, ink=GREY if zero else ink, width=0.6 if zero else 0.35)
        return y

    def _runs(
        self, points: Sequence[tuple[float, float]], area: tuple[float, float, float]
    ) -> Iterator[list[tuple[float, float]]]:
        """Stretches without a gap, in points of the page."""
        left, bottom, wide = area
        run: list[tuple[float, float]] = []
        for x, y in points:
            at, up = self._x.place(x), self._y.place(y)
            if at is None or up is None:
                if run:
                    yield run
                run = []
            else:
                run.append((left + at * wide, bottom + min(2.0, max(-1.0, up)) * self._chart.height))
        if run:
            yield run

    def _curve(self, pen: Pen, line: Line, look: Look, area: tuple[float, float, float]) -> None:
        ink, dash = look
        for run in self._runs(line.points, area):
            if line.style == "points" or len(run) == 1:
                for x, y in run:
                    pen.dot(x, y, 1.5, ink=ink)
            else:
                pen.polyline(run, ink=ink, width=0.9, dash=dash)

    def _band(self, pen: Pen, line: Line, ink: Colour, area: tuple[float, float, float]) -> None:
        if not line.low or not line.high:
            return
        floor = 1e-300 if self._chart.log_y else -math.inf
        corners = [
            (x, max(low, floor) if math.isfinite(low) else low, high)
            for (x, _), low, high in zip(line.points, line.low, line.high, strict=True)
        ]
        upper = [(x, high) for x, low, high in corners if math.isfinite(low) and math.isfinite(high)]
        lower = [(x, low) for x, low, high in corners if math.isfinite(low) and math.isfinite(high)]
        outline = [point for run in self._runs([*upper, *reversed(lower)], area) for point in run]
        if len(outline) < 3:
            return
        path = pen.canvas.beginPath()
        path.moveTo(*outline[0])
        for point in outline[1:]:
            path.lineTo(*point)
        path.close()
        pen.canvas.setFillColorRGB(*ink, alpha=_BAND_ALPHA)  # the other curves' bands show through
        pen.canvas.drawPath(path, stroke=0, fill=1)
        pen.canvas.setFillAlpha(1.0)

    def _marks(self, pen: Pen, area: tuple[float, float, float]) -> None:
        """Names beside their lines, one lower where two would meet."""
        left, bottom, wide = area
        ends: list[float] = []
        for value, label in sorted(self._chart.marks, key=lambda mark: mark[0]):
            share = self._x.place(value)
            if share is None or not 0.0 <= share <= 1.0:
                continue
            x = left + share * wide
            pen.rule(x, bottom, x, bottom + self._chart.height, ink=GREY, width=0.6, dash=(2.5, 2.0))
            text = one_line(label)
            width = text_width(text, _TICK_SIZE) + 3.0
            start = x + 3.0 if x + width + 3.0 <= left + wide else x - width
            row = next((row for row, end in enumerate(ends) if end <= start), len(ends))
            ends[row : row + 1] = [start + width + 4.0]
            pen.text(start, bottom + self._chart.height - 8.5 * (row + 1), text, _TICK_SIZE, ink=INK)
