"""The Monte Carlo check of a quantity as it is drawn: deviations from the value, in the unit that is on. No
Qt; only scales what the check holds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.rounding import format_grouped
from ahrs_lab.ui.formatting import number
from ahrs_lab.ui.pages.results.quantities import Quantity, Unit
from ahrs_lab.ui.pages.results.what_if_model import significant

Array = NDArray[np.float64]
IntervalKey = Literal["gum", "symmetric", "shortest"]


@dataclass(frozen=True)
class Interval:
    """95 % of the distribution: ``low`` and ``high`` as drawn, ``text`` as a person reads them."""

    key: IntervalKey
    low: float
    high: float
    text: str


@dataclass(frozen=True)
class HistogramData:
    """``edges``, shape (n + 1,), are deviations from the value in 10^``power`` of the unit ``label``;
    ``trials``, ``standard`` (–: there is none) and ``tolerance`` (δ) are texts with their unit. ``widened``:
    the reported U is taken from the trials."""

    edges: Array
    counts: Array
    intervals: tuple[Interval, ...]
    power: int
    label: str
    trials: str
    standard: str
    tolerance: str
    validated: bool
    widened: bool


def histogram_data(quantity: Quantity, unit: Unit) -> HistogramData | None:
    """None where the quantity has no Monte Carlo check."""
    check = quantity.uncertainty.monte_carlo
    if check is None:
        return None
    value, expanded = quantity.value, quantity.uncertainty.gum_expanded
    reach = abs(unit.factor) * max(abs(check.bins[0] - value), abs(check.bins[1] - value))
    power = 0 if reach == 0.0 or 1e-2 <= reach < 1e4 else 3 * math.floor(math.log10(reach) / 3.0)
    scale = unit.factor / 10.0**power
    decimals = _decimals(abs(unit.factor) * check.tolerance)

    def interval(key: IntervalKey, low: float, high: float) -> Interval:
        ends = [format_grouped(f"{(end - unit.reference) * unit.factor:.{decimals}f}") for end in (low, high)]
        drawn = ((low - value) * scale, (high - value) * scale)
        return Interval(key, *drawn, f"[{ends[0]}, {ends[1]}]")

    label = "" if unit.label == "1" else unit.label
    return HistogramData(
        edges=(np.linspace(*check.bins, len(check.counts) + 1) - value) * scale,
        counts=np.array(check.counts, dtype=np.float64),
        intervals=(
            interval("gum", value - expanded, value + expanded),
            interval("symmetric", *check.symmetric),
            interval("shortest", *check.shortest),
        ),
        power=power,
        label=label,
        trials=number(float(check.trials), 0),
        standard="–"
        if check.standard is None
        else f"{number(abs(unit.factor) * check.standard, decimals)} {label}".rstrip(),
        tolerance=f"{significant(abs(unit.factor) * check.tolerance, 2)} {label}".rstrip(),
        validated=check.validated,
        widened=quantity.uncertainty.from_monte_carlo,
    )


def _decimals(tolerance: float) -> int:
    """One digit more than those whose last half δ is."""
    return max(0, -math.floor(math.log10(tolerance))) if tolerance > 0.0 else 9
