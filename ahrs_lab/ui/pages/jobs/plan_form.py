"""The plan: the settings people change as fields, the rest as TOML; refusals stand at their field."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

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
    PROCEDURES,
    SCHEDULES,
    SCHEMES,
    EntryName,
    PlanView,
    default_plan,
    entries_of,
    plan_of_text,
    text_of_plan,
    view,
)
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField, grid
from ahrs_lab.ui.theme import GAP, TEXT_PX
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, Label, LinkButton

_CHOICES = {
    "order": ORDERS,
    "schedule": SCHEDULES,
    "mounting_order": MOUNTING_ORDERS,
    "power": POWERS,
    "scheme": SCHEMES,
}


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
        self.procedure = ChoiceField()
        self.fields: dict[EntryName, TextField | ChoiceField] = {
            name: ChoiceField() if name in _CHOICES else TextField() for name in ENTRIES
        }
        self._heads = [Label(role="strong") for _ in range(5)]
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
        self.procedure.edited.connect(self._take_procedure)
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
            grid(
                (self.procedure, None, self.preset, None),
                (f["mounting_order"], f["power"], f["warm_up"], f["repeats"]),
            ),
            grid((f["rates"],), (f["order"], f["dwell"], f["static"])),
            grid((f["schedule"], f["duration"], f["positions"])),
            grid((f["turn_rate"], f["turns"])),
            grid((f["scheme"], f["imu_dwell"], f["imu_turns"], f["imu_rate"]), (f["own"],)),
        )
        self._groups: list[QWidget] = []
        for head, part in zip(self._heads, parts, strict=True):
            group = QWidget()
            inside = QVBoxLayout(group)
            inside.setContentsMargins(0, 0, 0, GAP)
            inside.setSpacing(GAP)
            inside.addWidget(head)
            inside.addLayout(part)
            column.addWidget(group)
            self._groups.append(group)
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
        for field in (*self.fields.values(), self.preset, self.procedure):
            field.editor.setEnabled(editable)
        self.text.setReadOnly(not editable)

    # ----------------------------------------------------------------------------------------------------

    def _entries(self) -> dict[EntryName, str]:
        return {
            name: field.key() if isinstance(field, ChoiceField) else field.text()
            for name, field in self.fields.items()
        }

    def _show_plan(self) -> None:
        self.procedure.set_key(self._base.procedure)
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
        scheme = self.fields["scheme"]
        assert isinstance(scheme, ChoiceField)
        self.fields["own"].setVisible(scheme.key() == "own")
        for_imu = self._base.procedure == "imu-discrete"
        for group in self._groups[1:4]:
            group.setVisible(not for_imu)
        self._groups[4].setVisible(for_imu)

    def _form_edited(self) -> None:
        self._enable()
        self._judge()
        self.edited.emit()

    def _take_procedure(self) -> None:
        """Another procedure begins with a plan of its own; table and supply stay as they are set."""
        chosen = next(name for name in PROCEDURES if name == self.procedure.key())
        before, fresh = self._base, default_plan(chosen)
        power = replace(before.power, off_between_mountings=fresh.power.off_between_mountings)
        self._base = replace(fresh, settling=before.settling, power=power)
        self._show_plan()
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
            "imu-discrete": self.tr("Discrete IMU calibration"),
        }
        own = ("", self.tr("choose a preset …"))
        self.preset.set_choices([own, *((key, names.get(key, key)) for key in self._presets)])

    def retranslate(self) -> None:
        heads = (
            self.tr("Plan and mounting"),
            self.tr("Scale factor (7.1)"),
            self.tr("Zero offset (7.2)"),
            self.tr("Misalignment (7.3)"),
            self.tr("Whole turns and positions (2.6.3)"),
        )
        for head, text in zip(self._heads, heads, strict=True):
            head.setText(text)
        self._fill_presets()
        self._name_choices()
        self.preset.set_name(self.tr("Take over a preset"))
        self.procedure.set_name(self.tr("Procedure"))
        self.procedure.set_choices(
            [
                ("jjf1536-2015", self.tr("JJF 1536-2015: scale factor, zero offset, misalignment")),
                ("imu-discrete", self.tr("Discrete IMU calibration: gyros and accelerometers")),
            ]
        )
        self.procedure.set_key(self._base.procedure)
        self.fields["scheme"].set_name(self.tr("Positions"))
        self.fields["own"].set_name(
            self.tr("Own positions: where x, y, z point"),
            self.tr("For example UEN, DES, NUE@30; @ is by how many degrees the table is turned on."),
        )
        self.fields["imu_dwell"].set_name(self.tr("Time at each position, s"))
        self.fields["imu_turns"].set_name(self.tr("Whole turns each way"))
        self.fields["imu_rate"].set_name(self.tr("Rate, °/s"))
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
            "8": self.tr("8 (table 2-12)"),
            "own": self.tr("own list"),
        }
        standard = {
            "schedule": self.tr("standard: 12 positions"),
            "mounting_order": self.tr("as in the standard"),
        }
        for name, field in self.fields.items():
            if isinstance(field, ChoiceField):
                field.set_choices(
                    [
                        (key, standard[name] if key == "standard" else texts.get(key, key))
                        for key in _CHOICES[name]
                    ]
                )
