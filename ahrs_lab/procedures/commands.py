"""What a procedure may ask of a bench: frozen commands, yielded by generators, executed by the runner.

A procedure knows neither Qt, threads nor drivers. It yields a command and receives its outcome; the runner
decides when, can pause between two commands, and ends every run in a safe state.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import Segment


@dataclass(frozen=True)
class PowerOn:
    """Supply on at these settings."""

    voltage_v: float
    current_limit_a: float


@dataclass(frozen=True)
class SettleCurrent:
    """Wait until the supply current stays within ``tolerance`` (relative) for ``hold_s``, then ``warm_up_s``
    more."""

    tolerance: float
    hold_s: float
    timeout_s: float
    warm_up_s: float


@dataclass(frozen=True)
class PowerOff:
    """Supply off."""


@dataclass(frozen=True)
class Mount:
    """Have the case stand like ``orientation`` with the table at its north angle; table at rest and held."""

    orientation: Orientation
    previous: Orientation | None


@dataclass(frozen=True)
class CheckMounting:
    """Gravity on the accelerometers (or the attitude output) against the asked orientation; refused beyond
    ``tolerance_deg``."""

    orientation: Orientation
    tolerance_deg: float
    duration_s: float


@dataclass(frozen=True)
class PointTo:
    """Turn the table to an azimuth (degrees from its north angle, positive by the right hand) and settle."""

    azimuth_deg: float
    rate_dps: float
    tolerance_deg: float
    hold_s: float
    timeout_s: float


@dataclass(frozen=True)
class Spin:
    """Demand a table rate."""

    rate_dps: float


@dataclass(frozen=True)
class SettleRate:
    """Wait until the table reports ``rate_dps`` within ``tolerance_dps`` for ``hold_s``."""

    rate_dps: float
    tolerance_dps: float
    hold_s: float
    timeout_s: float


@dataclass(frozen=True)
class Record:
    """Record ``segment`` for ``duration_s``."""

    segment: Segment
    duration_s: float


@dataclass(frozen=True)
class RecordTurns:
    """Record ``segment`` while the table turns ``turns`` (signed) whole turns at |rate|, from rest to rest
    back at its start; recording begins ``lead_s`` before the motion and lasts ``duration_s`` in all."""

    segment: Segment
    turns: int
    rate_dps: float
    lead_s: float
    duration_s: float


@dataclass(frozen=True)
class Stop:
    """Table to rest, and wait for it."""

    timeout_s: float


Command = (
    PowerOn
    | SettleCurrent
    | PowerOff
    | Mount
    | CheckMounting
    | PointTo
    | Spin
    | SettleRate
    | Record
    | RecordTurns
    | Stop
)


@dataclass(frozen=True)
class Step:
    """A line of the operator's list of steps; the commands yielded until the next one belong to it.

    ``key`` is stable over resumes; ``mounting`` is the face (``"x+"``) it is done on; ``kind`` one of mount,
    power, rest, rates, turns, position, static; ``estimate_s`` its bench time.
    """

    key: str
    mounting: str
    kind: str
    axis: str
    estimate_s: float
    detail: str = ""


Procedure = Generator[Command | Step, object, None]
"""Yields commands (and the Step they belong to), receives each command's outcome."""
