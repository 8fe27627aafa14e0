"""What the laboratory has to do now: its jobs by who has to act. No Qt here."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from ahrs_lab.records.rows import JobRow, JobState

Column = Literal["measure", "verify", "approve"]
Action = Literal["complete", "start", "watch", "certify", "check", "approve"]

COLUMNS: tuple[Column, ...] = ("measure", "verify", "approve")
_COLUMN_OF: dict[JobState, Column] = {
    "draft": "measure",
    "ready": "measure",
    "running": "measure",
    "measured": "verify",
    "checked": "approve",
}
RECENT = 8


@dataclass(frozen=True)
class Task:
    """A job and its one next action."""

    job: JobRow
    action: Action


@dataclass(frozen=True)
class Agenda:
    """Tasks of each column in the order the jobs came in, and the jobs issued last."""

    tasks: dict[Column, tuple[Task, ...]]
    issued: tuple[JobRow, ...]

    @property
    def empty(self) -> bool:
        """There is no job at all."""
        return not self.issued and not any(self.tasks.values())


def agenda(jobs: Iterable[JobRow], signed: dict[str, int] | None = None) -> Agenda:
    """``signed`` counts the signatures on each job's certificate: after the operator's the verifier acts."""
    signed = signed or {}
    tasks: dict[Column, list[Task]] = {column: [] for column in COLUMNS}
    issued: list[JobRow] = []
    for job in sorted(jobs, key=lambda job: (job.received, job.number)):
        if job.state == "issued":
            issued.append(job)
        else:
            tasks[_COLUMN_OF[job.state]].append(Task(job, next_action(job, signed.get(job.number, 0))))
    newest = sorted(issued, key=lambda job: (job.issued or job.received, job.number), reverse=True)
    return Agenda({column: tuple(found) for column, found in tasks.items()}, tuple(newest[:RECENT]))


def next_action(job: JobRow, signatures: int) -> Action:
    """What the job waits for."""
    if job.state == "running":
        return "watch"
    if job.state == "measured":
        return "check" if signatures else "certify"
    if job.state == "checked":
        return "approve"
    return "start" if is_complete(job) else "complete"


def is_complete(job: JobRow) -> bool:
    """Whether everything stands that a run needs."""
    people = (job.operator, job.verifier, job.approver)
    return bool(job.plan_toml and job.bench_toml and job.standards and all(people))
