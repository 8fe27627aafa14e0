"""The list of analyses: name, and below it what each needs."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QEnterEvent, QFontMetrics, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QSizePolicy, QVBoxLayout

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.analysis.setting_values import titled
from ahrs_lab.ui.pages.words import listed
from ahrs_lab.ui.theme import RADIUS, STEP, font, tokens
from ahrs_lab.ui.translation import said

_PADDING = 10
_LINE_PX = 18
_MARK_PX = 3


class KindRow(QAbstractButton):
    """One analysis; checked while it is in front. Its name may take two lines."""

    def __init__(self) -> None:
        super().__init__()
        self._needs = ""
        self.setCheckable(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFont(font())

    def set_words(self, name: str, needs: str) -> None:
        """In the language that is on."""
        self.setText(name)
        self._needs = needs
        self.setToolTip(needs)
        self.updateGeometry()
        self.update()

    def needs(self) -> str:
        """What stands below the name."""
        return self._needs

    def _name_lines(self) -> int:
        room = max(1, self.width() - 2 * _PADDING)
        flags = int(Qt.TextFlag.TextWordWrap)
        high = QFontMetrics(font("strong")).boundingRect(0, 0, room, 1000, flags, self.text()).height()
        return max(1, round(high / QFontMetrics(font("strong")).lineSpacing()))

    def sizeHint(self) -> QSize:
        return QSize(160, (self._name_lines() + 1) * _LINE_PX + 2 * STEP + 4)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.updateGeometry()

    def enterEvent(self, event: QEnterEvent) -> None:
        super().enterEvent(event)
        self.update()

    def leaveEvent(self, event: QEvent) -> None:
        super().leaveEvent(event)
        self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        look = tokens()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        on = self.isChecked()
        if on or self.underMouse() or self.hasFocus():
            painter.setPen(QPen(look.colour("accent"), 1) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent_soft" if on else "hover"))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), RADIUS, RADIUS)
        room = self.width() - 2 * _PADDING
        lines = self._name_lines()
        painter.setPen(look.colour("accent" if on else "text"))
        painter.setFont(font("strong" if on else "text"))
        name = QRectF(_PADDING, STEP + 2, room, lines * _LINE_PX)
        flags = Qt.TextFlag.TextWordWrap | Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(name, int(flags), self.text())
        painter.setPen(look.colour("muted"))
        painter.setFont(font())
        shown = painter.fontMetrics().elidedText(self._needs, Qt.TextElideMode.ElideRight, room)
        needs = QRectF(_PADDING, name.bottom(), room, _LINE_PX)
        painter.drawText(needs, int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter), shown)


class KindList(Translated):
    """``chosen`` tells the key of the analysis that is wanted."""

    chosen = Signal(str)

    def __init__(self, kinds: Sequence[AnalysisKind]) -> None:
        super().__init__()
        self._kinds = tuple(kinds)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        self._group = QButtonGroup(self)
        self.rows: dict[str, KindRow] = {}
        for kind in kinds:
            row = KindRow()
            row.clicked.connect(lambda _on=False, key=kind.key: self.chosen.emit(key))
            self._group.addButton(row)
            self.rows[kind.key] = row
            column.addWidget(row)
        column.addStretch(1)
        self.retranslate()

    def set_current(self, key: str) -> None:
        """The analysis that is in front."""
        self.rows[key].setChecked(True)

    def retranslate(self) -> None:
        for kind in self._kinds:
            inputs = listed(said(label) for label in kind.inputs)
            self.rows[kind.key].set_words(said(kind.name), titled(inputs) or self.tr("No recording"))
