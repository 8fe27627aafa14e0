"""The WGS-84 Earth: its rate, its gravity, its radii of curvature.

Equation numbers are those of the textbook's chapter 2. Navigation frame: east, north, up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

SEMI_MAJOR_AXIS_M = 6378137.0
FLATTENING = 1.0 / 298.257223563
ECCENTRICITY_SQUARED = FLATTENING * (2.0 - FLATTENING)
EARTH_RATE_RADPS = 7.292115e-5
EARTH_RATE_DPS = float(np.degrees(EARTH_RATE_RADPS))
STANDARD_GRAVITY_MPS2 = 9.80665

_EQUATORIAL_GRAVITY_MPS2 = 9.7803253359
_SOMIGLIANA = 0.00193185265241
_CENTRIFUGAL_RATIO = 0.00344978650684
"""ω²a²b/GM."""


def normal_gravity_mps2(latitude_deg: ArrayLike, altitude_m: ArrayLike = 0.0) -> Array:
    """Normal gravity, m/s² (Somigliana), and its change with height to second order; the shape of the
    arguments.

    The textbook prints the constants of the older WGS-84 below (2-40); these are the current ones.
    """
    sine_squared = np.sin(np.radians(latitude_deg)) ** 2
    root = np.sqrt(1.0 - ECCENTRICITY_SQUARED * sine_squared)
    return normal_gravity_from_sine(sine_squared, root, np.asarray(altitude_m, dtype=np.float64))


def normal_gravity_from_sine(sine_squared: Array, root: Array, altitude_m: Array) -> Array:
    """The same of sin² L and √(1 − e² sin² L), for those who have them already."""
    height = altitude_m / SEMI_MAJOR_AXIS_M
    surface = _EQUATORIAL_GRAVITY_MPS2 * (1.0 + _SOMIGLIANA * sine_squared) / root
    slope = 1.0 + FLATTENING + _CENTRIFUGAL_RATIO - 2.0 * FLATTENING * sine_squared
    return np.asarray(surface * (1.0 - (2.0 * slope - 3.0 * height) * height), dtype=np.float64)


def meridian_radius_m(latitude_deg: ArrayLike) -> Array:
    """R_M, radius of curvature in the meridian, m: exact form of (2-1)."""
    sine_squared = np.sin(np.radians(latitude_deg)) ** 2
    return np.asarray(
        SEMI_MAJOR_AXIS_M * (1.0 - ECCENTRICITY_SQUARED) / (1.0 - ECCENTRICITY_SQUARED * sine_squared) ** 1.5,
        dtype=np.float64,
    )


def transverse_radius_m(latitude_deg: ArrayLike) -> Array:
    """R_N, radius of curvature in the prime vertical, m: exact form of (2-2)."""
    sine_squared = np.sin(np.radians(latitude_deg)) ** 2
    return np.asarray(
        SEMI_MAJOR_AXIS_M / np.sqrt(1.0 - ECCENTRICITY_SQUARED * sine_squared), dtype=np.float64
    )


def earth_rate_enu_dps(latitude_deg: float) -> Array:
    """Shape (3,), °/s: the Earth's rate in east, north, up (2-3)."""
    latitude = np.radians(latitude_deg)
    return np.array([0.0, EARTH_RATE_DPS * np.cos(latitude), EARTH_RATE_DPS * np.sin(latitude)])


def earth_rate_enu_radps(latitude_deg: ArrayLike) -> Array:
    """ω_ie^n (2-3), rad/s: shape (..., 3) for latitudes of shape (...)."""
    latitude = np.radians(np.asarray(latitude_deg, dtype=np.float64))
    return EARTH_RATE_RADPS * np.stack((np.zeros_like(latitude), np.cos(latitude), np.sin(latitude)), axis=-1)


def transport_rate_enu_radps(
    velocity_enu_mps: ArrayLike, latitude_deg: ArrayLike, altitude_m: ArrayLike = 0.0
) -> Array:
    """ω_en^n (2-43), rad/s: how fast east, north and up turn against the Earth with the place; (..., 3).

    ``velocity_enu_mps`` (..., 3); ``latitude_deg``, ``altitude_m`` (...). The up component grows beyond all
    bounds at the poles, where east and north have no meaning.
    """
    velocity = np.asarray(velocity_enu_mps, dtype=np.float64)
    altitude = np.asarray(altitude_m, dtype=np.float64)
    about_east = -velocity[..., 1] / (meridian_radius_m(latitude_deg) + altitude)
    about_north = velocity[..., 0] / (transverse_radius_m(latitude_deg) + altitude)
    about_up = about_north * np.tan(np.radians(latitude_deg))
    return np.stack(np.broadcast_arrays(about_east, about_north, about_up), axis=-1)
