"""Combinations against GTC (the GUM Tree Calculator), which propagates uncertain numbers by itself: u and
degrees of freedom to 1e-9."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import Correlation, Uncertainty
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.budget import combine, type_a
from ahrs_lab.metrology.uncertainty.fitted_scale import FittedScale
from ahrs_lab.metrology.uncertainty.gum_misalignment import misalignment_uncertainty
from ahrs_lab.metrology.uncertainty.gum_zero_offset import zero_offset_uncertainty
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from ahrs_lab.metrology.uncertainty.resolution import Resolution
from tests.metrology.evidence import (
    BENCH,
    KNOWN_TO_6_DOF,
    RATES,
    budgets,
    four_positions,
    rates_evidence,
    turns,
)

GTC = pytest.importorskip("GTC", reason="GTC, the oracle for budgets, is not installed here")
SOURCE = Message("Time base")


def gtc_of_rows(found: Uncertainty) -> Any:
    """The linear budget rebuilt of GTC's uncertain numbers; rows of one estimate form an ensemble."""
    numbers: list[Any] = [None] * len(found.rows)
    for name in {row.shared for row in found.rows} - {""}:
        places = [i for i, row in enumerate(found.rows) if row.shared == name]
        ensemble = GTC.multiple_ureal(
            [0.0] * len(places),
            [found.rows[i].standard_uncertainty for i in places],
            found.rows[places[0]].dof,
        )
        for place, number in zip(places, ensemble, strict=True):
            numbers[place] = number
    for index, row in enumerate(found.rows):
        if numbers[index] is None:
            independent = not any(index in (entry.first, entry.second) for entry in found.correlations)
            numbers[index] = GTC.ureal(0.0, row.standard_uncertainty, row.dof, independent=independent)
    for entry in found.correlations:
        GTC.set_correlation(entry.coefficient, numbers[entry.first], numbers[entry.second])
    return sum(row.sensitivity * number for row, number in zip(found.rows, numbers, strict=True))


def assert_same(found: Uncertainty, number: Any) -> None:
    assert found.standard == pytest.approx(GTC.uncertainty(number), rel=1e-9, abs=0.0)
    dof = GTC.dof(number)
    if math.isfinite(found.dof):
        assert found.dof == pytest.approx(dof, rel=1e-9)
    else:
        assert dof > 1e6


def row(u: float, c: float, dof: float, shared: str = "") -> Any:
    return type_a(f"x_{u}", SOURCE, "nm", u, c, dof, shared=shared)


def test_independent_rows() -> None:
    rows = [row(25.0, 1.0, 18.0), row(9.7, -2.0, 25.6), row(2.9, 0.3, 50.0), row(16.6, 1.0, math.inf)]
    found = combine(rows)
    assert_same(found, gtc_of_rows(found))


def test_rows_of_one_estimate_count_its_degrees_of_freedom_once() -> None:
    rows = [row(3.0, 1.0, 7.0, "N"), row(2.0, -2.0, 7.0, "N"), row(1.5, 1.0, 11.0), row(4.0, 0.5, math.inf)]
    found = combine(rows)
    assert_same(found, gtc_of_rows(found))
    assert found.dof < combine([row(3.0, 1.0, 7.0), row(2.0, -2.0, 7.0), *rows[2:]]).dof


def test_correlated_rows_of_known_uncertainty() -> None:
    rows = [row(3.0, 1.0, math.inf), row(2.0, -2.0, math.inf), row(1.5, 1.0, 11.0)]
    found = combine(rows, correlations=[Correlation(0, 1, 0.8)])
    assert_same(found, gtc_of_rows(found))
    assert found.standard == pytest.approx(math.sqrt(9.0 + 16.0 - 2.0 * 0.8 * 12.0 + 2.25))


def test_simultaneous_observations() -> None:
    rows = [row(3.0, 1.0, 4.0, "n"), row(2.0, -2.0, 4.0, "n"), row(1.0, 3.0, 4.0, "n"), row(1.5, 1.0, 11.0)]
    coefficients = [Correlation(0, 1, -0.36), Correlation(0, 2, 0.86), Correlation(1, 2, -0.65)]
    found = combine(rows, correlations=coefficients)
    assert_same(found, gtc_of_rows(found))
    assert combine(rows[:3], correlations=coefficients).dof == pytest.approx(4.0, rel=1e-12)


def test_many_random_budgets() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        rows = [
            row(float(u), float(c), float(dof))
            for u, c, dof in zip(
                10.0 ** rng.uniform(-6, 3, 6), rng.normal(size=6), rng.uniform(1, 200, 6), strict=True
            )
        ]
        found = combine(rows)
        assert_same(found, gtc_of_rows(found))


NOISE = NoiseModel(white=2.5e-3, white_dof=40.0, flicker=1e-3, covariance=KNOWN_TO_6_DOF)
MEANS = 1.01 * RATES + 0.02 + 1e-3 * np.sin(7.0 * RATES)


def quantities() -> dict[str, Uncertainty]:
    """A budget of each of the house's quantities with every row in it."""
    evidence = replace(rates_evidence(), noise=NOISE, resolution=Resolution(1e-3))
    fit = fit_scale_factor(RATES, MEANS, 0.001, 0.002)
    K, F0 = budgets(fit, evidence, time_scaled=True)
    K_measured, F0_measured = budgets(fit, evidence, "table")
    positions = replace(
        four_positions(), noise=NOISE, scale=FittedScale(1e-3, 12.0), time_scaled=True, leans=1e-3
    )
    in_turns = replace(turns(), noise=NOISE, scale=FittedScale(1e-3), resolution=Resolution(1e-3))
    return {
        "K": K,
        "F0": F0,
        "K, measured rates": K_measured,
        "F0, measured rates": F0_measured,
        "B": zero_offset_uncertainty(0.02, positions, BENCH),
        "L": misalignment_uncertainty(0.01, in_turns, BENCH),
    }


@pytest.mark.parametrize("quantity", quantities())
def test_every_quantitys_budget(quantity: str) -> None:
    found = quantities()[quantity]
    assert_same(found, gtc_of_rows(found))


def test_K_and_F0_of_a_line_through_uncertain_numbers() -> None:
    """GTC carries every mean and every band's error through (14) and (15) by itself: its derivatives, not
    ours."""
    evidence = replace(rates_evidence(), standard_errors=np.linspace(1e-3, 3e-3, len(RATES)))
    fit = fit_scale_factor(RATES, MEANS, 0.001, 0.002)
    bands = [GTC.ureal(0.0, 0.5 * relative) for relative in BENCH.rate_relative]
    band = np.digitize(np.abs(RATES), [1.0, 10.0])
    rates = [rate * (1.0 + bands[index]) for rate, index in zip(RATES.tolist(), band.tolist(), strict=True)]
    outputs = [
        GTC.ureal(mean, error, dof)
        for mean, error, dof in zip(
            fit.outputs, evidence.standard_errors.tolist(), evidence.dofs.tolist(), strict=True
        )
    ]
    rest = GTC.ureal(0.0, 1e-3, 39.0), GTC.ureal(0.0, 1e-3, 39.0)
    count = len(RATES)
    mean_rate, mean_output = sum(rates) / count, sum(outputs) / count
    deviations = [rate - mean_rate for rate in rates]
    K = sum(d * output for d, output in zip(deviations, outputs, strict=True)) / sum(
        d * d for d in deviations
    )
    F0 = mean_output - K * mean_rate - 0.5 * (rest[0] + rest[1])
    for symbols, ours, theirs in zip(("F̄ Ω", "F̄ Ω F̄ᵣ"), budgets(fit, evidence), (K, F0), strict=True):
        rows = [entry for entry in ours.rows if entry.symbol in symbols.split()]
        assert_same(combine(rows), theirs)


def test_L_of_uncertain_numbers() -> None:
    rows = [entry for entry in quantities()["L"].rows if entry.symbol in ("N⁺", "N⁻", "w", "β", "γ")]
    angles = GTC.multiple_ureal([3.6, -3.6], [entry.standard_uncertainty for entry in rows[:2]], 40.0)
    tilts = [GTC.ureal(0.0, entry.standard_uncertainty) for entry in rows[2:]]
    assert_same(combine(rows), (angles[0] - angles[1]) / 7200.0 - GTC.sin(sum(tilts)))
