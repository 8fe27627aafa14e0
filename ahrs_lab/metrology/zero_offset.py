"""Zero offset (零偏, 7.2): mean of the angle outputs over reversed positions, equation (16), and of the
multi-position method, whose first harmonic over azimuth has to be the Earth's horizontal rate."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError

Array = NDArray[np.float64]

EARTH_RATE_DPS = math.degrees(7.292115e-5)
"""WGS-84 ω_ie, °/s."""


def zero_offset(angles_deg: Sequence[float] | Array, durations_s: Sequence[float] | Array) -> float:
    """B in °/s by (16) or 7.2.2: angles N_i and their durations T_i, both of shape (n,).

    With one T this is ΣN_i/(n·T). Where recordings differ by a few samples each N_i is divided by its own
    T_i, so that the Earth's rate still cancels.
    """
    angles = np.asarray(angles_deg, dtype=np.float64)
    durations = np.asarray(durations_s, dtype=np.float64)
    if angles.shape != durations.shape or angles.ndim != 1 or not len(angles):
        raise ValueError(f"angles {angles.shape} and durations {durations.shape} have to be of one length")
    if np.all(durations == durations[0]):
        return float(angles.sum() / (len(angles) * durations[0]))
    return float(np.mean(angles / durations))


@dataclass(frozen=True)
class AzimuthHarmonic:
    """First harmonic of N_i/T_i over azimuth: what the axis sees of the Earth's rate.

    ``phase_deg`` is the azimuth error of the positions: 0 where the axis shows most when it points north,
    positive where it shows most east of it. ``expected_dps`` is ω_ie·cos φ.
    """

    amplitude_dps: float
    expected_dps: float
    phase_deg: float


def azimuth_harmonic(
    rates_dps: Sequence[float] | Array, headings_deg: Sequence[float] | Array, latitude_deg: float
) -> AzimuthHarmonic:
    """Least squares of ``N_i/T_i = B + A·cos(heading_i − phase)`` (7.2.2); arrays of shape (n,).

    ``headings_deg``: where the axis points, clockwise from north. Raises InputError where the headings do
    not spread in equal steps over the circle, because then ΣN_i/(n·T) is not free of the Earth's rate.
    """
    heading = np.radians(np.asarray(headings_deg, dtype=np.float64))
    rates = np.asarray(rates_dps, dtype=np.float64)
    resultant = abs(np.exp(1j * heading).mean())
    if len(rates) < 3 or resultant > 1e-3 or abs(np.exp(2j * heading).mean()) > 1e-3:
        raise InputError(
            "The {count} azimuths of the multi-position method are not equal steps round the circle: "
            "three or more equal steps are needed for the Earth's rate to cancel.",
            count=len(rates),
        )
    cosine = 2.0 * float(np.mean(rates * np.cos(heading)))
    sine = 2.0 * float(np.mean(rates * np.sin(heading)))
    return AzimuthHarmonic(
        amplitude_dps=math.hypot(cosine, sine),
        expected_dps=EARTH_RATE_DPS * math.cos(math.radians(latitude_deg)),
        phase_deg=math.degrees(math.atan2(sine, cosine)),
    )
