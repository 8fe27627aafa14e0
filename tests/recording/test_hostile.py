"""Recordings that somebody made to do harm: refused in one sentence, at once, with nothing else touched."""

from __future__ import annotations

import os
import struct
import sys
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from pyarrow import parquet

from ahrs_lab.errors import InputError
from ahrs_lab.recording.archive import pack
from ahrs_lab.recording.parquet_file import read_parquet
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.toml_table import parse_toml
from tests.recording.making import HEADER, four_positions, take, write_bundle

unix_only = pytest.mark.skipif(sys.platform == "win32", reason="links and devices are made otherwise there")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = 1" + "0" * 5000, "64 bits"),
        ("x = 0x" + "f" * 20000, "64 bits"),
        (f"x = {2**63}", "64 bits"),
        (f"x = [[{{y = {-(2**63) - 1}}}]]", "64 bits"),
        ("x = " + "[" * 20000 + "]" * 20000, "too deeply"),
        ("x = " + "[" * 400 + "]" * 400, "too deeply"),
        (".".join(["a"] * 900) + " = 1", "too deeply"),
    ],
)
def test_toml_that_nobody_can_hold_is_not_valid(text: str, words: str) -> None:
    with pytest.raises(tomllib.TOMLDecodeError, match=words):
        parse_toml(text)


def test_whole_numbers_up_to_64_bits_are_read() -> None:
    assert parse_toml(f"a = {2**63 - 1}\nb = [{-(2**63)}]") == {"a": 2**63 - 1, "b": [-(2**63)]}


def test_a_header_with_such_a_number_is_refused(tmp_path: Path) -> None:
    header = HEADER.replace("39.9042", "1" + "0" * 5000)
    assert header != HEADER
    with pytest.raises(InputError, match=r"not valid TOML.*64 bits"):
        read_bundle(write_bundle(tmp_path / "bundle", four_positions(), header))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"role": "rate", "item": "scale_factor", "rate_dps": 1e12}, "“rate_dps”"),
        ({"role": "turns", "item": "misalignment", "turns": 10**15}, "“turns”"),
    ],
)
def test_no_table_turns_so_fast_or_so_often(tmp_path: Path, keys: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_bundle(write_bundle(tmp_path / "bundle", [take("one", 30.0, **keys)]))


def test_a_file_name_cannot_drive_the_terminal(tmp_path: Path) -> None:
    folder = write_bundle(tmp_path / "bundle", four_positions())
    header = folder / "recording.toml"
    header.write_text(
        header.read_text(encoding="utf-8").replace("segments/zo_x_1", "segments/\\u001b[2Jzo", 1),
        encoding="utf-8",
    )
    with pytest.raises(InputError, match="has to lie inside the recording"):
        read_bundle(folder)


@unix_only
def test_a_link_in_a_circle_is_refused(tmp_path: Path) -> None:
    folder = write_bundle(tmp_path / "bundle", four_positions())
    file = folder / "segments" / "zo_x_1.csv"
    file.unlink()
    file.symlink_to(file.name)
    with pytest.raises(InputError, match=r"zo_x_1\.csv"):
        read_bundle(folder)


@unix_only
def test_a_device_is_no_recording(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="neither a folder nor an ordinary file"):
        read_bundle(Path(os.devnull))
    os.mkfifo(tmp_path / "pipe.ahrsrec")
    with pytest.raises(InputError, match="neither a folder nor an ordinary file"):
        read_bundle(tmp_path / "pipe.ahrsrec")


def test_a_huge_header_is_not_read_into_memory(tmp_path: Path) -> None:
    folder = write_bundle(tmp_path / "bundle", four_positions())
    with (folder / "recording.toml").open("r+b") as file:
        file.truncate(2**40)
    with pytest.raises(InputError, match="larger than 16 MiB"):
        read_bundle(folder)


def test_a_parquet_counter_beyond_what_a_float_holds_is_read(tmp_path: Path) -> None:
    file = tmp_path / "one.parquet"
    parquet.write_table(pa.table({"t_s": [0.1], "gyro_x": [0.0], "gyro_y": [0.0], "gyro_z": [0.0],
                                  "counter": pa.array([2**64 - 1], pa.uint64())}), file)  # fmt: skip
    assert read_parquet(file).columns["counter"].tolist() == [2.0**64]


def _packed(tmp_path: Path) -> tuple[Path, bytearray]:
    target = tmp_path / "one.ahrsrec"
    pack(write_bundle(tmp_path / "bundle", four_positions()), target)
    return target, bytearray(target.read_bytes())


@pytest.mark.parametrize(
    ("offset", "layout", "value", "words"),
    [
        (10, "<H", 99, "packed in a way that is not read"),
        (10, "<H", zipfile.ZIP_LZMA, "packed in a way that is not read"),
        (16, "<I", 1, "damaged"),
        (42, "<I", 0x7FFFFFFF, "damaged"),
    ],
    ids=["unknown method", "lzma", "checksum of the header", "offset of the header"],
)
def test_a_directory_that_lies_is_an_input_error(
    tmp_path: Path, offset: int, layout: str, value: int, words: str
) -> None:
    target, data = _packed(tmp_path)
    struct.pack_into(layout, data, data.find(b"PK\x01\x02") + offset, value)
    target.write_bytes(data)
    with pytest.raises(InputError, match=words):
        read_bundle(target)


def test_a_member_cannot_be_a_file_and_a_folder(tmp_path: Path) -> None:
    target, _ = _packed(tmp_path)
    with zipfile.ZipFile(target, "a") as archive:
        archive.writestr("segments", "a file")
    with pytest.raises(InputError, match="holds segments twice"):
        read_bundle(target)
