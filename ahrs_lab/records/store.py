"""The database file: opening it safely, its version, its transactions."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event, insert, inspect, select, text
from sqlalchemy.exc import DatabaseError, IntegrityError, NoResultFound, OperationalError
from sqlalchemy.pool import NullPool

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.records import schema
from ahrs_lab.records.audit import Audit
from ahrs_lab.records.jobs import Jobs
from ahrs_lab.records.migration import migrate
from ahrs_lab.records.people import People
from ahrs_lab.records.registry import Registry

_BUSY_MS = 5000


class Records:
    """The laboratory's records in one SQLite file; made where it does not exist.

    Raises InputError where the file belongs to a newer release or is no database of records, MachineError
    where the machine does not let us.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._engine = _engine(path)
        with said_plainly(path):
            _for_the_owner_only(path)
            self._prepare()
        self.audit = Audit(self)
        self.people = People(self)
        self.registry = Registry(self)
        self.jobs = Jobs(self)

    def __enter__(self) -> Records:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Forget the sign-ins and let the file go."""
        self.people.sign_out_all()
        self._engine.dispose()

    def _prepare(self) -> None:
        with self._engine.execution_options(immediate=True).begin() as connection:
            inspector = inspect(connection)
            if inspector.has_table(schema.version.name):
                found = connection.execute(select(schema.version.c.number)).scalar_one_or_none()
            elif not inspector.get_table_names():
                schema.metadata.create_all(connection)
                connection.execute(insert(schema.version).values(number=schema.VERSION))
                for trigger in schema.append_only_triggers():
                    connection.execute(text(trigger))
                return
            else:
                found = None
            if found is None:
                raise InputError("{path} is not a database of records.", path=self.path)
            if found > schema.VERSION:
                raise InputError(
                    "The records in {path} were written by a newer release "
                    "(version {found}, this one knows {known}): "
                    "use that release, or restore a backup.",
                    path=self.path,
                    found=found,
                    known=schema.VERSION,
                )
            migrate(connection, self.path, found)

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """One transaction: all of it on the disk at the end, or nothing."""
        with said_plainly(self.path), self._engine.execution_options(immediate=True).begin() as connection:
            yield connection

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A consistent look."""
        with said_plainly(self.path), self._engine.connect() as connection:
            try:
                yield connection
            except (NoResultFound, ValueError) as error:
                # A row that points nowhere, a text that is none: nothing in here writes such.
                raise _damaged(self.path, error) from error


def _for_the_owner_only(path: Path) -> None:
    """Password hashes and customers are in it; what SQLite puts beside it takes over who may read it."""
    with suppress(OSError):  # what stands in the way, SQLite meets next
        path.touch(mode=0o600)
        path.chmod(0o600)


@contextmanager
def said_plainly(path: Path) -> Iterator[None]:
    """What SQLite refuses, in words for a person."""
    try:
        yield
    except UnicodeDecodeError as error:  # of a name in the database's own schema
        raise _damaged(path, error) from error
    except OperationalError as error:
        raise MachineError(
            "The records {path} cannot be used ({reason}). Close other programs that hold them and see that "
            "the disk is writable and not full.",
            path=path,
            reason=str(error.orig),
        ) from error
    except DatabaseError as error:
        if "not a database" in str(error.orig):
            raise InputError("{path} is not a database of records.", path=path) from error
        if isinstance(error, IntegrityError):
            raise
        raise _damaged(path, error.orig) from error


def _damaged(path: Path, reason: object) -> InputError:
    return InputError(
        "The records {path} are damaged ({reason}): restore a backup.", path=path, reason=str(reason)
    )


def _engine(path: Path) -> Engine:
    # Not as text: a path may hold what a URL takes for something else.
    engine = create_engine(URL.create("sqlite", database=str(path)), poolclass=NullPool)

    @event.listens_for(engine, "connect")
    def _connected(connection: Any, _record: object) -> None:
        connection.isolation_level = None
        for pragma in (f"busy_timeout={_BUSY_MS}", "journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def _begun(connection: Connection) -> None:
        # A writer takes the lock at once: two of them wait for each other and never meet half-way.
        immediate = connection.get_execution_options().get("immediate", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if immediate else "BEGIN")

    return engine
