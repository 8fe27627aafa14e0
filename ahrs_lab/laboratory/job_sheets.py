"""From a job in the records to the sheet its certificate is made of, and the bench figures of its budget."""

from __future__ import annotations

from datetime import date
from typing import cast

from ahrs_lab.certificates.job_sheet import DeviceUnderTest, JobSheet, Party, Person
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.benches import is_simulated
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import capability_from_json
from ahrs_lab.metrology.capability import capability_of, figure_conflicts
from ahrs_lab.metrology.conditions import BenchCapability, Standard, StandardKind, clause6_violations
from ahrs_lab.metrology.declared_place import place_from_json
from ahrs_lab.metrology.figures_json import figures_from_text
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.recorded_days import is_recorded_on, recorded_days
from ahrs_lab.metrology.requirements import requirements_from_json
from ahrs_lab.metrology.result import Method, Reported
from ahrs_lab.records.rows import JobRow, LaboratoryRow, PersonRow, StandardRow


def standards_of(job: JobRow) -> tuple[Standard, ...]:
    """The job's standards as metrology knows them."""
    return tuple(_standard(row) for row in job.standards)


def _standard(row: StandardRow) -> Standard:
    return Standard(
        kind=cast("StandardKind", row.kind),
        name=row.name,
        name_zh=row.name_zh,
        manufacturer=row.manufacturer,
        model=row.model,
        serial_number=row.serial_number,
        accuracy=row.accuracy,
        accuracy_zh=row.accuracy_zh,
        certificate_number=row.certificate_number,
        due=row.due,
        traceability=row.traceability,
        figures=figures_from_text(row.figures_json, row.name),
    )


def check_standard(row: StandardRow) -> None:
    """Raises InputError where the figures of a standard cannot be used: they are none, another kind of
    standard states such, or the certificate they stand in is not named."""
    standard = _standard(row)
    for message in figure_conflicts([standard]):
        raise InputError(message)
    if standard.figures and not (standard.certificate_number.strip() and standard.due):
        raise InputError(
            "{name} states figures: enter the number and the due date of the certificate that they stand in.",
            name=row.name,
        )


def capability(job: JobRow) -> BenchCapability:
    """The bench's figures for the job's budgets: as its standards' certificates state them on the day it is
    measured, else clause 6's own as assumptions. Raises InputError where two standards state the same."""
    return capability_of(standards_of(job), job.calibrated or date.today())  # noqa: DTZ011


def violations(job: JobRow, laboratory: LaboratoryRow, result: Reported | None) -> tuple[Message, ...]:
    """What violates clause 6: standards missing or overdue, a bench that is worse, the place as the
    laboratory declares it, which a real bench needs, and, once measured, the room; before them figures that
    cannot be used together."""
    standards = standards_of(job)
    conflicts = figure_conflicts(standards)
    return conflicts + clause6_violations(
        standards,
        on_date=_calibrated(job, result),
        environment=result.environment if result is not None else None,
        capability=None if conflicts else capability(job),
        place=place_from_json(laboratory.place_json),
        place_needed=not is_simulated(job.bench_toml),
    )


def _calibrated(job: JobRow, result: Reported | None) -> date:
    """The job's own day of calibration; the recording's last day where that is another or none is known, as
    for a recording that was made elsewhere."""
    day = job.calibrated or date.today()  # noqa: DTZ011  due dates are the laboratory's own
    days = None if result is None else recorded_days(result.notes)
    if result is None or days is None or is_recorded_on(result.notes, day):
        return day
    return days[1]


def job_sheet(
    job: JobRow,
    laboratory: LaboratoryRow,
    result: AnyResult,
    *,
    issued: date | None,
    accepted_violations: tuple[str, ...] = (),
) -> JobSheet:
    """Everything of the certificate that was not measured; raises InputError where something is missing
    yet."""
    people = {"operator": job.operator, "verifier": job.verifier, "approver": job.approver}
    for role, row in people.items():
        if row is None:
            raise InputError(
                "Job {number} has no {role} yet: choose one in the job.", number=job.number, role=role
            )
    if not laboratory.name:
        raise InputError("The laboratory has no name yet: enter it on the page Set-up.")
    return JobSheet(
        number=job.number,
        certificate_number=job.certificate_number,
        laboratory=Party(laboratory.name, laboratory.address, laboratory.name_en, laboratory.address_en),
        customer=Party(
            job.customer.name, job.customer.address, job.customer.name_en, job.customer.address_en
        ),
        device=DeviceUnderTest(
            job.device.name,
            job.device.manufacturer,
            job.device.model,
            job.device.serial_number,
            job.device.name_en,
        ),
        operator=_person(job.operator),
        verifier=_person(job.verifier),
        approver=_person(job.approver),
        received=job.received,
        calibrated=_calibrated(job, result),
        issued=issued,
        place=job.place,
        place_en=job.place_en,
        standards=standards_of(job),
        capability=capability(job),
        requirements=requirements_from_json(job.limits_json),
        best_capability=capability_from_json(laboratory.capability_json),
        uncertainty_method=_method(result),
        accepted_violations=accepted_violations,
        demonstration=result.simulated,
    )


def _method(result: AnyResult) -> Method:
    if isinstance(result, ImuResult):
        return "gum"
    uncertainties = [
        *(k.uncertainty for k in result.scale_factor.values()),
        *(b.uncertainty for b in result.zero_offset.values()),
        *(m.uncertainty for m in result.misalignment.values()),
    ]
    return uncertainties[0].method if uncertainties else "gum"


def _person(row: PersonRow | None) -> Person:
    return Person(row.name, row.position, row.name_en, row.position_en) if row is not None else Person("")
