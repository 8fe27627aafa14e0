"""One limit in the form: quantity, bounds, unit, nominal value, and the button that takes it away."""

from __future__ import annotations

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from ahrs_lab.messages import Message
from ahrs_lab.metrology.limits import LIMIT_UNITS, LIMITED, Limit
from ahrs_lab.ui.pages.jobs.limits_model import LimitTexts, limit_of_texts, usual_unit
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField
from ahrs_lab.ui.widgets import IconButton

_STRETCH = (5, 4, 4, 4, 4)


class LimitLine(QObject):
    """Its fields stand in the form's grid, so that the columns of all lines are the same."""

    edited = Signal()
    removed = Signal()

    def __init__(self, texts: LimitTexts) -> None:
        super().__init__()
        self.quantity, self.unit = ChoiceField(), ChoiceField()
        self.low, self.high, self.nominal = TextField(), TextField(), TextField()
        self.remove = IconButton("remove")
        self.retranslate()
        self.quantity.set_key(texts.quantity)
        self._fill_units()
        self.unit.set_key(texts.unit)
        for field, text in ((self.low, texts.low), (self.high, texts.high), (self.nominal, texts.nominal)):
            field.set_text(text)
        self.quantity.edited.connect(self._quantity_chosen)
        for edited in (self.low, self.high, self.unit, self.nominal):
            edited.edited.connect(self._changed)
        self.remove.clicked.connect(self.removed)
        self._editable = True

    def place(self, layout: QGridLayout, row: int) -> None:
        """Into a row of the form's grid; the first one has the names above its fields."""
        for column, field in enumerate(self._fields()):
            field.show_name(row == 0)
            layout.addWidget(field, row, column, Qt.AlignmentFlag.AlignTop)
            layout.setColumnStretch(column, _STRETCH[column])
        layout.addWidget(self.remove, row, len(_STRETCH), Qt.AlignmentFlag.AlignBottom)

    def discard(self) -> None:
        """Out of the form."""
        for widget in self._widgets():
            widget.hide()
            widget.deleteLater()
        self.deleteLater()

    def set_editable(self, editable: bool) -> None:
        """A signed job only shows."""
        self._editable = editable
        for field in self._fields():
            field.editor.setEnabled(editable)
        self.remove.setEnabled(editable)
        self._look()

    def texts(self) -> LimitTexts:
        """As they stand in the fields."""
        return LimitTexts(
            self.quantity.key(), self.low.text(), self.high.text(), self.unit.key(), self.nominal.text()
        )

    def limit(self) -> Limit | Message:
        """The limit, or what is wrong with it."""
        return limit_of_texts(self.texts())

    def _fields(self) -> tuple[ChoiceField | TextField, ...]:
        return (self.quantity, self.low, self.high, self.unit, self.nominal)

    def _widgets(self) -> tuple[QWidget, ...]:
        return (*self._fields(), self.remove)

    def _quantity_chosen(self) -> None:
        before = self.unit.key()
        self._fill_units()
        if self.unit.key() != before:
            self.unit.set_key(usual_unit(self.quantity.key()))
        self._changed()

    def _fill_units(self) -> None:
        known = LIMIT_UNITS[self.quantity.key()[0]]
        named = [(key, key if unit.relative else unit.label) for key, unit in known.items()]
        self.unit.set_choices(
            [(key, self.tr("fraction") if key == "fraction" else text) for key, text in named]
        )

    def _changed(self) -> None:
        self._look()
        self.edited.emit()

    def _look(self) -> None:
        self.nominal.editor.setEnabled(self._editable and self.texts().takes_nominal())

    def retranslate(self) -> None:
        """Called by the form."""
        groups = {
            "K": self.tr("K, all axes"),
            "B": self.tr("B, all axes"),
            "L": self.tr("L, all pairs"),
        }
        self.quantity.set_choices([(key, groups.get(key, key.replace("_", ""))) for key in LIMITED])
        self.quantity.set_name(self.tr("Quantity"))
        self.low.set_name(self.tr("Lower limit"))
        self.high.set_name(self.tr("Upper limit"))
        self.unit.set_name(self.tr("Unit"))
        self.nominal.set_name(self.tr("Nominal value"))
        self.remove.set_hint(self.tr("Take this limit away"))
        if self.quantity.key():
            self._fill_units()
