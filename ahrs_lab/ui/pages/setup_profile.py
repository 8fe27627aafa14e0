"""The laboratory as its certificates name it."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.metrology.best_capability import (
    BestCapability,
    capability_from_json,
    capability_to_json,
)
from ahrs_lab.metrology.declared_place import DeclaredPlace, place_from_json, place_to_json
from ahrs_lab.records.rows import LaboratoryRow
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.limits_model import number_of
from ahrs_lab.ui.pages.widgets.form import ChoiceField, TextField, grid
from ahrs_lab.ui.theme import CARD_MARGIN
from ahrs_lab.ui.widgets import Label, PrimaryButton

_ISOLATED, _NOT_ISOLATED = "isolated", "not isolated"


class ProfilePanel(Translated):
    """Saved by an administrator."""

    def __init__(self, desk: Desk) -> None:
        super().__init__()
        self._desk = desk
        column = QVBoxLayout(self)
        column.setContentsMargins(0, CARD_MARGIN, 0, 0)
        column.setSpacing(CARD_MARGIN)
        self._hint = Label(tone="muted", wrap=True)
        self.name, self.name_en = TextField(), TextField()
        self.address, self.address_en = TextField(), TextField()
        self.K, self.B, self.L = TextField(), TextField(), TextField()
        self._capability_head, self._capability_hint = Label(role="strong"), Label(tone="muted", wrap=True)
        self.earth, self.foundation = TextField(), ChoiceField()
        self._place_head, self._place_hint = Label(role="strong"), Label(tone="muted", wrap=True)
        self.save_button = PrimaryButton()
        self.save_button.clicked.connect(self.save)
        column.addWidget(self._hint)
        column.addLayout(grid((self.name, self.name_en), (self.address, self.address_en)))
        column.addWidget(self._place_head)
        column.addWidget(self._place_hint)
        column.addLayout(grid((self.earth, self.foundation)))
        column.addWidget(self._capability_head)
        column.addWidget(self._capability_hint)
        column.addLayout(grid((self.K, self.B, self.L)))
        row = QHBoxLayout()
        row.addWidget(self.save_button)
        row.addStretch(1)
        column.addLayout(row)
        column.addStretch(1)
        for field in (
            self.name, self.name_en, self.address, self.address_en, self.earth, self.foundation,
            self.K, self.B, self.L,
        ):  # fmt: skip
            field.edited.connect(lambda: self.save_button.setEnabled(True))
        self.retranslate()
        self.refresh()

    def refresh(self) -> None:
        """As the records have it."""
        row = self._desk.laboratory.profile()
        self.name.set_text(row.name)
        self.name_en.set_text(row.name_en)
        self.address.set_text(row.address)
        self.address_en.set_text(row.address_en)
        try:
            stated = capability_from_json(row.capability_json)
        except AhrsLabError as error:
            self._desk.tell(error)
            stated = BestCapability()
        for field, value in ((self.K, stated.K_relative), (self.B, stated.B_dps), (self.L, stated.L_rad)):
            field.set_text(f"{value!r}" if value else "")
        self._show_place(row.place_json)
        self.save_button.setEnabled(False)

    def _show_place(self, text: str) -> None:
        try:
            place = place_from_json(text)
        except AhrsLabError as error:
            self._desk.tell(error)
            place = DeclaredPlace()
        ohm = place.earth_resistance_ohm
        self.earth.set_text("" if ohm is None else f"{ohm:.12g}")
        self.foundation.set_key({True: _ISOLATED, False: _NOT_ISOLATED, None: ""}[place.isolated_foundation])

    def _place(self) -> str:
        ohm = number_of(self.earth.text()) if self.earth.text() else None
        isolated = {_ISOLATED: True, _NOT_ISOLATED: False}.get(self.foundation.key())
        return place_to_json(DeclaredPlace(ohm, isolated))

    def _capability(self) -> str:
        numbers = [number_of(one.text()) if one.text() else 0.0 for one in (self.K, self.B, self.L)]
        return capability_to_json(BestCapability(*numbers))

    def save(self) -> None:
        """Into the records."""
        actor = self._desk.ask_actor(self)
        if actor is None:
            return
        try:
            row = LaboratoryRow(
                self.name.text(), self.name_en.text(), self.address.text(), self.address_en.text(),
                self._capability(), self._place(),
            )  # fmt: skip
            self._desk.laboratory.set_profile(row, actor)
        except AhrsLabError as error:
            self._desk.tell(error)
            return
        self.refresh()
        self._desk.workspace.notice("good", self.tr("Saved."))

    def retranslate(self) -> None:
        self._hint.setText(
            self.tr("Name and address stand on every certificate. An administrator changes them.")
        )
        self.name.set_name(self.tr("Name of the laboratory"))
        self.name_en.set_name(self.tr("Name in English"))
        self.address.set_name(self.tr("Address"))
        self.address_en.set_name(self.tr("Address in English"))
        self._place_head.setText(self.tr("Place of the table (clause 6)"))
        self._place_hint.setText(
            self.tr(
                "Recorded with each run and printed on its certificate; a real bench does not start without "
                "it unless a second person says why."
            )
        )
        self.earth.set_name(self.tr("Earth resistance, Ω"), self.tr("Has to be below 4 Ω."))
        self.foundation.set_name(self.tr("Table on an isolated foundation"))
        self.foundation.set_choices(
            (("", self.tr("Not said")), (_ISOLATED, self.tr("Yes")), (_NOT_ISOLATED, self.tr("No")))
        )
        self._capability_head.setText(self.tr("Best measurement capability (CMC)"))
        self._capability_hint.setText(
            self.tr("Expanded uncertainties, k = 2: no U is reported below them. Empty: none is stated.")
        )
        self.K.set_name(self.tr("Scale factor, relative"))
        self.B.set_name(self.tr("Zero offset, °/s"))
        self.L.set_name(self.tr("Misalignment, rad"))
        self.save_button.setText(self.tr("Save"))
