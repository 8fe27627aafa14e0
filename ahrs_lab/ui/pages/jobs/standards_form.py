"""Which measurement standards the job uses; one whose certificate has run out says so in red and in words."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import date

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.records.rows import StandardRow
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.jobs.checks import overdue
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.pages.widgets.tick_box import TickBox
from ahrs_lab.ui.pages.words import standard_kinds
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import ElidedLabel, Label, Line, LinkButton


class StandardsForm(Translated):
    """``edited`` follows the ticks; ``edit_standards`` asks for the page where standards are kept."""

    edited = Signal()
    edit_standards = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._standards: tuple[StandardRow, ...] = ()
        self._boxes: dict[int, TickBox] = {}
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._hint = Label(tone="muted", wrap=True)
        column.addWidget(self._hint)
        self._rows = QWidget()
        self._grid = QGridLayout(self._rows)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(CARD_MARGIN)
        self._grid.setVerticalSpacing(GAP)
        self._grid.setColumnStretch(1, 1)
        column.addWidget(self._rows)
        foot = QHBoxLayout()
        self._edit = LinkButton(icon="standard")
        self._edit.clicked.connect(self.edit_standards)
        foot.addWidget(self._edit)
        foot.addStretch(1)
        column.addLayout(foot)
        column.addStretch(1)
        self.retranslate()

    def set_standards(self, standards: Sequence[StandardRow], chosen: Collection[int]) -> None:
        """All there are, and the ones this job uses."""
        self._standards = tuple(standards)
        self._fill(set(chosen))

    def chosen(self) -> tuple[int, ...]:
        """Ids of the ticked ones, in their order."""
        return tuple(key for key, box in self._boxes.items() if box.isChecked())

    def set_editable(self, editable: bool) -> None:
        """A signed job only shows."""
        for box in self._boxes.values():
            box.setEnabled(editable)

    def _fill(self, chosen: set[int]) -> None:
        while self._grid.count():
            item = self._grid.takeAt(0)
            widget = item.widget() if item is not None else None
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        self._boxes = {}
        today = date.today()  # noqa: DTZ011  due dates are the laboratory's own
        for number, row in enumerate(self._standards):
            self._add_row(3 * number, row, row.id in chosen, today)

    def _add_row(self, line: int, row: StandardRow, ticked: bool, today: date) -> None:
        chinese = language() == "zh"
        box = TickBox()
        box.setChecked(ticked)
        box.clicked.connect(lambda _on: self.edited.emit())
        name = row.name_zh if chinese and row.name_zh else row.name
        box.setAccessibleName(name)
        self._boxes[row.id] = box
        self._grid.addWidget(box, line, 0, 2, 1, Qt.AlignmentFlag.AlignVCenter)
        self._grid.addWidget(ElidedLabel(name, role="strong"), line, 1)
        facts = [standard_kinds().get(row.kind, row.kind), row.model, row.serial_number]
        self._grid.addWidget(
            ElidedLabel(" · ".join(fact for fact in facts if fact), tone="muted"), line + 1, 1
        )
        certificate = Label(row.certificate_number or self.tr("no certificate"), tone="muted")
        self._grid.addWidget(certificate, line, 2, 2, 1, Qt.AlignmentFlag.AlignVCenter)
        chip = Chip()
        if row.due is None:
            chip.set_content("warn", "warn", self.tr("no due date"))
        elif overdue(row, today):
            chip.set_content("bad", "bad", self.tr("expired {date}").format(date=row.due.isoformat()))
        else:
            chip.set_content("good", "good", self.tr("valid until {date}").format(date=row.due.isoformat()))
        self._grid.addWidget(chip, line, 3, 2, 1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._grid.addWidget(Line(), line + 2, 0, 1, 4)

    def retranslate(self) -> None:
        self._hint.setText(
            self.tr(
                "Clause 6 asks for a table, a supply and a fixture, "
                "each with a certificate that has not run out."
            )
        )
        self._edit.setText(self.tr("Edit the laboratory's standards"))
        self._fill(set(self.chosen()))
