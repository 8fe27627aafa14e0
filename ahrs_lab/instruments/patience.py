"""Time limits where bench time runs faster than the wires of the bench.

A clock that maps wall time to bench time has ``wire_speed``, bench seconds per wall second. A clock without
it has wires that keep bench time, or none.
"""

from __future__ import annotations

from ahrs_lab.instruments.interfaces import Clock

ENOUGH_S = 3.0
"""Wall time after which a busy computer, which then serves the bench as well, has brought what it brings."""


def patient_s(clock: Clock, seconds: float, enough_s: float = ENOUGH_S) -> float:
    """Bench time to wait for a wire: ``seconds``; where bench time runs faster, at least ``enough_s`` of wall
    time."""
    return max(seconds, wall_s(clock, enough_s)) if wall_s(clock, 1.0) > 1.0 else seconds


def wall_s(clock: Clock, seconds: float) -> float:
    """Bench time that passes in ``seconds`` of wall time."""
    return seconds * float(getattr(clock, "wire_speed", 1.0))
