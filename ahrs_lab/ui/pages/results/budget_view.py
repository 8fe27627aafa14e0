"""The tab Uncertainty budget: every source of the chosen quantity's uncertainty in the unit that is on, what
if one were better known, and beside it the Monte Carlo check."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.budget_table import BudgetTable
from ahrs_lab.ui.pages.results.monte_carlo_view import MonteCarloView
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit, show
from ahrs_lab.ui.pages.results.what_if_model import WhatIfModel, degrees_of_freedom, significant
from ahrs_lab.ui.pages.results.what_if_strip import WhatIfStrip
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Line, MarkedLabel, QuietButton

_CHECK_PX = 288


class BudgetView(Translated):
    """Follows the quantity that is chosen on the page; ``save_wanted`` asks for all budgets as a file."""

    save_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._quantity: Quantity | None = None
        self._unit: Unit | None = None
        self._reported: Quantity | None = None
        self._model = WhatIfModel()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        row.addLayout(self._make_budget(), 1)
        self.check = MonteCarloView()
        self._check_side = QWidget()
        side = QHBoxLayout(self._check_side)
        side.setContentsMargins(0, 0, 0, 0)
        side.setSpacing(CARD_MARGIN)
        side.addWidget(Line(Qt.Orientation.Vertical))
        side.addWidget(self.check)
        self._check_side.setFixedWidth(_CHECK_PX)
        row.addWidget(self._check_side)
        self.retranslate()

    def _make_budget(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(GAP)
        head = QHBoxLayout()
        head.setSpacing(0)
        self._sum = MarkedLabel(role="strong")
        self.ask_button = QuietButton(icon="edit")
        self.ask_button.clicked.connect(self._ask)
        self.save_button = QuietButton(icon="export")
        self.save_button.clicked.connect(self.save_wanted)
        self.check_button = QuietButton(icon="results")
        self.check_button.setCheckable(True)
        self.check_button.setChecked(True)
        self.check_button.toggled.connect(self._show_check)
        head.addWidget(self._sum, 1)
        for button in (self.ask_button, self.save_button, self.check_button):
            head.addWidget(button)
        self.strip = WhatIfStrip()
        self.strip.reset_wanted.connect(self.reset)
        self.table = BudgetTable()
        self.table.edited.connect(self.change)
        column.addLayout(head)
        column.addWidget(self.strip)
        column.addWidget(self.table, 1)
        return column

    def show_quantity(self, quantity: Quantity, unit: Unit, reported: Quantity | None = None) -> None:
        """The budget of ``quantity``; contributions in ``unit``. What was asked of another one is gone.

        ``reported``: the same with its U raised to the laboratory's capability.
        """
        self._quantity, self._unit, self._reported = quantity, unit, reported
        another = self._model.follow(quantity)
        self.check.show_quantity(quantity, unit)
        self.strip.clear()
        self._show()
        if another:
            self.table.scrollToTop()

    def change(self, key: str, text: str) -> None:
        """What if u(x) of this row were ``text``; empty restores it."""
        try:
            self._model.change(int(key), text)
        except AhrsLabError as error:
            self.strip.refuse(said(error.message))
            return
        self.strip.clear()
        self._show()

    def reset(self) -> None:
        """Back to the result."""
        self._model.reset()
        self.strip.clear()
        self._show()

    def _show(self) -> None:
        if self._quantity is None or self._unit is None:
            return
        found, before = self._model.uncertainty, self._quantity.uncertainty
        self._sum.set_marked(self._sum_line(self._quantity, before, self._unit))
        self.table.show_budget(found, before, self._unit)
        if self._model.changes:
            label = "" if self._unit.label == "1" else f" {self._unit.label}"
            factor = abs(self._unit.factor)
            now, was = (f"{significant(U * factor)}{label}" for U in (found.expanded, before.gum_expanded))
            k = number(found.coverage_factor, 2)
            if now == was:
                self.strip.say_unchanged(now, k)
            else:
                self.strip.say(now, was, k)

    def _sum_line(self, quantity: Quantity, found: Uncertainty, unit: Unit) -> str:
        label = "" if unit.label == "1" else unit.label
        shown = show(quantity, unit)
        method = self.tr("annex A") if found.method == "annex-a" else self.tr("GUM")
        parts = (
            f"{quantity.symbol}_{{{quantity.index}}} = {shown.value} ± {shown.expanded} {label}".rstrip(),
            f"u = {significant(found.standard * abs(unit.factor))} {label}".rstrip(),
            f"k = {number(found.coverage_factor, 2)}",
            f"ν = {degrees_of_freedom(found.dof)}",
            method,
            *([self.tr("U from Monte Carlo")] if found.from_monte_carlo else ()),
            *([self._raised(self._reported, unit)] if self._reported is not None else ()),
        )
        return "   ".join(parts)

    def _raised(self, reported: Quantity, unit: Unit) -> str:
        shown = show(reported, unit)
        return self.tr("reported: U = {expanded} (CMC)").format(expanded=shown.expanded)

    def _ask(self) -> None:
        keys = self.table.keys()
        if keys:
            self.table.edit_key(self.table.current_key() or keys[0])

    def _show_check(self, on: bool) -> None:
        self._check_side.setVisible(on)

    def retranslate(self) -> None:
        self.ask_button.setText(self.tr("What if …"))
        self.ask_button.setToolTip(
            self.tr("Type another u(x) and see U: double-click a row, or F2. The result stays as it is.")
        )
        self.save_button.setText(self.tr("Save as CSV …"))
        self.save_button.setToolTip(self.tr("All budgets of this result, for a spreadsheet."))
        self.check_button.setText(self.tr("Monte Carlo"))
        self.check_button.setToolTip(self.tr("Show or hide the Monte Carlo check."))
        self.strip.clear()
        self._show()
