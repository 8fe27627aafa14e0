"""A whole calibration on the fake bench: order, samples, news, pause, resume, repeat; and how a run ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.errors import AbortedError, MachineError
from ahrs_lab.messages import Message
from ahrs_lab.procedures import course
from ahrs_lab.procedures.events import (
    BenchReading,
    Event,
    MountingChecked,
    MountRequested,
    SegmentFinished,
    SegmentStarted,
    StateChanged,
    StepFinished,
    StepStarted,
    Warned,
)
from ahrs_lab.procedures.plan import Plan, PowerPlan
from ahrs_lab.recording.samples import GYRO
from tests.procedures.fake_bench import FakeBench, MemoryWriter
from tests.procedures.runs import SMALL, WHOLE, Run, is_safe


def states(run: Run) -> list[str]:
    return [event.state for event in run.events if isinstance(event, StateChanged)]


def test_a_whole_calibration_records_every_segment_in_six_mountings() -> None:
    run = Run(WHOLE)
    outcome = run.go()
    assert outcome.state == "done"
    assert outcome.segments == course.segment_names(WHOLE)
    assert len(outcome.segments) == 3 * (7 + 2 + 2 + 4)
    assert len(run.fake.operator.asked) == 6
    assert outcome.warnings == ()
    assert is_safe(run.fake)
    outcome.raise_error()


@pytest.mark.parametrize("step_s", [None, 0.37, 5.0])
def test_each_segment_has_the_samples_of_its_duration_whatever_the_step(step_s: float | None) -> None:
    run = Run(SMALL, FakeBench(step_s=step_s))
    assert run.go().state == "done"
    for segment in run.writer.segments:
        samples = run.writer.samples[segment.name]
        started = next(e for e in run.events if isinstance(e, SegmentStarted) and e.segment == segment)
        assert len(samples) == round(started.duration_s * 20.0)
        assert np.allclose(np.diff(samples["t_s"]), 0.05, rtol=0.0, atol=1e-9)
        if segment.role != "turns":
            up = segment.orientation.gravity_unit()
            assert np.allclose(samples.matrix(GYRO), segment.rate_dps * up, rtol=0.0, atol=1e-9)
            assert np.allclose(samples["table_rate_dps"], segment.rate_dps, rtol=0.0, atol=1e-9)


def test_the_steps_of_time_do_not_change_what_is_recorded() -> None:
    recorded = []
    for step_s in (None, 0.41):
        run = Run(SMALL, FakeBench(step_s=step_s))
        run.go()
        recorded.append({name: len(samples) for name, samples in run.writer.samples.items()})
    assert recorded[0] == recorded[1]


def test_turns_go_from_rest_to_rest_and_back_for_the_same_time() -> None:
    run = Run(SMALL)
    run.go()
    forward, back = run.writer.samples["ma_x_pos"], run.writer.samples["ma_x_neg"]
    assert len(forward) == len(back)
    for samples, turned in ((forward, 3600.0), (back, -3600.0)):
        assert float(np.sum(samples["gyro_x"]) * 0.05) == pytest.approx(turned, abs=1e-6)
        assert np.all(samples["gyro_x"][:20] == 0.0)
        assert np.all(samples["gyro_x"][-20:] == 0.0)
        # the log's last point may lie 20 ms from a sample at 100 °/s
        assert samples["table_angle_deg"][-1] - samples["table_angle_deg"][0] == pytest.approx(
            turned, abs=1e-6
        )


def test_the_tables_columns_are_those_of_the_samples_own_times() -> None:
    run = Run(SMALL)
    run.go()
    samples = run.writer.samples["sf_x_06"]  # 30 °/s
    turned = np.diff(samples["table_angle_deg"])
    assert np.allclose(turned, 30.0 * 0.05, rtol=0.0, atol=1e-6)


def test_whole_averaging_angles_are_recorded_at_each_rate() -> None:
    run = Run(SMALL)
    run.go()
    for segment in run.writer.segments:
        if segment.role == "rate":
            samples = run.writer.samples[segment.name]
            turned = abs(float(np.sum(samples["gyro_x"])) * 0.05)
            assert turned % 360.0 == pytest.approx(0.0, abs=1e-6)
            assert len(samples) >= 400


def test_power_goes_on_after_each_mounting_and_off_before_the_next() -> None:
    run = Run(SMALL)
    run.go()
    seen = [
        call.split()[0]
        for call in run.fake.calls.log
        if call.split()[0] in ("operator.mount", "supply.on", "supply.off")
    ]
    expected = ["supply.off", "operator.mount", "supply.on", "supply.off"] * 3 + ["supply.off"]
    assert seen == expected


def test_power_stays_on_between_mountings_where_the_plan_says_so() -> None:
    plan = replace(SMALL, power=replace(SMALL.power, off_between_mountings=False))
    run = Run(plan)
    outcome = run.go()
    assert outcome.state == "done"
    assert run.fake.calls.log.count("supply.on") == 1
    assert is_safe(run.fake)
    assert {segment.extra["power_cycle"] for segment in run.writer.segments} == {1}


def test_each_repeat_is_a_power_on_of_its_own_within_one_mounting() -> None:
    plan = replace(SMALL, repeats=2, items=("zero_offset",))
    run = Run(plan)
    assert run.go().state == "done"
    assert len(run.fake.operator.asked) == 2
    cycles = {segment.name: segment.extra["power_cycle"] for segment in run.writer.segments}
    assert cycles == {
        "zo_x_1": 1, "zo_x_3": 1, "zo_x_1_r2": 2, "zo_x_3_r2": 2,
        "zo_x_2": 3, "zo_x_4": 3, "zo_x_2_r2": 4, "zo_x_4_r2": 4,
    }  # fmt: skip


def test_the_case_is_mounted_with_the_table_at_north_and_at_rest() -> None:
    run = Run(SMALL)
    angles: list[tuple[float, bool]] = []

    def look() -> None:
        state = run.fake.table.state()
        angles.append((state.angle_deg % 360.0, state.moving))

    run.fake.operator.on_mount = look
    run.go()
    assert angles == [(0.0, False)] * 3


def test_positions_are_recorded_at_their_azimuth() -> None:
    run = Run(SMALL)
    run.go()
    for segment in run.writer.segments:
        if segment.role == "position":
            angle = run.writer.samples[segment.name]["table_angle_deg"]
            assert segment.azimuth_deg == (0.0 if segment.position in (1, 2) else 180.0)
            assert np.all(np.abs((angle - segment.azimuth_deg + 180.0) % 360.0 - 180.0) < 1e-9)


def test_news_come_in_order_and_steps_match_the_list() -> None:
    run = Run(SMALL)
    run.go()
    assert [e.step for e in run.events if isinstance(e, StepStarted)] == list(
        course.steps(SMALL, run.fake.table.limits)
    )
    assert len(run.told(StepFinished)) == len(run.told(StepStarted))
    assert not any(e.skipped for e in run.events if isinstance(e, StepFinished))
    assert states(run) == ["running", *["waiting", "running"] * 3, "done"]
    started = [e.segment.name for e in run.events if isinstance(e, SegmentStarted)]
    finished = [e.segment.name for e in run.events if isinstance(e, SegmentFinished)]
    assert started == finished == run.writer.finished
    assert len(run.told(MountRequested)) == 3
    assert all(e.accepted for e in run.events if isinstance(e, MountingChecked))


def test_readings_tell_the_time_left() -> None:
    run = Run(SMALL, FakeBench(step_s=None))
    run.go()
    readings = [e for e in run.events if isinstance(e, BenchReading)]
    assert readings
    total = sum(step.estimate_s for step in course.steps(SMALL, run.fake.table.limits))
    assert 0.0 < readings[0].remaining_s <= total


def test_notes_hold_what_the_certificate_needs() -> None:
    run = Run(SMALL)
    outcome = run.go()
    notes = run.writer.notes
    assert notes["order_run"] == list(outcome.segments)
    assert notes["environment"] == {
        "temperature_c": 20.0,
            "temperature_spread_c"
        : 0.0,
            "humidity_percent"
        : 50.0,
            "humidity_spread_percent"
        : 0.0,
    }  # fmt: skip
    assert notes["simulated"] is True
    assert notes["started_utc"] == "2026-03-02T08:00:00+00:00"
    assert notes["finished_utc"] > notes["started_utc"]
    assert Message.from_json(notes["deviations"][0]).text().startswith("Only these axes")
    segment = run.writer.segments[0]
    assert segment.started_utc.startswith("2026-03-02T08:0")
    assert segment.extra["temperature_c"] == 20.0
    assert segment.extra["supply_v"] == 12.0


def test_a_room_out_of_limits_is_told_once_and_noted() -> None:
    run = Run(SMALL)
    run.fake.room.temperature_c, run.fake.room.humidity_percent = 24.0, 20.0
    outcome = run.go()
    assert outcome.state == "done"
    said = [str(warned.what) for warned in outcome.warnings]
    assert len(said) == 2
    assert "24.0 °C, outside 17 to 23 °C" in said[0]
    assert "20 % relative humidity, outside 30 to 85 %" in said[1]
    assert len(run.writer.notes["run_warnings"]) == 2


# resume, repeat ─────────────────────────────────────────────────────────────────────────────────────────────


@pytest.mark.parametrize("kept", range(0, 16))
def test_a_run_that_is_resumed_records_the_rest_and_nothing_twice(kept: int) -> None:
    first = Run(SMALL)
    count = 0

    def stop(event: Event) -> None:
        nonlocal count
        count += isinstance(event, SegmentFinished)
        if count == kept and isinstance(event, SegmentStarted | SegmentFinished):
            first.runner.abort("enough")

    first.on_event = stop
    first.go()
    writer = first.writer
    assert len(writer.finished) == kept
    left = [name for name in course.segment_names(SMALL) if name not in writer.finished]
    again = Run(SMALL, writer=writer)
    outcome = again.go()
    assert outcome.state == "done"
    assert list(outcome.segments) == left
    assert sorted(writer.finished) == sorted(course.segment_names(SMALL))
    # asked for those mountings only that something is left of
    needed = list(dict.fromkeys(s.extra["mounting"] for s in writer.segments if s.name in left))
    assert again.fake.operator.asked == [o for o in Run(SMALL).mountings() if o in needed]
    finished = [event for event in again.events if isinstance(event, StepFinished)]
    assert [event.step.key for event in finished] == [step.key for step in course.steps(SMALL)]
    assert all(event.skipped == (event.step.estimate_s == 0.0) for event in finished)


def test_what_belongs_together_but_was_recorded_over_two_power_ons_is_told() -> None:
    run = Run(SMALL)

    def stop(event: Event) -> None:
        if isinstance(event, SegmentFinished) and event.segment.name == "sf_x_02":
            run.runner.abort("enough")

    run.on_event = stop
    assert run.go().warnings == ()
    outcome = Run(SMALL, writer=run.writer).go()
    assert [str(warned.what) for warned in outcome.warnings] == [
        "scale factor of X was recorded over 2 power-ons; the device's bias may differ between them."
    ]
    assert len(run.writer.notes["run_warnings"]) == 1


def test_a_finished_recording_is_not_run_again() -> None:
    run = Run(SMALL)
    run.go()
    again = Run(SMALL, writer=run.writer)
    assert again.go().segments == ()
    assert again.fake.operator.asked == []
    assert "supply.on" not in again.fake.calls.log


def test_a_repeated_segment_keeps_both_takes_with_the_reason() -> None:
    run = Run(SMALL)
    run.go()
    again = Run(SMALL, writer=run.writer)
    outcome = again.go(course.repeat(SMALL, "sf_x_03", again.fake.table.limits, reason="door slammed"))
    assert outcome.segments == ("sf_x_03",)
    assert again.fake.operator.asked == ["UEN"]
    takes = [s for s in run.writer.segments if s.name == "sf_x_03"]
    assert [(s.superseded, s.reason) for s in takes] == [(True, ""), (False, "door slammed")]
    assert takes[1].extra["power_cycle"] == 4
    assert run.writer.notes["order_run"][-1] == "sf_x_03"


def test_everything_from_a_segment_on_is_recorded_again() -> None:
    run = Run(SMALL)
    run.go()
    again = Run(SMALL, writer=run.writer)
    names = course.segment_names(SMALL)
    outcome = again.go(course.from_segment(SMALL, names[-3], again.fake.table.limits))
    assert outcome.segments == names[-3:]


# pause ──────────────────────────────────────────────────────────────────────────────────────────────────────


def test_a_pause_while_the_table_turns_waits_for_the_recording_and_stops_the_table() -> None:
    run = Run(SMALL)
    seen: list[tuple[bool, bool, list[str]]] = []

    def hear(event: Event) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == "sf_x_05":
            run.runner.pause()
        if isinstance(event, StateChanged) and event.state == "paused":
            state, supply = run.fake.table.state(), run.fake.supply.read()
            seen.append((state.moving, supply.output_on, run.writer.finished))
            run.runner.resume()

    run.on_event = hear
    outcome = run.go()
    assert outcome.state == "done"
    assert outcome.segments == course.segment_names(SMALL)
    [(moving, power, finished)] = seen
    assert not moving
    assert power
    assert finished[-1] == "sf_x_05"
    i = states(run).index("pausing")
    assert states(run)[i : i + 3] == ["pausing", "paused", "running"]
    assert np.allclose(run.writer.samples["sf_x_01"]["table_rate_dps"], -20.0)


def test_a_pause_can_be_taken_back_before_it_takes_effect() -> None:
    run = Run(SMALL)

    def hear(event: Event) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == "sf_x_before":
            run.runner.pause()
            run.runner.resume()

    run.on_event = hear
    assert run.go().state == "done"
    assert "paused" not in states(run)


def test_a_pause_asked_for_while_the_operator_mounts_takes_effect_afterwards() -> None:
    run = Run(SMALL)
    run.fake.operator.on_mount = run.runner.pause

    def hear(event: Event) -> None:
        if isinstance(event, StateChanged) and event.state == "paused":
            run.runner.resume()

    run.on_event = hear
    assert run.go().state == "done"
    assert states(run).count("paused") == 3


def test_a_paused_run_can_be_aborted() -> None:
    run = Run(SMALL)

    def hear(event: Event) -> None:
        if isinstance(event, SegmentStarted):
            run.runner.pause()
        if isinstance(event, StateChanged) and event.state == "paused":
            run.runner.abort(Message("lunch"))

    run.on_event = hear
    outcome = run.go()
    assert outcome.state == "aborted"
    assert str(outcome.message) == "lunch"
    assert states(run)[-2:] == ["aborting", "aborted"]
    assert is_safe(run.fake)


def test_every_place_can_be_paused_at_and_nothing_is_lost() -> None:
    run = Run(SMALL)

    def hear(event: Event) -> None:
        if isinstance(event, StateChanged) and event.state == "paused":
            assert not run.fake.table.state().moving
            run.runner.resume()
            run.runner.pause()

    run.on_event = hear
    run.runner.pause()
    run.fake.operator.on_mount = run.runner.pause
    outcome = run.go()
    assert outcome.segments == course.segment_names(SMALL)


# the end ────────────────────────────────────────────────────────────────────────────────────────────────────


def test_an_aborted_outcome_raises_what_the_person_said() -> None:
    run = Run(SMALL)
    run.runner.abort(Message("not today"))
    outcome = run.go()
    assert outcome.state == "aborted"
    assert "operator.mount" not in " ".join(run.fake.calls.log)
    with pytest.raises(AbortedError, match="not today"):
        outcome.raise_error()


def test_a_person_who_gives_up_at_the_mounting_ends_the_run() -> None:
    run = Run(SMALL)

    def give_up() -> None:
        raise AbortedError("The person went home.")

    run.fake.operator.on_mount = give_up
    outcome = run.go()
    assert (outcome.state, str(outcome.message)) == ("aborted", "The person went home.")
    assert is_safe(run.fake)


def test_a_listener_that_fails_leaves_a_safe_bench() -> None:
    run = Run(SMALL)
    run.expect_no_fault_of_ours = False

    def fail(event: Event) -> None:
        if isinstance(event, SegmentStarted | StateChanged) and run.writer.finished:
            raise KeyError("screen")

    run.on_event = fail
    outcome = run.go()
    assert outcome.state == "failed"
    assert isinstance(outcome.cause, KeyError)
    assert "not yours" in str(outcome.message)
    assert is_safe(run.fake)


def test_a_keyboard_interrupt_leaves_a_safe_bench() -> None:
    run = Run(SMALL)

    def press(event: Event) -> None:
        if isinstance(event, SegmentFinished) and event.segment.name == "sf_x_04":
            raise KeyboardInterrupt

    run.on_event = press
    with pytest.raises(KeyboardInterrupt):
        run.go()
    assert is_safe(run.fake)


def test_a_full_disk_ends_the_run_with_its_message_and_a_safe_bench() -> None:
    run = Run(SMALL)

    def fill(event: Event) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == "sf_x_01":
            run.writer.fails = MachineError("The disk is full.")

    run.on_event = fill
    outcome = run.go()
    assert (outcome.state, str(outcome.message)) == ("failed", "The disk is full.")
    assert outcome.segments == course.segment_names(SMALL)[: len(outcome.segments)]
    assert is_safe(run.fake)


def test_a_runner_runs_once() -> None:
    run = Run(SMALL)
    run.go()
    with pytest.raises(RuntimeError, match="done cannot start"):
        run.go()


def test_a_plan_that_the_table_cannot_run_touches_nothing() -> None:
    plan = replace(SMALL, misalignment=replace(SMALL.misalignment, rate_dps=500.0))
    run = Run(plan, writer=MemoryWriter())
    outcome = run.go()
    assert outcome.state == "failed"
    assert "may turn at 400" in str(outcome.message)
    assert "supply.on" not in run.fake.calls.log
    assert run.fake.operator.asked == []


def test_warnings_are_told_once() -> None:
    plan: Plan = replace(SMALL, items=("scale_factor",), power=PowerPlan(warm_up_s=0.0))
    run = Run(plan)
    run.fake.ahrs.description = replace(run.fake.ahrs.description, accel_unit="g")
    outcome = run.go()
    assert outcome.state == "done"
    assert ["look like m/s^2" in str(e.what) for e in run.events if isinstance(e, Warned)] == [True]
