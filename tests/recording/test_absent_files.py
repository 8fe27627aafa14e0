"""Files that recording.toml lists and that are not there: findings of their segments, not in the hash."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.recording.archive import pack
from ahrs_lab.recording.read import ReadAhead, read_bundle, read_header
from tests.recording.making import four_positions, write_bundle

SECOND = "segments/zo_x_2.csv"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_bundle(tmp_path / "b", four_positions())


def sha256_of(folder: Path, *files: str) -> str:
    """By the words of the documentation: name, zero byte, size, bytes of each."""
    total = hashlib.sha256()
    for name in ("recording.toml", *files):
        data = (folder / name).read_bytes()
        total.update(name.encode() + b"\0" + len(data).to_bytes(8, "big") + data)
    return total.hexdigest()


def test_a_file_that_is_not_there_is_named_with_the_line_of_its_entry(folder: Path) -> None:
    (folder / SECOND).unlink()
    lines = (folder / "recording.toml").read_text(encoding="utf-8").splitlines()
    entry = lines.index(f'file = "{SECOND}"')  # the [[segment]] line stands before it; lines count from 1
    recording = read_bundle(folder)
    (found,) = recording.findings
    assert (found.segment, found.line, found.kind, found.severity) == (SECOND, 0, "absent", "unusable")
    assert (found.item, found.axis) == ("zero_offset", "x")
    assert str(found.placed) == (
        f"{SECOND}: the file is not there, though recording.toml lists it (line {entry}): "
        "copy it into the recording."
    )
    assert [recorded.usable for recorded in recording.segments] == [True, False, True, True]
    assert len(recording.segments[1].samples) == 0


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("[[segment]]", "  [[ segment ]]  # one more", True),
        ("[[segment]]", '[["segment"]]', True),
        ("[site]", 'remark = """\n[[segment]]\n"""\n\n[site]', False),
    ],
)
def test_the_line_is_told_only_where_it_is_certain(folder: Path, old: str, new: str, line: bool) -> None:
    (folder / SECOND).unlink()
    header = folder / "recording.toml"
    header.write_text(header.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    (found,) = read_bundle(folder).findings
    assert ("line" in found.what.params) == line


def test_every_file_that_is_not_there_is_named(folder: Path) -> None:
    for name in ("segments/zo_x_1.csv", "segments/zo_x_4.csv"):
        (folder / name).unlink()
    assert [found.segment for found in read_bundle(folder).findings] == [
        "segments/zo_x_1.csv",
        "segments/zo_x_4.csv",
    ]


def test_a_recording_none_of_whose_files_is_there_is_refused(folder: Path) -> None:
    for path in (folder / "segments").iterdir():
        path.unlink()
    with pytest.raises(
        InputError, match=r"recording\.toml lists segments/zo_x_1\.csv, which is not there, nor"
    ):
        read_bundle(folder)


def test_the_hash_leaves_out_what_is_not_there(folder: Path) -> None:
    files = [f"segments/zo_x_{i}.csv" for i in range(1, 5)]
    assert read_bundle(folder).sha256 == sha256_of(folder, *files)
    (folder / SECOND).unlink()
    files.remove(SECOND)
    assert read_bundle(folder).sha256 == sha256_of(folder, *files)


def test_an_archive_that_lacks_a_file_is_read_like_its_folder(folder: Path, tmp_path: Path) -> None:
    import zipfile

    (folder / SECOND).unlink()
    archive = tmp_path / "b.ahrsrec"
    with zipfile.ZipFile(archive, "w") as file:
        for path in sorted(folder.rglob("*.*")):
            file.write(path, path.relative_to(folder).as_posix())
    packed, plain = read_bundle(archive), read_bundle(folder)
    assert packed.sha256 == plain.sha256
    assert packed.findings == plain.findings


def test_what_was_read_ahead_of_a_file_that_is_gone_since_does_not_count(folder: Path) -> None:
    header, segments = read_header(folder)
    ahead = ReadAhead(folder)
    for segment in segments:
        ahead.read(segment, header)
    (folder / SECOND).unlink()
    assert [found.kind for found in read_bundle(folder, ahead).findings] == ["absent"]


def test_an_incomplete_recording_is_not_packed(folder: Path, tmp_path: Path) -> None:
    (folder / SECOND).unlink()
    with pytest.raises(InputError, match=r"zo_x_2\.csv of .* is missing"):
        pack(folder, tmp_path / "b.ahrsrec")
    assert not (tmp_path / "b.ahrsrec").exists()
