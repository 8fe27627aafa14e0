"""Private formats: what a description says is done, and what is wrong with it is said."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.protocols.catalogue import replay_summary, replayed, stream_decoder
from ahrs_lab.instruments.protocols.description import description_from_toml, load_description
from ahrs_lab.instruments.protocols.generic_text import GenericTextStream
from tests.instruments.protocols.streams_at_hand import DEVICES

TEXT = """
kind = "text"
rate_unit = "deg/s"
axes = "y x -z"
[text]
separator = "whitespace"
fields = 4
[[column]]
name = "t_s"
field = 0
unit = "ms"
[[column]]
name = "gyro_x"
field = 1
unit = "deg/h"
[[column]]
name = "gyro_y"
field = 2
unit = "rad/s"
[[column]]
name = "gyro_z"
field = 3
scale = 0.5
sign = -1
offset = 1.0
"""


def described(text: str = TEXT) -> dict[str, Any]:
    return tomllib.loads(text)


def test_units_scale_sign_and_axes_are_applied() -> None:
    decoder = GenericTextStream(description_from_toml(described(), "here"))
    read = replayed(b"9 9 9\n10 3600 1 4\r\n20  7200\t2 6\r\n", decoder)
    np.testing.assert_allclose(read["t_s"], [0.010, 0.020])
    np.testing.assert_allclose(read["gyro_y"], [1.0, 2.0])
    np.testing.assert_allclose(read["gyro_x"], np.degrees([1.0, 2.0]))
    np.testing.assert_allclose(read["gyro_z"], [-(1.0 - 2.0), -(1.0 - 3.0)])


def test_the_first_line_of_a_stream_without_prefix_may_have_lost_its_beginning() -> None:
    decoder = GenericTextStream(description_from_toml(described(), "here"))
    read = replayed(b"0 3600 1 4\n20 7200 2 6\n30 1_0 2 6\n40 1 2 6\n", decoder)
    np.testing.assert_allclose(read["t_s"], [0.02, 0.04])
    assert decoder.counts.failed == 1


@pytest.mark.parametrize("name", list(DEVICES))
def test_the_examples_are_descriptions(name: str) -> None:
    assert load_description(DEVICES[name]).columns


def _without(key: str) -> dict[str, Any]:
    data = described()
    del data[key]
    return data


def _with(place: str, value: object) -> dict[str, Any]:
    data: Any = described()
    *path, last = place.split(".")
    at = data
    for step in path:
        at = at[int(step)] if isinstance(at, list) else at[step]
    at[last] = value
    return data  # type: ignore[no-any-return]


def _binary(**said: object) -> dict[str, Any]:
    frame = {"sync": "AA 55", "payload": "<4f", "checksum": "xor", **said}
    return {**described(), "kind": "binary", "binary": frame}


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (_without("kind"), "“kind” has to be \"text\" / \"binary\""),
        (_without("text"), "“text” has to be [text]"),
        (_without("column"), "“column” has to be [[column]]"),
        (_with("text.separator", ""), "“text.separator”"),
        (_with("text.fields", 0), "“text.fields” has to be 1 … 1000"),
        (_with("text.seperator", ","), "“text.seperator” is not known"),
        (_with("column.1.field", 4), "“column[1].field” has to be 0 … 3"),
        (_with("column.1.unit", "g"), "“column[1].unit” has to be \"deg/s\""),
        (_with("column.1.scale", 0), "“column[1].scale” has to be ≠ 0"),
        (_with("column.1.sign", 0), "“column[1].sign”"),
        (_with("column.1.modulus", 9), "“column[1].name” has to be \"t_s\" / \"counter\""),
        (_with("column.1.name", "gyro_y"), "gyro_y"),
        (_with("column.1.name", "Gyro X"), "“column[1].name”"),
        (_with("axes", "x x z"), "“axes”"),
        (_with("axes", "x y"), "“axes”"),
        (_with("rate_unit", "rpm"), "“rate_unit” has to be \"deg/s\" / \"rad/s\" / \"LSB\""),
        (_binary(sync="G"), "“binary.sync”"),
        (_binary(sync=""), "“binary.sync”"),
        (_binary(payload="4f"), "“binary.payload”"),
        (_binary(payload="<4s"), "“binary.payload”"),
        (_binary(payload="<9999d"), "“binary.payload” has to be 1 … 4096 B"),
        (_binary(checksum="md5"), "crc16-modbus"),
        (_binary(checksum_from=99), "“binary.checksum_from” has to be 0 … 17"),
    ],
)  # fmt: skip
def test_a_fault_is_named_with_its_place(data: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as caught:
        description_from_toml(data, "unit.toml")
    assert str(caught.value).startswith("unit.toml: ")
    assert said in str(caught.value)
    assert "应为" in caught.value.message.text("zh") or "未知" in caught.value.message.text("zh")


def test_a_file_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        stream_decoder(str(tmp_path / "missing.toml"))
    broken = tmp_path / "broken.toml"
    broken.write_text("= 3", encoding="utf-8")
    with pytest.raises(InputError, match=r"broken\.toml is no TOML file"):
        stream_decoder(str(broken))
    with pytest.raises(InputError, match="vectornav, xsens, mip, anpp, nmea"):
        stream_decoder("novatel")


def test_a_summary_of_nothing_is_empty() -> None:
    decoder = stream_decoder("mip")
    assert replay_summary(replayed(b"", decoder), decoder) == {
        "frames": 0, "failed": 0, "skipped_bytes": 0, "samples": 0, "first": {}, "last": {},
    }  # fmt: skip
