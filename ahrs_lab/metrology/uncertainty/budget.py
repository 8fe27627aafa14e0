"""Rows of a budget and their combination: JCGM 100, 5.1.2, 5.2.2, G.4 and G.3.

Degrees of freedom where the rows are not independent estimates: with e_k = c_k·u_k the variance is
u_c² = Σ e_i Σ r_ij e_j, so a relative error of the estimate behind row i moves it by a_i = e_i Σ r_ij e_j of
itself. Rows of one estimate (``shared``) err together, different estimates apart:
ν = u_c⁴ / Σ (Σ a_i over the rows of an estimate)²/ν of the estimate. Without correlation or shared rows this
is (G.2b); for simultaneous observations (example H.2), all of one estimate, it is their own ν. The
coefficients themselves count as known.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Correlation, Distribution, Method, Origin, Uncertainty
from ahrs_lab.metrology.uncertainty.correlation import correlation_matrix
from ahrs_lab.metrology.uncertainty.distributions import refuse_dof

Array = NDArray[np.float64]

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
    shared: str = "",
) -> BudgetRow:
    """A row whose standard uncertainty comes from the recorded data.

    Rows whose uncertainties are one and the same estimate name it in ``shared``.
    """
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
        shared=shared,
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


def effective_dof(
    contributions: Sequence[float],
    dofs: Sequence[float],
    shared: Sequence[str] = (),
    correlation: Array | None = None,
) -> float:
    """Welch–Satterthwaite (JCGM 100, G.2b): infinite where no row of finite dof contributes to speak of.

    ``shared``: for each row the name of the estimate it comes from, empty for one of its own;
    ``correlation``: shape (n, n), for which ``contributions`` carry the signs of their sensitivities.
    """
    largest = max(map(abs, contributions), default=0.0)
    if largest == 0.0:
        return math.inf
    e = np.array(contributions) / largest  # fourth powers of 1e-7 and less stay representable
    moved = e * (e if correlation is None else correlation @ e)
    estimates: dict[str | int, float] = {}
    known: dict[str | int, float] = {}
    for index, (part, dof) in enumerate(zip(moved.tolist(), dofs, strict=True)):
        name = shared[index] if shared and shared[index] else index
        estimates[name] = estimates.get(name, 0.0) + part
        known[name] = dof
    weighted = sum(part**2 / known[name] for name, part in estimates.items())
    dof = float(moved.sum()) ** 2 / weighted if weighted > 0.0 else math.inf
    return dof if dof < AS_GOOD_AS_INFINITE else math.inf


def coverage_factor(dof: float, probability: float = PROBABILITY) -> float:
    """Two-sided t quantile (JCGM 100, G.3); fractional degrees of freedom are not cut."""
    upper = 0.5 * (1.0 + probability)
    return (
        float(scipy.special.stdtrit(dof, upper)) if math.isfinite(dof) else float(scipy.special.ndtri(upper))
    )


def scale_of(uncertainty: Uncertainty) -> float:
    """Scale of the t-distribution by which a quantity lies about its value: u_c, and where U is from the
    Monte Carlo trials what holds 95 % within that U."""
    if not uncertainty.from_monte_carlo:
        return uncertainty.standard
    return max(uncertainty.standard, uncertainty.expanded / coverage_factor(uncertainty.dof))


def combine(
    rows: Sequence[BudgetRow], method: Method = "gum", correlations: Sequence[Correlation] = ()
) -> Uncertainty:
    """u_c by (10) or, with ``correlations`` between rows, by (13) of JCGM 100; U = k·u_c, k from t at 95 %.

    Raises InputError for correlations that cannot be, for degrees of freedom that are not positive, and for
    rows that share an estimate but not its degrees of freedom.
    """
    _check(rows)
    signed = np.array([math.copysign(row.contribution, row.sensitivity) for row in rows])
    matrix = correlation_matrix([row.symbol for row in rows], correlations) if correlations else None
    if matrix is None:
        standard = float(np.sqrt(np.sum(np.square(signed))))
    else:
        standard = math.sqrt(max(0.0, float(signed @ matrix @ signed)))
    dof = effective_dof(signed.tolist(), [row.dof for row in rows], [row.shared for row in rows], matrix)
    k = coverage_factor(dof)
    return Uncertainty(
        standard=standard,
        expanded=k * standard,
        coverage_factor=k,
        dof=dof,
        method=method,
        rows=tuple(rows),
        correlations=tuple(correlations),
    )


def shares(uncertainty: Uncertainty) -> tuple[float, ...]:
    """Each row's part e_i Σ r_ij e_j of the variance, in the rows' order: 1 in all, negative where a
    correlation takes away more than the row brings; all 0 where nothing contributes."""
    rows = uncertainty.rows
    largest = max((row.contribution for row in rows), default=0.0)
    if not 0.0 < largest < math.inf:
        return (0.0,) * len(rows)
    e = np.array([math.copysign(row.contribution / largest, row.sensitivity) for row in rows])
    parts = e * e
    if uncertainty.correlations:
        parts = e * (correlation_matrix([row.symbol for row in rows], uncertainty.correlations) @ e)
    total = math.fsum(parts.tolist())
    return tuple(float(part) / total if total > 0.0 else 0.0 for part in parts)


def _check(rows: Sequence[BudgetRow]) -> None:
    known: dict[str, float] = {}
    for row in rows:
        refuse_dof(row.dof, row.symbol)
        if row.shared and known.setdefault(row.shared, row.dof) != row.dof:
            raise InputError(
                "The rows that share the estimate “{shared}” have different degrees of freedom ({first} and "
                "{second}): it has one number of them.",
                shared=row.shared,
                first=known[row.shared],
                second=row.dof,
            )
