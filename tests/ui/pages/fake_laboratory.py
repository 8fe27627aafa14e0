"""A laboratory with real records and nothing behind them: measuring, laying out and signing are pretended."""

from __future__ import annotations

import hashlib
import json
from datetime import UTC, date, datetime, timedelta
from pathlib import Path

from ahrs_lab.certificates.verify import SignatureReport, VerificationReport
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory import job_sheets
from ahrs_lab.laboratory.judgement import Judged, judge_for_screen
from ahrs_lab.laboratory.settings import Settings
from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import capability_from_json
from ahrs_lab.metrology.requirements import requirements_from_json
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.result_json import from_json, to_json
from ahrs_lab.recording.samples import Samples
from ahrs_lab.records.rows import (
    CustomerRow,
    DeviceRow,
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
from ahrs_lab.resource_files import resource_path

PASSWORD = "demo"


class FakeLaboratory:
    """The methods of the laboratory that pages call."""

    def __init__(self, home: Path) -> None:
        self.home = home
        self.records = Records(home / "records.sqlite")
        self.settings = Settings(home / "settings.toml")
        self.preview: Path | None = None
        self.signed_with_annex = False

    def close(self) -> None:
        self.records.close()

    def people(self) -> tuple[PersonRow, ...]:
        return self.records.people.all()

    def sign_in(self, name: str, password: str) -> SignedIn:
        return self.records.people.sign_in(name, password)

    def add_person(self, row: PersonRow, password: str, actor: SignedIn | None) -> PersonRow:
        return self.records.people.add(row, password, actor)

    def change_person(self, row: PersonRow, actor: SignedIn, password: str | None = None) -> None:
        self.records.people.change(row, actor, password)

    def profile(self) -> LaboratoryRow:
        return self.records.registry.laboratory() or LaboratoryRow("")

    def set_profile(self, row: LaboratoryRow, actor: SignedIn) -> None:
        self.records.registry.set_laboratory(row, actor)

    def standards(self) -> tuple[StandardRow, ...]:
        return self.records.registry.standards()

    def save_standard(self, row: StandardRow, actor: SignedIn) -> StandardRow:
        job_sheets.check_standard(row)
        return self.records.registry.save_standard(row, actor)

    def plan_presets(self) -> dict[str, str]:
        return {"standard": 'name = "JJF 1536-2015"\n', "accelerated": "[zero_offset]\nduration_s = 60.0\n"}

    def bench_presets(self) -> dict[str, str]:
        return {
            path.stem: path.read_text(encoding="utf-8")
            for path in sorted(resource_path("benches").glob("*.toml"))
        }

    def jobs(self) -> tuple[JobRow, ...]:
        return self.records.jobs.all()

    def job(self, number: str) -> JobRow:
        return self.records.jobs.get(number)

    def bundle(self, number: str) -> Path:
        return self.home / "jobs" / number / "recording"

    def create_job(self, draft: JobDraft, actor: SignedIn) -> str:
        return self.records.jobs.create(draft, actor)

    def update_job(self, number: str, draft: JobDraft, actor: SignedIn) -> None:
        self.records.jobs.change(number, draft, actor)

    def clause6(self, number: str) -> tuple[Message, ...]:
        return job_sheets.violations(self.job(number), self.profile(), None)

    def result(self, number: str) -> CalibrationResult | None:
        rows = self.records.jobs.results(number)
        return from_json(json.loads(rows[-1].json)) if rows else None

    def judged(self, number: str) -> Judged | None:
        result = self.result(number)
        if result is None:
            return None
        requirements = requirements_from_json(self.job(number).limits_json)
        capability = capability_from_json(self.profile().capability_json)
        return judge_for_screen(result, requirements, capability)

    def recalculate(self, number: str, settings: object, actor: SignedIn) -> CalibrationResult:
        result = self.result(number)
        if result is None:
            raise InputError("Job {number} has no recording yet.", number=number)
        return result

    def segment_samples(self, number: str, file: str) -> Samples:
        import numpy as np

        time = np.arange(1, 6001) / 100.0
        rng = np.random.default_rng(3)
        return Samples({"t_s": time, **{f"gyro_{axis}": rng.normal(0.0, 0.05, time.size) for axis in "xyz"}})

    def draft_certificate(
        self, number: str, language: str = "bilingual", *, budget_annex: bool = False
    ) -> Path:
        from reportlab.pdfgen.canvas import Canvas

        if self.preview is not None:
            return self.preview
        target = self.home / f"{number}-{language}{'-annex' if budget_annex else ''}.pdf"
        if target.exists():
            return target
        canvas = Canvas(str(target))
        for page in range(1, 4 if budget_annex else 3):
            canvas.drawString(100, 700, f"{number} {language} page {page} of 2")
            canvas.showPage()
        canvas.save()
        return target

    def original_record(self, number: str) -> Path:
        return self.draft_certificate(number, "record")

    def certificate(self, number: str) -> Path | None:
        return self.draft_certificate(number) if self.signatures(number) else None

    def sign(
        self,
        number: str,
        role: SigningRole,
        actor: SignedIn,
        password: str,
        language: str = "bilingual",
        *,
        budget_annex: bool = False,
    ) -> Path:
        self.records.jobs.may_sign(number, role, actor)
        self.records.people.sign_in(actor.person.name, password)
        self.signed_with_annex = budget_annex
        file = self.draft_certificate(number, language, budget_annex=budget_annex)
        digest = hashlib.sha256(file.read_bytes()).hexdigest()
        self.records.jobs.add_signature(number, role, actor, str(file), digest)
        return file

    def signatures(self, number: str) -> tuple[SignatureRow, ...]:
        return self.records.jobs.signatures(number)

    def send_back(self, number: str, actor: SignedIn, reason: str) -> None:
        self.records.jobs.move(number, "measured", actor, reason)

    def verify(self, path: Path) -> VerificationReport:
        signed = tuple(
            SignatureReport(row.role, row.role, row.person, datetime.now(UTC), True, True, True, "none")
            for job in self.jobs()
            for row in self.signatures(job.number)
        )
        return VerificationReport(True, signed, None, Message("Intact."))


def fill(laboratory: FakeLaboratory) -> dict[str, SignedIn]:
    """Three people, four standards, and a job in each state; returns who signed in by role."""
    people: dict[str, tuple[str, str, frozenset[object]]] = {
        "operator": ("演示校准员", "Demo operator", frozenset({"operator", "administrator"})),
        "verifier": ("演示核验员", "Demo verifier", frozenset({"verifier"})),
        "approver": ("演示签发人", "Demo approver", frozenset({"approver"})),
    }
    actors: dict[str, SignedIn] = {}
    rows: dict[str, PersonRow] = {}
    for role, (name, name_en, roles) in people.items():
        row = PersonRow(0, name, name_en, "校准工程师", "Calibration engineer", roles)  # type: ignore[arg-type]
        rows[role] = laboratory.add_person(row, PASSWORD, actors.get("operator"))
        actors[role] = laboratory.sign_in(name, PASSWORD)
    operator = actors["operator"]
    laboratory.set_profile(
        LaboratoryRow(
            "演示校准实验室", "Demonstration Calibration Laboratory", "演示市示例路 8 号", "8 Example Road"
        ),
        operator,
    )
    due = date.today() + timedelta(days=200)  # noqa: DTZ011
    for kind, name, name_zh, serial in (
        ("table", "Single-axis position and rate table", "单轴位置速率转台", "T-0007"),
        ("supply", "Linear DC supply", "线性直流电源", "P-0113"),
        ("fixture", "Mounting fixture", "安装夹具", "F-0021"),
        ("room", "Thermo-hygrometer", "温湿度计", "H-0104"),
    ):
        laboratory.save_standard(
            StandardRow(
                0, kind, name, name_zh, "Demonstration", "ST-1000", serial, "U_rel = 2×10^{−4}, k = 2",
                "U_rel = 2×10^{−4}，k = 2", f"DEMO-{serial}", due, "Demonstration",
            ),
            operator,
        )  # fmt: skip
    devices = (
        (
            "draft",
            "Demonstration Instruments",
            "VU-100",
            "DEMO-0001",
            "演示客户有限公司",
            "Demonstration Customer Ltd.",
        ),
        ("ready", "VectorNav", "VN-100", "0100012345", "航空仪表研究所", "Institute of Aviation Instruments"),
        ("measured", "Xsens", "MTi-30", "03680A21", "海洋测绘中心", "Centre for Marine Surveying"),
        (
            "checked",
            "MicroStrain",
            "3DM-GX5-25",
            "6253.77812",
            "演示客户有限公司",
            "Demonstration Customer Ltd.",
        ),
        ("issued", "Advanced Navigation", "Orientus", "0031-2207", "无人机系统公司", "Unmanned Systems Ltd."),
    )
    for number, device in enumerate(devices):
        _add_job(laboratory, rows, actors, device, number)
    return actors


def _add_job(
    laboratory: FakeLaboratory,
    people: dict[str, PersonRow],
    actors: dict[str, SignedIn],
    device: tuple[str, ...],
    number: int,
) -> None:
    from tests.ui.pages.sample_result import sample_result

    state, manufacturer, model, serial, customer, customer_en = device
    operator = actors["operator"]
    draft = JobDraft(
        customer=CustomerRow(0, customer, customer_en, "演示市示例路 1 号", "1 Example Road"),
        device=DeviceRow(0, "捷联式惯性航姿仪", "Strapdown AHRS", manufacturer, model, serial),
        received=date(2026, 11, 16) + timedelta(days=number),
        place="惯性实验室 101",
        place_en="Inertial laboratory 101",
        plan_toml=laboratory.plan_presets()["standard"],
        bench_toml=laboratory.bench_presets()["demo"],
        standard_ids=tuple(row.id for row in laboratory.standards()),
        operator_id=people["operator"].id,
        verifier_id=people["verifier"].id if state != "draft" else 0,
        approver_id=people["approver"].id,
    )
    job = laboratory.create_job(draft, operator)
    jobs = laboratory.records.jobs
    if state == "draft":
        return
    jobs.move(job, "ready", operator)
    if state == "ready":
        return
    jobs.move(job, "running", operator)
    jobs.add_result(job, json.dumps(to_json(sample_result()), ensure_ascii=False), operator)
    jobs.move(job, "measured", operator)
    order: tuple[SigningRole, ...] = ("operator", "verifier", "approver")
    for role in order[: {"measured": 0, "checked": 2, "issued": 3}[state]]:
        laboratory.sign(job, role, actors[role], PASSWORD)
