"""Bench time against wall time. The wall is a counter here, so nothing is timed."""

from __future__ import annotations

import threading
from datetime import UTC, datetime

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.simulation.bench import build_bench
from ahrs_lab.simulation.clock import SimulatedClock, parse_utc
from ahrs_lab.simulation.settings import SimulationSettings

_START = datetime(2026, 1, 31, 8, 0, tzinfo=UTC)


def test_at_full_speed_a_wait_is_one_step() -> None:
    clock = SimulatedClock(None, _START)
    steps: list[tuple[float, float]] = []
    clock.drive(None, lambda start, stop: steps.append((start, stop)))
    clock.wait(3600.0)
    assert steps == [(0.0, 3600.0)]
    assert clock.step_s is None
    assert clock.utc() == datetime(2026, 1, 31, 9, 0, tzinfo=UTC)


def test_in_step_with_the_wall_a_wait_goes_in_pieces_and_ends_at_the_same_time() -> None:
    clock = SimulatedClock(1000.0, _START)
    steps: list[tuple[float, float]] = []
    clock.drive(None, lambda start, stop: steps.append((start, stop)))
    clock.wait(130.0)
    assert clock.step_s == 50.0
    assert steps == [(0.0, 50.0), (50.0, 100.0), (100.0, 130.0)]
    assert clock.now_s() == 130.0


def test_an_interrupt_from_another_thread_ends_the_wait() -> None:
    clock = SimulatedClock(1.0, _START)
    begun = threading.Event()
    clock.drive(None, lambda start, stop: begun.set())
    waiting = threading.Thread(target=clock.wait, args=(3600.0,))
    waiting.start()
    assert begun.wait(30.0)
    clock.interrupt()
    waiting.join(30.0)
    assert not waiting.is_alive()
    assert 0.0 < clock.now_s() < 3600.0


def test_speed_may_change_while_it_runs() -> None:
    clock = SimulatedClock(1.0, _START)
    clock.drive(None, lambda start, stop: setattr(clock, "speed", None))
    clock.wait(3600.0)
    assert clock.now_s() == 3600.0


def test_a_speed_has_to_be_positive() -> None:
    for speed in (0.0, -1.0, float("nan")):
        with pytest.raises(InputError, match="above 0"):
            build_bench(SimulationSettings.ideal(), speed=speed)


def test_dates_need_an_offset() -> None:
    assert parse_utc("2026-01-31T16:00:00+08:00") == _START
    for text in ("yesterday", "2026-01-31T16:00:00"):
        with pytest.raises(InputError, match=r"2026-01-31T08:00:00\+00:00"):
            parse_utc(text)
