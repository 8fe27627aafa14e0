"""The ring against brute force over all samples ever appended."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ahrs_lab.ui.plots.envelope import EnvelopeRing
from ahrs_lab.ui.plots.live_plot import polyline

Array = NDArray[np.float64]
SPAN_S, BINS = 6.0, 24
WIDTH_S = SPAN_S / BINS


def brute_force(t_s: Array, values: Array) -> dict[int, tuple[float, float, float, int]]:
    """Per bin of the last span: low, high, mean, count, of the finite values."""
    number = np.floor(t_s / WIDTH_S).astype(int)
    newest = int(np.floor(t_s.max() / WIDTH_S))
    found = {}
    for bin_ in range(newest - BINS + 1, newest + 1):
        if not (number == bin_).any():
            continue
        inside = values[(number == bin_) & np.isfinite(values)]
        empty = (np.nan, np.nan, np.nan, 0)
        found[bin_] = (inside.min(), inside.max(), inside.mean(), len(inside)) if len(inside) else empty
    return found


steps = st.floats(0.0, 2.0, allow_nan=False, width=32)
block = st.lists(st.tuples(steps, st.floats(-1e3, 1e3, width=32) | st.just(np.nan)), min_size=0, max_size=30)


@given(st.lists(block, min_size=1, max_size=8))
def test_ring_holds_low_high_mean_of_each_bin_of_the_last_span(
    blocks: list[list[tuple[float, float]]],
) -> None:
    ring = EnvelopeRing(1, SPAN_S, BINS)
    now, times, values = 100.0, [], []
    for part in blocks:
        t_s = now + np.cumsum([step for step, _ in part])
        y = np.array([value for _, value in part], dtype=np.float64)
        ring.append(np.asarray(t_s, dtype=np.float64), y[np.newaxis, :])
        now = float(t_s[-1]) if len(part) else now
        times += t_s.tolist()
        values += y.tolist()
    seen = ring.look()
    if not times:
        assert not len(seen.t_s)
        return
    expected = brute_force(np.array(times), np.array(values))
    np.testing.assert_allclose(seen.t_s, (np.array(list(expected)) + 0.5) * WIDTH_S)
    low, high, mean, count = np.array(list(expected.values())).T
    np.testing.assert_array_equal(seen.low[0], low)
    np.testing.assert_array_equal(seen.high[0], high)
    np.testing.assert_allclose(seen.mean[0], mean, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(seen.count[0], count)


def test_blocks_do_not_matter() -> None:
    t_s = np.sort(np.random.default_rng(1).uniform(0.0, 20.0, 4000))
    y = np.random.default_rng(2).normal(size=(3, 4000))
    whole, parts = EnvelopeRing(3, SPAN_S, BINS), EnvelopeRing(3, SPAN_S, BINS)
    whole.append(t_s, y)
    for start in range(0, 4000, 77):
        parts.append(t_s[start : start + 77], y[:, start : start + 77])
    a, b = whole.look(), parts.look()
    np.testing.assert_array_equal(a.t_s, b.t_s)
    np.testing.assert_array_equal(a.low, b.low)
    np.testing.assert_array_equal(a.high, b.high)
    np.testing.assert_array_equal(a.count, b.count)


def test_late_samples_go_where_they_belong_and_too_late_ones_nowhere() -> None:
    ring = EnvelopeRing(1, SPAN_S, BINS)
    ring.append(np.array([10.0]), np.array([[1.0]]))
    ring.append(np.array([9.0, 3.0, 10.0]), np.array([[5.0, 7.0, -2.0]]))
    seen = ring.look()
    assert seen.t_s.tolist() == [9.125, 10.125]
    assert seen.low[0].tolist() == [5.0, -2.0]
    assert seen.high[0].tolist() == [5.0, 1.0]


def test_a_long_block_at_once_leaves_only_its_end() -> None:
    ring = EnvelopeRing(1, SPAN_S, BINS)
    t_s = np.arange(0.0, 1800.0, 0.01)
    ring.append(t_s, t_s[np.newaxis, :])
    seen = ring.look()
    assert len(seen.t_s) == BINS
    assert seen.low[0, 0] == pytest.approx(1794.0)


def test_clear_forgets() -> None:
    ring = EnvelopeRing(1, SPAN_S, BINS)
    ring.append(np.array([10.0]), np.array([[1.0]]))
    ring.clear()
    assert len(ring.look().t_s) == 0
    assert ring.newest_s == -np.inf


def test_another_thread_may_append_while_one_looks() -> None:
    ring = EnvelopeRing(2, SPAN_S, BINS)
    faults: list[str] = []

    def write() -> None:
        for number in range(400):
            t_s = number * 0.1 + np.linspace(0.0, 0.09, 10)
            ring.append(t_s, np.vstack([t_s, t_s]))

    writer = threading.Thread(target=write)
    writer.start()
    while writer.is_alive():
        seen = ring.look()
        if (np.diff(seen.t_s) <= 0).any() or (seen.low > seen.high).any():
            faults.append("torn look")
    writer.join()
    assert faults == []
    assert ring.look().high[0, -1] == pytest.approx(39.99)


def test_polyline_goes_down_and_up_through_each_bin_and_stops_at_gaps() -> None:
    ring = EnvelopeRing(1, SPAN_S, BINS)
    t_s = np.array([8.1, 8.2, 8.3, 12.1])
    ring.append(t_s, np.array([[1.0, 3.0, 2.0, -4.0]]))
    x, y, joined = polyline(ring.look(), 0, now_s=12.1, gap_s=1.0)
    np.testing.assert_allclose(x, np.repeat([8.125, 8.375, 12.125], 2) - 12.1)
    assert y.tolist() == [1.0, 3.0, 2.0, 2.0, -4.0, -4.0]
    assert np.asarray(joined).tolist() == [1, 1, 1, 0, 1, 1]
    ring.append(np.arange(8.5, 12.0, 0.25), np.zeros((1, 14)))
    assert polyline(ring.look(), 0, now_s=12.1, gap_s=1.0)[2] == "all"
