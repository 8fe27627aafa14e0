"""When a table and a supply count as steady, and the trace they are judged by."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.instruments.interfaces import SupplyReading, TableLog, TableState
from ahrs_lab.procedures.commands import PointTo, SettleCurrent, SettleRate
from ahrs_lab.procedures.settling import SteadyCurrent, angle_is_steady, rate_is_steady
from ahrs_lab.procedures.table_trace import TableTrace

RATE = SettleRate(10.0, 0.01, 2.0, 60.0)


def trace(t: np.ndarray, rate: np.ndarray, angle: np.ndarray | None = None) -> TableTrace:
    made = TableTrace()
    angle = np.zeros_like(t) if angle is None else angle
    made.add(TableLog(t, angle, rate), TableState(t[-1], angle[-1], rate[-1], 0.0, True, True))
    return made


T = np.arange(0.0, 5.0, 0.01)


@pytest.mark.parametrize(
    ("rate", "steady"),
    [
        (np.full(500, 10.0), True),
        (np.full(500, 10.009), True),
        (np.full(500, 10.011), False),
        (np.where(T < 2.9, 0.0, 10.0), True),
        (np.where(T < 3.3, 0.0, 10.0), False),  # for 1.7 s only
        (10.0 + 0.05 * np.sin(2 * np.pi * 0.5 * T), False),  # swings slowly
        (10.0 + 0.02 * np.where(np.arange(500) % 2, 1.0, -1.0), True),  # noise of single reports
    ],
)
def test_a_rate_is_steady_when_every_part_of_the_hold_is_within_tolerance(
    rate: np.ndarray,
    steady: bool,
) -> None:
    assert rate_is_steady(trace(T, rate), float(T[-1]), RATE) == steady


def test_nothing_is_steady_before_the_hold_time_was_seen() -> None:
    short = T[:150]
    assert not rate_is_steady(trace(short, np.full(150, 10.0)), float(short[-1]), RATE)
    stale = trace(T, np.full(500, 10.0))
    assert not rate_is_steady(stale, float(T[-1]) + 1.0, RATE)


@pytest.mark.parametrize(("off", "steady"), [(0.0019, True), (0.0021, False)])
def test_an_angle_is_steady_within_its_tolerance(off: float, steady: bool) -> None:
    wanted = PointTo(90.0, 20.0, 0.002, 2.0, 60.0)
    held = trace(T, np.zeros(500), np.full(500, 90.0 + off))
    assert angle_is_steady(held, float(T[-1]), 90.0, wanted) == steady


def test_the_trace_reads_angle_and_rate_between_reports() -> None:
    moving = trace(T, np.full(500, 30.0), 30.0 * T)
    angle, rate = moving.at(np.array([1.234, 3.3333]))
    assert angle == pytest.approx([37.02, 99.999])
    assert rate == pytest.approx([30.0, 30.0])
    assert moving.mean_rate_dps(1.0) == pytest.approx(30.0)


@given(st.lists(st.floats(0.001, 30.0), min_size=1, max_size=30))
def test_the_trace_of_many_looks_is_that_of_one(steps: list[float]) -> None:
    made, now = TableTrace(), 0.0
    for step in steps:
        t = np.arange(np.floor(now * 10) + 1, np.floor((now + step) * 10) + 1) / 10
        now += step
        made.add(TableLog(t, 7.0 * t, np.full(len(t), 7.0)), TableState(now, 7.0 * now, 7.0, 7.0, True, True))
        asked = np.linspace(max(now - step, now - 4.0, steps[0]), now, 7)
        if asked[0] < asked[-1]:
            assert made.at(asked)[0] == pytest.approx(7.0 * asked, abs=1e-9)
    kept, _, _ = made.since(-1.0)
    assert np.all(np.diff(kept) > 0.0)


def test_a_table_without_a_log_is_traced_by_its_states() -> None:
    made, empty = TableTrace(), np.empty(0)
    assert made.mean_rate_dps(1.0) is None
    for now in np.arange(0.0, 2.0, 0.1):
        made.add(TableLog(empty, empty, empty), TableState(now, 5.0 * now, 5.0, 5.0, True, True))
    assert made.at(np.array([1.05]))[0] == pytest.approx([5.25])
    assert made.mean_rate_dps(1.0) == pytest.approx(5.0)


WANTED = SettleCurrent(0.01, 10.0, 60.0, 0.0)


def settles_at(current: list[float], step_s: float = 1.0) -> float | None:
    steady = SteadyCurrent(WANTED)
    for i, amps in enumerate(current):
        if steady.add(SupplyReading(i * step_s, 12.0, amps, True)):
            return i * step_s
    return None


def test_a_constant_current_is_steady_after_the_hold() -> None:
    assert settles_at([0.2] * 30) == 10.0


def test_a_transient_is_waited_out() -> None:
    assert settles_at([1.0, 0.5, 0.3] + [0.2] * 30) == 13.0


@pytest.mark.parametrize(("half_spread", "steady"), [(0.0099, True), (0.0102, False)])
def test_the_tolerance_is_relative_and_to_either_side(half_spread: float, steady: bool) -> None:
    swing = [0.2 * (1 + half_spread * (1 if i % 2 else -1)) for i in range(40)]
    assert (settles_at(swing) is not None) == steady


def test_no_current_is_never_steady() -> None:
    assert settles_at([0.0] * 100) is None
