"""Tests on the residuals of a least squares fit.

NIST/SEMATECH e-Handbook 1.3.5.17 (Grubbs), Cook and Weisberg (externally studentised residuals), Draper and
Smith (pure error). scipy.special only: scipy.stats costs half a second to import.
"""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from ahrs_lab.metrology.diagnosis.model import Change

Array = NDArray[np.float64]

_ROUNDING = 1e-12
"""Residuals that small beside the values are the arithmetic's."""


def two_sided(t: float, dof: float) -> float:
    """Probability of a larger |t| by chance."""
    return float(
        2.0 * (scipy.special.ndtr(-abs(t)) if math.isinf(dof) else scipy.special.stdtr(dof, -abs(t)))
    )


def f_tail(F: float, dof_above: float, dof_below: float) -> float:
    """Probability of a larger F by chance; ``dof_below`` may be infinite."""
    if math.isinf(dof_below):
        return float(scipy.special.chdtrc(dof_above, F * dof_above))
    return float(scipy.special.fdtrc(dof_above, dof_below, F))


def outlier_limit(count: int, dof: int, level: float) -> float:
    """Of an externally studentised residual: the largest of ``count`` exceeds it by chance with ``level`` at
    most (Bonferroni). For residuals from a mean that is Grubbs' test."""
    return float(-scipy.special.stdtrit(dof, level / (2.0 * count)))


def studentised(design: Array, values: Array, spread: Array) -> tuple[Array, int]:
    """Externally studentised residuals, shape (n,), and their degrees of freedom n − p − 1.

    ``design``: shape (n, p); ``spread``: shape (n,), the relative standard deviations of the values. Each
    residual is judged by the scatter that is left without its value. Zeros where nothing is left to judge by.
    """
    count, unknowns = design.shape
    dof = count - unknowns - 1
    if dof < 1:
        return np.zeros(count), 0
    q, _ = np.linalg.qr(design / spread[:, None])
    scaled = values / spread
    residuals = scaled - q @ (q.T @ scaled)
    free = 1.0 - (q**2).sum(axis=1)
    total = float(residuals @ residuals)
    if math.sqrt(total / count) <= _ROUNDING * float(np.max(np.abs(scaled), initial=0.0)):
        return np.zeros(count), dof
    free = np.maximum(free, _ROUNDING)  # a value that no other one checks
    left = np.maximum(total * free - residuals**2, _ROUNDING * total)
    return residuals * np.sqrt(dof / left), dof


def trend(design: Array, values: Array, times_s: Array) -> Change | None:
    """Slope of ``values`` with time beside what ``design`` explains, unit per s; None where the scatter has
    no degree of freedom left or the times follow from the design."""
    count, unknowns = design.shape
    dof = count - unknowns - 1
    if dof < 1:
        return None
    q, _ = np.linalg.qr(design)
    centred = times_s - q @ (q.T @ times_s)
    spread = float(centred @ centred)
    if spread <= _ROUNDING * float(times_s @ times_s):
        return None
    slope = float(centred @ values) / spread
    left = values - q @ (q.T @ values) - slope * centred
    variance = float(left @ left) / dof
    if math.sqrt(variance) <= _ROUNDING * float(np.max(np.abs(values), initial=0.0)):
        return None
    standard = math.sqrt(variance / spread)
    return Change(slope, standard, float(dof), two_sided(slope / standard, dof))


def residual_expectation(design: Array, covariance: Array) -> tuple[float, float]:
    """What Σv² of a least squares fit is expected to be, and its degrees of freedom (Satterthwaite).

    ``covariance``: shape (n, n), of the values; with an intercept in the design −½ of a structure function
    will do.
    """
    q, _ = np.linalg.qr(design)
    maker = np.eye(len(design)) - q @ q.T
    left = maker @ covariance @ maker
    mean, square = float(np.trace(left)), float(np.sum(left * left.T))
    return mean, mean**2 / square if square > 0.0 else 0.0


def welch_satterthwaite(variances: Array, dofs: Array) -> float:
    """Degrees of freedom of Σ variances."""
    total = float(variances.sum())
    if total <= 0.0:
        return math.inf
    weighted = float(np.sum((variances / total) ** 2 / dofs))
    return 1.0 / weighted if weighted > 0.0 else math.inf
