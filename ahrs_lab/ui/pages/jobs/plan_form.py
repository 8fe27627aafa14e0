"""The plan: the settings people change as fields, the rest as TOML; refusals stand at their field."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import QPlainTextEdit, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.jobs.plan_model import (
    ENTRIES,
    MOUNTING_ORDERS,
    ORDERS,
    POWERS,
    SCHEDULES,
    EntryName,
    PlanView,
    entries_of,
    plan_of_text,
    text_of_plan,
    view,
)
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField, grid
from ahrs_lab.ui.theme import GAP, TEXT_PX
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Label, LinkButton

_CHOICES = {"order": ORDERS, "schedule": SCHEDULES, "mounting_order": MOUNTING_ORDERS, "power": POWERS}


class PlanForm(Translated):
    """``edited`` follows every change; :meth:`view` says what it makes."""

    edited = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._presets: Mapping[str, str] = {}
        self._base = Plan()
        self._limits: TableLimits | None = None
        self._text_error = ""
        self.preset = ChoiceField()
        self.fields: dict[EntryName, TextField | ChoiceField] = {
            name: ChoiceField() if name in _CHOICES else TextField() for name in ENTRIES
        }
        self._heads = [Label(role="strong") for _ in range(4)]
        self._stack = QStackedWidget()
        self._stack.addWidget(self._make_form())
        self.text = QPlainTextEdit()
        mono = QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont)
        mono.setPixelSize(TEXT_PX)
        self.text.setFont(mono)
        self.text.setTabChangesFocus(True)
        self._stack.addWidget(self.text)
        self._refusal = Banner("bad")
        self._refusal.setVisible(False)
        self.switch = LinkButton()
        self.switch.clicked.connect(self._toggle_text)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        column.setSpacing(GAP)
        column.addWidget(self._refusal)
        column.addWidget(self._stack, 1)
        column.addWidget(self.switch)
        for field in self.fields.values():
            field.edited.connect(self._form_edited)
        self.preset.edited.connect(self._take_preset)
        self.text.textChanged.connect(self._text_edited)
        self.retranslate()
        self._show_plan()

    def _make_form(self) -> QWidget:
        form = QWidget()
        column = QVBoxLayout(form)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GAP)
        f = self.fields
        parts = (
            grid((self.preset, f["mounting_order"], f["power"], f["warm_up"])),
            grid((f["rates"],), (f["order"], f["dwell"], f["static"])),
            grid((f["schedule"], f["duration"], f["repeats"], f["positions"])),
            grid((f["turn_rate"], f["turns"])),
        )
        for head, part in zip(self._heads, parts, strict=True):
            column.addWidget(head)
            column.addLayout(part)
            column.addSpacing(GAP)
        column.addStretch(1)
        return form

    def set_presets(self, presets: Mapping[str, str]) -> None:
        """Plans that come along, name → TOML."""
        self._presets = presets
        self._fill_presets()

    def set_limits(self, limits: TableLimits | None) -> None:
        """What the job's table can do."""
        self._limits = limits
        self._judge()

    def set_text(self, text: str) -> None:
        """Show the plan of a job; a text that is no plan opens as text with its fault."""
        try:
            self._base = plan_of_text(text) if text.strip() else Plan()
        except InputError as error:
            self.text.blockSignals(True)
            self.text.setPlainText(text)
            self.text.blockSignals(False)
            self._text_error = said(error.message)
            self._stack.setCurrentIndex(1)
        else:
            self._text_error = ""
            self._stack.setCurrentIndex(0)
            self._show_plan()
        self._name_switch()
        self._judge()

    def plan_text(self) -> str:
        """TOML of what stands here; what cannot be read stays as it is typed."""
        if self._stack.currentIndex() == 1:
            return self.text.toPlainText()
        made = self.view().plan
        return text_of_plan(made if made is not None else self._base)

    def view(self) -> PlanView:
        """What the entries make of the plan underneath."""
        if self._text_error:
            return PlanView(None, {}, {}, None, ())
        return view(self._entries(), self._base, self._limits)

    def set_editable(self, editable: bool) -> None:
        """A measured job keeps its plan."""
        for field in (*self.fields.values(), self.preset):
            field.editor.setEnabled(editable)
        self.text.setReadOnly(not editable)

    # ----------------------------------------------------------------------------------------------------

    def _entries(self) -> dict[EntryName, str]:
        return {
            name: field.key() if isinstance(field, ChoiceField) else field.text()
            for name, field in self.fields.items()
        }

    def _show_plan(self) -> None:
        for name, text in entries_of(self._base).items():
            field = self.fields[name]
            if isinstance(field, ChoiceField):
                field.set_key(text)
            else:
                field.set_text(text)
        self._enable()

    def _enable(self) -> None:
        multi = self.fields["schedule"]
        assert isinstance(multi, ChoiceField)
        self.fields["positions"].setVisible(multi.key() == "multi-position")

    def _form_edited(self) -> None:
        self._enable()
        self._judge()
        self.edited.emit()

    def _take_preset(self) -> None:
        self.set_text(self._presets.get(self.preset.key(), ""))
        self.edited.emit()

    def _text_edited(self) -> None:
        try:
            self._base = plan_of_text(self.text.toPlainText())
            self._text_error = ""
        except InputError as error:
            self._text_error = said(error.message)
        else:
            self._show_plan()
        self._judge()
        self.edited.emit()

    def _toggle_text(self) -> None:
        if self._stack.currentIndex() == 0:
            made = self.view().plan
            self.text.blockSignals(True)
            self.text.setPlainText(text_of_plan(made if made is not None else self._base))
            self.text.blockSignals(False)
            self._stack.setCurrentIndex(1)
        elif not self._text_error:
            self._show_plan()
            self._stack.setCurrentIndex(0)
        self._name_switch()
        self._judge()

    def _name_switch(self) -> None:
        as_text = self._stack.currentIndex() == 1
        self.switch.setText(
            self.tr("Back to the form") if as_text else self.tr("All settings as text (TOML)")
        )

    def _judge(self) -> None:
        found = self.view()
        faults = {
            "number": self.tr("Enter a number."),
            "whole": self.tr("Enter a whole number."),
            "list": self.tr("Enter rates separated by commas."),
        }
        for name, field in self.fields.items():
            fault = found.faults.get(name)
            refusal = found.refusals.get(name)
            field.set_error(faults[fault] if fault else said(refusal) if refusal else "")
        text = self._text_error or (said(found.refusal) if found.refusal else "")
        if self._stack.currentIndex() == 1 and not text and found.refusals:
            text = said(next(iter(found.refusals.values())))
        self._refusal.set_content("bad", "", text)
        self._refusal.setVisible(bool(text))

    def _fill_presets(self) -> None:
        names = {
            "standard": self.tr("Standard"),
            "accelerated": self.tr("Accelerated (demonstration)"),
            "combined": self.tr("Combined zero offset"),
        }
        own = ("", self.tr("choose a preset …"))
        self.preset.set_choices([own, *((key, names.get(key, key)) for key in self._presets)])

    def retranslate(self) -> None:
        heads = (
            self.tr("Plan and mounting"),
            self.tr("Scale factor (7.1)"),
            self.tr("Zero offset (7.2)"),
            self.tr("Misalignment (7.3)"),
        )
        for head, text in zip(self._heads, heads, strict=True):
            head.setText(text)
        self._fill_presets()
        self._name_choices()
        self.preset.set_name(self.tr("Take over a preset"))
        self.fields["mounting_order"].set_name(self.tr("Order of mountings"))
        self.fields["power"].set_name(self.tr("Power while re-mounting"))
        self.fields["warm_up"].set_name(self.tr("Warm-up, s"))
        self.fields["rates"].set_name(self.tr("Rates, °/s"))
        self.fields["order"].set_name(self.tr("Order of rates"))
        self.fields["dwell"].set_name(self.tr("Dwell at each rate, s"))
        self.fields["static"].set_name(self.tr("Rest before and after, s"))
        self.fields["schedule"].set_name(self.tr("Schedule"))
        self.fields["duration"].set_name(self.tr("T of each position, s"))
        self.fields["positions"].set_name(self.tr("Positions"))
        self.fields["repeats"].set_name(self.tr("Repeats"))
        self.fields["turn_rate"].set_name(self.tr("Rate, °/s"))
        self.fields["turns"].set_name(self.tr("Whole turns each way"))
        self._name_switch()
        self._judge()

    def _name_choices(self) -> None:
        texts = {
            "pairs": self.tr("± pairs"),
            "ascending": self.tr("ascending"),
            "as_listed": self.tr("as listed"),
            "combined": self.tr("combined: 4 positions"),
            "multi-position": self.tr("multi-position"),
            "shortest": self.tr("fewest mountings"),
            "off": self.tr("off"),
            "on": self.tr("stays on"),
        }
        standard = {
            "schedule": self.tr("standard: 12 positions"),
            "mounting_order": self.tr("as in the standard"),
        }
        for name, field in self.fields.items():
            if isinstance(field, ChoiceField):
                field.set_choices(
                    [(key, standard[name] if key == "standard" else texts[key]) for key in _CHOICES[name]]
                )
