"""A job's run: may it start, on which bench, and what the records say of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.laboratory import job_sheets
from ahrs_lab.laboratory.header import recording_header
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.metrology.declared_place import place_from_json, place_note
from ahrs_lab.procedures.events import Event
from ahrs_lab.procedures.plan import check_plan
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription
from ahrs_lab.records.jobs import STATE_NAMES
from ahrs_lab.records.rows import JobRow, PersonRow, SignedIn

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory


def make_run(
    laboratory: Laboratory,
    number: str,
    actor: SignedIn,
    *,
    on_event: Callable[[Event], None],
    on_samples: Callable[[Samples], None],
    speed: float | None,
    ask: bool,
    violations_reason: str,
    second_person: SignedIn | None,
) -> LiveRun:
    """The run of job ``number``, not started yet; the job is ``running`` from here.

    The figures of the job's standards and the declared place go into the recording. A bench that violates
    clause 6 needs ``violations_reason`` from a ``second_person``. Raises InputError or PermissionDeniedError;
    nothing has moved then.
    """
    records = laboratory.records
    job, person = _permitted(laboratory, number, actor)
    capability = job_sheets.capability(job)
    accepted = _accepted(laboratory, job, actor, violations_reason, second_person)
    plan = laboratory.plan(number)
    bench = laboratory.bench(number, speed)
    check_plan(plan, bench.table.limits)
    header = recording_header(
        bench,
        plan,
        device=_device(job, bench.ahrs.description),
        capability=capability,
        job=number,
        operator=person.name,
        accepted_violations=accepted,
        **place_note(place_from_json(laboratory.profile().place_json)),
    )
    run = LiveRun(
        bench,
        plan,
        laboratory.bundle(number),
        header,
        on_event=on_event,
        on_samples=on_samples,
        ask=ask,
    )
    if job.state == "draft":
        records.jobs.move(number, "ready", actor)
    if job.state != "running":
        reason = "recorded again" if job.state == "measured" else ""
        records.jobs.move(number, "running", actor, reason)
    records.jobs.add_run_event(number, "started", "; ".join(accepted))
    return run


def take_up(laboratory: Laboratory, number: str, actor: SignedIn, reason: str) -> None:
    """The job's run that ended goes on, or records a part again for ``reason``: the job is ``running`` again.

    Raises InputError or PermissionDeniedError; nothing has moved then.
    """
    job, _ = _permitted(laboratory, number, actor)
    if job.state != "running":
        laboratory.records.jobs.move(number, "running", actor, reason)
    laboratory.records.jobs.add_run_event(number, "continued", reason)


def _permitted(laboratory: Laboratory, number: str, actor: SignedIn) -> tuple[JobRow, PersonRow]:
    """The job and its operator, where that is who acts and the job may still be recorded into."""
    person = laboratory.records.people.require(actor, "operator")
    job = laboratory.job(number)
    if job.operator is None or job.operator.id != person.id:
        raise PermissionDeniedError(
            "Job {number} is not assigned to {name}.", number=number, name=person.name
        )
    if job.state not in ("draft", "ready", "running", "measured"):
        raise InputError(
            "Job {number} is {state}: it is not measured again.",
            number=number,
            state=STATE_NAMES[job.state],
        )
    return job, person


def _accepted(
    laboratory: Laboratory, job: JobRow, actor: SignedIn, reason: str, second: SignedIn | None
) -> list[str]:
    """Clause 6's violations as sentences with who accepted them; raises where nobody did."""
    found = laboratory.clause6(job.number)
    if not found:
        return []
    if not reason.strip() or second is None:
        raise InputError(
            "The bench violates clause 6: {violations} A second person has to give a reason before the job "
            "starts.",
            violations=" ".join(message.text() for message in found),
        )
    witness = laboratory.records.people.require(second, "verifier", "approver")
    if witness.id == actor.person.id:
        raise PermissionDeniedError("The reason has to come from a second person.")
    return [f"{message.text()} – {reason.strip()} ({witness.name})" for message in found]


def _device(job: JobRow, stream: DeviceDescription) -> DeviceDescription:
    """The device as the job names it, with units and rate as its stream has them."""
    return DeviceDescription(
        name=job.device.name or stream.name,
        manufacturer=job.device.manufacturer,
        model=job.device.model,
        serial_number=job.device.serial_number,
        rate_unit=stream.rate_unit,
        accel_unit=stream.accel_unit,
        sample_rate_hz=stream.sample_rate_hz,
    )
