"""Records that were tampered with or broke: said in one sentence; and nobody else reads them."""

from __future__ import annotations

import sqlite3
import stat
import sys
from contextlib import closing
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.records.store import Records
from tests.records.conftest import Staff


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has other permissions")
def test_only_the_owner_reads_the_records(tmp_path: Path) -> None:
    path = tmp_path / "records.sqlite"
    path.touch(0o644)
    with Records(path) as records:
        records.people.all()
        modes = {file.name: stat.S_IMODE(file.stat().st_mode) for file in tmp_path.iterdir()}
    assert set(modes.values()) == {0o600}


def test_a_broken_page_is_an_input_error(records: Records, measured: str) -> None:
    records.close()
    data = bytearray(records.path.read_bytes())
    data[4096:] = b"\xa5" * len(data[4096:])
    records.path.write_bytes(data)
    with pytest.raises(InputError, match=r"damaged|not a database"), Records(records.path) as again:
        again.jobs.get(measured)


@pytest.mark.parametrize(
    "statement",
    [
        "update jobs set received = 'no day'",
        "pragma foreign_keys = off; delete from customers",
    ],
)
def test_rows_that_hold_nonsense_are_an_input_error(records: Records, job: str, statement: str) -> None:
    with closing(sqlite3.connect(records.path)) as connection:
        connection.executescript(statement)
        connection.commit()
    with pytest.raises(InputError, match="damaged"):
        records.jobs.get(job)


def test_who_takes_recordings_in_cannot_replace_a_result(records: Records, measured: str) -> None:
    with pytest.raises(PermissionDeniedError):
        records.jobs.add_result(measured, '{"K": 2.0}', records.people.machine_user())
    assert [row.json for row in records.jobs.results(measured)] == ['{"K": 1.0}']


def test_who_takes_recordings_in_stores_the_result_of_a_draft(
    records: Records, staff: Staff, job: str
) -> None:
    records.jobs.add_result(job, '{"K": 1.0}', records.people.machine_user())
    assert len(records.jobs.results(job)) == 1
