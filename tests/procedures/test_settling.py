"""When a table and a supply count as steady, and the trace they are judged by."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.instruments.interfaces import SupplyReading, TableLog, TableState
from ahrs_lab.procedures.commands import PointTo, SettleCurrent, SettleRate
from ahrs_lab.procedures.settling import (
    Obedience,
    SteadyCurrent,
    TableRunsAwayError,
    angle_is_steady,
    rate_is_steady,
)
from ahrs_lab.procedures.table_trace import TableTrace
from tests.procedures.test_table_timing import late, off

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


# a table that turns as nobody demanded ──────────────────────────────────────────────────────────────────────


def accused(demanded: float, came_from: float, rate: np.ndarray, made: TableTrace | None = None) -> str:
    """What is said of rates reported for some seconds, looked at every half second; nothing: ""."""
    seen = made or trace(T[: len(rate)], rate, np.cumsum(rate) * 0.01)
    judge = Obedience(SettleRate(demanded, 0.01, 2.0, 240.0), came_from, 2.0)
    for end in np.arange(2.0, len(rate) * 0.01, 0.5):
        upto = TableTrace()
        t, angle, rates = seen.since(-1.0)
        known = t <= end
        upto.add(
            TableLog(t[known], angle[known], rates[known], doubts(seen)[known]),
            TableState(t[known][-1], angle[known][-1], rates[known][-1], demanded, True, True),
        )
        try:
            judge.check(upto, float(end))
        except TableRunsAwayError as error:
            return str(error)
    return ""


def doubts(seen: TableTrace) -> np.ndarray:
    t, _, _ = seen.since(-1.0)
    return seen.columns(t).get("table_doubt_s", np.zeros(len(t)))


def ramp(start: float, end: float, acceleration: float) -> np.ndarray:
    return np.asarray(start + np.sign(end - start) * np.minimum(acceleration * T, abs(end - start)))


@pytest.mark.parametrize(
    ("demanded", "came_from", "rate", "said"),
    [
        (-100.0, 100.0, np.full(500, 100.0), "turns the wrong way"),
        (100.0, 0.0, ramp(0.0, -100.0, 50.0), "turns the wrong way"),
        (0.5, 0.0, np.full(500, -0.5), "turns the wrong way"),
        (10.0, 100.0, np.full(500, 100.0), "turns too fast"),
        (10.0, 10.0, ramp(10.0, 200.0, 30.0), "turns too fast"),
        (-10.0, 0.0, np.full(500, -16.0), "turns too fast"),
        (10.0, 100.0, np.full(500, -30.0), "turns the wrong way"),
    ],
)
def test_a_table_that_turns_wrongly_and_comes_no_nearer_is_accused(
    demanded: float, came_from: float, rate: np.ndarray, said: str
) -> None:
    assert said in accused(demanded, came_from, rate)


@pytest.mark.parametrize("noise_dps", [0.0, 2.0])
@pytest.mark.parametrize("acceleration", [2.0, 10.0, 50.0, 400.0])
@pytest.mark.parametrize(
    ("came_from", "demanded"), [(0.0, 100.0), (100.0, -100.0), (-200.0, 200.0), (200.0, 10.0), (-5.0, 0.5)]
)
def test_a_ramp_is_never_accused(
    came_from: float, demanded: float, acceleration: float, noise_dps: float
) -> None:
    true = ramp(came_from, demanded, acceleration)
    reported = true + noise_dps * np.random.default_rng(7).standard_normal(len(true))
    made = trace(T, reported, np.cumsum(true) * 0.01)
    assert accused(demanded, came_from, reported, made) == ""


@pytest.mark.parametrize(
    "rate",
    [
        np.full(500, 10.05),
        10.0 + 5.0 * np.sin(2 * np.pi * 0.7 * T),
        10.0 + 8.0 * np.exp(-T),  # overshoots and comes back
        np.full(500, 6.0),
        np.zeros(500),
        10.0 * (1.0 - np.exp(-0.5 * T)),
        np.where(np.abs(T - 3.0) < 0.4, 25.0, 10.0),
    ],
)
def test_a_table_near_its_rate_slow_or_swinging_is_not_accused(rate: np.ndarray) -> None:
    assert accused(10.0, 0.0, rate) == ""


def test_noise_hides_no_table_that_runs_away() -> None:
    true = np.full(500, 100.0)
    reported = true + 10.0 * np.random.default_rng(3).standard_normal(500)
    assert "too fast" in accused(10.0, 100.0, reported, trace(T, reported, np.cumsum(true) * 0.01))


def test_reports_without_an_angle_that_turns_so_prove_nothing() -> None:
    assert accused(10.0, 0.0, np.full(500, 40.0), trace(T, np.full(500, 40.0), 10.0 * T)) == ""


@pytest.mark.parametrize(("doubt_s", "told"), [(0.05, True), (1.0, False)])
def test_an_angle_counts_as_far_as_its_times_are_known(doubt_s: float, told: bool) -> None:
    made = TableTrace()
    rate = np.full(500, 20.0)
    made.add(
        TableLog(T, 20.0 * T, rate, np.full(500, doubt_s)),
        TableState(T[-1], 20.0 * T[-1], 20.0, 10.0, True, True, doubt_s=doubt_s),
    )
    assert bool(accused(10.0, 0.0, rate, made)) == told


@pytest.mark.parametrize("factor", [1.0, 1.5, -1.0])
def test_a_table_over_a_late_wire_is_judged_by_what_it_does(factor: float) -> None:
    wire = late(off(factor))
    made = TableTrace()
    judge = Obedience(SettleRate(100.0, 0.01, 2.0, 120.0), 0.0, 2.0)
    wire.table.set_rate(100.0)
    said = ""
    while wire.clock.now_s() < 6.0 and not said:
        wire.clock.t_s += 0.025
        wire.table.poll()
        made.add(wire.table.log(), wire.table.state())
        if wire.clock.now_s() > 3.0:
            try:
                judge.check(made, wire.clock.now_s())
            except TableRunsAwayError as error:
                said = str(error)
    wrong = {1.0: "", 1.5: "too fast", -1.0: "the wrong way"}[factor]
    assert bool(said) == bool(wrong)
    assert wrong in said
