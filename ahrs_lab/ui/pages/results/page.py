"""The page Results: verdict, the three cards, and below what stands behind the chosen number."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QMenu, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.laboratory.budget_csv import save_budget_csv
from ahrs_lab.laboratory.evaluation import EvaluationSettings
from ahrs_lab.laboratory.judgement import Judged
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.recording.samples import Samples
from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.results.budget_view import BudgetView
from ahrs_lab.ui.pages.results.diagnosis_view import DiagnosisView
from ahrs_lab.ui.pages.results.findings_view import FindingsView
from ahrs_lab.ui.pages.results.imu_view import ImuView
from ahrs_lab.ui.pages.results.plot_view import PlotView
from ahrs_lab.ui.pages.results.quantities import GROUPS, Group, Quantity, quantities
from ahrs_lab.ui.pages.results.value_card import ValueCard
from ahrs_lab.ui.pages.results.values_view import ValuesView
from ahrs_lab.ui.pages.results.verdict import verdict_content
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Banner, Card, EmptyState, Label, ProgressBar, QuietButton


class ResultsPage(Page):
    """The open job's current result."""

    key = "results"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._judged: Judged | None = None
        self._imu: ImuResult | None = None
        self._number = ""
        self._quantities: dict[str, Quantity] = {}
        self._computed: dict[str, Quantity] = {}
        self._chosen = ""
        self._stack = QStackedWidget()
        self.outer.addWidget(self._stack)
        self._empty = EmptyState("results")
        self._empty.pressed.connect(self._leave_empty)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self._make_waiting())
        self._stack.addWidget(self._make_content())
        self.imu = ImuView()
        self.imu.certificate_wanted.connect(lambda: self.workspace.go_to("certificate"))
        self._stack.addWidget(self.imu)
        desk.evaluating.connect(self._evaluating)
        desk.jobs_changed.connect(self.refresh)
        desk.actor_changed.connect(self._permit)
        self.retranslate()

    # layout ---------------------------------------------------------------------------------------------

    def _make_waiting(self) -> QWidget:
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.addStretch(1)
        self._waiting_text = Label(role="title")
        self._waiting_bar = ProgressBar()
        self._waiting_bar.set_value(None)
        self._waiting_bar.setFixedWidth(420)
        row = QVBoxLayout()
        row.setSpacing(GAP)
        row.addWidget(self._waiting_text)
        row.addWidget(self._waiting_bar)
        centre = QHBoxLayout()
        centre.addStretch(1)
        centre.addLayout(row)
        centre.addStretch(1)
        column.addLayout(centre)
        column.addStretch(2)
        return whole

    def _make_content(self) -> QWidget:
        whole = QWidget()
        column = QVBoxLayout(whole)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self.verdict = Banner("info", large=True)
        self.verdict.pressed.connect(lambda: self.workspace.go_to("certificate"))
        column.addWidget(self.verdict)
        cards = QHBoxLayout()
        cards.setSpacing(CARD_MARGIN)
        self.cards: dict[Group, ValueCard] = {group: ValueCard(group) for group in GROUPS}
        for card in self.cards.values():
            card.chosen.connect(self.choose)
            card.unit_changed.connect(self._show_details)
            cards.addWidget(card, 1)
        column.addLayout(cards)
        column.addWidget(self._make_details(), 1)
        return whole

    def _make_details(self) -> Card:
        card = Card()
        head = QHBoxLayout()
        head.setSpacing(GAP)
        self.tabs = Tabs()
        self._busy = ProgressBar()
        self._busy.setFixedWidth(120)
        self._busy.setVisible(False)
        self.again = QuietButton(icon="repeat")
        self.again.setMenu(self._recalculation_menu())
        head.addWidget(self.tabs)
        head.addStretch(1)
        head.addWidget(self._busy)
        head.addWidget(self.again)
        card.add(head)
        self.plot, self.values = PlotView(), ValuesView()
        self.budget, self.diagnosis, self.findings = BudgetView(), DiagnosisView(), FindingsView()
        self._views = QStackedWidget()
        for view in (self.plot, self.values, self.budget, self.diagnosis, self.findings):
            self._views.addWidget(view)
        for source in (self.plot, self.diagnosis):
            source.segment_wanted.connect(self._open_segment)
        self.budget.save_wanted.connect(self._save_budgets)
        self.tabs.currentChanged.connect(self._views.setCurrentIndex)
        card.add(self._views, 1)
        return card

    def _recalculation_menu(self) -> QMenu:
        menu = QMenu(self)
        self._ways = {
            EvaluationSettings(rates, method): menu.addAction("")
            for method in ("gum", "annex-a")
            for rates in ("demanded", "table")
        }
        for settings, action in self._ways.items():
            action.triggered.connect(lambda _on=False, settings=settings: self._recalculate(settings))
        return menu

    # content --------------------------------------------------------------------------------------------

    def entered(self) -> None:
        self.refresh()

    def job_changed(self) -> None:
        self.refresh()

    def refresh(self) -> None:
        """Look at the open job's result again."""
        number = self._desk.number
        judged, self._imu = None, None
        try:
            result = self._desk.laboratory.result(number) if number else None
            self._imu = result if isinstance(result, ImuResult) else None
            judged = self._desk.laboratory.judged(number) if number and self._imu is None else None
        except AhrsLabError as error:
            self._desk.tell(error)
        if judged is not None and judged == self._judged and number == self._number:
            self._permit()
            return
        self.show_judged(judged)

    def show_judged(self, judged: Judged | None) -> None:
        """Everything of the page from one result; None: there is none yet."""
        self._judged = judged
        self.imu.show_result(self._imu)
        if self._stack.currentIndex() != 1:
            self._stack.setCurrentIndex(self._place())
        if judged is None:
            self._quantities, self._computed = {}, {}
            self._name_empty()
            return
        found = quantities(judged.shown)
        self._quantities = {quantity.key: quantity for quantity in found}
        self._computed = {quantity.key: quantity for quantity in quantities(judged.computed)}
        for group, card in self.cards.items():
            of_group = [quantity for quantity in found if quantity.group == group]
            card.set_quantities(of_group, judged.conformity)
        if self._number != self._desk.number:
            self._number = self._desk.number
            self._take_units(judged)
        self._show_sheets()
        self._permit()
        if self._chosen not in self._quantities:
            self._chosen = found[0].key if found else ""
        self.choose(self._chosen)

    def _take_units(self, judged: Judged) -> None:
        """Begin with the units that the job asks for."""
        units = judged.requirements.units
        self.cards["scale_factor"].prefer_unit(units.scale_factor)
        self.cards["zero_offset"].prefer_unit({"deg/s": "dps", "deg/h": "dph"}.get(units.zero_offset, ""))
        self.cards["misalignment"].prefer_unit(units.misalignment)

    def _show_sheets(self) -> None:
        judged = self._judged
        if judged is None:
            return
        self.values.show_result(judged.shown)
        self.findings.show_result(judged.shown, judged.raised)
        self.verdict.set_content(*verdict_content(judged))

    def choose(self, key: str) -> None:
        """Show plot and budget of this quantity."""
        self._chosen = key
        for card in self.cards.values():
            card.mark(key)
        self._show_details()

    def _show_details(self) -> None:
        quantity = self._quantities.get(self._chosen)
        judged = self._judged
        if quantity is None or judged is None:
            return
        unit = self.cards[quantity.group].unit()
        if unit is None:
            return
        self.plot.show_quantity(quantity, unit, judged.shown)
        raised = quantity.key.replace(".", "_") in judged.raised
        self.budget.show_quantity(self._computed[quantity.key], unit, quantity if raised else None)
        self.diagnosis.show_quantity(quantity, judged.computed)

    def _permit(self) -> None:
        number = self._desk.number
        if not number or self._judged is None:
            return
        self.again.setVisible(
            self._desk.laboratory.job(number).state == "measured"
            and not self._desk.laboratory.signatures(number)
        )

    # actions --------------------------------------------------------------------------------------------

    def _evaluating(self, on: bool) -> None:
        if on:
            self._stack.setCurrentIndex(1)
        else:
            self._stack.setCurrentIndex(self._place())

    def _place(self) -> int:
        """Which sheet of the stack what there is belongs on."""
        return 3 if self._imu is not None else 2 if self._judged is not None else 0

    def _recalculate(self, settings: EvaluationSettings) -> None:
        actor = self._desk.ask_actor(self)
        number = self._desk.number
        if actor is None or not number:
            return
        self._set_busy(True)
        self._desk.run(
            self,
            lambda: self._desk.laboratory.recalculate(number, settings, actor),
            self._recalculated,
            self._refused,
        )

    def _recalculated(self, _result: object) -> None:
        self._set_busy(False)
        self.refresh()
        self._desk.changed()

    def _refused(self, error: AhrsLabError) -> None:
        self._set_busy(False)
        self._desk.tell(error)

    def _set_busy(self, busy: bool) -> None:
        self._busy.set_value(None if busy else 0.0)
        self._busy.setVisible(busy)
        self.again.setEnabled(not busy)

    def _open_segment(self, name: str) -> None:
        number = self._desk.number
        self._set_busy(True)

        def opened(samples: Samples) -> None:
            self._set_busy(False)
            self.tabs.setCurrentIndex(0)
            self.plot.show_segment(name, samples)

        self._desk.run(
            self,
            lambda: self._desk.laboratory.segment_samples(number, name),
            opened,
            self._refused,
            topic="segment",
        )

    def _save_budgets(self) -> None:
        if self._judged is None:
            return
        result = self._judged.computed
        name = str(Path.home() / f"{self._desk.number}-budget.csv")
        path, _ = QFileDialog.getSaveFileName(
            self, self.tr("Save as"), name, self.tr("Tables for a spreadsheet (*.csv)")
        )
        if path:
            self._desk.run(self, lambda: save_budget_csv(result, Path(path)), self._saved, topic="save")

    def _saved(self, target: Path) -> None:
        self.workspace.notice("good", self.tr("Saved as {path}.").format(path=target))

    def _leave_empty(self) -> None:
        self.workspace.go_to("jobs")

    # words ----------------------------------------------------------------------------------------------

    def _name_empty(self) -> None:
        if self._desk.number:
            self._empty.set_content(
                self.tr("Not measured yet"),
                self.tr(
                    "Scale factors, zero offsets and misalignments of this job will be here, "
                    "each with its uncertainty and its plot."
                ),
                self.tr("Prepare and start"),
            )
        else:
            self._empty.set_content(
                self.tr("No job is open"),
                self.tr("Open a job to see its scale factors, zero offsets and misalignments."),
                self.tr("Choose a job"),
            )

    def retranslate(self) -> None:
        self._waiting_text.setText(self.tr("Evaluating the recording"))
        self._name_empty()
        titles = {
            "scale_factor": self.tr("Scale factor"),
            "zero_offset": self.tr("Zero offset"),
            "misalignment": self.tr("Misalignment"),
        }
        for group, card in self.cards.items():
            card.set_words(titles[group], self.tr("Not part of this calibration."))
        self.tabs.set_texts(
            self.tr("Plot"),
            self.tr("Values"),
            self.tr("Uncertainty budget"),
            self.tr("Diagnosis"),
            self.tr("Warnings and deviations"),
        )
        self.again.setText(self.tr("Calculate again"))
        methods = {"gum": self.tr("GUM"), "annex-a": self.tr("annex A")}
        rates = {"demanded": self.tr("demanded rates"), "table": self.tr("rates of the table")}
        for settings, action in self._ways.items():
            action.setText(f"{methods[settings.uncertainty]}, {rates[settings.rates]}")
        if self._judged is not None:
            self._show_sheets()
            self._show_details()
