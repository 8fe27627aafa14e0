"""The database file: what is acknowledged stays, what is appended stays as it is, trouble is said plainly."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import Connection, text

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.records import migration, schema, store
from ahrs_lab.records.rows import LaboratoryRow
from ahrs_lab.records.store import Records
from tests.records.conftest import Staff


def raw(path: Path) -> closing[sqlite3.Connection]:
    """The file as somebody with another program sees it."""
    return closing(sqlite3.connect(path, isolation_level=None))


def test_it_is_opened_for_keeping(records: Records) -> None:
    with records.reading() as connection:
        values = {
            name: connection.execute(text(f"PRAGMA {name}")).scalar()
            for name in ("journal_mode", "synchronous", "foreign_keys")
        }
    assert values == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1}


def test_what_was_stored_is_there_again(
    records: Records, staff: Staff, measured: str, tmp_path: Path
) -> None:
    before = records.jobs.get(measured), records.jobs.results(measured), records.audit.rows()
    records.close()
    with Records(tmp_path / "records.sqlite") as again:
        assert (again.jobs.get(measured), again.jobs.results(measured), again.audit.rows()) == before
        assert again.audit.verify() == ()


@pytest.mark.parametrize("table", ["runs", "results", "signatures", "audit"])
@pytest.mark.parametrize(
    "statement",
    ["UPDATE {t} SET utc = 'x'", "DELETE FROM {t}", "INSERT OR REPLACE INTO {t} SELECT * FROM {t}"],
)
def test_the_database_refuses_to_change_what_is_append_only(
    records: Records, staff: Staff, measured: str, tmp_path: Path, table: str, statement: str
) -> None:
    records.jobs.add_run_event(measured, "started")
    records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "1" * 64)
    with raw(tmp_path / "records.sqlite") as connection:
        before = connection.execute(f"SELECT * FROM {table}").fetchall()
        assert before
        with pytest.raises(sqlite3.IntegrityError, match="append-only"):
            connection.execute(statement.format(t=table))
        assert connection.execute(f"SELECT * FROM {table}").fetchall() == before


def tamper(path: Path, statement: str) -> None:
    """As somebody does who knows the database: without its triggers."""
    with raw(path) as connection:
        for trigger in schema.append_only_triggers():
            connection.execute(f"DROP TRIGGER {trigger.split()[5]}")
        connection.execute(statement)


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("UPDATE audit SET person = 'somebody else' WHERE id = 3", "row 3 does not follow"),
        ("UPDATE audit SET utc = '2020-01-01' WHERE id = 1", "row 1 does not follow"),
        ("DELETE FROM audit WHERE id = 2", "row 3 does not follow"),
        ("UPDATE results SET json = '{\"K\": 1.5}'", "A result of job 2026-0001 was changed"),
        (
            "DELETE FROM audit WHERE id >= (SELECT id FROM audit WHERE action = 'add result')",
            "A result of job",
        ),
        ("UPDATE signatures SET sha256 = 'x'", "A signature of job 2026-0001 was changed"),
        (
            "INSERT INTO results (job_id, utc, person, json, sha256) VALUES (1, '', '', '', 'x')",
            "A result of job",
        ),
    ],
)
def test_a_change_past_the_triggers_is_found(
    records: Records, staff: Staff, measured: str, tmp_path: Path, statement: str, words: str
) -> None:
    records.jobs.add_signature(measured, "operator", staff.operator, "c.pdf", "1" * 64)
    assert records.audit.verify() == ()
    assert records.audit.first_broken() is None
    tamper(tmp_path / "records.sqlite", statement)
    assert any(words in str(message) for message in records.audit.verify())


def test_every_act_is_in_the_trail_with_what_it_changed(
    records: Records, staff: Staff, measured: str
) -> None:
    acts = records.audit.rows(f"job {measured}")
    assert [row.action for row in acts] == ["create job", "move job", "move job", "add result", "move job"]
    assert {row.person for row in acts} == {"the operator"}
    assert all(row.utc.endswith("+00:00") for row in acts)
    assert json.loads(acts[0].after)["customer"]["name"] == "北京某研究所"
    assert (json.loads(acts[1].before), json.loads(acts[1].after)) == ("draft", {"to": "ready", "why": ""})


def test_an_act_that_fails_leaves_nothing(
    records: Records, staff: Staff, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("in the middle")

    monkeypatch.setattr("ahrs_lab.records.audit.write", fails)
    with pytest.raises(RuntimeError, match="in the middle"):
        records.registry.set_laboratory(LaboratoryRow("x"), staff.administrator)
    assert records.registry.laboratory() is None


CHILD = """
import sys
from pathlib import Path
from ahrs_lab.records.rows import LaboratoryRow, PersonRow
from ahrs_lab.records.store import Records
records = Records(Path(sys.argv[1]))
records.people.add(PersonRow(0, "A", roles=frozenset({"administrator"})), "x", None)
actor = records.people.sign_in("A", "x")
for count in range(100000):
    records.registry.set_laboratory(LaboratoryRow(str(count)), actor)
    print(count, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_kill_loses_no_acknowledged_row(tmp_path: Path) -> None:
    path = tmp_path / "records.sqlite"
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, str(path)],
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
    )
    assert child.stdout is not None
    for _ in range(50):
        told = int(child.stdout.readline())
    os.kill(child.pid, signal.SIGKILL)
    told = int([str(told), *child.stdout.read().split()][-1])
    child.wait()
    child.stdout.close()
    with Records(path) as records:
        kept = records.registry.laboratory()
        assert kept is not None
        assert int(kept.name) in (told, told + 1)
        assert records.audit.verify() == ()


def test_two_programs_write_one_after_the_other(records: Records, staff: Staff, tmp_path: Path) -> None:
    with Records(tmp_path / "records.sqlite") as other:
        actor = other.people.sign_in("管理", "admin-1")
        for count in range(5):
            records.registry.set_laboratory(LaboratoryRow(f"a{count}"), staff.administrator)
            other.registry.set_laboratory(LaboratoryRow(f"b{count}"), actor)
        assert records.registry.laboratory() == LaboratoryRow("b4")
        assert records.audit.verify() == ()


def test_records_that_another_program_holds_are_named(
    records: Records, staff: Staff, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store, "_BUSY_MS", 50)
    with raw(tmp_path / "records.sqlite") as connection:
        connection.execute("BEGIN IMMEDIATE")
        with pytest.raises(MachineError, match=r"locked.*Close other programs"):
            records.registry.set_laboratory(LaboratoryRow("x"), staff.administrator)
        assert records.registry.laboratory() is None
        with pytest.raises(MachineError, match="locked"):
            Records(tmp_path / "records.sqlite")


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(MachineError, match="cannot be used"):
        Records(tmp_path / "nowhere" / "records.sqlite")


def test_what_is_no_database_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "records.sqlite"
    path.write_bytes(b"a letter to grandmother" * 100)
    with pytest.raises(InputError, match="not a database of records"):
        Records(path)
    assert path.read_bytes().startswith(b"a letter")


def test_another_programs_database_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "records.sqlite"
    with raw(path) as connection:
        connection.execute("CREATE TABLE songs (name TEXT)")
    with pytest.raises(InputError, match="not a database of records"):
        Records(path)
    with raw(path) as connection:
        assert connection.execute("SELECT name FROM sqlite_master").fetchall() == [("songs",)]


def test_a_path_with_odd_characters_works(tmp_path: Path) -> None:
    folder = tmp_path / "档案 100% a?b#c"
    folder.mkdir()
    Records(folder / "records.sqlite").close()
    assert (folder / "records.sqlite").is_file()


def test_a_newer_releases_records_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "records.sqlite"
    Records(path).close()
    with raw(path) as connection:
        connection.execute("UPDATE version SET number = 99")
    with pytest.raises(InputError, match="newer release"):
        Records(path)


def test_older_records_are_backed_up_and_brought_up_to_date(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "records.sqlite"
    Records(path).close()

    def add_telephone(connection: Connection) -> None:
        connection.execute(text("ALTER TABLE customers ADD COLUMN telephone TEXT"))

    monkeypatch.setattr(schema, "VERSION", schema.VERSION + 1)
    with pytest.raises(InputError, match="cannot bring up to date"):
        Records(path)
    monkeypatch.setattr(migration, "STEPS", {schema.VERSION - 1: add_telephone})
    Records(path).close()
    Records(path).close()

    def columns(file: Path) -> list[str]:
        with raw(file) as connection:
            return [row[1] for row in connection.execute("PRAGMA table_info(customers)")]

    assert "telephone" in columns(path)
    backup = tmp_path / f"records.sqlite.version-{schema.VERSION - 1}"
    assert "telephone" not in columns(backup)
    with raw(path) as connection:
        assert connection.execute("SELECT number FROM version").fetchall() == [(schema.VERSION,)]


def test_a_migration_that_fails_leaves_the_records_as_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "records.sqlite"
    Records(path).close()
    old = schema.VERSION

    def fails(connection: Connection) -> None:
        connection.execute(text("ALTER TABLE customers ADD COLUMN telephone TEXT"))
        raise RuntimeError("half-way")

    with monkeypatch.context() as patch:
        patch.setattr(schema, "VERSION", old + 1)
        patch.setattr(migration, "STEPS", {old: fails})
        with pytest.raises(RuntimeError, match="half-way"):
            Records(path)
    Records(path).close()
