"""Discrete calibration of an inertial measurement unit (2.6.3): what goes in, and the calibration set.

The channels are those of (2-27), (2-28), means over a time::

    N   = E1 ∘ (B0 + Bf·f + (I + E)·ω)        gyros, N in rate_unit, ω in °/s, f in m/s²
    N_A = K1 ∘ (K0 + (I + K)·f)               accelerometers, N_A in accel_unit

Rows of a matrix are output channels, columns input axes; the diagonals of E and K are zero. The textbook's
B_1x, B_2x, B_3x of (2-184) are the row ``Bf[0]``; its (2-176) prints the names transposed and leaves out the
division by the channel's own scale factor.

The estimate is in :mod:`ahrs_lab.metrology.imu_estimation`, the JSON in
:mod:`ahrs_lab.metrology.imu_calibration_json`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message

Array = NDArray[np.float64]

AXES: Final[tuple[Literal["x", "y", "z"], ...]] = ("x", "y", "z")
OTHERS: Final = ((1, 2), (0, 2), (0, 1))
"""Of each channel, the two other axes: the columns of E and K that it has."""

_DIRECTIONS: Final = {"E": (1, 0, 0), "N": (0, 1, 0), "U": (0, 0, 1), "W": (-1, 0, 0), "S": (0, -1, 0), "D": (0, 0, -1)}  # fmt: skip  # noqa: E501


@dataclass(frozen=True, eq=False)
class PositionData:
    """A dwell at rest.

    ``case_to_enu``: 3×3, column i is where case axis i points. ``gyro``, ``accel``: mean outputs, shape (3,),
    in the unit's own units. ``gyro_error``, ``accel_error``: their standard errors by the sensor's noise
    without drift, shape (3,); zeros where unknown, then all dwells of one length weigh alike. ``start_s`` on
    one time scale with the other data, for the drift between them. ``mounting`` names the clamping of the
    case: dwells with the same name share its errors.
    """

    case_to_enu: Array
    gyro: Array
    accel: Array
    duration_s: float
    gyro_error: Array = field(default_factory=lambda: np.zeros(3))
    accel_error: Array = field(default_factory=lambda: np.zeros(3))
    start_s: float = 0.0
    name: str = ""
    mounting: str = ""


@dataclass(frozen=True, eq=False)
class RotationData:
    """Whole turns of the table about up, from rest to rest or at constant rate.

    ``case_to_enu`` as the case stands at table angle 0. ``turned_deg``: the table's angle over the recording,
    positive anticlockwise from above. ``angle``: output summed over the time, shape (3,), rate_unit·s, and
    its standard error ``angle_error``. ``mean_cosine``, ``mean_sine``: time means over the table's angle, 0
    at constant rate over whole turns; with them the Earth's horizontal rate is exact also with rests and
    ramps.
    """

    case_to_enu: Array
    turned_deg: float
    duration_s: float
    angle: Array
    angle_error: Array = field(default_factory=lambda: np.zeros(3))
    mean_cosine: float = 0.0
    mean_sine: float = 0.0
    start_s: float = 0.0
    name: str = ""
    mounting: str = ""

    @property
    def axis(self) -> int:
        """0, 1, 2: the case axis nearest to the vertical, about which it turns."""
        return int(np.argmax(np.abs(self.case_to_enu[2])))


@dataclass(frozen=True, eq=False)
class GyroCoefficients:
    """Of (2-28), or their uncertainties: ``E1`` (3,) rate_unit per °/s; ``B0`` (3,) °/s; ``Bf`` (3, 3)
    (°/s)/(m/s²); ``E`` (3, 3), rad for small angles."""

    E1: Array
    B0: Array
    Bf: Array
    E: Array


@dataclass(frozen=True, eq=False)
class AccelCoefficients:
    """Of (2-27), or their uncertainties: ``K1`` (3,) accel_unit per m/s²; ``K0`` (3,) m/s²; ``K`` (3, 3)."""

    K1: Array
    K0: Array
    K: Array


@dataclass(frozen=True, eq=False)
class Coefficients:
    """All 33 of the unit."""

    gyro: GyroCoefficients
    accel: AccelCoefficients

    def vectors(self) -> tuple[Array, Array]:
        """Per channel (E1, B0, Bf x y z, E of the two others), shape (3, 7), and (K1, K0, K of the two
        others), shape (3, 4): the order of the covariances."""
        g, a = self.gyro, self.accel
        gyro = [np.array([g.E1[i], g.B0[i], *g.Bf[i], *g.E[i, list(OTHERS[i])]]) for i in range(3)]
        accel = [np.array([a.K1[i], a.K0[i], *a.K[i, list(OTHERS[i])]]) for i in range(3)]
        return np.array(gyro), np.array(accel)

    @classmethod
    def from_vectors(cls, gyro: Array, accel: Array) -> Coefficients:
        """The inverse of :meth:`vectors`."""
        E, K = np.zeros((3, 3)), np.zeros((3, 3))
        for i, others in enumerate(OTHERS):
            E[i, list(others)] = gyro[i, 5:]
            K[i, list(others)] = accel[i, 2:]
        return cls(
            GyroCoefficients(gyro[:, 0].copy(), gyro[:, 1].copy(), gyro[:, 2:5].copy(), E),
            AccelCoefficients(accel[:, 0].copy(), accel[:, 1].copy(), K),
        )


@dataclass(frozen=True, eq=False)
class Quality:
    """How well a set is known.

    ``standard_uncertainty``: of the sensor's noise and drift in this recording, nothing else.
    ``gyro_covariance`` (3, 7, 7), ``accel_covariance`` (3, 4, 4): of each channel, in the order of
    :meth:`Coefficients.vectors`; the channels' noises are independent. ``bench``: standard uncertainty by the
    bench (level, fixture, north, gravity …) from ``bench_figures``, None where it was not asked for; these
    errors are common to the channels. Condition numbers are of the positions' matrix [1, f/g] and of the
    turns. Residuals: per position and channel, shape (n, 3), in °/s and m/s².
    """

    standard_uncertainty: Coefficients
    gyro_covariance: Array
    accel_covariance: Array
    gyro_condition: float
    accel_condition: float
    turns_condition: float
    gyro_residuals: Array
    accel_residuals: Array
    positions: tuple[str, ...]
    bench: Coefficients | None = None
    bench_figures: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class ImuCalibration:
    """A calibration set: what :mod:`ahrs_lab.analysis.compensation` takes.

    ``rate_unit``, ``accel_unit``: of the outputs that it was made from, "" where not said. ``quality`` is
    None for a set that comes without. ``provenance``: device, recording, software, reference values.
    """

    coefficients: Coefficients
    rate_unit: str = ""
    accel_unit: str = ""
    quality: Quality | None = None
    warnings: tuple[Message, ...] = ()
    provenance: Mapping[str, str | float] = field(default_factory=dict)

    @property
    def gyro(self) -> GyroCoefficients:
        """Of (2-28)."""
        return self.coefficients.gyro

    @property
    def accel(self) -> AccelCoefficients:
        """Of (2-27)."""
        return self.coefficients.accel


_SIX: Final = ("UWS", "DWN", "SUW", "NDW", "NWU", "SWD")
_EIGHT: Final = ("SUW", "NUE", "UWS", "DWN", "NWU", "SWD", "NDW", "SDE")
_TWELVE: Final = (*_EIGHT, "UEN", "DES", "SEU", "NED")
_SIXTEEN: Final = (*_TWELVE, "WSU", "ENU", "ESD", "WND")
_TWENTY: Final = (*_SIXTEEN, "EUS", "WUN", "WDS", "EDN")
_TWENTY_FOUR: Final = (*_TWENTY, "USE", "UNW", "DSW", "DNE")

SCHEMES: Final[Mapping[str, tuple[str, ...]]] = {
    "6": _SIX,
    "8": _EIGHT,
    "12": _TWELVE,
    "16": _SIXTEEN,
    "20": _TWENTY,
    "24": _TWENTY_FOUR,
}
"""Positions by where x, y, z of the case point.

8 is table 2-12. The textbook names 12, 16, 20 and 24 without listing them: 12 is the 8 with the opposite
azimuth of each added, so that the Earth's horizontal rate, and with it an error of north, cancels in every
coefficient; 16, 20 and 24 add the two azimuths between for the faces of z, y and x. 24 are all orientations.
6 is every face once, the fewest that balance. All have rank 4 of 4 for [1, f]. With the Earth's rate beside
it (7 columns) 6, 8, 12 have rank 4, 5, 6, and only from 16 on 7: E1 and E come from turns.
"""


def case_to_enu(letters: str) -> Array:
    """3×3 of an orientation of :data:`SCHEMES`: column i is where case axis i points."""
    return np.array([_DIRECTIONS[letter] for letter in letters], dtype=np.float64).T


def position_matrix(orientations: Sequence[Array]) -> Array:
    """Shape (n, 4): rows [1, f/g] of (2-185), (2-188) for case-to-ENU matrices, without dimension, so that
    condition numbers of different places agree."""
    ups = np.array([matrix[2] for matrix in orientations], dtype=np.float64).reshape(-1, 3)
    return np.column_stack([np.ones(len(ups)), ups])
