"""The small interfaces a bench is made of. Procedures and screens know these and nothing behind them.

Bench time is seconds of the bench's own clock (monotonic); every reading carries it. The table angle is
unwrapped and, like its rate, positive by the right hand about up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, Site

Array = NDArray[np.float64]


class Clock(Protocol):
    """Time as a parameter: everything that waits takes one."""

    def now_s(self) -> float:
        """Bench time, s."""
        ...

    def utc(self) -> datetime:
        """Date and time of now, timezone-aware UTC."""
        ...

    def wait(self, seconds: float) -> None:
        """Let ``seconds`` of bench time pass; may return early when :meth:`interrupt` is called."""
        ...

    def interrupt(self) -> None:
        """From any thread: the wait that is going on returns at once."""
        ...

    @property
    def step_s(self) -> float | None:
        """How much bench time a waiting loop should ask for at once; None: as much as there is to wait
        (a simulated bench at full speed makes it in one vectorised step)."""
        ...


@dataclass(frozen=True)
class TableLimits:
    """What the table can do and is allowed to."""

    max_rate_dps: float
    max_acceleration_dps2: float


@dataclass(frozen=True)
class TableState:
    """One look at the table. ``fault`` is the table's own text, empty when well. Angle and rate were read at
    most ``doubt_s`` before or after ``t_s``."""

    t_s: float
    angle_deg: float
    rate_dps: float
    demanded_rate_dps: float
    moving: bool
    enabled: bool
    fault: str = ""
    doubt_s: float = 0.0


@dataclass(frozen=True)
class TableLog:
    """What the table reported since it was last asked: arrays of shape (n,), bench time.

    Each row was read at most ``doubt_s`` before or after its ``t_s``; None: the times are exact.
    ``reports_rate``: whether the rate is the table's own word, or was formed here from its angles.
    """

    t_s: Array
    angle_deg: Array
    rate_dps: Array
    doubt_s: Array | None = None
    reports_rate: bool = True


class RateTable(Protocol):
    """A single-axis position and rate table."""

    limits: TableLimits

    def identify(self) -> str: ...
    def enable(self) -> None: ...
    def disable(self) -> None: ...
    def set_rate(self, rate_dps: float) -> None:
        """Demand a rate; returns at once. Raises InputError beyond the limits, InstrumentError on a fault."""
        ...

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """Go to an unwrapped angle with at most ``rate_dps`` and stay; returns at once."""
        ...

    def stop(self) -> None:
        """Rate to zero, from any state; returns at once."""
        ...

    def state(self) -> TableState: ...
    def log(self) -> TableLog: ...


class Ahrs(Protocol):
    """The unit under calibration."""

    description: DeviceDescription

    def identify(self) -> str: ...
    def start(self) -> None:
        """Begin to stream. Samples made before are dropped."""
        ...

    def stop(self) -> None: ...
    def read(self) -> Samples:
        """All samples since the last read, never waits; ``t_s`` and ``host_t_s`` (bench time of arrival) are
        always there. Empty when nothing came: whoever waits for data decides when that is too long."""
        ...


@runtime_checkable
class CountsLink(Protocol):
    """An instrument on a wire, which counts what goes wrong there; not all instruments are."""

    @property
    def link_counts(self) -> Mapping[str, int]:
        """Counts since its last start, by name: frames, failed, skipped_bytes, lost …"""
        ...


@dataclass(frozen=True)
class SupplyReading:
    """Measured at the supply's terminals."""

    t_s: float
    voltage_v: float
    current_a: float
    output_on: bool


class Supply(Protocol):
    """The DC supply of the unit."""

    def identify(self) -> str: ...
    def set_output(self, voltage_v: float, current_limit_a: float) -> None: ...
    def on(self) -> None: ...
    def off(self) -> None: ...
    def read(self) -> SupplyReading: ...


@dataclass(frozen=True)
class RoomReading:
    """Room air."""

    t_s: float
    temperature_c: float
    humidity_percent: float


class Room(Protocol):
    """Thermometer and hygrometer."""

    def read(self) -> RoomReading: ...


class Operator(Protocol):
    """The person at the bench."""

    def mount(self, orientation: Orientation, previous: Orientation | None) -> None:
        """Ask for the case to stand like ``orientation`` with the table at its home angle; returns when the
        person says that it does. Raises AbortedError when the person gives up."""
        ...


@dataclass(frozen=True)
class Bench:
    """Everything a procedure may touch.

    ``north_deg`` is the table angle (laboratory's north reference) at which a mounting stands as asked.
    ``simulated`` marks results that may never be issued as a real certificate.
    """

    clock: Clock
    table: RateTable
    ahrs: Ahrs
    supply: Supply
    room: Room
    operator: Operator
    site: Site
    north_deg: float = 0.0
    simulated: bool = False
    close: Callable[[], None] = lambda: None
