"""Decision rules, conformance probability and specific risk, against published figures and scipy."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.conformity import (
    VERDICTS,
    DecisionRule,
    RuleKind,
    assess,
    conformance_probability,
    judge,
)
from ahrs_lab.metrology.limits import Limit, Measured, limit_of
from ahrs_lab.metrology.result import AxisName, CalibrationResult, Uncertainty, ZeroOffsetResult

SIMPLE, GUARD, NON_BINARY = DecisionRule(), DecisionRule("guard-band"), DecisionRule("non-binary")


def offset(value: float, expanded: float = 2.0, k: float = 2.0, dof: float = math.inf) -> Measured:
    return Measured("B_x", value, "deg/s", Uncertainty(expanded / k, expanded, k, dof, "gum"))


# JCGM 106:2012, examples of 7.3 and 7.4; probabilities as printed


@pytest.mark.parametrize(
    ("value", "u", "low", "high", "printed", "digits"),
    [
        (-5.47, 0.05, None, -5.40, 0.92, 2),  # breakdown voltage of a Zener diode
        (509.7, 8.6, 490.0, None, 0.99, 2),  # burst strength of a container
        (13.6, 1.8, 12.5, 16.3, 0.66, 2),  # viscosity of SAE 40 motor oil
    ],
)
def test_the_conformance_probabilities_of_jcgm_106(
    value: float, u: float, low: float | None, high: float | None, printed: float, digits: int
) -> None:
    assert round(conformance_probability(value, u, math.inf, low, high), digits) == printed


@pytest.mark.parametrize(("z", "p"), [(0.84, 0.80), (1.28, 0.90), (1.64, 0.95), (2.33, 0.99), (3.09, 0.999)])
def test_table_1_of_jcgm_106(z: float, p: float) -> None:
    assert conformance_probability(-z, 1.0, math.inf, None, 0.0) == pytest.approx(p, abs=6e-4)


@pytest.mark.parametrize(
    ("rule", "below"),
    [
        (SIMPLE, 0.5 + 1e-12),
        (DecisionRule("guard-band", 0.83), 0.05),  # ISO 14253-1
        (GUARD, 0.025),
        (DecisionRule("guard-band", 1.5), 0.0016),
        (DecisionRule("guard-band", 3.0), 1e-6),
    ],
)
def test_the_risks_at_the_acceptance_limit_of_ilac_g8(rule: DecisionRule, below: float) -> None:
    said = judge(offset(0.0), Limit("B", None, 100.0, "deg/s"), rule)
    assert said.largest_false_accept < below
    assert said.largest_false_accept == pytest.approx(stats.norm.sf(2.0 * (0 if rule is SIMPLE else rule.r)))


@pytest.mark.parametrize("dof", [3.0, 11.0, 60.0])
def test_a_guard_band_of_u_lets_2_5_percent_pass_whatever_the_degrees_of_freedom(dof: float) -> None:
    k = float(stats.t.ppf(0.975, dof))
    said = judge(offset(0.0, k, k, dof), Limit("B", None, 100.0, "deg/s"), GUARD)
    assert said.largest_false_accept == pytest.approx(0.025, rel=1e-9)


LIMIT = Limit("B", -10.0, 10.0, "deg/s")


@pytest.mark.parametrize(
    ("value", "simple", "guard", "non_binary"),
    [
        (0.0, "pass", "pass", "pass"),
        (8.0, "pass", "pass", "pass"),  # on the acceptance limit
        (8.5, "pass", "fail", "conditional pass"),
        (-10.0, "pass", "fail", "conditional pass"),  # on the limit
        (10.5, "fail", "fail", "conditional fail"),
        (-12.0, "fail", "fail", "conditional fail"),
        (12.5, "fail", "fail", "fail"),
    ],
)
def test_the_zones_of_ilac_g8(value: float, simple: str, guard: str, non_binary: str) -> None:
    rules = (SIMPLE, GUARD, NON_BINARY)
    assert [judge(offset(value), LIMIT, rule).verdict for rule in rules] == [simple, guard, non_binary]


def test_acceptance_limits_and_risks_of_a_statement() -> None:
    said = judge(offset(8.5), LIMIT, DecisionRule("guard-band", 0.5))
    assert said.acceptance == (-9.0, 9.0)
    assert said.conformance == pytest.approx(stats.norm.cdf(1.5) - stats.norm.cdf(-18.5))
    assert said.false_accept == pytest.approx(stats.norm.sf(1.5))
    assert said.false_reject is None
    rejected = judge(offset(9.5), LIMIT, GUARD)
    assert rejected.verdict == "fail"
    assert rejected.false_accept is None
    assert rejected.false_reject == pytest.approx(stats.norm.cdf(0.5))


def test_a_risk_too_small_for_one_minus_it_keeps_its_digits() -> None:
    said = judge(offset(-10.0), Limit("B", None, 10.0, "deg/s"), SIMPLE)
    assert said.false_accept == pytest.approx(stats.norm.sf(20.0), rel=1e-9)


def test_a_limit_on_one_side_is_open_on_the_other() -> None:
    lower = Limit("B", 5.0, None, "deg/s")
    assert judge(offset(1e6), lower, GUARD).verdict == "pass"
    assert judge(offset(1e6), lower, GUARD).acceptance == (7.0, None)
    assert judge(offset(6.0), lower, GUARD).verdict == "fail"


def test_a_value_is_brought_into_the_unit_of_its_limit() -> None:
    per_hour = Limit("B_x", -20.0, 20.0, "deg/h")
    said = judge(offset(20.0 / 3600.0, 0.35 / 3600.0), per_hour, SIMPLE)
    assert (said.value, said.expanded, said.verdict) == (20.0, 0.35, "pass")
    k = Measured("K_x", 131.0 * 1.002, "LSB/(deg/s)", Uncertainty(0.0131, 0.0262, 2.0, math.inf, "gum"))
    relative = judge(k, Limit("K", -3000.0, 3000.0, "ppm", nominal=131.0), GUARD)
    assert relative.value == pytest.approx(2000.0)
    assert relative.expanded == pytest.approx(200.0)
    assert relative.acceptance[1] == pytest.approx(2800.0)
    angle = Measured("L_yx", math.radians(1.0 / 60.0), "rad", Uncertainty(1e-6, 2e-6, 2.0, math.inf, "gum"))
    assert judge(angle, Limit("L", -2.0, 2.0, "arcmin"), SIMPLE).value == 1.0


def test_a_negative_nominal_keeps_the_uncertainty_positive() -> None:
    k = Measured("K_z", -131.0, "LSB/(deg/s)", Uncertainty(0.01, 0.02, 2.0, math.inf, "gum"))
    said = judge(k, Limit("K", -300.0, 200.0, "ppm", nominal=-131.01), GUARD)
    assert said.expanded > 0.0
    assert said.value == pytest.approx(-76.3, abs=0.1)


# what cannot be judged is refused


@pytest.mark.parametrize(
    ("limit", "says"),
    [
        (("B", 2.0, 1.0, "deg/s", None), "the lower bound has to be the smaller"),
        (("B", 1.0, 1.0, "deg/s", None), "the lower bound has to be the smaller"),
        (("B", None, None, "deg/s", None), "neither a lower nor an upper bound"),
        (("B", math.nan, 1.0, "deg/s", None), "finite numbers"),
        (("B", None, math.inf, "deg/s", None), "finite numbers"),
        (("B_q", None, 1.0, "deg/s", None), "not of “B_q”"),
        (("B", None, 1.0, "rad", None), "not in “rad”"),
        (("K", None, 1.0, "ppm", None), "enter the nominal value"),
        (("K", None, 1.0, "ppm", 0.0), "enter the nominal value"),
        (("K", None, 1.0, "1", 1.0), "takes no nominal value"),
        (("B", None, 1.0, "ppm", 1.0), "not in “ppm”"),
    ],
)
def test_what_is_no_limit_is_refused(
    limit: tuple[str, float | None, float | None, str, float | None], says: str
) -> None:
    with pytest.raises(InputError, match=says):
        Limit(*limit)


@pytest.mark.parametrize("r", [0.0, -1.0, math.nan, math.inf, 11.0])
def test_what_is_no_guard_band_is_refused(r: float) -> None:
    with pytest.raises(InputError, match="w = r·U"):
        DecisionRule("guard-band", r)


@pytest.mark.parametrize("expanded", [0.0, -1.0, math.nan, math.inf])
def test_without_an_uncertainty_nothing_is_stated(expanded: float) -> None:
    with pytest.raises(InputError, match="no uncertainty"):
        judge(offset(1.0, expanded), LIMIT, SIMPLE)
    with pytest.raises(InputError, match="no uncertainty"):
        judge(offset(math.nan), LIMIT, SIMPLE)


@pytest.mark.parametrize("kind", ["guard-band", "non-binary"])
@pytest.mark.parametrize("expanded", [10.0, 25.0])
def test_a_guard_band_that_eats_the_tolerance_is_refused(kind: RuleKind, expanded: float) -> None:
    with pytest.raises(InputError, match="no value can pass"):
        judge(offset(0.0, expanded), LIMIT, DecisionRule(kind))


def test_a_limit_in_counts_of_a_result_without_counts_is_refused() -> None:
    k = Measured("K_x", 1.0, "(deg/s)/(deg/s)", Uncertainty(1e-5, 2e-5, 2.0, math.inf, "gum"))
    with pytest.raises(InputError, match="correct the limit"):
        judge(k, Limit("K", 130.0, 132.0, "LSB/(deg/s)"), SIMPLE)


# all of a result


def result_of(**values: float) -> CalibrationResult:
    certain = Uncertainty(1.0, 2.0, 2.0, math.inf, "gum")
    axes: tuple[AxisName, ...] = ("x", "y", "z")
    offsets = {
        axis: ZeroOffsetResult(axis, values[axis], "deg/s", 1800.0, (), certain)
        for axis in axes
        if axis in values
    }
    return CalibrationResult("jjf1536-2015", "", "", zero_offset=offsets)


def test_the_worst_verdict_is_that_of_the_whole() -> None:
    found = assess(result_of(x=0.0, y=9.0, z=11.0), (LIMIT,), NON_BINARY)
    assert found is not None
    assert [one.verdict for one in found.statements] == ["pass", "conditional pass", "conditional fail"]
    assert (found.verdict, found.within) == ("conditional fail", False)
    found = assess(result_of(x=0.0, y=9.0), (LIMIT,), NON_BINARY)
    assert found is not None
    assert found.missing == ("B_z",)
    assert not found.within


def test_a_quantity_s_own_limit_goes_before_its_group_s() -> None:
    own = Limit("B_y", -1.0, 1.0, "deg/s")
    assert limit_of("B_y", (LIMIT, own)) is own
    assert limit_of("B_x", (LIMIT, own)) is LIMIT
    assert limit_of("K_x", (LIMIT, own)) is None
    found = assess(result_of(x=5.0, y=5.0, z=5.0), (LIMIT, own), SIMPLE)
    assert found is not None
    assert [one.verdict for one in found.statements] == ["pass", "fail", "pass"]


def test_no_limits_are_no_statement() -> None:
    assert assess(result_of(x=0.0), (), SIMPLE) is None


# properties

finite = st.floats(-1e6, 1e6)
positive = st.floats(1e-3, 1e3)
dofs = st.one_of(st.just(math.inf), st.floats(1.0, 1e6))


@given(finite, positive, dofs, finite, positive)
def test_a_probability_is_scipy_s_whatever_the_numbers(
    value: float, u: float, dof: float, low: float, width: float
) -> None:
    found = conformance_probability(value, u, dof, low, low + width)
    distribution = stats.norm(value, u) if math.isinf(dof) else stats.t(dof, value, u)
    assert found == pytest.approx(distribution.cdf(low + width) - distribution.cdf(low), abs=1e-9)
    assert 0.0 <= found <= 1.0


@given(finite, positive, dofs, finite, positive, st.floats(0.1, 2.0))
def test_a_stricter_rule_never_says_better(
    value: float, expanded: float, dof: float, low: float, width: float, r: float
) -> None:
    limit = Limit("B", low, low + width + 5.0 * expanded, "deg/s")
    quantity = offset(value, expanded, 2.0, dof)
    simple, guard, non_binary = (
        judge(quantity, limit, rule)
        for rule in (SIMPLE, DecisionRule("guard-band", r), DecisionRule("non-binary", r))
    )
    assert VERDICTS.index(simple.verdict) <= VERDICTS.index(guard.verdict)
    assert (guard.verdict == "pass") == (non_binary.verdict == "pass")
    assert (simple.verdict == "pass") == (non_binary.verdict in ("pass", "conditional pass"))
    if guard.verdict == "pass":
        assert guard.false_accept is not None
        assert guard.false_accept <= guard.largest_false_accept + 1e-12
    for said in (simple, guard, non_binary):
        assert (said.false_accept is None) != (said.false_reject is None)


@given(finite, positive, finite)
def test_a_mirrored_quantity_has_the_mirrored_verdict(value: float, expanded: float, edge: float) -> None:
    up = judge(offset(value, expanded), Limit("B", None, edge, "deg/s"), NON_BINARY)
    down = judge(offset(-value, expanded), Limit("B", -edge, None, "deg/s"), NON_BINARY)
    assert up.verdict == down.verdict
    assert up.conformance == pytest.approx(down.conformance)


@pytest.mark.parametrize("rule", [SIMPLE, GUARD, NON_BINARY])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("limit", "expanded"),
    [(0.123456789012345, 0.0123456789012345), (0.3, 0.1), (1.0 / 3.0, 0.1), (2e5 / 3.0, 2e5 / 3.0 - 0.1)],
)
def test_a_value_exactly_on_its_limit_or_acceptance_limit_is_within(
    rule: DecisionRule, sign: float, limit: float, expanded: float
) -> None:
    """Value and limits are compared with equally many digits."""
    bounds = Limit("B", -limit, limit, "deg/s")
    found = judge(offset(sign * (limit - rule.guard_band(expanded)), expanded), bounds, rule)
    assert found.verdict == "pass"
    if rule.kind == "non-binary":
        assert judge(offset(sign * limit, expanded), bounds, rule).verdict == "conditional pass"
        beyond = sign * (limit + rule.guard_band(expanded))
        assert judge(offset(beyond, expanded), bounds, rule).verdict == "conditional fail"


@pytest.mark.parametrize("deviation", [1, 5, 7, 13, 130, 999])
def test_a_small_deviation_from_the_nominal_value_is_not_beyond_its_limit(deviation: int) -> None:
    """1.000005 − 1 is not 5·10⁻⁶ to the last bit."""
    limit = Limit("K", -float(deviation), float(deviation), "ppm", 1.0)
    for sign in (1, -1):
        value = 1.0 + sign * deviation * 1e-6
        measured = Measured("K_x", value, "1", Uncertainty(1e-7, 2e-7, 2.0, math.inf, "gum"))
        assert judge(measured, limit, SIMPLE).verdict == "pass"
