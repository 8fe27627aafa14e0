"""What goes wrong at a bench: each trouble ends in a message that says what to do, a safe bench, and kept
data."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.errors import InstrumentError, MountingError
from ahrs_lab.messages import Message
from ahrs_lab.procedures import course
from ahrs_lab.procedures.commands import Procedure, Step
from ahrs_lab.procedures.events import (
    Activity,
    Event,
    MountingChecked,
    SegmentFinished,
    SegmentStarted,
    Warned,
)
from ahrs_lab.procedures.runner import RunOutcome
from ahrs_lab.procedures.settling import TableRunsAwayError
from tests.procedures.fake_bench import Array, FakeBench
from tests.procedures.runs import SMALL, Run, is_safe


def failed(run: Run, outcome: RunOutcome, *fragments: str) -> None:
    """Failed with this message, in a safe state, with what was recorded kept and its Chinese written."""
    assert outcome.state == "failed"
    assert isinstance(outcome.error, InstrumentError)
    said = str(outcome.error)
    assert all(fragment in said for fragment in fragments), said
    assert outcome.error.message.text("zh") != said
    assert is_safe(run.fake)
    assert run.writer.finished == list(outcome.segments)
    assert [s.name for s in run.writer.segments if not s.interrupted] == run.writer.finished


def at_segment(run: Run, name: str, act: Callable[[], None]) -> None:
    def hear(event: Event) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == name:
            act()

    run.on_event = hear


@pytest.mark.parametrize("step_s", [None, 0.5])
def test_a_table_fault_in_mid_spin(step_s: float | None) -> None:
    run = Run(SMALL, FakeBench(step_s=step_s))

    def trip() -> None:
        run.fake.table.fault = "axis limit"

    at_segment(run, "sf_x_05", trip)
    outcome = run.go()
    failed(run, outcome, "axis limit", "start the run again", "is kept")
    assert [s.name for s in run.writer.segments if s.interrupted] == ["sf_x_05"]
    assert run.writer.finished[-1] == "sf_x_02"  # −12 °/s, the rate before
    assert len(run.writer.samples["sf_x_05"]) > 0
    assert "axis limit" in run.writer.segments[-1].reason


def test_a_table_fault_while_it_settles() -> None:
    run = Run(SMALL)

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished) and event.segment.name == "sf_x_before":
            run.fake.table.fault = "drive"

    run.on_event = hear
    failed(run, run.go(), "drive")


def test_a_rate_that_is_never_reached() -> None:
    run = Run(SMALL)
    run.fake.table.rate_error_dps = 0.01
    failed(run, run.go(), "has not held 10 °/s within ±0.001 °/s for 2 s", "10.01 °/s", "widen")


@pytest.mark.parametrize("step_s", [None, 0.5])
@pytest.mark.parametrize(
    ("rate_error_dps", "said"), [(-40.0, "turns the wrong way"), (60.0, "turns too fast")]
)
def test_a_table_that_turns_as_nobody_demanded_ends_the_run_within_seconds(
    rate_error_dps: float, said: str, step_s: float | None
) -> None:
    run = Run(SMALL, FakeBench(step_s=step_s))
    table = run.fake.table
    demanded_s: list[float] = []

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished) and event.segment.name == "sf_x_before":
            table.rate_error_dps = rate_error_dps
        if isinstance(event, Activity) and "Rate settles" in str(event.what):
            demanded_s.append(run.fake.clock.now_s())

    run.on_event = hear
    outcome = run.go()
    failed(run, outcome, said, "emergency stop", "do not go near", "is kept")
    assert "widen" not in str(outcome.error)
    assert "sf_x_before" in run.writer.finished
    assert run.fake.clock.now_s() - demanded_s[0] < 5.0


def test_a_table_that_takes_no_demand_any_more_is_said_first_to_turn_still() -> None:
    run = Run(SMALL)

    def run_away() -> None:
        run.fake.table._go = lambda rate_dps: None  # type: ignore[method-assign]

    at_segment(run, "sf_x_02", run_away)  # at −12 °/s, the next is +12 °/s
    outcome = run.go()
    assert outcome.state == "failed"
    assert isinstance(outcome.error, TableRunsAwayError)
    assert str(outcome.error).startswith("The table could not be stopped (it is still turning)")
    assert "turns the wrong way: it turns at -12.0 °/s" in str(outcome.error)
    assert "急停" in outcome.error.message.text("zh")
    assert run.writer.finished[-1] == "sf_x_02"
    assert run.fake.calls.commands[-1] == "supply.off"


def test_a_table_that_does_not_turn_to_a_position() -> None:
    run = Run(SMALL)

    def stick() -> None:
        run.fake.table.sticks = True

    at_segment(run, "zo_x_1", stick)
    failed(run, run.go(), "has not come to rest at 180.0°", "it is at 0.0°")


def test_turns_that_are_not_completed_do_not_count() -> None:
    run = Run(SMALL)

    def stick() -> None:
        run.fake.table.sticks = True

    at_segment(run, "ma_x_pos", stick)
    failed(run, run.go(), "10 turns of ma_x_pos were not completed", "instead of")
    assert run.writer.segments[-1].interrupted


def test_a_table_that_does_not_stop_is_braked() -> None:
    run = Run(SMALL)

    def run_away() -> None:
        run.fake.table._go = lambda rate_dps: None  # type: ignore[method-assign]

    at_segment(run, "sf_x_05", run_away)
    outcome = run.go()
    assert outcome.state == "failed"
    assert "table.disable" in run.fake.calls.commands[-4:]
    assert run.fake.calls.commands[-1] == "supply.off"
    assert any("could not be stopped" in str(w.what) for w in outcome.warnings)


@pytest.mark.parametrize("swing", [0.05, 0.5])
def test_a_supply_current_that_never_settles(swing: float) -> None:
    run = Run(SMALL)
    run.fake.supply.current_a = lambda seconds: 0.2 * (1.0 + swing * np.sin(seconds))
    failed(run, run.go(), "not settled within 20 s", "widen power.current_tolerance")
    assert run.writer.segments == ()


def test_a_current_that_settles_late_is_waited_for() -> None:
    run = Run(SMALL)
    run.fake.supply.current_a = lambda seconds: 0.2 + np.exp(-seconds)
    assert run.go().state == "done"


def test_a_device_that_draws_no_current() -> None:
    run = Run(SMALL)
    run.fake.supply.current_a = lambda seconds: 0.0
    failed(run, run.go(), "draws no current", "check the power cable")


def test_a_supply_that_trips_while_recording() -> None:
    run = Run(SMALL, FakeBench(step_s=1.0))

    def trip() -> None:
        run.fake.supply.trips_at_s = run.fake.clock.now_s() + 3.0

    at_segment(run, "sf_x_before", trip)
    failed(run, run.go(), "switched its output off", "current limit")


@pytest.mark.parametrize("step_s", [None, 0.25])
def test_a_device_that_goes_silent(step_s: float | None) -> None:
    run = Run(SMALL, FakeBench(step_s=step_s))

    def silence() -> None:
        run.fake.ahrs.silent_from_s = run.fake.clock.now_s() + 7.0

    at_segment(run, "sf_x_05", silence)
    failed(run, run.go(), "has sent nothing for", "data cable", "is kept")
    assert run.writer.segments[-1].interrupted
    assert 139 <= len(run.writer.samples["sf_x_05"]) <= 140  # whole intervals within the seven seconds


def test_a_silence_is_noticed_within_moments_on_a_bench_in_real_time() -> None:
    run = Run(SMALL, FakeBench(step_s=0.1))

    def silence() -> None:
        run.fake.ahrs.silent_from_s = run.fake.clock.now_s() + 2.0
        run.fake.ahrs.device_time_zero_s += run.fake.clock.now_s()

    at_segment(run, "zo_x_1", silence)
    start = 0.0

    def hear(event: Event) -> None:
        nonlocal start
        if isinstance(event, SegmentStarted) and event.segment.name == "zo_x_1":
            start = run.fake.clock.now_s()
            run.fake.ahrs.silent_from_s = start + 2.0

    run.on_event = hear
    run.go()
    assert run.fake.clock.now_s() - start < 2.0 + 1.0 + 0.3


def test_a_device_that_never_sends() -> None:
    run = Run(SMALL)
    run.fake.ahrs.silent_from_s = 0.0
    failed(run, run.go(), "has sent nothing for")
    assert run.writer.segments == ()


def test_a_silence_between_two_arrivals_counts_as_well() -> None:
    run = Run(SMALL)
    run.fake.ahrs.lose = lambda number: (number > 2000) & (number < 2040)  # two seconds
    failed(run, run.go(), "has sent nothing for 2")


def test_lost_samples_are_counted_and_told() -> None:
    run = Run(SMALL)
    run.fake.ahrs.lose = lambda number: number % 100 == 50
    outcome = run.go()
    assert outcome.state == "done"
    told = {e.segment.name: e for e in run.events if isinstance(e, SegmentFinished)}
    # 400 samples have four or, where they begin between, four again of every hundred
    assert told["sf_x_before"].lost == 4
    assert told["sf_x_before"].samples == 396
    assert any("4 of 400 samples" in str(e.what) for e in run.events if isinstance(e, Warned))


def test_a_late_link_shifts_nothing_but_the_waiting() -> None:
    run = Run(SMALL, FakeBench(step_s=0.3))
    run.fake.ahrs.latency_s = 0.12
    assert run.go().state == "done"
    for segment in run.writer.segments:
        if segment.role == "rate":
            samples = run.writer.samples[segment.name]
            assert np.allclose(samples["gyro_x"], segment.rate_dps)


# mounting ───────────────────────────────────────────────────────────────────────────────────────────────────


def test_a_wrong_mounting_is_refused_and_asked_for_again() -> None:
    run = Run(SMALL)
    first = run.mountings()[0]
    run.fake.operator.instead = ["NUE"]  # Y up
    outcome = run.go()
    assert outcome.state == "done"
    assert run.fake.operator.asked[:2] == [first, first]
    refused, *others = [e for e in run.events if isinstance(e, MountingChecked)]
    assert (refused.feels, refused.accepted) == ("y+", False)
    assert refused.tilt_deg == pytest.approx(90.0)
    assert "The sensor feels Y up (tilt 90.0°)" in str(refused.message)
    assert all(other.accepted for other in others)
    # power was off while the case was flipped again
    calls = [c for c in run.fake.calls.log if c.split()[0] in ("operator.mount", "supply.on", "supply.off")]
    second = [i for i, call in enumerate(calls) if call.startswith("operator.mount")][1]
    assert calls[second - 1] == "supply.off"
    assert calls[second + 1] == "supply.on"


def test_three_wrong_mountings_end_the_run() -> None:
    run = Run(SMALL)
    run.fake.operator.instead = ["NUE"] * 9
    outcome = run.go()
    failed(run, outcome, "mounted 3 times", "The sensor feels Y up", "check the fixture")
    assert isinstance(outcome.error, MountingError)
    assert len(run.fake.operator.asked) == 3
    assert run.writer.segments == ()


def test_a_case_that_slips_before_a_position_is_noticed_and_mounted_again() -> None:
    run = Run(SMALL)

    def slip() -> None:
        from ahrs_lab.recording.orientation import Orientation

        run.fake.ahrs.orientation = Orientation("NUE")

    def hear(event: Event) -> None:
        if isinstance(event, SegmentFinished) and event.segment.name == "zo_x_1":
            slip()

    run.on_event = hear
    outcome = run.go()
    assert outcome.state == "done"
    assert len(run.fake.operator.asked) == 4
    angle = run.writer.samples["zo_x_3"]["table_angle_deg"]
    assert np.all(np.abs(angle % 360.0 - 180.0) < 1e-9)


def test_a_case_that_shakes_is_looked_at_again_until_it_is_still() -> None:
    run = Run(SMALL)

    def shake(t: Array) -> Array:
        return np.where(t < 15.0, 5.0 * np.sin(t), 0.0)

    run.fake.ahrs.extra_rate = shake
    assert run.go().state == "done"
    checked = [e for e in run.events if isinstance(e, MountingChecked)]
    assert not checked[0].accepted
    assert "not still" in str(checked[0].message)
    assert len(run.fake.operator.asked) == 3


# stopping ───────────────────────────────────────────────────────────────────────────────────────────────────


def indices() -> list[int]:
    """Every command of the small plan."""
    commands = [c for c in course.calibration(SMALL) if not isinstance(c, Step)]
    return list(range(len(commands)))


@pytest.mark.parametrize("index", indices())
def test_an_abort_before_any_command_leaves_a_safe_bench(index: int) -> None:
    run = Run(SMALL)
    left = index

    def count(procedure: Procedure) -> Procedure:
        nonlocal left
        outcome: object = None
        while True:
            try:
                item = procedure.send(outcome)
            except StopIteration:
                return
            if not isinstance(item, Step):
                if left == 0:
                    run.runner.abort(Message("stop"))
                left -= 1
            outcome = yield item

    outcome = run.go(count(course.calibration(SMALL, limits=run.fake.table.limits)))
    assert outcome.state == "aborted"
    assert is_safe(run.fake)
    assert run.writer.finished == list(outcome.segments)
    assert outcome.segments == course.segment_names(SMALL)[: len(outcome.segments)]


@pytest.mark.parametrize("wait", range(0, 200, 3))
def test_an_abort_within_any_wait_leaves_a_safe_bench(wait: int) -> None:
    run = Run(SMALL, FakeBench(step_s=2.0))
    left = wait

    def count() -> None:
        nonlocal left
        if left == 0:
            run.runner.abort(Message("stop"))
        left -= 1

    run.fake.clock.on_wait = count
    outcome = run.go()
    assert outcome.state == "aborted"
    assert run.fake.clock.interrupts == 1
    assert is_safe(run.fake)


@pytest.mark.parametrize("error", [InstrumentError("broken"), OSError("port closed"), ValueError("odd")])
@pytest.mark.parametrize("name", ["table", "ahrs", "supply", "supply.off", "table.stop", "ahrs.stop"])
@pytest.mark.parametrize("after", [3, 40, 130])
def test_whatever_an_instrument_throws_the_others_are_made_safe(
    name: str, error: Exception, after: int
) -> None:
    run = Run(SMALL)
    run.expect_no_fault_of_ours = False
    left = after

    def throw(call: str) -> None:
        nonlocal left
        left -= 1
        if left < 0 and call.startswith(name):
            raise error

    run.fake.calls.before = throw
    outcome = run.go()
    assert outcome.state == "failed"
    commands = run.fake.calls.commands
    assert commands[-1] == "supply.off"
    assert "table.stop" in commands[-5:]
    run.fake.calls.before = lambda call: None
    if not name.startswith("supply"):
        assert not run.fake.supply.read().output_on
    if not name.startswith("table"):
        assert not run.fake.table.state().moving
    if name in ("table", "table.stop", "supply", "supply.off"):
        assert any("could not" in str(w.what) for w in outcome.warnings)


def test_an_instrument_that_never_answers_does_not_keep_the_supply_on() -> None:
    run = Run(SMALL)
    run.runner._answer_limit_s = 0.05
    held, release, outcomes = threading.Event(), threading.Event(), []

    def hang(call: str) -> None:
        if call == "table.stop" and "sf_x_00" in run.writer.finished:  # the last rate: the table still turns
            held.set()
            release.wait()

    run.fake.calls.before = hang
    thread = threading.Thread(target=lambda: outcomes.append(run.go()))
    thread.start()
    try:
        assert held.wait(10.0)
        run.runner.abort(Message("stop"))
        off = threading.Event()
        for _ in range(1000):
            if not run.fake.supply.read().output_on:
                off.set()
                break
            off.wait(0.01)
        assert off.is_set(), "the supply stays on while the table does not answer"
        assert "table.disable" in run.fake.calls.commands
    finally:
        release.set()
        thread.join()
    assert outcomes[0].state == "aborted"
    assert is_safe(run.fake)


def test_an_instrument_that_never_answers_at_the_end_is_told() -> None:
    run = Run(SMALL)
    run.runner._answer_limit_s = 0.05
    release = threading.Event()

    def hang(call: str) -> None:
        if call == "table.stop" and run.runner.state == "aborting":
            release.wait()

    run.fake.calls.before = hang
    at_segment(run, "sf_x_04", lambda: run.runner.abort(Message("stop")))
    try:
        outcome = run.go()
        assert not run.fake.supply.read().output_on
    finally:
        release.set()
    assert outcome.state == "aborted"
    assert any("no answer within 0.05 s" in str(w.what) for w in outcome.warnings)


def test_an_abort_from_another_thread_ends_a_wait_that_is_going_on() -> None:
    fake = FakeBench(step_s=1.0)
    waiting, woken = threading.Event(), threading.Event()

    class BlockingClock(type(fake.clock)):  # type: ignore[misc]
        def wait(self, seconds: float) -> None:
            if not woken.is_set() and run.writer.finished:
                waiting.set()
                assert woken.wait(10.0), "the wait was not interrupted"
            super().wait(seconds)

        def interrupt(self) -> None:
            super().interrupt()
            woken.set()

    clock = BlockingClock(1.0)
    fake.clock = fake.table._clock = fake.ahrs._clock = fake.supply._clock = fake.room.clock = clock
    run = Run(SMALL, fake)

    def abort() -> None:
        assert waiting.wait(10.0)
        run.runner.abort(Message("other thread"))

    thread = threading.Thread(target=abort)
    thread.start()
    outcome = run.go()
    thread.join()
    assert (outcome.state, str(outcome.message)) == ("aborted", "other thread")
    assert is_safe(fake)


def test_an_abort_releases_an_operator_who_can_be_interrupted() -> None:
    fake = FakeBench()
    released = threading.Event()

    class Person:
        def mount(self, orientation: object, previous: object) -> None:
            from ahrs_lab.errors import AbortedError

            assert released.wait(10.0)
            raise AbortedError("released")

        def interrupt(self) -> None:
            released.set()

    fake.operator = Person()  # type: ignore[assignment]
    run = Run(SMALL, fake)
    thread = threading.Thread(target=lambda: run.runner.abort(Message("stop")))

    def hear(event: Event) -> None:
        if type(event).__name__ == "MountRequested":
            thread.start()

    run.on_event = hear
    outcome = run.go()
    thread.join()
    assert outcome.state == "aborted"
    assert is_safe(fake)


def test_a_run_goes_on_after_its_trouble_is_over() -> None:
    run = Run(SMALL)

    def trip() -> None:
        run.fake.table.fault = "drive"

    at_segment(run, "ma_x_neg", trip)
    run.go()
    run.fake.table.fault = ""
    again = Run(SMALL, run.fake, run.writer)
    assert again.go().state == "done"
    assert sorted(run.writer.finished) == sorted(course.segment_names(SMALL))
    assert [s.name for s in run.writer.segments if s.interrupted] == ["ma_x_neg"]


def test_power_kept_on_does_not_hide_a_wrong_mounting() -> None:
    run = Run(replace(SMALL, power=replace(SMALL.power, off_between_mountings=False)))
    run.fake.operator.instead = [run.mountings()[0], "NUE"]
    assert run.go().state == "done"
    assert len(run.fake.operator.asked) == 4
    assert run.fake.calls.log.count("supply.on") == 1
