"""The laboratory itself, its customers, their devices, its measurement standards."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, TypeVar

from sqlalchemy import Connection, Row, Table, insert, select, update

from ahrs_lab.errors import InputError
from ahrs_lab.records import audit, schema
from ahrs_lab.records.rows import CustomerRow, DeviceRow, LaboratoryRow, SignedIn, StandardRow

if TYPE_CHECKING:
    from ahrs_lab.records.store import Records

_Kept = TypeVar("_Kept", CustomerRow, DeviceRow, StandardRow)

STANDARD_KINDS = ("table", "supply", "fixture", "room", "north", "other")


class Registry:
    """The desk of ``records.registry``."""

    def __init__(self, records: Records) -> None:
        self._records = records

    def laboratory(self) -> LaboratoryRow | None:
        """Name and address, or None before they are entered."""
        with self._records.reading() as connection:
            row = connection.execute(select(schema.laboratory)).one_or_none()
        return None if row is None else LaboratoryRow(**_without_id(row))

    def set_laboratory(self, row: LaboratoryRow, actor: SignedIn) -> None:
        """By an administrator."""
        who = self._records.people.require(actor, "administrator").name
        with self._records.writing() as connection:
            before = connection.execute(select(schema.laboratory)).one_or_none()
            statement = insert(schema.laboratory) if before is None else update(schema.laboratory)
            connection.execute(statement.values(id=1, **asdict(row)))
            old = _without_id(before) if before is not None else None
            audit.write(connection, who, "set laboratory", "laboratory", old, asdict(row))

    def customers(self) -> tuple[CustomerRow, ...]:
        """All of them, by name."""
        with self._records.reading() as connection:
            rows = connection.execute(select(schema.customers).order_by(schema.customers.c.name))
            return tuple(customer(row) for row in rows)

    def devices(self) -> tuple[DeviceRow, ...]:
        """All of them, the newest first."""
        with self._records.reading() as connection:
            rows = connection.execute(select(schema.devices).order_by(schema.devices.c.id.desc()))
            return tuple(device(row) for row in rows)

    def standards(self) -> tuple[StandardRow, ...]:
        """All of them, in the order they were entered."""
        with self._records.reading() as connection:
            rows = connection.execute(select(schema.standards).order_by(schema.standards.c.id))
            return tuple(standard(row) for row in rows)

    def save_standard(self, row: StandardRow, actor: SignedIn) -> StandardRow:
        """Add (id 0) or change a standard; by an operator or an administrator."""
        who = self._records.people.require(actor, "administrator", "operator").name
        if row.kind not in STANDARD_KINDS or not row.name.strip():
            raise InputError("A standard needs a name and a kind ({kinds}).", kinds=", ".join(STANDARD_KINDS))
        with self._records.writing() as connection:
            return keep(connection, schema.standards, row, who)


def keep(connection: Connection, table: Table, row: _Kept, who: str, *, in_place: bool = True) -> _Kept:
    """Store ``row`` inside a transaction, as a new one where its id is 0; ``who`` did it, says the trail.

    ``in_place=False``: a changed row becomes a new one, so that what other jobs point at stays as it was.
    """
    values = {key: value for key, value in asdict(row).items() if key != "id"}
    old: dict[str, Any] | None = None
    if row.id:
        before = connection.execute(select(table).where(table.c.id == row.id)).one_or_none()
        if before is None:
            raise InputError("{subject} {id} is not in the records.", subject=table.name, id=row.id)
        old = _without_id(before)
        if old == values:
            return row
    if row.id and in_place:
        connection.execute(update(table).where(table.c.id == row.id).values(**values))
        kept = row
    else:
        key = connection.execute(insert(table).values(**values)).inserted_primary_key
        kept = replace(row, id=int((key or (0,))[0]))
    act = "change" if row.id else "add"
    audit.write(connection, who, act, f"{table.name} {kept.id}", old, values)
    return kept


def _without_id(row: Row[Any]) -> dict[str, Any]:
    return {key: value for key, value in row._mapping.items() if key != "id"}


def customer(row: Row[Any]) -> CustomerRow:
    """A row of the table as the room's own type."""
    return CustomerRow(**row._mapping)


def device(row: Row[Any]) -> DeviceRow:
    """A row of the table as the room's own type."""
    return DeviceRow(**row._mapping)


def standard(row: Row[Any]) -> StandardRow:
    """A row of the table as the room's own type."""
    return StandardRow(**row._mapping)
