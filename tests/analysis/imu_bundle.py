"""Recordings of an inertial unit on an ideal table, made from the models alone and written as bundles.

Rows are exact means over their interval. While the table turns, its angle is linear within an interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2, earth_rate_enu_dps, normal_gravity_mps2
from ahrs_lab.metrology.imu_calibration import SCHEMES, AccelCoefficients, Coefficients, GyroCoefficients
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write_whole import write_recording

Array = NDArray[np.float64]
Made = tuple[Segment, Samples]

SITE = Site(39.9042, 50.0)
GRAVITY_MPS2 = float(normal_gravity_mps2(39.9042, 50.0))
EARTH_DPS = earth_rate_enu_dps(39.9042)
TURNED_UP = ("UWS", "SUW", "NWU")


def unit(seed: int = 1, rate_scale: float = 1.0, accel_scale: float = 1.0) -> Coefficients:
    """A poor MEMS unit."""
    rng = np.random.default_rng(seed)
    E, K = rng.normal(0.0, 2e-3, (2, 3, 3))
    np.fill_diagonal(E, 0.0)
    np.fill_diagonal(K, 0.0)
    return Coefficients(
        GyroCoefficients(
            rate_scale * rng.uniform(0.99, 1.01, 3), rng.normal(0, 0.01, 3), rng.normal(0, 1e-4, (3, 3)), E
        ),
        AccelCoefficients(accel_scale * rng.uniform(0.99, 1.01, 3), rng.normal(0, 0.02, 3), K),
    )


@dataclass
class Recorder:
    """One unit. White noise densities in °/√s and (m/s²)·√s."""

    unit: Coefficients
    rate_unit: str = "deg/s"
    accel_unit: str = "m/s^2"
    sample_rate_hz: float = 20.0
    gyro_density: float = 0.0
    accel_density: float = 0.0
    table_angle: bool = True
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(7))
    clock_s: float = 0.0

    def header(self, procedure: str = "imu-discrete", **notes: object) -> RecordingHeader:
        device = DeviceDescription(
            serial_number="T-1",
            rate_unit=self.rate_unit,  # type: ignore[arg-type]
            accel_unit=self.accel_unit,  # type: ignore[arg-type]
            sample_rate_hz=self.sample_rate_hz,
        )
        return RecordingHeader(procedure, SITE, device, notes=dict(notes))

    def output(self, rate_dps: Array, force_mps2: Array) -> tuple[Array, Array]:
        """(2-28), (2-27) for rows (n, 3), with noise."""
        g, a = self.unit.gyro, self.unit.accel
        per_row = np.sqrt(self.sample_rate_hz)
        noise = self.rng.standard_normal((2, *rate_dps.shape)) * per_row
        gyro = g.E1 * (
            g.B0 + force_mps2 @ g.Bf.T + rate_dps @ (np.eye(3) + g.E).T + self.gyro_density * noise[0]
        )
        accel = a.K1 * (a.K0 + force_mps2 @ (np.eye(3) + a.K).T + self.accel_density * noise[1])
        return gyro, accel

    def samples(self, matrix: Array, angle_deg: Array) -> Samples:
        """The case standing as ``matrix`` at table angle 0; angles at the edges, shape (n + 1,)."""
        theta, step = np.radians(angle_deg), np.diff(np.radians(angle_deg))
        middle, shrink = 0.5 * (theta[1:] + theta[:-1]), np.sinc(step / (2.0 * np.pi))
        _, north, up = EARTH_DPS
        table = np.column_stack(
            [
                north * shrink * np.sin(middle),
                north * shrink * np.cos(middle),
                up + np.degrees(step) * self.sample_rate_hz,
            ]
        )
        force = np.broadcast_to(np.array([0.0, 0.0, GRAVITY_MPS2]), table.shape) @ matrix
        return self.shown(table @ matrix, force, np.degrees(theta[1:]) if self.table_angle else None)

    def shown(self, rate_dps: Array, force_mps2: Array, table_deg: Array | None = None) -> Samples:
        gyro, accel = self.output(rate_dps, force_mps2)
        t_s = self.clock_s + np.arange(1, len(rate_dps) + 1) / self.sample_rate_hz
        self.clock_s = float(t_s[-1]) + 10.0
        columns = {"t_s": t_s}
        columns |= {f"gyro_{axis}": gyro[:, i] for i, axis in enumerate("xyz")}
        columns |= {f"accel_{axis}": accel[:, i] for i, axis in enumerate("xyz")}
        if table_deg is not None:
            columns["table_angle_deg"] = table_deg % 360.0
        return Samples(columns)

    def position(
        self, letters: str, number: int, duration_s: float = 20.0, azimuth_deg: float | None = None
    ) -> Made:
        segment = Segment(
            f"position_{number:02}",
            Orientation(letters),
            "static",
            Orientation(letters).up_axis,
            "position",
            position=number,
            azimuth_deg=azimuth_deg,
            file=f"segments/position_{number:02}.csv",
        )
        between = np.radians(0.0 if azimuth_deg is None else azimuth_deg - 90.0 * round(azimuth_deg / 90.0))
        turn = np.array(
            [
                [np.cos(between), -np.sin(between), 0.0],
                [np.sin(between), np.cos(between), 0.0],
                [0.0, 0.0, 1.0],
            ]
        )
        still = np.zeros(round(duration_s * self.sample_rate_hz) + 1)
        return segment, self.samples(turn @ Orientation(letters).matrix, still)

    def turns(self, letters: str, turns: int, rate_dps: float = 90.0) -> Made:
        """A second at rest, a ramp of half a second, the turns, a ramp, a second at rest."""
        orientation = Orientation(letters)
        name = f"turns_{letters}_{'p' if turns > 0 else 'm'}"
        segment = Segment(
            name,
            orientation,
            "rotation",
            orientation.up_axis,
            "turns",
            rate_dps=rate_dps * np.sign(turns),
            turns=turns,
            file=f"segments/{name}.csv",
        )
        end = 360.0 * abs(turns) / rate_dps + 0.5
        after = np.clip(
            np.arange(round((end + 2.0) * self.sample_rate_hz) + 1) / self.sample_rate_hz - 1.0, 0.0, end
        )
        ramped = np.where(
            after < 0.5, after**2, np.where(after > end - 0.5, end - 0.5 - (end - after) ** 2, after - 0.25)
        )
        return segment, self.samples(orientation.matrix, np.sign(turns) * rate_dps * ramped)

    def everything(self, scheme: str = "12", turns: int = 5, duration_s: float = 20.0) -> list[Made]:
        made = [self.turns(up, sign * turns) for up in TURNED_UP for sign in (1, -1)]
        made += [self.position(letters, i, duration_s) for i, letters in enumerate(SCHEMES[scheme], 1)]
        return made

    def moving(self, name: str, rate_dps: Array, force_mps2: Array) -> Made:
        segment = Segment(name, Orientation("ENU"), "dynamic", "z", "position", file=f"{name}.csv")
        return segment, self.shown(rate_dps, force_mps2)

    def write(
        self, folder: Path, made: Sequence[Made], procedure: str = "imu-discrete", **notes: object
    ) -> Path:
        write_recording(folder, self.header(procedure, **notes), made)
        return folder


def changed(made: Sequence[Made], index: int, **columns: Array | None) -> list[Made]:
    """With columns of one segment replaced, or taken away."""
    segment, samples = made[index]
    kept = {n: c for n, c in samples.columns.items() if n not in columns}
    added = {n: c for n, c in columns.items() if c is not None}
    return [*made[:index], (segment, Samples({**kept, **added})), *made[index + 1 :]]


def altered(made: Sequence[Made], index: int, **fields: object) -> list[Made]:
    """With fields of one segment's description changed."""
    segment, samples = made[index]
    segment = replace(segment, **fields)  # type: ignore[arg-type]
    return [*made[:index], (segment, samples), *made[index + 1 :]]


ONE_G = 1.0 / STANDARD_GRAVITY_MPS2
