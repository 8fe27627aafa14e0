"""A corrected copy keeps what was recorded, and what became of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.recording.corrected_copy import write_corrected
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.samples import GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter


def block(value: float) -> Samples:
    times = (np.arange(300) + 1) / 10
    return Samples({"t_s": times, **{name: np.full(300, value) for name in GYRO}})


def recorded(folder: Path) -> Path:
    """Taken twice, interrupted once, and one set aside without a repetition."""
    header = RecordingHeader(
        "dynamic", Site(40.0), DeviceDescription(sample_rate_hz=10.0), notes={"room": "7"}
    )
    with BundleWriter(folder, header) as writer:
        for name, value in (("a", 1.0), ("a", 2.0), ("b", 3.0), ("c", 4.0)):
            writer.begin(Segment(name, Orientation("ENU"), "dynamic", "z", "position"))
            writer.append(block(value))
            if name == "b":
                writer.interrupt("the power failed")
            else:
                writer.finish()
        writer.supersede("c", "the table was touched")
    return folder


def test_values_change_and_the_story_stays(tmp_path: Path) -> None:
    source = read_bundle(recorded(tmp_path / "in"))
    write_corrected(
        source,
        tmp_path / "out",
        lambda one: one.samples.with_columns({"gyro_x": 10 * one.samples["gyro_x"]}),
        {"correction": {"factor": 10}},
    )
    copy = read_bundle(tmp_path / "out")
    assert [one.samples["gyro_x"][0] for one in copy.segments] == [10.0, 20.0, 30.0, 40.0]
    assert [one.samples["gyro_y"][0] for one in copy.segments] == [1.0, 2.0, 3.0, 4.0]
    for before, after in zip(source.segments, copy.segments, strict=True):
        for name in ("name", "superseded", "interrupted", "reason"):
            assert getattr(after.segment, name) == getattr(before.segment, name)
    notes = copy.header.notes
    assert notes["room"] == "7"
    assert notes["correction"] == {"factor": 10}
    assert notes["corrected_from"] == source.sha256


def test_a_recording_is_never_overwritten(tmp_path: Path) -> None:
    source = read_bundle(recorded(tmp_path / "in"))
    with pytest.raises(InputError, match="holds a recording already"):
        write_corrected(source, tmp_path / "in", lambda one: one.samples, {})
