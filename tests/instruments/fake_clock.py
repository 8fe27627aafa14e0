"""Bench time that only a test lets pass."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta


class FakeClock:
    """A :class:`~ahrs_lab.instruments.interfaces.Clock`; ``on_step`` is called every ``look_s`` of a wait, as
    the polling thread would be."""

    step_s: float | None = 0.05

    def __init__(self) -> None:
        self.t_s = 0.0
        self.on_step: Callable[[], None] | None = None
        self.look_s = 0.025

    def now_s(self) -> float:
        return self.t_s

    def utc(self) -> datetime:
        return datetime(2026, 1, 1, tzinfo=UTC) + timedelta(seconds=self.t_s)

    def wait(self, seconds: float) -> None:
        end = self.t_s + seconds
        while self.t_s < end - 1e-12:
            self.t_s = min(end, self.t_s + self.look_s)
            if self.on_step is not None:
                self.on_step()

    def interrupt(self) -> None:
        """Nothing waits here."""
