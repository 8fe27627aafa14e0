"""The clock of a bench of real instruments: the computer's monotonic time.

``speed`` other than 1 is only for a virtual bench that is served elsewhere and runs that much faster than
time: both sides then count the same bench seconds.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta

from ahrs_lab.errors import InputError

_WALL_STEP_S = 0.05
"""How long a waiting loop sleeps at once: quick to stop, and instruments are looked at often enough."""


class RealClock:
    """A :class:`~ahrs_lab.instruments.interfaces.Clock` on the wall clock; bench time begins at 0."""

    def __init__(self, speed: float = 1.0, *, wall: Callable[[], float] = time.monotonic) -> None:
        if not speed > 0.0:
            raise InputError("The bench's speed is {speed}; it has to be above 0.", speed=speed)
        self.speed = speed
        self._wall = wall
        self._origin = wall()
        self._started = datetime.now(UTC)
        self._interrupted = threading.Event()

    @property
    def wire_speed(self) -> float:
        """See :mod:`ahrs_lab.instruments.patience`."""
        return self.speed

    @property
    def step_s(self) -> float | None:
        """See :class:`~ahrs_lab.instruments.interfaces.Clock`."""
        return _WALL_STEP_S * self.speed

    def now_s(self) -> float:
        """Bench time, s."""
        return (self._wall() - self._origin) * self.speed

    def utc(self) -> datetime:
        """The computer's date and time; at another speed the start plus bench time."""
        if self.speed == 1.0:
            return datetime.now(UTC)
        return self._started + timedelta(seconds=self.now_s())

    def wait(self, seconds: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Clock`."""
        self._interrupted.clear()
        self._interrupted.wait(max(seconds, 0.0) / self.speed)

    def interrupt(self) -> None:
        """From any thread: the wait that is going on returns at once."""
        self._interrupted.set()
