"""What an encoder says is what the decoder reads, in every number format and over every wrap."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ahrs_lab.instruments.protocols import generic_binary, generic_text, microstrain, vectornav_ascii, xsens
from ahrs_lab.instruments.protocols import microstrain_mip as mip
from ahrs_lab.instruments.protocols import vectornav_binary as vnb
from ahrs_lab.instruments.protocols import xsens_xbus as xbus
from ahrs_lab.instruments.protocols.attitudes import attitude_of
from ahrs_lab.instruments.protocols.catalogue import replayed, stream_decoder
from ahrs_lab.instruments.protocols.description import load_description
from ahrs_lab.recording.samples import ACCEL, ATTITUDE, GYRO, Samples
from tests.instruments.protocols.streams_at_hand import DEVICES, samples


def assert_read(said: Samples, read: Samples, names: tuple[str, ...], atol: float) -> None:
    assert len(said) == len(read)
    for name in names:
        np.testing.assert_allclose(read[name], said[name], rtol=0, atol=atol, err_msg=name)


@pytest.mark.parametrize(("number", "atol"), [(0, 4e-5), (1, 2**-20), (2, 2**-32), (3, 1e-12)])
@pytest.mark.parametrize("frame", [0, 4, 8], ids=["ENU", "NED", "NWU"])
def test_xsens_in_every_number_format_and_frame(number: int, atol: float, frame: int) -> None:
    said = samples(40)
    bits = number | frame
    items = [0x1020, 0x1060, 0x8020 | bits, 0x4020 | bits, 0x2030 | bits, 0x0810 | number]
    read = replayed(xsens.encode_samples(items, said), stream_decoder("xsens"))
    assert_read(said, read, (*GYRO, *ACCEL, *ATTITUDE, "temperature_c"), atol)
    assert_read(said, read, ("t_s", "counter"), 0.0)


@pytest.mark.parametrize("frame", ["ENU", "NED", "NWU"])
def test_a_quaternion_gives_the_attitude_of_the_same_turn(frame: str) -> None:
    """Against scipy: the case is forward, left, up (ENU, NWU) or forward, right, down (NED)."""
    said = samples(60)
    heading, pitch, roll = (said[name] for name in ATTITUDE)
    yaw = {"ENU": 90.0 - heading, "NED": heading, "NWU": -heading}[frame]
    nose = pitch if frame == "NED" else -pitch
    turn = Rotation.from_euler("ZYX", np.column_stack([yaw, nose, roll]), degrees=True)
    x, y, z, w = turn.as_quat().T
    read = attitude_of([w, x, y, z], frame)  # type: ignore[arg-type]
    for name in ATTITUDE:
        np.testing.assert_allclose(read[name], said[name], atol=1e-9)
    if frame != "NED":
        # Nose up: the forward axis points above the horizon.
        forward = turn.apply([1.0, 0.0, 0.0])
        np.testing.assert_allclose(np.degrees(np.arcsin(forward[:, 2])), pitch, atol=1e-9)


def test_xsens_time_and_counter_wrap() -> None:
    n = 400
    start = 2**32 / 1e4 - 1.0
    rows = np.arange(n, dtype=np.float64)
    said = samples(n).with_columns({"t_s": start + rows / 100.0, "counter": 65_400.0 + rows})
    data = xsens.encode_samples([0x1020, 0x1060, 0x8020], said)
    read = replayed(data, stream_decoder("xsens"))
    np.testing.assert_allclose(read["t_s"], said["t_s"], atol=5.1e-5)
    np.testing.assert_array_equal(read["counter"], said["counter"])
    frame = len(data) // n
    lossy = data[: 50 * frame] + data[250 * frame :]
    np.testing.assert_array_equal(
        replayed(lossy, stream_decoder("xsens"))["counter"], np.delete(said["counter"], np.arange(50, 250))
    )


def test_xsens_commands_and_answers() -> None:
    assert xbus.encode(xbus.GO_TO_CONFIG) == bytes.fromhex("FAFF3000D1")
    assert xbus.encode(xbus.GO_TO_MEASUREMENT) == bytes.fromhex("FAFF1000F1")
    decoder = xbus.XbusDecoder()
    (ack, error, big) = decoder.feed(
        xbus.encode_acknowledge(xbus.GO_TO_CONFIG) + xbus.encode_error(4) + xbus.encode(0x91, bytes(1320))
    )
    assert ack.acknowledges == xbus.GO_TO_CONFIG
    assert error.error == 4
    assert xbus.ERRORS[4] == "invalid message"
    assert len(big.data) == 1320


def test_mip_says_what_it_was_told() -> None:
    said = samples(40)
    read = replayed(microstrain.encode_samples([0xD5, 4, 5, 0x0C, 0x14, 0x18], said), stream_decoder("mip"))
    assert_read(said, read, (*GYRO, *ACCEL), 1e-7)
    assert_read(said, read, (*ATTITUDE, "temperature_c"), 2e-5)
    assert_read(said, read, ("t_s",), 1e-9)
    assert not read["over_range"].any()


def test_mip_internal_time_wraps() -> None:
    said = samples(300).with_columns({"t_s": 2**32 / 62_500 - 1.0 + np.arange(300) / 100.0})
    read = replayed(microstrain.encode_samples([0x0E, 5], said), stream_decoder("mip"))
    np.testing.assert_allclose(read["t_s"], said["t_s"], atol=8.1e-6)


def test_mip_settings_and_acknowledgements() -> None:
    listed = [(0xD5, 1), (0x05, 2)]
    reply = mip.encode_acknowledge(
        mip.COMMANDS_3DM, mip.MESSAGE_FORMAT, 0, [(mip.MESSAGE_FORMAT_REPLY, mip.message_format_data(listed))]
    )
    (packet,) = mip.MipDecoder().feed(reply)
    assert packet.acknowledgements == ((mip.MESSAGE_FORMAT, 0),)
    assert mip.message_format_of(packet.fields[1].data) == (0x80, tuple(listed))
    assert mip.encode(mip.BASE_COMMANDS, [(mip.PING, b"")]) == bytes.fromhex("756501020201E0C6")
    with pytest.raises(ValueError, match="255"):
        mip.encode(0x0C, [(1, bytes(200)), (1, bytes(200))])


@pytest.mark.parametrize("checksum", ["xor", "crc16", "none"])
@pytest.mark.parametrize("tag", ["YMR", "IMU"])
def test_vectornav_sentences_say_what_they_were_told(
    tag: str, checksum: vectornav_ascii.ChecksumMode
) -> None:
    said = samples(30)
    decoder = stream_decoder("vectornav")
    read = replayed(vectornav_ascii.encode_samples(tag, said, checksum), decoder)
    assert_read(said, read, GYRO, 5.1e-7)
    assert_read(said, read, ACCEL, 5.1e-4)
    assert decoder.filtered_rates == (tag == "YMR")


def test_vectornav_echoes_errors_and_unchecked_sentences() -> None:
    decoder = vectornav_ascii.AsciiDecoder()
    data = vectornav_ascii.encode_read(75) + b"$VNWRG,07,40*XX\r\n" + vectornav_ascii.encode("ERR", 12)
    read, written, error = decoder.feed(data + vectornav_ascii.encode_async(False))[:3]
    assert (read.register, written.register, written.checked) == (75, 7, False)
    assert error.error == 12
    assert vectornav_ascii.ERRORS[12] == "insufficient baud rate"


def test_the_status_behind_a_vectornav_sentence_is_passed_over() -> None:
    line = b"$VNYPR,+010.071,+000.278,-002.026,T1162704*2F\r\n"
    read = replayed(line + line, stream_decoder("vectornav"))
    assert read["heading_deg"].tolist() == [10.071, 10.071]


def test_vectornav_binary_says_what_it_was_told() -> None:
    said = samples(30).with_columns({"t_s": 5000.0 + np.arange(30) / 800.0})
    output = vnb.BinaryOutput.of({vnb.COMMON: [0, 3, 5], vnb.IMU: [2, 3, 4], vnb.INS: [0]})
    decoder = stream_decoder("vectornav")
    read = replayed(vnb.encode_samples(output, said), decoder)
    assert_read(said, read, (*GYRO, *ACCEL), 1e-7)
    assert_read(said, read, ("t_s",), 1e-9)
    assert not decoder.filtered_rates
    assert not read["gyro_compensated_x"].any()


def test_filtered_vectornav_rates_say_so() -> None:
    output = vnb.BinaryOutput.of({vnb.COMMON: [0, 5]})
    decoder = stream_decoder("vectornav")
    read = replayed(vnb.encode_samples(output, samples(5)), decoder)
    assert decoder.filtered_rates
    assert GYRO[0] in read


def test_the_length_of_a_vectornav_message_follows_from_its_masks() -> None:
    output = vnb.BinaryOutput.of({vnb.COMMON: range(15), vnb.ATTITUDE: range(12)})
    common = (8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8)
    attitude = (2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24)
    assert output.payload_length == sum(common) + sum(attitude)
    assert output.header == b"\xfa\x11" + struct.pack("<HH", 0x7FFF, 0x0FFF)
    with pytest.raises(ValueError, match="unknown"):
        vnb.BinaryOutput.of({vnb.TIME: [8]})


def test_generic_formats_say_what_they_were_told() -> None:
    said = samples(40)
    binary = load_description(DEVICES["binary"])
    read = replayed(generic_binary.encode_samples(binary, said), stream_decoder(str(DEVICES["binary"])))
    assert_read(said, read, (*GYRO, *ACCEL), 1e-6)
    assert_read(said, read, ("t_s", "counter"), 0.0)
    assert_read(said, read, ("temperature_c",), 0.005001)
    text = load_description(DEVICES["text"])
    read = replayed(generic_text.encode_samples(text, said), stream_decoder(str(DEVICES["text"])))
    assert_read(said, read, (*GYRO, *ACCEL, *ATTITUDE, "t_s"), 1e-9)


def test_a_described_counting_unit_is_turned_and_unwrapped() -> None:
    """By hand: y and z of the unit are −y and −z of the case; big-endian; the counter is one byte."""
    frames = b""
    for i in range(300):
        body = struct.pack(">B3i3iH", i & 0xFF, 10 + i, -20, 30, 1, 2, -3, 650)
        frames += b"\x80\x7f" + body + bytes((sum(body) & 0xFF,))
    decoder = stream_decoder(str(DEVICES["counts"]))
    read = replayed(frames, decoder)
    assert decoder.rate_unit == "LSB"
    np.testing.assert_array_equal(read["counter"], np.arange(300))
    np.testing.assert_array_equal(read["gyro_x"], 10 + np.arange(300))
    assert (read["gyro_y"][0], read["gyro_z"][0], read["accel_y"][0], read["accel_z"][0]) == (20, -30, -2, 3)
    assert read["temperature_c"][0] == pytest.approx(25.0)
