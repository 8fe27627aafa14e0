"""A demonstration laboratory: three people, standards, a customer's device on a simulated bench, and the
whole job without a screen. Everything goes the way a real job goes; only the bench is not real, and every
page says so."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import date, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from ahrs_lab.certificates.libraries import load_layout, load_signing
from ahrs_lab.errors import AhrsLabError, InputError
from ahrs_lab.laboratory import certification
from ahrs_lab.laboratory.benches import bench_presets, plan_presets
from ahrs_lab.laboratory.evaluation import OutputFolder, write_files
from ahrs_lab.laboratory.evaluation_beside import EvaluationBeside
from ahrs_lab.laboratory.headless import wait_for
from ahrs_lab.laboratory.results import AnyResult
from ahrs_lab.metrology.conformity import DecisionRule
from ahrs_lab.metrology.declared_place import DeclaredPlace, place_to_json
from ahrs_lab.metrology.figures_json import figures_text
from ahrs_lab.metrology.limits import Limit
from ahrs_lab.metrology.requirements import Requirements, requirements_to_json
from ahrs_lab.metrology.stated_figures import StatedFigure
from ahrs_lab.recording.folder_lock import FolderLock
from ahrs_lab.records.rows import (
    CustomerRow,
    DeviceRow,
    JobDraft,
    LaboratoryRow,
    PersonRow,
    SignedIn,
    SigningRole,
    StandardRow,
)

if TYPE_CHECKING:
    from ahrs_lab.laboratory.laboratory import Laboratory
    from ahrs_lab.laboratory.live_run import LiveRun
    from ahrs_lab.procedures.commands import Step
    from ahrs_lab.procedures.events import Event
    from ahrs_lab.procedures.plan import Plan

PASSWORD = "demo"
STANDARD_PLAN = "standard"
ACCELERATED_PLAN = "accelerated"
BENCH = "demo"
_PREPARATION_LIMIT_S = 30.0
_LONGER_THAN_PLANNED = 1.05
"""A run may take so much longer than its steps' estimates."""

OPERATOR = PersonRow(
    0,
    "演示校准员",
    "Demo operator",
    "校准工程师",
    "Calibration engineer",
    frozenset({"operator", "administrator"}),
)
VERIFIER = PersonRow(
    0, "演示核验员", "Demo verifier", "技术负责人", "Technical head", frozenset({"verifier"})
)
APPROVER = PersonRow(
    0, "演示签发人", "Demo approver", "授权签字人", "Authorised signatory", frozenset({"approver"})
)

REQUIREMENTS = Requirements(
    (
        Limit("K", -5000.0, 5000.0, "ppm", nominal=1.0),
        Limit("B", -30.0, 30.0, "deg/h"),
        Limit("L", -10.0, 10.0, "arcmin"),
    ),
    DecisionRule("guard-band", probability=True),
)
"""Limits of the demonstration's customer; wide enough for its unit and for a short plan's U."""


def prepare(laboratory: Laboratory) -> SignedIn | None:
    """Fill an empty laboratory and sign its operator in; one that has people already stays as it is.

    Of several instances at once the first one does it, the others wait until it is done.
    """
    if laboratory.people() and laboratory.jobs():
        return None
    with _alone(laboratory.home):
        known = {row.name for row in laboratory.people()}
        if not laboratory.jobs() and known <= {row.name for row in (OPERATOR, VERIFIER, APPROVER)}:
            return _fill(laboratory)
    return None


@contextmanager
def _alone(home: Path) -> Iterator[None]:
    until = time.monotonic() + _PREPARATION_LIMIT_S
    while True:
        try:
            lock = FolderLock(home)
            break
        except InputError:
            if time.monotonic() > until:
                raise
            time.sleep(0.05)
    try:
        yield
    finally:
        lock.release()


def _fill(laboratory: Laboratory) -> SignedIn:
    """Also goes on where another start was killed half-way."""
    people = (OPERATOR, VERIFIER, APPROVER)
    if found := {row.name: row for row in laboratory.people()}:
        actor = laboratory.sign_in(OPERATOR.name, PASSWORD)
        operator, verifier, approver = (
            found.get(row.name) or laboratory.add_person(row, PASSWORD, actor) for row in people
        )
    else:
        actor, (operator, verifier, approver) = laboratory.first_people(people, PASSWORD)
    laboratory.set_profile(
        LaboratoryRow(
            "演示校准实验室",
            "Demonstration Calibration Laboratory",
            "演示市示例路 8 号",
            "8 Example Road, Demo City",
            place_json=place_to_json(DeclaredPlace(earth_resistance_ohm=1.0, isolated_foundation=True)),
        ),
        actor,
    )
    for row in () if laboratory.standards() else _standards(date.today()):  # noqa: DTZ011  due dates are the laboratory's own
        laboratory.save_standard(row, actor)
    for plan in (ACCELERATED_PLAN, STANDARD_PLAN):
        laboratory.create_job(_draft(laboratory, plan, (operator.id, verifier.id, approver.id)), actor)
    certification.authority(laboratory.home).create()
    return actor


def _standards(today: date) -> tuple[StandardRow, ...]:
    due = today.replace(day=1) + timedelta(days=300)
    rows = (
        StandardRow(
            0,
            "table",
            "Single-axis position and rate table",
            "单轴位置速率转台",
            model="ST-1000",
            serial_number="T-0007",
            accuracy="U_rel = 2×10^{−4}, (10–1000) °/s, k = 2; U = 10″, k = 2",
            accuracy_zh="U_rel = 2×10^{−4}，(10～1000) °/s，k = 2；U = 10″，k = 2",
            certificate_number="DEMO-26-0815",
            figures_json=figures_text(
                (
                    StatedFigure("rate_relative_below_1", 2e-2, "1", 2.0),
                    StatedFigure("rate_relative_1_to_10", 2e-3, "1", 2.0),
                    StatedFigure("rate_relative_from_10", 2e-4, "1", 2.0),
                    StatedFigure("position_arcsec", 10.0, "arcsec", 2.0),
                    StatedFigure("wobble_arcsec", 2.0, "arcsec", 2.0),
                    StatedFigure("axis_tilt_arcsec", 10.0, "arcsec", 2.0),
                )
            ),
        ),
        StandardRow(
            0,
            "supply",
            "Linear DC supply",
            "线性直流电源",
            model="PS-30",
            serial_number="P-0113",
            accuracy="U_rel = 2×10^{−3}, k = 2; ripple 0.3 mV",
            accuracy_zh="U_rel = 2×10^{−3}，k = 2；纹波 0.3 mV",
            certificate_number="DEMO-26-0816",
        ),
        StandardRow(
            0,
            "fixture",
            "Mounting fixture",
            "安装夹具",
            model="FX-6",
            serial_number="F-0021",
            accuracy="perpendicularity < 5″",
            accuracy_zh="垂直度 < 5″",
            certificate_number="DEMO-26-0821",
            figures_json=figures_text(
                (StatedFigure("fixture_perpendicularity_arcsec", 5.0, "arcsec", distribution="rectangular"),)
            ),
        ),
        StandardRow(
            0,
            "room",
            "Thermo-hygrometer",
            "温湿度计",
            model="TH-2",
            serial_number="H-0104",
            accuracy="U = 0.3 °C, 2 %RH, k = 2",
            accuracy_zh="U = 0.3 °C，2 %RH，k = 2",
            certificate_number="DEMO-26-0830",
        ),
    )
    return tuple(
        replace(row, manufacturer="Demonstration", traceability="Demonstration", due=due) for row in rows
    )


def _draft(laboratory: Laboratory, plan: str, people: tuple[int, int, int], plan_toml: str = "") -> JobDraft:
    today = date.today()  # noqa: DTZ011
    return JobDraft(
        customer=CustomerRow(
            0, "演示客户有限公司", "Demonstration Customer Ltd.", "演示市示例路 1 号", "1 Example Road"
        ),
        device=DeviceRow(0, "捷联式惯性航姿仪", "Strapdown AHRS", "Demonstration", "DEMO-100", "0100012345"),
        received=today - timedelta(days=3),
        place="惯性实验室 101",
        place_en="Inertial laboratory 101",
        plan_toml=plan_toml or plan_presets()[plan],
        bench_toml=bench_presets()[BENCH],
        standard_ids=tuple(row.id for row in laboratory.standards()),
        operator_id=people[0],
        verifier_id=people[1],
        approver_id=people[2],
        limits_json=requirements_to_json(REQUIREMENTS),
    )


@dataclass(frozen=True)
class DemonstrationOutcome:
    """What the demonstration left: its result and the files by kind."""

    result: AnyResult
    files: dict[str, Path]


def run_demonstration(
    out: Path,
    *,
    plan: Plan | None,
    speed: float | None,
    on_event: Callable[[Event], None],
    on_stage: Callable[[str], None],
    beside: bool = False,
) -> DemonstrationOutcome:
    """A whole job without a screen into ``out``: measured, evaluated, certified by three signatures,
    verified.

    One of the same plan that was interrupted in ``out`` is gone on with; what a complete one left there is
    moved into ``out/earlier-<n>``, never deleted.
    """
    from ahrs_lab.laboratory.laboratory import Laboratory

    out = out.resolve()
    with OutputFolder(out):
        _refuse_foreign(out)
    with Laboratory() as laboratory:
        made = laboratory.prepare_demo()
        people = {role: _person(laboratory, role) for role in ("operator", "verifier", "approver")}
        actor = made or laboratory.sign_in(people["operator"].name, PASSWORD)
        ids = (people["operator"].id, people["verifier"].id, people["approver"].id)
        draft = _draft(laboratory, STANDARD_PLAN, ids, _plan_text(plan))
        number = _unfinished(laboratory, out, draft.plan_toml)
        if not number:
            with OutputFolder(out):
                _put_aside(out)
            number = laboratory.create_job(draft, actor, out)
        run = laboratory.start_run(
            number, actor, on_event=on_event, on_samples=lambda _samples: None, speed=speed, ask=False
        )
        with EvaluationBeside(run, _load_libraries, allowed=beside) as evaluation:
            _measure(laboratory, number, actor, run, speed)
            on_stage("evaluating")
            result = laboratory.finish_run(number, actor, evaluation.evaluate)
        files = {"recording": laboratory.bundle(number), **write_files(result, out, record=False)}
        files["original_record"] = laboratory.original_record(number)
        on_stage("certificate and signatures")
        for role in ("operator", "verifier", "approver"):
            signer = actor if role == "operator" else laboratory.sign_in(people[role].name, PASSWORD)
            signed = laboratory.sign(number, role, signer, PASSWORD)
        files["certificate"] = out / "certificate.pdf"
        files["certificate"].write_bytes(signed.read_bytes())
        report = laboratory.verify(files["certificate"])
        if not report.valid:
            raise AhrsLabError(
                "The demonstration's own certificate does not verify: {why}", why=report.summary
            )
    return DemonstrationOutcome(result, files)


def _measure(laboratory: Laboratory, number: str, actor: SignedIn, run: LiveRun, speed: float | None) -> None:
    run.start(lambda steps: _date_back(run, steps, speed))
    try:
        wait_for(run)
    except AhrsLabError as error:
        laboratory.leave_run(number, actor, error.message)
        raise


def _date_back(run: LiveRun, steps: tuple[Step, ...], speed: float | None) -> None:
    """The bench runs ahead of the clock on the wall: it begins so early that it ends before anybody signs."""
    from ahrs_lab.simulation.bench import world_of

    ahead = 1.0 if speed is None else max(1.0 - 1.0 / speed, 0.0)
    world_of(run.bench).clock.begin_earlier(
        ahead * _LONGER_THAN_PLANNED * sum(step.estimate_s for step in steps)
    )


def _load_libraries() -> None:
    import scipy.special  # noqa: F401  the distributions of a verdict

    load_layout()
    load_signing()


def _plan_text(plan: Plan | None) -> str:
    if plan is None:
        return ""
    import tomli_w

    from ahrs_lab.procedures.plan import plan_to_toml

    return tomli_w.dumps(plan_to_toml(plan))


def _person(laboratory: Laboratory, role: SigningRole) -> PersonRow:
    wanted = {"operator": OPERATOR, "verifier": VERIFIER, "approver": APPROVER}[role].name
    for row in laboratory.people():
        if row.name == wanted and role in row.roles:
            return row
    raise InputError(
        "The laboratory in {home} is not the demonstration laboratory: set AHRS_LAB_HOME to an empty folder.",
        home=laboratory.home,
    )


def _left(out: Path) -> list[Path]:
    return [path for path in out.iterdir() if not path.name.startswith("earlier-")]


def _refuse_foreign(out: Path) -> None:
    if _left(out) and not (out / "recording").is_dir():
        raise InputError(
            "{path} holds files of something else: choose another folder or an empty one.", path=out
        )


def _unfinished(laboratory: Laboratory, out: Path, plan_toml: str) -> str:
    """Number of the job that was broken off in ``out``, or nothing."""
    job = next((job for job in laboratory.jobs() if job.folder == str(out)), None)
    if job is None or job.state not in ("ready", "running") or job.plan_toml != plan_toml:
        return ""
    return job.number if laboratory.bundle(job.number).is_dir() else ""


def _put_aside(out: Path) -> None:
    """Move what an earlier demonstration left, whole, into the next free ``earlier-<n>``."""
    left = _left(out)
    if not left:
        return
    FolderLock(out / "recording").release()  # raises where another instance is recording there
    count = 1
    while (out / f"earlier-{count}").exists():
        count += 1
    aside = out / f"earlier-{count}"
    aside.mkdir()
    for path in left:
        path.rename(aside / path.name)
