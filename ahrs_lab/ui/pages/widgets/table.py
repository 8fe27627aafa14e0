"""Tables of texts: columns measured from what is in them, numbers right, one column takes what is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from ahrs_lab.ui.pages.widgets.rich_cells import RichCells
from ahrs_lab.ui.theme import font, tokens
from ahrs_lab.ui.widgets import rich_text

_Index = QModelIndex | QPersistentModelIndex
_ROW_PX = 32
_COMPACT_PX = 27
_PADDING_PX = 26
_CELL_PX = 24
"""What a cell keeps free beside its text."""


@dataclass(frozen=True)
class Cell:
    """A text, ``^{…}`` in it raised and ``_{…}`` lowered, with its tone (a colour name of the theme) and
    weight; ``sort`` orders better than the text and is what a delegate draws; ``edit`` is what an editor
    begins with, None: it cannot be edited."""

    text: str
    tone: str = "text"
    strong: bool = False
    sort: str | float | None = None
    edit: str | None = None


@dataclass(frozen=True)
class Column:
    """A heading of one or several lines; ``right`` for numbers, ``stretch`` takes what is left, ``least`` is
    its smallest width in pixels."""

    heading: str
    right: bool = False
    stretch: bool = False
    least: int = 0


class _Model(QAbstractTableModel):
    edited = Signal(str, str)

    def __init__(self) -> None:
        super().__init__()
        self.columns: tuple[Column, ...] = ()
        self.rows: list[tuple[Cell, ...]] = []
        self.keys: list[str] = []

    def rowCount(self, parent: _Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.rows)

    def columnCount(self, parent: _Index | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self.columns)

    def data(self, index: _Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        cell = self.rows[index.row()][index.column()]
        if role == Qt.ItemDataRole.DisplayRole:
            return cell.text
        if role in (Qt.ItemDataRole.ToolTipRole, Qt.ItemDataRole.AccessibleTextRole):
            return rich_text.plain(cell.text)
        if role == Qt.ItemDataRole.EditRole:
            return cell.edit
        if role == Qt.ItemDataRole.UserRole:
            return cell.sort
        if role == Qt.ItemDataRole.ForegroundRole:
            return QColor(getattr(tokens(), cell.tone))
        if role == Qt.ItemDataRole.FontRole:
            return font("strong") if cell.strong else None
        if role == Qt.ItemDataRole.TextAlignmentRole:
            side = (
                Qt.AlignmentFlag.AlignRight
                if self.columns[index.column()].right
                else Qt.AlignmentFlag.AlignLeft
            )
            return side | Qt.AlignmentFlag.AlignVCenter
        return None

    def flags(self, index: _Index) -> Qt.ItemFlag:
        flags = super().flags(index)
        editable = index.isValid() and self.rows[index.row()][index.column()].edit is not None
        return flags | Qt.ItemFlag.ItemIsEditable if editable else flags

    def setData(self, index: _Index, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Tells what was typed; whoever listens describes the table again."""
        if role != Qt.ItemDataRole.EditRole or str(value) == self.data(index, role):
            return False
        self.edited.emit(self.keys[index.row()], str(value))
        return True

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> object:
        if orientation != Qt.Orientation.Horizontal or section >= len(self.columns):
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return self.columns[section].heading
        if role == Qt.ItemDataRole.TextAlignmentRole:
            side = Qt.AlignmentFlag.AlignRight if self.columns[section].right else Qt.AlignmentFlag.AlignLeft
            return side | Qt.AlignmentFlag.AlignVCenter
        return None

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self.layoutAboutToBeChanged.emit()
        pairs = list(zip(self.rows, self.keys, strict=True))
        pairs.sort(key=lambda pair: _sort_key(pair[0][column]), reverse=order == Qt.SortOrder.DescendingOrder)
        self.rows = [row for row, _ in pairs]
        self.keys = [key for _, key in pairs]
        self.layoutChanged.emit()

    def replace(self, columns: tuple[Column, ...], rows: list[tuple[Cell, ...]], keys: list[str]) -> None:
        self.beginResetModel()
        self.columns, self.rows, self.keys = columns, rows, keys
        self.endResetModel()


def _sort_key(cell: Cell) -> tuple[int, float, str]:
    if isinstance(cell.sort, (int, float)):
        return (0, float(cell.sort), "")
    return (1, 0.0, cell.sort if cell.sort is not None else cell.text)


class TextTable(QTableView):
    """Rows have keys. ``opened`` tells the key by double click or Enter, ``chosen`` by moving; ``edited`` the
    key and what was typed into its editable cell. ``two_lines``: the column that takes what is left breaks
    its texts, and such rows are higher."""

    opened = Signal(str)
    chosen = Signal(str)
    edited = Signal(str, str)

    def __init__(
        self,
        *,
        selectable: bool = True,
        sortable: bool = False,
        compact: bool = False,
        two_lines: bool = False,
    ) -> None:
        super().__init__()
        self._model = _Model()
        self._model.setParent(self)
        self._selectable = selectable
        self._sortable = sortable
        self.setModel(self._model)
        self.setItemDelegate(RichCells(self))
        self.setShowGrid(False)
        self.setWordWrap(two_lines)
        self._two_lines = two_lines
        self.verticalHeader().setVisible(False)
        self.verticalHeader().setDefaultSectionSize(_COMPACT_PX if compact else _ROW_PX)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(
            QAbstractItemView.SelectionMode.SingleSelection
            if selectable
            else QAbstractItemView.SelectionMode.NoSelection
        )
        self.setTabKeyNavigation(False)
        if not selectable:
            self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        # A cell's text stands three pixels further in than the style sheet's padding; so does its heading.
        header.setStyleSheet("QHeaderView::section { padding: 6px 11px; }")
        header.setSectionsClickable(sortable)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        # Queued: the table is described again only when the editor has gone.
        self._model.edited.connect(self.edited, Qt.ConnectionType.QueuedConnection)
        self.doubleClicked.connect(lambda index: self.opened.emit(self._model.keys[index.row()]))
        self.selectionModel().currentRowChanged.connect(self._moved)

    def set_content(
        self, columns: Sequence[Column], rows: Sequence[Sequence[Cell]], keys: Sequence[str] = ()
    ) -> None:
        """Replace all; the chosen row stays chosen where its key is still there."""
        kept = self.current_key()
        self._model.replace(
            tuple(columns), [tuple(row) for row in rows], list(keys) or [str(i) for i in range(len(rows))]
        )
        self._measure()
        self.setSortingEnabled(False)
        if self._sortable:
            header = self.horizontalHeader()
            header.setSortIndicatorShown(True)
            header.setSectionsClickable(True)
        if kept:
            self.choose(kept)

    def sort_by(self, column: int, order: Qt.SortOrder) -> None:
        """Order the rows now and let the person order them otherwise."""
        self.horizontalHeader().setSortIndicator(column, order)
        self.setSortingEnabled(True)

    def current_key(self) -> str:
        """Of the chosen row, "" where none is."""
        row = self.currentIndex().row()
        return self._model.keys[row] if 0 <= row < len(self._model.keys) else ""

    def choose(self, key: str) -> None:
        """Choose a row by its key."""
        if key in self._model.keys:
            self.selectRow(self._model.keys.index(key))

    def edit_key(self, key: str) -> None:
        """Open the editor of the row's editable cell, where there is one and none is open."""
        if self.state() == QAbstractItemView.State.EditingState:
            return  # Return that ends an editor comes here too
        row = self._model.keys.index(key)
        for column, cell in enumerate(self._model.rows[row]):
            if cell.edit is not None:
                self.setCurrentIndex(self._model.index(row, column))
                self.edit(self._model.index(row, column))
                return

    def keys(self) -> list[str]:
        """In the order shown."""
        return list(self._model.keys)

    def texts(self, row: int) -> list[str]:
        """The texts of a row as they stand there."""
        return [cell.text for cell in self._model.rows[row]]

    def _measure(self) -> None:
        header = self.horizontalHeader()
        plain = self.fontMetrics()
        for number, column in enumerate(self._model.columns):
            if column.stretch:
                header.setSectionResizeMode(number, QHeaderView.ResizeMode.Stretch)
                continue
            widths = [plain.horizontalAdvance(line) for line in column.heading.split("\n")]
            for row in self._model.rows:
                cell = row[number]
                widths.append(ceil(rich_text.width(cell.text, font("strong" if cell.strong else "text"))))
            header.setSectionResizeMode(number, QHeaderView.ResizeMode.Interactive)
            width = max(widths) + _PADDING_PX + (12 if self._sortable else 0)
            self.setColumnWidth(number, max(width, column.least))
        self._fit_rows()

    def _fit_rows(self) -> None:
        """Higher rows where a text does not stand in one line of the column that takes what is left."""
        header = self.verticalHeader()
        stretched = [place for place, column in enumerate(self._model.columns) if column.stretch]
        if not self._two_lines or not stretched:
            return
        (place,) = stretched
        metrics = self.fontMetrics()
        room = self.columnWidth(place) - _CELL_PX
        for row, cells in enumerate(self._model.rows):
            long = metrics.horizontalAdvance(cells[place].text) > room
            header.resizeSection(row, header.defaultSectionSize() + (metrics.lineSpacing() if long else 0))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_rows()

    def _moved(self, current: QModelIndex, _previous: QModelIndex) -> None:
        if current.isValid():
            self.chosen.emit(self._model.keys[current.row()])

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.current_key():
            self.opened.emit(self.current_key())
            return
        if event.key() == Qt.Key.Key_F2 and self.current_key():
            self.edit_key(self.current_key())
            return
        super().keyPressEvent(event)
