"""Air of the virtual room."""

from __future__ import annotations

import threading
from math import pi, sin

import numpy as np

from ahrs_lab.instruments.interfaces import Clock, RoomReading
from ahrs_lab.simulation.faults import FaultSwitches
from ahrs_lab.simulation.settings import RoomSettings

_FAULTY_TEMPERATURE_C = 26.0
_FAULTY_HUMIDITY_PERCENT = 90.0


class SimulatedRoom:
    """A :class:`~ahrs_lab.instruments.interfaces.Room`."""

    def __init__(
        self,
        settings: RoomSettings,
        clock: Clock,
        faults: FaultSwitches,
        seed: np.random.SeedSequence,
        lock: threading.RLock,
    ) -> None:
        self._settings = settings
        self._clock = clock
        self._faults = faults
        self._lock = lock
        self._rng = np.random.Generator(np.random.SFC64(seed))

    def read(self) -> RoomReading:
        """See :class:`~ahrs_lab.instruments.interfaces.Room`."""
        with self._lock:
            s, now = self._settings, self._clock.now_s()
            noise = self._rng.standard_normal(2)
            swing = sin(2.0 * pi * now / s.swing_period_s)
            temperature = s.temperature_c + s.temperature_swing_c * swing
            humidity = s.humidity_percent + s.humidity_swing_percent * swing
            if self._faults.active("room_out_of_limits", now):
                temperature, humidity = _FAULTY_TEMPERATURE_C, _FAULTY_HUMIDITY_PERCENT
            return RoomReading(
                t_s=now,
                temperature_c=temperature + float(noise[0]) * s.temperature_noise_c,
                humidity_percent=min(max(humidity + float(noise[1]) * s.humidity_noise_percent, 0.0), 100.0),
            )
