"""The table's kinematics against closed forms and numerical integration."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

from ahrs_lab.simulation.motion import Motion


def _sampled(motion: Motion, start_s: float, stop_s: float, step_s: float = 1e-3) -> NDArray[np.float64]:
    times = np.arange(start_s, stop_s, step_s)
    return np.array([(t, motion.angle_at(t), motion.rate_at(t)) for t in times]).T


def test_a_demanded_rate_is_reached_by_the_acceleration_and_held() -> None:
    motion = Motion(10.0)
    motion.go_at(5.0, -100.0, 500.0)
    assert motion.rate_at(4.9) == 0.0
    assert motion.rate_at(5.1) == pytest.approx(-50.0)
    assert motion.angle_at(5.2) == pytest.approx(10.0 - 0.5 * 500.0 * 0.2**2)
    assert motion.rate_at(1000.0) == -100.0
    assert motion.angle_at(15.2) == pytest.approx(10.0 - 10.0 - 1000.0)


def test_whole_turns_end_exactly_where_they_were_told_and_turn_at_the_asked_rate() -> None:
    motion = Motion(0.1)
    motion.go_to(2.0, 3600.1, 100.0, 500.0)
    assert motion.rate_at(20.0) == 100.0
    assert motion.arrives_s() == pytest.approx(2.0 + 36.0 + 0.2)
    assert motion.angle_at(60.0) == 3600.1
    assert not motion.moving_at(60.0)
    motion.go_to(61.0, 0.1, 100.0, 500.0)
    assert motion.rate_at(80.0) == -100.0
    assert motion.angle_at(120.0) == 0.1


def test_a_short_move_never_reaches_the_rate() -> None:
    motion = Motion()
    motion.go_to(0.0, 1.0, 100.0, 100.0)
    _, angle, rate = _sampled(motion, 0.0, 0.3)
    assert rate.max() == pytest.approx(10.0, rel=2e-2)
    assert rate.max() <= 10.0
    assert angle[-1] == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_angle_is_the_integral_of_rate_and_acceleration_stays_within_its_limit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    motion = Motion(rng.uniform(-10, 10))
    for when in np.arange(0.0, 10.0, 1.25):
        if rng.random() < 0.5:
            motion.go_at(when, rng.uniform(-300, 300), 400.0)
        else:
            motion.go_to(when, rng.uniform(-500, 500), rng.uniform(1, 300), 400.0)
    times, angle, rate = _sampled(motion, 0.0, 20.0)
    assert np.max(np.abs(np.diff(rate))) <= 0.4 * (1 + 1e-9)
    integral = cumulative_simpson(rate, x=times, initial=0.0)
    # a kink inside a step of the sampling costs at most a·h²
    np.testing.assert_allclose(angle - angle[0], integral, atol=400.0 * 1e-6 * 30)


def test_a_new_command_starts_from_where_the_old_motion_was() -> None:
    motion = Motion()
    motion.go_to(0.0, 100.0, 50.0, 100.0)
    angle, rate = motion.angle_at(1.0), motion.rate_at(1.0)
    motion.go_at(1.0, 0.0, 100.0)
    assert (motion.angle_at(1.0), motion.rate_at(1.0)) == (angle, rate)
    assert motion.angle_at(9.0) == pytest.approx(angle + rate**2 / 200.0)


def test_hunting_never_settles_but_stays_near() -> None:
    motion = Motion()
    motion.go_at(0.0, 100.0, 500.0)
    motion.hunt(1.0)
    _, angle, rate = _sampled(motion, 1.0, 600.0, 0.01)
    assert rate.min() == pytest.approx(99.0, abs=0.05)
    assert rate.max() == pytest.approx(101.0, abs=0.05)
    assert (angle[-1] - angle[0]) / 598.99 == pytest.approx(100.0, abs=1e-2)


def test_spans_cover_the_time_asked_without_a_gap() -> None:
    motion = Motion()
    motion.go_to(1.0, 90.0, 20.0, 50.0)
    spans = motion.spans(0.5, 30.0)
    assert spans[0][0] == 0.5
    assert spans[-1][1] == 30.0
    assert all(a[1] == b[0] for a, b in pairwise(spans))
    assert len(spans) == 5


def test_what_is_over_can_be_forgotten() -> None:
    motion = Motion()
    motion.go_to(1.0, 90.0, 20.0, 50.0)
    before = [motion.angle_at(t) for t in (3.0, 5.0, 9.0)]
    motion.forget_before(3.0)
    assert [motion.angle_at(t) for t in (3.0, 5.0, 9.0)] == before
    assert len(motion.spans(3.0, 30.0)) == 3
