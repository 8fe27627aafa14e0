"""The writer: what was recorded is there again, whatever happened in between."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO, Literal

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from ahrs_lab.errors import InputError, InstrumentError, MachineError
from ahrs_lab.recording import journal
from ahrs_lab.recording.archive import pack
from ahrs_lab.recording.csv_file import read_csv
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.read import ReadAhead, read_bundle, read_header
from ahrs_lab.recording.samples import Samples, concatenate
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site
from ahrs_lab.recording.write import BundleWriter
from tests.recording.making import columns

HEADER = RecordingHeader(
    "jjf1536-2015", Site(39.9, 50.0, 116.4), DeviceDescription(serial_number="7", sample_rate_hz=50.0)
)


def segment(name: str = "zo_x_1", **keys: Any) -> Segment:
    return replace(Segment(name, Orientation("ENU"), "zero_offset", "x", "position", position=1), **keys)


def block(seconds: float = 30.0, start_s: float = 0.0) -> Samples:
    made = columns(seconds, "ENU")
    made["t_s"] = made["t_s"] + start_s
    return Samples(made)


def record(writer: BundleWriter, entry: Segment, *blocks: Samples) -> Segment:
    writer.begin(entry)
    for samples in blocks:
        writer.append(samples)
    return writer.finish()


@pytest.mark.parametrize("file_format", ["parquet", "csv"])
def test_what_is_written_is_read(tmp_path: Path, file_format: Literal["parquet", "csv"]) -> None:
    entry = segment(
        turns=None, azimuth_deg=90.0, started_utc="2026-01-02T03:04:05Z", extra={"operator": "李"}
    )
    with BundleWriter(tmp_path / "r", HEADER, file_format=file_format) as writer:
        sealed = record(writer, entry, block(10.0), block(20.0, 10.0))
        writer.update_notes({"plan": {"name": "JJF", "missing": None}})
    assert sealed == replace(entry, file=f"segments/zo_x_1.{file_format}")
    recording = read_bundle(tmp_path / "r")
    assert recording.header == replace(HEADER, notes={"plan": {"name": "JJF"}})
    assert recording.segments[0].segment == sealed
    written = concatenate([block(10.0), block(20.0, 10.0)])
    assert recording.segments[0].samples["t_s"].tobytes() == written["t_s"].tobytes()
    assert recording.segments[0].usable
    assert sorted(path.name for path in (tmp_path / "r").rglob("*")) == [
        "recording.toml",
        "segments",
        f"zo_x_1.{file_format}",
    ]


finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    values=arrays.arrays(np.float64, st.tuples(st.integers(1, 20), st.just(5)), elements=finite),
    file_format=st.sampled_from(["parquet", "csv"]),
)
def test_any_number_comes_back_bit_for_bit(
    tmp_path_factory: pytest.TempPathFactory,
    values: np.ndarray[Any, Any],
    file_format: Literal["parquet", "csv"],
) -> None:
    made = {
        name: np.ascontiguousarray(values[:, i])
        for i, name in enumerate(("gyro_x", "gyro_y", "gyro_z", "a,b", "ü"))
    }
    made = {"t_s": np.arange(1, len(values) + 1) / 50.0, **made}
    folder = tmp_path_factory.mktemp("r")
    with BundleWriter(folder, HEADER, file_format=file_format) as writer:
        record(writer, segment(), Samples(made))
    back = read_bundle(folder).segments[0].samples
    assert {name: column.tobytes() for name, column in back.columns.items()} == {
        name: column.tobytes() for name, column in made.items()
    }


@given(st.binary(max_size=300))
def test_no_bytes_break_the_csv_reader(data: bytes) -> None:
    for body in (data, b"t_s,gyro_x,gyro_y,gyro_z\n" + data, b"t_s,gyro_x,gyro_y,gyro_z\n0.1,1,2,3\n" + data):
        try:
            raw = read_csv(body)
        except InputError:
            continue
        assert all(len(column) == len(raw) for column in raw.columns.values())


def test_the_recording_is_valid_while_the_next_segment_is_open(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        record(writer, segment(), block())
        writer.begin(segment("zo_x_2"))
        writer.append(block())
        during = read_bundle(tmp_path / "r")
        assert [entry.segment.name for entry in during.segments] == ["zo_x_1"]
        writer.discard("not wanted")
    after = read_bundle(tmp_path / "r")
    assert after.header.notes["discarded"] == [{"segment": "zo_x_2", "reason": "not wanted"}]
    assert [path.name for path in (tmp_path / "r/segments").iterdir()] == ["zo_x_1.parquet"]


def test_the_hash_does_not_depend_on_who_still_writes(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        record(writer, segment(), block())
        live = read_bundle(tmp_path / "r").sha256
        pack(tmp_path / "r", tmp_path / "a.ahrsrec")
    assert live == read_bundle(tmp_path / "r").sha256 == read_bundle(tmp_path / "a.ahrsrec").sha256


def test_a_second_take_supersedes_the_first_and_both_are_kept(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        record(writer, segment(), block())
        writer.supersede("zo_x_1", "cable moved")
        record(writer, segment(), block())
        record(writer, segment(), block())
        takes = writer.segments
    assert [entry.file for entry in takes] == [f"segments/zo_x_1{n}.parquet" for n in ("", ".2", ".3")]
    assert [(entry.superseded, entry.reason) for entry in takes] == [
        (True, "cable moved"),
        (True, "recorded again"),
        (False, ""),
    ]
    assert [entry.counts for entry in read_bundle(tmp_path / "r").segments] == [False, False, True]


def test_superseding_what_is_not_there_is_refused(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer, pytest.raises(InputError, match="no segment zo_y_1"):
        writer.supersede("zo_y_1", "x")


def test_an_interrupted_segment_is_kept_and_not_evaluated(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        writer.begin(segment())
        writer.append(block(5.0))
        assert writer.interrupt("stopped") is not None
        writer.begin(segment())
        assert writer.interrupt("nothing came") is None
    entry = read_bundle(tmp_path / "r").segments[0]
    assert (entry.segment.interrupted, entry.segment.reason, len(entry.samples)) == (True, "stopped", 250)
    assert not entry.usable


def trip_while_recording(folder: Path) -> None:
    with BundleWriter(folder, HEADER) as writer:
        writer.begin(segment())
        writer.append(block(5.0))
        raise RuntimeError("trip")


def test_an_error_on_the_way_leaves_the_open_segment_interrupted(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="trip"):
        trip_while_recording(tmp_path / "r")
    _, segments = read_header(tmp_path / "r")
    assert [(entry.interrupted, entry.reason) for entry in segments] == [(True, "RuntimeError: trip")]


def test_a_silent_unit_leaves_no_segment(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        writer.begin(segment())
        with pytest.raises(InstrumentError, match="No sample of the segment zo_x_1"):
            writer.finish()
        record(writer, segment(), block())
    assert len(read_bundle(tmp_path / "r").segments) == 1


def test_a_second_writer_is_refused_and_told_who_writes(tmp_path: Path) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        record(writer, segment(), block())
        with pytest.raises(InputError, match=f"another instance \\(process {os.getpid()} on "):
            BundleWriter.resume(tmp_path / "r")
        with pytest.raises(InputError, match="another instance"):
            BundleWriter(tmp_path / "r", HEADER)
    BundleWriter.resume(tmp_path / "r").close()


def test_a_foreign_folder_and_a_finished_recording_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign/thesis.txt").write_text("x")
    with pytest.raises(InputError, match="not empty"):
        BundleWriter(tmp_path / "foreign", HEADER)
    assert [path.name for path in (tmp_path / "foreign").iterdir()] == ["thesis.txt"]
    BundleWriter(tmp_path / "r", HEADER).close()
    with pytest.raises(InputError, match="holds a recording already"):
        BundleWriter(tmp_path / "r", HEADER)
    with pytest.raises(InputError, match="no recording to go on with"):
        BundleWriter.resume(tmp_path / "foreign")


def test_resume_goes_on_where_it_stopped(tmp_path: Path) -> None:
    header = replace(HEADER, notes={"plan": {"name": "JJF"}})
    with BundleWriter(tmp_path / "r", header) as writer:
        record(writer, segment(), block())
    with BundleWriter.resume(tmp_path / "r") as writer:
        assert writer.header == header
        assert [entry.name for entry in writer.segments] == ["zo_x_1"]
        record(
            writer,
            segment("zo_x_2", orientation=Orientation("ESD"), position=2),
            Samples(columns(30.0, "ESD")),
        )
    assert [entry.segment.name for entry in read_bundle(tmp_path / "r").segments] == ["zo_x_1", "zo_x_2"]


CHILD = """
import sys, time
from pathlib import Path
from tests.recording.test_writer import HEADER, block, record, segment
from ahrs_lab.recording.write import BundleWriter
writer = BundleWriter(Path(sys.argv[1]), HEADER)
record(writer, segment(), block())
writer.begin(segment("zo_x_2"))
start = time.monotonic()
while True:
    time.sleep(0.02)
    writer.append(block(0.02, time.monotonic() - start))
    print(time.monotonic() - start, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_kill_loses_at_most_the_last_second(tmp_path: Path) -> None:
    folder = tmp_path / "r"
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, str(folder)],
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
    )
    assert child.stdout is not None
    last = 0.0
    while last < 1.6:
        last = float(child.stdout.readline())
    os.kill(child.pid, signal.SIGKILL)
    last = float((["0", *child.stdout.read().split()])[-1]) or last
    child.wait()
    child.stdout.close()
    assert [entry.name for entry in read_header(folder)[1]] == ["zo_x_1"]
    with BundleWriter.resume(folder) as writer:
        first, second = writer.segments
    assert (first.interrupted, second.interrupted) == (False, True)
    assert second.reason == "the program ended while it was recorded"
    recovered = read_bundle(folder).segments[1].samples["t_s"][-1]
    assert recovered > max(1.6, last) - 1.0
    assert sorted(path.suffix for path in (folder / "segments").iterdir()) == [".parquet", ".parquet"]


def killed_writer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> BundleWriter:
    """A writer with an open segment whose every block is on disk."""
    monkeypatch.setattr(journal, "WRITE_EVERY_S", 0.0)
    writer = BundleWriter(folder, HEADER)
    writer.begin(segment())
    for start in range(5):
        writer.append(block(6.0, 6.0 * start))
    return writer


def abandon(writer: BundleWriter) -> None:
    """As a kill does: everything the process held is gone."""
    assert writer._journal is not None
    writer._journal.close()
    writer._journal = None
    writer._lock.release()


def test_a_batch_that_was_cut_off_does_not_take_the_others_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    abandon(killed_writer(tmp_path / "r", monkeypatch))
    path = tmp_path / "r/segments/zo_x_1.parquet.journal"
    whole = path.read_bytes()
    for cut in (1, 700, len(whole) // 3, len(whole) - 100):
        path.write_bytes(whole[:-cut])
        (tmp_path / "r/segments/zo_x_1.parquet.part").write_bytes(b"half")
        with BundleWriter.resume(tmp_path / "r") as writer:
            if cut == len(whole) - 100:
                assert writer.segments == ()
            else:
                expected = {1: 1200, 700: 1200, len(whole) // 3: 900}[cut]
                assert len(read_bundle(tmp_path / "r").segments[-1].samples) == expected
            writer._segments = []
            writer._write_header()
        assert not (tmp_path / "r/segments/zo_x_1.parquet.part").exists()


@pytest.mark.parametrize("at", ["sealing", "header", "journal"])
def test_a_kill_while_a_finished_segment_is_sealed_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at: str
) -> None:
    """The segment had come to its end: it is recovered as a complete one."""

    class Killed(BaseException):
        pass

    def kill(*_: object) -> None:
        raise Killed

    writer = killed_writer(tmp_path / "r", monkeypatch)
    owner = {
        "sealing": "ahrs_lab.recording.write.write_parquet",
        "header": "ahrs_lab.recording.write.BundleWriter._write_header",
        "journal": "ahrs_lab.recording.write.BundleWriter._drop_journal",
    }[at]
    with monkeypatch.context() as patch:
        patch.setattr(owner, kill)
        with pytest.raises(Killed):
            writer.finish()
    abandon(writer)
    with BundleWriter.resume(tmp_path / "r") as resumed:
        assert [(entry.name, entry.interrupted) for entry in resumed.segments] == [("zo_x_1", False)]
    assert len(read_bundle(tmp_path / "r").segments[0].samples) == 1500
    assert [path.name for path in (tmp_path / "r/segments").iterdir()] == ["zo_x_1.parquet"]


def test_a_full_disk_while_recording_keeps_what_was_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = killed_writer(tmp_path / "r", monkeypatch)
    real = journal._write_all

    def full(file: BinaryIO, content: memoryview) -> None:
        real(file, content[: len(content) // 2])
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(journal, "_write_all", full)
        with pytest.raises(MachineError, match="full"):
            writer.append(block(6.0, 30.0))
    abandon(writer)
    with BundleWriter.resume(tmp_path / "r"):
        assert len(read_bundle(tmp_path / "r").segments[0].samples) == 1500


def no_room(_: int) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


def test_a_segment_that_could_not_be_sealed_is_sealed_once_there_is_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with BundleWriter(tmp_path / "r", HEADER) as writer:
        record(writer, segment("zo_x_0"), block())
        writer.begin(segment())
        writer.append(block())
        with monkeypatch.context() as patch:
            patch.setattr("os.fsync", no_room)
            with pytest.raises(MachineError, match="is full"):
                writer.finish()
            assert not list((tmp_path / "r").rglob("*.part"))
        assert [entry.name for entry in read_header(tmp_path / "r")[1]] == ["zo_x_0"]
        assert writer.finish().name == "zo_x_1"
    assert [entry.usable for entry in read_bundle(tmp_path / "r").segments] == [True, True]


def test_a_full_disk_at_the_end_leaves_the_segment_to_resume(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def until_the_disk_is_full() -> None:
        with BundleWriter(tmp_path / "r", HEADER) as writer:
            writer.begin(segment())
            writer.append(block())
            patch.setattr("os.fsync", no_room)
            writer.finish()

    with monkeypatch.context() as patch, pytest.raises(MachineError, match="full"):
        until_the_disk_is_full()
    with BundleWriter.resume(tmp_path / "r") as writer:
        assert len(writer.segments) == 1
    assert len(read_bundle(tmp_path / "r").segments[0].samples) == 1500


def test_a_folder_that_vanishes_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    writer = killed_writer(tmp_path / "r", monkeypatch)
    (tmp_path / "r").rename(tmp_path / "elsewhere")
    with pytest.raises(MachineError, match="is not there"):
        writer.append(block(6.0, 30.0))
    with pytest.raises(MachineError, match="is not there"):
        writer.close()
    with BundleWriter.resume(tmp_path / "elsewhere") as resumed:
        assert len(resumed.segments) == 1


def test_a_read_only_file_system_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "mkdir", refused)
    with pytest.raises(MachineError, match="may not be written"):
        BundleWriter(tmp_path / "r", HEADER)


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "r").mkdir(mode=0o555)
    with pytest.raises(MachineError, match="may not be written"):
        BundleWriter(tmp_path / "r", HEADER)


@pytest.mark.skipif(sys.platform != "linux", reason="nobody may make a folder there")
def test_a_folder_that_never_was_and_cannot_be_made_is_not_said_to_be_gone() -> None:
    folder = Path("/proc/x/recording")
    with pytest.raises(MachineError) as caught:
        BundleWriter(folder, HEADER)
    assert str(caught.value).startswith(f"{folder} is not there: ")
    assert "choose another folder" in str(caught.value)


def test_a_file_in_the_folders_place_is_named(tmp_path: Path) -> None:
    (tmp_path / "r").write_text("x")
    with pytest.raises(MachineError, match="is a file"):
        BundleWriter(tmp_path / "r", HEADER)


def test_what_was_read_ahead_counts_while_it_is_what_it_was(tmp_path: Path) -> None:
    folder = tmp_path / "r"
    ahead = ReadAhead(folder)
    with BundleWriter(folder, HEADER) as writer:
        for number in range(1, 5):
            ahead.read(record(writer, segment(f"zo_x_{number}", position=number), block()), HEADER)
        record(writer, segment("zo_y_1"), block())
        writer.supersede("zo_x_2", "cable moved")
    file = folder / "segments" / "zo_x_3.parquet"
    os.utime(file, ns=(0, 0))
    header, segments = read_header(folder)
    found = {entry.name: ahead.get(entry, header) for entry in segments}
    assert [name for name, recorded in found.items() if recorded] == ["zo_x_1", "zo_x_4"]
    faster = replace(header, device=replace(header.device, sample_rate_hz=60.0))
    assert ahead.get(segments[0], faster) is None

    whole, plain = read_bundle(folder, ahead), read_bundle(folder)
    assert whole.segments[0] is found["zo_x_1"]
    assert whole.sha256 == plain.sha256
    assert whole.findings == plain.findings
    for one, other in zip(whole.segments, plain.segments, strict=True):
        assert one.segment == other.segment
        assert one.findings == other.findings
        for name, column in other.samples.columns.items():
            np.testing.assert_array_equal(one.samples[name], column)
