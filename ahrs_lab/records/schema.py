"""The database's tables, and the triggers that keep what must never change from changing."""

from __future__ import annotations

from sqlalchemy import (
    Boolean,
    Column,
    Date,
    ForeignKey,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
)

VERSION = 3

metadata = MetaData()


def _text(name: str) -> Column[str]:
    return Column(name, Text, nullable=False, default="")


version = Table("version", metadata, Column("number", Integer, nullable=False))

laboratory = Table(
    "laboratory",
    metadata,
    Column("id", Integer, primary_key=True),
    *(_text(name) for name in ("name", "name_en", "address", "address_en")),
    # The best measurement capability it states; opaque here.
    _text("capability_json"),
    # What it declares of its table's place; opaque here.
    _text("place_json"),
)

people = Table(
    "people",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", String, nullable=False, unique=True),
    *(_text(name) for name in ("name_en", "position", "position_en", "roles", "password_hash")),
    Column("active", Boolean, nullable=False, default=True),
    Column("failures", Integer, nullable=False, default=0),
    _text("locked_until"),
)

customers = Table(
    "customers",
    metadata,
    Column("id", Integer, primary_key=True),
    *(_text(name) for name in ("name", "name_en", "address", "address_en")),
)

devices = Table(
    "devices",
    metadata,
    Column("id", Integer, primary_key=True),
    *(_text(name) for name in ("name", "name_en", "manufacturer", "model", "serial_number")),
)

standards = Table(
    "standards",
    metadata,
    Column("id", Integer, primary_key=True),
    *(
        _text(name)
        for name in (
            "kind",
            "name",
            "name_zh",
            "manufacturer",
            "model",
            "serial_number",
            "accuracy",
            "accuracy_zh",
            "certificate_number",
            "traceability",
            # The figures that the certificate states; opaque here.
            "figures_json",
        )
    ),
    Column("due", Date),
)

jobs = Table(
    "jobs",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("number", String, nullable=False, unique=True),
    Column("state", String, nullable=False),
    Column("customer_id", ForeignKey("customers.id"), nullable=False),
    Column("device_id", ForeignKey("devices.id"), nullable=False),
    Column("received", Date, nullable=False),
    *(
        _text(name)
        for name in (
            "place",
            "place_en",
            "plan_toml",
            "bench_toml",
            # The limits that the customer's specification states; opaque here.
            "limits_json",
            "folder",
            "certificate_number",
        )
    ),
    Column("operator_id", ForeignKey("people.id")),
    Column("verifier_id", ForeignKey("people.id")),
    Column("approver_id", ForeignKey("people.id")),
    Column("revision", Integer, nullable=False, default=0),
    Column("calibrated", Date),
    Column("issued", Date),
)

job_standards = Table(
    "job_standards",
    metadata,
    Column("job_id", ForeignKey("jobs.id"), nullable=False),
    Column("standard_id", ForeignKey("standards.id"), nullable=False),
    # The standard as it was when the job was measured: its next certificate is not this job's.
    _text("as_used"),
    UniqueConstraint("job_id", "standard_id"),
)

runs = Table(
    "runs",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("job_id", ForeignKey("jobs.id"), nullable=False),
    *(_text(name) for name in ("utc", "what", "detail")),
)

results = Table(
    "results",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("job_id", ForeignKey("jobs.id"), nullable=False),
    *(_text(name) for name in ("utc", "person", "json", "sha256")),
)

signatures = Table(
    "signatures",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("job_id", ForeignKey("jobs.id"), nullable=False),
    *(_text(name) for name in ("role", "person", "utc", "file", "sha256")),
    Column("revision", Integer, nullable=False),
    UniqueConstraint("job_id", "revision", "role"),
)

audit = Table(
    "audit",
    metadata,
    Column("id", Integer, primary_key=True),
    *(_text(name) for name in ("utc", "person", "action", "subject", "before", "after", "chain")),
)

APPEND_ONLY = (runs, results, signatures, audit)


def append_only_triggers() -> list[str]:
    """SQL that refuses to change, delete or replace a row of the append-only tables."""
    # INSERT OR REPLACE deletes without asking the trigger for DELETE.
    conditions = {"UPDATE": "", "DELETE": "", "INSERT": "WHEN EXISTS (SELECT 1 FROM {0} WHERE id = NEW.id) "}
    return [
        f"CREATE TRIGGER IF NOT EXISTS {table.name}_no_{verb.lower()} BEFORE {verb} ON {table.name} "
        f"{condition.format(table.name)}BEGIN SELECT RAISE(ABORT, '{table.name} is append-only'); END"
        for table in APPEND_ONLY
        for verb, condition in conditions.items()
    ]
