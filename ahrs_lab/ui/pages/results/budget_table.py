"""The table of a budget: every source with the bar of its share, and u(x) that can be asked about."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRect, QRectF, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import (
    QApplication,
    QLineEdit,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)

from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.uncertainty.budget import shares
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.pages.results.quantities import Unit
from ahrs_lab.ui.pages.results.what_if_model import degrees_of_freedom, significant
from ahrs_lab.ui.pages.widgets.rich_cells import RichCells
from ahrs_lab.ui.pages.widgets.table import Cell, Column, TextTable
from ahrs_lab.ui.theme import tokens
from ahrs_lab.ui.translation import said

_SHARE_COLUMN = 6
_NUMBER_PX = 60
_SHARE_PX = 134
_NUMBER_COLUMN = 2
_EDITOR_PX = 96


class BudgetTable(TextTable):
    """Rows are named by their place in the budget, the largest share first. A double click, Enter or F2
    edits u(x)."""

    def __init__(self) -> None:
        super().__init__(compact=True, two_lines=True)
        self.setItemDelegateForColumn(_NUMBER_COLUMN, _NumberDelegate(self))
        self.setItemDelegateForColumn(_SHARE_COLUMN, _ShareDelegate(self))
        self.opened.connect(self.edit_key)

    def show_budget(self, found: Uncertainty, before: Uncertainty, unit: Unit) -> None:
        """``found`` with contributions in ``unit``; rows that differ from ``before`` say what they were."""
        label = "" if unit.label == "1" else f", {unit.label}"
        parts, known = shares(found), shares(before)
        # a row that is asked about stays where it was
        order = sorted(range(len(known)), key=lambda place: -known[place])
        self.set_content(
            (
                Column(self.tr("Source"), stretch=True),
                Column(self.tr("Type, distribution")),
                Column("u(x)", right=True),
                Column(f"|c| u(x){label}", right=True),
                Column("ν", right=True),
                Column(self.tr("From")),
                Column(self.tr("Share of variance"), right=True, least=_SHARE_PX),
            ),
            [self._cells(found.rows[place], before.rows[place], parts[place], unit) for place in order],
            [str(place) for place in order],
        )

    def _cells(self, row: BudgetRow, before: BudgetRow, share: float, unit: Unit) -> tuple[Cell, ...]:
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
            Cell(f"{row.kind}  {distributions[row.distribution]}"),
            _uncertainty(row, before),
            Cell(significant(row.contribution * abs(unit.factor)), strong=True),
            Cell(degrees_of_freedom(row.dof)),
            Cell(origins[row.origin], "warn" if row.origin == "assumption" else "text"),
            Cell(f"{number(100.0 * share, 1)} %", sort=share),
        )


def _uncertainty(row: BudgetRow, before: BudgetRow) -> Cell:
    """With the row's unit; one that was changed says from what."""
    unit = "" if row.unit == "1" else f" {row.unit.replace('deg', '°').replace('arcsec', '″')}"
    edit = f"{row.standard_uncertainty:.6g}"
    text = f"{significant(row.standard_uncertainty)}{unit}"
    if row.standard_uncertainty == before.standard_uncertainty:
        return Cell(text, edit=edit)
    return Cell(f"{significant(before.standard_uncertainty)} → {text}", "accent", strong=True, edit=edit)


class _NumberDelegate(RichCells):
    """A flat field that is wide enough for a number, whatever stood there."""

    def createEditor(
        self, parent: QWidget, _option: QStyleOptionViewItem, _index: QModelIndex | QPersistentModelIndex
    ) -> QWidget:
        editor = QLineEdit(parent)
        editor.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        editor.setStyleSheet("QLineEdit { padding: 0 4px; min-height: 0; border-radius: 2px; }")
        return editor

    def updateEditorGeometry(
        self, editor: QWidget, option: QStyleOptionViewItem, _index: QModelIndex | QPersistentModelIndex
    ) -> None:
        place = QRect(option.rect)
        place.setLeft(min(place.left(), place.right() - _EDITOR_PX))
        editor.setGeometry(place)


class _ShareDelegate(QStyledItemDelegate):
    """A bar with its per cent."""

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        plain = QStyleOptionViewItem(option)
        self.initStyleOption(plain, index)
        plain.text = ""
        QApplication.style().drawControl(QStyle.ControlElement.CE_ItemViewItem, plain, painter)
        share = index.data(Qt.ItemDataRole.UserRole)
        look = tokens()
        place = QRectF(option.rect)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        bar = QRectF(place.left() + 8, place.center().y() - 2, max(0.0, place.width() - _NUMBER_PX - 16), 4)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("line"))
        painter.drawRoundedRect(bar, 2, 2)
        painter.setBrush(look.colour("accent"))
        if share > 0.0:
            width = max(4.0, bar.width() * min(share, 1.0))
            painter.drawRoundedRect(QRectF(bar.left(), bar.top(), width, 4), 2, 2)
        painter.setPen(look.colour("text"))
        painter.setFont(option.font)
        painter.drawText(
            place.adjusted(0, 0, -8, 0),
            int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter),
            str(index.data(Qt.ItemDataRole.DisplayRole)),
        )
        painter.restore()
