"""Who works here: people, their roles, signing in. Passwords are kept as argon2 hashes only."""

from __future__ import annotations

import getpass
import secrets
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from functools import cache
from typing import TYPE_CHECKING, Any

from sqlalchemy import Row, insert, select, update

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.messages import Message
from ahrs_lab.records import audit, schema
from ahrs_lab.records.rows import ROLES, PersonRow, Role, SignedIn

if TYPE_CHECKING:
    from argon2 import PasswordHasher

    from ahrs_lab.records.store import Records

FREE_FAILURES = 5
"""So many wrong passwords in a row cost nothing; each further one locks the name for a while."""
LOCK = timedelta(minutes=1)
_MACHINE_USER = -1

ROLE_NAMES: dict[str, Message] = {
    "operator": Message("operator"),
    "verifier": Message("verifier"),
    "approver": Message("approver"),
    "administrator": Message("administrator"),
    "importer": Message("importer"),
}


@cache
def _hasher() -> PasswordHasher:
    from argon2 import PasswordHasher

    return PasswordHasher()


@cache
def _hash_of_nobody() -> str:
    """Checked where the name is unknown, so that the answer takes as long as for a known one."""
    return _hasher().hash(secrets.token_hex(16))


class People:
    """The desk of ``records.people``."""

    def __init__(self, records: Records) -> None:
        self._records = records
        self._sessions: dict[str, PersonRow] = {}

    def all(self) -> tuple[PersonRow, ...]:
        """Everybody, also who has left."""
        with self._records.reading() as connection:
            return tuple(person(row) for row in connection.execute(select(schema.people)))

    def add(self, row: PersonRow, password: str, actor: SignedIn | None) -> PersonRow:
        """Add somebody; by an administrator, or, as the very first person, by nobody."""
        _check(row)
        with self._records.writing() as connection:
            if connection.execute(select(schema.people.c.id).limit(1)).first() is not None:
                who = self.require(actor, "administrator").name
            elif "administrator" in row.roles:
                who = "(first start)"
            else:
                raise InputError("The first person has to be an administrator: nobody could add the others.")
            taken = select(schema.people.c.id).where(schema.people.c.name == row.name)
            if connection.execute(taken).first() is not None:
                raise InputError("{name} is in the records already.", name=row.name)
            values = {**_values(row), "password_hash": hash_password(password)}
            key = connection.execute(insert(schema.people).values(**values)).inserted_primary_key
            audit.write(connection, who, "add person", f"person {row.name}", after=_values(row))
            found = connection.execute(
                select(schema.people).where(schema.people.c.id == (key or (0,))[0])
            ).one()
        return person(found)

    def found(self, rows: Sequence[PersonRow], password: str) -> tuple[SignedIn, tuple[PersonRow, ...]]:
        """The first people of an empty laboratory, an administrator first, who is signed in.

        All with one ``password``, and so with one hash: for a demonstration, whose password is published.
        """
        if not rows or "administrator" not in rows[0].roles:
            raise InputError("The first person has to be an administrator: nobody could add the others.")
        hashed = hash_password(password)
        with self._records.writing() as connection:
            if connection.execute(select(schema.people.c.id).limit(1)).first() is not None:
                raise InputError("There are people in the records already.")
            for row in rows:
                _check(row)
                connection.execute(insert(schema.people).values(**_values(row), password_hash=hashed))
                audit.write(
                    connection, "(first start)", "add person", f"person {row.name}", after=_values(row)
                )
            made = connection.execute(select(schema.people).order_by(schema.people.c.id)).all()
            audit.write(connection, rows[0].name, "sign in", f"person {rows[0].name}")
        people = tuple(person(row) for row in made)
        return self._session(people[0]), people

    def change(self, row: PersonRow, actor: SignedIn, password: str | None = None) -> None:
        """Change somebody's facts, or their password; by an administrator. The last of them stays one."""
        who = self.require(actor, "administrator").name
        _check(row)
        with self._records.writing() as connection:
            table = schema.people
            before = connection.execute(select(table).where(table.c.id == row.id)).one_or_none()
            if before is None:
                raise InputError("{name} is not in the records.", name=row.name)
            others = connection.execute(select(table).where(table.c.id != row.id, table.c.active)).all()
            if not (row.active and "administrator" in row.roles) and not any(
                "administrator" in person(other).roles for other in others
            ):
                raise InputError(
                    "{name} is the last administrator: make somebody else one first.", name=row.name
                )
            values = _values(row) | ({"password_hash": hash_password(password)} if password else {})
            connection.execute(update(table).where(table.c.id == row.id).values(**values))
            audit.write(
                connection,
                who,
                "change person",
                f"person {row.name}",
                _values(person(before)),
                {**_values(row), "password": "changed" if password else "kept"},
            )

    def sign_in(self, name: str, password: str) -> SignedIn:
        """Raises PermissionDeniedError for an unknown name or a wrong password, without saying which."""
        refused = PermissionDeniedError("Name or password is not right.")
        table = schema.people
        with self._records.writing() as connection:
            row = connection.execute(select(table).where(table.c.name == name)).one_or_none()
            now = datetime.now(UTC)
            if row is not None and row.locked_until and now < datetime.fromisoformat(row.locked_until):
                raise PermissionDeniedError(
                    "Too many wrong passwords for {name}: wait a minute and try again.", name=name
                )
            right = _matches(row.password_hash if row is not None else _hash_of_nobody(), password)
            if row is None or not row.active:
                raise refused
            failures = 0 if right else row.failures + 1
            locked = (now + LOCK).isoformat() if failures > FREE_FAILURES else ""
            connection.execute(
                update(table).where(table.c.id == row.id).values(failures=failures, locked_until=locked)
            )
            audit.write(connection, name, "sign in" if right else "sign in refused", f"person {name}")
        if not right:
            raise refused
        return self._session(person(row))

    def _session(self, row: PersonRow) -> SignedIn:
        signed_in = SignedIn(row, secrets.token_urlsafe(24))
        self._sessions[signed_in.token] = row
        return signed_in

    def machine_user(self) -> SignedIn:
        """The machine's user at the command line, where nobody signs in: may only take recordings in."""
        row = PersonRow(_MACHINE_USER, f"{getpass.getuser()} (command line)", roles=frozenset({"importer"}))
        return self._session(row)

    def sign_out(self, signed_in: SignedIn) -> None:
        """The token counts no longer."""
        self._sessions.pop(signed_in.token, None)

    def sign_out_all(self) -> None:
        """No token counts any longer."""
        self._sessions.clear()

    def require(self, actor: SignedIn | None, *roles: Role) -> PersonRow:
        """The acting person as the database knows them now, whatever ``actor`` says of them; raises
        PermissionDeniedError without one of ``roles``."""
        found = self._sessions.get(actor.token) if actor is not None else None
        if found is None:
            raise PermissionDeniedError("Sign in first.")
        if found.id != _MACHINE_USER:
            with self._records.reading() as connection:
                query = select(schema.people).where(schema.people.c.id == found.id)
                found = person(connection.execute(query).one())
        if not found.active or (roles and not found.roles & set(roles)):
            raise PermissionDeniedError(
                "{name} may not do this: it takes the role {role}.",
                name=found.name,
                role=ROLE_NAMES[roles[0]] if roles else "",
            )
        return found


def person(row: Row[Any]) -> PersonRow:
    """A row of the table as the room's own type."""
    return PersonRow(
        id=row.id,
        name=row.name,
        name_en=row.name_en,
        position=row.position,
        position_en=row.position_en,
        roles=frozenset(role for role in ROLES if role in row.roles.split()),
        active=row.active,
    )


def hash_password(password: str) -> str:
    """The argon2id hash; refuses an empty password."""
    if not password:
        raise InputError("A password is needed.")
    return _hasher().hash(password)


def _matches(stored: str, password: str) -> bool:
    from argon2.exceptions import InvalidHashError, VerificationError

    try:
        return _hasher().verify(stored, password)
    except (VerificationError, InvalidHashError):
        return False


def _check(row: PersonRow) -> None:
    if not row.name.strip():
        raise InputError("A person needs a name.")
    unknown = set(row.roles) - set(ROLES)
    if unknown:
        raise InputError("{role} is not a role.", role=", ".join(sorted(unknown)))


def _values(row: PersonRow) -> dict[str, Any]:
    return {
        "name": row.name,
        "name_en": row.name_en,
        "position": row.position,
        "position_en": row.position_en,
        "roles": " ".join(role for role in ROLES if role in row.roles),
        "active": row.active,
    }
