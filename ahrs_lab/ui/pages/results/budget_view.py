"""The tab Uncertainty budget: every source of the chosen quantity's uncertainty, in the unit that is on."""

from __future__ import annotations

import math

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QStyledItemDelegate, QStyleOptionViewItem, QVBoxLayout

from ahrs_lab.metrology.result import BudgetRow
from ahrs_lab.metrology.uncertainty.budget import shares
from ahrs_lab.ui.formatting import MINUS, number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit, show
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.theme import GAP, tokens
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import ElidedLabel

_SHARE_COLUMN = 8


class BudgetView(Translated):
    """Follows the quantity that is chosen on the page."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(GAP)
        self._sum = ElidedLabel(role="strong")
        self.table = TextTable(selectable=False, compact=True)
        self.table.setItemDelegateForColumn(_SHARE_COLUMN, _ShareDelegate(self.table))
        column.addWidget(self._sum)
        column.addWidget(self.table, 1)

    def show_quantity(self, quantity: Quantity, unit: Unit, reported: Quantity | None = None) -> None:
        """The budget of ``quantity``; contributions in ``unit``. ``reported``: the same with its U raised to
        the laboratory's capability."""
        uncertainty = quantity.uncertainty
        label = "" if unit.label == "1" else unit.label
        shown = show(quantity, unit)
        method = self.tr("annex A") if uncertainty.method == "annex-a" else self.tr("GUM")
        self._sum.setText(
            f"{quantity.symbol}{quantity.index} = {shown.value} ± {shown.expanded} {label}".rstrip()
            + f"   u = {significant(uncertainty.standard * abs(unit.factor))} {label}".rstrip()
            + f"   k = {number(uncertainty.coverage_factor, 2)}   {method}"
            + (self._raised(reported, unit) if reported is not None else "")
        )
        columns = (
            Column(self.tr("Source"), stretch=True),
            Column(self.tr("Type")),
            Column(self.tr("Distribution")),
            Column("u(x)", right=True),
            Column(self.tr("Unit")),
            Column(self.tr("Contribution") + (f", {label}" if label else ""), right=True),
            Column("ν", right=True),
            Column(self.tr("From")),
            Column(self.tr("Share of the variance"), right=True),
        )
        pairs = sorted(zip(uncertainty.rows, shares(uncertainty), strict=True), key=lambda pair: -pair[1])
        self.table.set_content(columns, [self._cells(row, share, unit) for row, share in pairs])

    def _raised(self, reported: Quantity, unit: Unit) -> str:
        shown = show(reported, unit)
        return "   " + self.tr("reported: U = {expanded} (CMC)").format(expanded=shown.expanded)

    def _cells(self, row: BudgetRow, share: float, unit: Unit) -> tuple[Cell, ...]:
        distributions = {
            "normal": self.tr("normal"),
            "rectangular": self.tr("rectangular"),
            "triangular": self.tr("triangular"),
            "arcsine": self.tr("arcsine"),
            "t": self.tr("Student's t"),
        }
        origins = {
            "data": self.tr("the recording"),
            "certificate": self.tr("certificate {number}").format(number=row.certificate)
            if row.certificate
            else self.tr("a certificate"),
            "assumption": self.tr("an assumption"),
        }
        return (
            Cell(said(row.source)),
            Cell(row.kind),
            Cell(distributions[row.distribution]),
            Cell(significant(row.standard_uncertainty)),
            Cell(row.unit.replace("deg", "°").replace("arcsec", "″"), "muted"),
            Cell(significant(row.contribution * abs(unit.factor)), strong=True),
            Cell("∞" if math.isinf(row.dof) or row.dof > 9999 else number(row.dof, 0)),
            Cell(origins[row.origin], "warn" if row.origin == "assumption" else "text"),
            Cell(f"{number(100.0 * share, 1)} %", sort=share),
        )

    def retranslate(self) -> None:
        """The page shows the quantity again."""


def significant(value: float) -> str:
    """Three significant digits; with a power of ten where there are too many zeros."""
    if value == 0.0:
        return "0"
    if not math.isfinite(value):
        return "∞"
    power = math.floor(math.log10(abs(value)))
    if -4 <= power < 6:
        return number(value, max(0, 2 - power))
    digits = number(value / 10.0**power, 2)
    return f"{digits}E{MINUS if power < 0 else ''}{abs(power)}"


class _ShareDelegate(QStyledItemDelegate):
    """A bar with its per cent."""

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        text = str(index.data(Qt.ItemDataRole.DisplayRole))
        share = (
            float(text.split("\u00a0", maxsplit=1)[0].split(" ", maxsplit=1)[0].replace("\u2009", "")) / 100.0
        )
        look = tokens()
        place = QRectF(option.rect)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        bar = QRectF(place.left() + 8, place.center().y() - 2, max(0.0, place.width() - 74), 4)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("line"))
        painter.drawRoundedRect(bar, 2, 2)
        painter.setBrush(look.colour("accent"))
        if share > 0.0:
            painter.drawRoundedRect(QRectF(bar.left(), bar.top(), max(4.0, bar.width() * share), 4), 2, 2)
        painter.setPen(look.colour("text"))
        painter.setFont(option.font)
        painter.drawText(
            place.adjusted(0, 0, -8, 0),
            int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter),
            text,
        )
        painter.restore()
