"""The .ahrsrec archive: the same recording as its folder, and nothing else than a recording."""

from __future__ import annotations

import stat
import zipfile
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.recording import write_whole
from ahrs_lab.recording.archive import pack, unpack
from ahrs_lab.recording.read import Recording, read_bundle
from tests.recording.making import four_positions, write_bundle


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_bundle(tmp_path / "bundle", four_positions())


def same(one: Recording, other: Recording) -> bool:
    assert one.header == other.header
    for first, second in zip(one.segments, other.segments, strict=True):
        assert first.segment == second.segment
        assert {n: c.tobytes() for n, c in first.samples.columns.items()} == {
            n: c.tobytes() for n, c in second.samples.columns.items()
        }
    return one.sha256 == other.sha256


def test_the_archive_reads_like_the_folder_and_has_its_hash(folder: Path, tmp_path: Path) -> None:
    (folder / "raw.bin").write_bytes(b"raw")
    target = tmp_path / "out" / "a.ahrsrec"
    pack(folder, target)
    assert same(read_bundle(folder), read_bundle(target))
    unpack(target, tmp_path / "again")
    assert same(read_bundle(folder), read_bundle(tmp_path / "again"))
    assert (tmp_path / "again/raw.bin").read_bytes() == b"raw"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again", "bundle", "out"]


def test_packing_twice_gives_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    pack(folder, tmp_path / "a.ahrsrec")
    pack(folder, tmp_path / "b.ahrsrec")
    assert (tmp_path / "a.ahrsrec").read_bytes() == (tmp_path / "b.ahrsrec").read_bytes()


def test_a_folder_zipped_with_its_own_name_is_read_too(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "zipped.ahrsrec"
    with zipfile.ZipFile(target, "w") as archive:
        for path in folder.rglob("*"):
            archive.write(path, path.relative_to(folder.parent).as_posix())
    assert same(read_bundle(folder), read_bundle(target))


def test_unpacking_needs_an_empty_folder(folder: Path, tmp_path: Path) -> None:
    pack(folder, tmp_path / "a.ahrsrec")
    with pytest.raises(InputError, match="not empty"):
        unpack(tmp_path / "a.ahrsrec", folder)


def hostile(folder: Path, target: Path) -> zipfile.ZipFile:
    pack(folder, target)
    return zipfile.ZipFile(target, "a", zipfile.ZIP_DEFLATED)


@pytest.mark.parametrize(
    "name", ["../evil.csv", "/evil.csv", "a/../../evil.csv", "..\\evil.csv", "C:evil.csv"]
)
def test_a_name_that_leads_out_is_refused(folder: Path, tmp_path: Path, name: str) -> None:
    with hostile(folder, tmp_path / "a.ahrsrec") as archive:
        archive.writestr(name, "x")
    for use in (read_bundle, lambda path: unpack(path, tmp_path / "out")):
        with pytest.raises(InputError, match="leads out"):
            use(tmp_path / "a.ahrsrec")
    assert not (tmp_path / "out").exists()


def test_a_link_is_refused(folder: Path, tmp_path: Path) -> None:
    with hostile(folder, tmp_path / "a.ahrsrec") as archive:
        info = zipfile.ZipInfo("segments/link.csv")
        info.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(info, "/etc/passwd")
    with pytest.raises(InputError, match="a link or a device"):
        read_bundle(tmp_path / "a.ahrsrec")


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_name_that_is_there_twice_is_refused(folder: Path, tmp_path: Path) -> None:
    with hostile(folder, tmp_path / "a.ahrsrec") as archive:
        archive.writestr("Recording.toml", "x")
    with pytest.raises(InputError, match="twice"):
        read_bundle(tmp_path / "a.ahrsrec")


def test_what_unpacks_to_hundreds_of_times_its_size_is_refused(folder: Path, tmp_path: Path) -> None:
    with hostile(folder, tmp_path / "a.ahrsrec") as archive:
        archive.writestr("segments/bomb.csv", b"0" * 20_000_000)
    with pytest.raises(InputError, match="times its size"):
        read_bundle(tmp_path / "a.ahrsrec")


def test_a_damaged_archive_is_named(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "a.ahrsrec"
    pack(folder, target)
    data = bytearray(target.read_bytes())
    data[len(data) // 2] ^= 0xFF
    target.write_bytes(data)
    with pytest.raises(InputError, match="damaged"):
        read_bundle(target)
    target.write_bytes(data[:1000])
    with pytest.raises(InputError, match="damaged"):
        read_bundle(target)


def test_an_archive_without_a_recording_is_refused(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.ahrsrec", "w") as archive:
        archive.writestr("readme.txt", "x")
    with pytest.raises(InputError, match=r"no recording\.toml"):
        read_bundle(tmp_path / "a.ahrsrec")


def test_a_recording_made_from_another_is_not_packed_over_one_that_is_there(
    folder: Path, tmp_path: Path
) -> None:
    target = tmp_path / "kept.ahrsrec"
    pack(folder, target)
    before = target.read_bytes()
    read = read_bundle(target)
    with pytest.raises(InputError, match="is there already"):
        write_whole.write_bundle(target, read.header, [(r.segment, r.samples) for r in read.segments])
    assert target.read_bytes() == before
