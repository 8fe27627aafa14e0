"""The tab Warnings and deviations: what the reader of the result has to know."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.metrology.result import Reported, ResultWarning
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.widgets.icon_line import IconLine
from ahrs_lab.ui.pages.words import listed
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Label


class FindingsView(Translated):
    """``texts`` are the sentences as they stand there."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(0, 0, GAP, 0)
        self._list.setSpacing(GAP)
        self._list.addStretch(1)
        area.setWidget(inside)
        column.addWidget(area)
        self.texts: list[str] = []

    def show_result(self, result: Reported, raised: Sequence[str] = ()) -> None:
        """Replace all lines. ``raised``: quantities whose U is the laboratory's capability."""
        while self._list.count() > 1:
            item = self._list.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        self.texts = []
        self._head(self.tr("Warnings"))
        if not result.warnings:
            self._line("good", self.tr("The recording has no defects."))
        for warning in result.warnings:
            self._line("warn", self._sentence(warning))
        by_standard = result.procedure == "jjf1536-2015"
        self._head(
            self.tr("Deviations from the standard") if by_standard else self.tr("Remarks on the method")
        )
        if not result.deviations:
            self._line(
                "good", self.tr("The plan follows JJF 1536-2015.") if by_standard else self.tr("None.")
            )
        for deviation in result.deviations:
            self._line("info", said(deviation))
        if raised:
            self._head(self.tr("Expanded uncertainty"))
            keys = listed(key.replace("_", "") for key in raised)
            self._line(
                "info",
                self.tr(
                    "U of {quantities} is raised to the laboratory's best measurement capability (CMC)."
                ).format(quantities=keys),
            )
        if result.environment is not None:
            room = result.environment
            self._head(self.tr("Room during the run"))
            self._line(
                "info",
                self.tr("({t} ± {dt}) °C, ({h} ± {dh}) %RH").format(
                    t=number(room.temperature_c, 1),
                    dt=number(room.temperature_spread_c, 1),
                    h=number(room.humidity_percent, 0),
                    dh=number(room.humidity_spread_percent, 0),
                ),
            )

    def _sentence(self, warning: ResultWarning) -> str:
        text = said(warning.what)
        if warning.segment and warning.line:
            return self.tr("{text} (segment {segment}, line {line})").format(
                text=text, segment=warning.segment, line=warning.line
            )
        if warning.segment:
            return self.tr("{text} (segment {segment})").format(text=text, segment=warning.segment)
        return text

    def _head(self, text: str) -> None:
        head = Label(text, role="strong")
        if self._list.count() > 1:
            head.setContentsMargins(0, CARD_MARGIN, 0, 0)
        self._list.insertWidget(self._list.count() - 1, head)

    def _line(self, state: str, text: str) -> None:
        self.texts.append(text)
        self._list.insertWidget(self._list.count() - 1, IconLine(state, text))
