"""What real devices sent, and the answers printed with it."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.instruments.protocols import microstrain_mip as mip
from ahrs_lab.instruments.protocols import vectornav_ascii, vectornav_binary, xsens_xbus
from ahrs_lab.instruments.protocols.catalogue import replay_summary, replayed, stream_decoder

CAPTURES = Path(__file__).resolve().parents[4] / "shared" / "captures"
pytestmark = pytest.mark.skipif(not CAPTURES.is_dir(), reason="the captures are kept outside the project")

VN100_COLUMNS = {
    "MagX": "mag_x", "MagY": "mag_y", "MagZ": "mag_z",
    "AccX": "accel_x", "AccY": "accel_y", "AccZ": "accel_z",
    "GyroX": "gyro_x", "GyroY": "gyro_y", "GyroZ": "gyro_z", "Temp": "temperature_c", "Pres": "pressure_kpa",
    "Yaw": "heading_deg", "Pitch": "pitch_deg", "Roll": "roll_deg",
    **{f"DCM{i + 1}": f"dcm_{i // 3 + 1}{i % 3 + 1}" for i in range(9)},
    "MagNED1": "mag_north", "MagNED2": "mag_east", "MagNED3": "mag_down",
    "AccNED1": "accel_north", "AccNED2": "accel_east", "ACCNED3": "accel_down",
}  # fmt: skip


def test_a_vn100_among_logger_lines_gives_its_author_s_numbers() -> None:
    decoder = stream_decoder("vectornav")
    rows = replayed((CAPTURES / "vn100_F00294_mixed.bin").read_bytes(), decoder)
    summary = replay_summary(rows, decoder)
    assert (summary["frames"], summary["failed"], summary["samples"]) == (99, 0, 99)
    assert summary["skipped_bytes"] == 15043 - 99 * 124
    assert not decoder.filtered_rates
    with (CAPTURES / "vn100_F00294_expected.csv").open(encoding="ascii", newline="") as file:
        header, *lines = csv.reader(file)
    expected = np.array([[float(cell) for cell in line if cell.strip()] for line in lines if line])
    names = [VN100_COLUMNS[name.strip()] for name in header if name.strip()]
    assert expected.shape == (98, 29)
    ours = np.delete(rows.matrix(names), 78, axis=0)
    # Printed as d.dddddde±xx: half a unit of the seventh digit.
    np.testing.assert_allclose(ours, expected, rtol=5.1e-7, atol=0.0)
    assert summary["first"]["gyro_z"] == pytest.approx(-3.673203e-03, rel=1e-6)


VECTORS = json.loads((CAPTURES / "vectornav_vectors.json").read_text()) if CAPTURES.is_dir() else []


@pytest.mark.parametrize("vector", [v for v in VECTORS if "ascii" in v], ids=lambda v: str(v["ascii"])[:24])
def test_vectornav_sentences_have_the_verdict_given(vector: dict[str, object]) -> None:
    text = str(vector["ascii"])
    decoder = vectornav_ascii.AsciiDecoder()
    found = decoder.feed(text.encode("ascii") + b"\r\n")
    assert len(found) == (1 if vector["checksum_ok"] else 0)
    assert decoder.counts.failed == 1 - len(found)
    body = text[3:].partition("*")[0].split(",")
    assert vectornav_ascii.encode(body[0], *body[1:]).endswith(f"*{vector['computed']}\r\n".encode())


BINARY_VECTORS = [vector for vector in VECTORS if "frame_hex" in vector]


@pytest.mark.parametrize("vector", BINARY_VECTORS, ids=lambda vector: str(vector["frame_hex"])[:16])
def test_vectornav_binary_vectors(vector: dict[str, object]) -> None:
    data = bytes.fromhex(str(vector["frame_hex"]))
    decoder = vectornav_binary.BinaryDecoder()
    found = [*decoder.feed(data), *decoder.flush()]
    if vector.get("crc_residue_nonzero"):
        assert not found
        return
    assert len(found) == 1
    rows = replayed(data, stream_decoder("vectornav"))
    expected = vector["expect"]
    assert isinstance(expected, dict)
    for name, column in (("yaw", "heading_deg"), ("pitch", "pitch_deg"), ("roll", "roll_deg")):
        assert rows[column][0] == pytest.approx(expected[name], rel=1e-7)
    if "time_startup_ns" in expected:
        assert rows["t_s"][0] == expected["time_startup_ns"] / 1e9


GOLDEN = (CAPTURES / "mtmanager_golden_packets.md").read_text() if CAPTURES.is_dir() else ""


def _configuration_frames() -> list[bytes]:
    """Sections “name - 0xMID” with lines of size, payload and checksum."""
    text = GOLDEN[GOLDEN.index("# Configuration Example") :]
    frames = []
    for match in re.finditer(r"^## [^\n]*?0x([0-9A-F]{2})\n(.*?)(?=^#|\Z)", text, re.M | re.S):
        digits = re.sub(r"```.*?```", "", match[2], flags=re.S)
        body = bytes.fromhex("".join(re.findall(r"\b[0-9A-F]{2}\b", digits)))
        extended = b"\xff" if len(body) > 256 else b""
        frames.append(b"\xfa\xff" + bytes.fromhex(match[1]) + extended + body)
    return frames


def test_of_the_golden_xsens_frames_25_of_28_check() -> None:
    frames = _configuration_frames()
    assert len(frames) == 28
    good = []
    for frame in frames:
        decoder = xsens_xbus.XbusDecoder()
        found = [*decoder.feed(frame), *decoder.flush()]
        good.append(len(found) == 1 and xsens_xbus.encode(found[0].mid, found[0].data) == frame)
    assert sum(good) == 25


def _golden_packets() -> list[tuple[bytes, str]]:
    raw = re.findall(r"## Raw Data\n\n```\n(.*?)\n```\n\n## Decoded Info\n\n```\n(.*?)\n```", GOLDEN, re.S)
    return [(bytes.fromhex(data), decoded) for data, decoded in raw]


GROUPS = {
    "acc": ("accel_x", "accel_y", "accel_z"),
    "gyr": ("gyro_x", "gyro_y", "gyro_z"),
    "mag": ("mag_x", "mag_y", "mag_z"),
    "freeAcc": ("free_accel_x", "free_accel_y", "free_accel_z"),
}


@pytest.mark.parametrize("index", range(6))
def test_golden_xsens_data_gives_the_manufacturer_s_numbers(index: int) -> None:
    payload, printed = _golden_packets()[index]
    rows = replayed(xsens_xbus.encode(xsens_xbus.MT_DATA2, payload), stream_decoder("xsens"))
    assert len(rows) == 1
    checked = 0
    for prefix, columns in GROUPS.items():
        for axis, column in zip("XYZ", columns, strict=True):
            match = re.search(rf"\b{prefix}{axis}:\s*(-?[\d.]+)", printed)
            if match:
                assert rows[column][0] == pytest.approx(float(match[1]), abs=5.1e-9)
                checked += 1
    counter = re.search(r"PacketCounter, 2 bytes, (\d+)", printed)
    fine = re.search(r"SampleTimeFine, 4 bytes, (\d+)", printed)
    assert counter
    assert fine
    assert rows["counter"][0] == int(counter[1])
    assert rows["t_s"][0] == int(fine[1]) / 1e4
    quaternion = [float(v) for v in re.findall(r"q\d:\s*(-?[\d.]+)", printed)[:4]]
    ours = [rows[f"quaternion_{part}"][0] for part in "wxyz"]
    np.testing.assert_allclose(ours, quaternion, atol=5.1e-9)
    assert checked >= (0 if index == 5 else 9)
    status = re.search(r"StatusWord, 4 bytes, ([01]{32})", printed)
    assert status
    assert rows["status"][0] == int(status[1], 2)
    assert (rows["over_range"][0] > 0) == (index == 4)


def test_the_golden_output_configuration_is_built_and_read() -> None:
    frame = next(f for f in _configuration_frames() if f[2] == xsens_xbus.SET_OUTPUT_CONFIGURATION)
    message = xsens_xbus.message_of(frame)
    listed = xsens_xbus.output_configuration(message.data)
    assert (0x8020, 400) in listed
    assert len(listed) == 12
    assert xsens_xbus.encode_output_configuration(listed) == frame


MIP_TEXT = (CAPTURES / "packet_example_cpp_check.txt").read_text() if CAPTURES.is_dir() else ""


def test_the_manufacturer_s_mip_packets_are_taken_apart_as_printed() -> None:
    checked = 0
    pattern = r"desc_set=0x(\w\w) tot_len=(\d+) pay_len=\d+ chk=(\w+) \[([0-9A-F]+)\]\n((?:    \(.*\n)*)"
    for set_, length, verdict, digits, printed in re.findall(pattern, MIP_TEXT):
        data = bytes.fromhex(digits)[: int(length)]
        decoder = mip.MipDecoder()
        found = [*decoder.feed(data), *decoder.flush()]
        if verdict == "invalid":
            assert not found
            continue
        fields = re.findall(r"\((\w\w),(\w\w)\): payload=\[([0-9A-F]*)\]", printed)
        assert found == [
            mip.MipPacket(
                int(set_, 16), tuple(mip.MipField(int(d, 16), bytes.fromhex(p)) for _, d, p in fields)
            )
        ]
        assert mip.encode(int(set_, 16), [(f.descriptor, f.data) for f in found[0].fields]) == data
        checked += 1
    assert checked == 7


def test_the_manufacturer_s_sensor_packet_gives_the_printed_numbers() -> None:
    digits = re.findall(r"\[(7565804C[0-9A-F]+)\]", MIP_TEXT)[0]
    rows = replayed(bytes.fromhex(digits), stream_decoder("mip"))
    accel = re.search(r"Scaled Accel = \((.*)\)", MIP_TEXT)
    gyro = re.search(r"Scaled Gyro = \((.*)\)", MIP_TEXT)
    time = re.search(r"Ref Time = (\d+)", MIP_TEXT)
    assert accel
    assert gyro
    assert time
    for columns, match in (
        (("accel_x", "accel_y", "accel_z"), accel),
        (("gyro_x", "gyro_y", "gyro_z"), gyro),
    ):
        printed = [float(value) for value in match[1].split(",")]
        np.testing.assert_allclose(rows.matrix(columns)[0], printed, atol=5.1e-7)
    assert rows["t_s"][0] == int(time[1]) / 1e9


def test_the_message_format_of_the_example_is_ours() -> None:
    example = bytes.fromhex("75650C0E0E0F018003D5000A04000A05000A91CE")
    assert mip.encode_message_format([(0xD5, 10), (0x04, 10), (0x05, 10)]) == example
