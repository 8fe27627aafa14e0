"""What documents say of JJF 1536 clause 6: the place as the laboratory declares it, and whether the
conditions were met."""

from __future__ import annotations

from collections.abc import Iterator

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Field, Label, Words, label
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import clause6_violations
from ahrs_lab.metrology.declared_place import DeclaredPlace, noted_place
from ahrs_lab.metrology.result import Reported


def violations_of(result: Reported, job: JobSheet) -> tuple[Message, ...]:
    """What violates clause 6 and was not accepted (that stands with its reason); the room as measured."""
    found = clause6_violations(
        job.standards,
        on_date=job.calibrated,
        environment=result.environment,
        capability=job.capability,
        place=place_of(result, job),
    )
    return tuple(
        message
        for message in found
        if not any(
            text.startswith((message.text("en"), message.text("zh"))) for text in job.accepted_violations
        )
    )


def place_of(result: Reported, job: JobSheet | None) -> DeclaredPlace:
    """As it was declared when the run began; the job sheet's where the recording says nothing."""
    noted = noted_place(result.notes)
    if noted is not None:
        return noted
    return job.declared_place if job is not None else DeclaredPlace()


def place_field(result: Reported, job: JobSheet | None, language: CertificateLanguage) -> Field:
    """Earth resistance and foundation, one line."""
    return Field(label(wording.DECLARED_PLACE, language), _place_text(place_of(result, job), language))


def clause_6_fields(result: Reported, job: JobSheet, language: CertificateLanguage) -> Iterator[Field]:
    """The place, and the sentence whether clause 6 was met."""
    yield place_field(result, job, language)
    yield Field(label(wording.CLAUSE_6, language), label(_verdict(result, job), language))


def _place_text(place: DeclaredPlace, language: CertificateLanguage) -> Label:
    if place == DeclaredPlace():
        return label(wording.NOT_DECLARED, language)
    ohm, isolated = place.earth_resistance_ohm, place.isolated_foundation
    earth = (
        wording.EARTH_NOT_DECLARED if ohm is None else wording.EARTH_RESISTANCE.filled(value=f"{ohm:.12g}")
    )
    foundation = {
        True: wording.ISOLATED,
        False: wording.NOT_ISOLATED,
        None: wording.FOUNDATION_NOT_DECLARED,
    }[isolated]
    return label(Words(f"{earth.zh}；{foundation.zh}", f"{earth.en}; {foundation.en}"), language)


def _verdict(result: Reported, job: JobSheet) -> Words:
    if job.accepted_violations or violations_of(result, job):
        return wording.CLAUSE_6_VIOLATED
    known = result.environment is not None and place_of(result, job).complete
    return wording.CLAUSE_6_MET if known else wording.CLAUSE_6_AS_KNOWN
