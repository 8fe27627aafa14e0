"""Full model of B: the case is really rotated by the errors of table, seat and fixture, and what it then
feels of the Earth's rate differs from what the positions were chosen to cancel.

From the case outwards: seat and fixture (each mounting its own) and the platform (common to all mountings)
tilt the case in axes that turn with the table; each stop but the first of a mounting is turned by its own
error; the table as a whole leans and is turned away from north.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.metrology.uncertainty.full_model import FullModel, Inputs, at, by_symbol
from ahrs_lab.metrology.uncertainty.gum_zero_offset import REPEATABILITY, EarthLeverage, ZeroOffsetEvidence
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS

Array = NDArray[np.float64]
Component = Array | float
Vector = tuple[Component, Component, Component]
_Tilt = tuple[int | None, int | None]


def rotated(vector: Vector, by: Vector) -> Vector:
    """``vector`` rotated by the rotation vector ``by``, rad; each component of shape (trials,) or a number.

    Gibbs' form with tan(θ/2) taken as θ/2: a rotation for any θ, its angle right to θ³/12, and without a
    sine.
    """
    g = (0.5 * by[0], 0.5 * by[1], 0.5 * by[2])
    once = _cross(g, vector)
    twice = _cross(g, once)
    factor = 2.0 / (1.0 + (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]))
    return (
        vector[0] + factor * (once[0] + twice[0]),
        vector[1] + factor * (once[1] + twice[1]),
        vector[2] + factor * (once[2] + twice[2]),
    )


def _cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@dataclass(frozen=True)
class _Places:
    """Where the errors stand in the drawn array: ``turned`` by stop, ``seat`` and ``fixture`` by mounting; of
    a tilt east and north."""

    turned: tuple[int | None, ...]
    azimuth: int | None
    lean: _Tilt
    platform: _Tilt
    seat: tuple[_Tilt, ...]
    fixture: tuple[_Tilt, ...]
    latitude: int | None


def zero_offset_model(B: float, evidence: ZeroOffsetEvidence, budget: Uncertainty) -> FullModel:
    """B = mean(N_i/T_i)/((1 + t)(1 + κ)) less what the errors let in of the Earth's rate."""
    noise = [row.symbol for row in budget.rows if row.symbol.startswith("N_")]
    inputs = Inputs(by_symbol(budget, *noise, "q", "λ", REPEATABILITY))
    relative = [inputs.add(row) for row in by_symbol(budget, "t", "K")]
    leverage = EarthLeverage.of(evidence)
    places = _add_errors(inputs, leverage, budget)

    def evaluate(drawn: Array) -> Array:
        shown = B + inputs.linear(drawn)
        for place in relative:
            shown /= 1.0 + at(drawn, place)
        return np.asarray(shown - _let_in(drawn, places, evidence, leverage))

    return inputs.model(evaluate)


def _add_errors(inputs: Inputs, leverage: EarthLeverage, budget: Uncertainty) -> _Places:
    alpha, psi, tau, wobble, beta, gamma, phi = (by_symbol(budget, symbol)[0] for symbol in "αψτwβγφ")
    return _Places(
        turned=tuple(None if first else inputs.add(alpha) for first in leverage.first_stops),
        azimuth=inputs.add(psi),
        lean=(inputs.add(tau), inputs.add(tau)),
        platform=(inputs.add(wobble), inputs.add(wobble)),
        seat=tuple((inputs.add(beta), inputs.add(beta)) for _ in leverage.names),
        fixture=tuple((inputs.add(gamma), inputs.add(gamma)) for _ in leverage.names),
        latitude=inputs.add(phi),
    )


def _let_in(
    drawn: Array, places: _Places, evidence: ZeroOffsetEvidence, leverage: EarthLeverage
) -> Component:
    """What the axis feels of the Earth's rate, less what it would without errors, mean of the stops, °/s."""
    latitude = math.radians(evidence.latitude_deg) + at(drawn, places.latitude)
    earth: Vector = (0.0, EARTH_RATE_DPS * np.cos(latitude), EARTH_RATE_DPS * np.sin(latitude))
    lean = at(drawn, places.lean[0]), at(drawn, places.lean[1])
    # the table carries the case with it: the same as the Earth's rate turned the other way
    earth = rotated(earth, (-lean[0], -lean[1], -at(drawn, places.azimuth)))
    felt: Component = 0.0
    for index, (direction, turned) in enumerate(
        zip(evidence.directions.tolist(), np.radians(evidence.turned_deg).tolist(), strict=True)
    ):
        mounting = leverage.names.index(evidence.mountings[index])
        tilts = (places.platform, places.seat[mounting], places.fixture[mounting])
        east, north = (sum(at(drawn, tilt[k]) for tilt in tilts) for k in range(2))
        cosine, sine = math.cos(turned), math.sin(turned)
        tilt = (cosine * east - sine * north, sine * east + cosine * north, 0.0)
        axis = rotated((direction[0], direction[1], direction[2]), tilt)
        axis = rotated(axis, (0.0, 0.0, at(drawn, places.turned[index])))
        felt = felt + (axis[0] * earth[0] + axis[1] * earth[1] + axis[2] * earth[2])
    count = len(evidence.directions)
    return felt / count - float((evidence.directions @ leverage.earth).sum()) / count
