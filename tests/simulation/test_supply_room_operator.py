"""What stands around the table."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.bench import build_bench, world_of
from ahrs_lab.simulation.settings import (
    DeviceSettings,
    OperatorSettings,
    RoomSettings,
    SimulationSettings,
    SupplySettings,
)
from tests.simulation.bench_at_hand import after, ready


def _bench(supply: SupplySettings) -> SimulationSettings:
    return SimulationSettings.ideal(supply=supply, device=DeviceSettings(load_w=2.4))


def test_switch_on_transient_decays_exponentially_to_the_loads_current() -> None:
    bench = build_bench(_bench(SupplySettings(inrush=1.5, inrush_time_constant_s=3.0)))
    bench.supply.set_output(12.0, 2.0)
    assert bench.supply.read().current_a == 0.0
    bench.supply.on()
    currents = []
    for _ in range(4):
        currents.append(bench.supply.read().current_a)
        bench.clock.wait(3.0)
    np.testing.assert_allclose(currents, 0.2 * (1.0 + 1.5 * np.exp(-np.arange(4.0))), rtol=1e-12)
    bench.clock.wait(300.0)
    assert bench.supply.read().current_a == pytest.approx(0.2)
    bench.supply.off()
    reading = bench.supply.read()
    assert (reading.voltage_v, reading.current_a, reading.output_on) == (0.0, 0.0, False)


def test_a_current_limit_below_the_transient_switches_the_output_off() -> None:
    bench = ready(_bench(SupplySettings(inrush=1.5)))
    bench.supply.off()
    bench.supply.set_output(12.0, 0.3)
    bench.supply.on()
    assert not bench.supply.read().output_on
    assert len(after(bench, 10.0)) == 0


def test_too_little_voltage_leaves_the_unit_dead_and_enough_wakes_it() -> None:
    bench = ready()
    bench.supply.set_output(5.0, 1.0)
    assert len(after(bench, 1.0)) == 0
    bench.supply.set_output(12.0, 1.0)
    assert len(after(bench, 1.0)) == 100


@pytest.mark.parametrize(("voltage", "current"), [(31.0, 1.0), (-1.0, 1.0), (12.0, 0.0), (12.0, 6.0)])
def test_settings_beyond_the_supply_are_refused(voltage: float, current: float) -> None:
    with pytest.raises(InputError):
        build_bench(SimulationSettings.ideal()).supply.set_output(voltage, current)


def test_a_current_that_never_settles() -> None:
    bench = ready()
    world_of(bench).faults.trigger("supply_never_settles")
    bench.clock.wait(600.0)
    currents = []
    for _ in range(100):
        bench.clock.wait(0.5)
        currents.append(bench.supply.read().current_a)
    assert (max(currents) - min(currents)) / np.mean(currents) > 0.1


def test_the_room_swings_about_its_mean_and_can_leave_its_limits() -> None:
    room = RoomSettings(
        temperature_c=20.5, temperature_swing_c=0.5, humidity_percent=40.0, swing_period_s=100.0
    )
    bench = build_bench(SimulationSettings.ideal(room=room))
    bench.clock.wait(25.0)
    reading = bench.room.read()
    assert reading.temperature_c == pytest.approx(21.0)
    assert (reading.t_s, reading.humidity_percent) == (25.0, 40.0)
    faults = world_of(bench).faults
    faults.trigger("room_out_of_limits", at_s=30.0, until_s=40.0)
    readings = []
    for _ in range(3):
        bench.clock.wait(7.0)
        readings.append(bench.room.read().temperature_c)
    assert readings[0] > 23.0
    assert readings[1] > 23.0
    assert readings[2] < 23.0


def test_the_operator_takes_time_and_mounts_as_asked() -> None:
    bench = build_bench(SimulationSettings.ideal(operator=OperatorSettings(mount_time_s=40.0)))
    bench.operator.mount(Orientation("DNE"), None)
    assert bench.clock.now_s() == 40.0
    assert world_of(bench).orientation == Orientation("DNE")


def test_a_wrong_mounting_happens_once_or_always() -> None:
    bench = build_bench(SimulationSettings.ideal())
    world = world_of(bench)
    asked = Orientation("UEN")
    world.faults.trigger("wrong_mounting", once=True)
    bench.operator.mount(asked, None)
    assert world.orientation.face != asked.face
    bench.operator.mount(asked, None)
    assert world.orientation == asked
    world.faults.trigger("wrong_mounting", orientation=Orientation("EUS"))
    for _ in range(2):
        bench.operator.mount(asked, None)
        assert world.orientation == Orientation("EUS")


def test_a_person_at_the_screen_can_place_the_case() -> None:
    bench = ready(letters="UEN")
    world_of(bench).place(Orientation("ENU"))
    assert after(bench, 0.1)["accel_z"][-1] == pytest.approx(9.8014573, abs=1e-6)
