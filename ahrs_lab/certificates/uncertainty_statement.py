"""The certificate's statement of uncertainty (clause 8 j)): how U was evaluated, which U hold another
probability than about 95 %, what U of B covers, and for which quantities traceability is shown.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Words
from ahrs_lab.certificates.job_sheet import JobSheet
from ahrs_lab.certificates.result_tables import methods_of
from ahrs_lab.metrology.budgets import QuantityBudget, budgets_of
from ahrs_lab.metrology.conditions import clause6_violations
from ahrs_lab.metrology.result import CalibrationResult, Uncertainty


def uncertainty_statement(
    result: CalibrationResult, shown: CalibrationResult, job: JobSheet, *, demonstration: bool
) -> tuple[Words, ...]:
    """Its paragraphs. ``result`` is as it was computed, ``shown`` as it is reported."""
    statements: list[Words] = []
    methods = methods_of(result)
    if "gum" in methods:
        statements.append(_noted(wording.BY_GUM, 5))
    if "annex-a" in methods:
        statements.append(_noted(wording.BY_ANNEX_A, 6 if "gum" in methods else 5))
    statements += _exceptions(shown)
    if job.rounding == "up":
        statements.append(wording.ROUNDED_UP)
    if result.zero_offset:
        included = all(one.repeatability_included for one in result.zero_offset.values())
        meaning = [wording.MEANING_OF_B_WITH if included else wording.MEANING_OF_B]
        known = [one for one in result.zero_offset.values() if one.repeatability_dps is not None]
        if any(not one.repeatability_cycles for one in known):
            meaning.append(wording.REPEATABILITY_BY_ALLAN)
        meaning += [
            wording.REPEATABILITY_BY_CYCLES.filled(count=count)
            for count in sorted({one.repeatability_cycles for one in known} - {0})
        ]
        statements.append(run_on(meaning))
    return (*statements, *_traceability(result, job, demonstration=demonstration))


def run_on(sentences: Iterable[Words]) -> Words:
    """One paragraph of several."""
    said = tuple(sentences)
    return Words("".join(one.zh for one in said), " ".join(one.en for one in said))


def widened_quantities(result: CalibrationResult) -> tuple[str, ...]:
    """The quantities (``K_x``, ``F0_x``) whose U is taken from the Monte Carlo trials."""
    return tuple(one.name for one in budgets_of(result) if one.uncertainty.from_monte_carlo)


def symbols_of(budgets: Iterable[QuantityBudget]) -> str:
    """The quantities as they stand within a sentence."""
    return ", ".join(
        f"F_{{0{one.index}}}" if one.letter == "F0" else f"{one.letter}_{{{one.index}}}" for one in budgets
    )


def _exceptions(shown: CalibrationResult) -> Iterator[Words]:
    """Which of the reported U clause 8 of JCGM 101 does not validate, and what they hold."""
    found: dict[Words, list[QuantityBudget]] = {}
    for budget in budgets_of(shown):
        check = budget.uncertainty.monte_carlo
        if check is None or check.validated:
            continue
        reach = max(budget.value - check.symmetric[0], check.symmetric[1] - budget.value)
        if budget.uncertainty.from_monte_carlo:
            said = wording.FROM_MONTE_CARLO
        elif reach <= budget.uncertainty.expanded:
            said = wording.LONGER_THAN_MONTE_CARLO
        else:  # a result from before U was raised
            said = wording.NOT_VALIDATED
        found.setdefault(said, []).append(budget)
    for said, budgets in found.items():
        yield said.filled(keys=symbols_of(budgets))


def _traceability(result: CalibrationResult, job: JobSheet, *, demonstration: bool) -> tuple[Words, ...]:
    """Only what the standards used, and the certificates behind the figures, bear out."""
    if demonstration:
        return (wording.DEMONSTRATION_NOT_TRACEABLE,)
    if clause6_violations(job.standards, on_date=job.calibrated):
        return (wording.NOT_TRACEABLE,)
    budgets = [one for one in budgets_of(result) if one.letter != "F0"]
    assumed = [one for one in budgets if _mostly_assumed(one.uncertainty)]
    if assumed and len(assumed) == len(budgets):
        return (wording.ASSUMED_ALL,)
    said = [wording.TRACEABILITY]
    if assumed:
        said.append(wording.ASSUMED_SOME.filled(keys=symbols_of(assumed)))
    bodies = list(dict.fromkeys(one.traceability for one in job.standards if one.traceability))
    paragraphs = [run_on(said)]
    if bodies:
        paragraphs.append(wording.TRACED_BY.filled(bodies=", ".join(bodies)))
    return tuple(paragraphs)


def _mostly_assumed(uncertainty: Uncertainty) -> bool:
    """More than half of the type B variance is from figures that no certificate states."""
    of_type_b = [row for row in uncertainty.rows if row.kind == "B"]
    assumed = math.fsum(row.contribution**2 for row in of_type_b if row.origin == "assumption")
    return assumed > 0.5 * math.fsum(row.contribution**2 for row in of_type_b)


def _noted(words: Words, mark: int) -> Words:
    return Words(f"{words.zh}^{{{mark}}}", f"{words.en}^{{{mark}}}")
