"""Which drivers there are: those of the house and of third parties, found by entry points.

A package that brings a driver names a :class:`Driver` in the group ``ahrs_lab.instruments``::

    [project.entry-points."ahrs_lab.instruments"]
    table-acme = "acme_tables:DRIVER"

What a bench file says of an instrument is a table with ``driver`` and the settings of that driver.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Literal, Protocol

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.settings import settings_from_toml
from ahrs_lab.messages import Message

GROUP = "ahrs_lab.instruments"

Kind = Literal["table", "ahrs", "supply", "room"]


class Instrument(Protocol):
    """What every driver has besides the interface of its kind."""

    def open(self) -> str:
        """Connect; who answered. Raises InstrumentError."""
        ...

    def close(self) -> None: ...
    def identify(self) -> str: ...


class LinkMaker(Protocol):
    """Makes the link of an instrument, not yet open."""

    def __call__(self, settings: LinkSettings, *, default_port: int = 0) -> Link: ...


@dataclass(frozen=True)
class Surroundings:
    """What a driver gets besides its settings. ``link`` may wrap or replace what the settings name."""

    clock: Clock
    link: LinkMaker = make_link


@dataclass(frozen=True)
class Driver:
    """One kind of instrument. ``settings``: a frozen dataclass; ``create`` makes the driver from an instance
    of it without opening anything. ``experimental``: never run on the hardware by us."""

    kind: Kind
    name: str
    title: Message
    settings: type[Any]
    create: Callable[[Any, Surroundings], Any]
    experimental: bool = False


@dataclass(frozen=True)
class Drivers:
    """All there are; ``broken`` tells of those that could not be loaded."""

    found: Mapping[tuple[Kind, str], Driver]
    broken: tuple[Message, ...] = ()

    def of(self, kind: Kind) -> tuple[Driver, ...]:
        """The drivers of a kind, by name."""
        return tuple(driver for (its, _), driver in sorted(self.found.items()) if its == kind)

    def get(self, kind: Kind, name: str) -> Driver:
        """Raises InputError where there is none of that name."""
        driver = self.found.get((kind, name))
        if driver is not None:
            return driver
        known = [entry.name for entry in self.of(kind)]
        close = difflib.get_close_matches(name, known, 1)
        reason = Message("did you mean “{close}”?", close=close[0]) if close else Message("")
        if self.broken:
            reason = self.broken[0]
        raise InputError(
            "There is no driver “{name}” for {kind}; there are: {known}. {reason}",
            name=name,
            kind=kind,
            known=", ".join(known) or "–",
            reason=reason,
        )


def find_drivers(points: Iterable[EntryPoint] | None = None) -> Drivers:
    """Load every entry point of the group. One that fails is told of and does not keep the others away; of
    two with the same kind and name the first counts."""
    found: dict[tuple[Kind, str], Driver] = {}
    broken: list[Message] = []
    for point in entry_points(group=GROUP) if points is None else points:
        try:
            driver = point.load()
        except Exception as error:  # third parties' code may raise whatever it likes
            broken.append(_broken(point, f"{type(error).__name__}: {error}"))
            continue
        if not isinstance(driver, Driver):
            broken.append(_broken(point, "it is no ahrs_lab.instruments.registry.Driver"))
        elif (driver.kind, driver.name) in found:
            if found[driver.kind, driver.name] is not driver:
                broken.append(_broken(point, f"there is already a {driver.kind} {driver.name}"))
        else:
            found[driver.kind, driver.name] = driver
    return Drivers(found, tuple(broken))


def create_instrument(
    kind: Kind, table: Mapping[str, Any], surroundings: Surroundings, drivers: Drivers | None = None
) -> Any:
    """The instrument that a bench file's table describes, not yet open. Raises InputError."""
    settings = dict(table)
    name = settings.pop("driver", None)
    if not isinstance(name, str):
        raise InputError("[{kind}] does not say which “driver” it needs.", kind=kind)
    driver = (find_drivers() if drivers is None else drivers).get(kind, name)
    return driver.create(settings_from_toml(driver.settings, settings, kind), surroundings)


def _broken(point: EntryPoint, reason: str) -> Message:
    return Message(
        "The driver {name} ({value}) cannot be loaded: {reason}.",
        name=point.name,
        value=point.value,
        reason=reason,
    )
