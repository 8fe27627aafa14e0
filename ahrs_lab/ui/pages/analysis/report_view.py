"""A report on the screen: its charts above, one in front at a time; below warnings, tables and notes."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QResizeEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QScrollArea,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from ahrs_lab.analysis.report import Report, Table
from ahrs_lab.analysis.report_cells import number_columns, readable
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.setting_values import titled
from ahrs_lab.ui.pages.widgets.form import ChoiceField
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, STEP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import ElidedLabel, IconButton, Label, rich_text

if TYPE_CHECKING:
    from ahrs_lab.ui.pages.analysis.chart_view import ChartView

_SHARES = (3, 2)
_HEADING_PX = 84
_COPY_PX = 20
_COMMA = re.compile("，(?=.{3})")
"""Where a Chinese heading may be broken: not before a unit of one sign."""
_LEAST_PX, _NO_LIMIT_PX = 90, 16_777_215


class ReportTable(QWidget):
    """Title and table, as high as its rows; wider ones scroll sideways. ``copy`` puts it on the clipboard, as
    a spreadsheet takes it."""

    def __init__(self, table: Table) -> None:
        super().__init__()
        self._content = table
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        head = QHBoxLayout()
        self.title = Label(titled(said(table.title)), role="strong", wrap=True)
        self.copy = IconButton("copy")
        self.copy.setFixedHeight(_COPY_PX)
        self.copy.set_hint(self.tr("Copy the table"))
        self.copy.clicked.connect(self._copy)
        head.addWidget(self.title, 1)
        head.addWidget(self.copy, 0, Qt.AlignmentFlag.AlignTop)
        self.table = TextTable(selectable=False, compact=True)
        self.table.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        numbers = number_columns(table)
        self.table.set_content(
            [
                Column(_in_lines(rich_text.plain(readable(said(head))), self.table), right=right)
                for head, right in zip(table.head, numbers, strict=True)
            ],
            [
                tuple(
                    Cell(readable(said(cell)), "text" if place or numbers[0] else "muted")
                    for place, cell in enumerate(row)
                )
                for row in table.rows
            ],
        )
        column.addLayout(head)
        column.addWidget(self.table)
        self._fit()

    def _copy(self) -> None:
        rows = [[said(cell) for cell in row] for row in (self._content.head, *self._content.rows)]
        QGuiApplication.clipboard().setText("\n".join("\t".join(row) for row in rows))

    def _fit(self) -> None:
        rows = self.table.verticalHeader().defaultSectionSize() * self.table.model().rowCount()
        head = self.table.horizontalHeader().sizeHint().height()
        wider = self.table.horizontalHeader().length() > self.width()
        bar = self.table.horizontalScrollBar().sizeHint().height() if wider else 2
        self.table.setFixedHeight(head + rows + bar)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()


def _in_lines(heading: str, table: QWidget) -> str:
    """A long heading over several lines, so that its column is not much wider than its numbers."""
    metrics = table.fontMetrics()
    lines: list[str] = []
    for word in _COMMA.sub("， ", heading).split(" "):
        between = "" if lines and lines[-1].endswith("，") else " "
        if lines and metrics.horizontalAdvance(f"{lines[-1]}{between}{word}") <= _HEADING_PX:
            lines[-1] += f"{between}{word}"
        else:
            lines.append(word)
    return "\n".join(lines)


class ReportView(Translated):
    """``show_report`` replaces all; with the same charts as before the one in front stays in front."""

    def __init__(self) -> None:
        super().__init__()
        self._report: Report | None = None
        self.chart: ChartView | None = None
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        self._split = QSplitter(Qt.Orientation.Vertical)
        self._split.setChildrenCollapsible(False)
        self._split.setHandleWidth(CARD_MARGIN)
        outer.addWidget(self._split)
        self._charts = QWidget()
        self._chart_column = QVBoxLayout(self._charts)
        self._chart_column.setContentsMargins(0, 0, 0, 0)
        self._chart_column.setSpacing(GAP)
        self.tabs = Tabs()
        self.tabs.currentChanged.connect(lambda _place: self._draw())
        self.charts = ChoiceField()
        self.charts.edited.connect(lambda: self.tabs.setCurrentIndex(int(self.charts.key())))
        self._chart_title = ElidedLabel(role="strong")
        self._chart_column.addWidget(self.tabs)
        self._chart_column.addWidget(self.charts)
        self._chart_column.addWidget(self._chart_title)
        self._split.addWidget(self._charts)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._split.addWidget(self._area)
        for place, share in enumerate(_SHARES):
            self._split.setStretchFactor(place, share)
        self._split.setSizes([100 * share for share in _SHARES])
        self.tables: list[ReportTable] = []
        self.lines: list[IconLine | Label] = []

    def show_report(self, report: Report) -> None:
        """In the language that is on."""
        self._report = report
        self._name_charts(report)
        self._charts.setVisible(bool(report.charts))
        self._write(report)
        self._draw()

    def texts(self) -> list[str]:
        """Warnings and notes as they stand there."""
        return [line.text() for line in self.lines]

    def _name_charts(self, report: Report) -> None:
        front = self.tabs.currentIndex()
        self.tabs.blockSignals(True)
        while self.tabs.count() > len(report.charts):
            self.tabs.removeTab(self.tabs.count() - 1)
        self.tabs.set_texts(*(said(chart.title) for chart in report.charts))
        self.tabs.setCurrentIndex(max(0, min(front, self.tabs.count() - 1)))
        self.tabs.blockSignals(False)
        self.charts.set_choices([(str(i), said(chart.title)) for i, chart in enumerate(report.charts)])
        self.charts.set_key(str(self.tabs.currentIndex()))
        self._choose_switch()
        title = said(report.charts[0].title) if report.charts else ""
        self._chart_title.setText(title)
        self._chart_title.setVisible(len(report.charts) == 1 and title != said(report.title))

    def _choose_switch(self) -> None:
        """Tabs where they fit side by side, else a list to choose from."""
        needed = sum(self.tabs.tabSizeHint(place).width() for place in range(self.tabs.count()))
        several, fit = self.tabs.count() > 1, needed <= self.width()
        self.tabs.setVisible(several and fit)
        self.charts.setVisible(several and not fit)

    def _draw(self) -> None:
        self.charts.set_key(str(self.tabs.currentIndex()))
        if self._report is None or not self._report.charts:
            return
        if self.chart is None:
            from ahrs_lab.ui.pages.analysis.chart_view import ChartView

            self.chart = ChartView()
            self.chart.whole.set_hint(self.tr("Show all"))
            self._chart_column.addWidget(self.chart, 1)
        self.chart.show_chart(self._report.charts[max(0, self.tabs.currentIndex())])

    def _write(self, report: Report) -> None:
        inside = QWidget()
        inside.setObjectName("scrolled")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, GAP, 0)
        column.setSpacing(CARD_MARGIN)
        self.lines = [IconLine("warn", said(what)) for what in report.warnings]
        for line in self.lines:
            column.addWidget(line)
        self.tables = [ReportTable(table) for table in report.tables]
        for table in self.tables:
            column.addWidget(table)
        notes = [Label(said(note), tone="muted", wrap=True) for note in report.notes]
        self.lines += notes
        if notes:
            column.addSpacing(STEP)
        for note in notes:
            column.addWidget(note)
        column.addStretch(1)
        place = self._area.verticalScrollBar().value()
        old = self._area.takeWidget()
        if old is not None:
            old.deleteLater()
        self._area.setWidget(inside)
        self._fit()
        self._area.verticalScrollBar().setValue(place)
        self._area.setVisible(bool(report.warnings or report.tables or report.notes))

    def _fit(self) -> None:
        """What the tables do not need is the chart's."""
        inside = self._area.widget()
        layout = inside.layout() if inside is not None else None
        if layout is None or self._report is None:
            return
        needed = layout.totalHeightForWidth(self.width() - 2 * GAP)
        charts = bool(self._report.charts)
        self._area.setMaximumHeight(max(_LEAST_PX, needed) if charts else _NO_LIMIT_PX)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._choose_switch()
        self._fit()

    def retranslate(self) -> None:
        if self._report is not None:
            self.show_report(self._report)
        if self.chart is not None:
            self.chart.whole.set_hint(self.tr("Show all"))
