"""Fields of a form: the name above, the editor, and below it what is wrong with it or what it means."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QDate, QPointF, Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import (
    QComboBox,
    QDateEdit,
    QGridLayout,
    QLineEdit,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, tokens
from ahrs_lab.ui.widgets import Label, repolish


def _draw_chevron(widget: QWidget) -> None:
    """The arrow that the style sheet takes away."""
    painter = QPainter(widget)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    pen = QPen(tokens().colour("muted" if widget.isEnabled() else "line"), 1.6)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    painter.setPen(pen)
    x, y = widget.width() - 16.0, widget.height() / 2 - 1.5
    painter.drawPolyline(QPolygonF([QPointF(x - 4, y), QPointF(x, y + 4), QPointF(x + 4, y)]))


class _Combo(QComboBox):
    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        _draw_chevron(self)


class _DateEdit(QDateEdit):
    def __init__(self, day: QDate) -> None:
        super().__init__(day)
        self.setStyleSheet(
            "QDateEdit::drop-down { border: none; width: 24px; } QDateEdit::down-arrow { width: 0; }"
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        _draw_chevron(self)


class Field(QWidget):
    """Name, editor, message. ``edited`` tells every change by the person."""

    edited = Signal()

    def __init__(self, editor: QWidget) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        self.editor = editor
        self._name = Label(tone="muted")
        self._name.setBuddy(editor)
        self._message = Label(tone="faint", wrap=True)
        self._message.setVisible(False)
        column.addWidget(self._name)
        column.addWidget(editor)
        column.addWidget(self._message)
        self._hint = ""
        self._error = ""
        self._bare = False

    def set_bare(self) -> None:
        """The editor alone, for a row whose headings say the names; what is wrong is its tip."""
        self._bare = True
        self._name.setVisible(False)

    def set_name(self, text: str, hint: str = "") -> None:
        """What is to be entered; ``hint`` stands below as long as nothing is wrong."""
        self._name.setText(text)
        self.editor.setAccessibleName(text)
        self._hint = hint
        self._show_message()

    def show_name(self, shown: bool) -> None:
        """Whether the name stands above the editor; a column of fields needs it once."""
        self._name.setVisible(shown)

    def set_error(self, text: str) -> None:
        """What is wrong, in red below; empty when all is well."""
        self._error = text
        self.editor.setProperty("invalid", "true" if text else "false")
        repolish(self.editor)
        self._show_message()

    def error(self) -> str:
        """What is said to be wrong."""
        return self._error

    def _show_message(self) -> None:
        text = self._error or self._hint
        if self._bare:
            self.editor.setToolTip(text)
            return
        self._message.setText(text)
        self._message.set_tone("bad" if self._error else "faint")
        self._message.setVisible(bool(text))


class TextField(Field):
    """One line of text."""

    def __init__(self, *, secret: bool = False) -> None:
        self.line = QLineEdit()
        if secret:
            self.line.setEchoMode(QLineEdit.EchoMode.Password)
        super().__init__(self.line)
        self.line.textEdited.connect(lambda _text: self.edited.emit())

    def text(self) -> str:
        """Without spaces at the ends."""
        return (
            self.line.text()
            if self.line.echoMode() != QLineEdit.EchoMode.Normal
            else self.line.text().strip()
        )

    def set_text(self, text: str) -> None:
        """Does not tell ``edited``; keeps the cursor where nothing changed."""
        if text != self.line.text():
            self.line.setText(text)
            self.line.setCursorPosition(0)


class ChoiceField(Field):
    """One of a few; each choice has a key and a text."""

    def __init__(self, *, editable: bool = False) -> None:
        self.combo = _Combo()
        self.combo.setEditable(editable)
        self.combo.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.combo.setMinimumContentsLength(8)
        super().__init__(self.combo)
        self.combo.activated.connect(lambda _index: self.edited.emit())

    def set_choices(self, choices: Sequence[tuple[str, str]]) -> None:
        """Keys and texts; the key that was on stays on where it is still there."""
        kept = self.key()
        self.combo.blockSignals(True)
        self.combo.clear()
        for key, text in choices:
            self.combo.addItem(text, key)
        self.combo.blockSignals(False)
        self.set_key(kept)

    def key(self) -> str:
        """The chosen key, "" where there is none."""
        data = self.combo.currentData()
        return data if isinstance(data, str) else ""

    def set_key(self, key: str) -> None:
        """Choose without telling ``edited``."""
        index = self.combo.findData(key)
        self.combo.setCurrentIndex(index if index >= 0 or self.combo.count() == 0 else 0)


class DateField(Field):
    """A calendar date."""

    def __init__(self) -> None:
        self.date_edit = _DateEdit(QDate.currentDate())
        self.date_edit.setCalendarPopup(True)
        self.date_edit.setDisplayFormat("yyyy-MM-dd")
        super().__init__(self.date_edit)
        self.date_edit.userDateChanged.connect(lambda _date: self.edited.emit())


class TickField(TickBox):
    """Yes or no."""

    edited = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.clicked.connect(lambda _on: self.edited.emit())


def grid(*rows: Sequence[QWidget | None]) -> QGridLayout:
    """Fields in rows of equal columns; None after a field lets it span."""
    layout = QGridLayout()
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setHorizontalSpacing(CARD_MARGIN)
    layout.setVerticalSpacing(GAP)
    columns = max(len(row) for row in rows)
    for number, row in enumerate(rows):
        for column, widget in enumerate(row):
            if widget is None:
                continue
            span = 1
            while column + span < len(row) and row[column + span] is None:
                span += 1
            if len(row) < columns and column + span == len(row):
                span += columns - len(row)
            layout.addWidget(widget, number, column, 1, span, Qt.AlignmentFlag.AlignTop)
    for column in range(columns):
        layout.setColumnStretch(column, 1)
    return layout
