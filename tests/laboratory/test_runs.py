"""Runs that are broken off from outside and gone on with, and what a job's run asks of people."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory import job_sheets
from ahrs_lab.laboratory.demonstration import APPROVER, OPERATOR, PASSWORD, VERIFIER
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.metrology.declared_place import DeclaredPlace, noted_place, place_to_json
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.records.rows import JobDraft, PersonRow, SignedIn, SigningRole
from tests.laboratory.short_run import (
    PLAN,
    SEGMENTS,
    assert_safe,
    assert_same_results,
    call,
    counted,
    only_json,
    wait_until,
    write_bench,
    write_plan,
)

posix = pytest.mark.skipif(sys.platform == "win32", reason="signals")
SLOW = "300"
"""Bench time over wall time: a segment of 20 s lasts long enough to be caught in it."""


def journal_of(bundle: Path, name: str) -> bool:
    """Whether samples of that segment are on the disk while it is being recorded."""
    path = bundle / "segments" / f"{name}.parquet.journal"
    return path.exists()


@contextmanager
def started(folder: Path, *more: str) -> Iterator[subprocess.Popen[str]]:
    """``ahrs-lab run`` in a process of its own, as a person starts it."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ahrs_lab", *call(folder, *more)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@posix
def test_a_second_instance_is_refused_and_a_killed_run_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], undisturbed: dict[str, Any]
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path)
    bundle = tmp_path / "out" / "recording"
    with started(tmp_path, "--speed", SLOW) as first:
        wait_until(lambda: journal_of(bundle, "zo_x_3"))
        assert main(call(tmp_path)) == 2
        captured = capsys.readouterr()
        assert captured.err.count("\n") == 1
        assert f"another instance (process {first.pid}" in captured.err
        assert "choose another folder, or close it" in captured.err
        wait_until(lambda: journal_of(bundle, "sf_x_before"))
        first.send_signal(signal.SIGKILL)
        first.wait()
    kept = {path.name: path.read_bytes() for path in bundle.glob("segments/*.parquet")}
    assert set(kept) == {"zo_x_1.parquet", "zo_x_3.parquet"}

    assert main(call(tmp_path, "--json")) == 0
    assert counted(bundle) == SEGMENTS
    assert_same_results(only_json(capsys.readouterr().out), undisturbed)
    for name, content in kept.items():
        assert (bundle / "segments" / name).read_bytes() == content


@contextmanager
def signalled(number: signal.Signals, bundle: Path, segment: str, times: int = 1) -> Iterator[None]:
    """Send this process a signal once ``segment`` is being recorded: the keys pressed by a person."""

    def press() -> None:
        wait_until(lambda: journal_of(bundle, segment))
        for _ in range(times):
            os.kill(os.getpid(), number)

    thread = threading.Thread(target=press)
    thread.start()
    try:
        yield
    finally:
        thread.join()


@posix
@pytest.mark.parametrize(
    ("number", "times"), [(signal.SIGINT, 1), (signal.SIGINT, 2), (signal.SIGTERM, 1), (signal.SIGHUP, 1)]
)
def test_ctrl_c_in_a_run_leaves_a_safe_bench_and_a_recording_to_go_on_with(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    benches: list[Bench],
    undisturbed: dict[str, Any],
    number: signal.Signals,
    times: int,
) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path)
    bundle = tmp_path / "out" / "recording"
    handler = signal.getsignal(number)
    with signalled(number, bundle, "sf_x_before", times):
        assert main(call(tmp_path, "--speed", SLOW, "--json")) == 130
    assert signal.getsignal(number) is handler
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Traceback" not in captured.err
    assert captured.err.splitlines()[-1] == (
        f"ahrs-lab: Interrupted: what was recorded is kept in {bundle}. Give the same command again to go on."
    )
    assert_safe(benches[-1])
    assert counted(bundle) == {"zo_x_1", "zo_x_3"}
    assert not list(bundle.glob("segments/*.journal"))

    assert main(call(tmp_path, "--json")) == 0
    result = only_json(capsys.readouterr().out)
    assert counted(bundle) == SEGMENTS
    assert_same_results(result, undisturbed)
    interrupted = [warning for warning in result["warnings"] if "interrupted" in warning["what"]]
    # Keys that are pressed before the segment's first row leave no take that was interrupted.
    kept = [one for one in read_bundle(bundle).segments if one.segment.interrupted]
    assert len(interrupted) == len(kept) <= 1
    for warning in interrupted:
        assert "keyboard" in warning["what"]
        assert "KeyboardInterrupt" not in warning["what"]


@posix
def test_ctrl_c_in_a_headless_demonstration_and_the_same_command_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], benches: list[Bench]
) -> None:
    out = tmp_path / "out"
    words = ["demo", "--headless", "--plan", str(write_plan(tmp_path)), "--out", str(out)]
    with signalled(signal.SIGINT, out / "recording", "sf_x_before"):
        assert main([*words, "--speed", SLOW]) == 130
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.splitlines()[-1].endswith("Give the same command again to go on.")
    assert_safe(benches[-1])
    kept = (out / "recording/segments/zo_x_1.parquet").read_bytes()
    with Laboratory() as laboratory:
        broken_off = laboratory.jobs()[0]
        assert broken_off.state == "ready"

    assert main([*words, "--json"]) == 0
    result = only_json(capsys.readouterr().out)
    assert (out / "recording/segments/zo_x_1.parquet").read_bytes() == kept
    assert counted(out / "recording") == SEGMENTS
    assert not (out / "earlier-1").exists()
    assert datetime.fromisoformat(result["notes"]["finished_utc"]) <= datetime.now(UTC)
    with Laboratory() as laboratory:
        assert laboratory.jobs()[0].number == broken_off.number
        assert laboratory.job(broken_off.number).state == "issued"
        whats = [event.what for event in laboratory.records.jobs.run_events(broken_off.number)]
        assert whats == ["started", "stopped", "started"]
    assert main(["verify", result["files"]["certificate"]]) == 0


@pytest.fixture
def laboratory(tmp_path: Path) -> Iterator[Laboratory]:
    with Laboratory(tmp_path / "laboratory") as laboratory:
        laboratory.prepare_demo()
        yield laboratory


@pytest.fixture
def operator(laboratory: Laboratory) -> SignedIn:
    return laboratory.sign_in(OPERATOR.name, PASSWORD)


def changed(laboratory: Laboratory, number: str, actor: SignedIn, **what: Any) -> str:
    """The job with some of its entries replaced."""
    job = laboratory.job(number)
    draft = JobDraft(
        customer=job.customer,
        device=job.device,
        received=job.received,
        place=job.place,
        plan_toml=PLAN,
        bench_toml=job.bench_toml,
        standard_ids=tuple(row.id for row in job.standards),
        operator_id=job.operator.id if job.operator else 0,
        verifier_id=job.verifier.id if job.verifier else 0,
        approver_id=job.approver.id if job.approver else 0,
    )
    laboratory.update_job(number, replace(draft, **what), actor)
    return number


def start(laboratory: Laboratory, number: str, actor: SignedIn, **more: Any) -> LiveRun:
    return laboratory.start_run(
        number,
        actor,
        on_event=lambda _event: None,
        on_samples=lambda _samples: None,
        speed=None,
        ask=False,
        **more,
    )


def test_only_the_operator_of_the_job_runs_it(laboratory: Laboratory, operator: SignedIn) -> None:
    number = laboratory.jobs()[0].number
    with pytest.raises(PermissionDeniedError, match="takes the role operator"):
        start(laboratory, number, laboratory.sign_in(VERIFIER.name, PASSWORD))
    other = replace(OPERATOR, name="另一位", name_en="Another", roles=frozenset({"operator"}))
    laboratory.add_person(other, "secret", operator)
    with pytest.raises(PermissionDeniedError, match=f"Job {number} is not assigned to 另一位"):
        start(laboratory, number, laboratory.sign_in("另一位", "secret"))
    assert laboratory.job(number).state == "draft"


def test_an_expired_standard_needs_the_reason_of_a_second_person(
    laboratory: Laboratory, operator: SignedIn
) -> None:
    table = next(row for row in laboratory.standards() if row.kind == "table")
    expired = date.today() - timedelta(days=1)  # noqa: DTZ011
    laboratory.save_standard(replace(table, due=expired), operator)
    number = changed(laboratory, laboratory.jobs()[0].number, operator)
    verifier = laboratory.sign_in(VERIFIER.name, PASSWORD)
    assert [message.text() for message in laboratory.clause6(number)] == [
        f"The certificate of Single-axis position and rate table s/n T-0007 ran out on {expired}: "
        "have it calibrated or use another."
    ]
    with pytest.raises(InputError, match=r"violates clause 6.*ran out.*second person"):
        start(laboratory, number, operator)
    with pytest.raises(InputError, match="second person"):
        start(laboratory, number, operator, violations_reason="the table is at its calibration")
    with pytest.raises(InputError, match="second person"):
        start(laboratory, number, operator, violations_reason="  ", second_person=verifier)
    with pytest.raises(PermissionDeniedError):
        start(laboratory, number, operator, violations_reason="I say so", second_person=operator)
    assert laboratory.job(number).state == "draft"

    reason = "checked against the reference polygon today"
    run = start(laboratory, number, operator, violations_reason=reason, second_person=verifier)
    run.start()
    assert run.join(60)
    result = laboratory.finish_run(number, operator)
    accepted = result.notes["accepted_violations"]
    assert len(accepted) == 1
    for part in ("ran out", reason, VERIFIER.name):
        assert part in accepted[0]
    assert any(reason in event.detail for event in laboratory.records.jobs.run_events(number))


def test_the_declared_place_is_recorded_and_a_violation_needs_a_second_person(
    laboratory: Laboratory, operator: SignedIn
) -> None:
    number = changed(laboratory, laboratory.jobs()[0].number, operator)
    assert laboratory.clause6(number) == ()
    worse = DeclaredPlace(earth_resistance_ohm=6.0, isolated_foundation=True)
    laboratory.set_profile(replace(laboratory.profile(), place_json=place_to_json(worse)), operator)
    with pytest.raises(InputError, match=r"violates clause 6.*6\.0 Ω.*second person"):
        start(laboratory, number, operator)
    verifier = laboratory.sign_in(VERIFIER.name, PASSWORD)
    run = start(laboratory, number, operator, violations_reason="dry season", second_person=verifier)
    run.start()
    assert run.join(60)
    # What is declared later is not this run's.
    laboratory.set_profile(replace(laboratory.profile(), place_json=""), operator)
    result = laboratory.finish_run(number, operator)
    assert noted_place(result.notes) == worse
    (accepted,) = result.notes["accepted_violations"]
    for part in ("6.0 Ω", "dry season", VERIFIER.name):
        assert part in accepted


def test_only_a_real_bench_needs_its_place_declared(laboratory: Laboratory, operator: SignedIn) -> None:
    number = changed(laboratory, laboratory.jobs()[0].number, operator)
    laboratory.set_profile(replace(laboratory.profile(), place_json=""), operator)
    assert laboratory.clause6(number) == ()
    job = laboratory.job(number)
    for bench, count in (
        ('kind = "instruments"\n', 2),
        ('kind = "instruments"\n[operator]\nkind = "terminal"\n', 2),
        ('kind = "instruments"\n[operator]\nkind = "simulated-hands"\n', 0),
        ("no TOML", 2),
        ('kind = "simulated"\n', 0),
    ):
        found = job_sheets.violations(replace(job, bench_toml=bench), laboratory.profile(), None)
        assert len(found) == count, bench
    assert (
        "not declared"
        in job_sheets.violations(replace(job, bench_toml='kind = "instruments"'), laboratory.profile(), None)[
            0
        ].text()
    )


def test_a_job_whose_program_was_killed_is_gone_on_with(laboratory: Laboratory, operator: SignedIn) -> None:
    """Its state is still “running” then: nobody was left to change it."""
    number = changed(laboratory, laboratory.jobs()[0].number, operator)
    start(laboratory, number, operator)
    assert laboratory.job(number).state == "running"
    run = start(laboratory, number, operator)
    run.start()
    assert run.join(60)
    laboratory.finish_run(number, operator)
    assert laboratory.job(number).state == "measured"
    assert counted(laboratory.bundle(number)) == SEGMENTS


def test_an_issued_job_is_not_measured_again(laboratory: Laboratory, operator: SignedIn) -> None:
    number = changed(laboratory, laboratory.jobs()[0].number, operator)
    run = start(laboratory, number, operator)
    run.start()
    assert run.join(60)
    laboratory.finish_run(number, operator)
    people: dict[SigningRole, PersonRow] = {"operator": OPERATOR, "verifier": VERIFIER, "approver": APPROVER}
    for role, row in people.items():
        laboratory.sign(number, role, laboratory.sign_in(row.name, PASSWORD), PASSWORD)
    with pytest.raises(InputError, match="issued: it is not measured again"):
        start(laboratory, number, operator)
    with pytest.raises(InputError):
        laboratory.finish_run(number, operator)
