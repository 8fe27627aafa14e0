"""A laboratory with an administrator and three people who measure, verify and approve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path

import pytest
from argon2 import PasswordHasher

from ahrs_lab.records import people
from ahrs_lab.records.rows import CustomerRow, DeviceRow, JobDraft, PersonRow, Role, SignedIn, StandardRow
from ahrs_lab.records.store import Records


@dataclass
class Staff:
    """Everybody signed in."""

    administrator: SignedIn
    operator: SignedIn
    verifier: SignedIn
    approver: SignedIn


@pytest.fixture(autouse=True)
def quick_hashes(monkeypatch: pytest.MonkeyPatch) -> None:
    """argon2 as weak as it goes: its cost is not what these tests are about."""
    monkeypatch.setattr(people, "_hasher", lambda: PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))


@pytest.fixture
def records(tmp_path: Path) -> Iterator[Records]:
    with Records(tmp_path / "records.sqlite") as opened:
        yield opened


@pytest.fixture
def staff(records: Records) -> Staff:
    records.people.add(PersonRow(0, "管理", roles=frozenset({"administrator"})), "admin-1", None)
    administrator = records.people.sign_in("管理", "admin-1")
    signed_in: dict[Role, SignedIn] = {}
    roles: tuple[Role, ...] = ("operator", "verifier", "approver")
    for role in roles:
        records.people.add(PersonRow(0, f"the {role}", roles=frozenset({role})), f"{role}-1", administrator)
        signed_in[role] = records.people.sign_in(f"the {role}", f"{role}-1")
    return Staff(administrator, signed_in["operator"], signed_in["verifier"], signed_in["approver"])


def draft(staff: Staff, received: date = date(2026, 3, 1)) -> JobDraft:
    """A job with everybody assigned."""
    return JobDraft(
        customer=CustomerRow(0, "北京某研究所", "An institute"),
        device=DeviceRow(0, "航姿仪", model="VN-100", serial_number="7"),
        received=received,
        plan_toml='name = "JJF"',
        operator_id=staff.operator.person.id,
        verifier_id=staff.verifier.person.id,
        approver_id=staff.approver.person.id,
    )


@pytest.fixture
def job(records: Records, staff: Staff) -> str:
    return records.jobs.create(draft(staff), staff.operator)


@pytest.fixture
def measured(records: Records, staff: Staff, job: str) -> str:
    """A job whose run is done and whose result is stored."""
    records.jobs.move(job, "ready", staff.operator)
    records.jobs.move(job, "running", staff.operator)
    records.jobs.add_result(job, '{"K": 1.0}', staff.operator)
    records.jobs.move(job, "measured", staff.operator)
    return job


def standard(records: Records, staff: Staff, certificate: str = "C-1") -> StandardRow:
    row = StandardRow(0, "table", "Rate table", "转台", certificate_number=certificate, due=date(2027, 1, 1))
    return records.registry.save_standard(row, staff.operator)


def choosing(wanted: JobDraft, *rows: StandardRow) -> JobDraft:
    return replace(wanted, standard_ids=tuple(row.id for row in rows))
