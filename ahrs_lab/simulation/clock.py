"""The bench's clock: waiting lets the world go on, as fast as can be or in step with the wall clock."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta

from ahrs_lab.errors import InputError

_WALL_STEP_S = 0.05
"""How much wall time a waiting loop asks for at once: quick to stop, cheap enough."""

_CATCH_UP_S = 0.25
"""What the computer was late by is made up for to this much, the rest is let go."""


def parse_utc(text: str) -> datetime:
    """An ISO 8601 date and time with offset, in UTC."""
    try:
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise InputError(
            "“{text}” is not a date and time; write it like 2026-01-31T08:00:00+00:00.", text=text
        ) from error
    if moment.tzinfo is None:
        raise InputError(
            "“{text}” has no offset from UTC; write it like 2026-01-31T08:00:00+00:00.", text=text
        )
    return moment.astimezone(UTC)


class SimulatedClock:
    """Bench time. ``speed`` is bench seconds per wall second and may be changed while it runs; None: no
    waiting."""

    def __init__(
        self,
        speed: float | None,
        start_utc: datetime,
        *,
        wall: Callable[[], float] = time.monotonic,
    ) -> None:
        self._now_s = 0.0
        self._speed = _checked(speed)
        self._start_utc = start_utc
        self._wall = wall
        self._due = 0.0
        self._interrupted = threading.Event()
        self._advance: Callable[[float, float], None] | None = None
        self.world: object = None
        """What the time is of; for those who may look behind the bench."""

    @property
    def speed(self) -> float | None:
        """Bench seconds per wall second; None: as fast as the computer can."""
        return self._speed

    @speed.setter
    def speed(self, speed: float | None) -> None:
        self._speed = _checked(speed)

    @property
    def step_s(self) -> float | None:
        """See :class:`ahrs_lab.instruments.interfaces.Clock`."""
        return None if self._speed is None else _WALL_STEP_S * self._speed

    def drive(self, world: object, advance: Callable[[float, float], None]) -> None:
        """``advance(start_s, stop_s)`` is called for each piece of time that passes."""
        self.world = world
        self._advance = advance

    def now_s(self) -> float:
        """Bench time, s."""
        return self._now_s

    def utc(self) -> datetime:
        """Start of the bench plus bench time."""
        return self._start_utc + timedelta(seconds=self._now_s)

    def begin_earlier(self, seconds: float) -> None:
        """Date the bench back, before anything is recorded on it: who is faster than time ends in the
        future else."""
        self._start_utc -= timedelta(seconds=seconds)

    def wait(self, seconds: float) -> None:
        """Let time pass: in one step, or in pieces of wall time that :meth:`interrupt` can break."""
        self._interrupted.clear()
        end = self._now_s + max(seconds, 0.0)
        while self._now_s < end:
            speed = self._speed
            if speed is None:
                self._go_to(end)
                return
            target = min(end, self._now_s + _WALL_STEP_S * speed)
            interrupted = self._sleep((target - self._now_s) / speed)
            self._go_to(target)
            if interrupted:
                return

    def interrupt(self) -> None:
        """From any thread: the wait that is going on returns within a step."""
        self._interrupted.set()

    def _go_to(self, target: float) -> None:
        start, self._now_s = self._now_s, target
        if self._advance is not None:
            self._advance(start, target)

    def _sleep(self, seconds: float) -> bool:
        """Wait on the wall clock, keeping in step over many short waits; True where it was interrupted."""
        now = self._wall()
        self._due = max(self._due, now - _CATCH_UP_S) + seconds
        return self._interrupted.wait(max(self._due - now, 0.0))


def _checked(speed: float | None) -> float | None:
    if speed is not None and not speed > 0.0:
        raise InputError("The bench's speed is {speed}; it has to be above 0.", speed=speed)
    return speed
