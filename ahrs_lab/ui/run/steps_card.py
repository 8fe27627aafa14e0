"""The list of steps: mountings, and under the open ones their steps, each with its mark and its time."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetrics, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QScrollArea, QSizePolicy, QWidget

from ahrs_lab.ui.formatting import duration
from ahrs_lab.ui.run import words
from ahrs_lab.ui.run.model import RunModel, StepGroup, StepLine
from ahrs_lab.ui.run.step_mark import StepMark
from ahrs_lab.ui.theme import RADIUS, font, tokens
from ahrs_lab.ui.widgets import Card, Label, ProgressBar
from ahrs_lab.ui.widgets.state_dot import paint_step

_ROW_PX = 28
_INDENT_PX = 18


class StepsCard(Card):
    """Follows the run; the step that is going on is kept in sight."""

    def __init__(self) -> None:
        super().__init__()
        self._percent = Label(tone="muted")
        self.add_tool(self._percent)
        self._bar = ProgressBar()
        self.add(self._bar)
        self.list = StepsList()
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setObjectName("scrolled")
        self._area.setWidget(self.list)
        self.add(self._area, 1)
        self._shown = -1
        self.retranslate()

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        self._bar.set_value(model.progress)
        self._percent.setText(f"{100.0 * model.progress:.0f} %" if model.groups else "")
        self.list.refresh(model)
        row = self.list.active_row()
        if row >= 0 and row != self._shown:
            # Only when it moves on, so that a person may scroll meanwhile.
            self._area.ensureVisible(0, row * _ROW_PX + _ROW_PX // 2, 0, 3 * _ROW_PX)
        self._shown = row

    def retranslate(self) -> None:
        """Set every text."""
        self.set_title(self.tr("Steps"))
        self.list.retranslate()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class StepsList(QWidget):
    """Paints the rows. Mountings that are done or still to come are folded; a click unfolds."""

    def __init__(self) -> None:
        super().__init__()
        self._model = RunModel()
        self._toggled: dict[int, bool] = {}
        self._rows: list[tuple[int, StepLine | None]] = []
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFont(font())

    def refresh(self, model: RunModel) -> None:
        """Look at the model."""
        if model is not self._model:
            self._model = model
            self._toggled.clear()
        self._lay_rows()

    def retranslate(self) -> None:
        """Row texts are made while painting."""
        self.setAccessibleName(self.tr("Steps"))
        self.update()

    def _lay_rows(self) -> None:
        rows: list[tuple[int, StepLine | None]] = []
        for number, group in enumerate(self._model.groups):
            rows.append((number, None))
            if self._open(number, group):
                rows += [(number, line) for line in group.lines]
        if len(rows) != len(self._rows):
            self._rows = rows
            self.setFixedHeight(max(1, len(rows) * _ROW_PX))
        self._rows = rows
        self.update()

    def _open(self, number: int, group: StepGroup) -> bool:
        return self._toggled.get(number, group.mark in ("active", "failed") or len(self._model.groups) == 1)

    def active_row(self) -> int:
        """The row of the step that is going on, −1 where none is."""
        return next((row for row, (_, line) in enumerate(self._rows) if line and line.mark == "active"), -1)

    def row_texts(self) -> list[str]:
        """What stands in the rows."""
        return [
            words.step(line.step) if line else words.face(self._model.groups[number].mounting)
            for number, line in self._rows
        ]

    def sizeHint(self) -> QSize:
        return QSize(200, len(self._rows) * _ROW_PX)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        row = int(event.position().y()) // _ROW_PX
        if 0 <= row < len(self._rows) and self._rows[row][1] is None:
            number = self._rows[row][0]
            self._toggled[number] = not self._open(number, self._model.groups[number])
            self._lay_rows()

    def paintEvent(self, _event: QPaintEvent) -> None:
        painter = QPainter(self)
        for row, (number, line) in enumerate(self._rows):
            self._paint_row(painter, row * _ROW_PX, number, line)

    def _paint_row(self, painter: QPainter, top: int, number: int, line: StepLine | None) -> None:
        look, group = tokens(), self._model.groups[number]
        mark: StepMark = line.mark if line else group.mark
        left = _INDENT_PX if line else 0
        if line is not None and mark == "active":
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent_soft"))
            painter.drawRoundedRect(
                QRectF(left - 8, top + 1, self.width() - left + 8, _ROW_PX - 2), RADIUS, RADIUS
            )
        paint_step(painter, mark, QPointF(left + 8, top + _ROW_PX / 2))
        strong = line is None or mark == "active"
        painter.setFont(font("strong" if strong else "text"))
        quiet = mark in ("pending", "skipped")
        painter.setPen(look.colour("muted" if quiet else "text"))
        time = (
            ""
            if line is not None and line.shown_s <= 0
            else duration(line.shown_s if line else group.shown_s, short=True)
        )
        time_width = QFontMetrics(font()).horizontalAdvance(time) + 8
        text_rect = QRectF(left + 24, top, self.width() - left - 24 - time_width, _ROW_PX)
        text = words.step(line.step) if line else words.face(group.mounting)
        metrics = QFontMetrics(painter.font())
        painter.drawText(
            text_rect,
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft,
            metrics.elidedText(text, Qt.TextElideMode.ElideRight, int(text_rect.width())),
        )
        painter.setFont(font())
        painter.setPen(look.colour("muted"))
        painter.drawText(
            QRectF(self.width() - time_width, top, time_width - 4, _ROW_PX),
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight,
            time,
        )
