"""Self-alignment (2.5.2) of a recorded unit at rest: heading, pitch and roll with their uncertainty.

The latitude comes from the recording's header, the noise from the recording itself. What no recording at rest
shows – the constant biases of the gyro that points east and of the level accelerometers – is an assumption:
its standard deviation is a setting, and the uncertainty of heading, pitch and roll is mostly made of it
(2-104). Biases that can be seen (north and up gyro, up accelerometer) are held against the assumption; where
they contradict it, it is widened, and the report says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.alignment_report import METHOD_NAMES, ORTHOGONALISATION_NAMES, report_of
from ahrs_lab.analysis.alignment_rest import Rest, rest_of
from ahrs_lab.analysis.alignment_unit import (
    GRAVITY_ANOMALY_MPS2,
    QUIETEST,
    RADPS_PER_DEG_PER_H,
    held_against,
    noise_of,
    refuse_poles,
    refuse_steep,
    refuse_unsure,
)
from ahrs_lab.analysis.inertial_record import InertialRecord
from ahrs_lab.analysis.report import Report
from ahrs_lab.inertial.alignment import (
    CoarseAlignment,
    Orthogonalisation,
    Place,
    UnitModel,
    angle_matrix,
    attitude_limit_rad,
    coarse_alignment,
)
from ahrs_lab.inertial.alignment_fine import fine_alignment
from ahrs_lab.inertial.alignment_kalman import KalmanAlignment, kalman_alignment
from ahrs_lab.inertial.alignment_steps import Steps, steps_of
from ahrs_lab.inertial.attitude import attitude_angles_deg
from ahrs_lab.inertial.earth import normal_gravity_mps2
from ahrs_lab.messages import Message

Array = NDArray[np.float64]
Method = Literal["coarse", "fine", "kalman-open", "kalman-closed"]
Axes = Literal["xyz", "yzx"]

METHODS: tuple[Method, ...] = ("coarse", "fine", "kalman-open", "kalman-closed")
GYRO_BIAS_DEG_PER_H = 0.03
ACCEL_BIAS_MPS2 = 1e-3
HEADING_LIMIT_DEG = 5.0
SHORTEST_S: Mapping[Method, float] = {
    "coarse": 20.0,
    "fine": 60.0,
    "kalman-open": 60.0,
    "kalman-closed": 60.0,
}

_FIRST_STEPS = (20, 120)
"""Of the filters' coarse alignment: a fifth of the record within these."""


@dataclass(frozen=True)
class AlignmentSettings:
    """``gyro_bias_deg_per_h``, ``accel_bias_mps2``: assumed standard deviation of each axis' constant error
    in this position (for an accelerometer also misalignment times gravity). ``axes``: which case axes are
    right, forward and up to heading, pitch and roll: "xyz", the textbook's, or "yzx", that of JJF 1536."""

    method: Method = "kalman-closed"
    gyro_bias_deg_per_h: float = GYRO_BIAS_DEG_PER_H
    accel_bias_mps2: float = ACCEL_BIAS_MPS2
    orthogonalisation: Orthogonalisation = "rows"
    axes: Axes = "xyz"
    heading_limit_deg: float = HEADING_LIMIT_DEG


@dataclass(frozen=True)
class Attitude:
    """Heading, pitch, roll and their standard uncertainties, shape (..., 3) each, degrees."""

    angles_deg: Array
    uncertainty_deg: Array


@dataclass(frozen=True)
class Biases:
    """Of the case's axes x, y, z with their standard uncertainties, shape (3,) each: the expectation under
    the assumption, so near zero with nearly the assumed deviation where the recording says nothing."""

    gyro_deg_per_h: Array
    gyro_uncertainty_deg_per_h: Array
    accel_mps2: Array
    accel_uncertainty_mps2: Array


@dataclass(frozen=True)
class Alignment:
    """``attitude`` of ``settings.method``, ``others`` beside it; ``course`` over ``course_s`` (p,);
    ``limit_deg`` (3,) what (2-104) leaves of φ_E, φ_N, φ_U; ``biases`` None where not estimated;
    ``bias_course`` (p, 5) ε_E, ε_N, ε_U (°/h), ∇_E, ∇_N (m/s²) and its standard deviations."""

    file: str
    settings: AlignmentSettings
    place: Place
    unit: UnitModel
    duration_s: float
    attitude: Attitude
    others: tuple[tuple[Message, Attitude], ...]
    limit_deg: Array
    course_s: Array
    course: Attitude | None
    biases: Biases | None
    bias_course: tuple[Array, Array] | None
    warnings: tuple[Message, ...]

    def to_json(self) -> dict[str, Any]:
        """Three numbers each in the order heading, pitch, roll; biases by case axis x, y, z, null where the
        method does not estimate them."""
        heading, pitch, roll = self.attitude.angles_deg.tolist()
        unknown = [None, None, None]
        return {
            "heading_deg": heading,
            "pitch_deg": pitch,
            "roll_deg": roll,
            "standard_uncertainty_deg": self.attitude.uncertainty_deg.tolist(),
            "gyro_bias_deg_per_h": self.biases.gyro_deg_per_h.tolist() if self.biases else unknown,
            "accel_bias_mps2": self.biases.accel_mps2.tolist() if self.biases else unknown,
        }

    def series(self) -> dict[str, Array]:
        """The estimates over time; empty for the coarse method."""
        if self.course is None:
            return {}
        columns = {"t_s": self.course_s}
        for index, name in enumerate(("heading", "pitch", "roll")):
            columns[f"{name}_deg"] = self.course.angles_deg[:, index]
            columns[f"{name}_uncertainty_deg"] = self.course.uncertainty_deg[:, index]
        if self.bias_course is not None:
            for index, name in enumerate(BIAS_COLUMNS):
                columns[name] = self.bias_course[0][:, index]
                columns[f"{name}_uncertainty"] = self.bias_course[1][:, index]
        return columns

    def report(self) -> Report:
        """Tables, charts and what they mean."""
        return report_of(self)


BIAS_COLUMNS = (
    "gyro_bias_east_deg_per_h",
    "gyro_bias_north_deg_per_h",
    "gyro_bias_up_deg_per_h",
    "accel_bias_east_mps2",
    "accel_bias_north_mps2",
)


def align(record: InertialRecord, settings: AlignmentSettings) -> Alignment:
    """Align the unit of ``record``.

    Raises InputError where it moves, where the record is too short, near the poles, and where the gyros
    cannot tell north.
    """
    record = record.needed_si()
    site = record.header.site
    place = Place(
        float(np.radians(site.latitude_deg)), float(normal_gravity_mps2(site.latitude_deg, site.altitude_m))
    )
    unit = UnitModel(settings.gyro_bias_deg_per_h * RADPS_PER_DEG_PER_H, settings.accel_bias_mps2)
    refuse_poles(place, unit, settings.heading_limit_deg)
    rest = rest_of(record, place, SHORTEST_S[settings.method])
    part = rest.record
    rows = max(1, round(part.header.device.sample_rate_hz))
    steps = steps_of(part.rate, part.needed_force(), part.interval_s, rows)
    unit = replace(
        unit,
        gyro_noise=noise_of(part, part.rate, QUIETEST[0]),
        accel_noise=noise_of(part, part.needed_force(), QUIETEST[1]),
    )
    unit, widened = held_against(steps, place, unit)
    coarse = coarse_alignment(*steps.means(), rest.duration_s, place, unit)
    refuse_unsure(coarse, place, unit, settings.heading_limit_deg, part)
    refuse_steep(coarse.C_bn, "xyz".index(settings.axes[1]), part)
    return _aligned(rest, steps, coarse, place, unit, settings, (*rest.warnings, *widened))


def _aligned(
    rest: Rest,
    steps: Steps,
    coarse: CoarseAlignment,
    place: Place,
    unit: UnitModel,
    settings: AlignmentSettings,
    warnings: tuple[Message, ...],
) -> Alignment:
    method, axes = settings.method, settings.axes
    plain = _attitude(coarse.C_bn, coarse.covariance, axes)
    others: list[tuple[Message, Attitude]] = []
    course_s, course, biases, bias_course = np.zeros(0), None, None, None
    if method == "coarse":
        found = {}
        for key, name in ORTHOGONALISATION_NAMES.items():
            one = coarse_alignment(*steps.means(), rest.duration_s, place, unit, key)
            found[key] = _attitude(one.C_bn, one.covariance, axes)
            if key != settings.orthogonalisation:
                others.append((name, found[key]))
        attitude = found[settings.orthogonalisation]
    else:
        others.append((METHOD_NAMES["coarse"], plain))
        if method == "fine":
            fine = fine_alignment(steps, coarse.C_bn, place, unit)
            attitude = _attitude(fine.C_bn, fine.covariance, axes)
            course_s, course = fine.t_s, _attitude(fine.attitudes, fine.covariances, axes)
            warnings = (*warnings, *_drifting(fine.tilt_rate, fine.tilt_rate_deviation, rest.duration_s))
        else:
            run = _filtered(steps, place, unit, method)
            attitude = _attitude(run.C_bn, run.covariance[:3, :3], axes)
            course_s, course = run.t_s, _attitude(run.attitudes, run.attitude_covariances, axes)
            per_hour = np.repeat([1.0 / RADPS_PER_DEG_PER_H, 1.0], [3, 2])
            bias_course = (run.biases * per_hour, run.bias_deviations * per_hour)
            biases = _biases(run, steps, place, unit)
    return Alignment(
        file=rest.record.segment.file,
        settings=settings,
        place=place,
        unit=unit,
        duration_s=rest.duration_s,
        attitude=attitude,
        others=tuple(others),
        limit_deg=np.degrees(attitude_limit_rad(place, unit)),
        course_s=course_s,
        course=course,
        biases=biases,
        bias_course=bias_course,
        warnings=(*rest.record.warnings, *warnings),
    )


def _attitude(C_bn: Array, covariance: Array, axes: Axes) -> Attitude:
    seen = C_bn[..., ["xyz".index(axis) for axis in axes]]
    matrix = angle_matrix(seen)
    variance = np.diagonal(matrix @ covariance @ np.swapaxes(matrix, -1, -2), axis1=-2, axis2=-1)
    return Attitude(
        np.stack(attitude_angles_deg(seen), axis=-1), np.degrees(np.sqrt(np.maximum(variance, 0.0)))
    )


def _filtered(steps: Steps, place: Place, unit: UnitModel, method: Method) -> KalmanAlignment:
    count = int(np.clip(len(steps) // 5, *_FIRST_STEPS))
    first = steps.part(0, count)
    first_s = float(first.duration_s.sum())
    start = coarse_alignment(*first.means(), first_s, place, unit)
    return kalman_alignment(
        steps.part(count), start.C_bn, first_s, place, unit, closed=method == "kalman-closed"
    )


def _biases(run: KalmanAlignment, steps: Steps, place: Place, unit: UnitModel) -> Biases:
    """Turned into the case. Two things the filters leave out show at rest: that the up gyro's mean exceeds
    ω_ie sin L, and the up accelerometer's mean normal gravity."""
    rate, force = steps.means()
    duration_s = float(steps.duration_s.sum())
    weights = run.C_bn[2] ** 2
    seen = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    seen[0] = place.north_radps
    cross = run.covariance @ seen
    share = cross / (seen @ cross + weights @ unit.gyro_noise.mean_variance(duration_s))
    bias = run.bias + share[3:] * (float(run.C_bn[2] @ rate) - place.up_radps - run.bias[2])
    covariance = np.zeros((6, 6))
    covariance[:5, :5] = (run.covariance - np.outer(share, cross))[3:, 3:]
    assumed = unit.accel_bias_mps2**2
    up = GRAVITY_ANOMALY_MPS2**2 + float(weights @ unit.accel_noise.mean_variance(duration_s))
    covariance[5, 5] = assumed * up / (assumed + up)
    excess = float(run.C_bn[2] @ force) - place.gravity_mps2
    in_n = np.append(bias, assumed / (assumed + up) * excess)
    case = run.C_bn.T
    gyro, accel = (np.sqrt(np.diag(case @ covariance[p, p] @ case.T)) for p in (slice(0, 3), slice(3, 6)))
    return Biases(case @ in_n[:3] / RADPS_PER_DEG_PER_H, gyro / RADPS_PER_DEG_PER_H, case @ in_n[3:], accel)


def _drifting(rate: Array, deviation: Array, duration_s: float) -> tuple[Message, ...]:
    """A tilt that grows more than its noise explains."""
    if np.all(np.abs(rate) < 4.0 * deviation):
        return ()
    return (
        Message(
            "Level drifted by {change}″ over the recording: the base settles or the accelerometers warm up. "
            "The attitude is that of its middle.",
            change=f"{np.degrees(np.abs(rate).max()) * duration_s * 3600.0:.3g}",
        ),
    )
