"""Limits, decision rule, units and the laboratory's best capability as ``JOB.toml`` writes them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.conformity import RULES, DecisionRule
from ahrs_lab.metrology.limits import LIMIT_UNITS, LIMITED, Limit
from ahrs_lab.metrology.requirements import (
    MISALIGNMENT_UNITS,
    SCALE_FACTOR_UNITS,
    ZERO_OFFSET_UNITS,
    Requirements,
    ResultUnits,
)

if TYPE_CHECKING:
    from ahrs_lab.certificates.job_sheet_file import _Table

_Made = TypeVar("_Made")


def read_requirements(top: _Table) -> Requirements:
    """``[[limit]]``, ``[decision_rule]``, ``[units]`` and ``[uncertainty]``; raises InputError with the place
    of a fault."""
    limits = tuple(_limit(table) for table in top.tables("limit"))
    rule, units = _rule(top.table("decision_rule", required=False)), _units(top)
    uncertainty = top.table("uncertainty", required=False)
    repeatability = uncertainty.flag("include_repeatability")
    uncertainty.finish()
    return _made(top, lambda: Requirements(limits, rule, units, repeatability))


def read_best_capability(table: _Table) -> BestCapability:
    """``[laboratory.capability]``: K relative, B in °/s, L in rad, each expanded (k = 2)."""
    K, B, L = (table.number(key, 0.0) for key in ("K", "B", "L"))
    table.finish()
    return BestCapability(K, B, L)


def _limit(table: _Table) -> Limit:
    quantity = table.choice("quantity", LIMITED)
    unit = table.choice("unit", tuple(LIMIT_UNITS[quantity[0]]))
    low, high, nominal = table.signed("low"), table.signed("high"), table.signed("nominal")
    table.finish()
    return _made(table, lambda: Limit(quantity, low, high, unit, nominal))


def _rule(table: _Table) -> DecisionRule:
    kind, r = table.choice("kind", RULES, "simple"), table.number("r", 1.0)
    probability = table.flag("probability")
    table.finish()
    return _made(table, lambda: DecisionRule(kind, r, probability))


def _units(top: _Table) -> ResultUnits:
    table = top.table("units", required=False)
    units = ResultUnits(
        table.choice("scale_factor", SCALE_FACTOR_UNITS[1:], ""),
        table.choice("zero_offset", ZERO_OFFSET_UNITS[1:], ""),
        table.choice("misalignment", MISALIGNMENT_UNITS[1:], ""),
    )
    table.finish()
    return units


def _made(table: _Table, make: Callable[[], _Made]) -> _Made:
    try:
        return make()
    except InputError as error:
        raise table.refused(error) from error
