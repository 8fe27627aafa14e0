"""Add an instrument or change its settings: which driver, where it is, what it may do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QScrollArea, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.registry import Driver, Kind
from ahrs_lab.laboratory.instrument_benches import (
    InstrumentBenches,
    SettingField,
    setting,
    setting_fields,
    table_languages,
    with_setting,
)
from ahrs_lab.ui.pages.instruments.words import part_names, setting_name
from ahrs_lab.ui.pages.widgets.dialogs import Question
from ahrs_lab.ui.pages.widgets.form import ChoiceField, Field, TextField
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets import LinkButton, SecondaryButton

_FIRST = (
    "limits.",
    "rate_hz",
    "max_voltage_v",
    "max_current_a",
    "serial_number",
)
_LINK = ("device", "baud", "host", "port")
_HIGH = 380


class InstrumentDialog(Question):
    """``table`` is the instrument's table in the bench file afterwards; None: it is to be removed."""

    def __init__(
        self,
        benches: InstrumentBenches,
        part: Kind,
        table: Mapping[str, Any] | None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._benches = benches
        self._part: Kind = part
        self.table: dict[str, Any] | None = dict(table) if table is not None else None
        self._start = dict(table or {})
        self._more = False
        self.setMinimumWidth(620)
        self.driver = ChoiceField()
        self.driver.edited.connect(self._driver_chosen)
        self.language = ChoiceField()
        self.language.set_name(self.tr("Language to begin with"))
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setMinimumHeight(_HIGH)
        self.more = LinkButton()
        self.more.clicked.connect(self._toggle_more)
        self.body.addWidget(self.driver)
        self.body.addWidget(self.language)
        self.body.addWidget(self._area)
        self.body.addWidget(self.more)
        self.remove = SecondaryButton(icon="remove")
        self.remove.setText(self.tr("Remove from the bench"))
        self.remove.setAutoDefault(False)
        self.remove.setVisible(table is not None)
        self.remove.clicked.connect(self._remove)
        self.body.addWidget(self.remove, 0, Qt.AlignmentFlag.AlignLeft)
        self._fields: list[tuple[SettingField, Field]] = []
        self.driver.set_name(self.tr("Driver"))
        self.driver.set_choices([(one.name, said(one.title)) for one in benches.drivers.of(part)])
        if table is not None:
            self.driver.set_key(str(table.get("driver", "")))
        self.language.set_choices([(name, str(one["name"])) for name, one in table_languages().items()])
        self.ask(
            part_names()[part],
            self.tr("Settings that are left empty have the driver's own default, shown in grey."),
            self.tr("Save"),
        )
        self._build()

    def _chosen(self) -> Driver | None:
        return self._benches.drivers.get(self._part, self.driver.key()) if self.driver.key() else None

    def _driver_chosen(self) -> None:
        link = self._values().get("link")
        self._start = {"link": link} if link else {}
        self._build()

    def _toggle_more(self) -> None:
        self._start, self._more = self._values(), not self._more
        self._build()

    def _build(self) -> None:
        driver = self._chosen()
        found = () if driver is None else setting_fields(driver)
        with_language = any(field.path.startswith("template.") for field in found)
        self.language.setVisible(with_language and "template" not in self._start)
        shown = [field for field in found if not field.path.startswith("template.")]
        first = [field for field in shown if field.required or _comes_first(field.path)]
        inside = QWidget()
        inside.setObjectName("scrolled")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, GAP, 0)
        grid = QGridLayout()
        grid.setHorizontalSpacing(CARD_MARGIN)
        grid.setVerticalSpacing(GAP)
        self._fields = []
        for place, field in enumerate(shown if self._more else first):
            editor = self._editor(field)
            self._fields.append((field, editor))
            grid.addWidget(editor, place // 2, place % 2)
        for place in range(2):
            grid.setColumnStretch(place, 1)
        column.addLayout(grid)
        column.addStretch(1)
        self._area.setWidget(inside)
        self.more.setVisible(len(shown) > len(first))
        self.more.setText(self.tr("Fewer settings") if self._more else self.tr("All settings"))
        self.action.setEnabled(driver is not None)

    def _editor(self, field: SettingField) -> Field:
        text = setting(self._start, field)
        editor: Field
        if field.kind in ("choice", "switch"):
            choices = field.choices or ("true", "false")
            words = {"true": self.tr("yes"), "false": self.tr("no")}
            chosen = ChoiceField()
            chosen.set_choices([("", f"({words.get(field.default, field.default)})")])
            chosen.set_choices(
                [
                    ("", f"({words.get(field.default, field.default)})"),
                    *((c, words.get(c, c)) for c in choices),
                ]
            )
            chosen.set_key(text)
            editor = chosen
        else:
            line = TextField()
            line.set_text(text)
            endless = field.default in ("inf", "-inf")
            line.line.setPlaceholderText(self.tr("no end") if endless else field.default)
            editor = line
        name = setting_name(field.path)
        editor.set_name(name + (" *" if field.required else ""))
        return editor

    def _values(self) -> dict[str, Any]:
        """The table as it stands in the form. Raises InputError."""
        table = {key: value for key, value in self._start.items() if key != "driver"}
        for field, editor in self._fields:
            text = editor.key() if isinstance(editor, ChoiceField) else ""
            text = editor.text() if isinstance(editor, TextField) else text
            if text != setting(table, field):
                table = with_setting(table, field, text)
        return table

    def answered(self) -> None:
        try:
            table = self._values()
            if self.language.isVisibleTo(self):
                table["template"] = table_languages()[self.language.key()]
            changed = self._benches.with_instrument({}, self._part, self.driver.key(), table)
        except AhrsLabError as error:
            self.refuse(said(error.message))
            return
        self.table = changed[self._part]
        self.accept()

    def _remove(self) -> None:
        self.table = None
        self.accept()


def _comes_first(path: str) -> bool:
    """Where the instrument is and what it may do: nobody should have to look for that."""
    outer, _, name = path.rpartition(".")
    return path.startswith(_FIRST) or (outer in ("link", "connection.link") and name in _LINK)


class NameDialog(Question):
    """What a new bench is called."""

    def __init__(self, benches: InstrumentBenches, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._benches = benches
        self.name = TextField()
        self.name.set_name(self.tr("Name"))
        self.body.addWidget(self.name)
        self.ask(
            self.tr("New bench"),
            self.tr(
                "A bench is a rate table, a power supply, a room sensor and the device under calibration."
            ),
            self.tr("Make it"),
        )

    def answered(self) -> None:
        name = self.name.text()
        try:
            if name in self._benches.names():
                self.refuse(self.tr("There is a bench of that name already."))
                return
            self._benches.save(name, {})
        except AhrsLabError as error:
            self.refuse(said(error.message))
            return
        self.accept()
