"""Curves with more points than places: extremes stay, gaps stay, few points are left alone."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.analysis.curve_thinning import thinned
from ahrs_lab.analysis.report import Curve


def test_a_short_curve_is_left_as_it_is() -> None:
    curve = Curve("a", np.arange(200.0), np.zeros(200))
    assert thinned(curve, 100) is curve


@given(st.integers(0, 2**32 - 1), st.booleans(), st.integers(50, 400))
def test_every_kept_point_is_one_of_the_curve_and_no_extreme_is_lost(
    seed: int, log_x: bool, places: int
) -> None:
    generator = np.random.default_rng(seed)
    x = np.cumsum(generator.uniform(0.1, 1.0, 5000))
    y = generator.normal(size=5000)
    curve = Curve("a", x, y, y - 1.0, y + 1.0, axis="x")
    thin = thinned(curve, places, log_x=log_x)
    assert 2 <= len(thin.x) <= 2 * places + 1
    kept = np.searchsorted(x, thin.x)
    assert (x[kept] == thin.x).all()
    assert (np.diff(kept) > 0).all()
    assert (y[kept] == thin.y).all()
    assert thin.x[-1] == x[-1]
    assert (y.min(), y.max()) == (thin.y.min(), thin.y.max())
    assert thin.low is not None
    assert thin.high is not None
    assert (thin.high - thin.low == (y[kept] + 1.0) - (y[kept] - 1.0)).all()
    assert thin.axis == "x"


def test_logarithmic_places_keep_the_few_points_of_the_first_decades() -> None:
    x = np.arange(1.0, 100_001.0)
    thin = thinned(Curve("a", x, np.zeros_like(x)), 200, log_x=True)
    assert set(thin.x[thin.x < 20]) >= {1.0, 2.0, 3.0, 5.0, 10.0}
    even = thinned(Curve("a", x, np.zeros_like(x)), 200)
    assert (even.x < 20).sum() < 3


def test_a_gap_stays_a_gap() -> None:
    x = np.arange(10_000.0)
    y = np.where((x > 4000) & (x < 6000), np.nan, 1.0)
    thin = thinned(Curve("a", x, y), 100)
    hole = thin.x[~np.isfinite(thin.y)]
    assert hole.min() < 4200
    assert hole.max() > 5800


def test_a_path_that_runs_back_keeps_its_order() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 10_000)
    thin = thinned(Curve("a", np.cos(angle), np.sin(angle)), 100)
    assert len(thin.x) <= 201
    assert (np.diff(np.unwrap(np.arctan2(thin.y, thin.x))) > 0).all()
