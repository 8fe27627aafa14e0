"""Rows of a budget and their combination: JCGM 100, 5.1.2, G.4 and G.3."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import ndtri, stdtrit

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Distribution, Method, Origin, Uncertainty

PROBABILITY = 0.95

AS_GOOD_AS_INFINITE = 1e9
"""Degrees of freedom from which the t quantile is the normal one to nine digits."""

DIVISORS: dict[Distribution, float] = {
    "normal": 1.0,
    "t": 1.0,
    "rectangular": math.sqrt(3.0),
    "triangular": math.sqrt(6.0),
    "arcsine": math.sqrt(2.0),
}
"""Half-width over standard uncertainty; 1 where the standard uncertainty itself is known."""


def type_a(
    symbol: str,
    source: Message,
    unit: str,
    standard_uncertainty: float,
    sensitivity: float,
    dof: float,
    estimate: float | None = None,
) -> BudgetRow:
    """A row whose standard uncertainty comes from the recorded data."""
    return BudgetRow(
        symbol=symbol,
        source=source,
        unit=unit,
        standard_uncertainty=standard_uncertainty,
        sensitivity=sensitivity,
        contribution=abs(sensitivity) * standard_uncertainty,
        kind="A",
        distribution="t" if math.isfinite(dof) else "normal",
        divisor=1.0,
        dof=dof,
        origin="data",
        estimate=estimate,
    )


def from_expanded(
    symbol: str,
    source: Message,
    unit: str,
    expanded: float,
    sensitivity: float,
    origin: Origin,
    coverage_factor: float = 2.0,
    estimate: float | None = None,
) -> BudgetRow:
    """A type B row from an expanded uncertainty, normally distributed."""
    standard = expanded / coverage_factor
    return BudgetRow(
        symbol=symbol,
        source=source,
        unit=unit,
        standard_uncertainty=standard,
        sensitivity=sensitivity,
        contribution=abs(sensitivity) * standard,
        kind="B",
        distribution="normal",
        divisor=coverage_factor,
        dof=math.inf,
        origin=origin,
        estimate=estimate,
        half_width=expanded,
    )


def from_half_width(
    symbol: str,
    source: Message,
    unit: str,
    half_width: float,
    sensitivity: float,
    origin: Origin,
    distribution: Distribution = "rectangular",
) -> BudgetRow:
    """A type B row from limits ± ``half_width``."""
    standard = half_width / DIVISORS[distribution]
    return BudgetRow(
        symbol=symbol,
        source=source,
        unit=unit,
        standard_uncertainty=standard,
        sensitivity=sensitivity,
        contribution=abs(sensitivity) * standard,
        kind="B",
        distribution=distribution,
        divisor=DIVISORS[distribution],
        dof=math.inf,
        origin=origin,
        half_width=half_width,
    )


def effective_dof(contributions: Sequence[float], dofs: Sequence[float]) -> float:
    """Welch–Satterthwaite (JCGM 100, G.2b): infinite where no row of finite dof contributes to speak of."""
    largest = max(contributions, default=0.0)
    if largest == 0.0:
        return math.inf
    shares = [c / largest for c in contributions]  # fourth powers of 1e-7 and less stay representable
    total = sum(share**2 for share in shares) ** 2
    weighted = sum(share**4 / dof for share, dof in zip(shares, dofs, strict=True))
    dof = total / weighted if weighted > 0.0 else math.inf
    return dof if dof < AS_GOOD_AS_INFINITE else math.inf


def coverage_factor(dof: float, probability: float = PROBABILITY) -> float:
    """Two-sided t quantile (JCGM 100, G.3); fractional degrees of freedom are not cut."""
    upper = 0.5 * (1.0 + probability)
    return float(stdtrit(dof, upper)) if math.isfinite(dof) else float(ndtri(upper))


def combine(rows: Sequence[BudgetRow], method: Method = "gum") -> Uncertainty:
    """u_c in quadrature (the rows are uncorrelated by construction), U = k·u_c with k from t at 95 %."""
    contributions = [row.contribution for row in rows]
    standard = float(np.sqrt(np.sum(np.square(contributions)))) if contributions else 0.0
    dof = effective_dof(contributions, [row.dof for row in rows])
    k = coverage_factor(dof)
    return Uncertainty(
        standard=standard, expanded=k * standard, coverage_factor=k, dof=dof, method=method, rows=tuple(rows)
    )
