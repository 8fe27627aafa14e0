"""What is known of a unit that shall align itself: its noise, from the recording; whether the biases that a
unit at rest shows contradict those assumed; and whether it can find north at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.alignment import CoarseAlignment, Place, SensorNoise, UnitModel
from ahrs_lab.inertial.alignment_steps import Steps
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS
from ahrs_lab.messages import Message
from ahrs_lab.metrology.uncertainty.noise import batch_means, fit_noise

Array = NDArray[np.float64]

RADPS_PER_DEG_PER_H = float(np.radians(1.0)) / 3600.0
GRAVITY_ANOMALY_MPS2 = 5e-4
"""Standard deviation of gravity on the ground about the normal one (50 mGal)."""
_FLICKER_AS_WALK = 2.65
"""A random walk of K² = 2.65 B²/T has flicker's Allan variance at half the record, T/2."""
QUIETEST = (1e-10, 1e-8)
"""Of gyros, rad/√s, and accelerometers, (m/s²)·√s: below those of any sensor."""
_CLEARLY = 2.0
"""Standard deviations of the fit."""
_CONTRADICTED = (13.8, 10.8)
"""χ² that is exceeded once in a thousand times: of the two gyro biases, of the accelerometer's."""
_STEEPEST_DEG = 89.0
_NEXT_TO_THE_POLE_DEG = 89.999
"""Beyond it no bias is small enough: where north is depends on what is called up."""


def noise_of(record: InertialRecord, values: Array, quietest: float) -> SensorNoise:
    """Of each axis, from the Allan variances of the recording. Flicker that the recording does not clearly
    show is left to the assumed bias, which it is a part of. White noise is at least ``quietest``: simulated
    readings may have none."""
    interval = 1.0 / record.header.device.sample_rate_hz
    duration_s = float(record.interval_s.sum())
    terms = []
    for channel in values.T:
        batches, batch_s = batch_means(channel, interval)
        fit = fit_noise([batches - batches.mean()], batch_s)
        flicker = fit.flicker**2
        if fit.covariance is None or flicker < _CLEARLY * np.sqrt(fit.covariance[2][2]):
            flicker = 0.0
        walk = np.sqrt(fit.walk**2 + _FLICKER_AS_WALK * flicker / duration_s)
        terms.append((max(fit.white, quietest), walk, fit.quantisation))
    return SensorNoise(*np.transpose(terms))


def held_against(steps: Steps, place: Place, unit: UnitModel) -> tuple[UnitModel, tuple[Message, ...]]:
    """The unit with a wider assumption where the biases that a unit at rest shows contradict it."""
    rate, force = steps.means()
    size = float(np.linalg.norm(force))
    up = float(rate @ force) / size
    north = float(np.sqrt(max(float(rate @ rate) - up**2, 0.0)))
    gyro = np.array([north - place.north_radps, up - place.up_radps])
    accel = size - place.gravity_mps2
    duration_s = float(steps.duration_s.sum())
    gyro_noise = float(unit.gyro_noise.mean_variance(duration_s).max())
    accel_noise = float(unit.accel_noise.mean_variance(duration_s).max())
    tilt = (unit.accel_bias_mps2 / place.gravity_mps2 * EARTH_RATE_RADPS) ** 2
    warnings = []
    if float(gyro @ gyro) > _CONTRADICTED[0] * (unit.gyro_bias_radps**2 + gyro_noise + tilt):
        wider = float(np.sqrt(gyro @ gyro / 2.0))
        warnings.append(
            Message(
                "The north and up gyro biases are {north} and {up} °/h, which contradicts the assumed "
                "{assumed} °/h: {used} °/h is taken for the east gyro instead.",
                north=f"{gyro[0] / RADPS_PER_DEG_PER_H:.3g}",
                up=f"{gyro[1] / RADPS_PER_DEG_PER_H:.3g}",
                assumed=f"{unit.gyro_bias_radps / RADPS_PER_DEG_PER_H:.3g}",
                used=f"{wider / RADPS_PER_DEG_PER_H:.3g}",
            )
        )
        unit = replace(unit, gyro_bias_radps=wider)
    variance = unit.accel_bias_mps2**2 + GRAVITY_ANOMALY_MPS2**2 + accel_noise
    if accel**2 > _CONTRADICTED[1] * variance:
        warnings.append(
            Message(
                "The specific force is {excess} m/s² off normal gravity, which contradicts the assumed "
                "accelerometer bias of {assumed} m/s²: that deviation is taken for the level axes instead.",
                excess=f"{accel:.2g}",
                assumed=f"{unit.accel_bias_mps2:.2g}",
            )
        )
        unit = replace(unit, accel_bias_mps2=abs(accel))
    return unit, tuple(warnings)


def refuse_poles(place: Place, unit: UnitModel, heading_limit_deg: float) -> None:
    """Raises InputError where the assumed biases alone make the heading worse than the limit."""
    limit = np.radians(heading_limit_deg)
    level = (unit.accel_bias_mps2 / place.gravity_mps2) ** 2
    cosine_squared = ((unit.gyro_bias_radps / EARTH_RATE_RADPS) ** 2 + level) / (limit**2 + level)
    highest = _NEXT_TO_THE_POLE_DEG
    if cosine_squared < 1.0:
        highest = min(float(np.degrees(np.arccos(np.sqrt(cosine_squared)))), highest)
    latitude = float(np.degrees(place.latitude_rad))
    if abs(latitude) > highest:
        raise InputError(
            "At latitude {latitude}° a unit at rest does not find north: the horizontal part of the Earth's "
            "rate, ω_ie·cos L = {rate} °/h, is too small against gyro biases of {bias} °/h; from latitude "
            "{highest}° on the heading would be uncertain by more than {limit}°. Align it against a "
            "reference instead, or state a smaller gyro bias if it is known.",
            latitude=f"{latitude:.4f}",
            rate=f"{abs(place.north_radps) / RADPS_PER_DEG_PER_H:.3g}",
            bias=f"{unit.gyro_bias_radps / RADPS_PER_DEG_PER_H:.3g}",
            highest=f"{highest:.3f}",
            limit=f"{heading_limit_deg:g}",
        )


def refuse_unsure(
    coarse: CoarseAlignment, place: Place, unit: UnitModel, heading_limit_deg: float, record: InertialRecord
) -> None:
    """Raises InputError where biases and noise together make the heading worse than the limit."""
    sigma = float(np.degrees(np.sqrt(coarse.covariance[2, 2])))
    if sigma > heading_limit_deg:
        raise InputError(
            "{file}: the heading would be uncertain by {sigma}° (limit {limit}°): with gyro biases of {bias} "
            "°/h and this noise, {seconds} s at rest do not find the horizontal Earth rate of {rate} °/h. "
            "Use better or calibrated gyros, a longer recording, or make sure that the unit was at rest.",
            file=record.segment.file,
            sigma=f"{sigma:.2g}",
            limit=f"{heading_limit_deg:g}",
            bias=f"{unit.gyro_bias_radps / RADPS_PER_DEG_PER_H:.3g}",
            seconds=f"{record.interval_s.sum():.0f}",
            rate=f"{place.north_radps / RADPS_PER_DEG_PER_H:.3g}",
        )


def refuse_steep(C_bn: Array, forward: int, record: InertialRecord) -> None:
    """Raises InputError where the forward axis (0, 1, 2 of the case) is so near the vertical that heading and
    roll cannot be told apart."""
    pitch = float(np.degrees(np.arcsin(np.clip(C_bn[2, forward], -1.0, 1.0))))
    if abs(pitch) > _STEEPEST_DEG:
        raise InputError(
            "{file}: the forward axis {axis} points along the vertical (pitch {pitch}°): heading and roll "
            "turn about the same line there. Choose other axes for the angles, or mount the unit otherwise.",
            file=record.segment.file,
            axis="xyz"[forward],
            pitch=f"{pitch:.2f}",
        )
