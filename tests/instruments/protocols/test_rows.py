"""Wraps made continuous, and rows woven of frames of several kinds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.instruments.protocols.frames import LinkCounts
from ahrs_lab.instruments.protocols.rows import COUNTER, TICKS, Clockwork, Part, Rank, RowMaker, Unwrapper
from ahrs_lab.instruments.protocols.stream import joined
from ahrs_lab.recording.samples import Samples


@given(
    start=st.integers(0, 65535),
    steps=st.lists(st.integers(1, 60_000), min_size=1, max_size=60),
    cut=st.integers(0, 60),
)
def test_a_counter_counts_on_over_its_end(start: int, steps: list[int], cut: int) -> None:
    true = start + np.concatenate([[0], np.cumsum(steps)]).astype(float)
    unwrapper = Unwrapper(1 << 16, forward_only=True)
    blocks = np.split(true % 65536, [min(cut, len(true))])
    np.testing.assert_array_equal(np.concatenate([unwrapper.unwrap(block) for block in blocks]), true)


def test_a_time_steps_back_where_the_device_was_booted_again() -> None:
    unwrapper = Unwrapper(1 << 32, forward_only=False)
    raw = np.array([2.0**32 - 20, 2.0**32 - 10, 0.0, 10.0])
    np.testing.assert_array_equal(unwrapper.unwrap(raw), 2.0**32 - 20 + 10.0 * np.arange(4))
    booted = Unwrapper(1 << 32, forward_only=False)
    np.testing.assert_array_equal(booted.unwrap(np.array([5000.0, 5010.0, 3.0, 13.0])), [5000, 5010, 3, 13])


def part(kind: str, rank: Rank, orders: list[int], **columns: Sequence[float]) -> Part:
    arrays = {name: np.array(values, dtype=float) for name, values in columns.items()}
    return Part(kind, rank, np.array(orders, dtype=np.int64), arrays)


def maker(rate_hz: float | None = None) -> RowMaker:
    return RowMaker(LinkCounts(), Clockwork(ticks_per_s=1e4), rate_hz)


def test_a_slow_frame_is_carried_into_the_rows_behind_it() -> None:
    rows = maker()
    gyro = part("g", Rank.RAW_RATE, [0, 1, 3, 4], gyro_x=[1, 2, 3, 4], t_s=[1, 2, 3, 4])
    slow = part("t", Rank.CARRIED, [2], temperature_c=[25])
    made = rows.feed([gyro, slow])
    np.testing.assert_array_equal(made["gyro_x"], [1, 2, 3, 4])
    np.testing.assert_array_equal(made["temperature_c"], [np.nan, np.nan, 25, 25])
    later = rows.feed([part("g", Rank.RAW_RATE, [5], gyro_x=[5], t_s=[5])])
    assert later["temperature_c"].tolist() == [25]


def test_a_row_whose_time_was_lost_is_dropped_and_counted() -> None:
    rows = maker()
    clock = part("c", Rank.CARRIED, [0, 2, 5], t_s=[1, 2, 4])
    gyro = part("g", Rank.RAW_RATE, [1, 3, 4, 6], gyro_x=[10, 20, 30, 40])
    made = rows.feed([clock, gyro])
    assert made["t_s"].tolist() == [1, 2, 4]
    assert made["gyro_x"].tolist() == [10, 20, 40]
    assert rows.counts.untimed == 1


def test_raw_rates_make_the_rows_where_filtered_ones_come_too() -> None:
    rows = maker()
    filtered = part("f", Rank.FILTERED_RATE, [0, 2], gyro_x=[1, 1], heading_deg=[90, 91])
    raw = part("r", Rank.RAW_RATE, [1, 3], gyro_x=[5, 6])
    made = rows.feed([filtered, raw])
    assert made["gyro_x"].tolist() == [5, 6]
    assert made["heading_deg"].tolist() == [90, 91]


def test_better_frames_take_over_where_they_first_come() -> None:
    rows = maker()
    first = rows.feed([part("a", Rank.ATTITUDE, [0, 1, 2], heading_deg=[1, 2, 3])])
    both = rows.feed(
        [
            part("a", Rank.ATTITUDE, [3, 5], heading_deg=[4, 5]),
            part("g", Rank.RAW_RATE, [4, 6], gyro_x=[7, 8]),
        ]
    )
    assert len(first) == 3
    assert both["heading_deg"].tolist() == [4, 4, 5]
    np.testing.assert_array_equal(both["gyro_x"], [np.nan, 7, 8])


def test_a_time_that_is_guessed_says_so() -> None:
    plain = [part("g", Rank.RAW_RATE, [0, 1], gyro_x=[1, 2])]
    rows = maker()
    assert "t_s" not in rows.feed(plain)
    assert rows.time_source == "none"
    counted = maker(50.0)
    assert counted.feed(plain)["t_s"].tolist() == [0.02, 0.04]
    assert counted.time_source == "counted at the nominal rate"
    by_counter = maker(50.0)
    gapped = [part("g", Rank.RAW_RATE, [0, 1], gyro_x=[1, 2], **{COUNTER: [65535, 1]})]
    assert by_counter.feed(gapped)["t_s"].tolist() == pytest.approx([1310.7, 1310.74])
    assert by_counter.time_source == "device counter"
    by_time = maker(50.0)
    assert by_time.feed([part("g", Rank.RAW_RATE, [0, 1], gyro_x=[1, 2], **{TICKS: [7, 9]})])[
        "t_s"
    ].tolist() == ([7e-4, 9e-4])
    assert by_time.time_source == "device time"


def test_a_single_frame_waits_for_the_second_or_the_end() -> None:
    rows = maker()
    assert not len(rows.feed([part("g", Rank.RAW_RATE, [0], gyro_x=[1])]))
    assert rows.flush()["gyro_x"].tolist() == [1]


def test_rows_that_say_nothing_yet_wait_for_the_first_column() -> None:
    rows = maker()
    nothing = part("g", Rank.RAW_RATE, [0, 1], gyro_x=[np.nan, np.nan])
    assert not len(rows.feed([nothing]))
    made = rows.feed([part("g", Rank.RAW_RATE, [2], gyro_x=[3])])
    np.testing.assert_array_equal(made["gyro_x"], [np.nan, np.nan, 3])
    assert not len(rows.flush())


def test_blocks_are_joined_under_the_columns_of_all() -> None:
    whole = joined(
        [Samples({"a": np.array([1.0])}), Samples(), Samples({"a": np.array([2.0]), "b": np.array([3.0])})]
    )
    np.testing.assert_array_equal(whole["a"], [1, 2])
    np.testing.assert_array_equal(whole["b"], [np.nan, 3])
