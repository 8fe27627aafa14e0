"""Jobs from order to issued certificate, through one table of states.

Everything measured or signed is appended: a run's start and end, each result, each signature. Of a job itself
only what a person may still correct can change, and the audit trail keeps what it was.
"""

from __future__ import annotations

import hashlib
from datetime import date
from typing import TYPE_CHECKING, Any

from sqlalchemy import Connection, Row, insert, select, update

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.messages import Message
from ahrs_lab.records import audit, schema
from ahrs_lab.records.job_tables import (
    SIGNING_ORDER,
    draft_values,
    freeze_standards,
    job_row,
    next_number,
    read_job,
    set_standards,
)
from ahrs_lab.records.rows import (
    ROLES,
    JobDraft,
    JobRow,
    JobState,
    PersonRow,
    ResultRow,
    Role,
    RunRow,
    SignatureRow,
    SignedIn,
    SigningRole,
)

if TYPE_CHECKING:
    from ahrs_lab.records.store import Records

TRANSITIONS: dict[tuple[JobState, JobState], tuple[Role, ...]] = {
    ("draft", "ready"): ("operator",),
    ("ready", "draft"): ("operator",),
    ("ready", "running"): ("operator",),
    ("running", "ready"): ("operator",),
    ("running", "measured"): ("operator",),
    ("measured", "running"): ("operator",),
    ("draft", "measured"): ("operator", "importer"),
    ("measured", "checked"): ("verifier",),
    ("checked", "issued"): ("approver",),
    ("checked", "measured"): ("approver",),
}
"""Which state follows which, and whose act it is. Backwards needs a reason; issued is the end."""

STATE_NAMES: dict[JobState, Message] = {
    "draft": Message("draft"),
    "ready": Message("ready"),
    "running": Message("running"),
    "measured": Message("measured"),
    "checked": Message("checked"),
    "issued": Message("issued"),
}

_BACKWARDS = {("ready", "draft"), ("measured", "running"), ("checked", "measured")}
_SIGNED_IN_STATE: dict[SigningRole, JobState] = {
    "operator": "measured",
    "verifier": "measured",
    "approver": "checked",
}
_STATE_AFTER: dict[SigningRole, JobState] = {
    "operator": "measured",
    "verifier": "checked",
    "approver": "issued",
}


class Jobs:
    """The desk of ``records.jobs``."""

    def __init__(self, records: Records) -> None:
        self._records = records

    def all(self) -> tuple[JobRow, ...]:
        """All jobs, the newest first."""
        with self._records.reading() as connection:
            rows = connection.execute(select(schema.jobs).order_by(schema.jobs.c.id.desc())).all()
            return tuple(read_job(connection, row) for row in rows)

    def get(self, number: str) -> JobRow:
        """Raises InputError where there is no such job."""
        with self._records.reading() as connection:
            return read_job(connection, job_row(connection, number))

    def create(self, draft: JobDraft, actor: SignedIn, folder: str = "") -> str:
        """A new job in state ``draft``; its number is the year's next. Any role may create one."""
        who = self._records.people.require(actor, *ROLES, "importer").name
        with self._records.writing() as connection:
            number = next_number(connection, draft.received.year)
            values = draft_values(connection, draft, who)
            connection.execute(
                insert(schema.jobs).values(
                    number=number, state="draft", folder=folder, certificate_number=f"AL-{number}", **values
                )
            )
            set_standards(connection, number, draft.standard_ids)
            audit.write(connection, who, "create job", f"job {number}", after=draft)
        return number

    def change(self, number: str, draft: JobDraft, actor: SignedIn) -> None:
        """Correct a job that nothing was signed of."""
        who = self._records.people.require(actor, "operator", "administrator").name
        with self._records.writing() as connection:
            before = job_row(connection, number)
            if before.state not in ("draft", "ready", "measured") or _signatures(connection, before):
                raise InputError(
                    "Job {number} is {state}: "
                    "it can be changed before its run and until the first signature.",
                    number=number,
                    state=_state(before),
                )
            measured = before.state == "measured"
            if measured and (draft.plan_toml, draft.bench_toml) != (before.plan_toml, before.bench_toml):
                raise InputError(
                    "Job {number} is measured: its plan and bench stay as they were run.", number=number
                )
            if measured and before.operator_id and draft.operator_id != before.operator_id:
                raise InputError("Job {number} is measured: its operator is who ran it.", number=number)
            values = draft_values(connection, draft, who)
            connection.execute(update(schema.jobs).where(schema.jobs.c.number == number).values(**values))
            set_standards(connection, number, draft.standard_ids)
            if measured:
                freeze_standards(connection, before.id)
            audit.write(connection, who, "change job", f"job {number}", dict(before._mapping), draft)

    def set_folder(self, number: str, folder: str, actor: SignedIn) -> None:
        """Where the job's recording is; once."""
        who = self._records.people.require(actor, *ROLES, "importer").name
        with self._records.writing() as connection:
            before = job_row(connection, number).folder
            if before == folder:
                return
            if before:
                raise InputError("Job {number} has its recording elsewhere already.", number=number)
            connection.execute(
                update(schema.jobs).where(schema.jobs.c.number == number).values(folder=folder)
            )
            audit.write(connection, who, "set folder", f"job {number}", after={"folder": folder})

    def move(self, number: str, state: JobState, actor: SignedIn, reason: str = "") -> None:
        """To another state, as the table allows; raises InputError or PermissionDeniedError.

        Only a signature (:meth:`add_signature`) makes a job checked or issued.
        """
        if state in ("checked", "issued"):
            raise InputError(
                "Job {number} becomes {wanted} by being signed.", number=number, wanted=STATE_NAMES[state]
            )
        with self._records.writing() as connection:
            row = job_row(connection, number)
            self._move(connection, row, state, actor, reason)

    def _move(
        self, connection: Connection, row: Row[Any], state: JobState, actor: SignedIn, reason: str = ""
    ) -> None:
        step: tuple[JobState, JobState] = (row.state, state)
        roles = TRANSITIONS.get(step)
        if roles is None:
            raise InputError(
                "Job {number} is {state}: it cannot become {wanted}.",
                number=row.number,
                state=_state(row),
                wanted=STATE_NAMES[state],
            )
        found = self._records.people.require(actor, *roles)
        if state == "running" and row.operator_id != found.id:
            raise PermissionDeniedError(
                "Job {number} is not assigned to {name}.", number=row.number, name=found.name
            )
        if step in _BACKWARDS and not reason.strip():
            raise InputError("Say why job {number} goes back: the reason is kept.", number=row.number)
        values: dict[str, Any] = {"state": state}
        if state == "issued":
            values["issued"] = date.today()  # noqa: DTZ011  the date on a certificate is the laboratory's own
        if state == "measured" and row.state == "running":
            values["calibrated"] = date.today()  # noqa: DTZ011
        if step in (("checked", "measured"), ("measured", "running")) and _signatures(connection, row):
            values["revision"] = row.revision + 1
        connection.execute(update(schema.jobs).where(schema.jobs.c.id == row.id).values(**values))
        if state == "measured" and row.state != "checked":
            freeze_standards(connection, row.id)
        audit.write(
            connection, found.name, "move job", f"job {row.number}", row.state, {"to": state, "why": reason}
        )

    def add_run_event(self, number: str, what: str, detail: str = "") -> None:
        """A run started, ended, failed; appended."""
        with self._records.writing() as connection:
            row = job_row(connection, number)
            connection.execute(
                insert(schema.runs).values(job_id=row.id, utc=audit.utc_now(), what=what, detail=detail)
            )
            audit.write(connection, "(bench)", "run", f"job {number}", after={"what": what, "detail": detail})

    def run_events(self, number: str) -> tuple[RunRow, ...]:
        """In the order they happened."""
        with self._records.reading() as connection:
            query = select(schema.runs).where(schema.runs.c.job_id == job_row(connection, number).id)
            return tuple(
                RunRow(r.utc, r.what, r.detail) for r in connection.execute(query.order_by(schema.runs.c.id))
            )

    def add_result(self, number: str, json_text: str, actor: SignedIn) -> ResultRow:
        """Append a result; it becomes the current one. Not once the certificate is being signed."""
        digest = hashlib.sha256(json_text.encode("utf-8")).hexdigest()
        with self._records.writing() as connection:
            row = job_row(connection, number)
            # What was measured here is not replaced by whoever may take recordings in.
            roles: tuple[Role, ...] = ("operator", "verifier")
            who = self._records.people.require(
                actor, *roles, *(("importer",) if row.state == "draft" else ())
            ).name
            if _signatures(connection, row):
                raise InputError(
                    "Job {number} is signed: send it back with a reason before another result is stored.",
                    number=number,
                )
            values = {"utc": audit.utc_now(), "person": who, "json": json_text, "sha256": digest}
            key = connection.execute(
                insert(schema.results).values(job_id=row.id, **values)
            ).inserted_primary_key
            audit.write(connection, who, "add result", f"job {number}", after={"sha256": digest})
        return ResultRow(int((key or (0,))[0]), **values)

    def results(self, number: str) -> tuple[ResultRow, ...]:
        """All of them; the last is the current one."""
        table = schema.results
        with self._records.reading() as connection:
            query = select(table).where(table.c.job_id == job_row(connection, number).id).order_by(table.c.id)
            return tuple(
                ResultRow(r.id, r.utc, r.person, r.json, r.sha256) for r in connection.execute(query)
            )

    def may_sign(self, number: str, role: SigningRole, actor: SignedIn) -> None:
        """Raises where ``actor`` may not sign as ``role`` now: not assigned, not the role, out of turn, or
        the same person twice."""
        found = self._records.people.require(actor, role)
        with self._records.reading() as connection:
            row = job_row(connection, number)
            _refuse_signature(connection, row, role, found)

    def add_signature(self, number: str, role: SigningRole, actor: SignedIn, file: str, sha256: str) -> None:
        """Append a signature and take the job to the state that follows."""
        found = self._records.people.require(actor, role)
        with self._records.writing() as connection:
            row = job_row(connection, number)
            _refuse_signature(connection, row, role, found)
            connection.execute(
                insert(schema.signatures).values(
                    job_id=row.id,
                    role=role,
                    person=found.name,
                    utc=audit.utc_now(),
                    file=file,
                    sha256=sha256,
                    revision=row.revision,
                )
            )
            audit.write(connection, found.name, f"sign as {role}", f"job {number}", after={"sha256": sha256})
            if _STATE_AFTER[role] != row.state:
                self._move(connection, row, _STATE_AFTER[role], actor)

    def signatures(self, number: str) -> tuple[SignatureRow, ...]:
        """Those on the current revision of the certificate, in order."""
        with self._records.reading() as connection:
            return _signatures(connection, job_row(connection, number))


def _refuse_signature(connection: Connection, row: Row[Any], role: SigningRole, found: PersonRow) -> None:
    assigned = {"operator": row.operator_id, "verifier": row.verifier_id, "approver": row.approver_id}
    if assigned[role] != found.id:
        raise PermissionDeniedError(
            "Job {number} is not assigned to {name}.", number=row.number, name=found.name
        )
    done = _signatures(connection, row)
    if any(signature.person == found.name for signature in done):
        raise PermissionDeniedError(
            "{name} has signed job {number} already.", name=found.name, number=row.number
        )
    if row.state != _SIGNED_IN_STATE[role] or len(done) != SIGNING_ORDER.index(role):
        raise InputError(
            "Job {number} is {state} with {count} of 3 signatures: "
            "operator, verifier and approver sign in this order.",
            number=row.number,
            state=_state(row),
            count=len(done),
        )


def _state(row: Row[Any]) -> Message:
    state: JobState = row.state
    return STATE_NAMES[state]


def _signatures(connection: Connection, row: Row[Any]) -> tuple[SignatureRow, ...]:
    table = schema.signatures
    query = (
        select(table).where(table.c.job_id == row.id, table.c.revision == row.revision).order_by(table.c.id)
    )
    return tuple(
        SignatureRow(r.role, r.person, r.utc, r.file, r.sha256, r.revision) for r in connection.execute(query)
    )
