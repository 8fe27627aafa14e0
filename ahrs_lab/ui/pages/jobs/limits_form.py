"""What the customer asks: limits, the rule by which they are judged, and the units of the certificate."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conformity import RULES, DecisionRule, RuleKind
from ahrs_lab.metrology.limits import LIMITED, Limit
from ahrs_lab.metrology.requirements import (
    MISALIGNMENT_UNITS,
    SCALE_FACTOR_UNITS,
    ZERO_OFFSET_UNITS,
    Requirements,
    ResultUnits,
    requirements_from_json,
    requirements_to_json,
)
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.jobs.limit_line import LimitLine
from ahrs_lab.ui.pages.jobs.limits_model import LimitTexts, number_of, text_of_number, texts_of, usual_unit
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField, TickField, grid
from ahrs_lab.ui.pages.words import rule_names
from ahrs_lab.ui.theme import GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Label, LinkButton

_UNIT_LABELS = {"deg/s": "°/s", "deg/h": "°/h", "arcmin": "′", "arcsec": "″", "deg": "°", "rad": "rad"}


class LimitsForm(Translated):
    """``edited`` follows every change by the person."""

    edited = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[LimitLine] = []
        self._kept = ""
        self._editable = True
        self.rule, self.r, self.probability = ChoiceField(), TextField(), TickField()
        self.repeatability = TickField()
        self.scale_factor, self.zero_offset, self.misalignment = ChoiceField(), ChoiceField(), ChoiceField()
        self._heads = [Label(role="strong") for _ in range(3)]
        self._hint = Label(tone="muted", wrap=True)
        self._rows = QWidget()
        self._grid = QGridLayout(self._rows)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(GAP)
        self._grid.setVerticalSpacing(4)
        self.add_button = LinkButton(icon="add")
        self.add_button.clicked.connect(self._add)
        self._refusal = Banner("bad")
        self._lay_out()
        for field in (
            self.rule,
            self.r,
            self.probability,
            self.repeatability,
            self.scale_factor,
            self.zero_offset,
            self.misalignment,
        ):
            field.edited.connect(self._changed)
        self.retranslate()
        self._look()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        column.setSpacing(6)
        column.addWidget(self._heads[0])
        column.addWidget(self._hint)
        column.addWidget(self._rows)
        foot = QHBoxLayout()
        foot.addWidget(self.add_button)
        foot.addStretch(1)
        column.addLayout(foot)
        column.addWidget(self._refusal)
        column.addSpacing(GAP)
        column.addWidget(self._heads[1])
        column.addLayout(grid((self.rule, None, self.r)))
        column.addWidget(self.probability)
        column.addWidget(self.repeatability)
        column.addSpacing(GAP)
        column.addWidget(self._heads[2])
        column.addLayout(grid((self.scale_factor, self.zero_offset, self.misalignment)))
        column.addStretch(1)
        column.setAlignment(Qt.AlignmentFlag.AlignTop)

    # content --------------------------------------------------------------------------------------------

    def set_text(self, text: str) -> None:
        """Show a job's requirements; a text that cannot be read is said and kept until something is typed."""
        self._kept = ""
        unreadable: Message | None = None
        try:
            asked = requirements_from_json(text)
        except AhrsLabError as error:
            asked, self._kept, unreadable = Requirements(), text, error.message
        self._set_lines([texts_of(limit) for limit in asked.limits])
        self.rule.set_key(asked.rule.kind)
        self.r.set_text(text_of_number(asked.rule.r))
        self.probability.setChecked(asked.rule.probability)
        self.repeatability.setChecked(asked.repeatability)
        self.scale_factor.set_key(asked.units.scale_factor)
        self.zero_offset.set_key(asked.units.zero_offset)
        self.misalignment.set_key(asked.units.misalignment)
        self._look(unreadable)

    def text(self) -> str:
        """What the records keep; where :meth:`refusal` says something, it is not to be stored."""
        if self._kept:
            return self._kept
        found = self._requirements()
        return "" if isinstance(found, Message) else requirements_to_json(found)

    def refusal(self) -> Message | None:
        """What is wrong with what stands here."""
        found = self._requirements()
        return found if isinstance(found, Message) else None

    def set_editable(self, editable: bool) -> None:
        """A signed job only shows."""
        self._editable = editable
        for field in (self.rule, self.r, self.scale_factor, self.zero_offset, self.misalignment):
            field.editor.setEnabled(editable)
        for tick in (self.probability, self.repeatability):
            tick.setEnabled(editable)
        self.add_button.setVisible(editable)
        for line in self.lines:
            line.set_editable(editable)
        self._look()

    def _requirements(self) -> Requirements | Message:
        limits: list[Limit] = []
        for line in self.lines:
            found = line.limit()
            if isinstance(found, Message):
                return found
            limits.append(found)
        kind: RuleKind = next((rule for rule in RULES if rule == self.rule.key()), "simple")
        try:
            r = 1.0 if kind == "simple" else number_of(self.r.text())
            rule = DecisionRule(kind, r, self.probability.isChecked())
            return Requirements(tuple(limits), rule, self._units(), self.repeatability.isChecked())
        except AhrsLabError as error:
            return error.message

    def _units(self) -> ResultUnits:
        return ResultUnits(
            next((one for one in SCALE_FACTOR_UNITS if one == self.scale_factor.key()), ""),
            next((one for one in ZERO_OFFSET_UNITS if one == self.zero_offset.key()), ""),
            next((one for one in MISALIGNMENT_UNITS if one == self.misalignment.key()), ""),
        )

    # lines ----------------------------------------------------------------------------------------------

    def _add(self) -> None:
        taken = {line.texts().quantity for line in self.lines}
        quantity = next((key for key in ("K", "B", "L", *LIMITED) if key not in taken), "K")
        texts = LimitTexts(quantity, unit=usual_unit(quantity), nominal="1" if quantity[0] == "K" else "")
        self._set_lines([*(line.texts() for line in self.lines), texts])
        self.lines[-1].low.line.setFocus()
        self._changed()

    def _remove(self, line: LimitLine) -> None:
        self._set_lines([one.texts() for one in self.lines if one is not line])
        self._changed()

    def _set_lines(self, texts: list[LimitTexts]) -> None:
        for line in self.lines:
            line.discard()
        self.lines = []
        for number, one in enumerate(texts):
            line = LimitLine(one)
            line.place(self._grid, number)
            line.set_editable(self._editable)
            line.edited.connect(self._changed)
            line.removed.connect(lambda line=line: self._remove(line))
            self.lines.append(line)
        self._rows.setVisible(bool(self.lines))

    def _changed(self) -> None:
        self._kept = ""
        self._look()
        self.edited.emit()

    def _look(self, unreadable: Message | None = None) -> None:
        wrong = unreadable or self.refusal()
        self._refusal.set_content("bad", "", said(wrong) if wrong else "")
        self._refusal.setVisible(wrong is not None)
        self.r.editor.setEnabled(self._editable and self.rule.key() != "simple")

    def retranslate(self) -> None:
        heads = (self.tr("Limits"), self.tr("Decision rule"), self.tr("Units on the certificate"))
        for head, text in zip(self._heads, heads, strict=True):
            head.setText(text)
        self._hint.setText(
            self.tr(
                "Without limits there is no statement of conformity. A limit of one axis goes before that of "
                "its group; a bound that is left empty is open."
            )
        )
        self.add_button.setText(self.tr("Add a limit"))
        self.rule.set_name(self.tr("Rule (ILAC-G8)"))
        self.rule.set_choices(list(rule_names().items()))
        self.r.set_name(self.tr("r, multiple of U"))
        self.probability.setText(self.tr("State the conformance probability"))
        self.repeatability.setText(self.tr("U of the zero offset includes its repeatability (another day)"))
        usual = ("", self.tr("all the usual ones"))
        self.scale_factor.set_name(self.tr("Scale factor"))
        self.scale_factor.set_choices([("", self.tr("as delivered")), ("ppm", self.tr("also ppm from 1"))])
        self.zero_offset.set_name(self.tr("Zero offset"))
        self.zero_offset.set_choices([usual, *((key, _UNIT_LABELS[key]) for key in ZERO_OFFSET_UNITS if key)])
        self.misalignment.set_name(self.tr("Misalignment"))
        self.misalignment.set_choices(
            [usual, *((key, _UNIT_LABELS[key]) for key in MISALIGNMENT_UNITS if key)]
        )
        for line in self.lines:
            line.retranslate()
        self._look()
