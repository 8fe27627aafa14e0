"""Damaged samples are left out and counted; a device that restarts is told, not recorded."""

from __future__ import annotations

import numpy as np
import pytest

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.drivers.ahrs.screening import Screening
from ahrs_lab.recording.samples import Samples


def samples(t_s: np.ndarray, *, gyro: float = 0.1, late_s: float = 0.002, counter: bool = True) -> Samples:
    columns = {"t_s": t_s, "host_t_s": t_s + late_s}
    columns |= {f"gyro_{axis}": np.full(len(t_s), gyro) for axis in "xyz"}
    if counter:
        columns["counter"] = np.rint(t_s / 0.01)
    return Samples(columns)


def times(first: int, last: int) -> np.ndarray:
    return np.arange(first, last + 1) * 0.01


def test_an_undamaged_stream_passes_unchanged() -> None:
    screening = Screening(0.01, 10.0)
    block = samples(times(1, 100))
    assert screening.take(block) is block
    assert (screening.lost, screening.repeated, screening.implausible) == (0, 0, 0)


@pytest.mark.parametrize("counter", [True, False])
def test_missing_samples_are_counted_also_between_blocks(counter: bool) -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 10), counter=counter))
    screening.take(samples(times(14, 20), counter=counter))
    assert screening.lost == 3


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e9, 16.0])
def test_a_rate_no_device_has_is_left_out(value: float) -> None:
    screening = Screening(0.01, 10.0)
    block = samples(times(1, 20))
    block["gyro_y"][7] = value
    kept = screening.take(block)
    assert len(kept) == 19
    assert screening.implausible == 1
    assert np.abs(kept["gyro_y"]).max() < 1.0


@pytest.mark.parametrize("jump_s", [5.0, -0.05])
def test_one_sample_with_a_damaged_time_is_left_out_and_its_neighbours_are_not(jump_s: float) -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 50)))
    block = samples(times(51, 60))
    block["t_s"][4] += jump_s
    kept = screening.take(block)
    assert np.allclose(np.delete(times(51, 60), 4), kept["t_s"])
    assert screening.implausible == 1


def test_repeated_samples_are_left_out_and_counted() -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 10)))
    kept = screening.take(samples(np.concatenate([times(10, 12), times(12, 14)])))
    assert np.allclose(kept["t_s"], times(11, 14))
    assert screening.repeated == 2


def test_a_restart_of_the_device_is_told() -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 3000)))
    after = samples(times(1, 10), late_s=31.0)
    with pytest.raises(InstrumentError, match=r"has restarted: its time went back from 30\.0 s to 0\.01 s"):
        screening.take(after)


def test_a_jump_of_the_devices_time_is_told() -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 100)))
    ahead = samples(times(101, 110) + 60.0, late_s=-60.0)
    with pytest.raises(InstrumentError, match="time has jumped"):
        screening.take(ahead)


def test_a_link_that_stalls_for_seconds_is_no_jump() -> None:
    screening = Screening(0.01, 10.0)
    screening.take(samples(times(1, 100)))
    late = samples(times(101, 400)).with_columns({"host_t_s": np.full(300, 4.5)})
    assert len(screening.take(late)) == 300
    assert len(screening.take(samples(times(401, 500)))) == 100
