"""Full model of L: the turned axis really tilts, so the output shows a part of the turn itself."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.metrology.uncertainty.full_model import FullModel, Inputs, at, by_symbol
from ahrs_lab.metrology.uncertainty.gum_misalignment import MisalignmentEvidence

Array = NDArray[np.float64]


def misalignment_model(L: float, evidence: MisalignmentEvidence, budget: Uncertainty) -> FullModel:
    """(17) with what was turned and what K is: M = (N⁺ − N⁻)/(2·360·n·(1 + θ)(1 + κ)).

    A case whose axis is tilted by δ towards the output's shows M = sin δ + L·cos δ; δ is wobble, seat and
    fixture together.
    """
    inputs = Inputs(by_symbol(budget, "N⁺", "N⁻", "D", "ΔT", "q"))
    tilts = [inputs.add(row) for row in by_symbol(budget, "w", "β", "γ")]
    (angle,) = [inputs.add(row) for row in by_symbol(budget, "θ")]
    scales = [inputs.add(row) for row in by_symbol(budget, "K")]
    turned_rad = math.radians(360.0 * evidence.turns)

    def evaluate(drawn: Array) -> Array:
        shown = L + inputs.linear(drawn)
        shown /= 1.0 + at(drawn, angle) / turned_rad
        for place in scales:
            shown /= 1.0 + at(drawn, place)
        tilt = sum((at(drawn, place) for place in tilts), start=np.zeros(drawn.shape[1]))
        return np.asarray((shown - np.sin(tilt)) / np.cos(tilt))

    return inputs.model(evaluate)
