"""What is read while the recording goes on is what is read at its end, or it is read again."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.read_ahead import ReadAhead
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter
from tests.recording.making import columns

HEADER = RecordingHeader("jjf1536-2015", Site(39.9), DeviceDescription(sample_rate_hz=50.0))


@pytest.fixture
def ahead(tmp_path: Path) -> Iterator[ReadAhead]:
    with ReadAhead(tmp_path / "recording") as made:
        yield made


def record(writer: BundleWriter, name: str, position: int) -> Segment:
    writer.begin(Segment(name, Orientation("ENU"), "zero_offset", "x", "position", position=position))
    writer.append(Samples(columns(30.0, "ENU")))
    return writer.finish()


def test_the_recording_is_the_same_and_nothing_is_read_twice(
    ahead: ReadAhead, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "recording"
    with BundleWriter(folder, HEADER) as writer:
        for position in (1, 2):
            ahead.take(record(writer, f"zo_x_{position}", position))
    alone = read_bundle(folder)
    for one in alone.segments:
        assert ahead.get(one.segment, alone.header) is not None
    monkeypatch.setattr("ahrs_lab.recording.read.read_segment", lambda *_: pytest.fail("read again"))
    helped = read_bundle(folder, ahead)
    assert helped.sha256 == alone.sha256
    assert helped.findings == alone.findings
    for a, b in zip(alone.segments, helped.segments, strict=True):
        assert a.segment == b.segment
        assert np.array_equal(a.samples["gyro_x"], b.samples["gyro_x"])


def test_a_file_that_changed_since_is_read_again(ahead: ReadAhead, tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    with BundleWriter(folder, HEADER) as writer:
        segment = record(writer, "zo_x_1", 1)
        ahead.take(segment)
        assert ahead.get(segment, writer.header) is not None
    os.utime(folder / segment.file, ns=(1, 1))
    assert ahead.get(segment, HEADER) is None
    assert len(read_bundle(folder, ahead).segments[0].samples) == 1500


def test_a_take_that_was_superseded_since_is_read_again(ahead: ReadAhead, tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    with BundleWriter(folder, HEADER) as writer:
        for _ in range(2):
            ahead.take(record(writer, "zo_x_1", 1))
    first, second = read_bundle(folder, ahead).segments
    assert first.segment.superseded
    assert not first.counts
    assert second.counts


def test_what_cannot_be_read_is_told_by_who_reads_it_at_the_end(ahead: ReadAhead, tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    with BundleWriter(folder, HEADER) as writer:
        segment = record(writer, "zo_x_1", 1)
        (folder / segment.file).rename(folder / "elsewhere")
        ahead.take(segment)
        assert ahead.get(segment, HEADER) is None
        (folder / "elsewhere").rename(folder / segment.file)
    assert len(read_bundle(folder, ahead).segments) == 1
