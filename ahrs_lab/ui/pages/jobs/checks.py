"""What stands between a job and its run: entries that are missing, clause 6, the plan. No Qt here."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import date
from typing import Literal

from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.laboratory import job_sheets
from ahrs_lab.messages import Message
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.records.rows import JobDraft, JobRow, LaboratoryRow, PersonRow, StandardRow

Missing = Literal["customer", "device", "operator", "verifier", "approver", "standards", "bench"]


@dataclass(frozen=True)
class Estimate:
    """How long the plan takes on the bench, and how often the case is mounted."""

    seconds: float
    mountings: int


def missing(draft: JobDraft) -> tuple[Missing, ...]:
    """Entries without which no run starts, in the form's order."""
    found: list[Missing] = []
    if not draft.customer.name.strip():
        found.append("customer")
    if not (draft.device.name.strip() or draft.device.model.strip()):
        found.append("device")
    if not draft.standard_ids:
        found.append("standards")
    if not draft.operator_id:
        found.append("operator")
    if not draft.verifier_id:
        found.append("verifier")
    if not draft.approver_id:
        found.append("approver")
    if not draft.bench_toml.strip():
        found.append("bench")
    return tuple(found)


def clause6(
    draft: JobDraft, laboratory: LaboratoryRow, standards: Iterable[StandardRow]
) -> tuple[Message, ...]:
    """Clause 6's violations of a job that may not be saved yet."""
    return job_sheets.violations(preview(draft, standards, ()), laboratory, None)


def preview(draft: JobDraft, standards: Iterable[StandardRow], people: Iterable[PersonRow]) -> JobRow:
    """The job that the draft would become."""
    known = {person.id: person for person in people}
    return JobRow(
        id=0, number="", state="draft", customer=draft.customer, device=draft.device, received=draft.received,
        place=draft.place, place_en=draft.place_en, plan_toml=draft.plan_toml, bench_toml=draft.bench_toml,
        standards=tuple(row for row in standards if row.id in draft.standard_ids),
        operator=known.get(draft.operator_id), verifier=known.get(draft.verifier_id),
        approver=known.get(draft.approver_id), folder="", certificate_number="", revision=0, calibrated=None,
        issued=None,
    )  # fmt: skip


def estimate(plan: Plan, limits: TableLimits) -> Estimate:
    """From the procedure's own steps."""
    from ahrs_lab.procedures import course

    steps = course.steps(plan, limits)
    return Estimate(sum(step.estimate_s for step in steps), sum(1 for step in steps if step.kind == "mount"))


def overdue(standard: StandardRow, today: date) -> bool:
    """Its certificate has run out."""
    return standard.due is not None and standard.due < today
