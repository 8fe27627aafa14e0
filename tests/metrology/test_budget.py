"""Combination of rows against published examples."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.messages import Message
from ahrs_lab.metrology.uncertainty.annex_a import acquisition_uncertainty, annex_a_uncertainty
from ahrs_lab.metrology.uncertainty.budget import (
    combine,
    coverage_factor,
    effective_dof,
    from_expanded,
    from_half_width,
    type_a,
)

SOURCE = Message("Time base")


@pytest.mark.parametrize(
    ("dof", "probability", "expected"),
    # JCGM 100, table G.2
    [
        (1, 0.95, 12.71),
        (4, 0.95, 2.78),
        (10, 0.95, 2.23),
        (50, 0.95, 2.01),
        (16, 0.99, 2.92),
        (math.inf, 0.95, 1.960),
        (math.inf, 0.9545, 2.000),
    ],
)
def test_the_coverage_factor_is_the_t_quantile(dof: float, probability: float, expected: float) -> None:
    assert coverage_factor(dof, probability) == pytest.approx(expected, abs=0.005)


def test_the_end_gauge_of_jcgm_100() -> None:
    """H.1: contributions 25, 9.7, 2.9, 16.6 nm with 18, 25.6, 50, 2 degrees of freedom."""
    rows = [
        type_a("a", SOURCE, "nm", u, 1.0, dof)
        for u, dof in ((25.0, 18.0), (9.7, 25.6), (2.9, 50.0), (16.6, 2.0))
    ]
    found = combine(rows)
    assert found.standard == pytest.approx(32.0, abs=0.5)
    assert found.dof == pytest.approx(16.7, abs=0.1)
    assert coverage_factor(math.floor(found.dof), 0.99) * found.standard == pytest.approx(93.0, abs=1.0)


def test_a_row_multiplies_by_its_sensitivity() -> None:
    assert type_a("a", SOURCE, "deg", 0.3, -1.0 / 7200.0, 9.0).contribution == pytest.approx(0.3 / 7200.0)
    row = from_expanded("b", SOURCE, "rad", 2e-4, -3.0, "certificate")
    assert (row.standard_uncertainty, row.contribution, row.divisor) == pytest.approx((1e-4, 3e-4, 2.0))


@pytest.mark.parametrize(
    ("distribution", "divisor"),
    [("rectangular", math.sqrt(3)), ("triangular", math.sqrt(6)), ("arcsine", math.sqrt(2))],
)
def test_limits_become_standard_uncertainties(distribution: str, divisor: float) -> None:
    row = from_half_width("q", SOURCE, "deg", 1.0, 2.0, "data", distribution)  # type: ignore[arg-type]
    assert row.contribution == pytest.approx(2.0 / divisor)


@given(st.lists(st.tuples(st.floats(0.0, 1e6), st.floats(1.0, 1e6)), min_size=1, max_size=8))
def test_effective_degrees_of_freedom_lie_between_the_least_and_the_sum(
    rows: list[tuple[float, float]],
) -> None:
    contributions, dofs = [u for u, _ in rows], [nu for _, nu in rows]
    found = effective_dof(contributions, dofs)
    assert found >= min(dofs) * (1.0 - 1e-9)
    if any(contributions):
        assert found <= sum(dofs) * (1.0 + 1e-9)


def test_tiny_and_infinite_rows_do_no_harm() -> None:
    assert effective_dof([], []) == math.inf
    assert effective_dof([0.0, 0.0], [3.0, 5.0]) == math.inf
    assert effective_dof([1e-200, 1e-210], [4.0, math.inf]) == pytest.approx(4.0)
    assert combine([]).expanded == 0.0


ANNEX = {"table_expanded": 2e-4, "table_origin": "certificate", "bits": 12.0, "bits_origin": "assumption"}


@pytest.mark.parametrize(
    ("repeatability", "standard", "expanded"),
    [
        ([1.22e-4], 2.12e-4, 4.23e-4),
        ([3.41e-5] * 4, 2.20e-4, 4.40e-4),
        ([2.51e-3] * 2, 5.02e-3, 1.005e-2),
    ],
)
def test_annex_a_gives_its_reference_values(
    repeatability: list[float], standard: float, expanded: float
) -> None:
    found = annex_a_uncertainty(1.0, "1", repeatability=repeatability, **ANNEX)  # type: ignore[arg-type]
    assert [row.contribution for row in found.rows[:2]] == pytest.approx([1.0e-4, 1.41e-4], rel=5e-3)
    assert found.rows[2].contribution == pytest.approx(sum(repeatability))
    assert found.standard == pytest.approx(standard, rel=2.5e-3)
    assert found.expanded == pytest.approx(expanded, rel=2.5e-3)
    assert (found.coverage_factor, found.method) == (2.0, "annex-a")


def test_annex_a_divides_the_full_step() -> None:
    assert acquisition_uncertainty(12) == pytest.approx(1.0 / 4096.0 / math.sqrt(3.0), rel=1e-15)


def test_annex_a_takes_its_relative_terms_of_the_value() -> None:
    found = annex_a_uncertainty(-3.0, "deg/s", repeatability=[], **ANNEX)  # type: ignore[arg-type]
    assert found.rows[0].contribution == pytest.approx(3e-4)
