"""A job's rows inside a transaction: its number, what a draft puts into it, and the whole of it read back."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import date
from typing import Any

from sqlalchemy import Connection, Integer, Row, cast, delete, func, insert, select, update

from ahrs_lab.errors import InputError
from ahrs_lab.records import schema
from ahrs_lab.records.people import ROLE_NAMES, person
from ahrs_lab.records.registry import customer, device, keep, standard
from ahrs_lab.records.rows import JobDraft, JobRow, PersonRow, SigningRole, StandardRow

SIGNING_ORDER: tuple[SigningRole, ...] = ("operator", "verifier", "approver")


def job_row(connection: Connection, number: str) -> Row[Any]:
    """The row of a job; raises InputError where there is none."""
    row = connection.execute(select(schema.jobs).where(schema.jobs.c.number == number)).one_or_none()
    if row is None:
        raise InputError("There is no job {number} in the records.", number=number)
    return row


def next_number(connection: Connection, year: int) -> str:
    """The next of the year, such as 2026-0001."""
    # Counted, not compared as text: after 2026-9999 comes 2026-10000.
    counter = cast(func.substr(schema.jobs.c.number, 6), Integer)
    last = connection.execute(
        select(func.max(counter)).where(schema.jobs.c.number.like(f"{year:04d}-%"))
    ).scalar()
    return f"{year:04d}-{(last or 0) + 1:04d}"


def draft_values(connection: Connection, draft: JobDraft, who: str) -> dict[str, Any]:
    """The columns a draft stands for, its customer and device stored; InputError for what cannot be."""
    if not draft.customer.name.strip():
        raise InputError("A job needs a customer's name.")
    if not draft.device.model.strip() and not draft.device.name.strip():
        raise InputError("A job needs the device's name or model.")
    people = [key for key in (draft.operator_id, draft.verifier_id, draft.approver_id) if key]
    if len(set(people)) < len(people):
        raise InputError("Operator, verifier and approver have to be three different people.")
    for key, role in zip(
        (draft.operator_id, draft.verifier_id, draft.approver_id), SIGNING_ORDER, strict=True
    ):
        if key:
            row = connection.execute(select(schema.people).where(schema.people.c.id == key)).one_or_none()
            if row is None or role not in person(row).roles:
                raise InputError("Choose as {role} somebody who has this role.", role=ROLE_NAMES[role])
    return {
        "customer_id": keep(connection, schema.customers, draft.customer, who, in_place=False).id,
        "device_id": keep(connection, schema.devices, draft.device, who, in_place=False).id,
        "received": draft.received,
        "place": draft.place,
        "place_en": draft.place_en,
        "plan_toml": draft.plan_toml,
        "bench_toml": draft.bench_toml,
        "limits_json": draft.limits_json,
        "operator_id": draft.operator_id or None,
        "verifier_id": draft.verifier_id or None,
        "approver_id": draft.approver_id or None,
    }


def set_standards(connection: Connection, number: str, ids: tuple[int, ...]) -> None:
    """The standards that the job uses, instead of those before."""
    job_id = job_row(connection, number).id
    connection.execute(delete(schema.job_standards).where(schema.job_standards.c.job_id == job_id))
    known = set(connection.execute(select(schema.standards.c.id)).scalars())
    for key in ids:
        if key not in known:
            raise InputError("{subject} {id} is not in the records.", subject="standards", id=key)
        connection.execute(insert(schema.job_standards).values(job_id=job_id, standard_id=key))


def freeze_standards(connection: Connection, job_id: int) -> None:
    """Keep the job's standards as they are today: their next certificate is not this job's."""
    table = schema.job_standards
    for used in _standards(connection, job_id):
        as_used = json.dumps(asdict(used), ensure_ascii=False, default=date.isoformat)
        chosen = (table.c.job_id == job_id) & (table.c.standard_id == used.id)
        connection.execute(update(table).where(chosen).values(as_used=as_used))


def _standards(connection: Connection, job_id: int) -> list[StandardRow]:
    """Those chosen, as they are now."""
    query = (
        select(schema.standards)
        .join(schema.job_standards, schema.job_standards.c.standard_id == schema.standards.c.id)
        .where(schema.job_standards.c.job_id == job_id)
        .order_by(schema.standards.c.id)
    )
    return [standard(row) for row in connection.execute(query)]


def _standards_used(connection: Connection, row: Row[Any]) -> tuple[StandardRow, ...]:
    """Those of the job: once it is measured, as they were then."""
    now = _standards(connection, row.id)
    if row.state not in ("measured", "checked", "issued"):
        return tuple(now)
    table = schema.job_standards
    kept = {
        r.standard_id: r.as_used for r in connection.execute(select(table).where(table.c.job_id == row.id))
    }
    return tuple(_thawed(kept[used.id]) if kept[used.id] else used for used in now)


def _thawed(text: str) -> StandardRow:
    values = json.loads(text)
    return StandardRow(**{**values, "due": date.fromisoformat(values["due"]) if values["due"] else None})


def read_job(connection: Connection, row: Row[Any]) -> JobRow:
    """The job with all that it points at."""

    def one(key: int | None) -> PersonRow | None:
        if key is None:
            return None
        return person(connection.execute(select(schema.people).where(schema.people.c.id == key)).one())

    return JobRow(
        id=row.id,
        number=row.number,
        state=row.state,
        customer=customer(
            connection.execute(select(schema.customers).where(schema.customers.c.id == row.customer_id)).one()
        ),
        device=device(
            connection.execute(select(schema.devices).where(schema.devices.c.id == row.device_id)).one()
        ),
        received=row.received,
        place=row.place,
        place_en=row.place_en,
        plan_toml=row.plan_toml,
        bench_toml=row.bench_toml,
        standards=_standards_used(connection, row),
        operator=one(row.operator_id),
        verifier=one(row.verifier_id),
        approver=one(row.approver_id),
        folder=row.folder,
        certificate_number=row.certificate_number + (f"-R{row.revision}" if row.revision else ""),
        revision=row.revision,
        calibrated=row.calibrated,
        issued=row.issued,
        limits_json=row.limits_json,
    )
