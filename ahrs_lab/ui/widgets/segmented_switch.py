"""A switch with a few choices side by side, one of them on: units, languages, tabs of a card."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QWidget

from ahrs_lab.ui.widgets.buttons import QuietButton


class SegmentedSwitch(QWidget):
    """Choices are (key, text); ``changed`` tells the key. Texts may be set again for another language."""

    changed = Signal(str)

    def __init__(self, choices: Sequence[tuple[str, str]], current: str = "") -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self._group = QButtonGroup(self)
        self._buttons: dict[str, QuietButton] = {}
        for key, text in choices:
            button = QuietButton(text)
            button.setCheckable(True)
            button.setChecked(key == current)
            button.clicked.connect(lambda _checked=False, key=key: self.changed.emit(key))
            self._group.addButton(button)
            self._buttons[key] = button
            row.addWidget(button)

    def set_texts(self, texts: Sequence[tuple[str, str]]) -> None:
        """The same keys in other words."""
        for key, text in texts:
            self._buttons[key].setText(text)

    def set_current(self, key: str) -> None:
        """Switch without telling."""
        self._buttons[key].setChecked(True)

    def button(self, key: str) -> QuietButton:
        """The button of one choice."""
        return self._buttons[key]

    def current(self) -> str:
        """The key that is on, "" where none is."""
        return next((key for key, button in self._buttons.items() if button.isChecked()), "")
