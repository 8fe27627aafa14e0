"""What one kind of table says for the few things a table can do. A dialect speaks; when to say what, limits,
turns, faults and threads are :class:`~ahrs_lab.instruments.drivers.tables.polled_table.PolledTable`'s."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from ahrs_lab.messages import Message


@dataclass(frozen=True)
class TableReading:
    """One look. ``angle_deg`` as the table reports it, which may wrap. ``rate_dps`` None where it tells none.
    ``fault`` is the table's own text. The angle was read at most ``doubt_s`` before or after ``t_s``: between
    the request and its answer."""

    t_s: float
    angle_deg: float
    rate_dps: float | None
    fault: str | Message = ""
    doubt_s: float = 0.0


class TableDialect(Protocol):
    """Commands are lists of texts, sent one by one with ``pause_s`` between those that change something.
    Every call may raise InstrumentError, LinkLostError where the link is gone."""

    @property
    def name(self) -> str:
        """Of the link, for messages."""
        ...

    @property
    def wraps(self) -> bool:
        """Whether the reported position wraps and is reached on the shortest path."""
        ...

    @property
    def pause_s(self) -> float: ...
    def connect(self) -> str:
        """Open the link and return who answers."""
        ...

    def disconnect(self) -> None:
        """Never raises."""
        ...

    def enabling(self) -> Sequence[str]:
        """Acknowledge faults and servo on, at zero rate, ending in rate mode."""
        ...

    def disabling(self) -> Sequence[str]: ...
    def stopping(self) -> Sequence[str]:
        """Rate to zero from any state, as the table itself does it best."""
        ...

    def turning(self, rate_dps: float, *, entering: bool) -> Sequence[str]:
        """Turn at a rate; ``entering``: the table is in another mode."""
        ...

    def pointing(self, angle_deg: float, rate_dps: float) -> Sequence[str]:
        """Go to an angle with at most a rate. The last text starts the motion, those before prepare it and
        may be sent while the table turns at a rate."""
        ...

    def send(self, command: str) -> None:
        """Say one text and take its acknowledgement."""
        ...

    def read(self) -> TableReading: ...
    def stay(self) -> None:
        """Called at every look while enabled: what keeps the drive from dropping out."""
        ...
