"""The inertial measurement unit's channels: what gyros and accelerometers show for a given motion.

Rows of a matrix are output channels, columns input axes: the textbook's E_yx in (2-28), which multiplies ω_y
in the x channel, is ``misalignment[0][1]`` here. Random and slow terms are in
:mod:`ahrs_lab.inertial.sensor_noise`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

ZERO: Vector = (0.0, 0.0, 0.0)
ZERO_MATRIX: Matrix = (ZERO, ZERO, ZERO)
ONE: Vector = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class GyroModel:
    """Deterministic part of the gyro channels, (2-28) with a cubic nonlinearity:
    ``N = E₁ ∘ (B₀ + B_f·f + (I + E)·ω + c ∘ ω (ω/ω_ref)²)``.

    ``scale_factor`` output per °/s; ``bias_dps`` B₀; ``g_sensitivity`` B_f, (°/s)/(m/s²);
    ``misalignment_rad`` E, its diagonal is not used; ``nonlinearity`` c, relative at
    ``nonlinearity_rate_dps``; ``range_dps`` where the output saturates.
    """

    scale_factor: Vector = ONE
    bias_dps: Vector = ZERO
    g_sensitivity: Matrix = ZERO_MATRIX
    misalignment_rad: Matrix = ZERO_MATRIX
    nonlinearity: Vector = ZERO
    nonlinearity_rate_dps: float = 400.0
    range_dps: float = 400.0

    def indicated_dps(self, rate_dps: Array, specific_force_mps2: Array) -> Array:
        """Shape (3, n), °/s: the bracket of (2-28), before the scale factor, for ω and f of shape (3, n)."""
        coupling = _coupling(self.misalignment_rad)
        channel_rate = coupling @ rate_dps
        shown = channel_rate + np.array(self.g_sensitivity) @ specific_force_mps2
        shown += _column(self.bias_dps)
        if any(self.nonlinearity):
            relative = channel_rate / self.nonlinearity_rate_dps
            shown += _column(self.nonlinearity) * channel_rate * relative**2
        return np.asarray(shown, dtype=np.float64)

    def output(self, rate_dps: Array, specific_force_mps2: Array) -> Array:
        """Shape (3, n): N of (2-28), saturated at the range, without random terms."""
        shown = np.clip(self.indicated_dps(rate_dps, specific_force_mps2), -self.range_dps, self.range_dps)
        return np.asarray(_column(self.scale_factor) * shown, dtype=np.float64)


@dataclass(frozen=True)
class AccelModel:
    """Deterministic part of the accelerometer channels (2-27): ``N_A = K₁ ∘ (K₀ + (I + K)·f)``.

    ``scale_factor`` K₁, output per m/s²; ``bias_mps2`` K₀; ``misalignment_rad`` K, its diagonal is not used.
    """

    scale_factor: Vector = ONE
    bias_mps2: Vector = ZERO
    misalignment_rad: Matrix = ZERO_MATRIX
    range_mps2: float = 100.0

    def indicated_mps2(self, specific_force_mps2: Array) -> Array:
        """Shape (3, n), m/s²: the bracket of (2-27), for f of shape (3, n)."""
        return np.asarray(
            _coupling(self.misalignment_rad) @ specific_force_mps2 + _column(self.bias_mps2), dtype=np.float64
        )

    def output(self, specific_force_mps2: Array) -> Array:
        """Shape (3, n): N_A of (2-27), saturated at the range, without random terms."""
        shown = np.clip(self.indicated_mps2(specific_force_mps2), -self.range_mps2, self.range_mps2)
        return np.asarray(_column(self.scale_factor) * shown, dtype=np.float64)


def _coupling(misalignment: Matrix) -> Array:
    """I + E; what stands on the diagonal of E belongs to the scale factor."""
    matrix = np.array(misalignment, dtype=np.float64)
    np.fill_diagonal(matrix, 1.0)
    return matrix


def _column(vector: Vector) -> Array:
    return np.array(vector, dtype=np.float64)[:, np.newaxis]
