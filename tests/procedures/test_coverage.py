"""Of the 95 % intervals of whole calibrations 95 of 100 hold the truth; the long run is
``benchmarks/coverage.py``, its report ``docs/coverage.md``."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom, chi2

from benchmarks.coverage import QUANTITIES, Configuration, Tally, run
from benchmarks.coverage_report import GROUPS, members, ratios

RUNS = 100
LOW, HIGH = 0.94, 0.965
"""What the long run has to show; here the counts lie within what chance allows beside it (99.9 %)."""

SHOWN = (
    Configuration("tactical-fog", "standard", "noise alone"),
    Configuration("navigation-rlg", "combined", "clause 6"),
)


@pytest.fixture(scope="module", params=SHOWN, ids=lambda one: f"{one.grade}, {one.world}")
def tally(request: pytest.FixtureRequest) -> Tally:
    configuration: Configuration = request.param
    return run(configuration, RUNS, 7)


def test_the_intervals_of_each_quantity_hold_the_truth_as_often_as_they_say(tally: Tally) -> None:
    # fifteen quantities are looked at: each gets its part of the 0.1 %
    part = 0.0005 / len(QUANTITIES)
    least, most = binom.ppf(part, RUNS, LOW), binom.ppf(1.0 - part, RUNS, HIGH)
    counted = dict(zip(QUANTITIES, tally.covered.tolist(), strict=True))
    assert {name: n for name, n in counted.items() if not least <= n <= most} == {}


@pytest.mark.parametrize("group", GROUPS)
def test_the_stated_uncertainty_is_the_scatter(group: str, tally: Tally) -> None:
    # the axes may share one error of the table, so RUNS are the independent ones
    low, high = np.sqrt(chi2.ppf([0.0005, 0.9995], RUNS) / RUNS)
    assert low < ratios(tally, group)[1] < high


@pytest.mark.parametrize("group", ["F0", "B"])
def test_where_noise_dominates_the_error_is_the_statistical_limit(group: str, tally: Tally) -> None:
    count = RUNS * len(members(group))
    low, high = np.sqrt(chi2.ppf([0.0005, 0.9995], count) / count)
    assert low < ratios(tally, group)[0] < 1.05 * high
