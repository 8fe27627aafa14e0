"""The virtual rate table: true motion of the platform, and what its controller reports of it."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.interfaces import Clock, TableLimits, TableLog, TableState
from ahrs_lab.simulation.faults import FaultSwitches
from ahrs_lab.simulation.motion import Motion
from ahrs_lab.simulation.settings import TableSettings

Array = NDArray[np.float64]

_LOG_KEEPS_S = 7200.0
"""The controller's memory: a log asked for later than that has lost its beginning."""

_TRIP_TEXT = "drive tripped: axis limit"


class SimulatedTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable`. Faults stay latched until the table is enabled
    again."""

    def __init__(
        self,
        settings: TableSettings,
        clock: Clock,
        faults: FaultSwitches,
        seed: np.random.SeedSequence,
        lock: threading.RLock,
    ) -> None:
        self.limits = TableLimits(settings.max_rate_dps, settings.max_acceleration_dps2)
        self._settings = settings
        self._clock = clock
        self._faults = faults
        self._lock = lock
        look, log = seed.spawn(2)
        self._look_rng = np.random.Generator(np.random.SFC64(look))
        self._log_rng = np.random.Generator(np.random.SFC64(log))
        self._enabled = False
        self._demanded_dps = 0.0
        self._fault = ""
        self._logged = 0
        self.motion = Motion(self._true_angle(settings.north_deg))

    def identify(self) -> str:
        return f"{self._settings.name} (simulated)"

    def enable(self) -> None:
        """Close the drive's interlock; acknowledges a fault."""
        with self._lock:
            self._fault = ""
            self._enabled = True

    def disable(self) -> None:
        """Brake and open the interlock."""
        with self._lock:
            self.stop()
            self._enabled = False

    def set_rate(self, rate_dps: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        with self._lock:
            self._ready(rate_dps)
            self._demanded_dps = rate_dps
            if self._ignores():
                return
            self.motion.go_at(
                self._clock.now_s(), self._true_rate(rate_dps), self._settings.max_acceleration_dps2
            )
            self._hunt(rate_dps)

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`; ``rate_dps`` without sign, above 0."""
        with self._lock:
            self._ready(rate_dps)
            if not rate_dps > 0.0:
                raise InputError(
                    "The table cannot move at {rate_dps} °/s: give a rate above 0.", rate_dps=rate_dps
                )
            self._demanded_dps = 0.0
            if self._ignores():
                return
            now = self._clock.now_s()
            self.motion.go_to(
                now,
                self._true_angle(angle_deg),
                self._true_rate(rate_dps),
                self._settings.max_acceleration_dps2,
            )
            self._hunt(0.0)

    def stop(self) -> None:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        with self._lock:
            self._demanded_dps = 0.0
            if not self._runs_away():
                self.motion.go_at(self._clock.now_s(), 0.0, self._settings.max_acceleration_dps2)

    def state(self) -> TableState:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`."""
        with self._lock:
            now = self._clock.now_s()
            true = np.array([self.motion.rate_at(now)])
            moving = self.motion.moving_at(now)
            return TableState(
                t_s=now,
                angle_deg=float(self._encoder(np.array([self.motion.angle_at(now)]))[0]),
                rate_dps=float(self._reported_rate(true, self._look_rng)[0]),
                demanded_rate_dps=self._demanded_dps,
                moving=moving,
                enabled=self._enabled,
                fault=self._fault,
            )

    def log(self) -> TableLog:
        """See :class:`~ahrs_lab.instruments.interfaces.RateTable`; at ``log_rate_hz``, of the last two
        hours."""
        with self._lock:
            rate = self._settings.log_rate_hz
            now = self._clock.now_s()
            last = int(np.floor(now * rate * (1.0 + 1e-15)))
            first = max(self._logged + 1, last - int(_LOG_KEEPS_S * rate) + 1)
            self._logged = last
            times = np.arange(first, last + 1) / rate
            angles, rates = np.empty_like(times), np.zeros_like(times)
            for start, stop, piece in self.motion.spans(first / rate, (last + 1) / rate):
                a, b = np.searchsorted(times, (start, stop))
                angles[a:b] = piece.angles(times[a:b])
                if not piece.at_rest:
                    rates[a:b] = piece.rates(times[a:b])
            return TableLog(times, self._encoder(angles), self._reported_rate(rates, self._log_rng))

    def trip(self, t_s: float) -> None:
        """The drive fails at bench time ``t_s`` and brakes."""
        with self._lock:
            self._fault = _TRIP_TEXT
            self._enabled = False
            self._demanded_dps = 0.0
            self.motion.go_at(t_s, 0.0, self._settings.max_acceleration_dps2)

    def turning(self) -> bool:
        """Whether the platform moves now."""
        with self._lock:
            return self.motion.moving_at(self._clock.now_s())

    @property
    def logged_until_s(self) -> float:
        """Bench time up to which :meth:`log` was read, or which it will have forgotten."""
        return max(self._logged / self._settings.log_rate_hz, self._clock.now_s() - _LOG_KEEPS_S) - 1.0

    def _ready(self, rate_dps: float) -> None:
        if self._fault:
            raise InstrumentError(
                "The rate table reports a fault: {fault}. Find its cause and enable the table again.",
                fault=self._fault,
            )
        if not self._enabled:
            raise InstrumentError("The rate table is not enabled: enable it before it is asked to move.")
        # the negation also refuses what is not a number
        if not abs(rate_dps) <= self._settings.max_rate_dps:
            raise InputError(
                "The rate table cannot turn at {rate_dps} °/s: its limit is {limit_dps} °/s.",
                rate_dps=rate_dps,
                limit_dps=self._settings.max_rate_dps,
            )

    def _ignores(self) -> bool:
        now = self._clock.now_s()
        return self._faults.active("table_ignores_commands", now) is not None or self._runs_away()

    def _runs_away(self) -> bool:
        now = self._clock.now_s()
        return self._faults.active("table_runs_away", now) is not None and self.motion.moving_at(now)

    def _hunt(self, rate_dps: float) -> None:
        if self._faults.active("table_never_settles", self._clock.now_s()):
            self.motion.hunt(max(0.01 * abs(rate_dps), 0.05))

    def _rate_error(self, rate_dps: float) -> float:
        slow, middle, fast = self._settings.rate_error
        magnitude = abs(rate_dps)
        return slow if magnitude < 1.0 else middle if magnitude < 10.0 else fast

    def _true_rate(self, rate_dps: float) -> float:
        return rate_dps * (1.0 + self._rate_error(rate_dps))

    def _reported_rate(self, true_dps: Array, rng: np.random.Generator) -> Array:
        """The controller measures with the time base that it turns by, so it does not see its own rate
        error."""
        slow, middle, fast = self._settings.rate_error
        if slow or middle or fast:
            magnitude = np.abs(true_dps)
            true_dps = true_dps / (
                1.0
                + np.where(
                    magnitude < 1.0 + slow, slow, np.where(magnitude < 10.0 * (1.0 + middle), middle, fast)
                )
            )
        if self._settings.rate_noise_dps:
            return true_dps + self._settings.rate_noise_dps * rng.standard_normal(len(true_dps))
        return true_dps

    def _encoder_error_deg(self, angle_deg: Array) -> Array:
        phase = self._settings.position_error_harmonic * angle_deg + self._settings.position_error_phase_deg
        return np.asarray(
            self._settings.position_error_arcsec / 3600.0 * np.sin(np.radians(phase)), dtype=np.float64
        )

    def _encoder(self, true_deg: Array) -> Array:
        """What the encoder reads at true angles, shape (n,)."""
        shown = true_deg
        if self._settings.position_error_arcsec:
            shown = shown + self._encoder_error_deg(true_deg)
        step = self._settings.encoder_resolution_deg
        return np.rint(shown / step) * step if step else shown

    def _true_angle(self, shown_deg: float) -> float:
        """Where the platform stands when the encoder reads ``shown_deg``: the position loop ends there."""
        if not self._settings.position_error_arcsec:
            return shown_deg
        # the error repeats each turn: what it is on the first turn it is on the tenth, to the bit
        within = shown_deg % 360.0
        true = within
        for _ in range(4):
            true = within - float(self._encoder_error_deg(np.array([true]))[0])
        return shown_deg + (true - within)
