"""What if a source were better known: the example H.1 of JCGM 100 with a changed row, and what stays."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.result import BudgetRow, Correlation, Uncertainty
from ahrs_lab.metrology.uncertainty.annex_a import annex_a_uncertainty
from ahrs_lab.metrology.uncertainty.budget import combine, from_expanded, from_half_width, shares, type_a
from ahrs_lab.metrology.uncertainty.what_if import Change, what_if

SOURCE = Message("Time base")


def end_gauge() -> Uncertainty:
    """H.1: contributions 25, 9.7, 2.9, 16.6 nm; the last is δθ with a half-width of 0.05 °C."""
    return combine(
        [
            type_a("l_S", SOURCE, "nm", 25.0, 1.0, 18.0),
            type_a("d", SOURCE, "nm", 9.7, 1.0, 25.6),
            type_a("δα", SOURCE, "nm", 2.9, 1.0, 50.0),
            replace(
                from_half_width("δθ", SOURCE, "°C", 0.05, -50_000_623.0 * 11.5e-6, "certificate"), dof=2.0
            ),
        ]
    )


def test_h1_with_the_temperature_difference_known_twice_as_well() -> None:
    """By hand: √(25² + 9.7² + 2.9² + 8.3²) = 28.2 nm; ν = 28.2⁴/(25⁴/18 + 9.7⁴/25.6 + 2.9⁴/50 + 8.3⁴/2)."""
    before = end_gauge()
    found = what_if(before, {3: Change(half_width=0.025)})
    last = 0.5 * before.rows[3].contribution
    parts = [25.0, 9.7, 2.9, last]
    assert last == pytest.approx(8.3, abs=0.05)
    assert found.standard == pytest.approx(math.hypot(*parts), rel=1e-14)
    assert found.standard == pytest.approx(28.2, abs=0.1)
    known = 25.0**4 / 18.0 + 9.7**4 / 25.6 + 2.9**4 / 50.0 + last**4 / 2.0
    assert found.dof == pytest.approx(found.standard**4 / known, rel=1e-12)
    assert found.expanded < before.expanded
    assert shares(found) == pytest.approx([part**2 / found.standard**2 for part in parts])
    assert found.rows[3].half_width == pytest.approx(0.025)
    assert before == end_gauge()  # the budget itself is as it was


def test_a_row_that_is_left_out_stays_with_nothing() -> None:
    found = what_if(end_gauge(), {0: Change(left_out=True)})
    assert found.standard == pytest.approx(math.hypot(9.7, 2.9, 50_000_623.0 * 11.5e-6 * 0.05 / 3**0.5))
    assert [row.symbol for row in found.rows] == ["l_S", "d", "δα", "δθ"]
    assert shares(found)[0] == 0.0


def test_u_may_be_given_as_itself_or_as_half_width() -> None:
    row = from_expanded("β", SOURCE, "rad", 2e-4, -3.0, "assumption")
    budget = combine([row])
    assert what_if(budget, {0: Change(half_width=1e-4)}) == what_if(
        budget, {0: Change(standard_uncertainty=5e-5)}
    )


def test_correlations_are_kept() -> None:
    rows = [type_a("a", SOURCE, "nm", 3.0, 1.0, math.inf), type_a("b", SOURCE, "nm", 4.0, -1.0, math.inf)]
    budget = combine(rows, correlations=[Correlation(0, 1, 0.5)])
    found = what_if(budget, {1: Change(standard_uncertainty=2.0)})
    assert found.standard == pytest.approx(math.sqrt(9.0 + 4.0 - 6.0))
    assert found.correlations == budget.correlations
    assert shares(found) == pytest.approx([(9.0 - 3.0) / 7.0, (4.0 - 3.0) / 7.0])


def test_degrees_of_freedom_are_of_the_estimate() -> None:
    rows = [type_a(name, SOURCE, "nm", 1.0, 1.0, 9.0, shared="noise") for name in "ab"]
    found = what_if(combine([*rows, type_a("c", SOURCE, "nm", 1.0, 1.0, 7.0)]), {0: Change(dof=4.0)})
    assert [row.dof for row in found.rows] == [4.0, 4.0, 7.0]
    assert found.dof == pytest.approx(9.0 / (4.0 / 4.0 + 1.0 / 7.0))


def test_annex_a_keeps_its_own_k() -> None:
    budget = annex_a_uncertainty(
        1.0,
        "1",
        table_expanded=2e-4,
        table_origin="assumption",
        bits=12.0,
        bits_origin="data",
        repeatability=[1e-5],
    )
    found = what_if(budget, {1: Change(left_out=True)})
    assert found.standard == pytest.approx(math.hypot(1e-4, 1e-5))
    assert (found.coverage_factor, found.expanded, found.method) == (2.0, 2.0 * found.standard, "annex-a")
    assert math.isinf(found.dof)


sizes = st.floats(0.0, 1e6)
rows_of_a_budget = st.lists(
    st.builds(
        lambda u, c, dof: type_a("x", SOURCE, "1", u, c, dof),
        sizes,
        st.floats(-1e6, 1e6),
        st.one_of(st.floats(1.0, 1e4), st.just(math.inf)),
    ),
    min_size=1,
    max_size=8,
)


@given(rows_of_a_budget)
def test_no_change_is_the_same_to_the_last_bit(rows: list[BudgetRow]) -> None:
    budget = combine(rows)
    assert what_if(budget, {}) == budget
    same = {
        i: Change(standard_uncertainty=row.standard_uncertainty, dof=row.dof) for i, row in enumerate(rows)
    }
    assert what_if(budget, same) == budget
    # and there and back again, through the combination itself
    other = what_if(budget, {0: Change(standard_uncertainty=rows[0].standard_uncertainty + 1.0)})
    back = what_if(other, {0: Change(standard_uncertainty=rows[0].standard_uncertainty)})
    assert (back.standard, back.expanded, back.dof) == (budget.standard, budget.expanded, budget.dof)


@pytest.mark.parametrize(
    ("place", "change", "words"),
    [
        (4, Change(left_out=True), "no row 5"),
        (0, Change(standard_uncertainty=-1.0), "0 or more"),
        (0, Change(standard_uncertainty=math.nan), "0 or more"),
        (0, Change(half_width=math.inf), "0 or more"),
        (0, Change(dof=0.0), "positive"),
        (0, Change(1.0, 1.0), "changed twice"),
    ],
)
def test_what_cannot_be_is_refused(place: int, change: Change, words: str) -> None:
    with pytest.raises(InputError, match=words):
        what_if(end_gauge(), {place: change})
