"""A run in its own thread, driven as the screen drives it."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.errors import AbortedError, InputError, InstrumentError, MachineError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.laboratory.evaluation import evaluate_bundle
from ahrs_lab.laboratory.header import recording_header
from ahrs_lab.laboratory.live_run import LiveRun
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import Event, MountRequested, SegmentStarted, StateChanged
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.recording.samples import Samples
from ahrs_lab.simulation.bench import world_of
from tests.laboratory.short_run import (
    SEGMENTS,
    assert_safe,
    assert_same_results,
    counted,
    wait_until,
    write_bench,
    write_plan,
)


class Screen:
    """A live run with what a screen would have seen of it."""

    def __init__(
        self, folder: Path, *, ask: bool = False, speed: float | None = None, fault: str = ""
    ) -> None:
        self.events: list[Event] = []
        self.samples = 0
        plan = load_plan(write_plan(folder))
        text = write_bench(folder, *([fault] if fault else [])).read_text(encoding="utf-8")
        self.bench: Bench = bench_from_text(text, "bench.toml", speed=speed)
        self.bundle = folder / "recording"
        self.run = LiveRun(
            self.bench,
            plan,
            self.bundle,
            recording_header(self.bench, plan),
            on_event=self.events.append,
            on_samples=self._count,
            ask=ask,
        )

    def _count(self, samples: Samples) -> None:
        self.samples += len(samples)

    def saw(self, kind: type[Event]) -> list[Event]:
        return [event for event in list(self.events) if isinstance(event, kind)]

    def recording(self, name: str) -> bool:
        """Whether that segment has begun."""
        return any(
            isinstance(event, SegmentStarted) and event.segment.name == name for event in list(self.events)
        )

    def end(self) -> str:
        assert self.run.join(60)
        assert self.run.outcome is not None
        states = [event.state for event in list(self.events) if isinstance(event, StateChanged)]
        assert states[-1] == self.run.outcome.state == self.run.state
        return self.run.outcome.state


@pytest.fixture
def screens() -> Iterator[list[Screen]]:
    """The runs of a test, none of which may go on after it."""
    made: list[Screen] = []
    yield made
    for screen in made:
        screen.run.abort(Message("the test is over"))
        assert screen.run.join(60)


def test_each_mounting_waits_for_the_person_and_the_result_is_that_of_a_run_without_one(
    tmp_path: Path, screens: list[Screen], undisturbed: dict[str, Any]
) -> None:
    screen = Screen(tmp_path, ask=True)
    screens.append(screen)
    screen.run.start()
    for count in (1, 2, 3):
        wait_until(lambda count=count: len(screen.saw(MountRequested)) == count)  # type: ignore[misc]
        assert screen.run.state == "waiting"
        assert not screen.run.join(0.1)
        screen.run.confirm_mounted()
    assert screen.end() == "done"
    assert screen.samples > 20 * 100 * len(SEGMENTS)
    assert counted(screen.bundle) == SEGMENTS
    assert_safe(screen.bench)
    assert_same_results(to_json(evaluate_bundle(screen.bundle)), undisturbed)


def test_a_wrong_mounting_is_asked_for_again(tmp_path: Path, screens: list[Screen]) -> None:
    screen = Screen(tmp_path, ask=True)
    screens.append(screen)
    world_of(screen.bench).faults.trigger("wrong_mounting", once=True)
    screen.run.start()
    for count in (1, 2, 3, 4):
        wait_until(lambda count=count: len(screen.saw(MountRequested)) == count)  # type: ignore[misc]
        screen.run.confirm_mounted()
    assert screen.end() == "done"
    first, second = screen.saw(MountRequested)[:2]
    assert isinstance(first, MountRequested)
    assert isinstance(second, MountRequested)
    assert first.orientation == second.orientation


def test_a_run_is_stopped_while_the_person_mounts(tmp_path: Path, screens: list[Screen]) -> None:
    screen = Screen(tmp_path, ask=True)
    screens.append(screen)
    screen.run.start()
    wait_until(lambda: bool(screen.saw(MountRequested)))
    screen.run.abort(Message("Stopped by the operator."))
    assert screen.end() == "aborted"
    assert_safe(screen.bench)


def test_a_stop_in_mid_spin_keeps_what_was_recorded_and_the_run_goes_on(
    tmp_path: Path, screens: list[Screen], undisturbed: dict[str, Any]
) -> None:
    screen = Screen(tmp_path, speed=300.0)
    screens.append(screen)
    screen.run.start()
    wait_until(lambda: screen.recording("sf_x_02"))
    with pytest.raises(InputError, match="A run is going on"):
        screen.run.start()
    screen.run.abort(Message("Stopped by the operator."))
    assert screen.end() == "aborted"
    outcome = screen.run.outcome
    assert outcome is not None
    assert isinstance(outcome.error, AbortedError)
    assert outcome.error.message.text() == "Stopped by the operator."
    assert_safe(screen.bench)
    kept = counted(screen.bundle)
    assert {"zo_x_1", "zo_x_3", "sf_x_before"} <= kept < SEGMENTS

    world_of(screen.bench).clock.speed = None
    screen.run.start()
    assert screen.end() == "done"
    assert counted(screen.bundle) == SEGMENTS
    assert_safe(screen.bench)
    assert_same_results(to_json(evaluate_bundle(screen.bundle)), undisturbed)


def test_a_pause_leaves_the_table_at_rest_and_goes_on(tmp_path: Path, screens: list[Screen]) -> None:
    screen = Screen(tmp_path, speed=300.0)
    screens.append(screen)
    screen.run.start()
    wait_until(lambda: screen.recording("sf_x_03"))
    screen.run.pause()
    wait_until(lambda: screen.run.state == "paused")
    assert not world_of(screen.bench).table.turning()
    assert "sf_x_03" in counted(screen.bundle)
    world_of(screen.bench).clock.speed = None
    screen.run.resume()
    assert screen.end() == "done"
    assert counted(screen.bundle) == SEGMENTS


def test_a_segment_is_repeated_with_a_reason_and_both_takes_are_kept(
    tmp_path: Path, screens: list[Screen]
) -> None:
    screen = Screen(tmp_path)
    screens.append(screen)
    screen.run.start()
    assert screen.end() == "done"
    with pytest.raises(InputError, match="Say why"):
        screen.run.repeat("sf_x_02", "  ")
    with pytest.raises(InputError, match="not recorded yet"):
        screen.run.repeat("sf_y_02", "the door slammed")
    screen.run.repeat("sf_x_02", "the door slammed")
    assert screen.end() == "done"
    assert counted(screen.bundle) == SEGMENTS
    assert (screen.bundle / "segments/sf_x_02.parquet").is_file()
    assert (screen.bundle / "segments/sf_x_02.2.parquet").is_file()
    assert "the door slammed" in (screen.bundle / "recording.toml").read_text(encoding="utf-8")


def test_a_unit_that_goes_silent_fails_the_run_and_it_goes_on_once_it_speaks(
    tmp_path: Path, screens: list[Screen]
) -> None:
    screen = Screen(tmp_path)
    screens.append(screen)
    world_of(screen.bench).faults.trigger("ahrs_silent", at_s=300.0)
    screen.run.start()
    assert screen.end() == "failed"
    assert screen.run.outcome is not None
    assert isinstance(screen.run.outcome.error, InstrumentError)
    assert_safe(screen.bench)
    world_of(screen.bench).faults.clear("ahrs_silent")
    screen.run.start()
    assert screen.end() == "done"
    assert counted(screen.bundle) == SEGMENTS


def test_a_disk_that_stays_full_to_the_end_is_told_and_leaves_a_recording_to_go_on_with(
    tmp_path: Path, screens: list[Screen], monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = Screen(tmp_path)
    screens.append(screen)
    written = 0

    def until_full(descriptor: int) -> None:
        nonlocal written
        written += 1
        if written > 12:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", until_full)
        screen.run.start()
        assert screen.end() == "failed"
    outcome = screen.run.outcome
    assert outcome is not None
    assert isinstance(outcome.error, MachineError)
    assert "is full" in outcome.error.message.text()
    assert_safe(screen.bench)
    screen.run.start()
    assert screen.end() == "done"
    assert counted(screen.bundle) == SEGMENTS


def test_a_folder_that_another_run_writes_is_refused_and_free_again_afterwards(
    tmp_path: Path, screens: list[Screen]
) -> None:
    first = Screen(tmp_path, ask=True)
    second = Screen(tmp_path)
    screens += [first, second]
    first.run.start()
    wait_until(lambda: bool(first.saw(MountRequested)))
    with pytest.raises(InputError, match="another instance"):
        second.run.start()
    first.run.abort(Message("Stopped by the operator."))
    assert first.end() == "aborted"
    second.run.start()
    assert second.end() == "done"
