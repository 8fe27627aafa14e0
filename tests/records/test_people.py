"""Who works here, and who may do what."""

from __future__ import annotations

import sqlite3
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.records import people
from ahrs_lab.records.rows import PersonRow, SignedIn
from ahrs_lab.records.store import Records
from tests.records.conftest import Staff


class Clock(datetime):
    """A date that stands where the test puts it."""

    at = datetime(2026, 1, 1, tzinfo=UTC)

    @classmethod
    def now(cls, tz: tzinfo | None = None) -> datetime:  # type: ignore[override]
        return cls.at.astimezone(tz)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> type[Clock]:
    monkeypatch.setattr(people, "datetime", Clock)
    monkeypatch.setattr(Clock, "at", datetime(2026, 1, 1, tzinfo=UTC))
    return Clock


def test_the_first_person_has_to_be_an_administrator(records: Records) -> None:
    with pytest.raises(InputError, match="first person"):
        records.people.add(PersonRow(0, "A", roles=frozenset({"operator"})), "x", None)
    added = records.people.add(PersonRow(0, "A", roles=frozenset({"administrator", "operator"})), "x", None)
    assert records.people.all() == (added,)
    with pytest.raises(PermissionDeniedError, match="Sign in first"):
        records.people.add(PersonRow(0, "B", roles=frozenset({"administrator"})), "x", None)


def test_signing_in_takes_name_and_password(records: Records, staff: Staff) -> None:
    assert records.people.sign_in("the operator", "operator-1").person.roles == {"operator"}
    for name, password in (("the operator", "operator-2"), ("nobody", "operator-1"), ("the operator", "")):
        with pytest.raises(PermissionDeniedError, match=r"Name or password is not right\."):
            records.people.sign_in(name, password)


def test_no_password_is_in_the_file_in_plain(records: Records, staff: Staff, tmp_path: Path) -> None:
    content = b"".join(path.read_bytes() for path in tmp_path.glob("records.sqlite*"))
    assert b"the operator" in content
    assert b"operator-1" not in content
    assert b"$argon2id$" in content


def test_hashes_are_argon2id_at_its_recommended_cost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    hashed = people.hash_password("secret")
    # RFC 9106, second recommended option: m = 64 MiB, t = 3, p = 4.
    assert hashed.startswith("$argon2id$v=19$m=65536,t=3,p=4$")


def test_many_wrong_passwords_lock_the_name_for_a_minute(
    records: Records, staff: Staff, clock: type[Clock]
) -> None:
    for _ in range(people.FREE_FAILURES + 1):
        with pytest.raises(PermissionDeniedError, match="not right"):
            records.people.sign_in("the operator", "guess")
    with pytest.raises(PermissionDeniedError, match="wait a minute"):
        records.people.sign_in("the operator", "operator-1")
    records.people.sign_in("the verifier", "verifier-1")
    clock.at += timedelta(seconds=61)
    with pytest.raises(PermissionDeniedError, match="not right"):
        records.people.sign_in("the operator", "guess")
    with pytest.raises(PermissionDeniedError, match="wait a minute"):
        records.people.sign_in("the operator", "operator-1")
    clock.at += timedelta(seconds=61)
    records.people.sign_in("the operator", "operator-1")
    with pytest.raises(PermissionDeniedError, match="not right"):
        records.people.sign_in("the operator", "guess")


def test_a_refused_sign_in_is_in_the_trail(records: Records, staff: Staff) -> None:
    with pytest.raises(PermissionDeniedError):
        records.people.sign_in("the operator", "guess")
    last = records.audit.rows("person the operator")[-1]
    assert (last.action, last.person) == ("sign in refused", "the operator")
    assert "guess" not in last.before + last.after


def test_only_an_administrator_changes_people(records: Records, staff: Staff) -> None:
    row = PersonRow(0, "New", roles=frozenset({"operator"}))
    with pytest.raises(PermissionDeniedError, match="takes the role administrator"):
        records.people.add(row, "x", staff.operator)
    with pytest.raises(PermissionDeniedError):
        records.people.change(replace(staff.operator.person, position="boss"), staff.operator)
    records.people.change(replace(staff.operator.person, position="engineer"), staff.administrator, "new-1")
    assert records.people.sign_in("the operator", "new-1").person.position == "engineer"
    with pytest.raises(InputError, match="already"):
        records.people.add(PersonRow(0, "the operator"), "x", staff.administrator)


def test_the_last_administrator_stays_one(records: Records, staff: Staff) -> None:
    for changed in (
        replace(staff.administrator.person, active=False),
        replace(staff.administrator.person, roles=frozenset({"operator"})),
    ):
        with pytest.raises(InputError, match="last administrator"):
            records.people.change(changed, staff.administrator)


def test_a_role_taken_away_counts_at_once(records: Records, staff: Staff) -> None:
    records.people.change(replace(staff.operator.person, active=False), staff.administrator)
    with pytest.raises(PermissionDeniedError):
        records.people.require(staff.operator, "operator")
    with pytest.raises(PermissionDeniedError, match="not right"):
        records.people.sign_in("the operator", "operator-1")


def test_what_a_caller_says_of_themselves_does_not_count(records: Records, staff: Staff) -> None:
    forged = SignedIn(
        replace(staff.operator.person, roles=frozenset({"administrator"})), staff.operator.token
    )
    with pytest.raises(PermissionDeniedError):
        records.people.require(forged, "administrator")
    machine = records.people.machine_user()
    forged = SignedIn(replace(machine.person, roles=frozenset({"administrator"})), machine.token)
    with pytest.raises(PermissionDeniedError):
        records.people.require(forged, "administrator")


def test_a_sign_in_ends(records: Records, staff: Staff, tmp_path: Path) -> None:
    records.people.sign_out(staff.operator)
    with pytest.raises(PermissionDeniedError, match="Sign in first"):
        records.people.require(staff.operator, "operator")
    with (
        Records(tmp_path / "records.sqlite") as other,
        pytest.raises(PermissionDeniedError, match="Sign in first"),
    ):
        other.people.require(staff.verifier, "verifier")


def test_an_empty_password_or_name_and_an_unknown_role_are_refused(records: Records, staff: Staff) -> None:
    with pytest.raises(InputError, match="password"):
        records.people.add(PersonRow(0, "New"), "", staff.administrator)
    with pytest.raises(InputError, match="name"):
        records.people.add(PersonRow(0, " "), "x", staff.administrator)
    with pytest.raises(InputError, match="importer is not a role"):
        records.people.add(PersonRow(0, "New", roles=frozenset({"importer"})), "x", staff.administrator)


def test_the_hash_is_nowhere_but_in_its_column(records: Records, staff: Staff, tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "records.sqlite") as connection:
        told = connection.execute("SELECT before || after FROM audit").fetchall()
    connection.close()
    assert not any("argon2" in text for (text,) in told)
