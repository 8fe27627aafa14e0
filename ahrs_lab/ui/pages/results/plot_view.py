"""The tab Plot: the chosen quantity's plot, its few further figures, where its uncertainty comes from; and,
after a click on a point, the raw segment behind it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.certificates.wording import MEANING_OF_B
from ahrs_lab.metrology.result import (
    CalibrationResult,
    MisalignmentResult,
    ScaleFactorResult,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.uncertainty.budget import shares
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.formatting import NO_BREAK_SPACE, number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit, show
from ahrs_lab.ui.pages.widgets.share_bars import ShareBars
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import language, said
from ahrs_lab.ui.widgets import ElidedLabel, IconButton, Label, Line, MarkedLabel, SegmentedSwitch, Swatch

if TYPE_CHECKING:
    from ahrs_lab.ui.pages.widgets.plot import Plot

_BUDGET_PX = 320


class PlotView(Translated):
    """``segment_wanted`` names the segment behind a clicked point."""

    segment_wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._quantity: Quantity | None = None
        self._unit: Unit | None = None
        self._result: CalibrationResult | None = None
        self._segments: tuple[str, ...] = ()
        self._segment: tuple[str, Samples] | None = None
        self.plot: Plot | None = None
        self.raw_plot: Plot | None = None
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        self._stack = QStackedWidget()
        self._stack.addWidget(self._make_plot())
        self._stack.addWidget(self._make_raw())
        row.addWidget(self._stack, 1)
        row.addWidget(Line(Qt.Orientation.Vertical))
        row.addWidget(self._make_budget())
        self.retranslate()

    def _make_plot(self) -> QWidget:
        whole = QWidget()
        self._plot_column = QVBoxLayout(whole)
        self._plot_column.setContentsMargins(0, 0, 0, 0)
        self._plot_column.setSpacing(2)
        head = QHBoxLayout()
        head.setSpacing(CARD_MARGIN)
        self._title = MarkedLabel(role="strong")
        self._facts = MarkedLabel(tone="muted")
        self.what = SegmentedSwitch([("residuals", ""), ("fit", "")], "residuals")
        self.what.changed.connect(lambda _key: self._draw())
        head.addWidget(self._title)
        head.addWidget(self._facts, 1)
        head.addWidget(self.what)
        self._plot_column.addLayout(head)
        self.meaning = Label(tone="muted", wrap=True)
        self._plot_column.addWidget(self.meaning)
        return whole

    def _make_raw(self) -> QWidget:
        whole = QWidget()
        self._raw_column = QVBoxLayout(whole)
        self._raw_column.setContentsMargins(0, 0, 0, 0)
        self._raw_column.setSpacing(2)
        head = QHBoxLayout()
        head.setSpacing(GAP)
        self.back = IconButton("back")
        self.back.clicked.connect(self.show_plot)
        self._raw_title = ElidedLabel(role="strong")
        head.addWidget(self.back)
        head.addWidget(self._raw_title, 1)
        for axis in AXES:
            head.addWidget(Swatch(axis))
            head.addWidget(Label(axis.upper(), tone="muted"))
        self._raw_column.addLayout(head)
        return whole

    def _make_budget(self) -> QWidget:
        whole = QWidget()
        whole.setFixedWidth(_BUDGET_PX)
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(GAP)
        self._budget_title = MarkedLabel(role="strong")
        self._budget_facts = ElidedLabel(tone="muted")
        self._shares = ShareBars()
        column.addWidget(self._budget_title)
        column.addWidget(self._budget_facts)
        column.addWidget(self._shares, 1)
        return whole

    # content --------------------------------------------------------------------------------------------

    def show_quantity(self, quantity: Quantity, unit: Unit, result: CalibrationResult) -> None:
        """Plot, figures and shares of ``quantity``."""
        self._quantity, self._unit, self._result = quantity, unit, result
        if self.plot is None:
            from ahrs_lab.ui.pages.widgets.plot import Plot

            self.plot, self.raw_plot = Plot(), Plot()
            self._plot_column.insertWidget(1, self.plot, 1)
            self._raw_column.addWidget(self.raw_plot, 1)
            self.plot.picked.connect(self._picked)
            self.plot.restyled.connect(self._draw)
            self.raw_plot.restyled.connect(self._draw_raw)
        self.show_plot()
        self._draw()

    def show_segment(self, name: str, samples: Samples) -> None:
        """The raw segment, with a way back."""
        self._segment = (name, samples)
        self._stack.setCurrentIndex(1)
        self._draw_raw()
        self.back.setFocus()

    def show_plot(self) -> None:
        """Back from the raw segment."""
        self._segment = None
        self._stack.setCurrentIndex(0)

    def shows_segment(self) -> str:
        """The name of the raw segment in front, "" where the plot is."""
        return self._segment[0] if self._segment is not None else ""

    def _picked(self, point: int) -> None:
        if point < len(self._segments) and self._segments[point]:
            self.segment_wanted.emit(self._segments[point])

    def _rate_unit(self) -> str:
        unit = str(self._result.device.get("rate_unit", "deg/s")) if self._result is not None else "deg/s"
        return unit.replace("deg/s", "°/s")

    def _draw(self) -> None:
        if self._quantity is None or self._unit is None or self._result is None or self.plot is None:
            return
        from ahrs_lab.ui.pages.results.plots import draw

        latitude = self._result.site.get("latitude_deg")
        self._segments = draw(
            self.plot,
            self._quantity,
            float(latitude) if isinstance(latitude, (int, float)) else None,
            self._rate_unit(),
            fit=self.what.current() == "fit",
        )
        self._name(self._quantity, self._unit)

    def _draw_raw(self) -> None:
        if self._segment is None or self.raw_plot is None:
            return
        from ahrs_lab.ui.pages.results.plots import draw_segment

        name, samples = self._segment
        self._raw_title.setText(
            self.tr("Raw segment {name}, {count} samples").format(name=name, count=number(len(samples), 0))
        )
        draw_segment(self.raw_plot, samples, self._rate_unit())

    def _name(self, quantity: Quantity, unit: Unit) -> None:
        symbol = f"{quantity.symbol}_{{{quantity.index}}}"
        match quantity.source:
            case ScaleFactorResult():
                title = self.tr("{symbol}: fit and residuals")
            case ZeroOffsetResult():
                title = self.tr("{symbol}: positions")
            case MisalignmentResult():
                title = self.tr("{symbol}: turns in both senses")
        self._title.set_marked(title.format(symbol=symbol))
        self.what.setVisible(isinstance(quantity.source, ScaleFactorResult))
        self.meaning.setVisible(isinstance(quantity.source, ZeroOffsetResult))
        self.meaning.setText(MEANING_OF_B.zh if language() == "zh" else MEANING_OF_B.en)
        if self.plot is not None:
            hint = self.tr("Click a point to open its raw segment.")
            self.plot.canvas().setToolTip(hint if any(self._segments) else "")
        self._facts.set_marked("  ·  ".join(self._further(quantity)))
        self._budget_title.set_marked(self.tr("Where U({symbol}) comes from").format(symbol=symbol))
        shown = show(quantity, unit)
        uncertainty = quantity.uncertainty
        self._budget_facts.setText(
            f"U = {shown.expanded} {shown.unit if shown.unit != '1' else ''}".rstrip()
            + f"   k = {number(uncertainty.coverage_factor, 2)}   ν = {_degrees(uncertainty.dof)}"
        )
        parts = shares(uncertainty)
        self._shares.show_shares(
            [(said(row.source), share) for row, share in zip(uncertainty.rows, parts, strict=True)],
            self.tr("all others"),
        )

    def _further(self, quantity: Quantity) -> list[str]:
        match quantity.source:
            case ScaleFactorResult() as scale:
                return [
                    self.tr("nonlinearity {ppm} ppm").format(ppm=number(scale.nonlinearity_ppm, 1)),
                    self.tr("asymmetry {ppm} ppm").format(ppm=number(scale.asymmetry_ppm, 1)),
                    f"F_{{0}} = {number(scale.F0, 6)} {self._rate_unit()}",
                ]
            case ZeroOffsetResult() as offset:
                facts = [
                    self.tr("band: ± U; circles: B and the Earth's rate"),
                    self.tr("positions: {count}").format(count=len(offset.angles_deg)),
                    self.tr("T = {time} each").format(
                        time=f"{number(offset.duration_s, 0)}{NO_BREAK_SPACE}s"
                    ),
                ]
                if offset.repeatability_dps is not None:
                    repeat = number(3600.0 * offset.repeatability_dps, 2)
                    facts.append(self.tr("repeatability {rate} °/h").format(rate=repeat))
                return facts
            case MisalignmentResult() as angle:
                return [
                    self.tr("turns each way: {count}").format(count=angle.turns),
                    f"N(+) = {number(angle.angle_positive_deg, 4)}°",
                    f"N(−) = {number(angle.angle_negative_deg, 4)}°",
                ]

    def retranslate(self) -> None:
        self.what.set_texts([("residuals", self.tr("Residuals")), ("fit", self.tr("Fit"))])
        self.back.set_hint(self.tr("Back to the plot"))
        self._draw()
        self._draw_raw()


def _degrees(dof: float) -> str:
    return "∞" if dof > 9999 else number(dof, 0)
