"""The page Analysis. What it is made of is imported when it is first entered: the systems and their plots
cost a second, which the first window shall not wait for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QStackedWidget

from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.widgets import EmptyState

if TYPE_CHECKING:
    from ahrs_lab.laboratory.analyses.kinds import AnalysisKind
    from ahrs_lab.ui.pages.analysis.workbench import Workbench

Kinds = tuple["AnalysisKind", ...]


def house_analyses() -> Kinds:
    """Those that the house offers."""
    from ahrs_lab.laboratory.analyses import analyses

    return analyses()


class AnalysisPage(Page):
    """``kinds`` gives the analyses; it is called once, in the worker, when the page is first entered."""

    key = "analyse"

    def __init__(self, desk: Desk, kinds: Callable[[], Kinds] = house_analyses) -> None:
        super().__init__(desk.workspace)
        self._desk = desk
        self._give = kinds
        self._asked = False
        self.workbench: Workbench | None = None
        self._stack = QStackedWidget()
        self._empty = EmptyState("analyse")
        self._stack.addWidget(self._empty)
        self.outer.addWidget(self._stack)
        self.retranslate()

    def entered(self) -> None:
        if self.workbench is not None:
            self.workbench.refresh()
        elif not self._asked:
            self._asked = True
            self._desk.run(self, self._give, self._made)

    def _made(self, kinds: Kinds) -> None:
        from ahrs_lab.ui.pages.analysis.workbench import Workbench

        if not kinds:
            return
        self.workbench = Workbench(self._desk, kinds)
        self._stack.addWidget(self.workbench)
        self._stack.setCurrentWidget(self.workbench)

    def job_changed(self) -> None:
        if self.workbench is not None and self.isVisible():
            self.workbench.refresh()

    def retranslate(self) -> None:
        self._empty.set_content(
            self.tr("Analyses of recordings"),
            self.tr(
                "Allan deviation, navigation, alignment and calibration of inertial units from recorded data "
                "will be here, with their tables and charts."
            ),
        )
