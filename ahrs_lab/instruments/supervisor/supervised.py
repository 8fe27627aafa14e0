"""The instruments of a bench as the supervisor needs them: the table's wire now, the drivers when it comes to
stopping."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol, cast

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.drivers.tables.polled_table import PolledTable
from ahrs_lab.instruments.interfaces import Clock, RateTable, Supply
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.registry import Instrument
from ahrs_lab.instruments.supervisor.making import make_supply, make_table, table_wire
from ahrs_lab.messages import Message

_TRIES = 3


class Charged(Protocol):
    """What was entrusted, see :class:`~ahrs_lab.instruments.supervisor.supervisor.Charge`."""

    @property
    def table(self) -> Mapping[str, Any] | None: ...
    @property
    def supply(self) -> Mapping[str, Any] | None: ...


class Supervised:
    """Made at once, so that settings that are wrong are refused at the start and not when it burns."""

    def __init__(self, charge: Charged, clock: Clock) -> None:
        self._charge = charge
        self._clock = clock
        self._close: list[Callable[[], object]] = []
        self._rate_to_zero: Callable[[], None] | None = None

    @classmethod
    def of(cls, charge: Charged, clock: Clock) -> Supervised:
        """The supervised instruments of ``charge``."""
        return cls(charge, clock)

    def table_link(self) -> Link | None:
        """The table's wire, not yet open; None where no table is supervised. Raises InputError."""
        return None if self._charge.table is None else table_wire(self._charge.table, self._clock)

    def table(self, port: int) -> RateTable | None:
        """The table, reached through the relay's ``port``. Raises InstrumentError where it is silent."""
        if self._charge.table is None:
            return None
        table = make_table(self._charge.table, port, self._clock)
        self._close.append(table.close)
        _open(table)
        if isinstance(table, PolledTable):
            self._rate_to_zero = lambda: _demand_zero(table)
        return cast(RateTable, table)

    def supply(self) -> Supply | None:
        """The supply, on a wire of its own. Raises InstrumentError where it does not answer."""
        if self._charge.supply is None:
            return None
        supply = make_supply(self._charge.supply, self._clock)
        self._close.append(supply.close)
        supply.open()
        return cast(Supply, supply)

    @property
    def rate_to_zero(self) -> Callable[[], None] | None:
        """How to demand rate zero of a table that this process has not enabled itself."""
        return self._rate_to_zero

    def close(self) -> tuple[Message, ...]:
        """Let the instruments go; what did not work."""
        problems: list[Message] = []
        for close in self._close:
            try:
                close()
            except AhrsLabError as error:
                problems.append(error.message)
        self._close.clear()
        return tuple(problems)


def _open(table: Instrument) -> None:
    """A table that was asked something in the moment of takeover may answer that first."""
    for left in reversed(range(_TRIES)):
        try:
            table.open()
        except InstrumentError:
            if not left:
                raise
        else:
            return


def _demand_zero(table: PolledTable) -> None:
    dialect = table._dialect
    with table._talk:
        for text in dialect.turning(0.0, entering=False):
            dialect.send(text)
