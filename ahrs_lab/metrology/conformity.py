"""Statements of conformity: does a value lie within its limit, by which rule, and how likely is that wrong.

Decision rules as in ILAC-G8:09/2019; conformance probability and specific risks as in JCGM 106:2012, 7 and 8,
from what was measured alone: the quantity is distributed about its value as u and the degrees of freedom say,
normally or by Student's t. Judged is the value before it is rounded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import scipy

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.limits import QUANTITY_KEYS, Limit, Measured, limit_of, measured, steady
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.uncertainty.budget import scale_of

RuleKind = Literal["simple", "guard-band", "non-binary"]
RULES: tuple[RuleKind, ...] = ("simple", "guard-band", "non-binary")
Verdict = Literal["pass", "conditional pass", "conditional fail", "fail"]
VERDICTS: tuple[Verdict, ...] = ("pass", "conditional pass", "conditional fail", "fail")
"""The best first."""
WIDEST_GUARD = 10.0
"""Largest r: beyond it somebody mistyped."""

VERDICT_NAMES: dict[Verdict, Message] = {
    "pass": Message("pass"),
    "conditional pass": Message("conditional pass"),
    "conditional fail": Message("conditional fail"),
    "fail": Message("fail"),
}


@dataclass(frozen=True)
class DecisionRule:
    """``simple``: the limit itself decides; ``guard-band``: the limit less w = r·U, all else fails;
    ``non-binary``: the guard band either side of the limit is a conditional pass or fail.

    ``probability``: the conformance probability is stated with the verdict. Raises InputError for an r that
    is none.
    """

    kind: RuleKind = "simple"
    r: float = 1.0
    probability: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.r) and 0.0 < self.r <= WIDEST_GUARD):
            raise InputError(
                "The guard band is w = r·U with r above 0 and up to {limit}, not {found}.",
                limit=WIDEST_GUARD,
                found=self.r,
            )

    def guard_band(self, expanded: float) -> float:
        """w, in the unit of ``expanded``."""
        return 0.0 if self.kind == "simple" else self.r * expanded

    def name(self) -> Message:
        """As it is named beside a verdict."""
        if self.kind == "simple":
            return Message("simple acceptance (ILAC-G8)")
        width = "w = U" if self.r == 1.0 else f"w = {self.r:g} U"
        if self.kind == "guard-band":
            return Message("guard band {width} (ILAC-G8)", width=width)
        return Message("non-binary with guard band {width} (ILAC-G8)", width=width)


@dataclass(frozen=True)
class Statement:
    """One quantity against its limit; all numbers in the limit's unit.

    ``acceptance`` are the acceptance limits (None: unbounded). ``conformance`` is the probability that the
    quantity lies within the limit (JCGM 106, 7). ``false_accept`` is the specific consumer's risk of what is
    accepted, ``false_reject`` the specific producer's risk of what is rejected (JCGM 106, 9.3); the other is
    None. ``largest_false_accept`` is the former for a value at the worse acceptance limit: what the rule lets
    pass at most.
    """

    key: str
    limit: Limit
    rule: DecisionRule
    verdict: Verdict
    value: float
    expanded: float
    standard: float
    dof: float
    acceptance: tuple[float | None, float | None]
    conformance: float
    false_accept: float | None
    false_reject: float | None
    largest_false_accept: float


@dataclass(frozen=True)
class Conformity:
    """All statements of one result in annex C's order; ``missing`` have a limit but were not measured."""

    rule: DecisionRule
    statements: tuple[Statement, ...]
    missing: tuple[str, ...] = ()

    @property
    def verdict(self) -> Verdict:
        """The worst of all."""
        return max((one.verdict for one in self.statements), key=VERDICTS.index, default="fail")

    @property
    def within(self) -> bool:
        """Everything that has a limit was measured and is accepted, if only conditionally."""
        return not self.missing and self.verdict in ("pass", "conditional pass")

    def of(self, key: str) -> Statement | None:
        """The statement on one quantity."""
        return next((one for one in self.statements if one.key == key), None)


def assess(result: CalibrationResult, limits: Sequence[Limit], rule: DecisionRule) -> Conformity | None:
    """Every quantity that has a limit, judged; None where there are no limits.

    Raises InputError as :func:`judge` does.
    """
    if not limits:
        return None
    found = {one.key: one for one in measured(result)}
    statements, missing = [], []
    for key in QUANTITY_KEYS:
        limit = limit_of(key, limits)
        if limit is None:
            continue
        if key in found:
            statements.append(judge(found[key], limit, rule))
        else:
            missing.append(key)
    return Conformity(rule, tuple(statements), tuple(missing))


def judge(quantity: Measured, limit: Limit, rule: DecisionRule) -> Statement:
    """One quantity against its limit.

    Raises InputError where its uncertainty is no positive number, where limit and result have different
    units, and where the guard band leaves nothing between the limits.
    """
    uncertainty = quantity.uncertainty
    value = limit.value(quantity)
    expanded = limit.size(uncertainty.expanded)
    standard = limit.size(scale_of(uncertainty))
    if not (math.isfinite(value) and all(0.0 < u < math.inf for u in (expanded, standard))):
        raise InputError(
            "The limit of {quantity} cannot be judged: its value has no uncertainty or is no number.",
            quantity=quantity.key,
        )
    acceptance = _acceptance(quantity.key, limit, rule.guard_band(expanded))
    verdict = _verdict(value, limit, rule, acceptance, rule.guard_band(expanded))
    dof = uncertainty.dof
    outside = _outside(value, standard, dof, limit)
    accepted = verdict in ("pass", "conditional pass")
    return Statement(
        key=quantity.key,
        limit=limit,
        rule=rule,
        verdict=verdict,
        value=value,
        expanded=expanded,
        standard=standard,
        dof=dof,
        acceptance=acceptance,
        conformance=1.0 - outside,
        false_accept=outside if accepted else None,
        false_reject=None if accepted else 1.0 - outside,
        largest_false_accept=max(
            _outside(end, standard, dof, limit) for end in acceptance if end is not None
        ),
    )


def conformance_probability(
    value: float, standard: float, dof: float, low: float | None, high: float | None
) -> float:
    """Probability that a quantity known as ``value`` with ``standard`` > 0 lies from ``low`` to ``high``.

    JCGM 106, 7.2 to 7.4, with Student's t of ``dof`` in place of the normal distribution where ``dof`` is
    finite.
    """
    return 1.0 - _beyond(value, standard, dof, low, high)


def _beyond(value: float, standard: float, dof: float, low: float | None, high: float | None) -> float:
    """Both tails; a small risk keeps its digits, which 1 − (1 − risk) would lose."""
    below = 0.0 if low is None else float(scipy.special.stdtr(dof, (low - value) / standard))
    above = 0.0 if high is None else float(scipy.special.stdtr(dof, (value - high) / standard))
    return min(below + above, 1.0)


def _outside(value: float, standard: float, dof: float, limit: Limit) -> float:
    return _beyond(value, standard, dof, limit.low, limit.high)


def _moved(limit: Limit, inwards: float) -> tuple[float | None, float | None]:
    """The limits, each ``inwards`` of itself; with twelve digits, as the value that is compared with them."""
    low = None if limit.low is None else steady(limit.low + inwards, max(abs(limit.low), abs(inwards)))
    high = None if limit.high is None else steady(limit.high - inwards, max(abs(limit.high), abs(inwards)))
    return low, high


def _acceptance(key: str, limit: Limit, guard: float) -> tuple[float | None, float | None]:
    low, high = _moved(limit, guard)
    if low is not None and high is not None and low >= high:
        raise InputError(
            "The guard band of {quantity}, {guard} {unit} on each side, leaves nothing of its limits from "
            "{low} to {high}: no value can pass. Agree on wider limits or another rule, or measure with a "
            "smaller uncertainty.",
            quantity=key,
            guard=float(f"{guard:.2g}"),
            unit=limit.unit,
            low=limit.low,
            high=limit.high,
        )
    return low, high


def _verdict(
    value: float,
    limit: Limit,
    rule: DecisionRule,
    acceptance: tuple[float | None, float | None],
    guard: float,
) -> Verdict:
    """A value on a limit is inside it: it is compared with no more digits than the limits have."""
    value = steady(value, max(abs(one) for one in (limit.low, limit.high, guard) if one is not None))
    if _inside(value, *acceptance):
        return "pass"
    if rule.kind != "non-binary":
        return "fail"
    if _inside(value, *_moved(limit, 0.0)):
        return "conditional pass"
    return "conditional fail" if _inside(value, *_moved(limit, -guard)) else "fail"


def _inside(value: float, low: float | None, high: float | None) -> bool:
    return (low is None or value >= low) and (high is None or value <= high)
