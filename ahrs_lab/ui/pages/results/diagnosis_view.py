"""The tab Diagnosis: what the data of the chosen quantity say about themselves: a plot to look at, and each
finding as a sentence with its state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.metrology.diagnosis.model import (
    Diagnosis,
    DiagnosisFinding,
    MisalignmentDiagnosis,
    ScaleFactorDiagnosis,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.diagnosis.words import chance
from ahrs_lab.metrology.result import CalibrationResult, MisalignmentResult
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.quantities import Quantity
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import ElidedLabel, Label, Line, SegmentedSwitch

if TYPE_CHECKING:
    from ahrs_lab.ui.pages.widgets.plot import Plot

_SENTENCES_PX = 380
_ICON_OF = {"fine": "good", "look": "info", "warn": "warn"}
_RANK = ("warn", "look", "fine")
_ICON_PX = 16


class DiagnosisView(Translated):
    """``segment_wanted`` names the segment behind a clicked point; ``texts`` are the sentences that stand
    there."""

    segment_wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._quantity: Quantity | None = None
        self._diagnosis: Diagnosis | None = None
        self._segments: tuple[str, ...] = ()
        self.texts: list[str] = []
        self.plot: Plot | None = None
        self._whole = QStackedWidget()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._whole)
        self._none = Label(tone="muted", wrap=True)
        self._none.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._whole.addWidget(self._make_content())
        self._whole.addWidget(self._none)
        self.retranslate()

    def _make_content(self) -> QWidget:
        whole = QWidget()
        row = QHBoxLayout(whole)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        self._plot_column = QVBoxLayout()
        self._plot_column.setSpacing(2)
        head = QHBoxLayout()
        head.setSpacing(CARD_MARGIN)
        self._title = Label(role="strong")
        self._key = ElidedLabel(tone="muted")
        self.against = SegmentedSwitch([("rate", ""), ("order", ""), ("time", "")], "rate")
        self.what = SegmentedSwitch([("allan", ""), ("positions", ""), ("harmonic", "")], "allan")
        head.addWidget(self._title)
        head.addWidget(self._key, 1)
        for switch in (self.against, self.what):
            switch.changed.connect(lambda _key: self._draw())
            head.addWidget(switch)
        self._plot_column.addLayout(head)
        row.addLayout(self._plot_column, 1)
        row.addWidget(Line(Qt.Orientation.Vertical))
        row.addWidget(self._make_sentences())
        return whole

    def _make_sentences(self) -> QWidget:
        area = QScrollArea()
        area.setFixedWidth(_SENTENCES_PX)
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(0, 4, GAP, 0)
        self._list.setSpacing(CARD_MARGIN)
        self._list.addStretch(1)
        area.setWidget(inside)
        return area

    # content --------------------------------------------------------------------------------------------

    def show_quantity(self, quantity: Quantity, result: CalibrationResult) -> None:
        """Plot and sentences of ``quantity``."""
        self._quantity, self._diagnosis = quantity, result.diagnosis
        if self.plot is None:
            from ahrs_lab.ui.pages.widgets.plot import Plot

            self.plot = Plot()
            self.plot.picked.connect(self._picked)
            self.plot.restyled.connect(self._draw)
            self._plot_column.addWidget(self.plot, 1)
        self._show()

    def _show(self) -> None:
        found = self._found()
        self._whole.setCurrentIndex(0 if found is not None else 1)
        self._set_findings(found.findings if found is not None else ())
        self._draw()

    def _found(self) -> ScaleFactorDiagnosis | ZeroOffsetDiagnosis | MisalignmentDiagnosis | None:
        quantity, diagnosis = self._quantity, self._diagnosis
        if quantity is None or diagnosis is None:
            return None
        match quantity.group:
            case "scale_factor":
                return diagnosis.scale_factor.get(quantity.index)
            case "zero_offset":
                return diagnosis.zero_offset.get(quantity.index)
            case "misalignment":
                return diagnosis.misalignment.get(quantity.index)

    def _picked(self, point: int) -> None:
        if point < len(self._segments) and self._segments[point]:
            self.segment_wanted.emit(self._segments[point])

    def _set_findings(self, findings: Sequence[DiagnosisFinding]) -> None:
        while self._list.count() > 1:
            item = self._list.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        ranked = sorted(findings, key=lambda finding: _RANK.index(finding.state))
        self.texts = [said(finding.what) for finding in ranked]
        for finding in ranked:
            self._list.insertWidget(self._list.count() - 1, self._line(finding))

    def _line(self, finding: DiagnosisFinding) -> QWidget:
        """Icon and sentence; below in words its state, the chance of a false alarm, the segment."""
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        unbroken = said(finding.what).replace(" °/", "\u00a0°/\u2060").replace("u = ", "u\u00a0=\u00a0")
        column.addWidget(IconLine(_ICON_OF[finding.state], unbroken))
        words = {"fine": self.tr("fine"), "look": self.tr("worth a look"), "warn": self.tr("warning")}
        parts = [words[finding.state]]
        if finding.p is not None:
            parts.append(chance(finding.p))
        if finding.segment:
            parts.append(finding.segment)
        about = ElidedLabel("  ·  ".join(parts), tone="muted")
        about.setContentsMargins(_ICON_PX + GAP, 0, 0, 0)
        column.addWidget(about)
        return whole

    # plot -----------------------------------------------------------------------------------------------

    def _draw(self) -> None:
        found, quantity, plot = self._found(), self._quantity, self.plot
        if found is None or quantity is None or plot is None:
            return
        self.against.setVisible(isinstance(found, ScaleFactorDiagnosis))
        self.what.setVisible(isinstance(found, ZeroOffsetDiagnosis))
        symbol = f"{quantity.symbol}{quantity.index}"
        if isinstance(found, ScaleFactorDiagnosis):
            from ahrs_lab.ui.pages.results.diagnosis_plots import draw_residuals

            self._segments = draw_residuals(plot, found, quantity.axis, self.against.current())
            self._title.setText(self.tr("{symbol}: residuals").format(symbol=symbol))
            self._key.setText(self.tr("bars: two standard errors; ringed: stands apart"))
        elif isinstance(found, ZeroOffsetDiagnosis):
            self._draw_offset(plot, found, quantity, symbol)
        elif isinstance(quantity.source, MisalignmentResult):
            from ahrs_lab.ui.pages.results.plots import draw_turns

            self._segments = draw_turns(plot, quantity.source)
            self._title.setText(self.tr("{symbol}: both senses").format(symbol=symbol))
            self._key.setText("")

    def _draw_offset(self, plot: Plot, found: ZeroOffsetDiagnosis, quantity: Quantity, symbol: str) -> None:
        from ahrs_lab.ui.pages.results.diagnosis_plots import draw_allan, draw_harmonic, draw_positions

        there = {"allan": found.allan, "positions": found.residuals, "harmonic": found.harmonic}
        for key, one in there.items():
            self.what.button(key).setVisible(one is not None)
        if there[self.what.current()] is None:
            self.what.set_current(next((key for key, one in there.items() if one is not None), "allan"))
        self._segments = ()
        match self.what.current():
            case "allan" if found.allan is not None:
                draw_allan(plot, found.allan, quantity.axis)
                self._title.setText(self.tr("{symbol}: Allan deviation").format(symbol=symbol))
                self._key.setText(self.tr("band: 95 %; line: the noise model of the budget"))
            case "harmonic" if found.harmonic is not None:
                draw_harmonic(plot, found.harmonic, quantity.axis)
                self._title.setText(self.tr("{symbol}: the Earth's rate").format(symbol=symbol))
                self._key.setText(self.tr("line: as measured; dashed: expected at this latitude"))
            case "positions" if found.residuals is not None:
                self._segments = draw_positions(plot, found.residuals, quantity.axis)
                self._title.setText(self.tr("{symbol}: single recordings").format(symbol=symbol))
                self._key.setText(self.tr("Earth's rate taken out; bars: two standard errors of noise"))
            case _:
                plot.clear("", "")

    def retranslate(self) -> None:
        self._none.setText(
            self.tr(
                "This result has no diagnosis: an earlier version made it. Calculate it again to see one."
            )
        )
        self.against.set_texts(
            [("rate", self.tr("Rate")), ("order", self.tr("Order")), ("time", self.tr("Time"))]
        )
        self.what.set_texts(
            [
                ("allan", self.tr("Allan deviation")),
                ("positions", self.tr("Recordings")),
                ("harmonic", self.tr("Earth's rate")),
            ]
        )
        self._show()
