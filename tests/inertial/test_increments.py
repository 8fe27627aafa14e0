"""Coning and sculling: the drift that is left, against the published values of the algorithms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.increments import Samples, rotation_vectors, velocity_changes
from ahrs_lab.inertial.quaternion import conjugate, from_rotation_vector, product, running_product

Array = NDArray[np.float64]
SAMPLES: tuple[Samples, ...] = (1, 2, 3)


def cone(
    half_angle_deg: float, frequency_hz: float, interval_s: float, seconds: float
) -> tuple[Array, Array]:
    """Exact increments (3, n), and quaternions (4, n + 1), of a pure coning motion."""
    a, W = np.radians(half_angle_deg), 2 * np.pi * frequency_hz
    t = np.arange(round(seconds / interval_s) + 1) * interval_s
    about_z = np.full(len(t) - 1, -2 * np.sin(a / 2) ** 2 * W * interval_s)
    d = np.stack([np.sin(a) * np.diff(np.cos(W * t)), np.sin(a) * np.diff(np.sin(W * t)), about_z])
    s = np.sin(a / 2)
    return d, np.stack([np.full(len(t), np.cos(a / 2)), s * np.cos(W * t), s * np.sin(W * t), 0 * t])


@pytest.mark.parametrize(
    ("samples", "half_angle_deg", "frequency_hz", "interval_s", "drift_deg_per_h", "within"),
    [
        (1, 1.0, 1.0, 0.01, 0.129879, 5e-4),
        (2, 1.0, 1.0, 0.01, 1.025482e-4, 1e-3),
        # published to the second power of the half-angle; the fourth adds a sixth at 1°, a hundredth at 0.3°
        (3, 1.0, 1.0, 0.01, 8.675e-8, 0.2),
        (3, 0.3, 1.0, 0.01, 0.3**2 * 8.675e-8, 0.02),
        (3, 1.0, 10.0, 0.002, 5e-5, 0.2),
        (2, 1.0, 10.0, 0.002, 0.0166, 0.02),
    ],
)
def test_coning_leaves_the_published_drift(
    samples: Samples,
    half_angle_deg: float,
    frequency_hz: float,
    interval_s: float,
    drift_deg_per_h: float,
    within: float,
) -> None:
    seconds = 120.0
    d, truth = cone(half_angle_deg, frequency_hz, interval_s, seconds)
    steps = from_rotation_vector(rotation_vectors(d, np.full(d.shape[1], interval_s), samples))
    error = product(running_product(truth[:, 0], steps), conjugate(truth))
    # between two whole turns of the cone, far from the record's ends
    turn = round(1 / frequency_hz / interval_s)
    shown = 2 * (error[3, -1 - turn] - error[3, turn]) / (seconds - 2 / frequency_hz)
    assert np.degrees(abs(shown)) * 3600 == pytest.approx(drift_deg_per_h, rel=within)


def test_sculling_is_no_acceleration() -> None:
    """Rocking about x while shaking along y, in phase: the mean force up is real (½ A·α), and a constant rate
    of fall is all that the corrected increments show."""
    W, alpha, push, h = 2 * np.pi * 5.0, np.radians(1.0), 2.0, 0.005
    t = np.arange(2001) * h
    # ω = αW cos(Wt) about x, specific force A sin(Wt) along body y
    d = np.zeros((3, 2000))
    d[0] = alpha * np.diff(np.sin(W * t))
    f = np.zeros((3, 2000))
    f[1] = -push / W * np.diff(np.cos(W * t))
    fine = np.linspace(0, t[-1], 2_000_01)
    angle = alpha * np.sin(W * fine)
    truth = np.trapezoid(push * np.sin(W * fine) * np.sin(angle), fine)
    errors = []
    for samples in SAMPLES:
        interval = np.full(2000, h)
        change = velocity_changes(d, f, interval, samples)
        attitude = alpha * np.sin(W * t[:-1])
        up = np.sin(attitude) * change[1] + np.cos(attitude) * change[2]
        errors.append(abs(float(np.sum(up)) - truth) / truth)
    # x²/12, x⁴/60, x⁶/280 with x = W·h, as for coning
    x = W * h
    assert errors[0] == pytest.approx(x**2 / 6, rel=0.05)
    assert errors[1] < 0.1 * x**4
    assert errors[2] < 0.02 * x**6 + 1e-6


def test_a_steady_turn_is_exact_at_any_rate() -> None:
    turn, force = np.array([0.9, -0.5, 1.2]), np.array([1.0, 2.0, 3.0])
    tau = (np.arange(200000) + 0.5) / 200000
    C = from_rotation_vector(turn[:, np.newaxis] * tau)
    w, x = C[0], C[1:]
    moved = force[:, np.newaxis] + 2 * np.cross(x, w * force[:, np.newaxis] + np.cross(x.T, force).T, axis=0)
    for samples in SAMPLES:
        change = velocity_changes(
            np.tile(turn[:, np.newaxis], 5),
            np.tile(force[:, np.newaxis], 5),
            np.ones(5),
            samples,
        )
        assert change[:, 2] == pytest.approx(moved.mean(axis=1), rel=1e-9)


def test_an_interval_beside_a_gap_stands_alone() -> None:
    rng = np.random.default_rng(1)
    d, h = rng.standard_normal((3, 9)) * 0.01, np.full(9, 0.01)
    h[4] = 0.5
    gappy = rotation_vectors(d, h, 3)
    assert gappy[:, 4] == pytest.approx(d[:, 4])
    assert gappy[:, 3] == pytest.approx(d[:, 3] + np.cross(d[:, 2], d[:, 3]) / 12)
    assert gappy[:, 5] == pytest.approx(d[:, 5] + np.cross(d[:, 5], d[:, 6]) / 12)
    whole = rotation_vectors(d, np.full(9, 0.01), 3)
    assert gappy[:, 1:3] == pytest.approx(whole[:, 1:3])


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_short_records_are_taken(count: int) -> None:
    d = np.ones((3, count)) * [[0.1], [0.2], [0.3]]
    assert rotation_vectors(d, np.ones(count)).shape == (3, count)
    assert velocity_changes(d, d, np.ones(count)) == pytest.approx(d, abs=1e-15)
