"""The unit's inertial sensors: true increments in, what the six channels indicate out, with all errors."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.sensor_noise import GRID_S, Interpolation, NoiseCoefficients, SlowDrift, WhiteNoise
from ahrs_lab.simulation.motion import Motion
from ahrs_lab.simulation.mounted_case import MountedCase
from ahrs_lab.simulation.settings import (
    AccelNoise,
    DeviceSettings,
    GyroNoise,
    RoomSettings,
    SensorSettings,
    Stability,
)

Array = NDArray[np.float64]

_HOUR_S: Final = 3600.0


@dataclass(frozen=True)
class Session:
    """From one power-on to the next: when, how warm the unit was, and the biases it woke up with (shape
    (6,))."""

    started_s: float
    excess_c: float
    turn_on: Array


class Sensors:
    """Three gyros and three accelerometers, channels 0–2 in °/s, 3–5 in m/s²."""

    def __init__(
        self,
        settings: SensorSettings,
        device: DeviceSettings,
        room: RoomSettings,
        seed: np.random.SeedSequence,
    ) -> None:
        self._settings = settings
        self._device = device
        self._room = room
        slow, self._turn_on_seed, *white = seed.spawn(8)
        gyro, accel = _gyro_coefficients(settings.gyro_noise), _accel_coefficients(settings.accel_noise)
        triads = (gyro, gyro, gyro, accel, accel, accel)
        interval_s = 1.0 / device.sample_rate_hz
        self._slow = SlowDrift(triads, slow)
        self._white = [WhiteNoise(c, interval_s, s) for c, s in zip(triads, white, strict=True)]
        self._stability = (settings.gyro_stability,) * 3 + (settings.accel_stability,) * 3
        self._scale_ppm_per_c = (
            settings.gyro_stability.scale_ppm_per_c + settings.accel_stability.scale_ppm_per_c
        )

    def power_on(self, t_s: float, excess_c: float) -> Session:
        """A new session; the biases it wakes up with are drawn anew each time."""
        (seed,) = self._turn_on_seed.spawn(1)
        spread = np.array([stability.turn_on for stability in self._stability])
        return Session(t_s, excess_c, spread * np.random.Generator(np.random.SFC64(seed)).standard_normal(6))

    def excess_c(self, session: Session, t_s: float | Array) -> Array:
        """How much warmer than the room the unit is, °C."""
        final = self._device.self_heating_c
        age = np.maximum(np.asarray(t_s, dtype=np.float64) - session.started_s, 0.0)
        decay = np.exp(-age / self._device.thermal_time_constant_s)
        return np.asarray(final + (session.excess_c - final) * decay, dtype=np.float64)

    def cooled_c(self, excess_c: float, off_for_s: float) -> float:
        """What is left of ``excess_c`` after a time without power."""
        return excess_c * exp(-off_for_s / self._device.thermal_time_constant_s)

    def temperature_c(self, session: Session, t_s: Array) -> Array:
        """Of the unit, shape (n,)."""
        room = self._room
        swing = np.sin(2.0 * pi / room.swing_period_s * t_s) if room.temperature_swing_c else 0.0
        return np.asarray(
            room.temperature_c + room.temperature_swing_c * swing + self.excess_c(session, t_s),
            dtype=np.float64,
        )

    def drift(self, session: Session, first: int, last: int) -> Array:
        """Shape (6, last − first + 1): all that moves the biases, at the nodes of the slow grid."""
        times = _grid_s(first, last)
        drift = self._slow.nodes(first, last) + session.turn_on[:, np.newaxis]
        temperature = None
        for row, stability in enumerate(self._stability):
            start_up = stability.start_up[row % 3]
            if start_up:
                drift[row] += start_up * np.exp(
                    -(times - session.started_s) / stability.start_up_time_constant_s
                )
            if stability.temperature:
                if temperature is None:
                    temperature = self.temperature_c(session, times)
                drift[row] += _polynomial(stability, temperature)
        return drift

    def indicate(
        self, session: Session, motion: Motion, case: MountedCase, edges_s: Array, shown: Array
    ) -> None:
        """Fill ``shown``, shape (6, n): the brackets of (2-28) and (2-27), means over the n intervals between
        ``edges_s`` (shape (n + 1,)), with every drift and noise, before the scale factors."""
        self._feel(motion, case, edges_s, shown)
        self.disturb(session, edges_s, shown)

    def disturb(self, session: Session, edges_s: Array, shown: Array) -> None:
        """Add every drift and noise to ``shown``, shape (6, n): what :meth:`show` made of the n intervals
        between ``edges_s``."""
        between = Interpolation(0.5 * (edges_s[1:] + edges_s[:-1]))
        drift = self.drift(session, between.first, between.last)
        scratch = np.empty(shown.shape[1])
        limits = (self._settings.gyro.range_dps,) * 3 + (self._settings.accel.range_mps2,) * 3
        for row, values in enumerate(shown):
            if drift[row].any():
                np.add(values, between(drift[row], scratch), out=values)
            self._white[row].add_to(values, scratch)
            np.clip(values, -limits[row], limits[row], out=values)
        if any(self._scale_ppm_per_c):
            self._scale_with_temperature(session, between, shown, scratch)

    def _feel(self, motion: Motion, case: MountedCase, edges_s: Array, shown: Array) -> None:
        """The deterministic part. Intervals inside one piece of motion go together, the few that lie across
        two pieces one by one."""
        interval_s = 1.0 / self._device.sample_rate_hz
        across: set[int] = set()
        for start, stop, piece in motion.spans(edges_s[0], edges_s[-1]):
            a = int(np.searchsorted(edges_s, start, "left"))
            b = int(np.searchsorted(edges_s, stop, "right")) - 1
            if a > 0 and edges_s[a] > start:
                across.add(a - 1)
            if b > a:
                felt = case.integrals(piece, edges_s[a : b + 1], interval_s)
                self.show(felt.angle_deg / interval_s, felt.velocity_mps / interval_s, shown[:, a:b])
        for index in across:
            angle, velocity = np.zeros((3, 1)), np.zeros((3, 1))
            for start, stop, piece in motion.spans(edges_s[index], edges_s[index + 1]):
                felt = case.integrals(piece, np.array([start, stop]))
                angle += felt.angle_deg
                velocity += felt.velocity_mps
            self.show(angle / interval_s, velocity / interval_s, shown[:, index : index + 1])

    def show(self, rate_dps: Array, force_mps2: Array, shown: Array) -> None:
        """Fill ``shown``, shape (6, n), with the brackets of (2-28) and (2-27) for ω and f of shape (3,
        n)."""
        shown[:3] = self._settings.gyro.indicated_dps(rate_dps, force_mps2)
        shown[3:] = self._settings.accel.indicated_mps2(force_mps2)

    def _scale_with_temperature(
        self, session: Session, between: Interpolation, shown: Array, scratch: Array
    ) -> None:
        times = _grid_s(between.first, between.last)
        temperature = self.temperature_c(session, times)
        for row, values in enumerate(shown):
            if self._scale_ppm_per_c[row]:
                above = temperature - self._stability[row].reference_temperature_c
                factor = 1.0 + 1e-6 * self._scale_ppm_per_c[row] * above
                np.multiply(values, between(factor, scratch), out=values)


def _grid_s(first: int, last: int) -> Array:
    return np.arange(first, last + 1, dtype=np.float64) * GRID_S


def _polynomial(stability: Stability, temperature_c: Array) -> Array:
    above = temperature_c - stability.reference_temperature_c
    total = np.zeros_like(above)
    for coefficient in reversed(stability.temperature):
        total = (total + coefficient) * above
    return total


def _gyro_coefficients(noise: GyroNoise) -> NoiseCoefficients:
    return NoiseCoefficients(
        white=noise.angle_random_walk_deg_per_sqrt_h / np.sqrt(_HOUR_S),
        bias_instability=noise.bias_instability_deg_per_h / _HOUR_S,
        random_walk=noise.rate_random_walk_deg_per_h_per_sqrt_h / _HOUR_S / np.sqrt(_HOUR_S),
        quantisation=noise.quantisation_arcsec / 3600.0,
    )


def _accel_coefficients(noise: AccelNoise) -> NoiseCoefficients:
    return NoiseCoefficients(
        white=noise.velocity_random_walk_mps_per_sqrt_s,
        bias_instability=noise.bias_instability_mps2,
        random_walk=noise.acceleration_random_walk_mps2_per_sqrt_s,
        quantisation=noise.quantisation_mps,
    )
