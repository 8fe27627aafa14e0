"""What a perfect calibration of the virtual unit would find. For tests and demonstrations; no procedure sees
it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.inertial.sensor_model import Vector
from ahrs_lab.inertial.sensor_noise import GRID_S
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.simulation.ahrs import rate_units_per_dps
from ahrs_lab.simulation.bench import world_of
from ahrs_lab.simulation.world import World

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Truth:
    """The unit's constants in the terms of JJF 1536.

    ``K``: output unit per °/s, before the nonlinearity (see :meth:`fitted_scale_factor`); ``B_dps``: constant
    part of the zero offset, output scaled to °/s by the unit (for LSB: by K); ``L``: misalignment, keys like
    "yx".
    """

    K: Vector
    B_dps: Vector
    L: dict[str, float]
    world: World

    def fitted_scale_factor(self, rates_dps: tuple[float, ...]) -> Vector:
        """What least squares over ``rates_dps`` gives with the cubic nonlinearity, for the rates as
        demanded."""
        rates = np.array(rates_dps)
        centred = rates - rates.mean()
        gyro = self.world.settings.sensor.gyro
        share = float(centred @ rates**3) / float(centred @ centred) / gyro.nonlinearity_rate_dps**2
        x, y, z = (k * (1.0 + c * share) for k, c in zip(self.K, gyro.nonlinearity, strict=True))
        return (x, y, z)

    def mean_offset_dps(self, start_s: float, stop_s: float) -> Array:
        """Shape (3,), °/s as B_dps: the mean zero offset over bench time ``start_s`` … ``stop_s``, with all
        that drifted (bias instability, random walk, turn-on, start-up, temperature) but without white
        noise."""
        sessions = [s for s in self.world.ahrs.sessions if s.started_s <= start_s]
        if not sessions:
            raise InputError("The unit had no power at {t_s} s of bench time.", t_s=start_s)
        first, last = int(start_s / GRID_S), int(np.ceil(stop_s / GRID_S))
        nodes = self.world.sensors.drift(sessions[-1], first, max(last, first + 1))[:3]
        times = np.arange(first, max(last, first + 1) + 1) * GRID_S
        inside = np.concatenate(([start_s], times[(times > start_s) & (times < stop_s)], [stop_s]))
        drift = [
            float(np.trapezoid(np.interp(inside, times, row), inside)) / (stop_s - start_s) for row in nodes
        ]
        return np.asarray(np.array(self.B_dps) + _shown_scale(self.world) * np.array(drift), dtype=np.float64)


def truth(bench: Bench) -> Truth:
    """The truth behind a bench of :func:`~ahrs_lab.simulation.bench.build_bench`."""
    world = world_of(bench)
    gyro = world.settings.sensor.gyro
    unit = rate_units_per_dps(world.settings.device)
    shown = _shown_scale(world)
    x, y, z = (k * unit for k in gyro.scale_factor)
    bx, by, bz = (float(b) for b in shown * np.array(gyro.bias_dps))
    L = {
        AXES[i] + AXES[j]: float(shown[i]) * gyro.misalignment_rad[i][j]
        for i in range(3)
        for j in range(3)
        if i != j
    }
    return Truth((x, y, z), (bx, by, bz), L, world)


def _shown_scale(world: World) -> Array:
    """Shape (3,): N in degrees per degree turned. A unit that shows degrees shows its scale factor too;
    counts are scaled by the fitted K, which takes it out."""
    scale = np.array(world.settings.sensor.gyro.scale_factor)
    return np.ones(3) if world.settings.device.rate_unit == "LSB" else scale
