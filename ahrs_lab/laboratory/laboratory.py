"""The laboratory: records, benches, runs, results and certificates behind one door for screen and command
line.

It owns a job from order to certificate. What a person may do is decided by the records; what is measured by
the procedures; what is printed by the certificates. Here they meet.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory import certification, job_sheets
from ahrs_lab.laboratory.benches import bench_from_text, bench_presets, plan_from_text, plan_presets
from ahrs_lab.laboratory.evaluation import Evaluate, EvaluationSettings, evaluate_bundle
from ahrs_lab.laboratory.home import home_folder
from ahrs_lab.laboratory.judgement import Judged, judge_for_screen
from ahrs_lab.laboratory.results import AnyResult, from_json_text, to_json
from ahrs_lab.laboratory.settings import Settings
from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import capability_from_json
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.requirements import requirements_from_json
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.recording.samples import Samples
from ahrs_lab.records.rows import (
    JobDraft,
    JobRow,
    LaboratoryRow,
    PersonRow,
    SignatureRow,
    SignedIn,
    SigningRole,
    StandardRow,
)
from ahrs_lab.records.store import Records

if TYPE_CHECKING:
    from ahrs_lab.certificates.job_sheet import CertificateLanguage
    from ahrs_lab.certificates.verify import VerificationReport
    from ahrs_lab.laboratory.live_run import LiveRun
    from ahrs_lab.procedures.events import Event


class Laboratory:
    """One laboratory on one machine, kept in ``home``."""

    def __init__(self, home: Path | None = None) -> None:
        self.home = home_folder(home)
        self.records = Records(self.home / "records.sqlite")
        self.settings = Settings.load(self.home / "settings.toml")

    def __enter__(self) -> Laboratory:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Let the records go."""
        self.records.close()

    # people ---------------------------------------------------------------------------------------------

    def prepare_demo(self) -> SignedIn | None:
        """A demonstration laboratory with its people, standards and a job, unless there is a laboratory
        already. Its operator is signed in where it was made just now."""
        from ahrs_lab.laboratory.demonstration import prepare

        return prepare(self)

    def open_demo(self) -> SignedIn | None:
        """Prepare the demonstration and sign its operator in; None where somebody has made it their own."""
        from ahrs_lab.laboratory.demonstration import OPERATOR, PASSWORD

        made = self.prepare_demo()
        try:
            return made or self.sign_in(OPERATOR.name, PASSWORD)
        except PermissionDeniedError:
            return None

    def people(self) -> tuple[PersonRow, ...]:
        """Everybody."""
        return self.records.people.all()

    def sign_in(self, name: str, password: str) -> SignedIn:
        """Raises PermissionDeniedError."""
        return self.records.people.sign_in(name, password)

    def add_person(self, row: PersonRow, password: str, actor: SignedIn | None) -> PersonRow:
        """Add somebody; their signing key is made when they first sign, locked by the same password."""
        return self.records.people.add(row, password, actor)

    def first_people(
        self, rows: Sequence[PersonRow], password: str
    ) -> tuple[SignedIn, tuple[PersonRow, ...]]:
        """Of an empty laboratory, all with one published password; the first of them is signed in."""
        return self.records.people.found(rows, password)

    def change_person(self, row: PersonRow, actor: SignedIn, password: str | None = None) -> None:
        """Change somebody; a new password comes with a new signing key."""
        self.records.people.change(row, actor, password)
        if password:
            certification.make_key(self.home, row, password)

    # registry -------------------------------------------------------------------------------------------

    def profile(self) -> LaboratoryRow:
        """Name and address; empty before they are entered."""
        return self.records.registry.laboratory() or LaboratoryRow("")

    def set_profile(self, row: LaboratoryRow, actor: SignedIn) -> None:
        """By an administrator."""
        self.records.registry.set_laboratory(row, actor)

    def standards(self) -> tuple[StandardRow, ...]:
        """The laboratory's measurement standards."""
        return self.records.registry.standards()

    def save_standard(self, row: StandardRow, actor: SignedIn) -> StandardRow:
        """Add or change one; its figures have to be such as its certificate can state."""
        job_sheets.check_standard(row)
        return self.records.registry.save_standard(row, actor)

    def plan_presets(self) -> dict[str, str]:
        """Plans that come along, name → TOML."""
        return plan_presets()

    def bench_presets(self) -> dict[str, str]:
        """Benches that come along, name → TOML."""
        return bench_presets()

    # jobs -----------------------------------------------------------------------------------------------

    def jobs(self) -> tuple[JobRow, ...]:
        """All jobs, the newest first."""
        return self.records.jobs.all()

    def job(self, number: str) -> JobRow:
        """Raises InputError where there is no such job."""
        return self.records.jobs.get(number)

    def create_job(self, draft: JobDraft, actor: SignedIn, folder: Path | None = None) -> str:
        """A new job; its recordings go to ``folder``, by default one of the laboratory's own."""
        number = self.records.jobs.create(draft, actor)
        place = folder or self.home / "jobs" / number
        self.records.jobs.set_folder(number, str(place.resolve()), actor)
        return number

    def update_job(self, number: str, draft: JobDraft, actor: SignedIn) -> None:
        """Correct a job before anything of it is signed."""
        self.records.jobs.change(number, draft, actor)

    def folder(self, number: str) -> Path:
        """Where the job's files are."""
        return Path(self.job(number).folder)

    def bundle(self, number: str) -> Path:
        """The job's recording."""
        return self.folder(number) / "recording"

    def plan(self, number: str) -> Plan:
        """The job's plan; raises InputError where it cannot be run."""
        return plan_from_text(self.job(number).plan_toml, f"plan of job {number}")

    def bench(self, number: str, speed: float | None) -> Bench:
        """The job's bench; ``speed`` of a simulated one, None: as fast as the machine can."""
        return bench_from_text(self.job(number).bench_toml, f"bench of job {number}", speed=speed)

    def clause6(self, number: str) -> tuple[Message, ...]:
        """What of the bench violates clause 6 today; empty when the job may start."""
        return job_sheets.violations(self.job(number), self.profile(), self.result(number))

    def start_run(
        self,
        number: str,
        actor: SignedIn,
        *,
        on_event: Callable[[Event], None],
        on_samples: Callable[[Samples], None],
        speed: float | None = 1.0,
        ask: bool = True,
        violations_reason: str = "",
        second_person: SignedIn | None = None,
    ) -> LiveRun:
        """Make the job's run, ready to ``start()``; see :mod:`ahrs_lab.laboratory.runs`."""
        from ahrs_lab.laboratory.runs import make_run

        return make_run(
            self,
            number,
            actor,
            on_event=on_event,
            on_samples=on_samples,
            speed=speed,
            ask=ask,
            violations_reason=violations_reason,
            second_person=second_person,
        )

    def take_up_run(self, number: str, actor: SignedIn, reason: str = "") -> None:
        """A run that ended goes on, or records a part again for ``reason``; the job is running again."""
        from ahrs_lab.laboratory.runs import take_up

        take_up(self, number, actor, reason)

    def finish_run(self, number: str, actor: SignedIn, evaluate: Evaluate = evaluate_bundle) -> AnyResult:
        """Evaluate what the job's run recorded, keep the result, and call
        the job measured."""
        result = self.recalculate(number, EvaluationSettings(), actor, evaluate)
        if self.job(number).state == "running":
            self.records.jobs.move(number, "measured", actor)
        return result

    def leave_run(self, number: str, actor: SignedIn, why: Message) -> None:
        """The run ended before its end: the job is ready again, and goes on where it stopped."""
        self.records.jobs.add_run_event(number, "stopped", why.text())
        if self.job(number).state == "running":
            self.records.jobs.move(number, "ready", actor)

    def recalculate(
        self,
        number: str,
        settings: EvaluationSettings,
        actor: SignedIn,
        evaluate: Evaluate = evaluate_bundle,
    ) -> AnyResult:
        """Reduce the job's recording again, as its customer asked; the result becomes the current one,
        earlier ones stay."""
        job = self.job(number)
        capability = job_sheets.capability(job)
        asked = requirements_from_json(job.limits_json)
        settings = replace(settings, repeatability=asked.repeatability)
        result = evaluate(self.bundle(number), settings, capability)
        self.records.jobs.add_result(
            number, json.dumps(to_json(result), ensure_ascii=False, allow_nan=False), actor
        )
        return result

    def result(self, number: str) -> AnyResult | None:
        """The current result, or None before there is one."""
        rows = self.records.jobs.results(number)
        return from_json_text(rows[-1].json) if rows else None

    def judged(self, number: str) -> Judged | None:
        """The current result by JJF 1536 as it is reported and judged; None before there is one, and for a
        calibration by another procedure, whose quantities have no limits."""
        result = self.result(number)
        if result is None or isinstance(result, ImuResult):
            return None
        return judge_for_screen(
            result,
            requirements_from_json(self.job(number).limits_json),
            capability_from_json(self.profile().capability_json),
        )

    def segment_samples(self, number: str, file: str) -> Samples:
        """The raw samples of one segment file of the job's recording."""
        from ahrs_lab.recording.read import read_bundle

        for recorded in read_bundle(self.bundle(number)).segments:
            if recorded.segment.file == file or recorded.segment.name == file:
                if not len(recorded.samples):
                    raise InputError("There is nothing to show. {what}", what=recorded.findings[0].placed)
                return recorded.samples
        raise InputError("The recording of job {number} has no segment {file}.", number=number, file=file)

    # certificates ---------------------------------------------------------------------------------------

    def draft_certificate(
        self, number: str, language: CertificateLanguage = "bilingual", *, budget_annex: bool = False
    ) -> Path:
        """The certificate as the customer will see it, not signed: for looking at."""
        return certification.draft(self, number, language, budget_annex=budget_annex)

    def original_record(self, number: str) -> Path:
        """The original record (原始记录) of the current result as PDF."""
        return certification.original_record(self, number)

    def sign(
        self,
        number: str,
        role: SigningRole,
        actor: SignedIn,
        password: str,
        language: CertificateLanguage = "bilingual",
        *,
        budget_annex: bool = False,
    ) -> Path:
        """Sign the job's certificate as ``role``; the first signature fixes its content. Returns the PDF."""
        return certification.sign(self, number, role, actor, password, language, budget_annex=budget_annex)

    def certificate(self, number: str) -> Path | None:
        """The certificate that is being or has been signed, or None before the first signature."""
        return certification.signed_file(self, number)

    def signatures(self, number: str) -> tuple[SignatureRow, ...]:
        """Those on the current certificate."""
        return self.records.jobs.signatures(number)

    def send_back(self, number: str, actor: SignedIn, reason: str) -> None:
        """The approver returns a checked job; its next certificate is a new revision."""
        self.records.jobs.move(number, "measured", actor, reason)

    def verify(self, file: Path, extra_roots: Sequence[Path] = ()) -> VerificationReport:
        """Who signed ``file``, when, and whether anything changed since; trusts this laboratory's
        authority."""
        return certification.verify(self.home, file, extra_roots)

    # in and out -----------------------------------------------------------------------------------------

    def export(self, number: str, target: Path) -> Path:
        """Write the job's recording as ``<number>.ahrsrec`` into ``target``; returns the file."""
        from ahrs_lab.laboratory.exchange import export_job

        return export_job(self, number, target)

    def import_bundle(self, bundle: Path, actor: SignedIn | None = None) -> str:
        """Take a recording into the records as a job of its own; returns its number."""
        from ahrs_lab.laboratory.exchange import import_bundle

        return import_bundle(self, bundle, actor)


def today() -> datetime:
    """Now, in the laboratory's own time zone."""
    return datetime.now().astimezone()
