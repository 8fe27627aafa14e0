"""Plots drawn as vectors: small panels side by side with the same scales."""

from __future__ import annotations

import math

from ahrs_lab.certificates.boxes import one_line
from ahrs_lab.certificates.documents import Chart, Series
from ahrs_lab.certificates.drawing import AXIS_COLOURS, AXIS_DASHES, GREY, INK, RULE, Pen, text_width
from ahrs_lab.certificates.richtext import RichText, bold, plain
from ahrs_lab.metrology.rounding import format_grouped

_TICK_SIZE = 6.5
_LABEL_SIZE = 7.0
_BELOW = 26.0
_ABOVE = 14.0
_BETWEEN = 16.0


def nice_ticks(low: float, high: float, most: int = 5) -> tuple[float, ...]:
    """Round numbers of a step of 1, 2 or 5 times a power of ten that span ``low`` to ``high``."""
    span = max(high - low, 1e-12 * max(abs(low), abs(high), 1e-30))
    raw = span / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw * (1 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return tuple(i * step for i in range(first, max(last, first + 1) + 1))  # two at least, for a scale


def tick_text(value: float, step: float) -> RichText:
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return plain(format_grouped(f"{value + 0.0:.{decimals}f}" if abs(value) > step * 1e-6 else "0"))


class ChartBox:
    """One row of panels, one an axis of the unit, in the house's axis colours."""

    space_before = 6.0
    keep_with_next = False

    def __init__(self, chart: Chart) -> None:
        self._chart = chart
        values = [x for panel in chart.panels for x in (*panel.x, *(p[0] for p in panel.curve))]
        self._low, self._high = min(values), max(values)
        self._x_ticks = chart.x_ticks or tuple(
            tick for tick in nice_ticks(self._low, self._high, 4) if self._low <= tick <= self._high
        )
        self._y_ticks = self._span_y()

    def _span_y(self) -> tuple[float, ...]:
        values: list[float] = []
        for panel in self._chart.panels:
            errors = panel.error or (0.0,) * len(panel.y)
            values += [y + e for y, e in zip(panel.y, errors, strict=True)]
            values += [y - e for y, e in zip(panel.y, errors, strict=True)]
            values += [p[1] for p in panel.curve]
        low, high = min(values), max(values)
        return nice_ticks(min(low, 0.0), max(high, 0.0), 5)

    def height(self, width: float) -> float:  # noqa: ARG002 - the same at every width
        return self._chart.height + _BELOW + _ABOVE

    def cut(self, width: float, room: float) -> None:  # noqa: ARG002 - a picture is not cut
        return None

    def draw(self, pen: Pen, x: float, top: float, width: float) -> None:
        step = self._y_ticks[1] - self._y_ticks[0]
        texts = [tick_text(value, step) for value in self._y_ticks]
        gutter = max(text_width(text, _TICK_SIZE) for text in texts) + 5.0
        pen.text(x, top - _LABEL_SIZE, one_line(self._chart.y_label), _LABEL_SIZE, ink=GREY)
        count = len(self._chart.panels)
        wide = (width - gutter - _BETWEEN * (count - 1)) / count
        bottom = top - _ABOVE - self._chart.height
        for index, panel in enumerate(self._chart.panels):
            left = x + gutter + index * (wide + _BETWEEN)
            self._frame(pen, panel, left, bottom, wide, texts if index == 0 else None)
            self._series(pen, panel, left, bottom, wide)
        pen.text(
            x + gutter + (width - gutter) / 2,
            bottom - 20.0,
            one_line(self._chart.x_label),
            _LABEL_SIZE,
            ink=GREY,
            align="centre",
        )

    def _place_x(self, value: float, left: float, wide: float) -> float:
        margin = 0.08 * wide
        share = (value - self._low) / ((self._high - self._low) or 1.0)
        return left + margin + share * (wide - 2 * margin)

    def _place_y(self, value: float, bottom: float) -> float:
        low, high = self._y_ticks[0], self._y_ticks[-1]
        return bottom + (value - low) / ((high - low) or 1.0) * self._chart.height

    def _frame(
        self,
        pen: Pen,
        panel: Series,
        left: float,
        bottom: float,
        wide: float,
        texts: list[RichText] | None,
    ) -> None:
        for index, value in enumerate(self._y_ticks):
            y = self._place_y(value, bottom)
            zero = value == 0
            pen.rule(left, y, left + wide, y, ink=GREY if zero else RULE, width=0.6 if zero else 0.35)
            if texts is not None:
                pen.text(left - 4.0, y - _TICK_SIZE * 0.35, texts[index], _TICK_SIZE, ink=GREY, align="right")
        step = self._x_ticks[1] - self._x_ticks[0] if len(self._x_ticks) > 1 else 1.0
        for index, value in enumerate(self._x_ticks[: len(panel.names) or None]):
            place = self._place_x(value, left, wide)
            pen.rule(place, bottom, place, bottom - 2.5, ink=GREY, width=0.5)
            text = plain(panel.names[index]) if panel.names else tick_text(value, step)
            pen.text(place, bottom - 9.5, text, _TICK_SIZE, ink=GREY, align="centre")
        pen.box(left, bottom, wide, self._chart.height, edge=RULE, line=0.5)

    def _series(self, pen: Pen, panel: Series, left: float, bottom: float, wide: float) -> None:
        ink = AXIS_COLOURS.get(panel.axis, INK)
        if panel.curve:
            points = [(self._place_x(a, left, wide), self._place_y(b, bottom)) for a, b in panel.curve]
            pen.polyline(points, ink=ink, width=0.8, dash=AXIS_DASHES.get(panel.axis, ()))
        errors = panel.error or (0.0,) * len(panel.y)
        for value, y, error in zip(panel.x, panel.y, errors, strict=True):
            place = self._place_x(value, left, wide)
            if error > 0:
                low, high = self._place_y(y - error, bottom), self._place_y(y + error, bottom)
                pen.rule(place, low, place, high, ink=ink, width=0.7)
                for end in (low, high):
                    pen.rule(place - 1.8, end, place + 1.8, end, ink=ink, width=0.7)
            pen.dot(place, self._place_y(y, bottom), 1.9, ink=ink)
        right, above = left + wide, bottom + self._chart.height + 4.5
        pen.text(right, above, bold(panel.title), 8.5, ink=ink, align="right")
