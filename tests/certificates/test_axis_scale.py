"""Ticks of linear and logarithmic axes."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.certificates.axis_scale import axis_ticks, number_text


def test_linear_ticks_are_round_and_within_the_range() -> None:
    ticks = axis_ticks(-0.3, 10.2, 6)
    assert ticks.texts == ("0", "2", "4", "6", "8", "10")
    assert axis_ticks(0.0, 1230.0, 6).texts == ("0", "500", "1000")
    assert axis_ticks(-25_000.0, 25_000.0, 6).texts[0] == "−20\N{THIN SPACE}000"


def test_very_large_and_very_small_numbers_carry_a_power_of_ten() -> None:
    assert axis_ticks(0.0, 4e-6, 4).texts == ("0", "1×10^{−6}", "2×10^{−6}", "3×10^{−6}", "4×10^{−6}")
    assert axis_ticks(0.0, 3e7, 3).texts == ("0", "1×10^{7}", "2×10^{7}", "3×10^{7}")
    assert number_text(1.25e-5, 1e-7) == "1.25×10^{−5}"


def test_decades_of_a_logarithmic_axis_have_lines_between_them() -> None:
    ticks = axis_ticks(0.05, 2000.0, 8, log=True)
    assert ticks.texts == ("0.1", "1", "10", "100", "1000")
    assert {0.2, 0.05, 2000.0} <= {round(value, 9) for value in ticks.minor}
    assert axis_ticks(1e-9, 1e-3, 8, log=True).texts[0] == "10^{−9}"


def test_many_decades_name_only_some() -> None:
    ticks = axis_ticks(1e-12, 1e12, 6, log=True)
    assert len(ticks.texts) <= 7
    assert len(ticks.values) + len(ticks.minor) == 25


def test_a_short_logarithmic_axis_has_numbers_between_the_decades() -> None:
    assert axis_ticks(0.5, 60.0, 8, log=True).texts == ("0.5", "1", "2", "5", "10", "20", "50")
    assert len(axis_ticks(1.0, 1.5, 5, log=True).texts) >= 2


@given(st.floats(-1e9, 1e9), st.floats(1e-9, 1e9), st.integers(2, 12), st.booleans())
def test_every_range_has_a_scale_that_can_be_read(low: float, span: float, most: int, log: bool) -> None:
    low = abs(low) + 1e-9 if log else low
    high = low + max(span, 1e-6 * abs(low))
    ticks = axis_ticks(low, high, most, log=log)
    assert len(ticks.values) == len(ticks.texts)
    assert 2 <= len(ticks.values) <= 4 * most + 10
    assert len(set(ticks.texts)) == len(ticks.texts)
    slack = 1e-6 * (high - low)
    assert all(low - slack <= value <= high + slack for value in (*ticks.values, *ticks.minor))


@pytest.mark.parametrize("value", [0.0, 3.0, -2e-9])
def test_a_range_of_one_point_has_that_point(value: float) -> None:
    (text,) = axis_ticks(value, value, 5).texts
    assert text
    assert math.isfinite(axis_ticks(value, value, 5).values[0])
