"""The figures that a standard's certificate states: one row for each that its kind can state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import cast

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.stated_figures import (
    FIGURES,
    LIMITS,
    UNITS,
    FigureName,
    StatedDistribution,
    StatedFigure,
    figures_of_kind,
)
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.widgets.form import ChoiceField, Field, TextField
from ahrs_lab.ui.theme import GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Label

_UNIT_SIGNS = {"arcsec": "″", "arcmin": "′", "deg": "°", "urad": "µrad", "um": "µm", "uV": "µV"}
_ROWS_SHOWN_PX = 202
_NUMBER_PX, _UNIT_PX, _STATED_PX = 80, 84, 176


@dataclass
class _Row:
    figure: FigureName
    name: Label
    value: TextField
    unit: ChoiceField
    known_as: ChoiceField
    k: TextField
    dof: TextField

    @property
    def fields(self) -> tuple[Field, ...]:
        return (self.value, self.unit, self.known_as, self.k, self.dof)


class FiguresForm(Translated):
    """Follows the kind of standard; an empty row is a figure that the certificate does not state."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        self._title = Label(role="strong")
        self._hint = Label(tone="faint", wrap=True)
        column.addWidget(self._title)
        column.addWidget(self._hint)
        self._inside = QWidget()
        self._inside.setObjectName("scrolled")
        self._grid = QGridLayout(self._inside)
        self._grid.setContentsMargins(0, 0, GAP, 0)
        self._grid.setHorizontalSpacing(GAP)
        self._grid.setVerticalSpacing(4)
        self._grid.setColumnStretch(0, 1)
        self._heads = [Label(tone="muted") for _ in range(6)]
        for place, head in enumerate(self._heads):
            self._grid.addWidget(head, 0, place)
        self.rows = {name: self._add_row(name, line) for line, name in enumerate(FIGURES, 1)}
        self._grid.setRowStretch(len(FIGURES) + 1, 1)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setWidget(self._inside)
        column.addWidget(self._area)
        self._shown: tuple[FigureName, ...] = ()
        self.retranslate()

    def _add_row(self, figure: FigureName, line: int) -> _Row:
        row = _Row(figure, Label(), TextField(), ChoiceField(), ChoiceField(), TextField(), TextField())
        units = UNITS[FIGURES[figure].unit]
        row.unit.set_choices([(unit, _UNIT_SIGNS.get(unit, unit)) for unit in units])
        row.known_as.edited.connect(lambda: _allow(row))
        for number in (row.value, row.k, row.dof):
            number.setFixedWidth(_NUMBER_PX)
        row.unit.setFixedWidth(_UNIT_PX)
        row.known_as.setFixedWidth(_STATED_PX)
        self._grid.addWidget(row.name, line, 0)
        for place, field in enumerate(row.fields, 1):
            field.set_bare()
            self._grid.addWidget(field, line, place)
        return row

    def set_kind(self, kind: str) -> None:
        """Show the rows of this kind; what is typed in the others is not read."""
        self._shown = figures_of_kind(kind)
        for name, row in self.rows.items():
            for widget in (row.name, *row.fields):
                widget.setVisible(name in self._shown)
        self.setVisible(bool(self._shown))
        self._area.setFixedHeight(min(self._grid.sizeHint().height(), _ROWS_SHOWN_PX))

    def set_figures(self, figures: tuple[StatedFigure, ...]) -> None:
        """What is stated now."""
        for figure in figures:
            row = self.rows[figure.figure]
            row.value.set_text(_number(figure.value))
            row.unit.set_key(figure.unit)
            row.known_as.set_key(figure.distribution)
            row.k.set_text(_number(figure.coverage_factor))
            row.dof.set_text(_number(figure.dof))
            _allow(row)

    def figures(self) -> tuple[StatedFigure, ...]:
        """What stands in the rows; raises ValueError with what is wrong, which is marked."""
        for row in self.rows.values():
            for field in row.fields:
                field.set_error("")
        return tuple(figure for name in self._shown if (figure := self._figure(self.rows[name])))

    def _figure(self, row: _Row) -> StatedFigure | None:
        limits = row.known_as.key() in LIMITS
        if not row.value.text() and (limits or not row.k.text()) and not row.dof.text():
            return None
        value = self._read(row, row.value)
        k = None if limits else self._read(row, row.k)
        dof = math.inf if limits or not row.dof.text() else self._read(row, row.dof)
        distribution = cast("StatedDistribution", row.known_as.key())
        try:
            return StatedFigure(
                row.figure, value or 0.0, row.unit.key(), k, distribution, math.inf if dof is None else dof
            )
        except InputError as error:
            wrong = row.value if not value or value < 0.0 else row.k if not k or k <= 0.0 else row.dof
            raise self._wrong(wrong, said(error.message)) from error

    def _read(self, row: _Row, field: TextField) -> float | None:
        text = field.text().replace("−", "-").replace(",", ".")
        if not text:
            return None
        try:
            return float(text)
        except ValueError:
            said_so = self.tr("{figure}: write numbers as 10, 0.0002 or 2E-4.")
            raise self._wrong(field, said_so.format(figure=row.name.text())) from None

    def _wrong(self, field: TextField, text: str) -> ValueError:
        field.set_error(text)
        self._area.ensureWidgetVisible(field)
        return ValueError(text)

    def retranslate(self) -> None:
        self._title.setText(self.tr("Figures that the certificate states"))
        self._hint.setText(
            self.tr(
                "They go into the uncertainty budgets or the check of clause 6; what a budget lacks is "
                "clause 6's own figure, marked as an assumption."
            )
        )
        heads = (
            self.tr("Figure"),
            self.tr("U or limit"),
            self.tr("Unit"),
            self.tr("Stated as"),
            "k",
            "ν",
        )
        self._heads[-1].setToolTip(self.tr("Degrees of freedom, where the certificate states them"))
        for head, text in zip(self._heads, heads, strict=True):
            head.setText(text)
        choices = [
            ("normal", self.tr("U with k")),
            ("rectangular", self.tr("± limit, rectangular")),
            ("triangular", self.tr("± limit, triangular")),
            ("arcsine", self.tr("± limit, arcsine")),
        ]
        for row in self.rows.values():
            row.name.setText(said(FIGURES[row.figure].name))
            row.known_as.set_choices(choices)
            for field, text in zip(row.fields, heads[1:], strict=True):
                field.editor.setAccessibleName(f"{row.name.text()}: {text}")


def _allow(row: _Row) -> None:
    """A limit has neither k nor degrees of freedom."""
    stated = row.known_as.key() == "normal"
    for field in (row.k, row.dof):
        field.setEnabled(stated)
        if not stated:
            field.set_text("")


def _number(value: float | None) -> str:
    return "" if value is None or not math.isfinite(value) else f"{value:.10g}"
