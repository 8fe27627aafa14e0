"""Combinations against GTC (the GUM Tree Calculator), which propagates uncertain numbers by itself: u and
degrees of freedom to 1e-9."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import Correlation, Uncertainty
from ahrs_lab.metrology.uncertainty.budget import combine, type_a

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
