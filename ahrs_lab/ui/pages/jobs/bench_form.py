"""Which bench the job runs on: a preset, or its own TOML."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import QPlainTextEdit, QVBoxLayout

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.bench_model import BenchView, look_at
from ahrs_lab.ui.pages.widgets.form import ChoiceField, grid
from ahrs_lab.ui.theme import GAP, TEXT_PX
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import Banner, KeyValueTable, Label


class BenchForm(Translated):
    """``edited`` follows every change; ``limits`` are those of the bench that stands here, None while it is
    not one."""

    edited = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._presets: Mapping[str, str] = {}
        self._view: BenchView | None = None
        self.preset = ChoiceField()
        self._refusal = Banner("bad")
        self._facts = KeyValueTable(("table", "rate", "acceleration", "ahrs", "supply"), numbers=False)
        self._text_name = Label(tone="muted")
        self.text = QPlainTextEdit()
        mono = QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont)
        mono.setPixelSize(TEXT_PX)
        self.text.setFont(mono)
        self.text.setTabChangesFocus(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        column.setSpacing(GAP)
        column.addLayout(grid((self.preset,)))
        column.addWidget(self._facts)
        column.addWidget(self._refusal)
        column.addWidget(self._text_name)
        column.addWidget(self.text, 1)
        self.preset.edited.connect(self._take_preset)
        self.text.textChanged.connect(self._text_edited)
        self._look()
        self.retranslate()

    @property
    def limits(self) -> TableLimits | None:
        """Of the table that stands here."""
        return self._view.limits if self._view is not None else None

    def set_presets(self, presets: Mapping[str, str]) -> None:
        """Benches that come along, name → TOML."""
        self._presets = presets
        self.preset.set_choices([("", self.tr("its own settings")), *((key, key) for key in presets)])
        self._name_preset()

    def set_text(self, text: str) -> None:
        """Show a job's bench."""
        self.text.blockSignals(True)
        self.text.setPlainText(text)
        self.text.blockSignals(False)
        self._name_preset()
        self._look()

    def bench_text(self) -> str:
        """TOML as it stands here."""
        return self.text.toPlainText()

    def set_editable(self, editable: bool) -> None:
        """A measured job keeps its bench."""
        self.preset.editor.setEnabled(editable)
        self.text.setReadOnly(not editable)

    def _name_preset(self) -> None:
        text = self.text.toPlainText()
        self.preset.set_key(next((key for key, preset in self._presets.items() if preset == text), ""))

    def _take_preset(self) -> None:
        if self.preset.key():
            self.set_text(self._presets[self.preset.key()])
            self.edited.emit()

    def _text_edited(self) -> None:
        self._name_preset()
        self._look()
        self.edited.emit()

    def _look(self) -> None:
        text = self.text.toPlainText()
        self._view, refusal = None, ""
        if text.strip():
            try:
                self._view = look_at(text)
            except AhrsLabError as error:
                refusal = said(error.message)
        self._refusal.set_content("bad", "", refusal)
        self._refusal.setVisible(bool(refusal))
        self._facts.setVisible(self._view is not None)
        if self._view is not None:
            self._facts.set_value("table", said(self._view.table))
            self._facts.set_value("rate", f"{number(self._view.limits.max_rate_dps, 0)} °/s")
            self._facts.set_value(
                "acceleration", f"{number(self._view.limits.max_acceleration_dps2, 0)} °/s²"
            )
            self._facts.set_value("ahrs", said(self._view.ahrs))
            self._facts.set_value("supply", said(self._view.supply))

    def retranslate(self) -> None:
        self.preset.set_name(self.tr("Bench"))
        self.set_presets(self._presets)
        self._text_name.setText(self.tr("Settings of the bench (TOML)"))
        for key, text in (
            ("table", self.tr("Rate table")),
            ("rate", self.tr("Highest rate")),
            ("acceleration", self.tr("Highest acceleration")),
            ("ahrs", self.tr("Device")),
            ("supply", self.tr("Supply")),
        ):
            self._facts.set_name(key, text)
        self._look()
