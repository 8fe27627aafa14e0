"""Installation angles of a strapdown unit's bracket on its carrier (patent CN 102435206 A).

The unit (the box) stands in a bracket that does not point exactly where the carrier (the aircraft) points.
With C = C_box→n of the unit's own angles and the bracket's installation angles δψ, δθ, δγ

    C' = C·D,   θ' = asin C'₃₂,   γ' = atan2(−C'₃₁, C'₃₃),   ψ' = atan2(C'₁₂, C'₂₂) mod 360°

is the carrier's attitude. D as the patent prints it is the transpose of the attitude matrix of δ: so δ is
the attitude of the box relative to the aircraft (``box-in-aircraft``), D = C(δ)ᵀ. Where the survey gives the
attitude of the aircraft relative to the box (``aircraft-in-box``), D = C(δ).

The patent's guards (1.7×10⁻⁶ rad at ±90° of roll, 5×10⁻⁶ rad at 90° and 270° of heading) keep an arctangent
of a quotient from dividing by nothing; atan2 needs none. At pitch ±90° heading and roll turn about one line:
the angles still describe the attitude, but neither means anything alone; :attr:`Compensated.gimbal_lock` says
so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ahrs_lab.inertial.attitude import attitude_angles_deg, attitude_matrix, skew

Array = NDArray[np.float64]
Direction = Literal["box-in-aircraft", "aircraft-in-box"]

GIMBAL_LOCK_COSINE = 1e-6
"""Within 0.2″ of pitch ±90°: an error of attitude is a million times as large in heading and in roll."""

_STEP_DEG = 1e-3
"""Of the central differences: their error is far below any uncertainty's own."""


@dataclass(frozen=True)
class InstallationAngles:
    """δψ, δθ, δγ of a bracket in degrees, and whose attitude relative to whom they are."""

    heading_deg: float
    pitch_deg: float
    roll_deg: float
    direction: Direction = "box-in-aircraft"

    @property
    def compensation_matrix(self) -> Array:
        """D, shape (3, 3): takes components along the aircraft's axes to the box's."""
        matrix = attitude_matrix(self.heading_deg, self.pitch_deg, self.roll_deg)
        return matrix.T if self.direction == "box-in-aircraft" else matrix

    @property
    def small_angle_matrix(self) -> Array:
        """D to first order in the angles: ∓(δθ, δγ, −δψ)× beside the unit matrix."""
        rotation = skew(np.radians([self.pitch_deg, self.roll_deg, -self.heading_deg]))
        return np.asarray(
            np.eye(3) - rotation if self.direction == "box-in-aircraft" else np.eye(3) + rotation
        )

    def the_other_way(self) -> InstallationAngles:
        """The same bracket in the other direction of definition; not merely the opposite signs."""
        other: Direction = "aircraft-in-box" if self.direction == "box-in-aircraft" else "box-in-aircraft"
        own = attitude_matrix(self.heading_deg, self.pitch_deg, self.roll_deg)
        return _angles(_signed(own.T), other)


@dataclass(frozen=True)
class LevelCarrier:
    """What is read on the level carrier once the unit is aligned, in degrees.

    ``heading_error_deg`` is the surveyed heading of the bracket's longitudinal axis minus the carrier's, both
    in the horizontal plane. ``carrier_pitch_deg`` and ``carrier_roll_deg`` are what levelling left. The
    standard uncertainties belong to the unit's pitch and roll each, the carrier's level each, and the survey;
    None where nobody has stated them.
    """

    unit_pitch_deg: float
    unit_roll_deg: float
    heading_error_deg: float
    carrier_pitch_deg: float = 0.0
    carrier_roll_deg: float = 0.0
    u_attitude_deg: float | None = None
    u_level_deg: float | None = None
    u_heading_error_deg: float | None = None


@dataclass(frozen=True)
class Calibrated:
    """``angles`` of the bracket, box relative to aircraft. ``covariance_deg2``, shape (3, 3), in the order
    heading, pitch, roll: NaN in the rows and columns of an angle for which an input's uncertainty is not
    stated."""

    angles: InstallationAngles
    covariance_deg2: Array

    @property
    def standard_uncertainty_deg(self) -> Array:
        """Shape (3,): of δψ, δθ, δγ; NaN where it is not known."""
        return np.asarray(np.sqrt(np.diag(self.covariance_deg2)))


@dataclass(frozen=True)
class Compensated:
    """The carrier's angles, each of the shape of the unit's; ``gimbal_lock`` (same shape) marks where heading
    and roll mean something only together."""

    heading_deg: Array
    pitch_deg: Array
    roll_deg: Array
    gimbal_lock: NDArray[np.bool_]


def calibrate(reading: LevelCarrier) -> Calibrated:
    """The bracket's angles: C(δ) = C_n→aircraft·C_box→n, with the aircraft's heading as zero.

    On a carrier that is level, δθ and δγ are the unit's own pitch and roll and δψ is the surveyed error; a
    residual of levelling is taken out exactly. Uncertainty to first order, inputs independent.
    """
    inputs = np.array(
        [
            reading.heading_error_deg,
            reading.unit_pitch_deg,
            reading.unit_roll_deg,
            reading.carrier_pitch_deg,
            reading.carrier_roll_deg,
        ]
    )
    stated = (
        reading.u_heading_error_deg,
        reading.u_attitude_deg,
        reading.u_attitude_deg,
        reading.u_level_deg,
        reading.u_level_deg,
    )
    return Calibrated(_angles(_bracket(inputs)), _covariance(_jacobian(_bracket, inputs), stated))


def compensate(
    heading_deg: ArrayLike, pitch_deg: ArrayLike, roll_deg: ArrayLike, bracket: InstallationAngles
) -> Compensated:
    """The carrier's attitude of the unit's, for angles of any one shape."""
    corrected = attitude_matrix(heading_deg, pitch_deg, roll_deg) @ bracket.compensation_matrix
    heading, pitch, roll = attitude_angles_deg(corrected)
    cosine = np.hypot(corrected[..., 0, 1], corrected[..., 1, 1])
    return Compensated(heading, pitch, roll, cosine < GIMBAL_LOCK_COSINE)


def compensation_covariance_deg2(
    heading_deg: float, pitch_deg: float, roll_deg: float, calibrated: Calibrated
) -> Array:
    """Shape (3, 3), heading, pitch, roll: what the bracket's uncertainty does to one corrected attitude, to
    first order. The uncertainty of the unit's own angles is not in it."""
    bracket = calibrated.angles

    def corrected(angles: Array) -> Array:
        one = compensate(heading_deg, pitch_deg, roll_deg, _angles(angles, bracket.direction))
        return np.array([one.heading_deg, one.pitch_deg, one.roll_deg])

    jacobian = _jacobian(corrected, np.array([bracket.heading_deg, bracket.pitch_deg, bracket.roll_deg]))
    return np.asarray(jacobian @ calibrated.covariance_deg2 @ jacobian.T)


def _bracket(inputs: Array) -> Array:
    heading_error, unit_pitch, unit_roll, carrier_pitch, carrier_roll = inputs
    carrier = attitude_matrix(0.0, carrier_pitch, carrier_roll)
    return _signed(carrier.T @ attitude_matrix(heading_error, unit_pitch, unit_roll))


def _angles(values_deg: Array, direction: Direction = "box-in-aircraft") -> InstallationAngles:
    heading, pitch, roll = (float(angle) for angle in values_deg)
    return InstallationAngles(heading, pitch, roll, direction)


def _signed(matrix: Array) -> Array:
    """Shape (3,): heading in (−180°, 180°], as an installation angle is told, pitch, roll."""
    heading, pitch, roll = (float(angle) for angle in attitude_angles_deg(matrix))
    return np.array([heading - 360.0 if heading > 180.0 else heading, pitch, roll])


def _jacobian(function: Callable[[Array], Array], at: Array) -> Array:
    """Shape (3, n) of an angle-valued function, by central differences."""
    columns = []
    for step in _STEP_DEG * np.eye(len(at)):
        difference = function(at + step) - function(at - step)
        columns.append(((difference + 180.0) % 360.0 - 180.0) / (2 * _STEP_DEG))
    return np.column_stack(columns)


def _covariance(jacobian: Array, stated: tuple[float | None, ...]) -> Array:
    known = np.array([0.0 if u is None else u for u in stated])
    covariance = jacobian @ np.diag(known**2) @ jacobian.T
    # an input that only enters through the product of two small angles does not make a figure unknown
    open_inputs = np.array([u is None for u in stated])
    unknown = np.any(np.abs(jacobian[:, open_inputs]) > 0.1, axis=1)
    covariance[unknown, :] = np.nan
    covariance[:, unknown] = np.nan
    return np.asarray(covariance)
