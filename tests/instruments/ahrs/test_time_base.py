"""Device time against host time: known offsets and rates are found through late and bunched arrivals."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.instruments.time_base import TimeBase


def fed(device_s: np.ndarray, host_s: np.ndarray, block: int = 50) -> TimeBase:
    base = TimeBase()
    for at in range(0, len(device_s), block):
        base.add(device_s[at : at + block], host_s[at : at + block])
    return base


@pytest.mark.parametrize("rate_ppm", [-50.0, 0.0, 120.0])
def test_offset_and_rate_are_found_through_bunches_of_sixteen_milliseconds(rate_ppm: float) -> None:
    device = np.arange(1, 60001) * 0.01
    made = 100.0 + device * (1.0 + rate_ppm * 1e-6)
    host = np.ceil(made / 0.016) * 0.016
    relation = fed(device, host).relation
    assert relation is not None
    assert relation.rate_ppm is not None
    assert relation.rate_ppm == pytest.approx(rate_ppm, abs=0.1)
    assert relation.offset_s == pytest.approx(made[-1] - device[-1], abs=2e-4)
    assert 0.012 < relation.jitter_s < 0.0162


def test_a_stall_of_seconds_moves_neither_offset_nor_rate() -> None:
    device = np.arange(1, 20001) * 0.01
    host = 5.0 + device
    host[7000:7400] = host[7400]
    relation = fed(device, host).relation
    assert relation is not None
    assert relation.rate_ppm is not None
    assert relation.rate_ppm == pytest.approx(0.0, abs=1e-6)
    assert relation.offset_s == pytest.approx(5.0, abs=1e-9)


def test_no_rate_is_claimed_from_less_than_two_seconds() -> None:
    device = np.arange(1, 101) * 0.01
    relation = fed(device, device + 1.0).relation
    assert relation is not None
    assert relation.rate_ppm is None
    assert relation.offset_s == pytest.approx(1.0)


def test_days_of_samples_are_kept_in_a_bounded_number_of_points() -> None:
    device = np.arange(1, 200001) * 1.0
    base = fed(device, device * (1.0 + 1e-5) + 3.0, block=1000)
    assert len(base._buckets) <= 1200
    assert base.relation is not None
    assert base.relation.rate_ppm == pytest.approx(10.0, abs=1e-3)
