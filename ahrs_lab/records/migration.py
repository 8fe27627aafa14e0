"""Records of an older release: backed up, then brought to this release's tables, step by step.

A release that changes the tables adds one step to :data:`STEPS` and counts ``schema.VERSION`` up.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path

from sqlalchemy import Connection, text, update

from ahrs_lab.errors import InputError
from ahrs_lab.records import schema


def _figures_and_limits(connection: Connection) -> None:
    """1 to 2: what a standard's certificate states, the limits of a job, the laboratory's capability."""
    for table, column in (
        ("standards", "figures_json"),
        ("jobs", "limits_json"),
        ("laboratory", "capability_json"),
    ):
        connection.execute(text(f"ALTER TABLE {table} ADD COLUMN {column} TEXT NOT NULL DEFAULT ''"))


def _declared_place(connection: Connection) -> None:
    """2 to 3: what the laboratory declares of its table's place."""
    connection.execute(text("ALTER TABLE laboratory ADD COLUMN place_json TEXT NOT NULL DEFAULT ''"))


STEPS: Mapping[int, Callable[[Connection], None]] = {1: _figures_and_limits, 2: _declared_place}
"""From this version to the next one."""


def migrate(connection: Connection, path: Path, found: int) -> None:
    """Bring the records from version ``found`` to this release's, inside the transaction of ``connection``.

    What they were is kept beside them as ``<name>.version-<found>``. Raises InputError where a step is not
    known.
    """
    if found == schema.VERSION:
        return
    if any(version not in STEPS for version in range(found, schema.VERSION)):
        raise InputError(
            "The records in {path} are of version {found}, which this release cannot bring up to date: "
            "open them with the release before.",
            path=path,
            found=found,
        )
    back_up(path, path.with_name(f"{path.name}.version-{found}"))
    for version in range(found, schema.VERSION):
        STEPS[version](connection)
    connection.execute(update(schema.version).values(number=schema.VERSION))


def back_up(path: Path, target: Path) -> None:
    """A consistent copy of the records as they were last committed; replaces an earlier copy."""
    target.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as source, closing(sqlite3.connect(target)) as copy:
        source.backup(copy)
