"""Soft limits around any table."""

from __future__ import annotations

import math

import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.motion_limits import LimitedTable
from tests.instruments.fake_clock import FakeClock
from tests.instruments.tables.plant import Plant


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()


def plant(clock: FakeClock, acceleration: float = 100.0) -> Plant:
    made = Plant(clock, max_rate_dps=400.0, acceleration=acceleration)
    made.enable()
    return made


def watched(table: LimitedTable, clock: FakeClock, seconds: float, step: float = 0.05) -> None:
    """As a run looks at a table."""
    for _ in range(round(seconds / step)):
        clock.wait(step)
        table.state()


@pytest.mark.parametrize("rate", [100.1, -100.1, math.inf, math.nan])
def test_a_rate_beyond_the_limit_is_refused_and_not_sent(clock: FakeClock, rate: float) -> None:
    inner = plant(clock)
    table = LimitedTable(inner, SoftLimits(100.0, 100.0))
    with pytest.raises(InputError):
        table.set_rate(rate)
    with pytest.raises(InputError):
        table.move_to(10.0, rate)
    clock.wait(1.0)
    inner.state()
    assert inner.rate_dps == 0.0


@pytest.mark.parametrize("angle", [90.5, -90.5, math.nan])
def test_an_angle_outside_the_range_is_refused(clock: FakeClock, angle: float) -> None:
    table = LimitedTable(plant(clock), SoftLimits(100.0, 100.0, -90.0, 90.0))
    with pytest.raises(InputError, match="range"):
        table.move_to(angle, 10.0)


def test_limits_above_what_the_table_can_are_refused(clock: FakeClock) -> None:
    for soft in (SoftLimits(401.0, 100.0), SoftLimits(400.0, 101.0)):
        with pytest.raises(InputError, match="lower it"):
            LimitedTable(plant(clock), soft)


def test_what_is_within_the_limits_runs(clock: FakeClock) -> None:
    inner = plant(clock)
    table = LimitedTable(inner, SoftLimits(100.0, 100.0))
    table.set_rate(100.0)
    watched(table, clock, 3.0)
    assert inner.rate_dps == 100.0
    table.set_rate(-100.0)
    watched(table, clock, 4.0)
    assert inner.rate_dps == -100.0


def test_a_table_that_runs_away_is_stopped_until_it_is_enabled_again(clock: FakeClock) -> None:
    inner = plant(clock)
    table = LimitedTable(inner, SoftLimits(50.0, 100.0))
    table.set_rate(50.0)
    watched(table, clock, 1.0)
    inner.set_rate(200.0)  # nobody asked for that
    with pytest.raises(InstrumentError, match="limit is set to 50"):
        watched(table, clock, 2.0)
    clock.wait(2.0)
    inner.state()
    assert inner.rate_dps == 0.0
    with pytest.raises(InstrumentError):
        table.set_rate(10.0)
    table.enable()
    table.set_rate(10.0)
    watched(table, clock, 1.0)
    assert inner.rate_dps == 10.0


def test_a_table_that_accelerates_too_hard_is_stopped(clock: FakeClock) -> None:
    inner = plant(clock, acceleration=100.0)
    table = LimitedTable(inner, SoftLimits(100.0, 40.0))
    table.set_rate(100.0)
    with pytest.raises(InstrumentError, match="accelerated"):
        watched(table, clock, 1.0)
    assert inner.largest_rate_dps < 100.0


def test_a_table_never_leaves_its_range(clock: FakeClock) -> None:
    inner = plant(clock)
    table = LimitedTable(inner, SoftLimits(100.0, 100.0, -90.0, 90.0))
    table.set_rate(60.0)
    with pytest.raises(InstrumentError, match="range"):
        watched(table, clock, 5.0)
    clock.wait(3.0)
    inner.state()
    assert 0.0 < inner.angle_deg <= 90.0
    table.enable()
    inner.angle_deg = 89.9
    with pytest.raises(InputError, match="from there"):
        table.set_rate(60.0)
    table.set_rate(-20.0)  # the way back is free
    watched(table, clock, 0.5)
    assert inner.rate_dps < 0.0
