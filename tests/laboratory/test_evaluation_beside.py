"""The second process: it is it that evaluates, with the same numbers, and nothing of it outlives its run."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory import evaluation_beside
from ahrs_lab.laboratory.benches import load_bench
from ahrs_lab.laboratory.evaluation import EvaluationSettings, evaluate_bundle
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.procedures.events import Event, SegmentFinished
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.resource_files import resource_path
from tests.laboratory.short_run import call, wait_until, write_bench, write_plan


@pytest.fixture(autouse=True)
def always_worth_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluation_beside, "LEAST_SAMPLES", 0)


@pytest.fixture
def evaluated_here(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The bundles that this process evaluates itself."""
    bundles: list[Path] = []

    def evaluate(bundle: Path, *more: Any) -> Any:
        bundles.append(bundle)
        return evaluate_bundle(bundle, *more)

    monkeypatch.setattr(evaluation_beside, "evaluate_bundle", evaluate)
    return bundles


def started(folder: Path) -> tuple[Any, Any]:
    return load_plan(write_plan(folder)), load_bench(write_bench(folder))


def test_the_second_process_gives_the_result_of_an_evaluation(
    tmp_path: Path, evaluated_here: list[Path]
) -> None:
    plan, bench = started(tmp_path)
    chosen = EvaluationSettings(rates="table", trials=0)
    outcome = run_plan(
        plan, bench, tmp_path / "out", on_event=lambda _event: None, settings=chosen, beside=True
    )
    assert not evaluated_here
    assert not multiprocessing.active_children()
    assert outcome.result.deviations
    assert to_json(outcome.result) == to_json(evaluate_bundle(outcome.bundle, chosen))


def test_a_process_that_dies_leaves_the_evaluation_to_this_one(
    tmp_path: Path, evaluated_here: list[Path]
) -> None:
    plan, bench = started(tmp_path)

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished):
            for child in multiprocessing.active_children():
                child.kill()

    outcome = run_plan(plan, bench, tmp_path / "out", on_event=hear, beside=True)
    assert evaluated_here == [outcome.bundle]
    assert to_json(outcome.result) == to_json(evaluate_bundle(outcome.bundle))


@pytest.mark.parametrize("fault", [BlockingIOError("no more processes"), MemoryError()])
def test_a_process_that_cannot_be_started_leaves_the_evaluation_to_this_one(
    tmp_path: Path, evaluated_here: list[Path], monkeypatch: pytest.MonkeyPatch, fault: Exception
) -> None:
    def refuse(*_arguments: Any) -> None:
        raise fault

    monkeypatch.setattr(multiprocessing.process.BaseProcess, "start", refuse)
    plan, bench = started(tmp_path)
    outcome = run_plan(plan, bench, tmp_path / "out", on_event=lambda _event: None, beside=True)
    assert evaluated_here == [outcome.bundle]


def test_a_thread_that_cannot_be_started_takes_its_process_with_it(
    tmp_path: Path, evaluated_here: list[Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    start = threading.Thread.start

    def refuse(thread: threading.Thread) -> None:
        if thread.name == "evaluation-beside":
            raise RuntimeError("can't start new thread")
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", refuse)
    plan, bench = started(tmp_path)
    outcome = run_plan(plan, bench, tmp_path / "out", on_event=lambda _event: None, beside=True)
    assert evaluated_here == [outcome.bundle]
    assert not multiprocessing.active_children()


def test_what_cannot_be_sent_does_not_hang_the_run(
    tmp_path: Path, evaluated_here: list[Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    give = evaluation_beside._Worker.give

    def unsendable(worker: Any, what: Any) -> None:
        unsent: Any = threading.Lock()
        give(worker, unsent if isinstance(what, tuple) else what)

    monkeypatch.setattr(evaluation_beside._Worker, "give", unsendable)
    plan, bench = started(tmp_path)
    outcome = run_plan(plan, bench, tmp_path / "out", on_event=lambda _event: None, beside=True)
    assert evaluated_here == [outcome.bundle]


def test_what_cannot_be_evaluated_is_said_as_ever(tmp_path: Path, evaluated_here: list[Path]) -> None:
    plan, bench = started(tmp_path)

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished):
            (tmp_path / "out" / "recording" / event.segment.file).unlink()

    with pytest.raises(InputError, match=r"recording\.toml"):
        run_plan(plan, bench, tmp_path / "out", on_event=hear, beside=True)
    assert evaluated_here == [tmp_path / "out" / "recording"]
    assert not multiprocessing.active_children()


def test_an_interrupted_run_takes_its_process_with_it(tmp_path: Path) -> None:
    write_plan(tmp_path)
    write_bench(tmp_path, 'name = "table_trips"\nat_s = 60.0')
    assert main(call(tmp_path)) == 3
    assert not multiprocessing.active_children()


@pytest.mark.skipif(sys.platform == "win32", reason="no process groups, and no list in /proc")
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGKILL"])
def test_a_program_that_is_ended_leaves_no_process_behind(tmp_path: Path, number: str) -> None:
    """Ctrl-C at a terminal reaches both processes."""
    out = tmp_path / "out"
    standard, bench = resource_path("plans/standard.toml"), resource_path("benches/demo.toml")
    words = ["run", str(standard), "--bench", str(bench), "--out", str(out)]
    with subprocess.Popen(
        [sys.executable, "-m", "ahrs_lab", *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as program:
        assert program.stderr is not None
        first = program.stderr.readline()
        (child,) = children_of(program.pid)
        if number == "SIGTERM":
            program.terminate()
        else:
            os.killpg(program.pid, signal.SIGINT) if number == "SIGINT" else program.kill()
        said = program.stderr.read()
    wait_until(lambda: not is_running(child))
    assert "Traceback" not in first + said
    if number != "SIGKILL":
        assert program.returncode == 130
        assert "Interrupted" in said


def children_of(pid: int) -> list[int]:
    """The processes that evaluate beside the process ``pid``."""
    listed = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()
    return [int(child) for child in listed if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def is_running(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"
