"""Full models of the quantities for the Monte Carlo check of their budgets: the measurement equation itself,
not its first-order sum, with each input distributed as its row of the budget says.

What enters linearly is drawn together: the normal rows as one normal, the rows of one estimate as one t.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.result import BudgetRow, MonteCarloCheck, Uncertainty
from ahrs_lab.metrology.uncertainty.distributions import (
    ArcSine,
    Input,
    Normal,
    Rectangular,
    StudentT,
    triangular,
)
from ahrs_lab.metrology.uncertainty.monte_carlo import Model, numerical_tolerance, propagate, validate

Array = NDArray[np.float64]

LINEAR = ""
"""In place of a row's symbol: an input in the quantity's own unit that stands for linear rows."""
MOST_TRIALS = 500_000
"""Limit of the adaptive procedure in a reduction. Twice the standard error of an interval's end is then
0.0076 u, and δ is nowhere below 0.017 u: only what differs by about δ is a matter of chance."""


@dataclass(frozen=True)
class FullModel:
    """``evaluate`` takes deviations from the estimates, shape (inputs, trials), in the rows' own units, to
    the quantity, shape (trials,); at zero it gives the reported value.

    ``symbols`` names the row that each input belongs to; a row that acts in several places has several.
    """

    inputs: tuple[Input, ...]
    symbols: tuple[str, ...]
    evaluate: Model


@dataclass(frozen=True)
class MonteCarloSettings:
    """``identity``: what the seeds come from (the bundle's hash), so that a recording has one result.

    ``trials``: None adaptive, 0 without Monte Carlo, else a fixed number.
    """

    identity: str
    trials: int | None = None

    def seed(self, quantity: str) -> int:
        """Of one quantity, such as ``K_x``; 48 bits, which JSON readers keep exactly."""
        return int.from_bytes(hashlib.sha256(f"{self.identity} {quantity}".encode()).digest()[:6], "big")


def meaningful_digits(standard: float) -> int:
    """Two digits of u where it begins with 1 or 2, else one: δ is 1.7 % to 17 % of u, whatever u is.

    One digit throughout would let half of u pass where u begins with 1; two throughout would need 3·10⁷
    trials where it begins with 9.
    """
    return 2 if Decimal(repr(standard)).as_tuple().digits[0] in (1, 2) else 1


def check_by_monte_carlo(
    budget: Uncertainty,
    value: float,
    make_model: Callable[[], FullModel],
    settings: MonteCarloSettings,
    quantity: str,
) -> Uncertainty:
    """``budget`` with its Monte Carlo check on the model made for it.

    Where the check is not passed and the trials' symmetric interval reaches beyond ± U, U becomes what covers
    it (8.3): see :func:`_widened`. Without trials, without width or without bounds it stays as it is.
    """
    if settings.trials == 0 or budget.standard == 0.0 or not math.isfinite(value + budget.expanded):
        return budget
    model, digits = make_model(), meaningful_digits(budget.standard)
    found = propagate(
        model.inputs,
        model.evaluate,
        seed=settings.seed(quantity),
        trials=settings.trials,
        digits=digits,
        tolerance=numerical_tolerance(budget.standard, digits),
        most=MOST_TRIALS,
    )
    ends = value - budget.expanded, value + budget.expanded
    check = validate(found, *ends, standard=budget.standard, digits=digits)
    # the U that was tested, not half a difference that has lost its last digits beside a large value
    check = replace(check, gum_expanded=budget.expanded)
    return _widened(replace(budget, monte_carlo=check), value, check)


def _widened(budget: Uncertainty, value: float, check: MonteCarloCheck) -> Uncertainty:
    """U from the trials where the GUM's is not validated and too short: half-width about the value that
    covers the symmetric interval, k = U/u_c. A longer U of the GUM stays: it holds more than 95 %."""
    reach = max(value - check.symmetric[0], check.symmetric[1] - value)
    if check.validated or reach <= budget.expanded:
        return budget
    return replace(budget, expanded=reach, coverage_factor=reach / budget.standard, from_monte_carlo=True)


def deviation(row: BudgetRow, size: float = 1.0) -> Input:
    """Of a row's input from its estimate, distributed as the row says; times ``size``."""
    factor = abs(size)
    if row.distribution == "t":
        return StudentT(0.0, factor * row.standard_uncertainty, row.dof)
    if row.distribution == "normal":
        return Normal(0.0, factor * row.standard_uncertainty)
    half_width = factor * row.divisor * row.standard_uncertainty
    if row.distribution == "rectangular":
        return Rectangular(0.0, half_width)
    return triangular(0.0, half_width) if row.distribution == "triangular" else ArcSine(0.0, half_width)


def linear_part(rows: Sequence[BudgetRow]) -> list[Input]:
    """Deviations of the quantity by rows that enter linearly, in the quantity's unit; their sum is meant.

    Rows of one estimate of n degrees of freedom are jointly a multivariate t, so their sum is one t.
    """
    found: list[Input] = []
    normal = math.hypot(*(row.contribution for row in rows if row.distribution == "normal"))
    if normal > 0.0:
        found.append(Normal(0.0, normal))
    shared: dict[tuple[str, float], float] = {}
    for row in rows:
        if row.contribution == 0.0 or row.distribution == "normal":
            continue
        if row.distribution == "t" and row.shared:
            key = (row.shared, row.dof)
            shared[key] = math.hypot(shared.get(key, 0.0), row.contribution)
        else:
            found.append(deviation(row, row.sensitivity))
    return [*found, *(StudentT(0.0, scale, dof) for (_, dof), scale in shared.items())]


class Inputs:
    """Gathers the inputs of a model and says where in the drawn array each stands."""

    def __init__(self, linear: Sequence[BudgetRow]) -> None:
        self._inputs = linear_part(linear)
        self._symbols = [LINEAR] * len(self._inputs)
        self._linear = len(self._inputs)

    def add(self, row: BudgetRow) -> int | None:
        """The place of a deviation by ``row``; None where it has no width and need not be drawn."""
        if row.standard_uncertainty == 0.0:
            return None
        self._inputs.append(deviation(row))
        self._symbols.append(row.symbol)
        return len(self._inputs) - 1

    def linear(self, drawn: Array) -> Array:
        """Sum of the linear part, shape (trials,)."""
        return np.asarray(drawn[: self._linear].sum(axis=0))

    def model(self, evaluate: Model) -> FullModel:
        """All gathered inputs with the equation they belong to."""
        return FullModel(tuple(self._inputs), tuple(self._symbols), evaluate)


def at(drawn: Array, place: int | None) -> Array | float:
    """The input's deviations, 0 for one without width."""
    return 0.0 if place is None else drawn[place]


def by_symbol(budget: Uncertainty, *symbols: str) -> list[BudgetRow]:
    """The rows of ``budget`` with one of ``symbols``, in their order."""
    return [row for row in budget.rows if row.symbol in symbols]
