"""The card of an analysis' outcome: what went wrong, what came out, whether it still answers what stands in
the form, and the button that saves it."""

from __future__ import annotations

from PySide6.QtCore import QElapsedTimer, Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome
from ahrs_lab.messages import Message
from ahrs_lab.ui.formatting import duration
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.report_view import ReportView
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Card, ElidedLabel, EmptyState, Label, ProgressBar, SecondaryButton

PATIENCE_MS = 300
"""Work that takes longer shows that it goes on."""
_TELL_TIME_S = 5


class OutcomeCard(Translated):
    """``save_wanted``: the outcome shall be written; ``error_closed``: what went wrong was read."""

    save_wanted = Signal()
    error_closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._kind: AnalysisKind | None = None
        self._outcome: Outcome | None = None
        self._changed = False
        self._error: Message | None = None
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        card = Card()
        outer.addWidget(card)
        self._head = self._make_head()
        card.add(self._head)
        self.banner = Banner("bad", closable=True)
        self.banner.setVisible(False)
        self.banner.closed.connect(self.error_closed)
        card.add(self.banner)
        self._stack = QStackedWidget()
        self._empty = EmptyState("analyse")
        self.report = ReportView()
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self.report)
        card.add(self._stack, 1)
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.setInterval(PATIENCE_MS)
        self._patience.timeout.connect(self._show_progress)
        self._second = QTimer(self)
        self._second.setInterval(1000)
        self._second.timeout.connect(self._tell_time)
        self._since = QElapsedTimer()
        self.retranslate()

    def _make_head(self) -> QWidget:
        whole = QWidget()
        row = QHBoxLayout(whole)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(CARD_MARGIN)
        self._title = ElidedLabel(role="title")
        self.warnings = Chip()
        self.stale = Chip()
        self._progress = QWidget()
        column = QHBoxLayout(self._progress)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GAP)
        self._time = Label(tone="muted")
        self.bar = ProgressBar()
        self.bar.setFixedWidth(110)
        column.addWidget(self._time)
        column.addWidget(self.bar)
        self._progress.setVisible(False)
        self.save = SecondaryButton(icon="export")
        self.save.clicked.connect(self.save_wanted)
        row.addWidget(self._title, 1)
        for widget in (self._progress, self.warnings, self.stale, self.save):
            row.addWidget(widget, 0, Qt.AlignmentFlag.AlignVCenter)
        whole.setMinimumHeight(self.save.sizeHint().height())
        return whole

    # content --------------------------------------------------------------------------------------------

    def show_outcome(
        self, kind: AnalysisKind, outcome: Outcome | None, error: Message | None, *, changed: bool
    ) -> None:
        """What is known of ``kind``; ``changed``: the form says something else by now."""
        another = outcome is not self._outcome
        self._kind, self._outcome, self._error = kind, outcome, error
        if outcome is not None and another:
            self.report.show_report(outcome.report)
        self._stack.setCurrentIndex(0 if outcome is None else 1)
        self.mark_changed(changed)
        self._name()

    def mark_changed(self, changed: bool) -> None:
        """Whether the form says something else by now."""
        self._changed = changed
        self.stale.setVisible(changed and self._outcome is not None)

    def set_running(self, running: bool) -> None:
        """Work goes on, or has ended."""
        if running and not self._since.isValid():
            self._since.start()
            self._patience.start()
        elif not running:
            self._since.invalidate()
            self._patience.stop()
            self._second.stop()
            self.bar.set_value(0.0)
            self._progress.setVisible(False)
            self._show_head()

    def progress_shown(self) -> bool:
        """The bar runs."""
        return self._progress.isVisibleTo(self)

    def _show_progress(self) -> None:
        self.bar.set_value(None)
        self._time.setText("")
        self._progress.setVisible(True)
        self._show_head()
        self._second.start()

    def _show_head(self) -> None:
        """Not an empty line above what will be here."""
        self._head.setVisible(self._outcome is not None or self._progress.isVisibleTo(self._head))

    def _tell_time(self) -> None:
        seconds = self._since.elapsed() // 1000
        self._time.setText(duration(seconds) if seconds >= _TELL_TIME_S else "")

    # words ----------------------------------------------------------------------------------------------

    def _name(self) -> None:
        kind, outcome = self._kind, self._outcome
        self.save.setVisible(outcome is not None)
        self._show_head()
        warnings = len(outcome.report.warnings) if outcome is not None else 0
        self.warnings.setVisible(warnings > 0)
        self.warnings.set_content(
            "warn",
            "warn",
            self.tr("1 warning") if warnings == 1 else self.tr("{count} warnings").format(count=warnings),
        )
        self.stale.set_content("plain", "info", self.tr("Settings changed"))
        self.stale.setToolTip(self.tr("These are the results of other settings: run the analysis again."))
        error = said(self._error) if self._error is not None else ""
        self.banner.set_content("bad", "", error)
        self.banner.setVisible(bool(error))
        if kind is None:
            return
        self._title.setText(said(outcome.report.title) if outcome is not None else "")
        inputs = bool(kind.inputs)
        self._empty.set_content(
            said(kind.name),
            self.tr("Tables and charts will be here: choose what to analyse on the left, then run it.")
            if inputs
            else self.tr("Tables and charts will be here: check the settings on the left, then run it."),
        )

    def retranslate(self) -> None:
        self.save.setText(self.tr("Save…"))
        self.report.retranslate()
        self._name()
