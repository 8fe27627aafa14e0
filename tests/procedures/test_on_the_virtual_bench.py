"""The whole way on the virtual bench: plan → run → bundle on disk → resumed, repeated, reduced; and its
faults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError, MountingError
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.messages import Message
from ahrs_lab.procedures import course
from ahrs_lab.procedures.events import Event, SegmentFinished, SegmentStarted
from ahrs_lab.procedures.plan import Plan, load_plan
from ahrs_lab.procedures.reduction import reduce_recording
from ahrs_lab.procedures.runner import Runner, RunOutcome
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.segment import RecordingHeader
from ahrs_lab.recording.write import BundleWriter
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.bench import build_bench, world_of
from ahrs_lab.simulation.faults import FaultName
from ahrs_lab.simulation.presets import demonstration
from ahrs_lab.simulation.settings import OutputGroup, SimulationSettings
from ahrs_lab.simulation.truth import truth

ACCELERATED = load_plan(resource_path("plans/accelerated.toml"))
QUICK = replace(
    ACCELERATED,
    axes=("x",),
    settling=replace(ACCELERATED.settling, timeout_s=10.0),
    zero_offset=replace(ACCELERATED.zero_offset, schedule="combined", duration_s=20.0),
)


def run(
    folder: Path,
    bench: Bench,
    plan: Plan = QUICK,
    act: Callable[[Event, Runner], None] = lambda event, runner: None,
) -> RunOutcome:
    """Run ``plan`` into ``folder``, or go on with what is there."""
    header = RecordingHeader("jjf1536-2015", bench.site, bench.ahrs.description)
    there = (folder / "recording.toml").exists()
    with BundleWriter.resume(folder) if there else BundleWriter(folder, header) as writer:
        done = frozenset(s.name for s in writer.segments if not s.interrupted and not s.superseded)
        runner = Runner(bench, writer, lambda event: act(event, runner), lambda samples: None, plan)
        outcome = runner.run(course.calibration(plan, done, bench.table.limits))
    if outcome.cause is not None:
        raise outcome.cause
    return outcome


def is_off(bench: Bench) -> bool:
    return not bench.supply.read().output_on and not bench.table.state().moving


def test_the_accelerated_calibration_gives_the_truth_and_no_finding(tmp_path: Path) -> None:
    bench = build_bench(SimulationSettings.ideal())
    outcome = run(tmp_path / "run", bench, ACCELERATED)
    assert outcome.state == "done"
    assert is_off(bench)
    recording = read_bundle(tmp_path / "run")
    assert recording.findings == ()
    result = reduce_recording(recording)
    known = truth(bench)
    K = known.fitted_scale_factor(ACCELERATED.scale_factor.rates_dps)
    for i, axis in enumerate(("x", "y", "z")):
        assert pytest.approx(K[i], rel=1e-9) == result.scale_factor[axis].K  # type: ignore[index]
        assert pytest.approx(known.B_dps[i], abs=1e-9) == result.zero_offset[axis].B  # type: ignore[index]
    for key, value in known.L.items():
        assert pytest.approx(value, abs=1e-9) == result.misalignment[key].L


def test_the_combined_schedule_yields_all_three_axes(tmp_path: Path) -> None:
    bench = build_bench(demonstration())
    plan = replace(ACCELERATED, zero_offset=replace(ACCELERATED.zero_offset, schedule="combined"))
    assert run(tmp_path / "run", bench, plan).state == "done"
    result = reduce_recording(read_bundle(tmp_path / "run"))
    assert set(result.zero_offset) == {"x", "y", "z"}
    # X has its own four positions; the other two owe theirs to them
    assert {axis: offset.schedule for axis, offset in result.zero_offset.items() if axis != "x"} == {
        "y": "combined",
        "z": "combined",
    }
    assert any("combined schedule" in str(deviation) for deviation in result.deviations)
    assert result.environment is not None
    assert result.environment.temperature_c == pytest.approx(20.0, abs=3.0)


def test_the_multi_position_schedule_finds_the_earths_rate(tmp_path: Path) -> None:
    bench = build_bench(SimulationSettings.ideal())
    zero_offset = replace(ACCELERATED.zero_offset, schedule="multi-position", duration_s=20.0, positions=8)
    plan = replace(ACCELERATED, items=("zero_offset",), zero_offset=zero_offset)
    assert run(tmp_path / "run", bench, plan).state == "done"
    result = reduce_recording(read_bundle(tmp_path / "run"), trials=0)
    # an azimuth between quarter turns is no wrong mounting; without turns nothing is known of L
    assert ["its misalignment about" in warning.what.text() for warning in result.warnings] == [True] * 3
    for i, axis in enumerate(("x", "y", "z")):
        offset = result.zero_offset[axis]  # type: ignore[index]
        assert pytest.approx(truth(bench).B_dps[i], abs=1e-9) == offset.B
        assert offset.earth_rate_check is not None
        # 11.5382751 °/h at 39.9042° N
        assert offset.earth_rate_check["amplitude_dps"] * 3600.0 == pytest.approx(11.5382751, rel=1e-5)


@pytest.mark.parametrize(
    ("fault", "at_segment", "error", "fragment"),
    [
        ("table_trips", "sf_x_05", InstrumentError, "drive tripped"),
        ("ahrs_silent", "sf_x_05", InstrumentError, "has sent nothing"),
        ("table_never_settles", "sf_x_before", InstrumentError, "has not held"),
        ("table_ignores_commands", "sf_x_before", InstrumentError, "has not held"),
        ("table_ignores_commands", "ma_x_pos", InstrumentError, "were not completed"),
        ("supply_never_settles", None, InstrumentError, "has not settled"),
        ("wrong_mounting", None, MountingError, "mounted 3 times"),
    ],
)
def test_a_fault_of_the_bench_ends_safely_and_the_run_goes_on_once_it_is_mended(
    tmp_path: Path, fault: FaultName, at_segment: str | None, error: type[Exception], fragment: str
) -> None:
    bench = build_bench(demonstration())
    faults = world_of(bench).faults
    if at_segment is None:
        faults.trigger(fault)

    def act(event: Event, runner: Runner) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == at_segment:
            faults.trigger(fault)

    outcome = run(tmp_path / "run", bench, act=act)
    assert outcome.state == "failed"
    assert isinstance(outcome.error, error)
    assert fragment in str(outcome.error)
    assert is_off(bench)
    faults.clear(fault)
    kept = outcome.segments
    again = run(tmp_path / "run", bench)
    assert again.state == "done", again.message
    assert (*kept, *again.segments) == course.segment_names(QUICK)
    assert not [
        f for f in read_bundle(tmp_path / "run").findings if f.severity == "unusable" and not f.segment
    ]


def test_a_wrong_mounting_once_costs_one_more_mounting_and_no_data(tmp_path: Path) -> None:
    bench = build_bench(demonstration())
    world_of(bench).faults.trigger("wrong_mounting", once=True)
    outcome = run(tmp_path / "run", bench)
    assert outcome.state == "done"
    assert outcome.segments == course.segment_names(QUICK)


def test_dropouts_are_counted_and_told(tmp_path: Path) -> None:
    bench = build_bench(demonstration())
    world_of(bench).faults.trigger("ahrs_dropouts")
    lost: list[int] = []

    def act(event: Event, runner: Runner) -> None:
        if isinstance(event, SegmentFinished):
            lost.append(event.lost)

    outcome = run(tmp_path / "run", bench, act=act)
    assert outcome.state == "done"
    # one in ten of about a hundred a second
    assert all(0.07 < n / (n + len(r.samples)) < 0.13 for n, r in zip(lost, read_bundle(tmp_path /
        "run"
    ).segments, strict=True))  # fmt: skip
    assert any("were lost" in str(warned.what) for warned in outcome.warnings)


def test_a_room_out_of_limits_is_in_the_record(tmp_path: Path) -> None:
    bench = build_bench(demonstration())
    world_of(bench).faults.trigger("room_out_of_limits")
    outcome = run(tmp_path / "run", bench)
    assert outcome.state == "done"
    assert len(outcome.warnings) == 2
    environment = read_bundle(tmp_path / "run").header.notes["environment"]
    assert environment["temperature_c"] + environment["temperature_spread_c"] > 23.0
    result = reduce_recording(read_bundle(tmp_path / "run"))
    assert sum("6.2.1" in warning.what.text() for warning in result.warnings) == 2


@pytest.mark.parametrize("kept", [0, 1, 5, 9, 11, 14])
def test_a_run_killed_in_any_segment_leaves_the_same_set_when_it_is_resumed(
    tmp_path: Path, kept: int
) -> None:
    class Killed(BaseException):
        pass

    count = 0

    def kill(event: Event, runner: Runner) -> None:
        nonlocal count
        if isinstance(event, SegmentStarted):
            if count == kept:
                raise Killed
            count += 1

    with pytest.raises(Killed):
        run(tmp_path / "run", build_bench(demonstration()), act=kill)
    outcome = run(tmp_path / "run", build_bench(demonstration()))
    assert outcome.state == "done"
    recorded = [r.segment for r in read_bundle(tmp_path / "run").segments]
    counted = [s.name for s in recorded if not s.interrupted and not s.superseded]
    assert counted == list(course.segment_names(QUICK))
    assert len(outcome.segments) == len(counted) - kept


def test_a_repeated_segment_is_kept_twice_and_the_last_one_counts(tmp_path: Path) -> None:
    run(tmp_path / "run", build_bench(demonstration()))
    bench = build_bench(demonstration())
    with BundleWriter.resume(tmp_path / "run") as writer:
        runner = Runner(bench, writer, lambda event: None, lambda samples: None, QUICK)
        outcome = runner.run(course.repeat(QUICK, "zo_x_3", bench.table.limits, reason="a door"))
    assert outcome.segments == ("zo_x_3",)
    takes = [r.segment for r in read_bundle(tmp_path / "run").segments if r.segment.name == "zo_x_3"]
    assert [(take.superseded, take.file) for take in takes] == [
        (True, "segments/zo_x_3.parquet"),
        (False, "segments/zo_x_3.2.parquet"),
    ]
    assert takes[1].reason == "a door"


def test_a_second_instance_on_the_same_folder_is_refused(tmp_path: Path) -> None:
    bench = build_bench(demonstration())
    seen: list[InputError] = []

    def act(event: Event, runner: Runner) -> None:
        if isinstance(event, SegmentStarted) and not seen:
            with pytest.raises(InputError) as caught:
                BundleWriter.resume(tmp_path / "run")
            seen.append(caught.value)

    assert run(tmp_path / "run", bench, act=act).state == "done"
    assert seen


def test_a_case_turned_in_azimuth_is_felt_by_a_good_gyro_and_warned_of(tmp_path: Path) -> None:
    ideal = SimulationSettings.ideal()
    plan = replace(QUICK, items=("zero_offset",))
    for turned_deg, warned in ((0.0, False), (5.0, True), (-20.0, True)):
        settings = replace(ideal, table=replace(ideal.table, north_misalignment_arcsec=3600.0 * turned_deg))
        outcome = run(tmp_path / f"run{turned_deg:g}", build_bench(settings), plan)
        said = [str(w.what) for w in outcome.warnings if "Earth's rate" in str(w.what)]
        assert bool(said) == warned
        # the table stands anticlockwise by that much, which is clockwise by the opposite
        assert all(f"clockwise by {-turned_deg}°" in sentence for sentence in said)


def test_a_poor_gyro_is_not_asked_for_north(tmp_path: Path) -> None:
    settings = demonstration()
    settings = replace(settings, table=replace(settings.table, north_misalignment_arcsec=36000.0))
    outcome = run(tmp_path / "run", build_bench(settings), replace(QUICK, items=("zero_offset",)))
    assert outcome.state == "done"
    assert outcome.warnings == ()


def test_an_abort_keeps_what_was_recorded_and_the_bench_is_off(tmp_path: Path) -> None:
    bench = build_bench(demonstration())

    def act(event: Event, runner: Runner) -> None:
        if isinstance(event, SegmentStarted) and event.segment.name == "sf_x_06":
            runner.abort(Message("fire alarm"))

    outcome = run(tmp_path / "run", bench, act=act)
    assert (outcome.state, str(outcome.message)) == ("aborted", "fire alarm")
    assert is_off(bench)
    recording = read_bundle(tmp_path / "run")
    assert [r.segment.name for r in recording.segments if not r.segment.interrupted] == list(outcome.segments)
    assert recording.header.notes["order_run"] == list(outcome.segments)


@pytest.mark.parametrize(
    "outputs", [("rate", "accel"), ("increment", "accel"), ("attitude", "rate"), ("rate",)]
)
def test_whatever_the_unit_sends_is_recorded_and_its_mounting_checked_where_it_can_be(
    tmp_path: Path, outputs: tuple[OutputGroup, ...]
) -> None:
    ideal = SimulationSettings.ideal()
    settings = replace(ideal, device=replace(ideal.device, outputs=outputs))
    outcome = run(tmp_path / "run", build_bench(settings))
    assert outcome.state == "done", outcome.message
    by_word = any("operator's word" in str(w.what) for w in outcome.warnings)
    assert by_word == (outputs == ("rate",))


def test_the_tables_rate_over_a_dwell_is_the_demanded_one(tmp_path: Path) -> None:
    run(tmp_path / "run", build_bench(demonstration()))
    for recorded in read_bundle(tmp_path / "run").segments:
        if recorded.segment.role == "rate":
            t, angle = recorded.samples["t_s"], recorded.samples["table_angle_deg"]
            mean = (angle[-1] - angle[0]) / (t[-1] - t[0])
            # clause 6.1 for the table, and a step of the encoder at either end of twenty seconds
            assert mean == pytest.approx(recorded.segment.rate_dps, rel=2e-4, abs=1e-3)
            assert np.all(np.diff(angle) * np.sign(recorded.segment.rate_dps) > 0.0)
