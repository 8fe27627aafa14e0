"""Where an uncertainty comes from: sources with their parts of the variance as bars, the largest first."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.widgets import ElidedLabel, Label, ProgressBar

_SMALLEST = 0.0005


class ShareBars(QScrollArea):
    """``show_shares`` takes (source, share 0…1); what is too small to see is added up under ``rest``."""

    def __init__(self) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        inside = QWidget()
        inside.setObjectName("scrolled")
        self._list = QVBoxLayout(inside)
        self._list.setContentsMargins(0, 0, 4, 0)
        self._list.setSpacing(CARD_MARGIN)
        self._list.addStretch(1)
        self.setWidget(inside)

    def show_shares(self, shares: Sequence[tuple[str, float]], rest: str) -> None:
        """Replace all bars."""
        while self._list.count() > 1:
            item = self._list.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        ordered = sorted(shares, key=lambda pair: -pair[1])
        large = [pair for pair in ordered if pair[1] >= _SMALLEST]
        small = sum(share for _, share in ordered if share < _SMALLEST)
        if len(large) < len(ordered):
            large.append((rest, small))
        for place, (source, share) in enumerate(large):
            self._list.insertWidget(place, _Bar(source, share))


class _Bar(QWidget):
    def __init__(self, source: str, share: float) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(3)
        row = QHBoxLayout()
        row.addWidget(ElidedLabel(source), 1)
        row.addWidget(Label(f"{number(100.0 * share, 1)} %", tone="muted"))
        column.addLayout(row)
        bar = ProgressBar()
        bar.set_value(share)
        column.addWidget(bar)
