"""Full models of K and F₀: the line of (14), (15) fitted again through the rates that may have been.

A table that turns by e faster than demanded in one band of clause 6 changes Ω_j to Ω_j(1 + e) in all of that
band, so a fit needs only the sums over each band.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.scale_factor import ScaleFactorFit
from ahrs_lab.metrology.uncertainty.full_model import FullModel, Inputs, at, by_symbol
from ahrs_lab.metrology.uncertainty.gum_scale_factor import bands_of

Array = NDArray[np.float64]

_MEANS = ("F̄", "v", "D", "q", "F̄ᵣ", "θ")
"""Rows of the means and of the table's single angles: they move K and F₀ linearly."""


@dataclass(frozen=True)
class Line:
    """A fitted line, each field of shape (trials,): slope, value at rate 0, and S = Σ(Ω − Ω̄)²."""

    K: Array
    F0: Array
    spread: Array


class BandSums:
    """Sums of Ω_j, Ω_j², Ω_j·F_j over each band of ``fit``'s rates, from which lines are fitted."""

    def __init__(self, fit: ScaleFactorFit) -> None:
        rates, outputs = np.array(fit.rates_dps), np.array(fit.outputs)
        bands = bands_of(rates)
        self._count = len(rates)
        self._output = float(outputs.mean())
        inside = [bands == band for band in np.unique(bands)]
        self._rates = [float(rates[band].sum()) for band in inside]
        self._squares = [float(rates[band] @ rates[band]) for band in inside]
        # about the mean output: the sum of products does not cancel
        self._products = [float(rates[band] @ (outputs[band] - self._output)) for band in inside]

    def fit(self, relative: list[Array | float], trials: int) -> Line:
        """With the rates of each band larger by ``relative``, each of shape (trials,) or 0."""
        mean, square, product = (np.zeros(trials) for _ in range(3))
        for error, rates, squares, products in zip(
            relative, self._rates, self._squares, self._products, strict=True
        ):
            larger = 1.0 + error
            mean += rates / self._count * larger
            square += squares * (larger * larger)
            product += products * larger
        spread = square - self._count * mean * mean
        K = product / spread
        return Line(K, self._output - K * mean, spread)


def _band_inputs(inputs: Inputs, fit: ScaleFactorFit, rows: list[BudgetRow]) -> list[int | None]:
    if not rows:  # rates as the table measured them
        return [None] * len(np.unique(bands_of(np.array(fit.rates_dps))))
    return [inputs.add(row) for row in rows]


def scale_factor_model(fit: ScaleFactorFit, budget: Uncertainty) -> FullModel:
    """Of K, with the inputs of its budget.

    Noise of the means moves K by 1/√S of the rates that really were; the time base scales the rates, and an
    axis inclined by ε both ways shows their cosine.
    """
    inputs = Inputs(by_symbol(budget, *_MEANS))
    bands = _band_inputs(inputs, fit, by_symbol(budget, "Ω"))
    timing = [inputs.add(row) for row in by_symbol(budget, "t")]
    inclined = [inputs.add(row) for row in by_symbol(budget, "ε") for _ in range(2)]
    sums = BandSums(fit)

    def evaluate(drawn: Array) -> Array:
        line = sums.fit([at(drawn, place) for place in bands], drawn.shape[1])
        K = line.K + inputs.linear(drawn) * np.sqrt(fit.spread / line.spread)
        for place in timing:
            K *= 1.0 + at(drawn, place)
        for place in inclined:
            K /= np.cos(at(drawn, place))
        return np.asarray(K)

    return inputs.model(evaluate)


def offset_model(fit: ScaleFactorFit, budget: Uncertainty) -> FullModel:
    """Of F₀, with the inputs of its budget."""
    inputs = Inputs(by_symbol(budget, *_MEANS, "β"))
    bands = _band_inputs(inputs, fit, by_symbol(budget, "Ω"))
    sums = BandSums(fit)

    def evaluate(drawn: Array) -> Array:
        line = sums.fit([at(drawn, place) for place in bands], drawn.shape[1])
        return np.asarray(line.F0 + inputs.linear(drawn))

    return inputs.model(evaluate)
