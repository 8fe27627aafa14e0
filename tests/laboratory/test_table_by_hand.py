"""A calibration on a table that is set by hand, driven as the screen drives it; the test is the hand."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.errors import AbortedError, InstrumentError
from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.laboratory.evaluation import evaluate_bundle
from ahrs_lab.laboratory.hands import TerminalOperator
from ahrs_lab.laboratory.header import recording_header
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import (
    Event,
    HandChecked,
    HandRequested,
    MadeSafe,
    MountRequested,
    SegmentStarted,
    Warned,
)
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.recording.read import read_bundle
from tests.laboratory.by_hand import bench_without_wire, obey
from tests.laboratory.short_run import SEGMENTS, counted, values, wait_until, write_bench, write_plan

_TIME_S = 12.0
"""Bench time a person takes for anything at the table."""

Deed = Callable[[HandRequest], str]
"""Does something else than what is asked: "done", or "silent" where nothing is said either; "": nothing."""


class Person:
    """Confirms each mounting and does each thing that is asked at the table; ``deed`` comes first."""

    def __init__(self, folder: Path, deed: Deed = lambda _: "") -> None:
        self.events: list[Event] = []
        self.deed = deed
        self.asleep = False
        self.mounted = 0
        plan = load_plan(write_plan(folder))
        text = write_bench(folder).read_text(encoding="utf-8")
        self.bench, self.table = bench_without_wire(text, None)
        self.bundle = folder / "recording"
        header = recording_header(self.bench, plan)
        self.run = LiveRun(
            self.bench, plan, self.bundle, header, on_event=self.hear, on_samples=lambda _: None
        )

    def hear(self, event: Event) -> None:
        """In the run's thread, as news: what is done is done before the run waits for the answer."""
        self.events.append(event)
        if self.asleep:
            return
        again = (
            isinstance(event, HandChecked) and not event.finding.accepted and not event.finding.begin_again
        )
        if isinstance(event, HandRequested) or (isinstance(event, HandChecked) and again):
            done = self.deed(event.request)
            if not done:
                obey(self.table, event.request)
            if done != "silent":
                self.bench.clock.wait(_TIME_S)
                self.run.confirm_set()

    def saw(self, kind: type[Any]) -> list[Any]:
        return [event for event in list(self.events) if isinstance(event, kind)]

    def mounts_until(self, there: Callable[[], bool]) -> None:
        """Confirm mountings until then, or until the run is over."""
        while not there() and not self.run.join(0.02):
            if len(self.saw(MountRequested)) > self.mounted and self.run.state == "waiting":
                self.mounted += 1
                self.run.confirm_mounted()

    def mount_all(self) -> None:
        self.mounts_until(lambda: False)

    def at_a_rate(self) -> bool:
        return any(event.segment.role == "rate" for event in self.saw(SegmentStarted))


@pytest.fixture
def people() -> Iterator[list[Person]]:
    made: list[Person] = []
    yield made
    for person in made:
        person.run.abort(Message("the test is over"))
        assert person.run.join(60)


def test_a_whole_calibration_by_hand_with_what_was_wrong_refused_and_not_recorded(
    tmp_path: Path, people: list[Person], undisturbed: dict[str, Any]
) -> None:
    wrong: list[str] = []

    def deed(request: HandRequest) -> str:
        """Once the wrong sense, once one turn too few."""
        if request.kind == "rate" and request.rate_dps == 100.0 and "rate" not in wrong:
            wrong.append("rate")
            person.table.set_rate(-100.0)
            return "done"
        if request.kind == "turns" and "turns" not in wrong:
            wrong.append("turns")
            person.table.move_to(person.table.state().angle_deg + request.travel_deg - 360.0, 100.0)
            return "done"
        return ""

    person = Person(tmp_path, deed)
    people.append(person)
    person.run.start()
    person.mount_all()
    assert person.run.outcome is not None
    assert person.run.outcome.state == "done", person.run.outcome.message
    refusals = [event for event in person.saw(HandChecked) if not event.finding.accepted]
    told = " ".join(str(event.finding.message) for event in refusals)
    assert "the table turns the wrong way. Set it to +100 °/s, anticlockwise" in told
    assert "has felt the table turn by +36" in told
    assert counted(person.bundle) == SEGMENTS
    spoilt = [s.segment for s in read_bundle(person.bundle).segments if s.segment.interrupted]
    assert [segment.name for segment in spoilt] == ["ma_x_pos"]
    assert not person.bench.supply.read().output_on
    expected = values(undisturbed)
    for name, (value, expanded) in values(to_json(evaluate_bundle(person.bundle))).items():
        assert abs(value - expected[name][0]) < 2.0 * (expanded + expected[name][1]), name


def test_stop_ends_a_question_at_once_and_tells_to_bring_the_table_to_rest(
    tmp_path: Path, people: list[Person]
) -> None:
    asked: list[HandRequest] = []

    def deed(request: HandRequest) -> str:
        if request.rate_dps != 50.0 and not asked:
            return ""
        asked.append(request)
        person.table.set_rate(50.0)
        return "silent"

    person = Person(tmp_path, deed)
    people.append(person)
    person.run.start()
    person.mounts_until(lambda: bool(asked))
    wait_until(lambda: abs(person.table.state().rate_dps) > 40.0)
    assert not person.run.join(0.3)
    person.run.abort(Message("Stopped by the operator."))
    wait_until(lambda: person.saw(HandRequested)[-1].request.kind == "rest")
    person.table.stop()
    assert person.run.join(10)
    assert person.run.outcome is not None
    assert person.run.outcome.state == "aborted"
    assert isinstance(person.run.outcome.error, AbortedError)
    assert person.saw(MadeSafe) == [MadeSafe(())]
    assert not person.bench.supply.read().output_on
    names = [event.segment.name for event in person.saw(SegmentStarted)]
    assert "sf_x_04" not in names


def test_a_table_that_nobody_brings_to_rest_is_said_to_turn(tmp_path: Path, people: list[Person]) -> None:
    person = Person(tmp_path)
    people.append(person)
    person.run.start()
    person.mounts_until(person.at_a_rate)
    person.asleep = True
    person.run.abort(Message("Stopped by the operator."))
    assert person.run.join(30)
    (safe,) = person.saw(MadeSafe)
    assert re.search(r"set by hand and was still turning at (25|50)\b", str(safe.problems[0]))
    assert str(safe.problems[0]) in [str(event.what) for event in person.saw(Warned)]
    assert not person.bench.supply.read().output_on


def test_pause_waits_for_the_dwell_and_has_the_table_brought_to_rest(
    tmp_path: Path, people: list[Person]
) -> None:
    person = Person(tmp_path)
    people.append(person)
    person.run.start()
    person.mounts_until(person.at_a_rate)
    person.run.pause()
    wait_until(lambda: person.run.state == "paused")
    assert person.saw(HandRequested)[-1].request.kind == "rest"
    assert not person.table.state().moving
    person.run.resume()
    person.mount_all()
    assert person.run.outcome is not None
    assert person.run.outcome.state == "done", person.run.outcome.message
    assert counted(person.bundle) == SEGMENTS


def test_a_simulated_hand_runs_it_without_a_person_and_gives_up_what_it_cannot(tmp_path: Path) -> None:
    text = write_bench(
        tmp_path,
        'name = "wrong_rate"',
        old="mount_time_s = 60.0",
        new="mount_time_s = 60.0\nsets_table = true",
    ).read_text(encoding="utf-8")
    plan = load_plan(write_plan(tmp_path))
    with pytest.raises(AbortedError, match=r"gives up: .*the wrong way"):
        run_plan(plan, bench_from_text(text, "bench"), tmp_path / "out", on_event=lambda _: None)


def test_without_anybody_to_ask_the_run_does_not_begin(tmp_path: Path) -> None:
    text = write_bench(tmp_path).read_text(encoding="utf-8")
    bench, _ = bench_without_wire(text, None)
    with pytest.raises(InstrumentError, match="nobody on this bench to ask"):
        run_plan(load_plan(write_plan(tmp_path)), bench, tmp_path / "out", on_event=lambda _: None)


def test_the_terminal_asks_and_takes_enter_for_done() -> None:
    questions = StringIO()
    terminal = TerminalOperator(StringIO("\n\nq\n"), questions)
    request = HandRequest("rest", Message("Bring the table to rest."))
    terminal.ask(request)
    wait_until(lambda: terminal.has_set(0.1))
    terminal.ask(request, Message("It still turns."))
    assert "It still turns.\nBring the table to rest.\nEnter: done" in questions.getvalue()
    wait_until(lambda: terminal.has_set(0.1))
    terminal.ask(request)
    with pytest.raises(AbortedError):
        wait_until(lambda: terminal.has_set(0.1))
