"""A result as it is reported and judged: U not below the laboratory's capability, values against limits.

Certificate, screen and command line all come here, so they say the same.
"""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import BestCapability, reported
from ahrs_lab.metrology.conformity import Conformity, assess
from ahrs_lab.metrology.requirements import Requirements
from ahrs_lab.metrology.result import CalibrationResult


@dataclass(frozen=True)
class Judged:
    """``shown``: the result as reported, ``computed``: before U was raised, ``raised``: whose U that was
    ("K_x"); ``conformity``: None without limits, or where ``refusal`` says why nothing can be stated."""

    computed: CalibrationResult
    requirements: Requirements
    shown: CalibrationResult
    raised: tuple[str, ...]
    conformity: Conformity | None
    refusal: Message | None = None


def judge_result(result: CalibrationResult, requirements: Requirements, capability: BestCapability) -> Judged:
    """Raises InputError where a limit cannot be judged."""
    shown = reported(result, capability)
    conformity = assess(shown.result, requirements.limits, requirements.rule)
    return Judged(result, requirements, shown.result, shown.raised, conformity)


def judge_for_screen(
    result: CalibrationResult, requirements: Requirements, capability: BestCapability
) -> Judged:
    """The same, with a refusal to be shown in place of the verdict."""
    try:
        return judge_result(result, requirements, capability)
    except InputError as error:
        shown = reported(result, capability)
        return Judged(result, requirements, shown.result, shown.raised, None, error.message)
