"""The audit trail: who did what when, each row's hash over the one before, so that a change is found."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from sqlalchemy import Connection, Row, insert, select

from ahrs_lab.messages import Message
from ahrs_lab.records import schema
from ahrs_lab.records.rows import AuditRow

if TYPE_CHECKING:
    from ahrs_lab.records.store import Records

_FIELDS = ("utc", "person", "action", "subject", "before", "after")


def utc_now() -> str:
    """ISO 8601 in UTC, to the millisecond."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _chain(previous: str, values: dict[str, str]) -> str:
    text = json.dumps([previous, *(values[name] for name in _FIELDS)], ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def write(
    connection: Connection,
    person: str,
    action: str,
    subject: str,
    before: object = None,
    after: object = None,
) -> None:
    """Append an act inside the transaction that does it."""
    last = connection.execute(
        select(schema.audit.c.chain).order_by(schema.audit.c.id.desc()).limit(1)
    ).scalar()
    values = {
        "utc": utc_now(),
        "person": person,
        "action": action,
        "subject": subject,
        "before": _json(before),
        "after": _json(after),
    }
    connection.execute(insert(schema.audit).values(chain=_chain(last or "", values), **values))


def _json(value: object) -> str:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = dataclasses.asdict(value)
    return "" if value is None else json.dumps(value, ensure_ascii=False, default=str, sort_keys=True)


class Audit:
    """Reading the trail."""

    def __init__(self, records: Records) -> None:
        self._records = records

    def rows(self, subject: str | None = None) -> tuple[AuditRow, ...]:
        """All acts in order, or those on one subject such as ``job 2026-0001``."""
        query = select(schema.audit).order_by(schema.audit.c.id)
        if subject is not None:
            query = query.where(schema.audit.c.subject == subject)
        with self._records.reading() as connection:
            return tuple(AuditRow(row.id, *_values(row).values()) for row in connection.execute(query))

    def first_broken(self) -> int | None:
        """The id of the first row that does not follow from the one before; None when the trail is whole."""
        with self._records.reading() as connection:
            return _first_broken(connection)

    def verify(self) -> tuple[Message, ...]:
        """What does not hold together: the trail's chain, and each result and signature against the trail.

        Empty when nothing was changed past this software. Acts that were cut off at the trail's end are found
        where a result or a signature has lost its act.
        """
        with self._records.reading() as connection:
            broken = _first_broken(connection)
            found = []
            if broken is not None:
                found.append(
                    Message(
                        "The audit trail was changed: row {row} does not follow from the one before it.",
                        row=broken,
                    )
                )
            return (*found, *_without_their_act(connection))


def _first_broken(connection: Connection) -> int | None:
    previous = ""
    for row in connection.execute(select(schema.audit).order_by(schema.audit.c.id)):
        if row.chain != _chain(previous, _values(row)):
            return int(row.id)
        previous = row.chain
    return None


def _without_their_act(connection: Connection) -> list[Message]:
    """Results and signatures that the trail does not know in this form."""
    acts = {
        (row.action, row.subject, row.after)
        for row in connection.execute(select(schema.audit).where(schema.audit.c.after != ""))
    }
    numbers = {row.id: row.number for row in connection.execute(select(schema.jobs))}
    found = []
    for row in connection.execute(select(schema.results).order_by(schema.results.c.id)):
        number = numbers.get(row.job_id, "?")
        told = ("add result", f"job {number}", _json({"sha256": row.sha256})) in acts
        if not told or hashlib.sha256(row.json.encode("utf-8")).hexdigest() != row.sha256:
            found.append(Message("A result of job {number} was changed: restore a backup.", number=number))
    for row in connection.execute(select(schema.signatures).order_by(schema.signatures.c.id)):
        number = numbers.get(row.job_id, "?")
        if (f"sign as {row.role}", f"job {number}", _json({"sha256": row.sha256})) not in acts:
            found.append(Message("A signature of job {number} was changed: restore a backup.", number=number))
    return found


def _values(row: Row[Any]) -> dict[str, str]:
    return {name: getattr(row, name) for name in _FIELDS}
