"""A conformity as JSON, for those who script against ``evaluate`` and ``certificate``."""

from __future__ import annotations

import math
from typing import Any

from ahrs_lab.metrology.conformity import Conformity, Statement


def conformity_to_json(conformity: Conformity) -> dict[str, Any]:
    """Verdicts and their probabilities by quantity, full precision, each in its limit's unit."""
    rule = conformity.rule
    return {
        "rule": {"kind": rule.kind, "r": rule.r, "name": rule.name().text()},
        "verdict": conformity.verdict,
        "within": conformity.within,
        "missing": list(conformity.missing),
        "statements": {one.key: _statement(one) for one in conformity.statements},
    }


def _statement(one: Statement) -> dict[str, Any]:
    return {
        "verdict": one.verdict,
        "unit": one.limit.unit,
        "nominal": one.limit.nominal,
        "low": one.limit.low,
        "high": one.limit.high,
        "acceptance_low": one.acceptance[0],
        "acceptance_high": one.acceptance[1],
        "value": one.value,
        "standard_uncertainty": one.standard,
        "expanded_uncertainty": one.expanded,
        "dof": one.dof if math.isfinite(one.dof) else None,
        "conformance_probability": one.conformance,
        "false_accept_risk": one.false_accept,
        "false_reject_risk": one.false_reject,
    }
