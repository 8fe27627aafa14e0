"""The rate table: limits, its two kinds of error, its log, its faults."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.bench import world_of
from ahrs_lab.simulation.faults import FaultName
from ahrs_lab.simulation.settings import SimulationSettings, TableSettings
from tests.simulation.bench_at_hand import ready


def _with(table: TableSettings) -> SimulationSettings:
    return SimulationSettings.ideal(table=table)


def test_rates_beyond_the_limit_are_refused_with_both_numbers() -> None:
    bench = ready(_with(TableSettings(max_rate_dps=120.0)))
    with pytest.raises(InputError, match=r"-120\.5 °/s: its limit is 120\.0"):
        bench.table.set_rate(-120.5)
    with pytest.raises(InputError):
        bench.table.set_rate(float("nan"))
    with pytest.raises(InputError):
        bench.table.move_to(90.0, 121.0)
    with pytest.raises(InputError, match="above 0"):
        bench.table.move_to(90.0, 0.0)
    assert not bench.table.state().moving


def test_a_table_that_is_not_enabled_refuses_to_move() -> None:
    bench = ready()
    bench.table.disable()
    with pytest.raises(InstrumentError, match="not enabled"):
        bench.table.set_rate(1.0)


def test_the_acceleration_limit_holds() -> None:
    bench = ready(_with(TableSettings(max_acceleration_dps2=50.0)))
    bench.table.set_rate(100.0)
    bench.clock.wait(1.0)
    assert bench.table.state().rate_dps == pytest.approx(50.0)
    bench.clock.wait(1.5)
    assert bench.table.state().rate_dps == 100.0


def test_disabling_brakes_the_table() -> None:
    bench = ready()
    bench.table.set_rate(300.0)
    bench.clock.wait(5.0)
    bench.table.disable()
    bench.clock.wait(1.0)
    state = bench.table.state()
    assert (state.moving, state.enabled) == (False, False)


@pytest.mark.parametrize(("rate", "error"), [(0.5, 1e-3), (-5.0, -2e-4), (100.0, 3e-5)])
def test_the_rate_error_of_each_band_is_invisible_to_the_table_but_shows_in_its_angle(
    rate: float, error: float
) -> None:
    bench = ready(_with(TableSettings(rate_error=(1e-3, -2e-4, 3e-5))))
    bench.table.set_rate(rate)
    bench.clock.wait(5.0)
    before = bench.table.state()
    bench.clock.wait(100.0)
    later = bench.table.state()
    assert before.rate_dps == pytest.approx(rate, rel=1e-12)
    turned = (later.angle_deg - before.angle_deg) / (later.t_s - before.t_s)
    assert turned / rate - 1.0 == pytest.approx(error, rel=1e-6)


def test_the_position_error_is_of_the_true_angle_not_of_what_the_encoder_says() -> None:
    bench = ready(_with(TableSettings(position_error_arcsec=36.0, position_error_phase_deg=10.0)))
    bench.table.move_to(90.0, 50.0)
    bench.clock.wait(10.0)
    true = world_of(bench).table.motion.angle_at(bench.clock.now_s())
    assert bench.table.state().angle_deg == pytest.approx(90.0, abs=1e-12)
    assert true - 90.0 == pytest.approx(-0.01 * np.sin(np.radians(100.0)), rel=1e-3)


def test_ten_turns_end_where_they_began_to_the_bit_in_spite_of_the_position_error() -> None:
    bench = ready(_with(TableSettings(position_error_arcsec=36.0, rate_error=(0.0, 0.0, 1e-4))))
    motion = world_of(bench).table.motion
    bench.table.move_to(0.0, 100.0)
    bench.clock.wait(10.0)
    start = motion.angle_at(bench.clock.now_s())
    bench.table.move_to(3600.0, 100.0)
    bench.clock.wait(20.0)
    assert motion.rate_at(bench.clock.now_s()) == pytest.approx(100.01)
    bench.clock.wait(40.0)
    assert motion.angle_at(bench.clock.now_s()) - start == pytest.approx(3600.0, abs=1e-12)


def test_the_encoder_shows_whole_steps() -> None:
    bench = ready(_with(TableSettings(encoder_resolution_deg=0.01)))
    bench.table.set_rate(7.7)
    bench.clock.wait(3.0)
    bench.table.log()
    bench.clock.wait(1.0)
    steps = bench.table.log().angle_deg / 0.01
    assert np.max(np.abs(steps - np.rint(steps))) < 1e-9


def test_the_log_has_each_moment_once_and_follows_the_motion() -> None:
    bench = ready()
    bench.table.set_rate(90.0)
    times, angles, rates = [], [], []
    for wait in (0.003, 1.0, 0.004, 2.5):
        bench.clock.wait(wait)
        log = bench.table.log()
        times.append(log.t_s)
        angles.append(log.angle_deg)
        rates.append(log.rate_dps)
    t = np.concatenate(times)
    np.testing.assert_allclose(np.diff(t), 0.01, atol=1e-12)
    assert (t[0], t[-1]) == (0.01, 3.5)
    ramp = 90.0 / 500.0
    expected = np.where(t < ramp, 250.0 * t**2, 90.0 * (t - ramp) + 0.5 * 90.0 * ramp)
    np.testing.assert_allclose(np.concatenate(angles), expected, atol=1e-10)
    np.testing.assert_allclose(np.concatenate(rates), np.minimum(500.0 * t, 90.0), atol=1e-9)


def test_a_trip_in_mid_spin_brakes_and_stays_until_it_is_acknowledged() -> None:
    bench = ready()
    bench.table.set_rate(200.0)
    bench.clock.wait(5.0)
    world_of(bench).faults.trigger("table_trips", at_s=bench.clock.now_s() + 2.0)
    bench.clock.wait(2.2)
    assert 0.0 < bench.table.state().rate_dps == pytest.approx(100.0)
    bench.clock.wait(1.0)
    state = bench.table.state()
    assert (state.moving, state.enabled, state.demanded_rate_dps) == (False, False, 0.0)
    assert "tripped" in state.fault
    with pytest.raises(InstrumentError, match="tripped"):
        bench.table.set_rate(10.0)
    bench.table.enable()
    bench.table.set_rate(10.0)
    bench.clock.wait(1.0)
    assert bench.table.state().rate_dps == 10.0


def test_a_trip_can_wait_for_a_rate() -> None:
    bench = ready()
    world_of(bench).faults.trigger("table_trips", above_dps=150.0)
    bench.table.set_rate(100.0)
    bench.clock.wait(10.0)
    assert bench.table.state().fault == ""
    bench.table.set_rate(-200.0)
    bench.clock.wait(10.0)
    assert bench.table.state().fault
    log = bench.table.log()
    assert log.rate_dps.min() == pytest.approx(-150.0, abs=5.0)


def test_a_table_that_never_settles_swings_about_its_demand() -> None:
    bench = ready()
    world_of(bench).faults.trigger("table_never_settles")
    bench.table.set_rate(100.0)
    bench.clock.wait(5.0)
    bench.table.log()
    bench.clock.wait(120.0)
    rates = bench.table.log().rate_dps
    assert rates.max() > 100.9
    assert rates.min() < 99.1
    bench.table.stop()
    bench.clock.wait(2.0)
    assert not bench.table.state().moving


@pytest.mark.parametrize(("fault", "stops"), [("table_ignores_commands", True), ("table_runs_away", False)])
def test_a_deaf_table(fault: FaultName, stops: bool) -> None:
    bench = ready()
    bench.table.set_rate(50.0)
    bench.clock.wait(1.0)
    world_of(bench).faults.trigger(fault)
    bench.table.set_rate(20.0)
    bench.clock.wait(1.0)
    state = bench.table.state()
    assert (state.rate_dps, state.demanded_rate_dps) == (50.0, 20.0)
    bench.table.stop()
    bench.clock.wait(1.0)
    assert bench.table.state().moving is not stops


def test_a_table_that_runs_away_has_to_be_turning_first() -> None:
    bench = ready()
    world_of(bench).faults.trigger("table_runs_away")
    bench.table.set_rate(50.0)
    bench.clock.wait(1.0)
    bench.table.disable()
    bench.clock.wait(1.0)
    assert bench.table.state().rate_dps == 50.0


def test_nobody_mounts_a_case_on_a_turning_table() -> None:
    bench = ready()
    bench.table.set_rate(10.0)
    with pytest.raises(InstrumentError, match="turning"):
        bench.operator.mount(Orientation("DNE"), None)
