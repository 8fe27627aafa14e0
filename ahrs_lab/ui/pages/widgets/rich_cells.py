"""Cells of a table whose powers of ten are raised and whose indices are lowered."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QPainter
from PySide6.QtWidgets import QApplication, QStyle, QStyledItemDelegate, QStyleOptionViewItem

from ahrs_lab.ui.theme import font
from ahrs_lab.ui.widgets import rich_text

_CELL_PX = 11


class RichCells(QStyledItemDelegate):
    """Draws what stands in ``^{…}`` and ``_{…}`` small; other cells as ever."""

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        text = str(index.data(Qt.ItemDataRole.DisplayRole))
        if not rich_text.is_marked(text):
            super().paint(painter, option, index)
            return
        empty = QStyleOptionViewItem(option)
        self.initStyleOption(empty, index)
        empty.text = ""
        QApplication.style().drawControl(QStyle.ControlElement.CE_ItemViewItem, empty, painter)
        painter.save()
        colour, of_cell = index.data(Qt.ItemDataRole.ForegroundRole), index.data(Qt.ItemDataRole.FontRole)
        painter.setPen(colour if isinstance(colour, QColor) else option.palette.text().color())
        align = Qt.AlignmentFlag(index.data(Qt.ItemDataRole.TextAlignmentRole))
        area = QRectF(option.rect).adjusted(_CELL_PX, 0, -_CELL_PX, 0)
        rich_text.draw(painter, area, align, text, of_cell if isinstance(of_cell, QFont) else font())
        painter.restore()
