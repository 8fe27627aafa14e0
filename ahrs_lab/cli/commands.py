"""What each command does: read the call's files, ask the laboratory, print text or one JSON object."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ahrs_lab.cli.analysis import commands as analysis_commands
from ahrs_lab.cli.progress import ProgressLine
from ahrs_lab.cli.stop_signals import stop_signals
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.evaluation import EvaluationSettings, evaluate_bundle, read_result, write_files
from ahrs_lab.laboratory.judgement import Judged, judge_result
from ahrs_lab.laboratory.kept_memory import keep_memory
from ahrs_lab.laboratory.results import AnyResult, to_json
from ahrs_lab.metrology.best_capability import BestCapability
from ahrs_lab.metrology.conformity_json import conformity_to_json
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.requirements import Requirements
from ahrs_lab.metrology.rounding import RoundingMode

if TYPE_CHECKING:
    from ahrs_lab.certificates.job_sheet import JobSheet


def run(arguments: argparse.Namespace) -> int:
    """The command of ``arguments``; None opens the application."""
    if arguments.command is None:
        return _application(language=None, speed=1.0, demonstration=False)
    for analysis in analysis_commands():
        if arguments.command == analysis.NAME:
            return analysis.run(arguments)
    return int(_COMMANDS[arguments.command](arguments))


def _say(arguments: argparse.Namespace, data: dict[str, Any], text: str) -> None:
    print(json.dumps(data, ensure_ascii=False, allow_nan=False) if arguments.json else text)


def _application(*, language: str | None, speed: float | None, demonstration: bool) -> int:
    from concurrent.futures import ThreadPoolExecutor

    from ahrs_lab.laboratory.laboratory import Laboratory

    with Laboratory() as laboratory:
        # The people's password hashes take as long as the screen's libraries: both at once.
        with ThreadPoolExecutor(1) as beside:
            prepared = beside.submit(laboratory.open_demo) if demonstration else None
            import ahrs_lab.ui.main_window
            import ahrs_lab.ui.pages.all_pages  # noqa: F401
            from ahrs_lab.ui.application import run_application
        operator = prepared.result() if prepared is not None else None
        return run_application(
            laboratory, language=language, speed=speed, demo=demonstration, operator=operator
        )


def _demo(arguments: argparse.Namespace) -> int:
    if not arguments.headless:
        if arguments.out is not None:
            raise InputError("--out belongs to --headless: with a screen the records keep everything.")
        speed = arguments.speed if arguments.speed is not None else 20.0
        return _application(language=arguments.language, speed=speed, demonstration=True)
    from ahrs_lab.laboratory.demonstration import run_demonstration
    from ahrs_lab.procedures.plan import load_plan

    if arguments.out is None:
        raise InputError("Say with --out DIR where the demonstration shall leave its files.")
    keep_memory()
    plan = load_plan(arguments.plan) if arguments.plan else None
    with stop_signals(), ProgressLine(sys.stderr) as progress:
        outcome = run_demonstration(
            arguments.out,
            plan=plan,
            speed=arguments.speed,
            on_event=progress.event,
            on_stage=progress.stage,
            beside=True,
        )
    files = {name: str(path) for name, path in outcome.files.items()}
    data = {**to_json(outcome.result), "files": files}
    lines = [summary(outcome.result), "", "Files:"]
    lines += [f"  {name.replace('_', ' '):16} {path}" for name, path in files.items()]
    _say(arguments, data, "\n".join(lines))
    return 0


def _run(arguments: argparse.Namespace) -> int:
    from ahrs_lab.laboratory.benches import load_bench
    from ahrs_lab.laboratory.headless import run_plan
    from ahrs_lab.procedures.plan import load_plan

    keep_memory()
    plan = load_plan(arguments.plan)
    job = _job(arguments)
    bench = load_bench(arguments.bench, speed=arguments.speed)
    try:
        with stop_signals(), ProgressLine(sys.stderr) as progress:
            outcome = run_plan(
                plan,
                bench,
                arguments.out,
                on_event=progress.event,
                settings=_settings(arguments, job),
                capability=job.capability if job else None,
                again_from=arguments.again_from,
                reason=arguments.reason,
                beside=True,
            )
    finally:
        bench.close()
    files = {name: str(path) for name, path in outcome.files.items()}
    data = {**to_json(outcome.result), "files": {"recording": str(outcome.bundle), **files}}
    _say(arguments, data, f"{summary(outcome.result)}\n\nFiles: {arguments.out}")
    return 0


def _settings(arguments: argparse.Namespace, job: JobSheet | None) -> EvaluationSettings:
    return EvaluationSettings(
        rates=arguments.rates,
        uncertainty=arguments.uncertainty,
        trials=arguments.trials,
        repeatability=job is not None and job.requirements.repeatability,
    )


def _job(arguments: argparse.Namespace) -> JobSheet | None:
    """The job sheet of ``--job``, or None where there is none."""
    if arguments.job is None:
        return None
    from ahrs_lab.certificates.job_sheet import load_job_sheet

    return load_job_sheet(arguments.job)


def _evaluate(arguments: argparse.Namespace) -> int:
    job = _job(arguments)
    requirements = job.requirements if job else Requirements()
    _refuse_strict_without_limits(arguments, requirements)
    result = evaluate_bundle(arguments.bundle, _settings(arguments, job), job.capability if job else None)
    judged = _judged(arguments, result, requirements, job.best_capability if job else BestCapability())
    rounding: RoundingMode = job.rounding if job else "half-even"
    text = "\n".join([summary(judged.shown if judged else result, rounding), *judgement(judged, rounding)])
    if arguments.out is not None:
        files = write_files(result, arguments.out)
        text += "\n\nFiles: " + ", ".join(str(path) for path in files.values())
    _say(arguments, {**to_json(result), **_judged_json(judged)}, text)
    return _strict_code(arguments, judged)


def _refuse_strict_without_limits(arguments: argparse.Namespace, requirements: Requirements) -> None:
    if arguments.strict and not requirements.limits:
        raise InputError("--strict needs limits: add [[limit]] tables to the JOB.toml given with --job.")


def _judged(
    arguments: argparse.Namespace, result: AnyResult, requirements: Requirements, capability: BestCapability
) -> Judged | None:
    """None for a calibration whose quantities have no limits; raises InputError where the answer was to
    depend on limits all the same."""
    if not isinstance(result, ImuResult):
        return judge_result(result, requirements, capability)
    if arguments.strict:
        raise InputError(
            "--strict is for results by JJF 1536-2015: the quantities of a discrete IMU calibration have no "
            "limits."
        )
    return None


def _judged_json(judged: Judged | None) -> dict[str, Any]:
    """Keys beside the result's own, where there is something to say."""
    data: dict[str, Any] = {}
    if judged is None:
        return data
    if judged.conformity is not None:
        data["conformity"] = conformity_to_json(judged.conformity)
    if judged.raised:
        data["raised_to_capability"] = list(judged.raised)
    return data


def _strict_code(arguments: argparse.Namespace, judged: Judged | None) -> int:
    """1: done, but out of specification, which is an answer only where it was asked for."""
    conformity = judged.conformity if judged is not None else None
    return 1 if arguments.strict and conformity is not None and not conformity.within else 0


def _certificate(arguments: argparse.Namespace) -> int:
    from ahrs_lab.certificates.certificate import certificate_pdf
    from ahrs_lab.certificates.job_sheet import load_job_sheet
    from ahrs_lab.laboratory.evaluation import OutputFolder

    result, job = read_result(arguments.result), load_job_sheet(arguments.job)
    if arguments.budget_annex:
        job = replace(job, budget_annex=True)
    _refuse_strict_without_limits(arguments, job.requirements)
    judged = _judged(arguments, result, job.requirements, job.best_capability)
    with OutputFolder(arguments.out.parent):
        certificate_pdf(result, job, arguments.out, arguments.language)
    data = {"certificate": str(arguments.out), "number": job.certificate_number, **_judged_json(judged)}
    text = f"Certificate {job.certificate_number}: {arguments.out} (not signed yet)"
    _say(arguments, data, "\n".join([text, *judgement(judged, job.rounding)]))
    return _strict_code(arguments, judged)


def _verify(arguments: argparse.Namespace) -> int:
    from ahrs_lab.laboratory import certification
    from ahrs_lab.laboratory.home import home_folder

    report = certification.verify(home_folder(), arguments.file, arguments.trust)
    _say(arguments, report.to_json(), report.text())
    return 0 if report.valid and not report.unsigned_fields else 1


def _export(arguments: argparse.Namespace) -> int:
    from ahrs_lab.laboratory.laboratory import Laboratory

    with Laboratory() as laboratory:
        written = laboratory.export(arguments.job, arguments.dir)
    _say(arguments, {"job": arguments.job, "bundle": str(written)}, f"Job {arguments.job}: {written}")
    return 0


def _import(arguments: argparse.Namespace) -> int:
    from ahrs_lab.laboratory.laboratory import Laboratory

    with Laboratory() as laboratory:
        number = laboratory.import_bundle(arguments.bundle)
    _say(arguments, {"job": number}, f"Taken into the records as job {number}.")
    return 0


def _simulate(arguments: argparse.Namespace) -> int:
    from ahrs_lab.cli import simulate

    return simulate.run(arguments)


def _replay(arguments: argparse.Namespace) -> int:
    from ahrs_lab.cli import replay

    return replay.run(arguments)


def judgement(judged: Judged | None, rounding: RoundingMode = "half-even") -> list[str]:
    """Each verdict as a person reads it in a terminal, the rule first; nothing where no limits are set.
    Values, U and probability as the certificate rounds them."""
    from ahrs_lab.certificates.conformity_tables import probability_text
    from ahrs_lab.metrology.rounding import round_to_uncertainty

    if judged is None:
        return []
    lines = [f"  U of {key} raised to the laboratory's best capability" for key in judged.raised]
    conformity = judged.conformity
    if conformity is None:
        return lines
    if conformity.statements:
        lines.append(f"Conformity by {conformity.rule.name().text()}: {conformity.verdict}")
    for one in conformity.statements:
        low, high = ("" if bound is None else f"{bound:.10g}" for bound in (one.limit.low, one.limit.high))
        rounded = round_to_uncertainty(one.value, one.expanded, rounding)
        lines.append(
            f"  {one.key:8} {rounded.value:>14} ± {rounded.expanded:<8} {one.limit.unit}, limits [{low}, "
            f"{high}]: {one.verdict} (conformance probability {probability_text(one.conformance)})"
        )
    return lines + [f"  {key:8} has a limit, but was not calibrated" for key in conformity.missing]


def summary(result: AnyResult, rounding: RoundingMode = "half-even") -> str:
    """The result as a person reads it in a terminal: value ± U, rounded as on a certificate; of an IMU the
    tables of its calibration set."""
    from ahrs_lab.metrology.rounding import round_to_uncertainty

    if isinstance(result, ImuResult):
        return _imu_summary(result)

    def line(name: str, value: float, expanded: float, unit: str, k: float) -> str:
        rounded = round_to_uncertainty(value, expanded, rounding)
        return f"  {name:8} {rounded.value:>14} ± {rounded.expanded:<12} {unit}  (k = {k:.2f})"

    lines = [f"{result.procedure}, recording {result.bundle_sha256[:16]}…"]
    for axis, k in result.scale_factor.items():
        lines.append(line(f"K_{axis}", k.K, k.uncertainty.expanded, k.unit, k.uncertainty.coverage_factor))
    for axis, b in result.zero_offset.items():
        lines.append(line(f"B_{axis}", b.B, b.uncertainty.expanded, b.unit, b.uncertainty.coverage_factor))
    for pair, m in result.misalignment.items():
        lines.append(line(f"L_{pair}", m.L, m.uncertainty.expanded, m.unit, m.uncertainty.coverage_factor))
    lines += [f"  deviation: {message.text()}" for message in result.deviations]
    for warning in result.warnings:
        line_number = f":{warning.line}" if warning.line else ""
        place = f"{warning.segment}{line_number}: " if warning.segment else ""
        lines.append(f"  warning: {place}{warning.what.text()}")
    return "\n".join(lines)


def _imu_summary(result: ImuResult) -> str:
    from ahrs_lab.analysis.report import report_text
    from ahrs_lab.laboratory.imu_evaluation import imu_report

    lines = [f"{result.procedure}, recording {result.bundle_sha256[:16]}…", report_text(imu_report(result))]
    return "\n".join([*lines, *(f"  deviation: {message.text()}" for message in result.deviations)])


_COMMANDS = {
    "demo": _demo,
    "run": _run,
    "evaluate": _evaluate,
    "certificate": _certificate,
    "verify": _verify,
    "export": _export,
    "import": _import,
    "simulate": _simulate,
    "replay": _replay,
}
