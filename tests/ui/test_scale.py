"""The value axis goes in steps: grows at once, shrinks late, and always holds the data."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.ui.plots.scale import SteppedRange, nice_range, nice_step, ticks

values = st.floats(-1e4, 1e4, allow_nan=False)


def test_steps_are_one_two_five() -> None:
    assert [nice_step(span) for span in (4.0, 4.1, 8.1, 20.1, 0.04)] == [1.0, 2.0, 5.0, 10.0, 0.01]


@given(values, values)
def test_range_holds_the_data_and_is_at_most_a_few_steps_wider(a: float, b: float) -> None:
    low, high = min(a, b), max(a, b)
    bottom, top = nice_range(low, high, 0.02)
    slack = 1e-6 * max(1.0, abs(low), abs(high))
    assert bottom <= low + slack
    assert top >= high - slack
    step = nice_step(max(high - low, 0.02))
    assert top - bottom <= max(high - low, 0.02) + 2 * step + slack


@given(st.lists(st.tuples(values, values), min_size=1, max_size=60))
def test_shown_range_always_holds_the_data(looks: list[tuple[float, float]]) -> None:
    shown = SteppedRange(0.02)
    for a, b in looks:
        shown.follow(min(a, b), max(a, b))
        slack = 1e-6 * max(1.0, abs(a), abs(b))
        assert shown.low <= min(a, b) + slack
        assert shown.high >= max(a, b) - slack


def test_range_shrinks_only_after_a_while() -> None:
    shown = SteppedRange(0.02)
    shown.follow(-100.0, 100.0)
    changes = [shown.follow(-1.0, 1.0) for _ in range(100)]
    assert changes.count(True) == 1
    assert changes.index(True) > 20
    assert (shown.low, shown.high) == (-1.0, 1.0)


@pytest.mark.parametrize(
    ("low", "high"), [(-200.0, 200.0), (0.7, 1.5), (-0.01, 0.01), (0.55, 0.85), (3.0, 3.4)]
)
def test_an_axis_has_at_least_two_numbers_where_two_have_room(low: float, high: float) -> None:
    for apart in (0.0, 0.2, 0.45):
        assert len(ticks(low, high, apart * (high - low))[1]) >= 2


@pytest.mark.parametrize(
    ("low", "high", "number"),
    [(-200.0, 200.0, 0.0), (0.7, 1.5, 1.0), (-210.0, 30.0, 0.0), (3.1, 3.4, 3.2)],
)
def test_where_one_number_has_room_it_is_a_round_one(low: float, high: float, number: float) -> None:
    assert ticks(low, high, 1.2 * (high - low))[1] == pytest.approx([number])


@given(values, st.floats(1e-3, 1e3), st.floats(0.0, 3.0))
def test_numbers_lie_on_the_axis_and_keep_their_distance(low: float, span: float, apart: float) -> None:
    high, slack = low + span, 1e-6 * (span + abs(low))
    step, found = ticks(low, high, apart * span)
    assert 1 <= len(found) <= 5
    assert low - slack <= found[0] <= found[-1] <= high + slack
    assert all(b - a >= apart * span - slack for a, b in itertools.pairwise(found))
    assert all(abs(value / step - round(value / step)) < 1e-6 for value in found)
