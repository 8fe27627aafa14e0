"""Names on the left, values on the right, one pair a line."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QWidget

from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets.labels import ElidedLabel, Label, Tone


class KeyValueTable(QWidget):
    """Rows have keys, so that names can be set for another language and values while things change.

    ``numbers`` aligns the values right; else they stand left beside their names and are shortened where
    needed.
    """

    def __init__(self, keys: Sequence[str], *, numbers: bool = True, row_gap: int = GAP) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(CARD_MARGIN)
        grid.setVerticalSpacing(row_gap)
        self._names: dict[str, Label] = {}
        self._values: dict[str, Label] = {}
        for row, key in enumerate(keys):
            name = Label(tone="muted")
            value = Label("–") if numbers else ElidedLabel("–")
            if numbers:
                value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            grid.addWidget(name, row, 0)
            grid.addWidget(value, row, 1)
            self._names[key] = name
            self._values[key] = value
        grid.setColumnStretch(1, 1)

    def set_name(self, key: str, text: str) -> None:
        """What stands on the left."""
        self._names[key].setText(text)

    def set_value(self, key: str, text: str, tone: Tone = "text") -> None:
        """What stands on the right."""
        self._values[key].setText(text)
        self._values[key].set_tone(tone)

    def value(self, key: str) -> str:
        """The value as it stands there."""
        return self._values[key].text()

    def set_row_visible(self, key: str, visible: bool) -> None:
        """Hide what does not apply."""
        self._names[key].setVisible(visible)
        self._values[key].setVisible(visible)
