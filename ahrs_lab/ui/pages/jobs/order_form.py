"""The order: who sent which device, when, where it is measured, who signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date

from PySide6.QtCore import QDate, Signal
from PySide6.QtWidgets import QCompleter, QVBoxLayout

from ahrs_lab.records.rows import CustomerRow, DeviceRow, JobDraft, PersonRow, SigningRole
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.people import shown_name
from ahrs_lab.ui.pages.widgets.form import ChoiceField, DateField, TextField, grid
from ahrs_lab.ui.pages.words import role_names
from ahrs_lab.ui.theme import GAP
from ahrs_lab.ui.translation import language
from ahrs_lab.ui.widgets import Label

SIGNERS: tuple[SigningRole, ...] = ("operator", "verifier", "approver")


@dataclass(frozen=True)
class Order:
    """The part of a job's draft that this form holds."""

    customer: CustomerRow
    device: DeviceRow
    received: date
    place: str
    place_en: str
    people: tuple[int, int, int]


class OrderForm(Translated):
    """``edited`` follows every change by the person."""

    edited = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._customers: tuple[CustomerRow, ...] = ()
        self._people: tuple[PersonRow, ...] = ()
        self._ids = (0, 0)
        self.customer, self.customer_en = TextField(), TextField()
        self.address, self.address_en = TextField(), TextField()
        self.device, self.device_en = TextField(), TextField()
        self.manufacturer, self.model, self.serial = TextField(), TextField(), TextField()
        self.received, self.place, self.place_en = DateField(), TextField(), TextField()
        self.signers = {role: ChoiceField() for role in SIGNERS}
        self._heads = [Label(role="strong") for _ in range(4)]
        column = QVBoxLayout(self)
        column.setContentsMargins(0, GAP, 0, 0)
        column.setSpacing(6)
        parts = (
            grid((self.customer, self.customer_en), (self.address, self.address_en)),
            grid((self.device, self.device_en, self.manufacturer), (self.model, self.serial)),
            grid((self.received, self.place, self.place_en)),
            grid(tuple(self.signers.values())),
        )
        for head, part in zip(self._heads, parts, strict=True):
            column.addWidget(head)
            column.addLayout(part)
            column.addSpacing(2)
        column.addStretch(1)
        for field in self._fields():
            field.edited.connect(self.edited)
        self.customer.line.editingFinished.connect(self._take_known_customer)
        self.retranslate()

    def _fields(self) -> tuple[TextField | DateField | ChoiceField, ...]:
        return (
            self.customer, self.customer_en, self.address, self.address_en, self.device, self.device_en,
            self.manufacturer, self.model, self.serial, self.received, self.place, self.place_en,
            *self.signers.values(),
        )  # fmt: skip

    def set_known(self, customers: Sequence[CustomerRow], people: Sequence[PersonRow]) -> None:
        """Customers to complete from, people to choose from."""
        self._customers = tuple(customers)
        self._people = tuple(person for person in people if person.active)
        completer = QCompleter([row.name for row in customers], self.customer.line)
        self.customer.line.setCompleter(completer)
        self._fill_signers()

    def _fill_signers(self) -> None:
        nobody = ("0", self.tr("not chosen"))
        for role, field in self.signers.items():
            able = [(str(p.id), shown_name(p, language())) for p in self._people if role in p.roles]
            field.set_choices([nobody, *able])

    def _take_known_customer(self) -> None:
        name = self.customer.text()
        for row in self._customers:
            if row.name == name and row.id != self._ids[0]:
                self._ids = (row.id, self._ids[1])
                self._show_customer(row)
                self.edited.emit()

    def set_order(self, draft: JobDraft) -> None:
        """Show a job's order."""
        self._ids = (draft.customer.id, draft.device.id)
        self._show_customer(draft.customer)
        device = draft.device
        self.device.set_text(device.name)
        self.device_en.set_text(device.name_en)
        self.manufacturer.set_text(device.manufacturer)
        self.model.set_text(device.model)
        self.serial.set_text(device.serial_number)
        self.received.date_edit.blockSignals(True)
        self.received.date_edit.setDate(QDate(draft.received.year, draft.received.month, draft.received.day))
        self.received.date_edit.blockSignals(False)
        self.place.set_text(draft.place)
        self.place_en.set_text(draft.place_en)
        ids = (draft.operator_id, draft.verifier_id, draft.approver_id)
        for role, key in zip(SIGNERS, ids, strict=True):
            self.signers[role].set_key(str(key))

    def _show_customer(self, row: CustomerRow) -> None:
        self.customer.set_text(row.name)
        self.customer_en.set_text(row.name_en)
        self.address.set_text(row.address)
        self.address_en.set_text(row.address_en)

    def order(self) -> Order:
        """What stands in the form. A customer of another name is another customer."""
        customer_id = self._ids[0]
        known = next((row for row in self._customers if row.id == customer_id), None)
        if known is not None and known.name != self.customer.text():
            customer_id = 0
        day = self.received.date_edit.date()
        ids = [int(self.signers[role].key() or 0) for role in SIGNERS]
        return Order(
            CustomerRow(
                customer_id, self.customer.text(), self.customer_en.text(), self.address.text(),
                self.address_en.text(),
            ),
            DeviceRow(
                self._ids[1], self.device.text(), self.device_en.text(), self.manufacturer.text(),
                self.model.text(), self.serial.text(),
            ),
            date(day.year(), day.month(), day.day()),
            self.place.text(),
            self.place_en.text(),
            (ids[0], ids[1], ids[2]),
        )  # fmt: skip

    def set_editable(self, editable: bool) -> None:
        """A signed job only shows."""
        for field in self._fields():
            field.editor.setEnabled(editable)

    def retranslate(self) -> None:
        heads = (self.tr("Customer"), self.tr("Device"), self.tr("Receipt and place"), self.tr("Who signs"))
        for head, text in zip(self._heads, heads, strict=True):
            head.setText(text)
        self.customer.set_name(self.tr("Name"))
        self.customer_en.set_name(self.tr("Name in English"))
        self.address.set_name(self.tr("Address"))
        self.address_en.set_name(self.tr("Address in English"))
        self.device.set_name(self.tr("Name of the device"))
        self.device_en.set_name(self.tr("Name in English"))
        self.manufacturer.set_name(self.tr("Manufacturer"))
        self.model.set_name(self.tr("Model"))
        self.serial.set_name(self.tr("Serial number"))
        self.received.set_name(self.tr("Received on"))
        self.place.set_name(self.tr("Place of calibration"))
        self.place_en.set_name(self.tr("Place in English"))
        names = role_names()
        for role, field in self.signers.items():
            field.set_name(names[role])
        self._fill_signers()
