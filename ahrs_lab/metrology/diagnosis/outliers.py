"""Which of several recordings stand apart from a fit. They are named, never left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.diagnosis.model import LOOK_LEVEL, Residuals
from ahrs_lab.metrology.diagnosis.statistics import outlier_limit, studentised, two_sided

Array = NDArray[np.float64]


def diagnose_residuals(
    design: Array,
    values: Array,
    residuals: Array,
    standard_errors: Array,
    starts_s: Array,
    durations_s: Array,
    segments: tuple[str, ...],
) -> Residuals:
    """``design``: shape (n, p) of the fit whose ``residuals`` of ``values`` these are; all others shape (n,).

    Noise of a mean is taken to fall with the square root of its duration. The largest comes first among the
    outliers.
    """
    t, dof = studentised(design, values, np.sqrt(durations_s.mean() / durations_s))
    count = len(values)
    limit = outlier_limit(count, dof, LOOK_LEVEL) if dof > 0 else 0.0
    ranked = np.argsort(-np.abs(t), kind="stable")
    outliers = [int(place) for place in ranked if dof > 0 and abs(t[place]) > limit]
    return Residuals(
        segments=segments,
        starts_s=tuple(starts_s.tolist()),
        residuals=tuple(residuals.tolist()),
        standard_errors=tuple(standard_errors.tolist()),
        studentised=tuple(t.tolist()),
        dof=dof,
        limit=limit,
        outliers=tuple(outliers),
        outlier_p=chance_of_all(float(np.max(np.abs(t), initial=0.0)), dof, count),
    )


def chance_of_all(t: float, dof: int, count: int) -> float:
    """Probability that the largest of ``count`` exceeds |t| by chance, at most (Bonferroni)."""
    return min(1.0, count * two_sided(t, dof)) if dof > 0 else 1.0
