"""Whether a table can have come to the angle that it reports: lines without checksums damage readings."""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.instruments.angles import wrap_180
from ahrs_lab.instruments.drivers.tables.dialect import TableReading


@dataclass(frozen=True)
class Look:
    """What was seen of a table at a moment; the angle is unwrapped."""

    t_s: float
    angle_deg: float
    rate_dps: float
    doubt_s: float = 0.0


@dataclass(frozen=True)
class Slack:
    """How far from where it should be an angle may be: ``angle_deg``, and ``time_s`` of doubt about when it
    was read beyond what the stamps admit."""

    angle_deg: float
    time_s: float


ODD = Slack(0.2, 0.003)
"""A reading farther off than this is asked for again."""
JUMPED = Slack(2.0, 0.03)
"""Farther off than this twice, and the table has lost its position."""


def fits(last: Look, reading: TableReading, slack: Slack, acceleration_dps2: float, *, wraps: bool) -> bool:
    """Whether the reading fits to the one before and to the rates of both."""
    if reading.rate_dps is None:
        return True
    passed = reading.t_s - last.t_s
    expected = last.angle_deg + 0.5 * (last.rate_dps + reading.rate_dps) * passed
    change = reading.angle_deg - expected
    if wraps:
        change = wrap_180(change)
    allowed = slack.angle_deg + abs(reading.rate_dps) * (slack.time_s + last.doubt_s + reading.doubt_s)
    # Where the rate has changed, nobody knows when within the time between.
    allowed += 0.5 * abs(reading.rate_dps - last.rate_dps) * passed + 4.0 * acceleration_dps2 * passed**2
    return abs(change) <= allowed
