"""What each driver says to its unit and what it makes of the answers; frames are the makers' own, or summed
up here by the rule in their manuals."""

from __future__ import annotations

import struct
import time
from functools import reduce
from operator import xor

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.microstrain import MicroStrainAhrs, MicroStrainSettings
from ahrs_lab.instruments.drivers.ahrs.vectornav import VectorNavAhrs, VectorNavSettings
from ahrs_lab.instruments.drivers.ahrs.xsens import XsensAhrs, XsensSettings
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.real_clock import RealClock
from tests.instruments.ahrs.reading import read_until
from tests.instruments.ahrs.scripted_unit import ScriptedLink

LINK = LinkSettings(device="scripted")


def vn(body: str) -> bytes:
    return f"${body}*{reduce(xor, body.encode()):02X}\r\n".encode()


def xbus(mid: int, data: bytes = b"") -> bytes:
    body = bytes((0xFF, mid, len(data))) + data
    return b"\xfa" + body + bytes((-sum(body) & 0xFF,))


def mip(descriptor_set: int, *fields: bytes) -> bytes:
    payload = b"".join(bytes((len(f) + 1,)) + f for f in fields)
    body = b"\x75\x65" + bytes((descriptor_set, len(payload))) + payload
    first = second = 0
    for byte in body:
        first = (first + byte) & 0xFF
        second = (second + first) & 0xFF
    return body + bytes((first, second))


def vn_frame(t_ns: int, gyro: float) -> bytes:
    head = bytes((0xFA, 0x05)) + struct.pack("<HH", 0x0001, 0x001C)
    body = head + struct.pack("<Q7f", t_ns, 0.0, 0.0, 9.8, gyro, 0.0, 0.0, 21.5)
    crc = 0
    for byte in body[1:]:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return body + struct.pack(">H", crc)


VN_BINARY = "1,8,05,0001,001C"
VN_DIALOGUE = [
    (vn("VNASY,0"), vn("VNASY,0")),
    (vn("VNASY,1"), vn("VNASY,1")),
    (vn("VNRRG,01"), vn("VNRRG,01,VN-100S-CR")),
    (vn("VNRRG,03"), vn("VNRRG,03,0100013456")),
    (vn("VNRRG,04"), vn("VNRRG,04,2.1.0.0")),
    (vn("VNWRG,06,0"), vn("VNWRG,06,0")),
    (vn(f"VNWRG,75,{VN_BINARY}"), vn(f"VNWRG,75,{VN_BINARY}")),
    (vn("VNRRG,06"), vn("VNRRG,06,0")),
    (vn("VNRRG,75"), vn("VNRRG,75,1,8,5,1,1C")),
]


def vectornav(link: ScriptedLink, **settings: object) -> VectorNavAhrs:
    return VectorNavAhrs(VectorNavSettings(LINK, boot_time_s=0.0, **settings), link, RealClock())  # type: ignore[arg-type]


def test_vectornav_is_paused_set_read_back_and_started() -> None:
    link = ScriptedLink(VN_DIALOGUE)
    ahrs = vectornav(link)
    try:
        assert ahrs.identify() == "VectorNav VN-100S-CR s/n 0100013456 firmware 2.1.0.0"
        assert ahrs.description.serial_number == "0100013456"
        assert ahrs.configure() == ()
        link.send(vn_frame(10_000_000, 7.0))
        ahrs.start()
        for n in range(2, 7):
            link.send(vn_frame(n * 10_000_000, 0.25))
        samples = read_until(ahrs, 4)
    finally:
        ahrs.close()
    assert link.heard[0] == vn("VNASY,0")
    assert samples["t_s"][:3] == pytest.approx([0.02, 0.03, 0.04])
    assert np.all(samples["gyro_x"] == 0.25), "what was sent before the start is dropped"
    assert {"accel_z", "temperature_c", "host_t_s"} <= set(samples.columns)


def test_vectornav_reads_back_something_else() -> None:
    dialogue = dict(VN_DIALOGUE) | {vn("VNRRG,75"): vn("VNRRG,75,1,16,5,1,1C")}
    ahrs = vectornav(ScriptedLink(list(dialogue.items())))
    try:
        (difference,) = ahrs.configure()
        assert (difference.setting, difference.wanted, difference.found) == ("rate divisor", "8", "16")
        with pytest.raises(InstrumentError, match="does not take its settings: rate divisor was set to 8"):
            ahrs.start()
    finally:
        ahrs.close()


def test_vectornav_error_messages_are_told() -> None:
    dialogue = dict(VN_DIALOGUE) | {vn(f"VNWRG,75,{VN_BINARY}"): vn("VNERR,12")}
    ahrs = vectornav(ScriptedLink(list(dialogue.items())))
    try:
        with pytest.raises(InstrumentError, match="error 12, insufficient baud rate"):
            ahrs.configure()
    finally:
        ahrs.close()


def test_a_line_that_is_too_slow_is_refused_with_the_numbers_before_anything_is_said() -> None:
    link = ScriptedLink(VN_DIALOGUE, bits_per_second=38400)
    ahrs = vectornav(link)
    try:
        # 44 bytes × 100 Hz × 10 bits
        with pytest.raises(
            InputError, match=r"44 bytes 100\.0 times a second need 44000 bit/s.* 38400 bit/s"
        ):
            ahrs.configure()
    finally:
        ahrs.close()
    assert link.heard == []


def test_a_silent_port_and_a_port_full_of_garbage_are_told_apart() -> None:
    silent = vectornav(ScriptedLink([]))
    garbage = vectornav(ScriptedLink([(vn("VNASY,0"), b"\xb1\x9c\x07\xe0" * 20)]))
    try:
        with pytest.raises(InstrumentError, match=r"does not answer .*: check its power"):
            silent.identify()
        with pytest.raises(InstrumentError, match="although 240 bytes came, of which 240 made no frame"):
            garbage.identify()
    finally:
        silent.close()
        garbage.close()


def test_a_link_that_comes_back_is_verified_again_and_the_gap_stays_in_the_time() -> None:
    link = ScriptedLink(VN_DIALOGUE)
    ahrs = vectornav(link)
    try:
        ahrs.start()
        for n in range(1, 6):
            link.send(vn_frame(n * 10_000_000, 0.25))
        before = read_until(ahrs, 5)
        link.heard.clear()
        link.unplug()
        time.sleep(0.05)
        link.plugged = True
        end = time.monotonic() + 5.0
        while vn("VNASY,1") not in link.heard and time.monotonic() < end:
            ahrs.read()
            time.sleep(0.005)
        for n in range(50, 55):
            link.send(vn_frame(n * 10_000_000, 0.25))
        after = read_until(ahrs, 5)
    finally:
        ahrs.close()
    assert link.heard == [vn("VNASY,0"), vn("VNRRG,75"), vn("VNRRG,06"), vn("VNASY,1")]
    assert after["t_s"][0] - before["t_s"][-1] == pytest.approx(0.45)
    assert (ahrs.counts.reconnections, ahrs.counts.lost) == (1, 44)


def test_a_link_that_stays_away_ends_the_run_with_its_own_reason() -> None:
    link = ScriptedLink(VN_DIALOGUE)
    ahrs = vectornav(link)
    try:
        ahrs.start()
        link.unplug()
        with pytest.raises(LinkLostError, match=r"not plugged in|pulled out"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()


def test_the_filters_rates_are_refused() -> None:
    link = ScriptedLink(VN_DIALOGUE)
    ahrs = vectornav(link)
    try:
        ahrs.start()
        ymr = vn("VNYMR,+010.071,+000.278,-002.026,+01.0670,-00.2568,+03.0696,-00.019,+00.320,-09.802,"
                 "+00.002801,-00.001186,-00.001582")  # fmt: skip
        for _ in range(10):
            link.send(ymr)
        with pytest.raises(InstrumentError, match=r"estimate of bias|sends neither time nor counter"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()


XSENS_OUTPUTS = bytes.fromhex("1020FFFF 1060FFFF 80200064 40200064 E020FFFF 08100001")
XSENS_DIALOGUE = [
    (bytes.fromhex("FAFF3000D1"), bytes.fromhex("FAFF3100D0")),
    (bytes.fromhex("FAFF1000F1"), bytes.fromhex("FAFF1100F0")),
    (xbus(0xC0, XSENS_OUTPUTS), xbus(0xC1, XSENS_OUTPUTS)),
    (xbus(0xC0), xbus(0xC1, XSENS_OUTPUTS)),
    (xbus(0x00), xbus(0x01, bytes.fromhex("03800123"))),
    (xbus(0x1C), xbus(0x1D, b"MTi-300-2A5G4       ")),
    (xbus(0x12), xbus(0x13, bytes((1, 8, 2)))),
]


def test_xsens_goes_to_config_sets_reads_back_and_measures() -> None:
    link = ScriptedLink(XSENS_DIALOGUE)
    ahrs = XsensAhrs(XsensSettings(LINK, boot_time_s=0.0), link, RealClock())
    try:
        assert ahrs.identify() == "Xsens MTi-300-2A5G4 s/n 03800123 firmware 1.8.2"
        ahrs.start()
        for n in range(65534, 65540):  # the counter wraps on the way
            items = bytes.fromhex("102002") + struct.pack(">H", n & 0xFFFF)
            items += bytes.fromhex("106004") + struct.pack(">I", n * 100)
            items += bytes.fromhex("80200C") + struct.pack(">3f", 0.5, -0.25, 0.0)
            link.send(xbus(0x36, items))
        samples = read_until(ahrs, 5)
    finally:
        ahrs.close()
    assert samples["counter"][:4] == pytest.approx([65534, 65535, 65536, 65537])
    assert np.diff(samples["t_s"]) == pytest.approx(0.01)
    assert samples["gyro_y"][0] == -0.25
    assert ahrs.counts.lost == 0


def test_xsens_error_message_is_told() -> None:
    dialogue = dict(XSENS_DIALOGUE) | {xbus(0xC0, XSENS_OUTPUTS): xbus(0x42, b"\x21")}
    ahrs = XsensAhrs(XsensSettings(LINK, boot_time_s=0.0), ScriptedLink(list(dialogue.items())), RealClock())
    try:
        with pytest.raises(InstrumentError, match="refuses message C0: error 21, invalid parameter"):
            ahrs.configure()
    finally:
        ahrs.close()


MIP_FORMAT = bytes.fromhex("75650C0E0E0F018003D5000A04000A05000A91CE")
MIP_DIALOGUE = [
    (mip(0x01, b"\x02"), mip(0x01, b"\xf1\x02\x00")),
    (mip(0x01, b"\x06"), mip(0x01, b"\xf1\x06\x00")),
    (mip(0x0C, b"\x0e\x80"), mip(0x0C, b"\xf1\x0e\x00", b"\x8e\x80" + struct.pack(">H", 1000))),
    (MIP_FORMAT, mip(0x0C, b"\xf1\x0f\x00")),
    (
        mip(0x0C, b"\x0f\x02\x80\x00"),
        mip(0x0C, b"\xf1\x0f\x00", b"\x8f\x80\x03" + bytes.fromhex("D5000A04000A05000A")),
    ),
    (mip(0x0C, b"\x11\x01\x80\x01"), mip(0x0C, b"\xf1\x11\x00")),
]


def test_microstrain_idles_asks_for_its_base_rate_and_sets_the_makers_message_format() -> None:
    link = ScriptedLink(MIP_DIALOGUE)
    settings = MicroStrainSettings(LINK, boot_time_s=0.0, temperature=False)
    ahrs = MicroStrainAhrs(settings, link, RealClock())
    try:
        ahrs.start()
        for n in range(1, 6):
            time_field = b"\xd5" + struct.pack(">Q", n * 10_000_000)
            accel = b"\x04" + struct.pack(">3f", 0.0, 0.0, -1.0)
            gyro = b"\x05" + struct.pack(">3f", 0.125, 0.0, 0.0)
            link.send(mip(0x80, time_field, accel, gyro))
        samples = read_until(ahrs, 4)
    finally:
        ahrs.close()
    assert MIP_FORMAT in link.heard
    assert not any(b"\x0c\x39" in heard for heard in link.heard), "the gyro bias is never captured"
    assert samples["t_s"][:3] == pytest.approx([0.01, 0.02, 0.03])
    assert samples["gyro_x"][0] == 0.125
    assert samples["accel_z"][0] == -1.0
    assert ahrs.description.accel_unit == "g"


def test_microstrain_refusals_are_told() -> None:
    dialogue = dict(MIP_DIALOGUE) | {MIP_FORMAT: mip(0x0C, b"\xf1\x0f\x03")}
    settings = MicroStrainSettings(LINK, boot_time_s=0.0, temperature=False)
    ahrs = MicroStrainAhrs(settings, ScriptedLink(list(dialogue.items())), RealClock())
    try:
        with pytest.raises(InstrumentError, match="refuses command 0C/0F: code 3, invalid parameter"):
            ahrs.configure()
    finally:
        ahrs.close()


def test_rates_that_a_unit_does_not_have_are_refused() -> None:
    with pytest.raises(InputError, match="800/n"):
        VectorNavSettings(LINK, rate_hz=150.0)
    with pytest.raises(InputError, match="whole number"):
        XsensSettings(LINK, rate_hz=33.3)
    settings = MicroStrainSettings(LINK, boot_time_s=0.0, rate_hz=300.0)
    ahrs = MicroStrainAhrs(settings, ScriptedLink(MIP_DIALOGUE), RealClock())
    try:
        with pytest.raises(InputError, match="1000/n"):
            ahrs.configure()
    finally:
        ahrs.close()
