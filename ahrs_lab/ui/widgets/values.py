"""Measured values: the number in front, its unit in a lighter tone behind."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.ui.formatting import DASH
from ahrs_lab.ui.theme import NUMBER_PX, STEP, FontRole
from ahrs_lab.ui.widgets.labels import Label, Tone


class ValueLabel(QWidget):
    """``12.00 V``: right-aligned, digits of equal width."""

    def __init__(self, unit: str = "", *, role: FontRole = "text", tone: Tone = "text") -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(STEP)
        self._value = Label(DASH, role=role, tone=tone)
        self._unit = Label(unit, tone="muted")
        row.addStretch(1)
        row.addWidget(self._value, 0, Qt.AlignmentFlag.AlignBaseline)
        row.addWidget(self._unit, 0, Qt.AlignmentFlag.AlignBaseline)
        self._unit.setVisible(bool(unit))

    def set_value(self, value: str, unit: str | None = None) -> None:
        """A text made by :mod:`ahrs_lab.ui.formatting`; ``unit`` only where it changes."""
        self._value.setText(value)
        if unit is not None:
            self._unit.setText(unit)
            self._unit.setVisible(bool(unit))

    def set_tone(self, tone: Tone) -> None:
        """The number's tone."""
        self._value.set_tone(tone)

    def value(self) -> str:
        """The number as it stands there."""
        return self._value.text()


class BigNumber(QWidget):
    """A caption, and under it the number in the largest size."""

    def __init__(self, caption: str = "", unit: str = "", tone: Tone = "text") -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self._caption = Label(caption, tone="muted")
        self._value = ValueLabel(unit, role="number", tone=tone)
        # The font's own line is half as high again as its digits.
        self._value.setFixedHeight(round(1.2 * NUMBER_PX))
        column.addWidget(self._caption)
        column.addWidget(self._value)

    def set_caption(self, caption: str) -> None:
        """What the number is."""
        self._caption.setText(caption)

    def set_value(self, value: str, unit: str | None = None) -> None:
        """See :meth:`ValueLabel.set_value`."""
        self._value.set_value(value, unit)

    def set_tone(self, tone: Tone) -> None:
        """The number's tone."""
        self._value.set_tone(tone)

    def value(self) -> str:
        """The number as it stands there."""
        return self._value.value()
