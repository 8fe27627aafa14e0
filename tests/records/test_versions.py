"""Records that an earlier release wrote: opened, brought up to date, nothing lost."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest

from ahrs_lab.records import schema
from ahrs_lab.records.rows import LaboratoryRow, StandardRow
from ahrs_lab.records.store import Records
from tests.records.conftest import Staff, choosing, draft, standard

STANDARD = StandardRow(
    1, "table", "Rate table", "转台", certificate_number="C-2025", due=date(2027, 1, 1), figures_json=""
)


@pytest.fixture
def version_1(tmp_path: Path) -> Path:
    """What version 1 left behind: a laboratory, a measured job with a signature, a job that is ready."""
    path = tmp_path / "records.sqlite"
    script = Path(__file__).with_name("version_1.sql").read_text(encoding="utf-8")
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript(script)
    return path


def columns(path: Path, table: str) -> set[str]:
    with closing(sqlite3.connect(path)) as connection:
        return {row[1] for row in connection.execute(f"PRAGMA table_info({table})")}


def test_version_1_keeps_everything(version_1: Path) -> None:
    with Records(version_1) as records:
        assert records.registry.laboratory() == LaboratoryRow("校准实验室", "Laboratory", capability_json="")
        measured, ready = records.jobs.get("2026-0001"), records.jobs.get("2026-0002")
        assert (measured.state, ready.state) == ("measured", "ready")
        assert measured.standards == (STANDARD,)
        assert ready.standards == (replace(STANDARD, certificate_number="C-2026"),)
        assert (measured.limits_json, measured.plan_toml) == ("", 'name = "JJF"')
        assert [row.json for row in records.jobs.results("2026-0001")] == ['{"K": 1.0}']
        assert [row.role for row in records.jobs.signatures("2026-0001")] == ["operator"]
        assert len(records.audit.rows()) == 24
        assert records.audit.verify() == ()


def test_version_1_is_backed_up_and_has_this_versions_columns(version_1: Path) -> None:
    Records(version_1).close()
    backup = version_1.with_name("records.sqlite.version-1")
    for table in schema.metadata.tables.values():
        assert columns(version_1, table.name) == {column.name for column in table.columns}
    assert "figures_json" not in columns(backup, "standards")
    assert "limits_json" not in columns(backup, "jobs")
    assert not {"capability_json", "place_json"} & columns(backup, "laboratory")


@pytest.fixture
def version_2(version_1: Path) -> Path:
    """What version 2 left behind: version 1's tables and what its step added, with the laboratory's
    capability."""
    with closing(sqlite3.connect(version_1)) as connection:
        for table, column in (
            ("standards", "figures_json"), ("jobs", "limits_json"), ("laboratory", "capability_json")
        ):  # fmt: skip
            connection.execute(f"ALTER TABLE {table} ADD COLUMN {column} TEXT NOT NULL DEFAULT ''")
        connection.execute("UPDATE laboratory SET capability_json = '{}'")
        connection.execute("UPDATE version SET number = 2")
        connection.commit()
    return version_1


def test_version_2_declares_nothing_of_its_place_and_can(version_2: Path) -> None:
    before = LaboratoryRow("校准实验室", "Laboratory", capability_json="{}", place_json="")
    declared = replace(before, place_json='{"earth_resistance_ohm": 1.0}')
    with Records(version_2) as records:
        assert records.registry.laboratory() == before
        administrator = records.people.sign_in("管理", "admin-1")
        records.registry.set_laboratory(declared, administrator)
    with Records(version_2) as records:
        assert records.registry.laboratory() == declared
        assert "earth_resistance_ohm" in records.audit.rows("laboratory")[-1].after
        assert records.audit.verify() == ()
    assert "place_json" not in columns(version_2.with_name("records.sqlite.version-2"), "laboratory")


def test_version_1_is_worked_on(version_1: Path) -> None:
    with Records(version_1) as records:
        operator = records.people.sign_in("the operator", "operator-1")
        (row,) = records.registry.standards()
        stated = replace(row, figures_json='[{"figure": "wobble_arcsec"}]')
        records.registry.save_standard(stated, operator)
        assert records.registry.standards() == (stated,)
        records.jobs.move("2026-0002", "running", operator)
        records.jobs.move("2026-0002", "measured", operator)
        records.registry.save_standard(replace(stated, figures_json=""), operator)
        assert records.jobs.get("2026-0002").standards == (stated,)
        # The job of version 1 was measured without figures; none are ascribed to it afterwards.
        assert records.jobs.get("2026-0001").standards[0].figures_json == ""
        assert records.audit.verify() == ()


def test_figures_are_those_of_the_day_it_was_measured(records: Records, staff: Staff) -> None:
    stated = replace(standard(records, staff), figures_json='["of 2025"]')
    records.registry.save_standard(stated, staff.operator)
    number = records.jobs.create(choosing(draft(staff), stated), staff.operator)
    records.jobs.move(number, "ready", staff.operator)
    records.jobs.move(number, "running", staff.operator)
    records.jobs.move(number, "measured", staff.operator)
    records.registry.save_standard(replace(stated, figures_json='["of 2026"]'), staff.operator)
    assert records.jobs.get(number).standards == (stated,)
    before, after = records.audit.rows("standards 1")[-1].before, records.audit.rows("standards 1")[-1].after
    assert "of 2025" in before
    assert "of 2026" in after


def test_a_jobs_limits_are_kept_and_their_change_is_in_the_trail(records: Records, staff: Staff) -> None:
    limits = '{"scale_factor": 0.1}'
    number = records.jobs.create(replace(draft(staff), limits_json=limits), staff.operator)
    assert records.jobs.get(number).limits_json == limits
    records.jobs.change(number, draft(staff), staff.operator)
    assert records.jobs.get(number).limits_json == ""
    assert "scale_factor" in records.audit.rows(f"job {number}")[-1].before
