"""The reduction of a recording finds the truth of the unit that made it."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ahrs_lab.certificates.charts import position_blocks
from ahrs_lab.certificates.documents import Chart
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, ZeroOffsetResult
from ahrs_lab.procedures import reduction
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.read import RecordedSegment, read_bundle
from tests.procedures.virtual_unit import EARTH_DPS, VirtualUnit, changed, without

reduce_recording = partial(reduction.reduce_recording, trials=0)
"""Without the Monte Carlo check, which has tests of its own."""

SAMPLE = {
    "K": {"x": 1.0023354972170277, "y": 0.9981303779047173, "z": 1.0007446457794191},
    "B": {"x": 3.087392621666639e-3, "y": -2.3500235037499885e-3, "z": 1.805527627916662e-3},
    "L": {
        "yx": -2.6885030749999997e-4,
        "zx": 3.9153196791666666e-4,
        "xy": 6.027772040277779e-4,
        "zy": -7.190909452777777e-4,
        "xz": -4.287619295833333e-4,
        "yz": 8.788338404166666e-4,
    },
}
"""interfaces.md, printed; made outside this project."""


def random_unit(rng: np.random.Generator) -> VirtualUnit:
    return VirtualUnit(
        K=rng.uniform(0.9, 1.1, 3).tolist(),
        B=rng.uniform(-0.1, 0.1, 3).tolist(),
        L=dict(zip(MISALIGNMENT_KEYS, rng.uniform(-0.02, 0.02, 6).tolist(), strict=True)),
        latitude_deg=float(rng.uniform(-90.0, 90.0)),
    )


def test_the_sample_gives_the_printed_numbers(shared: Path) -> None:
    result = reduce_recording(read_bundle(shared / "samples" / "mems-unit-a"))
    assert {a: r.K for a, r in result.scale_factor.items()} == pytest.approx(SAMPLE["K"], rel=1e-10, abs=0.0)
    assert {a: r.B for a, r in result.zero_offset.items()} == pytest.approx(SAMPLE["B"], rel=1e-10, abs=0.0)
    assert {k: r.L for k, r in result.misalignment.items()} == pytest.approx(SAMPLE["L"], rel=1e-10, abs=0.0)
    assert [r.duration_s for r in result.zero_offset.values()] == pytest.approx([600.0] * 3)


def test_the_sample_warns_of_every_rate_that_is_no_whole_averaging_angle(shared: Path) -> None:
    result = reduce_recording(read_bundle(shared / "samples" / "mems-unit-a"))
    # 30 s at 10, 50, 100, 200 °/s end inside a turn, at 300 °/s they do not
    files = {warning.segment for warning in result.warnings}
    assert files == {f"segments/sf_{axis}_{index:02}.csv" for axis in AXES for index in range(1, 9)}


def test_the_sample_shows_the_noise_it_was_made_with(shared: Path) -> None:
    result = reduce_recording(read_bundle(shared / "samples" / "mems-unit-a"))
    for zero_offset in result.zero_offset.values():
        rows = [row for row in zero_offset.uncertainty.rows if row.symbol.startswith("N_")]
        # 0.15 °/√h over 600 s
        assert [row.standard_uncertainty for row in rows] == pytest.approx(
            [0.15 / 60.0 * 600.0**0.5] * 4, rel=0.05
        )


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_thousand_random_noiseless_units_are_recovered() -> None:
    rng = np.random.default_rng(1536)
    for _ in range(1000):
        unit = random_unit(rng)
        result = reduce_recording(unit.standard())
        assert [result.scale_factor[a].K for a in AXES] == pytest.approx(list(unit.K), rel=1e-9)
        assert [result.zero_offset[a].B for a in AXES] == pytest.approx(list(unit.B), abs=1e-9)
        assert {k: r.L for k, r in result.misalignment.items()} == pytest.approx(unit.L, abs=1e-9)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.floats(10.0, 1e6))
def test_radians_and_counts_tell_the_same_as_degrees(seed: int, counts_per_dps: float) -> None:
    in_degrees = random_unit(np.random.default_rng(seed))
    expected = reduce_recording(in_degrees.standard())
    in_degrees.rate_unit, in_degrees.shown_per_dps = "rad/s", (np.pi / 180.0,) * 3
    in_radians = reduce_recording(in_degrees.standard())
    in_degrees.rate_unit, in_degrees.shown_per_dps = "LSB", (counts_per_dps,) * 3
    in_counts = reduce_recording(in_degrees.standard())
    for axis in AXES:
        K = expected.scale_factor[axis].K
        assert pytest.approx(np.radians(K), rel=1e-9) == in_radians.scale_factor[axis].K
        assert pytest.approx(K * counts_per_dps, rel=1e-9) == in_counts.scale_factor[axis].K
        assert pytest.approx(expected.zero_offset[axis].B, abs=1e-12) == in_radians.zero_offset[axis].B
        # counts are scaled by the fitted K, degrees are not
        assert pytest.approx(expected.zero_offset[axis].B / K, abs=1e-12) == in_counts.zero_offset[axis].B
    for key, result in expected.misalignment.items():
        assert pytest.approx(result.L, abs=1e-12) == in_radians.misalignment[key].L
        K = expected.scale_factor[result.output_axis].K
        assert pytest.approx(result.L / K, abs=1e-12) == in_counts.misalignment[key].L
    assert in_degrees.rate_unit == "LSB"
    assert {r.unit for r in in_counts.scale_factor.values()} == {"LSB/(deg/s)"}
    assert {r.unit for r in in_radians.scale_factor.values()} == {"(rad/s)/(deg/s)"}


def test_a_constant_bias_does_not_reach_the_misalignment() -> None:
    unit = VirtualUnit(L={"yx": 1e-3, "zx": -2e-3})
    without_bias = reduce_recording(unit.recording(unit.turns("x")))
    unit.B = (0.5, -0.4, 0.3)
    with_bias = reduce_recording(unit.recording(unit.turns("x")))
    for key in ("yx", "zx"):
        assert pytest.approx(without_bias.misalignment[key].L, abs=1e-14) == with_bias.misalignment[key].L


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("latitude_deg", [-60.0, 0.0, 39.9, 90.0])
def test_the_earths_rate_does_not_reach_the_zero_offset_of_four_positions(
    axis: str, latitude_deg: float
) -> None:
    unit = VirtualUnit(
        B=(1e-3, 2e-3, 3e-3), latitude_deg=latitude_deg, L={"xy": 5e-3, "yz": 4e-3, "zx": 3e-3}
    )
    result = reduce_recording(unit.recording(unit.positions(axis)))  # type: ignore[arg-type]
    found = result.zero_offset[axis]  # type: ignore[index]
    assert pytest.approx(unit.B[AXES.index(axis)], abs=1e-15) == found.B
    assert found.schedule == "standard"


def test_four_positions_of_one_axis_give_all_three_where_the_plan_is_the_combined_one() -> None:
    unit = VirtualUnit(B=(1e-3, 2e-3, -3e-3), L={"xy": 5e-3, "yz": 4e-3, "zx": 3e-3})
    plan = {"zero_offset": {"schedule": "combined"}}
    result = reduce_recording(unit.recording(unit.positions("x"), plan=plan))
    assert [result.zero_offset[a].B for a in AXES] == pytest.approx(list(unit.B), abs=1e-15)
    assert [result.zero_offset[a].schedule for a in AXES] == ["standard", "combined", "combined"]


def test_without_that_plan_they_give_the_one_that_was_asked() -> None:
    unit = VirtualUnit()
    assert set(reduce_recording(unit.recording(unit.positions("y"))).zero_offset) == {"y"}


def test_multi_position_states_what_a_misaligned_axis_feels_of_the_vertical_rate() -> None:
    """With Z up (table 2 of X) L_xz of the vertical rate is the same at every azimuth: B is off by it."""
    unit = VirtualUnit(B=(1e-3, 0.0, 0.0), L={"xz": 2e-3, "xy": 5e-3}, latitude_deg=30.0)
    lets_in = 2e-3 * EARTH_DPS * math.sin(math.radians(30.0))
    alone = reduce_recording(unit.recording(unit.azimuths("x")))
    assert pytest.approx(lets_in, rel=1e-6) == alone.zero_offset["x"].B - 1e-3
    (said,) = [one.what for one in alone.warnings if "was not measured" in one.what.text()]
    assert said.text().startswith("zero offset X: its misalignment about Z")
    known = reduce_recording(unit.recording([*unit.azimuths("x"), *unit.turns("z")]))
    assert not [one for one in known.warnings if "was not measured" in one.what.text()]
    row = next(row for row in known.zero_offset["x"].uncertainty.rows if row.symbol == "λ")
    assert row.contribution * math.sqrt(3.0) == pytest.approx(lets_in, rel=1e-6)
    assert known.zero_offset["x"].B == alone.zero_offset["x"].B


@pytest.mark.parametrize("axis", AXES)
def test_multi_position_shows_the_horizontal_earth_rate_and_its_azimuth(axis: str) -> None:
    unit = VirtualUnit(B=(1e-3, 2e-3, -3e-3), latitude_deg=30.0)
    made = unit.azimuths(axis, 12)  # type: ignore[arg-type]
    found = reduce_recording(unit.recording(made)).zero_offset[axis]  # type: ignore[index]
    assert pytest.approx(unit.B[AXES.index(axis)], abs=1e-15) == found.B
    assert found.schedule == "multi-position"
    assert found.earth_rate_check is not None
    assert found.earth_rate_check["amplitude_dps"] == pytest.approx(EARTH_DPS * np.cos(np.radians(30.0)))
    assert found.earth_rate_check["expected_dps"] == pytest.approx(EARTH_DPS * np.cos(np.radians(30.0)))
    assert found.earth_rate_check["phase_deg"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("axis", AXES)
def test_the_curve_of_the_earths_rate_runs_through_the_positions(axis: str) -> None:
    unit = VirtualUnit(B=(1e-3, 2e-3, -3e-3), latitude_deg=30.0)
    made = unit.azimuths(axis, 12)  # type: ignore[arg-type]
    result = reduce_recording(unit.recording(made))
    chart = next(block for block in position_blocks(result, "en") if isinstance(block, Chart))
    (panel,) = chart.panels
    azimuths, rates = zip(*panel.curve, strict=True)
    assert np.interp(panel.x, azimuths, rates) == pytest.approx(panel.y, abs=0.02)  # °/h; its steps are 4.6°
    assert max(rates) == pytest.approx(3600.0 * EARTH_DPS * np.cos(np.radians(30.0)), rel=1e-3)


def _cycle(made: RecordedSegment, number: int, *, power_off: bool) -> RecordedSegment:
    extra = {"repeat": number, "power_cycle": number if power_off else 1}
    name = f"{made.segment.name}_r{number}"
    return replace(made, segment=replace(made.segment, name=name, extra=extra))


def test_repeats_with_power_off_between_give_the_repeatability() -> None:
    offsets = (1.0e-3, 1.6e-3, 0.7e-3)

    def found(*, power_off: bool) -> ZeroOffsetResult:
        made = []
        for number, offset in enumerate(offsets, start=1):
            unit = VirtualUnit(B=(offset, 0.0, 0.0))
            made += [_cycle(one, number, power_off=power_off) for one in unit.positions("x")]
        return reduce_recording(VirtualUnit().recording(made)).zero_offset["x"]

    scattered = found(power_off=True)
    assert scattered.repeatability_dps == pytest.approx(statistics.stdev(offsets), rel=1e-9)
    assert scattered.repeatability_cycles == 3
    assert pytest.approx(statistics.mean(offsets), rel=1e-9) == scattered.B
    powered = found(power_off=False)
    assert powered.repeatability_cycles == 0
    assert powered.repeatability_dps is None  # no noise, no Allan deviation


def test_u_of_b_includes_the_repeatability_where_the_job_asks() -> None:
    offsets = (1.0e-3, 1.6e-3, 0.7e-3, 1.2e-3)
    made = []
    for number, offset in enumerate(offsets, start=1):
        unit = VirtualUnit(B=(offset, 0.0, 0.0))
        made += [_cycle(one, number, power_off=True) for one in unit.positions("x")]
    recording = VirtualUnit().recording(made)
    without, asked = (
        reduce_recording(recording, repeatability=asked, trials=100_000).zero_offset["x"]
        for asked in (False, True)
    )
    assert asked.B == without.B
    assert (without.repeatability_included, asked.repeatability_included) == (False, True)
    spread = statistics.stdev(offsets)
    row = next(row for row in asked.uncertainty.rows if row.symbol == "R")
    assert row.standard_uncertainty == pytest.approx(spread)
    assert row.dof == 3.0
    assert asked.uncertainty.standard == pytest.approx(np.hypot(without.uncertainty.standard, spread))
    # t of 3 degrees of freedom at 95 %, but for the little that the bench adds
    assert 3.0 < asked.uncertainty.coverage_factor < 3.183
    # the trials draw it too: were it left out of their model, they would find the narrow U
    check = asked.uncertainty.monte_carlo
    assert check is not None
    assert check.symmetric[1] - check.symmetric[0] == pytest.approx(
        2.0 * asked.uncertainty.expanded, rel=0.04
    )


def test_the_method_of_annex_a_stays_as_printed() -> None:
    made = []
    for number, offset in enumerate((1.0e-3, 1.6e-3, 0.7e-3), start=1):
        unit = VirtualUnit(B=(offset, 0.0, 0.0))
        made += [_cycle(one, number, power_off=True) for one in unit.positions("x")]
    recording = VirtualUnit().recording(made)
    asked = reduce_recording(recording, uncertainty="annex-a", repeatability=True).zero_offset["x"]
    assert not asked.repeatability_included


def test_outputs_that_belong_to_other_axes_give_no_result() -> None:
    unit = VirtualUnit(L={"yx": 1.5, "xy": 0.4})
    result = reduce_recording(unit.recording([*unit.rates("x"), *unit.turns("x"), *unit.turns("y")]))
    said = " ".join(warning.what.text() for warning in result.warnings)
    assert result.scale_factor == {}
    assert "scale factor x is not evaluated: the turns about it show on output Y" in said
    assert set(result.misalignment) == {"zx", "xy", "zy"}
    assert "misalignment yx is not evaluated: it would be 1.5 rad" in said


def test_the_order_of_recording_does_not_matter() -> None:
    unit = random_unit(np.random.default_rng(3))
    recording = unit.standard()
    backwards = unit.recording(recording.segments[::-1])
    first, second = reduce_recording(recording), reduce_recording(backwards)
    for axis in AXES:
        assert pytest.approx(first.scale_factor[axis].K, rel=1e-13) == second.scale_factor[axis].K
        assert pytest.approx(first.zero_offset[axis].B, abs=1e-15) == second.zero_offset[axis].B
    for key in MISALIGNMENT_KEYS:
        assert second.misalignment[key].L == first.misalignment[key].L


def test_rates_as_the_table_measured_them() -> None:
    unit = VirtualUnit(K=(1.01, 1.0, 1.0), table_error=1e-3)
    recording = unit.recording(unit.rates("x", duration_s=40.0))
    assert pytest.approx(1.01 * 1.001, rel=1e-6) == reduce_recording(recording).scale_factor["x"].K
    measured = reduce_recording(recording, rates="table").scale_factor["x"]
    assert pytest.approx(1.01, rel=1e-6) == measured.K
    assert measured.rate_source == "table"
    assert measured.rates_dps == pytest.approx(
        tuple(r * 1.001 for r in measured.demanded_rates_dps), rel=1e-9
    )


def test_a_table_angle_sampled_slower_than_twice_a_turn_is_unwrapped_about_the_demanded_rate() -> None:
    unit = VirtualUnit(sample_rate_hz=1.0, table_error=1e-4)
    recording = unit.recording(unit.rates("x", rates=(-720, -500, -300, -10, 10, 300, 500, 720)))
    found = reduce_recording(recording, rates="table").scale_factor["x"]
    assert found.rates_dps == pytest.approx(tuple(r * 1.0001 for r in found.demanded_rates_dps), rel=1e-9)


def test_repeats_of_a_position_are_averaged() -> None:
    unit = VirtualUnit(B=(1e-3, 0, 0))
    first = unit.positions("x")
    unit.B = (3e-3, 0, 0)
    result = reduce_recording(unit.recording([*first, *unit.positions("x")])).zero_offset["x"]
    assert pytest.approx(2e-3) == result.B
    assert len(result.angles_deg) == 4
    assert len(result.segments) == 8


def test_a_device_that_gives_accumulated_angles() -> None:
    unit = VirtualUnit(K=(1.01, 1.0, 1.0), B=(0.01, -0.02, 0.03), L={"yx": 1e-3, "zx": 2e-3})
    made = []
    for recorded in [*unit.rates("x"), *unit.turns("x"), *unit.positions("x")]:
        angles = {
            f"angle_{axis}": np.cumsum(recorded.samples[f"gyro_{axis}"]) / unit.sample_rate_hz + 17.0
            for axis in AXES
        }
        made.append(without(changed(recorded, **angles), "gyro_x", "gyro_y", "gyro_z"))
    result = reduce_recording(unit.recording(made))
    assert pytest.approx(1.01, rel=1e-6) == result.scale_factor["x"].K
    assert pytest.approx(0.01, abs=1e-9) == result.zero_offset["x"].B
    assert pytest.approx(1e-3, abs=1e-9) == result.misalignment["yx"].L
    assert pytest.approx(2e-3, abs=1e-9) == result.misalignment["zx"].L


@pytest.mark.parametrize("attitude", [False, True])
def test_the_resolution_of_angles_is_that_of_their_columns(attitude: bool) -> None:
    """0.001° at 10 samples a second: 0.01 °/s of one increment, and two readings of a position's angle."""
    unit = VirtualUnit(density=2.5e-3)
    columns = ("heading_deg", "pitch_deg", "roll_deg") if attitude else ("angle_x", "angle_y", "angle_z")
    made = []
    for recorded in [*unit.rates("x"), *unit.positions("x", 60.0)]:
        gyro = (recorded.samples[f"gyro_{axis}"] for axis in AXES)
        angles = [np.round(np.cumsum(rate) / unit.sample_rate_hz / 0.001) * 0.001 for rate in gyro]
        made.append(
            without(
                changed(recorded, **dict(zip(columns, angles, strict=True))), "gyro_x", "gyro_y", "gyro_z"
            )
        )
    recording = unit.recording(made)
    rows = {row.symbol: row for row in reduce_recording(recording).zero_offset["x"].uncertainty.rows}
    assert rows["q"].unit == "deg"
    assert rows["q"].half_width == pytest.approx(0.0005, rel=1e-6)
    bits = reduce_recording(recording, uncertainty="annex-a").scale_factor["x"].uncertainty.rows[1]
    assert bits.half_width == pytest.approx(0.01 / 600.0, rel=0.01)


def test_a_device_that_gives_attitude_only() -> None:
    """X up turns the heading, which counts clockwise and wraps; a drifting heading is a zero offset."""
    unit = VirtualUnit()
    made = []
    for recorded in unit.rates("x"):
        turned = np.cumsum(recorded.samples["gyro_x"]) / unit.sample_rate_hz * 1.02
        count = len(turned)
        columns = {
            "heading_deg": (-turned) % 360.0,
            "pitch_deg": np.zeros(count),
            "roll_deg": np.zeros(count),
        }
        made.append(without(changed(recorded, **columns), "gyro_x", "gyro_y", "gyro_z"))
    result = reduce_recording(unit.recording(made))
    assert pytest.approx(1.02, rel=1e-9) == result.scale_factor["x"].K


def test_pitch_and_roll_are_rotations_about_y_and_z() -> None:
    unit = VirtualUnit()
    for axis, column in (("y", "pitch_deg"), ("z", "roll_deg")):
        made = []
        for recorded in unit.positions(axis):  # type: ignore[arg-type]
            count = len(recorded.samples)
            columns = {name: np.zeros(count) for name in ("heading_deg", "pitch_deg", "roll_deg")}
            columns[column] = 0.01 * recorded.samples["t_s"]
            made.append(without(changed(recorded, **columns), "gyro_x", "gyro_y", "gyro_z"))
        result = reduce_recording(unit.recording(made))
        assert pytest.approx(0.01, abs=1e-12) == result.zero_offset[axis].B  # type: ignore[index]


def test_the_result_carries_what_the_header_says() -> None:
    unit = VirtualUnit()
    deviation = {"template": "T is {seconds} s", "params": {"seconds": 20}}
    room = {
        "temperature_c": 20.4,
        "temperature_spread_c": 0.3,
        "humidity_percent": 48,
        "humidity_spread_percent": 2,
    }
    recording = unit.recording(unit.positions("x"), deviations=[deviation], environment=room, simulated=True)
    result = reduce_recording(recording, software="x 1")
    assert [message.text() for message in result.deviations] == ["T is 20 s"]
    assert result.environment is not None
    assert result.environment.temperature_c == 20.4
    assert result.simulated
    assert result.notes["environment"] == room
    assert result.site["latitude_deg"] == unit.latitude_deg
    assert (result.software, result.bundle_sha256) == ("x 1", "00" * 32)
