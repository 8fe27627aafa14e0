"""From a measured job to its signed certificate.

The certificate of a revision is laid out once, when the operator signs: from then on the file only grows by
signatures. Each person's key stands in ``home/authority``, locked by the person's own password; it is made at
the person's first signature.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.laboratory.evaluation import OutputFolder
from ahrs_lab.laboratory.job_sheets import job_sheet
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.records.rows import PersonRow, SignedIn, SigningRole

if TYPE_CHECKING:
    from ahrs_lab.certificates.authority import Authority, SigningIdentity
    from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet, Person
    from ahrs_lab.certificates.verify import VerificationReport
    from ahrs_lab.laboratory.laboratory import Laboratory


def authority(home: Path) -> Authority:
    """The laboratory's demonstration authority; made with the first key it issues."""
    from ahrs_lab.certificates.authority import Authority

    return Authority(home / "authority")


def make_key(home: Path, person: PersonRow, password: str) -> None:
    """A signing key for ``person`` with a certificate of the laboratory's authority."""
    authority(home).issue(_key_name(person), person.name_en or person.name, password)


def _key_name(person: PersonRow) -> str:
    return f"person-{person.id}"


def _measured(laboratory: Laboratory, number: str) -> AnyResult:
    result = laboratory.result(number)
    if result is None:
        raise InputError("Job {number} has no result yet: run the calibration first.", number=number)
    return result


def _sheet(laboratory: Laboratory, number: str, result: AnyResult, issued: date | None) -> JobSheet:
    accepted = result.notes.get("accepted_violations", ())
    return job_sheet(
        laboratory.job(number),
        laboratory.profile(),
        result,
        issued=issued,
        accepted_violations=tuple(str(text) for text in accepted) if isinstance(accepted, list) else (),
    )


def draft(
    laboratory: Laboratory, number: str, language: CertificateLanguage, *, budget_annex: bool = False
) -> Path:
    """The unsigned certificate in the job's folder, for looking at."""
    from ahrs_lab.certificates.certificate import certificate_pdf

    result = _measured(laboratory, number)
    target = laboratory.folder(number) / f"preview-{language}.pdf"
    with OutputFolder(target.parent):
        sheet = replace(_sheet(laboratory, number, result, issued=None), budget_annex=budget_annex)
        certificate_pdf(result, sheet, target, language)
    return target


def original_record(laboratory: Laboratory, number: str) -> Path:
    """The original record in the job's folder."""
    from ahrs_lab.certificates.original_record import original_record_pdf

    result = _measured(laboratory, number)
    target = laboratory.folder(number) / "original-record.pdf"
    with OutputFolder(target.parent):
        original_record_pdf(result, target, _sheet(laboratory, number, result, issued=None))
    return target


def _file(laboratory: Laboratory, number: str) -> Path:
    job = laboratory.job(number)
    return Path(job.folder) / f"{job.certificate_number}.pdf"


def signed_file(laboratory: Laboratory, number: str) -> Path | None:
    """The certificate of the current revision, once it has a signature."""
    return _file(laboratory, number) if laboratory.signatures(number) else None


def sign(
    laboratory: Laboratory,
    number: str,
    role: SigningRole,
    actor: SignedIn,
    password: str,
    language: CertificateLanguage,
    *,
    budget_annex: bool = False,
) -> Path:
    """Sign as ``role`` with the actor's own key; the records decide who may, in which order. ``language`` and
    ``budget_annex`` are the first signature's to choose: it fixes the content.

    The file on disk has to be the one that the last signature left: its digest is compared before another is
    added.
    """
    from ahrs_lab.certificates.certificate import certificate_pdf
    from ahrs_lab.certificates.signing import sign_certificate

    jobs = laboratory.records.jobs
    jobs.may_sign(number, role, actor)
    target = _file(laboratory, number)
    done = jobs.signatures(number)
    with OutputFolder(target.parent):
        if done:
            _unchanged(target, done[-1].sha256)
        else:
            result = _measured(laboratory, number)
            today = date.today()  # noqa: DTZ011  the date on a certificate is the laboratory's own
            content = replace(_sheet(laboratory, number, result, issued=today), budget_annex=budget_annex)
            certificate_pdf(result, content, target, language)
        sheet = _sheet(laboratory, number, _measured(laboratory, number), issued=None)
        identity = _identity(laboratory, actor, password)
        person: Person = getattr(sheet, role)
        before = target.read_bytes()
        sign_certificate(target, role, identity, person)
        digest = hashlib.sha256(target.read_bytes()).hexdigest()
        try:
            jobs.add_signature(number, role, actor, str(target), digest)
        except BaseException:
            target.write_bytes(before)  # a signature that the records do not know is none
            raise
    return target


def _identity(laboratory: Laboratory, actor: SignedIn, password: str) -> SigningIdentity:
    """The actor's own key. Raises PermissionDeniedError for a wrong password."""
    keys, person = authority(laboratory.home), actor.person
    if not keys.has(_key_name(person)):
        people = laboratory.records.people
        people.sign_out(people.sign_in(person.name, password))
        make_key(laboratory.home, person, password)
    return keys.unlock(_key_name(person), password)


def _unchanged(file: Path, digest: str) -> None:
    if not file.is_file():
        raise MachineError("The certificate {path} is not where it was signed: restore it first.", path=file)
    if hashlib.sha256(file.read_bytes()).hexdigest() != digest:
        raise InputError(
            "{path} is not the file that was signed before: it changed outside this program. Restore it, or "
            "send the "
            "job back for a new certificate.",
            path=file,
        )


def verify(home: Path, file: Path, extra_roots: Sequence[Path]) -> VerificationReport:
    """Verify ``file`` against the laboratory's authority (where there is one) and ``extra_roots``."""
    from ahrs_lab.certificates.verify import verify_pdf

    own = home / "authority" / "root.pem"
    roots = [own] if own.is_file() else []
    return verify_pdf(file, [*roots, *extra_roots])
