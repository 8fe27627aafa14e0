"""The sample that was simulated outside the project."""

from __future__ import annotations

import hashlib
import tomllib
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.recording.read import Recording, read_bundle
from ahrs_lab.recording.samples import interval_s

B_DPS = {"x": 3.087392621666639e-3, "y": -2.3500235037499885e-3, "z": 1.805527627916662e-3}
L_RAD = {
    "yx": -2.6885030749999997e-4,
    "zx": 3.9153196791666666e-4,
    "xy": 6.027772040277779e-4,
    "zy": -7.190909452777777e-4,
    "xz": -4.287619295833333e-4,
    "yz": 8.788338404166666e-4,
}


@pytest.fixture(scope="module")
def sample(shared: Path) -> Recording:
    return read_bundle(shared / "samples/mems-unit-a")


def angle_deg(recording: Recording, name: str, axis: str) -> float:
    entry = next(entry for entry in recording.segments if entry.segment.name == name)
    return float(np.sum(entry.samples[f"gyro_{axis}"] * interval_s(entry.samples, 10.0)))


def test_nothing_in_it_is_unusable(sample: Recording) -> None:
    assert len(sample.segments) == 54
    assert [finding for finding in sample.findings if finding.severity == "unusable"] == []
    assert all(entry.usable and entry.lost == 0 for entry in sample.segments)


def test_only_the_slow_rates_are_noted_for_less_than_a_whole_turn(sample: Recording) -> None:
    noted = {finding.segment: finding.kind for finding in sample.findings}
    assert noted == {f"segments/sf_{axis}_0{n}.csv": "dwell" for axis in "xyz" for n in (4, 5)}


@pytest.mark.parametrize("axis", "xyz")
def test_intervals_give_the_printed_zero_offset(sample: Recording, axis: str) -> None:
    turned = sum(angle_deg(sample, f"zo_{axis}_{position}", axis) for position in range(1, 5))
    assert turned / (4 * 600.0) == pytest.approx(B_DPS[axis], rel=1e-12)


@pytest.mark.parametrize("pair", L_RAD)
def test_intervals_give_the_printed_misalignment(sample: Recording, pair: str) -> None:
    turned = angle_deg(sample, f"ma_{pair[1]}_pos", pair[0]) - angle_deg(sample, f"ma_{pair[1]}_neg", pair[0])
    assert turned / 7200.0 == pytest.approx(L_RAD[pair], rel=1e-12)


def test_the_hash_covers_header_and_files_in_order(sample: Recording, shared: Path) -> None:
    folder = shared / "samples/mems-unit-a"
    listed = tomllib.loads((folder / "recording.toml").read_text())["segment"]
    total = hashlib.sha256()
    for name in ["recording.toml", *(entry["file"] for entry in listed)]:
        data = (folder / name).read_bytes()
        total.update(name.encode() + b"\0" + len(data).to_bytes(8, "big") + data)
    assert sample.sha256 == total.hexdigest()
