"""A card of one group of quantities: its lines, and the switch of their unit."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from ahrs_lab.metrology.conformity import Conformity
from ahrs_lab.ui.pages.results.limit_drawing import word_width
from ahrs_lab.ui.pages.results.quantities import Group, Quantity, Unit, show, units
from ahrs_lab.ui.pages.results.quantity_row import QuantityRow, RowTexts
from ahrs_lab.ui.pages.words import axis_names, short_verdict_names, verdict_names
from ahrs_lab.ui.widgets import Card, Label, SegmentedSwitch

_ARROW = "→"


class ValueCard(Card):
    """``chosen`` tells the key of the line that was pressed, ``unit_changed`` that the unit was switched."""

    chosen = Signal(str)
    unit_changed = Signal()

    def __init__(self, group: Group) -> None:
        super().__init__()
        self.group: Group = group
        self._switch: QWidget | None = None
        self._units: tuple[Unit, ...] = ()
        self._unit_key = ""
        self._quantities: tuple[Quantity, ...] = ()
        self._conformity: Conformity | None = None
        self.rows: dict[str, QuantityRow] = {}
        self._nothing = Label(tone="faint", wrap=True)
        self.add(self._nothing)
        self.body.setSpacing(2)

    def set_words(self, title: str, nothing: str) -> None:
        """Also of the lines, which name axes."""
        self.set_title(title)
        self._nothing.setText(nothing)
        self._fill()

    def set_quantities(self, quantities: Sequence[Quantity], conformity: Conformity | None = None) -> None:
        """The group's, in annex C's order, and what is said of their limits."""
        self._quantities = tuple(quantities)
        self._conformity = conformity
        for row in self.rows.values():
            row.hide()
            row.deleteLater()
        self.rows = {}
        large = self.group != "misalignment"
        for quantity in self._quantities:
            row = QuantityRow(quantity.axis, large=large)
            row.clicked.connect(lambda _on=False, key=quantity.key: self.chosen.emit(key))
            self.rows[quantity.key] = row
            self.add(row)
        self._nothing.setVisible(not self._quantities)
        self._set_units(units(self._quantities[0]) if self._quantities else ())
        self._fill()

    def unit(self) -> Unit | None:
        """The unit that is on."""
        return next((unit for unit in self._units if unit.key == self._unit_key), None)

    def switch_unit(self, key: str) -> None:
        """As pressing the switch does."""
        self._unit_key = key
        if isinstance(self._switch, SegmentedSwitch):
            self._switch.set_current(key)
        self._fill()
        self.unit_changed.emit()

    def prefer_unit(self, key: str) -> None:
        """The unit to begin with; one that the card does not have changes nothing."""
        if key in [unit.key for unit in self._units]:
            self.switch_unit(key)

    def mark(self, key: str) -> None:
        """Show which line is the chosen one of the page."""
        for known, row in self.rows.items():
            row.setChecked(known == key)

    def _set_units(self, found: tuple[Unit, ...]) -> None:
        if found == self._units:
            return
        self._units = found
        if self._unit_key not in [unit.key for unit in found]:
            self._unit_key = found[0].key if found else ""
        if self._switch is not None:
            self._switch.hide()
            self._switch.deleteLater()
            self._switch = None
        if len(found) > 1:
            switch = SegmentedSwitch([(unit.key, unit.label) for unit in found], self._unit_key)
            switch.changed.connect(self.switch_unit)
            self._switch = switch
            self.add_tool(switch)
        elif found:
            self._switch = Label(found[0].label, tone="muted")
            self.add_tool(self._switch)

    def _fill(self) -> None:
        unit = self.unit()
        if unit is None:
            return
        names = short_verdict_names() if self.group == "misalignment" else verdict_names()
        for quantity in self._quantities:
            row = self.rows[quantity.key]
            row.set_texts(self._texts(quantity, unit))
            said = self._conformity.of(quantity.key.replace(".", "_")) if self._conformity else None
            row.set_judgement(said, names[said.verdict] if said else "")
        rows = self.rows.values()
        tail = max((row.tail_width() for row in rows), default=0.0)
        lead = max((row.lead_width() for row in rows), default=0.0)
        words = [row.verdict_word() for row in rows if row.verdict_word()]
        widest = max((word_width(word) for word in words), default=0.0)
        for row in rows:
            row.set_widths(tail, lead, widest)

    @staticmethod
    def _texts(quantity: Quantity, unit: Unit) -> RowTexts:
        shown = show(quantity, unit)
        name = axis_names()[quantity.axis] if quantity.group == "zero_offset" else ""
        if quantity.group == "misalignment":
            output, turned = quantity.index[0], quantity.index[1]
            name = f"{turned.upper()}{_ARROW}{output.upper()}"
        return RowTexts(quantity.symbol, quantity.index, name, shown.value, shown.expanded)
