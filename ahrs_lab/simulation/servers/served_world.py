"""The virtual world in step with the wall clock, for instruments that answer whenever they are asked.

The world of a bench in process stands still until somebody waits; here it goes on by itself. In a ``stepped``
world time passes only by :meth:`ServedWorld.step`: for tests that run as fast as both sides can follow, so
that a computer under load changes nothing.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

from ahrs_lab.recording.segment import AccelUnit, RateUnit
from ahrs_lab.simulation.settings import SimulationSettings
from ahrs_lab.simulation.world import World

_LOOK_S = 0.0002


def in_units(settings: SimulationSettings, rate_unit: RateUnit, accel_unit: AccelUnit) -> SimulationSettings:
    """The same bench with a unit that measures in a protocol's units."""
    device = replace(settings.device, rate_unit=rate_unit, accel_unit=accel_unit)
    return replace(settings, device=device)


class ServedWorld:
    """A world that :meth:`catch_up` brings to the present. Bench time is ``speed`` times wall time."""

    def __init__(
        self,
        settings: SimulationSettings,
        speed: float = 1.0,
        *,
        stepped: bool = False,
        wall: Callable[[], float] = time.monotonic,
    ) -> None:
        self.world = World(settings, None)
        self.speed = speed
        self.stepped = stepped
        self._wall = wall
        self._origin = wall()
        self.waiting = 0
        """Who waits on a :class:`ServedClock` now."""
        self.world.ahrs.start()

    @property
    def now_s(self) -> float:
        """Bench time that the world has come to."""
        return self.world.clock.now_s()

    @property
    def said_speed(self) -> float:
        """As the instruments say it; a stepped world has no relation to the wall clock."""
        return 1.0 if self.stepped else self.speed

    @property
    def powered(self) -> bool:
        """Whether the unit has its voltage and has booted."""
        device, ahrs = self.world.settings.device, self.world.ahrs
        return ahrs.powered and self.now_s >= ahrs.sessions[-1].started_s + device.boot_time_s

    def catch_up(self) -> float:
        """Let the time pass that has passed; bench time now."""
        with self.world.lock:
            if not self.stepped:
                passed = (self._wall() - self._origin) * self.speed - self.now_s
                if passed > 0.0:
                    self.world.clock.wait(passed)
            return self.now_s

    def step(self, seconds: float) -> None:
        """Let so much bench time pass."""
        with self.world.lock:
            self.world.clock.wait(seconds)

    def reboot(self) -> None:
        """The unit loses its voltage for a moment."""
        with self.world.lock:
            if self.world.ahrs.powered:
                self.world.ahrs.power(False)
                self.world.ahrs.power(True)


class ServedClock:
    """The :class:`~ahrs_lab.instruments.interfaces.Clock` of a bench whose instruments are served in the same
    process: it reads the served world's time. One thread waits on it."""

    def __init__(self, served: ServedWorld) -> None:
        self._served = served
        self._interrupted = threading.Event()

    @property
    def step_s(self) -> float | None:
        """See :class:`~ahrs_lab.instruments.interfaces.Clock`."""
        return 0.01 * self._served.speed

    @property
    def speed(self) -> float:
        """Bench seconds per wall second; of a stepped world the longest look."""
        return self._served.speed

    def now_s(self) -> float:
        """Bench time, s."""
        return self._served.now_s

    def utc(self) -> datetime:
        """The served world's."""
        return self._served.world.clock.utc()

    def wait(self, seconds: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Clock`."""
        self._interrupted.clear()
        end = self.now_s() + max(seconds, 0.0)
        self._served.waiting += 1
        try:
            while (left := end - self.now_s()) > 0.0:
                if self._interrupted.wait(_LOOK_S if self._served.stepped else left / self._served.speed):
                    return
        finally:
            self._served.waiting -= 1

    def interrupt(self) -> None:
        """The wait that is going on returns at once."""
        self._interrupted.set()
