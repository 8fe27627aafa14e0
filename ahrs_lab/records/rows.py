"""What the records give and take: frozen rows. ``id`` 0 means not stored yet."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import Literal

Role = Literal["operator", "verifier", "approver", "administrator", "importer"]
JobState = Literal["draft", "ready", "running", "measured", "checked", "issued"]
SigningRole = Literal["operator", "verifier", "approver"]

ROLES: tuple[Role, ...] = ("operator", "verifier", "approver", "administrator")
"""Those a person can be given. ``importer`` is the machine's user at the command line, who may take
recordings in."""


@dataclass(frozen=True)
class PersonRow:
    """Somebody of the laboratory; the password's hash never leaves the database."""

    id: int
    name: str
    name_en: str = ""
    position: str = ""
    position_en: str = ""
    roles: frozenset[Role] = frozenset()
    active: bool = True


@dataclass(frozen=True)
class SignedIn:
    """Proof of a sign-in, valid for the records that gave it until ``sign_out`` or close."""

    person: PersonRow
    token: str


@dataclass(frozen=True)
class LaboratoryRow:
    """The laboratory as its certificates name it. ``capability_json``: the best measurement capability that
    it states; ``place_json``: what it declares of its table's place. JSON texts that the records keep as they
    are."""

    name: str
    name_en: str = ""
    address: str = ""
    address_en: str = ""
    capability_json: str = ""
    place_json: str = ""


@dataclass(frozen=True)
class CustomerRow:
    """送校单位."""

    id: int
    name: str
    name_en: str = ""
    address: str = ""
    address_en: str = ""


@dataclass(frozen=True)
class DeviceRow:
    """被校对象."""

    id: int
    name: str
    name_en: str = ""
    manufacturer: str = ""
    model: str = ""
    serial_number: str = ""


@dataclass(frozen=True)
class StandardRow:
    """A measurement standard with its certificate; ``kind`` is table, supply, fixture, room, north or
    other. ``figures_json``: the figures that the certificate states, a JSON text that the records keep as
    it is."""

    id: int
    kind: str
    name: str
    name_zh: str = ""
    manufacturer: str = ""
    model: str = ""
    serial_number: str = ""
    accuracy: str = ""
    accuracy_zh: str = ""
    certificate_number: str = ""
    due: date | None = None
    traceability: str = ""
    figures_json: str = ""


@dataclass(frozen=True)
class JobDraft:
    """What a person enters for a job; 0 for a person not chosen yet. ``limits_json``: the limits to judge
    its result by, a JSON text that the records keep as it is."""

    customer: CustomerRow
    device: DeviceRow
    received: date
    place: str = ""
    place_en: str = ""
    plan_toml: str = ""
    bench_toml: str = ""
    standard_ids: tuple[int, ...] = ()
    operator_id: int = 0
    verifier_id: int = 0
    approver_id: int = 0
    limits_json: str = ""


@dataclass(frozen=True)
class JobRow:
    """A job as it is kept; the rows it points at come with it."""

    id: int
    number: str
    state: JobState
    customer: CustomerRow
    device: DeviceRow
    received: date
    place: str
    place_en: str
    plan_toml: str
    bench_toml: str
    standards: tuple[StandardRow, ...]
    operator: PersonRow | None
    verifier: PersonRow | None
    approver: PersonRow | None
    folder: str
    certificate_number: str
    revision: int
    """Counts the certificates laid out for signing; a job sent back after a signature gets the next one."""
    calibrated: date | None
    issued: date | None
    limits_json: str = ""


@dataclass(frozen=True)
class RunRow:
    """A run's start or end, as it happened."""

    utc: str
    what: str
    detail: str


@dataclass(frozen=True)
class ResultRow:
    """A stored result; the newest of a job is its current one, the others stay."""

    id: int
    utc: str
    person: str
    json: str
    sha256: str


@dataclass(frozen=True)
class SignatureRow:
    """A signature on a job's certificate."""

    role: SigningRole
    person: str
    utc: str
    file: str
    sha256: str
    revision: int


@dataclass(frozen=True)
class AuditRow:
    """One act. ``before`` and ``after`` are JSON texts."""

    id: int
    utc: str
    person: str
    action: str
    subject: str
    before: str
    after: str
