"""A simple rate table to answer for: acceleration-limited, integrated in steps of a millisecond."""

from __future__ import annotations

import math
import threading

from ahrs_lab.instruments.interfaces import Clock, TableLimits, TableLog, TableState

_STEP_S = 0.001


class Plant:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable` with an unwrapped angle of its own, which no
    driver sees. In position mode it runs to its target with a braking curve and ends exactly there."""

    def __init__(self, clock: Clock, max_rate_dps: float = 1000.0, acceleration: float = 100.0) -> None:
        self.limits = TableLimits(max_rate_dps, acceleration)
        self._clock = clock
        self._lock = threading.Lock()
        self._t_s = clock.now_s()
        self.angle_deg = 0.0
        self.rate_dps = 0.0
        self.fault = ""
        self.enabled = False
        self._target_deg: float | None = None
        self._wanted_dps = 0.0
        self.largest_rate_dps = 0.0

    def identify(self) -> str:
        return "plant"

    def enable(self) -> None:
        self._advance()
        self.fault = ""
        self.enabled = True

    def disable(self) -> None:
        self.stop()
        self.enabled = False

    def set_rate(self, rate_dps: float) -> None:
        self._advance()
        self._target_deg, self._wanted_dps = None, rate_dps

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        self._advance()
        self._target_deg, self._wanted_dps = angle_deg, rate_dps

    def stop(self) -> None:
        self.set_rate(0.0)

    def state(self) -> TableState:
        self._advance()
        moving = self.rate_dps != 0.0 or (self._wanted_dps != 0.0 and self._target_deg != self.angle_deg)
        return TableState(
            self._clock.now_s(),
            self.angle_deg,
            self.rate_dps,
            self._wanted_dps,
            moving,
            self.enabled,
            self.fault,
        )

    def log(self) -> TableLog:
        raise AssertionError("nobody asks the plant for its log")

    def _advance(self) -> None:
        with self._lock:
            now = self._clock.now_s()
            while self._t_s < now - 1e-9:
                step = min(_STEP_S, now - self._t_s)
                self._t_s += step
                self._step(step)

    def _step(self, step: float) -> None:
        change = self.limits.max_acceleration_dps2 * step
        wanted = self._wanted_dps
        if self._target_deg is not None:
            left = self._target_deg - self.angle_deg
            if abs(left) < 2.0 * change * step and abs(self.rate_dps) <= 2.0 * change:
                self.angle_deg, self.rate_dps = self._target_deg, 0.0
                return
            braking = math.sqrt(2.0 * self.limits.max_acceleration_dps2 * abs(left)) - change
            wanted = math.copysign(max(min(self._wanted_dps, braking), 0.5 * change), left)
        self.rate_dps += min(max(wanted - self.rate_dps, -change), change)
        self.angle_deg += self.rate_dps * step
        self.largest_rate_dps = max(self.largest_rate_dps, abs(self.rate_dps))
