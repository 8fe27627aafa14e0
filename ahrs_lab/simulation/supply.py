"""The virtual DC supply and what hangs on it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from math import exp, pi, sin

import numpy as np

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import Clock, SupplyReading
from ahrs_lab.simulation.faults import FaultSwitches
from ahrs_lab.simulation.settings import DeviceSettings, SupplySettings

_RIPPLE_OF_FAULT = 0.06
_RIPPLE_PERIOD_S = 7.0


class SimulatedSupply:
    """A :class:`~ahrs_lab.instruments.interfaces.Supply`. A load beyond the current limit switches the output
    off."""

    def __init__(
        self,
        settings: SupplySettings,
        load: DeviceSettings,
        clock: Clock,
        faults: FaultSwitches,
        seed: np.random.SeedSequence,
        lock: threading.RLock,
    ) -> None:
        self._settings = settings
        self._load = load
        self._clock = clock
        self._faults = faults
        self._lock = lock
        self._rng = np.random.Generator(np.random.SFC64(seed))
        self._voltage_v = 0.0
        self._limit_a = 0.0
        self._on_since_s: float | None = None
        self._powered: Callable[[bool], None] | None = None

    def feeds(self, powered: Callable[[bool], None]) -> None:
        """``powered(True)`` when the load comes to life, ``powered(False)`` when it loses its voltage."""
        self._powered = powered

    def identify(self) -> str:
        return "DC supply (simulated)"

    def set_output(self, voltage_v: float, current_limit_a: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.Supply`."""
        if not 0.0 <= voltage_v <= self._settings.max_voltage_v:
            raise InputError(
                "The supply cannot give {voltage_v} V: it goes from 0 to {limit_v} V.",
                voltage_v=voltage_v,
                limit_v=self._settings.max_voltage_v,
            )
        if not 0.0 < current_limit_a <= self._settings.max_current_a:
            raise InputError(
                "The supply's current limit cannot be {current_a} A: set it above 0 and up to {limit_a} A.",
                current_a=current_limit_a,
                limit_a=self._settings.max_current_a,
            )
        with self._lock:
            was_alive = self._alive()
            self._voltage_v, self._limit_a = voltage_v, current_limit_a
            if self._alive() and not was_alive:
                self._on_since_s = self._clock.now_s()
            self._tell(was_alive)

    def on(self) -> None:
        with self._lock:
            if self._on_since_s is None:
                self._on_since_s = self._clock.now_s()
                self._tell(was_alive=False)

    def off(self) -> None:
        with self._lock:
            was_alive = self._alive()
            self._on_since_s = None
            self._tell(was_alive)

    def read(self) -> SupplyReading:
        """See :class:`~ahrs_lab.instruments.interfaces.Supply`."""
        with self._lock:
            now = self._clock.now_s()
            noise = self._rng.standard_normal(2)
            on = self._on_since_s is not None
            voltage = self._voltage_v if on else 0.0
            return SupplyReading(
                t_s=now,
                voltage_v=voltage + float(noise[0]) * self._settings.voltage_noise_v,
                current_a=self._current_a(now) + float(noise[1]) * self._settings.current_noise_a,
                output_on=on,
            )

    def _alive(self) -> bool:
        return self._on_since_s is not None and self._voltage_v >= self._load.min_voltage_v

    def _tell(self, was_alive: bool) -> None:
        if self._current_a(self._clock.now_s()) > self._limit_a:
            self._on_since_s = None
        alive = self._alive()
        if alive != was_alive and self._powered is not None:
            self._powered(alive)

    def _current_a(self, now_s: float) -> float:
        if self._on_since_s is None or not self._alive():
            return 0.0
        age = now_s - self._on_since_s
        steady = self._load.load_w / self._voltage_v
        current = steady * (1.0 + self._settings.inrush * exp(-age / self._settings.inrush_time_constant_s))
        if self._faults.active("supply_never_settles", now_s):
            current += steady * _RIPPLE_OF_FAULT * sin(2.0 * pi * age / _RIPPLE_PERIOD_S)
        return current
