"""Scale factor (7.1): least squares line through the means at the table rates, equations (11) to (15)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ScaleFactorFit:
    """The line ``F_j = K·Ω_j + F₀ + v_j`` of (13); F in the device's unit, rates in °/s.

    ``outputs`` are the F_j of (12), ``static`` is F_r of (11). ``K_weights`` and ``F0_weights`` are
    ∂K/∂mean_j and ∂F₀/∂mean_j, what an uncertainty budget needs; ``spread`` is S = Σ(Ω − Ω̄)² in (°/s)².
    """

    K: float
    F0: float
    rates_dps: tuple[float, ...]
    outputs: tuple[float, ...]
    residuals: tuple[float, ...]
    static: float
    nonlinearity_ppm: float
    asymmetry_ppm: float
    spread: float
    K_weights: tuple[float, ...]
    F0_weights: tuple[float, ...]


def fit_scale_factor(
    rates_dps: Sequence[float] | Array,
    means: Sequence[float] | Array,
    static_before: float,
    static_after: float,
) -> ScaleFactorFit:
    """K by (14), F₀ by (15) from the means of (10), each of shape (M,), and the means at rest F_s, F_e.

    Sums are taken about the mean rate: algebraically (14) and (15), without their cancellation. Nonlinearity
    is ``max|v_j| / max|F_j|``; asymmetry is (K₊ − K₋)/K of the lines through the positive and the negative
    rates alone, both in ppm. Raises InputError where a line is not determined or a sense of rotation is
    missing.
    """
    rates = np.asarray(rates_dps, dtype=np.float64)
    output = np.asarray(means, dtype=np.float64)
    if rates.shape != output.shape or rates.ndim != 1:
        raise ValueError(f"rates {rates.shape} and means {output.shape} have to be of one length")
    positive, negative = rates > 0.0, rates < 0.0
    if not positive.any() or not negative.any():
        raise InputError(
            "The scale factor needs rates of both senses, but {positive} are positive and {negative} "
            "negative: "
            "record the missing ones.",
            positive=int(positive.sum()),
            negative=int(negative.sum()),
        )
    static = 0.5 * (static_before + static_after)
    outputs = output - static
    K, F0 = _line(rates, outputs)
    residuals = outputs - (K * rates + F0)
    deviation = rates - rates.mean()
    spread = float(deviation @ deviation)
    K_weights = deviation / spread
    largest = float(np.max(np.abs(outputs)))
    return ScaleFactorFit(
        K=K,
        F0=F0,
        rates_dps=tuple(rates.tolist()),
        outputs=tuple(outputs.tolist()),
        residuals=tuple(residuals.tolist()),
        static=static,
        nonlinearity_ppm=1e6 * float(np.max(np.abs(residuals))) / largest if largest > 0.0 else 0.0,
        asymmetry_ppm=1e6 * _difference_of_senses(rates, outputs) / K if K != 0.0 else 0.0,
        spread=spread,
        K_weights=tuple(K_weights.tolist()),
        F0_weights=tuple((1.0 / len(rates) - K_weights * rates.mean()).tolist()),
    )


def asymmetry_standard_ppm(
    rates_dps: Sequence[float] | Array, K: float, standard_errors: Sequence[float] | Array
) -> float | None:
    """Standard uncertainty of the asymmetry from the means' own errors, shape (M,), in ppm: without what
    means of one sense have in common (drift, table). None where the errors are not known or K is 0."""
    rates = np.asarray(rates_dps, dtype=np.float64)
    errors = np.asarray(standard_errors, dtype=np.float64)
    if errors.shape != rates.shape or K == 0.0 or not np.all(np.isfinite(errors)):
        return None
    weights = np.array([_difference_of_senses(rates, one) for one in np.eye(len(rates))])
    return 1e6 * float(np.linalg.norm(weights * errors)) / abs(K)


def _difference_of_senses(rates: Array, outputs: Array) -> float:
    """K₊ − K₋, linear in the outputs."""
    F0 = _line(rates, outputs)[1]
    positive, negative = rates > 0.0, rates < 0.0
    return _one_sense(rates[positive], outputs[positive], F0) - _one_sense(
        rates[negative], outputs[negative], F0
    )


def _line(rates: Array, outputs: Array) -> tuple[float, float]:
    mean_rate, mean_output = rates.mean(), outputs.mean()
    deviation = rates - mean_rate
    K = float(deviation @ (outputs - mean_output) / (deviation @ deviation))
    return K, float(mean_output - K * mean_rate)


def _one_sense(rates: Array, outputs: Array, F0: float) -> float:
    """Slope of one sense of rotation; a single rate gives the slope from the common F₀."""
    if np.ptp(rates) > 0.0:
        return _line(rates, outputs)[0]
    return float((outputs.mean() - F0) / rates.mean())
