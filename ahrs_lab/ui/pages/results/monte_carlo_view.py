"""The Monte Carlo check beside the budget: histogram, the GUM's interval and both of the trials, and whether
the one is validated by the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QVBoxLayout, QWidget

from ahrs_lab.ui.formatting import MINUS
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.histogram_data import HistogramData, IntervalKey, histogram_data
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import STEP, tokens
from ahrs_lab.ui.widgets import ElidedLabel, Label
from ahrs_lab.ui.widgets.labels import LineSwatch

if TYPE_CHECKING:
    from ahrs_lab.ui.pages.widgets.plot import Plot

_LINES: dict[IntervalKey, tuple[str, Qt.PenStyle]] = {
    "gum": ("#CC79A7", Qt.PenStyle.SolidLine),
    "symmetric": ("#56B4E9", Qt.PenStyle.DashLine),
    "shortest": ("#E69F00", Qt.PenStyle.DotLine),
}
"""Colours that the colour-blind tell apart, and none of the axes'."""
_FIRST, _STEP = 1.1, 0.14
"""Heights of the intervals above the highest bar, in its height."""


class MonteCarloView(Translated):
    """Follows the quantity that is chosen on the page."""

    def __init__(self) -> None:
        super().__init__()
        self._quantity: Quantity | None = None
        self._unit: Unit | None = None
        self.plot: Plot | None = None
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 4, 0, 0)
        self._column.setSpacing(STEP)
        self._legend = self._make_legend()
        self._column.addWidget(self._legend)
        self.verdict = IconLine("info", "")
        self._column.addWidget(self.verdict)
        self.nothing = Label(tone="muted", wrap=True)
        self._column.addWidget(self.nothing)
        self._column.addStretch()
        self.retranslate()

    def _make_legend(self) -> QWidget:
        whole = QWidget()
        grid = QGridLayout(whole)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(2 * STEP)
        grid.setVerticalSpacing(0)
        grid.setColumnStretch(2, 1)
        self._names: dict[IntervalKey, Label] = {}
        self.ends: dict[IntervalKey, ElidedLabel] = {}
        for row, (key, (colour, style)) in enumerate(_LINES.items()):
            self._names[key], self.ends[key] = Label(tone="muted"), ElidedLabel()
            grid.addWidget(LineSwatch(colour, style), row, 0)
            grid.addWidget(self._names[key], row, 1)
            grid.addWidget(self.ends[key], row, 2)
        return whole

    def show_quantity(self, quantity: Quantity, unit: Unit) -> None:
        """The check of ``quantity`` in ``unit``, or that there is none."""
        self._quantity, self._unit = quantity, unit
        self._draw()

    def _draw(self) -> None:
        if self._quantity is None or self._unit is None:
            return
        data = histogram_data(self._quantity, self._unit)
        for widget in (self._legend, self.verdict):
            widget.setVisible(data is not None)
        self.nothing.setVisible(data is None)
        if self.plot is not None:
            self.plot.setVisible(data is not None)
        if data is None:
            self._say_nothing(self._quantity)
            return
        if self.plot is None:
            from ahrs_lab.ui.pages.widgets.plot import Plot

            self.plot = Plot()
            self.plot.hide_heights()
            self.plot.restyled.connect(self._draw)
            self._column.insertWidget(0, self.plot, 1)
        self._draw_plot(self.plot, data)
        self._say(data)

    def _draw_plot(self, plot: Plot, data: HistogramData) -> None:
        unit = data.label or ("1" if not data.power else "")
        power = f"10<sup>{str(data.power).replace('-', MINUS)}</sup>" if data.power else ""
        plot.clear(self.tr("Deviation from the value, {unit}").format(unit=f"{power} {unit}".strip()), "")
        peak = float(data.counts.max(initial=0.0)) or 1.0
        if data.counts.size:
            plot.add_bars(data.edges, data.counts / peak, tokens().accent)
        for number, interval in enumerate(data.intervals):
            colour, style = _LINES[interval.key]
            height = _FIRST + _STEP * number
            plot.add_curve(
                np.array([interval.low, interval.low, interval.high, interval.high]),
                np.array([0.0, height, height, 0.0]),
                colour,
                width=1.5,
                style=style,
            )
        ends = [end for interval in data.intervals for end in (interval.low, interval.high)]
        edges = [*ends, *data.edges.tolist()]
        room = 0.02 * (max(edges) - min(edges))
        plot.set_ranges((min(edges) - room, max(edges) + room), (0.0, _FIRST + _STEP * len(_LINES)))

    def _say(self, data: HistogramData) -> None:
        for interval in data.intervals:
            self.ends[interval.key].setText(f"{interval.text} {data.label}".rstrip())
        if data.validated:
            text = self.tr(
                "{trials} trials, u = {u}: ± U is validated (JCGM 101, clause 8, δ = {tolerance})."
            )
            hint = self.tr("Both ends of ± U lie within δ of the symmetric interval's.")
        else:
            text = self.tr(
                "{trials} trials, u = {u}: ± U is not validated (JCGM 101, clause 8, δ = {tolerance})."
            )
            hint = (
                self.tr("± U of the GUM is too short: the U reported covers the symmetric interval.")
                if data.widened
                else self.tr("An end of ± U lies more than δ from the symmetric interval's.")
            )
        self.verdict.setToolTip(hint)
        self.verdict.set_content(
            "good" if data.validated else "warn",
            text.format(trials=data.trials, u=data.standard, tolerance=data.tolerance),
        )

    def _say_nothing(self, quantity: Quantity) -> None:
        self.nothing.setText(
            self.tr(
                "Annex A of the standard has no Monte Carlo check: it is made of uncertainties by the GUM."
            )
            if quantity.uncertainty.method == "annex-a"
            else self.tr(
                "This result has no Monte Carlo check: it was evaluated without one. "
                "Calculate again to see the histogram here."
            )
        )

    def retranslate(self) -> None:
        names = {
            "gum": self.tr("± U (GUM)"),
            "symmetric": self.tr("95 % symmetric"),
            "shortest": self.tr("95 % shortest"),
        }
        for key, label in self._names.items():
            label.setText(names[key])
        self._draw()
