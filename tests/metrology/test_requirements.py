"""What is asked of a result survives its JSON, and U never goes below the laboratory's capability."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.best_capability import (
    BestCapability,
    capability_from_json,
    capability_to_json,
    reported,
)
from ahrs_lab.metrology.conformity import RULES, DecisionRule, assess
from ahrs_lab.metrology.limits import LIMIT_UNITS, LIMITED, Limit
from ahrs_lab.metrology.requirements import (
    MISALIGNMENT_UNITS,
    SCALE_FACTOR_UNITS,
    ZERO_OFFSET_UNITS,
    Requirements,
    ResultUnits,
    requirements_from_json,
    requirements_to_json,
)
from ahrs_lab.metrology.result import Uncertainty
from tests.certificates.conftest import U_B, U_K, K, sample_result


def test_nothing_asked_is_no_text() -> None:
    assert requirements_to_json(Requirements()) == ""
    assert requirements_from_json(" ") == Requirements()


@st.composite
def a_limit(draw: st.DrawFn, quantity: str) -> Limit:
    unit = draw(st.sampled_from(sorted(LIMIT_UNITS[quantity[0]])))
    low = draw(st.one_of(st.none(), st.floats(-1e9, 1e9)))
    high = None if low is not None and draw(st.booleans()) else (low or 0.0) + draw(st.floats(1.0, 1e9))
    nominal = draw(st.floats(1e-3, 1e3)) if LIMIT_UNITS[quantity[0]][unit].relative else None
    return Limit(quantity, low, high, unit, nominal)


@st.composite
def requirements(draw: st.DrawFn) -> Requirements:
    quantities = draw(st.lists(st.sampled_from(LIMITED), unique=True, max_size=5))
    return Requirements(
        tuple(draw(a_limit(quantity)) for quantity in quantities),
        DecisionRule(draw(st.sampled_from(RULES)), draw(st.floats(0.1, 10.0)), draw(st.booleans())),
        ResultUnits(
            draw(st.sampled_from(SCALE_FACTOR_UNITS)),
            draw(st.sampled_from(ZERO_OFFSET_UNITS)),
            draw(st.sampled_from(MISALIGNMENT_UNITS)),
        ),
        draw(st.booleans()),
    )


@given(requirements())
def test_requirements_survive_their_json(asked: Requirements) -> None:
    assert requirements_from_json(requirements_to_json(asked)) == asked


@pytest.mark.parametrize(
    "text",
    [
        "x",
        "[]",
        "[" * 100_000,
        '{"limits": [{"quantity": "K"}]}',
        '{"limits": [{"quantity": "B", "low": "1", "high": 2, "unit": "deg/s"}]}',
        '{"limits": [{"quantity": "B", "low": NaN, "high": 2, "unit": "deg/s"}]}',
        '{"limits": [{"quantity": "B", "low": 3, "high": 2, "unit": "deg/s"}]}',
        '{"rule": {"kind": "kind"}}',
        '{"rule": {"kind": "simple", "r": -1}}',
        '{"rule": {"kind": "simple", "probability": 1}}',
        '{"units": {"zero_offset": "furlong"}}',
    ],
)
def test_a_text_that_was_not_written_here_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        requirements_from_json(text)


def test_two_limits_of_one_quantity_are_refused() -> None:
    limit = Limit("B", -1.0, 1.0, "deg/s")
    with pytest.raises(InputError, match="two limits"):
        Requirements((limit, limit))


def test_u_is_raised_to_the_capability_and_only_where_it_is_smaller() -> None:
    result = sample_result()
    raised = reported(result, BestCapability(K_relative=3e-4, B_dps=U_B))
    assert raised.raised == ("K_x", "K_y", "K_z")
    x = raised.result.scale_factor["x"].uncertainty
    assert x.expanded == pytest.approx(3e-4 * K["x"])
    assert (x.coverage_factor, x.dof) == (2.0, result.scale_factor["x"].uncertainty.dof)
    assert x.standard == pytest.approx(x.expanded / 2.0)
    assert raised.result.zero_offset == result.zero_offset
    assert result.scale_factor["x"].uncertainty.expanded == U_K


@pytest.mark.parametrize(
    ("k", "dof", "smallest"), [(3.18, 3.0, 3.2), (1.96, math.inf, 1.97), (4.3, 2.0, 4.4), (2.0, 50.0, 9.0)]
)
@pytest.mark.parametrize("high", [0.5, 1.5, 3.0, 10.0, 40.0])
def test_a_raise_makes_no_conformance_more_probable(
    k: float, dof: float, smallest: float, high: float
) -> None:
    """u = 1 stays or grows, and so do the tails; U = k·u still."""
    result = sample_result()
    offset = replace(result.zero_offset["x"], B=0.0, uncertainty=Uncertainty(1.0, k, k, dof, "gum"))
    found = replace(result, zero_offset={"x": offset})
    raised = reported(found, BestCapability(B_dps=smallest)).result
    stated = raised.zero_offset["x"].uncertainty
    assert stated.expanded == smallest
    assert stated.standard == max(1.0, smallest / 2.0)
    assert stated.coverage_factor * stated.standard == pytest.approx(smallest)
    limits = [Limit("B_x", None, high, "deg/s")]
    before, after = (assess(one, limits, DecisionRule()) for one in (found, raised))
    assert before is not None
    assert after is not None
    assert after.statements[0].conformance <= before.statements[0].conformance


def test_a_u_from_the_trials_widens_what_a_conformance_is_taken_from() -> None:
    """A value whose limit is U away conforms with 97.5 %, whichever way that U came about."""
    result = sample_result()
    for stated in (
        Uncertainty(1.0, 3.0, 3.0, math.inf, "gum", from_monte_carlo=True),
        Uncertainty(1.0, 1.959964, 1.959964, math.inf, "gum"),
    ):
        offset = replace(result.zero_offset["x"], B=0.0, uncertainty=stated)
        limits = [Limit("B_x", None, stated.expanded, "deg/s")]
        found = assess(replace(result, zero_offset={"x": offset}), limits, DecisionRule())
        assert found is not None
        assert found.statements[0].conformance == pytest.approx(0.975, abs=1e-6)


def test_without_a_capability_the_result_is_reported_as_it_is() -> None:
    result = sample_result()
    assert reported(result, BestCapability()).result is result


@pytest.mark.parametrize("wrong", [-1.0, math.nan, math.inf])
def test_a_capability_that_is_no_number_is_refused(wrong: float) -> None:
    with pytest.raises(InputError, match="not negative"):
        BestCapability(B_dps=wrong)


@given(st.floats(0.0, 1e-2), st.floats(0.0, 1e-2), st.floats(0.0, 1e-2))
def test_no_reported_u_is_below_the_capability(k: float, b: float, m: float) -> None:
    found = reported(sample_result(), BestCapability(k, b, m)).result
    assert all(one.uncertainty.expanded >= k * abs(one.K) for one in found.scale_factor.values())
    assert all(one.uncertainty.expanded >= b for one in found.zero_offset.values())
    assert all(one.uncertainty.expanded >= m for one in found.misalignment.values())


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_a_capability_survives_its_json(k: float, b: float, m: float) -> None:
    stated = BestCapability(k, b, m)
    assert capability_from_json(capability_to_json(stated)) == stated


@pytest.mark.parametrize("text", ["x", "[]", '{"B_dps": -1}', '{"B_dps": NaN}', '{"B_dps": "1"}'])
def test_a_capability_that_was_not_written_here_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        capability_from_json(text)
