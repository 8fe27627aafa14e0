"""The tab Values: the result sheet of annex C, each value in both of its usual units."""

from __future__ import annotations

from PySide6.QtWidgets import QVBoxLayout

from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit, quantities, show, units
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.pages.words import axis_names

_COLUMN_UNITS = {
    "scale_factor": ("1", "ppm"),
    "zero_offset": ("dps", "dph"),
    "misalignment": ("rad", "arcmin"),
}


class ValuesView(Translated):
    """Rows can be marked and copied from nowhere: it is a sheet to read."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        self.table = TextTable(selectable=False, compact=True)
        column.addWidget(self.table)

    def show_result(self, result: CalibrationResult) -> None:
        """All quantities, in annex C's order."""
        columns = (
            Column(self.tr("Quantity"), stretch=True),
            Column(self.tr("Symbol")),
            Column(self.tr("Value"), right=True),
            Column("U", right=True),
            Column(self.tr("Unit")),
            Column(self.tr("Value"), right=True),
            Column("U", right=True),
            Column(self.tr("Unit")),
            Column("k", right=True),
        )
        found = quantities(result)
        self.table.set_content(columns, [self._cells(quantity) for quantity in found], [q.key for q in found])

    def _cells(self, quantity: Quantity) -> tuple[Cell, ...]:
        cells = [Cell(self._name(quantity)), Cell(f"{quantity.symbol}{quantity.index}", "muted")]
        for unit in _two_units(quantity):
            if unit is None:
                cells += [Cell(""), Cell(""), Cell("")]
                continue
            shown = show(quantity, unit)
            cells += [Cell(shown.value, strong=True), Cell(shown.expanded), Cell(shown.unit, "muted")]
        return (*cells, Cell(number(quantity.uncertainty.coverage_factor, 2), "muted"))

    def _name(self, quantity: Quantity) -> str:
        axis = quantity.axis.upper()
        if quantity.group == "scale_factor":
            return self.tr("Scale factor of axis {axis}").format(axis=axis)
        if quantity.group == "zero_offset":
            return self.tr("Zero offset of axis {axis} ({angle})").format(
                axis=axis, angle=axis_names()[quantity.axis]
            )
        return self.tr("Misalignment of axis {turned} to axis {output}").format(
            turned=axis, output=quantity.index[0].upper()
        )


def _two_units(quantity: Quantity) -> tuple[Unit | None, Unit | None]:
    known = {unit.key: unit for unit in units(quantity)}
    first, second = _COLUMN_UNITS[quantity.group]
    if first not in known:
        return (next(iter(known.values())), None)
    return (known[first], known[second])
