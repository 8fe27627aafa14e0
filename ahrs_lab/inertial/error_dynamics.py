"""How errors of an inertial system at rest grow and swing: the state model (2-90) and its matrix exponential.

State: δv_E, δv_N (m/s), δL (rad), φ_E, φ_N, φ_U (rad), and δλ (rad), which stands outside the loop (2-88).
Every error is computed minus true. φ turns the true frame into the computed one, so that the computed
attitude is (I − φ×)·C_bn and φ_U the error of heading. The height is held from outside, as the text assumes.

ε of (2-90) is the drift of the platform. A strapdown unit's platform is a sum of its gyros' rates, and a gyro
that shows too much turns it back: ε = −C_bn·(error of the gyros). The sources here are errors of the sensors,
with that sign; the accelerometers' ∇ = C_bn·(their error).

Derived again from (2-42) and (2-76), (2-90) is right as printed. Tables 2-9 and 2-10, which the print leaves
incomplete, are not used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from ahrs_lab.inertial.earth import (
    EARTH_RATE_RADPS,
    meridian_radius_m,
    normal_gravity_mps2,
    transverse_radius_m,
)

Array = NDArray[np.float64]

STATES: Final = ("dv_e", "dv_n", "dlat", "phi_e", "phi_n", "phi_u", "dlon")
DV_E, DV_N, DLAT, PHI_E, PHI_N, PHI_U, DLON = range(7)
INPUTS: Final = ("accel_e", "accel_n", "gyro_e", "gyro_n", "gyro_u")

POLE_DEG: Final = 89.9


@dataclass(frozen=True)
class RestingPlace:
    """Where the system rests: ``meridian_m`` R_M + h, ``transverse_m`` R_N + h."""

    latitude_rad: float
    gravity_mps2: float
    meridian_m: float
    transverse_m: float

    @classmethod
    def on_earth(cls, latitude_deg: float, altitude_m: float = 0.0) -> Self:
        """On WGS-84; raises ValueError nearer than 0.1° to a pole, where east is lost."""
        if not abs(latitude_deg) <= POLE_DEG:
            raise ValueError(f"latitude {latitude_deg}° is too near a pole")
        return cls(
            float(np.radians(latitude_deg)),
            float(normal_gravity_mps2(latitude_deg, altitude_m)),
            float(meridian_radius_m(latitude_deg)) + altitude_m,
            float(transverse_radius_m(latitude_deg)) + altitude_m,
        )

    @property
    def schuler_radps(self) -> float:
        """ω_s = √(g/R)."""
        return float(np.sqrt(self.gravity_mps2 / np.sqrt(self.meridian_m * self.transverse_m)))

    @property
    def foucault_radps(self) -> float:
        """ω_ie sin L, without sign."""
        return abs(EARTH_RATE_RADPS * float(np.sin(self.latitude_rad)))


def state_matrix(place: RestingPlace) -> Array:
    """Shape (7, 7): F of (2-90), and the longitude's row."""
    up = EARTH_RATE_RADPS * np.sin(place.latitude_rad)
    north = EARTH_RATE_RADPS * np.cos(place.latitude_rad)
    g, R_M, R_N = place.gravity_mps2, place.meridian_m, place.transverse_m
    F = np.zeros((7, 7))
    F[DV_E, [DV_N, PHI_N]] = 2 * up, -g
    F[DV_N, [DV_E, PHI_E]] = -2 * up, g
    F[DLAT, DV_N] = 1 / R_M
    F[PHI_E, [DV_N, PHI_N, PHI_U]] = -1 / R_M, up, -north
    F[PHI_N, [DV_E, DLAT, PHI_E]] = 1 / R_N, -up, -up
    F[PHI_U, [DV_E, DLAT, PHI_E]] = np.tan(place.latitude_rad) / R_N, north, north
    F[DLON, DV_E] = 1 / (R_N * np.cos(place.latitude_rad))
    return F


def input_matrix() -> Array:
    """Shape (7, 5): how the sensors' errors enter, in the order of :data:`INPUTS` (east, north, up
    components; m/s² and rad/s)."""
    G = np.zeros((7, 5))
    G[DV_E, 0] = G[DV_N, 1] = 1.0
    G[PHI_E, 2] = G[PHI_N, 3] = G[PHI_U, 4] = -1.0
    return G


def propagate(place: RestingPlace, initial: Array, sensors: Array, step_s: float, count: int) -> Array:
    """Shape (7, count + 1): the state every ``step_s`` from ``initial`` (7,), under constant errors of the
    ``sensors`` (5,)."""
    augmented = np.zeros((8, 8))
    augmented[:7, :7] = state_matrix(place)
    augmented[:7, 7] = input_matrix() @ sensors
    step = expm(augmented * step_s)
    states = np.empty((8, count + 1))
    states[:, 0] = np.append(initial, 1.0)
    for i in range(count):
        states[:, i + 1] = step @ states[:, i]
    return states[:7]


def eigenfrequencies_radps(place: RestingPlace) -> tuple[float, float, float]:
    """The three frequencies of (2-93), ascending: ω_ie, and about ω_s ∓ ω_ie sin L."""
    roots = np.linalg.eigvals(state_matrix(place)[:6, :6]).imag
    positive = np.sort(roots[roots > 0])
    if len(positive) != 3:
        raise ValueError("the frequencies cannot be told apart here")
    a, b, c = (float(root) for root in positive)
    return a, b, c


@dataclass(frozen=True)
class SchulerChannel:
    """One horizontal channel alone: errors of position in metres after t s."""

    radius_m: float = 6.371e6
    gravity_mps2: float = 9.8

    @property
    def rate_radps(self) -> float:
        """ω_s."""
        return float(np.sqrt(self.gravity_mps2 / self.radius_m))

    def of_gyro_drift(self, drift_radps: float, t_s: Array | float) -> Array:
        """R·ε·(t − sin(ω_s t)/ω_s)."""
        t, w = np.asarray(t_s), self.rate_radps
        return np.asarray(self.radius_m * drift_radps * (t - np.sin(w * t) / w), dtype=np.float64)

    def of_accel_bias(self, bias_mps2: float, t_s: Array | float) -> Array:
        """∇/ω_s²·(1 − cos ω_s t)."""
        w = self.rate_radps
        return np.asarray(bias_mps2 / w**2 * (1 - np.cos(w * np.asarray(t_s))), dtype=np.float64)

    def of_tilt(self, tilt_rad: float, t_s: Array | float) -> Array:
        """R·φ·(1 − cos ω_s t)."""
        return self.of_accel_bias(self.gravity_mps2 * tilt_rad, t_s)
