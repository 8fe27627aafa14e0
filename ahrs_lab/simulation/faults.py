"""What can go wrong on the virtual bench, switched on by tests, by a demonstration or by the bench file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Literal, get_args

from ahrs_lab.recording.orientation import Orientation

FaultName = Literal[
    "table_trips",
    "table_never_settles",
    "table_ignores_commands",
    "table_runs_away",
    "supply_never_settles",
    "ahrs_silent",
    "ahrs_dropouts",
    "wrong_mounting",
    "wrong_rate",
    "room_out_of_limits",
]
TRIP_ABOVE_DPS = 30.0
"""So that it happens in a spin, not while the table is pointed."""

FAULT_NAMES: tuple[FaultName, ...] = get_args(FaultName)


@dataclass
class Fault:
    """One switch. Active from ``at_s`` up to ``until_s`` of bench time; ``once``: until it has done its harm
    once.

    - ``table_trips``: the drive trips, once, as soon as it turns at ``above_dps`` or more, and brakes
    - ``table_never_settles``: the rate swings about its demand
    - ``table_ignores_commands``: it takes motion demands and does nothing
    - ``table_runs_away``: once it turns it takes no demand any more, not even to stop
    - ``supply_never_settles``: the current swings by some per cent
    - ``ahrs_silent``: nothing arrives
    - ``ahrs_dropouts``: one sample in ten is lost
    - ``wrong_mounting``: the operator mounts ``orientation`` or, without one, the asked axes cyclically
    exchanged
    - ``wrong_rate``: whoever sets a table by hand turns it the wrong way
    - ``room_out_of_limits``: 26 °C, 90 %
    """

    at_s: float = 0.0
    until_s: float = inf
    once: bool = False
    orientation: Orientation | None = None
    above_dps: float = TRIP_ABOVE_DPS
    spent: bool = False


class FaultSwitches:
    """The faults that are set, by name. ``now`` is the bench's time."""

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._set: dict[FaultName, Fault] = {}

    def trigger(
        self,
        name: FaultName,
        at_s: float | None = None,
        until_s: float | None = None,
        *,
        once: bool = False,
        orientation: Orientation | None = None,
        above_dps: float = TRIP_ABOVE_DPS,
    ) -> None:
        """Set a fault, at once or from bench time ``at_s`` on."""
        if name not in FAULT_NAMES:
            raise ValueError(f"no such fault: {name}")
        self._set[name] = Fault(
            self._now() if at_s is None else at_s,
            inf if until_s is None else until_s,
            once,
            orientation,
            above_dps,
        )

    def clear(self, name: FaultName) -> None:
        """Mend it from now on."""
        fault = self._set.get(name)
        if fault is not None:
            fault.until_s = min(fault.until_s, self._now())

    def get(self, name: FaultName) -> Fault | None:
        """The switch, whether active, still to come or over; None where it was never set."""
        return self._set.get(name)

    def active(self, name: FaultName, t_s: float) -> Fault | None:
        """The switch where it is active at ``t_s``."""
        fault = self._set.get(name)
        return fault if fault is not None and fault.at_s <= t_s < fault.until_s else None
