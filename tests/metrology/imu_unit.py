"""An inertial unit and what it shows on an ideal bench, by (2-27), (2-28) alone: the truth for calibrations.

Rates during turns are integrated numerically over the table's motion, ramps and rests with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.earth import earth_rate_enu_dps, normal_gravity_mps2
from ahrs_lab.metrology.imu_calibration import (
    SCHEMES,
    AccelCoefficients,
    Coefficients,
    GyroCoefficients,
    PositionData,
    RotationData,
    case_to_enu,
)
from ahrs_lab.metrology.imu_estimation import ReferenceVectors

Array = NDArray[np.float64]

LATITUDE_DEG = 39.9042
REFERENCE = ReferenceVectors(float(normal_gravity_mps2(LATITUDE_DEG)), earth_rate_enu_dps(LATITUDE_DEG))
UP = ("UWS", "DWN", "SUW", "NDW", "NWU", "SWD")
TURNED_UP = ("UWS", "SUW", "NWU")


def random_unit(rng: np.random.Generator, *, counts: bool = True) -> Coefficients:
    """Errors of a poor MEMS unit, or worse; scale factors of one or of counts, also negative ones."""
    E, K = rng.normal(0.0, 1e-2, (2, 3, 3))
    np.fill_diagonal(E, 0.0)
    np.fill_diagonal(K, 0.0)
    size = (
        10.0 ** rng.uniform(0.0, 5.0, (2, 3)) * rng.choice((-1.0, 1.0), (2, 3)) if counts else np.ones((2, 3))
    )
    scale = size * rng.uniform(0.9, 1.1, (2, 3))
    return Coefficients(
        GyroCoefficients(scale[0], rng.normal(0.0, 0.1, 3), rng.normal(0.0, 1e-3, (3, 3)), E),
        AccelCoefficients(scale[1], rng.normal(0.0, 0.1, 3), K),
    )


@dataclass(frozen=True)
class Shown:
    """Of one unit: white densities N in °/√s and (m/s²)·√s, drawn by :meth:`drawn` alone."""

    unit: Coefficients
    gyro_density: float = 0.0
    accel_density: float = 0.0
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(1))

    def gyro(self, rate_dps: Array, force_mps2: Array) -> Array:
        g = self.unit.gyro
        return np.array(
            [
                g.E1[i]
                * (
                    g.B0[i]
                    + rate_dps[i]
                    + sum(g.Bf[i, j] * force_mps2[j] + g.E[i, j] * rate_dps[j] for j in range(3))
                )
                for i in range(3)
            ]
        )

    def accel(self, force_mps2: Array) -> Array:
        a = self.unit.accel
        return np.array(
            [
                a.K1[i] * (a.K0[i] + force_mps2[i] + sum(a.K[i, j] * force_mps2[j] for j in range(3)))
                for i in range(3)
            ]
        )

    def position(self, matrix: Array, duration_s: float = 60.0, **more: object) -> PositionData:
        force = matrix.T @ np.array([0.0, 0.0, REFERENCE.gravity_mps2])
        gyro_error = np.abs(self.unit.gyro.E1) * self.gyro_density / np.sqrt(duration_s)
        accel_error = np.abs(self.unit.accel.K1) * self.accel_density / np.sqrt(duration_s)
        found = PositionData(
            case_to_enu=matrix,
            gyro=self.gyro(matrix.T @ REFERENCE.earth_rate_enu_dps, force),
            accel=self.accel(force),
            duration_s=duration_s,
            gyro_error=gyro_error,
            accel_error=accel_error,
        )
        return replace(found, **more)  # type: ignore[arg-type]

    def turns(
        self, letters: str, turns: int, rate_dps: float = 100.0, *, ramp_s: float = 0.0
    ) -> RotationData:
        """A second at rest, a ramp, whole turns with both ramps, a ramp, a second at rest; without a ramp at
        constant rate all the time."""
        matrix = case_to_enu(letters)
        angle = _angle(360.0 * turns, rate_dps, ramp_s)
        middle, step = 0.5 * (angle[1][1:] + angle[1][:-1]), np.diff(angle[0])
        duration = float(angle[0][-1])
        cosine, sine = np.cos(np.radians(middle)), np.sin(np.radians(middle))
        _, north, up = REFERENCE.earth_rate_enu_dps
        earth = np.array([north * sine @ step, north * cosine @ step, up * duration])  # seen from the table
        rate = matrix.T @ (earth + np.array([0.0, 0.0, 360.0 * turns])) / duration
        force = matrix.T @ np.array([0.0, 0.0, REFERENCE.gravity_mps2])
        error = np.abs(self.unit.gyro.E1) * self.gyro_density * np.sqrt(duration)
        return RotationData(
            case_to_enu=matrix,
            turned_deg=360.0 * turns,
            duration_s=duration,
            angle=self.gyro(rate, force) * duration,
            angle_error=error,
            mean_cosine=float(cosine @ step) / duration,
            mean_sine=float(sine @ step) / duration,
        )

    def all_turns(self, turns: int = 10, *, ramp_s: float = 0.0) -> list[RotationData]:
        return [self.turns(up, sign * turns, ramp_s=ramp_s) for up in TURNED_UP for sign in (1, -1)]

    def scheme(self, name: str, duration_s: float = 60.0) -> list[PositionData]:
        return [self.position(case_to_enu(letters), duration_s, name=letters) for letters in SCHEMES[name]]

    def drawn(
        self, positions: Sequence[PositionData], rotations: Sequence[RotationData]
    ) -> tuple[list[PositionData], list[RotationData]]:
        """The same data with noise."""
        noise = self.rng.standard_normal
        return (
            [
                replace(p, gyro=p.gyro + p.gyro_error * noise(3), accel=p.accel + p.accel_error * noise(3))
                for p in positions
            ],
            [replace(r, angle=r.angle + r.angle_error * noise(3)) for r in rotations],
        )


def _angle(total_deg: float, rate_dps: float, ramp_s: float) -> tuple[Array, Array]:
    """Times and table angles."""
    if not ramp_s:
        duration = abs(total_deg) / rate_dps
        times = np.linspace(0.0, duration, 2001)
        return times, times / duration * total_deg
    times = np.linspace(0.0, abs(total_deg) / rate_dps + ramp_s + 2.0, 200001)
    after = np.clip(times - 1.0, 0.0, times[-1] - 2.0)
    speed = np.minimum(np.minimum(after, times[-1] - 2.0 - after) / ramp_s, 1.0)
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times))])
    return times, angle / angle[-1] * total_deg


def limits(
    unit: Coefficients, positions: Sequence[PositionData], rotations: Sequence[RotationData]
) -> tuple[Array, Array]:
    """Cramér–Rao standard deviations of each channel, (3, 7) and (3, 4), from Fisher's information:
    derivatives of the models by differences at the truth, one unknown offset for each axis that turned."""
    exact = Shown(unit)
    forces = [p.case_to_enu.T @ np.array([0.0, 0.0, REFERENCE.gravity_mps2]) for p in positions]

    def shown(gyro: Array, accel: Array) -> tuple[Array, Array]:
        trial = Shown(Coefficients.from_vectors(gyro, accel))
        rests = [
            trial.gyro(p.case_to_enu.T @ REFERENCE.earth_rate_enu_dps, f)
            for p, f in zip(positions, forces, strict=True)
        ]
        turns = []
        for r in rotations:
            up = r.case_to_enu.T @ np.array([0.0, 0.0, 1.0])
            rate = up * (r.turned_deg / r.duration_s)
            turns.append(trial.gyro(rate, np.zeros(3)) - trial.unit.gyro.E1 * trial.unit.gyro.B0)
        return np.array([*turns, *rests]), np.array([trial.accel(f) for f in forces])

    gyro, accel = exact.unit.vectors()
    base = shown(gyro, accel)
    result = []
    for part, (vectors, zero) in enumerate(zip((gyro, accel), base, strict=True)):
        columns = []
        for k in range(vectors.shape[1]):
            step = np.where(vectors[:, k] == 0.0, 1e-3, 1e-6 * np.abs(vectors[:, k]) + 1e-9)
            changed = vectors.copy()
            changed[:, k] += step
            now = shown(changed, accel)[0] if part == 0 else shown(gyro, changed)[1]
            columns.append((now - zero) / step)
        jacobian = np.array(columns)  # (p, m, 3)
        if part == 0:
            errors = np.array(
                [*(r.angle_error / r.duration_s for r in rotations), *(p.gyro_error for p in positions)]
            )
            axes = sorted({r.axis for r in rotations})
            offsets = np.zeros((len(axes), len(errors), 3))
            for row, r in enumerate(rotations):
                offsets[axes.index(r.axis), row] = 1.0
            jacobian = np.concatenate([jacobian, offsets * np.abs(exact.unit.gyro.E1)])
        else:
            errors = np.array([p.accel_error for p in positions])
        limit = []
        for i in range(3):
            weighted = jacobian[:, :, i] / errors[:, i]
            size = np.linalg.norm(weighted, axis=1)
            inverse = np.linalg.inv((weighted / size[:, None]) @ (weighted / size[:, None]).T)
            limit.append((np.sqrt(np.diag(inverse)) / size)[: vectors.shape[1]])
        result.append(np.array(limit))
    return result[0], result[1]
