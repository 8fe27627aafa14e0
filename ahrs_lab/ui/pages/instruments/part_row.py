"""One instrument in the list: who it is, how it is connected, and what can be done about that."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from ahrs_lab.instruments.registry import Kind
from ahrs_lab.laboratory.instrument_station import StationView
from ahrs_lab.ui import icons
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.instruments.words import ICONS, part_names, state_words
from ahrs_lab.ui.theme import CARD_MARGIN, GAP, STEP, tokens
from ahrs_lab.ui.widgets import ElidedLabel, IconButton, Label, SecondaryButton, StateDot, repolish

_ICON = 22


class PartRow(Translated):
    """``chosen``, ``toggled`` (connect or disconnect) and ``edit`` tell what the person wants."""

    chosen = Signal(str)
    toggled = Signal(str)
    edit = Signal(str)

    def __init__(self, part: Kind) -> None:
        super().__init__()
        self.part: Kind = part
        self._driver = ""
        self._place = ""
        self._view: StationView | None = None
        self._usable = True
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        self._frame = QFrame()
        self._frame.setProperty("panel", "plain")
        outer.addWidget(self._frame)
        column = QVBoxLayout(self._frame)
        column.setContentsMargins(CARD_MARGIN, GAP, GAP, GAP)
        column.setSpacing(STEP)
        head = QHBoxLayout()
        head.setSpacing(GAP)
        self._icon = QLabel()
        self._name = Label(role="strong")
        self._state = StateDot()
        self.settings = IconButton("edit")
        self.settings.clicked.connect(lambda: self.edit.emit(self.part))
        head.addWidget(self._icon)
        head.addWidget(self._name)
        head.addStretch(1)
        head.addWidget(self._state)
        head.addWidget(self.settings)
        foot = QHBoxLayout()
        foot.setSpacing(GAP)
        words = QVBoxLayout()
        words.setSpacing(0)
        self._title = ElidedLabel()
        self._where = ElidedLabel(tone="muted")
        words.addWidget(self._title)
        words.addWidget(self._where)
        self.action = SecondaryButton()
        self.action.clicked.connect(self._pressed)
        foot.addLayout(words, 1)
        foot.addWidget(self.action, 0, Qt.AlignmentFlag.AlignBottom)
        column.addLayout(head)
        column.addLayout(foot)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.retranslate()

    @property
    def there(self) -> bool:
        """The bench has such an instrument."""
        return bool(self._driver)

    def set_instrument(self, driver: str, place: str) -> None:
        """Its driver's title and where it is; "" where the bench has none."""
        self._driver, self._place = driver, place
        self.retranslate()

    def set_view(self, view: StationView | None, usable: bool) -> None:
        """What is known of it now; ``usable``: it may be connected."""
        self._view, self._usable = view, usable
        self.retranslate()

    def set_chosen(self, chosen: bool) -> None:
        """It is shown at the right."""
        kind = "accent" if chosen else "plain"
        if self._frame.property("panel") != kind:
            self._frame.setProperty("panel", kind)
            repolish(self._frame)

    def state_text(self) -> str:
        """As it stands there."""
        return self._state.text()

    def _pressed(self) -> None:
        self.chosen.emit(self.part)
        (self.toggled if self.there else self.edit).emit(self.part)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.chosen.emit(self.part)
        super().mousePressEvent(event)

    def retranslate(self) -> None:
        name = part_names()[self.part]
        self._name.setText(name)
        self._icon.setPixmap(icons.pixmap(ICONS[self.part], tokens().muted, _ICON, self.devicePixelRatioF()))
        state = self._view.state if self._view is not None else "off"
        on = self._view is not None and (self._view.connected or state == "connecting")
        self._state.setVisible(self.there)
        self._state.set_state(*state_words()[state])
        self.settings.setVisible(self.there)
        self.settings.setEnabled(state == "off" or (state == "failed" and not on))
        self.settings.set_hint(self.tr("Settings of this instrument"))
        identity = self._view.identity if self._view is not None else ""
        self._title.setText(identity or self._driver or self.tr("none yet"))
        self._where.setText(self._place)
        self._where.setVisible(bool(self._place))
        if not self.there:
            self.action.setText(self.tr("Add …"))
        else:
            self.action.setText(self.tr("Disconnect") if on else self.tr("Connect"))
        self.action.setEnabled(self._usable or not self.there)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.PaletteChange:
            self.retranslate()
        super().changeEvent(event)
