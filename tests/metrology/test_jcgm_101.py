"""The examples of JCGM 101:2008, clause 9, with the numbers printed there and the verdicts of clause 8.

Trials are so many that four standard errors of an interval's end stay within the tolerances asked here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.metrology.uncertainty.distributions import (
    ArcSine,
    CurvilinearTrapezoid,
    Input,
    Joint,
    Normal,
    Rectangular,
    StudentT,
)
from ahrs_lab.metrology.uncertainty.monte_carlo import Propagated, propagate, validate

Array = NDArray[np.float64]
TRIALS = 10**6


def run(
    inputs: Sequence[Input], model: object, probability: float = 0.95, trials: int = TRIALS
) -> Propagated:
    return propagate(inputs, model, seed=101, trials=trials, probability=probability)  # type: ignore[arg-type]


def total(x: Array) -> Array:
    return np.asarray(x.sum(axis=0))


def test_9_2_2_four_normal_quantities() -> None:
    """u = 2.0, [−3.92, 3.92] by both ways: validated with δ = 0.05."""
    found = run([Normal(0.0, 1.0)] * 4, total)
    assert (found.mean, found.standard) == pytest.approx((0.0, 2.0), abs=0.01)
    assert found.symmetric == pytest.approx((-3.92, 3.92), abs=0.025)
    assert found.shortest == pytest.approx((-3.92, 3.92), abs=0.1)
    check = validate(found, -3.92, 3.92, standard=2.0, digits=2)
    assert (check.tolerance, check.validated) == (0.05, True)


def test_9_2_3_four_rectangular_quantities_of_the_same_width() -> None:
    """u = 2.0, [−3.88, 3.88] against ±3.92: the ends differ by 0.04, which δ = 0.05 allows."""
    found = run([Rectangular(0.0, math.sqrt(3.0))] * 4, total, trials=4 * TRIALS)
    assert found.standard == pytest.approx(2.0, abs=0.005)
    assert found.symmetric == pytest.approx((-3.88, 3.88), abs=0.01)
    assert validate(found, -3.92, 3.92, standard=2.0, digits=2).validated


def test_9_2_4_rectangular_quantities_one_of_them_ten_times_as_wide() -> None:
    """u = 10.1, [−17.0, 17.0] against ±19.9: not validated."""
    found = run([*[Rectangular(0.0, math.sqrt(3.0))] * 3, Rectangular(0.0, 10.0 * math.sqrt(3.0))], total)
    assert found.standard == pytest.approx(10.15, abs=0.03)
    assert found.symmetric == pytest.approx((-17.0, 17.0), abs=0.06)
    check = validate(found, -19.9, 19.9, standard=10.1, digits=2)
    assert (check.tolerance, check.validated) == (0.5, False)


def test_9_3_mass_calibration() -> None:
    """δm in mg. First order: 1.2340, u = 0.0539, [1.1285, 1.3395]: not validated; with the terms of second
    order u = 0.0750, [1.0870, 1.3810]: validated. Trials: u = 0.0754, [1.0834, 1.3825]; δ = 0.005."""
    inputs: list[Input] = [
        Normal(100_000.000, 0.050),
        Normal(1.234, 0.020),
        Rectangular(1.20, 0.10),
        Rectangular(8e3, 1e3),
        Rectangular(8e3, 0.05e3),
    ]

    def model(x: Array) -> Array:
        """Conventional mass less the nominal 100 g."""
        return np.asarray((x[0] + x[1]) * (1.0 + (x[2] - 1.2) * (1.0 / x[3] - 1.0 / x[4])) - 1e5)

    found = run(inputs, model)
    assert found.mean == pytest.approx(1.2340, abs=5e-4)
    assert found.standard == pytest.approx(0.0754, abs=3e-4)
    assert found.shortest == pytest.approx((1.0834, 1.3825), abs=2e-3)
    first_order = math.hypot(0.050, 0.020)
    assert first_order == pytest.approx(0.0539, abs=5e-5)
    first = validate(found, 1.1285, 1.3395, standard=0.0539, digits=1)
    second = validate(found, 1.0870, 1.3810, standard=0.0750, digits=1)
    assert first.tolerance == pytest.approx(0.005)
    assert (first.validated, second.validated) == (False, True)


@pytest.mark.parametrize(
    ("x1", "r", "mean", "standard", "interval", "gum"),
    # all 1e-6; the first-order interval is y ± 1.96·2·x₁·u
    [
        (0.000, 0.0, 50, 50, (0, 150), (0, 0)),
        (0.010, 0.0, 150, 112, (0, 367), (-96, 296)),
        (0.050, 0.0, 2551, 502, (1590, 3543), (1520, 3480)),
        (0.000, 0.9, 50, 67, (0, 185), (0, 0)),
        (0.010, 0.9, 150, 121, (13, 398), (-96, 296)),
        (0.050, 0.9, 2551, 505, (1628, 3555), (1520, 3480)),
    ],
)
def test_9_4_comparison_loss_in_microwave_power_meter_calibration(
    x1: float, r: float, mean: float, standard: float, interval: tuple[float, float], gum: tuple[float, float]
) -> None:
    """δY = X₁² + X₂², u(x₁) = u(x₂) = 0.005: in no case is the first order validated."""
    inputs = [Joint(("X₁", "X₂"), (x1, 0.0), (0.005, 0.005), ((1.0, r), (r, 1.0)))]
    found = run(inputs, lambda x: 1e6 * (x[0] ** 2 + x[1] ** 2))
    assert found.mean == pytest.approx(mean, abs=2.0)
    assert found.standard == pytest.approx(standard, abs=1.5)
    # a nearly normal density is flat about its shortest interval: shifted by 13 it is longer by 1 only
    assert found.shortest == pytest.approx(interval, abs=15.0 if x1 == 0.05 else 2.5)
    assert not validate(found, *gum, standard=0.5 * (gum[1] - gum[0]) / 1.96, digits=1).validated


def test_9_5_gauge_block() -> None:
    """δL in nm, 99 %: 838, u = 36, [745, 932] of the trials; 838, u = 32, [745, 931] of the GUM: validated
    with δ = 5."""
    inputs: list[Input] = [
        StudentT(50_000_623.0, 25.0, 18.0),
        StudentT(215.0, 6.0, 24.0),
        StudentT(0.0, 4.0, 5.0),
        StudentT(0.0, 7.0, 8.0),
        Rectangular(11.5e-6, 2e-6),
        Normal(-0.1, 0.2),
        ArcSine(0.0, 0.5),
        CurvilinearTrapezoid(0.0, 1.0e-6, 0.1e-6),
        CurvilinearTrapezoid(0.0, 0.050, 0.025),
    ]

    def model(x: Array) -> Array:
        """L_S + D − L_S·(δα·Θ + α_S·δΘ) less the nominal 50 mm."""
        length, comparison, theta = x[0], x[1] + x[2] + x[3], x[5] + x[6]
        return np.asarray(length - 5e7 + comparison - length * (x[7] * theta + x[4] * x[8]))

    found = run(inputs, model, probability=0.99)
    assert found.mean == pytest.approx(838.0, abs=0.6)
    assert found.standard == pytest.approx(36.0, abs=0.5)
    assert found.shortest == pytest.approx((745.0, 932.0), abs=3.0)
    check = validate(found, 745.0, 931.0, standard=32.0, digits=1)
    assert (check.tolerance, check.validated) == (5.0, True)
