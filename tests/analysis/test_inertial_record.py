"""A recording in SI units, and the doubts about its units."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.analysis.inertial_record import records, some_of
from ahrs_lab.errors import InputError
from ahrs_lab.recording.read import read_bundle

HEADER = """format = "ahrs-lab-recording"
version = 1
procedure = "static"
[site]
latitude_deg = 39.9042
[device]
rate_unit = "deg/s"
accel_unit = "{accel_unit}"
sample_rate_hz = 10.0
[[segment]]
file = "a.csv"
orientation = "ENU"
item = "static"
"""


def bundle(folder: Path, accel_unit: str, up: float, columns: str = "gyro_x,gyro_y,gyro_z") -> Path:
    folder.joinpath("recording.toml").write_text(HEADER.format(accel_unit=accel_unit), encoding="utf-8")
    rows = [f"{(i + 1) / 10},1.0,2.0,{180.0},0,0,{up}" for i in range(100) if i != 50]
    head = f"t_s,{columns},accel_x,accel_y,accel_z"
    folder.joinpath("a.csv").write_text("\n".join([head, *rows]), encoding="utf-8")
    return folder


def test_of_a_hundred_segments_a_sentence_names_the_first() -> None:
    names = [f"{number}.csv" for number in range(100)]
    assert some_of(names) == "0.csv, 1.csv, 2.csv, 3.csv, 4.csv, 5.csv, …"
    assert some_of(names[:6]) == "0.csv, 1.csv, 2.csv, 3.csv, 4.csv, 5.csv"


def test_units_become_si_and_a_gap_is_known(tmp_path: Path) -> None:
    (record,) = records(read_bundle(bundle(tmp_path, "g", 1.0)))
    assert len(record) == 99
    assert record.rate[0] == pytest.approx(np.radians([1.0, 2.0, 180.0]))
    assert record.needed_force()[0] == pytest.approx([0.0, 0.0, 9.80665])
    assert record.gaps.tolist() == [50]
    assert record.angle_increments_rad[50, 2] == pytest.approx(0.2 * np.pi)
    assert record.needed_si() is record
    assert record.velocity_increments_mps()[0, 2] == pytest.approx(0.980665)


@pytest.mark.parametrize(
    ("unit", "up", "likely"), [("m/s^2", 1.0, "g"), ("g", 9.8, "m/s^2"), ("g", 4096.0, "LSB")]
)
def test_a_unit_that_gravity_contradicts_is_named(tmp_path: Path, unit: str, up: float, likely: str) -> None:
    (record,) = records(read_bundle(bundle(tmp_path, unit, up)))
    with pytest.raises(InputError, match=rf"these look like .*{re.escape(likely)}"):
        record.needed_si()


def test_counts_ask_for_the_calibration_set(tmp_path: Path) -> None:
    (record,) = records(read_bundle(bundle(tmp_path, "LSB", 4096.0)))
    with pytest.raises(InputError, match="compensate"):
        record.needed_si()


def test_without_gyros_there_is_nothing_to_analyse(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        records(read_bundle(bundle(tmp_path, "g", 1.0, "a,b,c")))


def test_an_unknown_segment_is_told_with_those_that_are_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no segment b\.csv; there are: a\.csv"):
        records(read_bundle(bundle(tmp_path, "g", 1.0)), "b.csv")
