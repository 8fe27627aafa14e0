"""The mean of a dwell so far, against numpy over all its samples."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.ui.plots.running_mean import RunningMeanOf


def test_mean_and_standard_error_are_those_of_all_samples_and_of_their_1_s_means() -> None:
    values = np.random.default_rng(3).normal(5.0, 0.3, 100 * 60)
    t_s = 7.0 + np.arange(len(values)) / 100.0
    running = RunningMeanOf()
    for start in range(0, len(values), 137):
        running.append(t_s[start : start + 137], values[start : start + 137])
    seen = running.look()
    # The last second has no successor yet, so its batch is not closed.
    batches = values.reshape(60, 100).mean(axis=1)[:-1]
    assert seen.samples == 6000
    assert seen.mean == pytest.approx(values.mean(), rel=1e-12)
    assert seen.error == pytest.approx(batches.std(ddof=1) / np.sqrt(59), rel=1e-9)
    assert seen.elapsed_s == pytest.approx(59.99)
    np.testing.assert_allclose(seen.means, np.cumsum(batches) / np.arange(1, 60), rtol=1e-12)
    np.testing.assert_allclose(seen.history_s, np.arange(1, 60))


def test_a_dwell_of_half_an_hour_keeps_a_short_history() -> None:
    running = RunningMeanOf()
    t_s = np.arange(0.0, 1800.0, 0.1)
    running.append(t_s, np.ones_like(t_s))
    seen = running.look()
    assert 256 <= len(seen.history_s) <= 512
    assert seen.history_s[-1] > 1790.0


def test_values_that_are_not_finite_count_for_nothing() -> None:
    running = RunningMeanOf()
    running.append(np.arange(4.0), np.array([1.0, np.nan, np.inf, 3.0]))
    assert running.look().samples == 2
    assert running.look().mean == 2.0


def test_restart_forgets() -> None:
    running = RunningMeanOf()
    running.append(np.arange(10.0), np.ones(10))
    running.restart()
    assert running.look().samples == 0
    assert np.isnan(running.look().mean)
    assert running.elapsed_s == 0.0
