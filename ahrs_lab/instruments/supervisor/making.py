"""Drivers and wires of the supervised instruments, out of the same TOML as the application's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.links.tcp_link import TcpLink
from ahrs_lab.instruments.registry import Drivers, LinkMaker, Surroundings, create_instrument
from ahrs_lab.instruments.supervisor.relay import HOST


class RelayedLink(TcpLink):
    """The table's wire through the relay; tells the line rate of the wire behind it, by which drivers correct
    their times."""

    def __init__(self, port: int, behind: Link) -> None:
        super().__init__(HOST, port)
        self._behind = behind

    @property
    def name(self) -> str:
        """Of the wire behind."""
        return self._behind.name

    @property
    def bits_per_second(self) -> int | None:
        """Of the wire behind."""
        return self._behind.bits_per_second


def relayed(port: int) -> LinkMaker:
    """What makes links that lead through the relay at ``port``."""

    def make(settings: LinkSettings, *, default_port: int = 0) -> Link:
        return RelayedLink(port, make_link(settings, default_port=default_port))

    return make


def table_wire(table: Mapping[str, Any], clock: Clock, drivers: Drivers | None = None) -> Link | None:
    """The wire that the driver of a bench file's ``[table]`` asks for, not yet open; None for one that needs
    none, like a table set by hand. Raises InputError."""
    made: list[Link] = []

    def make(settings: LinkSettings, *, default_port: int = 0) -> Link:
        made.append(make_link(settings, default_port=default_port))
        return made[-1]

    create_instrument("table", table, Surroundings(clock, make), drivers)
    return made[0] if made else None


def make_table(table: Mapping[str, Any], port: int, clock: Clock) -> Any:
    """The table's driver on the relay's ``port``, not yet open. Raises InputError."""
    return create_instrument("table", table, Surroundings(clock, relayed(port)))


def make_supply(supply: Mapping[str, Any], clock: Clock) -> Any:
    """The supply's driver on a wire of its own, not yet open. Raises InputError."""
    return create_instrument("supply", supply, Surroundings(clock))
