"""One field a setting of an analysis: number, choice, flag, text or file. Each gives its value, or says below
what is wrong with it."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QVBoxLayout, QWidget

from ahrs_lab.laboratory.analyses.kinds import Setting, Value
from ahrs_lab.ui.pages.analysis.setting_values import fault_of_number, number_text, titled, typed_number
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.theme import GAP, STEP, tokens
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import IconButton, Label, repolish

_NUMBER_PX = 132
_UNIT_GAP_PX = 9


class SettingField(QWidget):
    """``edited`` tells every change by the person, ``submitted`` that Return was pressed. Subclasses fill the
    column above the message."""

    edited = Signal()
    submitted = Signal()

    def __init__(self, setting: Setting) -> None:
        super().__init__()
        self.setting = setting
        self._error = ""
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(2)
        self._message = Label(tone="faint", wrap=True)

    def read(self) -> Value | None:
        """The value; None where there is none, which is said below."""
        raise NotImplementedError

    def put(self, value: Value) -> None:
        """Show this value; does not tell ``edited``."""
        raise NotImplementedError

    def error(self) -> str:
        """What is said to be wrong."""
        return self._error

    def set_error(self, text: str) -> None:
        """What is wrong, in red below; empty when all is well."""
        self._error = text
        text = text or (said(self.setting.hint) if self.setting.hint is not None else "")
        self._message.setText(text)
        self._message.set_tone("bad" if self._error else "faint")
        self._message.setVisible(bool(text))

    def retranslate(self) -> None:
        """Name and hint in the language that is on."""
        self.set_error(self._error)


class _UnitLine(QLineEdit):
    """The unit stands at the right in a lighter tone; the number right-aligned before it."""

    def __init__(self, unit: str) -> None:
        super().__init__()
        self._unit = unit
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        if unit:
            room = self.fontMetrics().horizontalAdvance(unit) + _UNIT_GAP_PX - STEP
            self.setTextMargins(0, 0, room, 0)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._unit:
            painter = QPainter(self)
            painter.setPen(tokens().colour("muted"))
            area = self.rect().adjusted(0, 0, -_UNIT_GAP_PX, 0)
            painter.drawText(
                area, int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), self._unit
            )


class NumberSetting(SettingField):
    """Name at the left, number and unit at the right."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.line = _UnitLine(setting.unit)
        self.line.setFixedWidth(_NUMBER_PX)
        self.line.textEdited.connect(self._typed)
        self.line.returnPressed.connect(self.submitted)
        self._name = Label(wrap=True)
        self._name.setBuddy(self.line)
        row = QHBoxLayout()
        row.setSpacing(GAP)
        row.addWidget(self._name, 1)
        row.addWidget(self.line, 0, Qt.AlignmentFlag.AlignTop)
        self.column.addLayout(row)
        self.column.addWidget(self._message)
        self.put(setting.default)

    def _typed(self) -> None:
        self.read()
        self.edited.emit()

    def read(self) -> float | None:
        if self.setting.blank is not None and not self.line.text().strip():
            self.set_error("")
            return self.setting.blank
        value = typed_number(self.line.text())
        self.set_error(fault_of_number(self.setting, value))
        return None if self.error() else value

    def put(self, value: Value) -> None:
        self.line.setText("" if value == self.setting.blank else number_text(float(value)))
        self.set_error("")

    def set_error(self, text: str) -> None:
        if bool(text) != bool(self._error):
            self.line.setProperty("invalid", "true" if text else "false")
            repolish(self.line)
        super().set_error(text)

    def retranslate(self) -> None:
        self._name.setText(titled(said(self.setting.label)))
        self.line.setAccessibleName(said(self.setting.label))
        if self.error():
            self.read()
        else:
            super().retranslate()


class ChoiceSetting(SettingField):
    """Name above, choices below."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self._name = Label(tone="muted", wrap=True)
        self.column.addWidget(self._name)
        self.field = ChoiceField()
        self.field.show_name(False)
        self.field.edited.connect(self.edited)
        self.column.addWidget(self.field)
        self.column.addWidget(self._message)
        self._fill()
        self.put(setting.default)

    def _fill(self) -> None:
        self._name.setText(titled(said(self.setting.label)))
        self.field.set_name(titled(said(self.setting.label)))
        self.field.set_choices([(key, titled(said(text))) for key, text in self.setting.choices])

    def read(self) -> str:
        return self.field.key()

    def put(self, value: Value) -> None:
        self.field.set_key(str(value))

    def retranslate(self) -> None:
        self._fill()
        super().retranslate()


class _Caption(Label):
    """Words that belong to a box beside them."""

    pressed = Signal()

    def mousePressEvent(self, _event: QMouseEvent) -> None:
        self.pressed.emit()


class FlagSetting(SettingField):
    """A box to tick, and its words, which may take several lines."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.box = TickBox()
        self.box.clicked.connect(lambda _on: self.edited.emit())
        self._name = _Caption(wrap=True)
        self._name.pressed.connect(self.box.click)
        row = QHBoxLayout()
        row.setSpacing(GAP)
        row.addWidget(self.box, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self._name, 1)
        self.column.addLayout(row)
        self.column.addWidget(self._message)
        self.put(setting.default)

    def read(self) -> bool:
        return self.box.isChecked()

    def put(self, value: Value) -> None:
        self.box.setChecked(bool(value))

    def retranslate(self) -> None:
        self._name.setText(titled(said(self.setting.label)))
        self.box.setAccessibleName(titled(said(self.setting.label)))
        super().retranslate()


class TextSetting(SettingField):
    """Free text; as a file, with a button that looks for one."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self._name = Label(tone="muted", wrap=True)
        self.column.addWidget(self._name)
        self.field = TextField()
        self.field.show_name(False)
        self.field.edited.connect(self.edited)
        self.field.line.returnPressed.connect(self.submitted)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        row.addWidget(self.field, 1)
        self.seek: IconButton | None = None
        if setting.kind == "file":
            self.seek = IconButton("folder")
            self.seek.clicked.connect(self._look)
            row.addWidget(self.seek, 0, Qt.AlignmentFlag.AlignTop)
        self.column.addLayout(row)
        self.column.addWidget(self._message)
        self.put(setting.default)

    def _look(self) -> None:
        start = self.field.text() or str(Path.home())
        path, _ = QFileDialog.getOpenFileName(self, said(self.setting.label), start)
        if path:
            self.put(path)
            self.edited.emit()

    def read(self) -> str:
        return self.field.text()

    def put(self, value: Value) -> None:
        self.field.set_text(str(value))

    def retranslate(self) -> None:
        self._name.setText(titled(said(self.setting.label)))
        self.field.set_name(said(self.setting.label))
        if self.seek is not None:
            self.seek.set_hint(self.tr("Choose a file"))
        super().retranslate()


def field_of(setting: Setting) -> SettingField:
    """The field for this kind of setting."""
    match setting.kind:
        case "number":
            return NumberSetting(setting)
        case "choice":
            return ChoiceSetting(setting)
        case "flag":
            return FlagSetting(setting)
        case "text" | "file":
            return TextSetting(setting)
