"""Grades of sensors and tables to start from.

Noise, scale error and misalignment are typical of the grade. Guesses, where data sheets of the grade do not
agree or do not say: turn-on, quantisation, rate random walk, noise and bias instability of the
accelerometers of the ring-laser and tactical fibre-optic units (what data sheets give of these is the bias
from one power-on to the next). A unit's own constants (which axis is off by how much) are set so that no two
axes agree, for a calibration to find.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass

from ahrs_lab.errors import InputError
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2
from ahrs_lab.inertial.sensor_model import AccelModel, GyroModel, Matrix, Vector
from ahrs_lab.messages import Message
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.settings import (
    AccelNoise,
    GyroNoise,
    SensorSettings,
    SimulationSettings,
    Stability,
    TableSettings,
    simulation_from_toml,
)

_MICRO_G = 1e-6 * STANDARD_GRAVITY_MPS2
_DPH = 1.0 / 3600.0
_WALK_PER_INSTABILITY = 0.3
"""°/h/√h per °/h: the Allan deviation leaves its floor after half a day."""


@dataclass(frozen=True)
class Grade:
    """A grade of unit.

    Gyros: angle random walk °/√h, bias ``instability`` and ``turn_on`` °/h, ``scale`` error, ``nonlinearity``
    and ``misalignment`` relative, ``g_sensitivity`` °/h/g, ``quantisation_arcsec``. Accelerometers: noise
    (m/s²)·√s, bias instability and turn-on m/s², scale error relative.
    """

    angle_random_walk: float
    instability: float
    turn_on: float
    scale: float
    nonlinearity: float
    misalignment: float
    accel_noise: float
    accel_instability: float
    accel_scale: float
    g_sensitivity: float = 0.0
    quantisation_arcsec: float = 0.0
    accel_turn_on: float = 0.0
    range_dps: float = 400.0


GRADES: Mapping[str, Grade] = {
    "industrial-mems": Grade(
        angle_random_walk=0.21, instability=6.0, turn_on=10.0,
        scale=1e-3, nonlinearity=8e-5, misalignment=8.7e-4,
        accel_noise=140 * _MICRO_G, accel_instability=40 * _MICRO_G, accel_scale=1e-3,
    ),
    "tactical-mems": Grade(
        angle_random_walk=0.15, instability=0.5, turn_on=2.0, g_sensitivity=1.0,
        scale=5e-4, nonlinearity=4e-5, misalignment=1e-3,
        accel_noise=0.06 / 60.0, accel_instability=50 * _MICRO_G, accel_scale=5e-4,
    ),
    "tactical-rlg": Grade(
        angle_random_walk=0.125, instability=1.0, turn_on=1.0, quantisation_arcsec=1.0,
        scale=1.5e-4, nonlinearity=1e-5, misalignment=3e-4, range_dps=800.0,
        accel_noise=50 * _MICRO_G, accel_instability=50 * _MICRO_G, accel_turn_on=1000 * _MICRO_G,
        accel_scale=3e-4,
    ),
    "tactical-fog": Grade(
        angle_random_walk=0.07, instability=1.0, turn_on=1.0, quantisation_arcsec=0.1,
        scale=1e-4, nonlinearity=1e-5, misalignment=1e-4, range_dps=800.0,
        accel_noise=50 * _MICRO_G, accel_instability=30 * _MICRO_G, accel_turn_on=300 * _MICRO_G,
        accel_scale=3e-4,
    ),
    "fog": Grade(
        angle_random_walk=0.012, instability=0.05, turn_on=0.05, quantisation_arcsec=0.05,
        scale=5e-5, nonlinearity=1e-5, misalignment=1e-4, range_dps=500.0,
        accel_noise=120 * _MICRO_G, accel_instability=50 * _MICRO_G, accel_scale=2e-4,
    ),
    "navigation-rlg": Grade(
        angle_random_walk=0.002, instability=0.0035, turn_on=0.003, quantisation_arcsec=0.5,
        scale=5e-6, nonlinearity=1e-6, misalignment=5e-5,
        accel_noise=10 * _MICRO_G, accel_instability=5 * _MICRO_G, accel_turn_on=25 * _MICRO_G,
        accel_scale=1e-4,
    ),
    # the classes of the textbook's tables 2-1 and 2-2, at the middle of their ranges; their noise is a guess
    "dynamically-tuned": Grade(
        angle_random_walk=0.02, instability=0.3, turn_on=0.5, g_sensitivity=3.0,
        scale=2e-4, nonlinearity=5e-5, misalignment=1e-4,
        accel_noise=20 * _MICRO_G, accel_instability=30 * _MICRO_G, accel_scale=1e-4,
    ),
    # a tuning fork of quartz, the rate grade of table 2-1
    "vibratory": Grade(
        angle_random_walk=0.6, instability=10.0, turn_on=36.0,
        scale=1e-3, nonlinearity=5e-4, misalignment=5e-3, range_dps=100.0,
        accel_noise=200 * _MICRO_G, accel_instability=100 * _MICRO_G, accel_scale=1e-3,
    ),
    "strategic": Grade(
        angle_random_walk=1e-4, instability=5e-4, turn_on=5e-4, quantisation_arcsec=0.05,
        scale=1e-6, nonlinearity=5e-7, misalignment=1e-5, range_dps=100.0,
        accel_noise=1 * _MICRO_G, accel_instability=1 * _MICRO_G, accel_scale=1e-6,
    ),
}  # fmt: skip

_SCALE_PATTERN: Vector = (1.0, -0.8, 0.3)
_BIAS_PATTERN: Vector = (1.0, -0.7, 0.6)
_CROSS_PATTERN: Matrix = ((0.0, 0.69, -0.49), (-0.31, 0.0, 1.0), (0.45, -0.82, 0.0))


def sensor_preset(name: object) -> SensorSettings:
    """The sensors of a grade by name, "ideal" for none of its errors."""
    if name == "ideal":
        return SensorSettings()
    grade = GRADES.get(str(name))
    if grade is None:
        raise _unknown(Message("sensor"), name, ("ideal", *GRADES))
    bias_dps = 3.0 * max(grade.turn_on, grade.instability) * _DPH
    cross = _times_matrix(grade.misalignment, _CROSS_PATTERN)
    g_sensitivity = grade.g_sensitivity * _DPH / STANDARD_GRAVITY_MPS2
    return SensorSettings(
        gyro=GyroModel(
            scale_factor=_one_plus(grade.scale, _SCALE_PATTERN),
            bias_dps=_times(bias_dps, _BIAS_PATTERN),
            g_sensitivity=_diagonal(g_sensitivity),
            misalignment_rad=cross,
            nonlinearity=_times(grade.nonlinearity, (1.0, -0.6, 0.75)),
            range_dps=grade.range_dps,
        ),
        gyro_noise=GyroNoise(
            angle_random_walk_deg_per_sqrt_h=grade.angle_random_walk,
            bias_instability_deg_per_h=grade.instability,
            rate_random_walk_deg_per_h_per_sqrt_h=_WALK_PER_INSTABILITY * grade.instability,
            quantisation_arcsec=grade.quantisation_arcsec,
        ),
        gyro_stability=Stability(turn_on=grade.turn_on * _DPH),
        accel=AccelModel(
            scale_factor=_one_plus(grade.accel_scale, _SCALE_PATTERN),
            bias_mps2=_times(max(10.0 * grade.accel_instability, 3.0 * grade.accel_turn_on), _BIAS_PATTERN),
            misalignment_rad=cross,
        ),
        accel_stability=Stability(turn_on=grade.accel_turn_on),
        accel_noise=AccelNoise(
            velocity_random_walk_mps_per_sqrt_s=grade.accel_noise,
            bias_instability_mps2=grade.accel_instability,
        ),
    )


TABLES: Mapping[str, TableSettings] = {
    "ideal": TableSettings(),
    "standard": TableSettings(
        name="single-axis position and rate table",
        rate_error=(2e-4, 5e-5, 1e-5),
        rate_noise_dps=5e-5,
        position_error_arcsec=2.0,
        position_error_phase_deg=40.0,
        encoder_resolution_deg=0.0001,
        wobble_arcsec=1.0,
        wobble_harmonic=2,
        wobble_phase_deg=25.0,
        tilt_east_arcsec=3.0,
        tilt_north_arcsec=-2.0,
        north_misalignment_arcsec=20.0,
    ),
    "clause-6-limit": TableSettings(
        name="single-axis table at the limits of clause 6",
        rate_error=(1e-2, 1e-3, 1e-4),
        rate_noise_dps=1e-4,
        position_error_arcsec=5.0,
        encoder_resolution_deg=0.0002,
        wobble_arcsec=2.0,
        wobble_harmonic=1,
        tilt_east_arcsec=5.0,
        tilt_north_arcsec=5.0,
        north_misalignment_arcsec=60.0,
    ),
}


def table_preset(name: object) -> TableSettings:
    """A table by name."""
    table = TABLES.get(str(name))
    if table is None:
        raise _unknown(Message("table"), name, tuple(TABLES))
    return table


def demonstration() -> SimulationSettings:
    """The bench of ``ahrs-lab demo``, from its file: a MEMS unit with known constants on a table within
    clause 6."""
    data = tomllib.loads(resource_path("benches/demo.toml").read_text(encoding="utf-8"))
    data.pop("kind")
    return simulation_from_toml(data)


def _unknown(what: Message, name: object, known: tuple[str, ...]) -> InputError:
    return InputError(
        "“{name}” is not a preset of the virtual bench's {what}; there are: {known}.",
        name=name,
        what=what,
        known=", ".join(known),
    )


def _times(factor: float, pattern: Vector) -> Vector:
    x, y, z = pattern
    return (factor * x, factor * y, factor * z)


def _times_matrix(factor: float, pattern: Matrix) -> Matrix:
    x, y, z = pattern
    return (_times(factor, x), _times(factor, y), _times(factor, z))


def _one_plus(factor: float, pattern: Vector) -> Vector:
    x, y, z = _times(factor, pattern)
    return (1.0 + x, 1.0 + y, 1.0 + z)


def _diagonal(value: float) -> Matrix:
    return ((value, 0.0, 0.0), (0.0, value, 0.0), (0.0, 0.0, value))
