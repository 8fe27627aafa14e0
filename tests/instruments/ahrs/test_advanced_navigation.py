"""What the driver says to an Advanced Navigation unit and what it makes of the answers; packets are summed up
here by the rule in the maker's manual."""

from __future__ import annotations

import struct
import time

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.advanced_navigation import (
    AdvancedNavigationAhrs,
    AdvancedNavigationSettings,
)
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.real_clock import RealClock
from tests.instruments.ahrs.reading import read_until
from tests.instruments.ahrs.scripted_unit import ScriptedLink
from tests.instruments.fake_clock import FakeClock

LINK = LinkSettings(device="scripted")


def crc_of(data: bytes) -> bytes:
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return struct.pack("<H", crc)


def packet(packet_id: int, data: bytes) -> bytes:
    head = bytes((packet_id, len(data))) + crc_of(data)
    return bytes(((sum(head) ^ 0xFF) + 1 & 0xFF,)) + head + data


def acknowledged(command: bytes, result: int = 0) -> tuple[bytes, bytes]:
    return command, packet(0, command[1:2] + command[3:5] + bytes((result,)))


def sample(t_us: int, gyro: float) -> bytes:
    raw = struct.pack("<12f", 0.0, 0.0, -9.8, gyro, 0.0, 0.0, 0.0, 0.0, 0.0, 25.5, 1e5, 25.0)
    return packet(21, struct.pack("<II", *divmod(t_us, 1_000_000))) + packet(28, raw)


PAUSE = packet(181, b"\x00\x01")
RESUME = packet(181, b"\x00\x01" + struct.pack("<BIBI", 21, 1, 28, 1))
SET_TIMER = packet(180, struct.pack("<BBH", 0, 1, 10_000))
ASK_TIMER, ASK_DEVICE = packet(1, b"\xb4"), packet(1, b"\x03")
DEVICE = packet(3, struct.pack("<6I", 61, 26, 4, 0xA, 0xB, 0xC))
DIALOGUE = [
    acknowledged(PAUSE),
    acknowledged(RESUME),
    acknowledged(SET_TIMER),
    (ASK_TIMER, SET_TIMER),
    (ASK_DEVICE, DEVICE),
]
START_US = 1_700_000_000_000_000


def unit(link: ScriptedLink, **settings: object) -> AdvancedNavigationAhrs:
    chosen = AdvancedNavigationSettings(LINK, boot_time_s=0.0, **settings)  # type: ignore[arg-type]
    return AdvancedNavigationAhrs(chosen, link, RealClock())


def changed(*answers: tuple[bytes, bytes]) -> ScriptedLink:
    return ScriptedLink(list((dict(DIALOGUE) | dict(answers)).items()))


def test_it_is_paused_asked_set_read_back_started_and_paused_again() -> None:
    link = ScriptedLink(DIALOGUE)
    ahrs = unit(link)
    name = "Advanced Navigation certus hardware 4 s/n 0000000A-0000000B-0000000C firmware 61"
    try:
        assert ahrs.identify() == name
        assert ahrs.description.model == "certus"
        assert ahrs.configure() == ()
        link.send(sample(START_US, 7.0))
        ahrs.start()
        for n in range(1, 7):
            link.send(sample(START_US + n * 10_000, 0.25))
        samples = read_until(ahrs, 5)
        ahrs.stop()
    finally:
        ahrs.close()
    assert link.heard == [PAUSE, ASK_DEVICE, PAUSE, SET_TIMER, ASK_TIMER, PAUSE, ASK_TIMER, RESUME, PAUSE]
    assert samples["t_s"][:2] - START_US / 1e6 == pytest.approx([0.01, 0.02], abs=1e-6)
    assert np.all(samples["gyro_x"] == 0.25), "what was sent before the start is dropped"
    assert samples["accel_z"][0] == pytest.approx(-9.8)
    assert samples["temperature_c"][0] == 25.5
    assert "host_t_s" in samples
    assert (ahrs.counts.lost, ahrs.counts.failed, ahrs.counts.skipped_bytes) == (0, 0, 0)


def test_a_device_that_the_makers_package_does_not_know_keeps_its_number() -> None:
    ahrs = unit(changed((ASK_DEVICE, packet(3, struct.pack("<6I", 61, 999, 4, 1, 2, 3)))))
    try:
        assert ahrs.identify().startswith("Advanced Navigation device 999 hardware 4")
    finally:
        ahrs.close()


def test_another_timer_read_back_is_shown_and_not_started() -> None:
    ahrs = unit(changed((ASK_TIMER, packet(180, struct.pack("<BBH", 0, 1, 20_000)))))
    try:
        (difference,) = ahrs.configure()
        assert (difference.wanted, difference.found) == ("10000 µs", "20000 µs")
        with pytest.raises(InstrumentError, match="does not take its settings: packet timer"):
            ahrs.start()
    finally:
        ahrs.close()


@pytest.mark.parametrize(("result", "text"), [(3, "out of range"), (5, "not ready"), (6, "unknown packet")])
def test_refusals_are_told_in_the_makers_words(result: int, text: str) -> None:
    ahrs = unit(changed(acknowledged(SET_TIMER, result)))
    try:
        with pytest.raises(InstrumentError, match=f"refuses packet timer period: {text}"):
            ahrs.configure()
    finally:
        ahrs.close()


def test_the_answer_to_an_earlier_command_is_not_taken_for_this_one() -> None:
    ahrs = unit(changed((RESUME, acknowledged(PAUSE)[1])))
    try:
        with pytest.raises(InstrumentError, match=r"does not answer \(packets period\)"):
            ahrs.start()
    finally:
        ahrs.close()


def test_silence_and_a_wrong_baud_rate_are_told_apart() -> None:
    silent, garbage = unit(ScriptedLink([])), unit(ScriptedLink([(PAUSE, b"\xb1\x9c\x07\xe0" * 20)]))
    try:
        with pytest.raises(InstrumentError, match=r"does not answer .*: check its power"):
            silent.identify()
        with pytest.raises(InstrumentError, match=r"although 240 bytes came, of which .*check the baud rate"):
            garbage.identify()
    finally:
        silent.close()
        garbage.close()


def test_a_line_that_is_too_slow_is_refused_before_anything_is_said() -> None:
    link = ScriptedLink(DIALOGUE, bits_per_second=57_600)
    ahrs = unit(link)
    try:
        with pytest.raises(InputError, match=r"66 bytes 100\.0 times a second need 66000 bit/s"):
            ahrs.configure()
    finally:
        ahrs.close()
    assert link.heard == []


def test_a_link_that_comes_back_is_verified_again_and_the_gap_is_counted() -> None:
    link = ScriptedLink(DIALOGUE)
    ahrs = unit(link)
    try:
        ahrs.start()
        for n in range(5):
            link.send(sample(START_US + n * 10_000, 0.25))
        before = read_until(ahrs, 5)
        link.heard.clear()
        link.unplug()
        time.sleep(0.05)
        link.plugged = True
        end = time.monotonic() + 5.0
        while RESUME not in link.heard and time.monotonic() < end:
            ahrs.read()
            time.sleep(0.005)
        for n in range(50, 55):
            link.send(sample(START_US + n * 10_000, 0.25))
        after = read_until(ahrs, 5)
    finally:
        ahrs.close()
    assert link.heard == [PAUSE, ASK_TIMER, RESUME]
    assert after["t_s"][0] - before["t_s"][-1] == pytest.approx(0.46)
    assert (ahrs.counts.reconnections, ahrs.counts.lost) == (1, 45)


def test_a_unit_that_comes_back_with_other_settings_is_set_again_or_refused() -> None:
    link = ScriptedLink(DIALOGUE)
    ahrs = unit(link)
    try:
        ahrs.start()
        link.send(sample(START_US, 0.25) + sample(START_US + 10_000, 0.25))
        assert len(read_until(ahrs, 2)) == 2
        link.heard.clear()
        link.dialogue[ASK_TIMER] = packet(180, struct.pack("<BBH", 0, 1, 20_000))
        link.unplug()
        link.plugged = True
        with pytest.raises(InstrumentError, match="does not take its settings"):
            read_until(ahrs, 1)
        assert link.heard == [PAUSE, ASK_TIMER, SET_TIMER, ASK_TIMER]
    finally:
        ahrs.close()


def test_damage_is_counted_and_a_link_that_stays_away_ends_the_run() -> None:
    link = ScriptedLink(DIALOGUE)
    ahrs = unit(link)
    try:
        ahrs.start()
        broken = bytearray(sample(START_US + 10_000, 0.25))
        broken[-1] ^= 0x10
        link.send(sample(START_US, 0.25) + bytes(broken) + sample(START_US + 20_000, 0.25))
        link.send(sample(START_US + 30_000, 0.25))
        assert len(read_until(ahrs, 3)) == 3
        assert (ahrs.counts.failed, ahrs.counts.lost) == (1, 1)
        link.unplug()
        with pytest.raises(LinkLostError, match=r"not plugged in|pulled out"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()


@pytest.mark.parametrize("rate_hz", [3.0, 15.0, 2000.0])
def test_rates_that_it_does_not_have_are_refused(rate_hz: float) -> None:
    with pytest.raises(InputError, match="whole number of microseconds"):
        AdvancedNavigationSettings(LINK, rate_hz=rate_hz)


def test_a_unit_that_was_just_resumed_is_not_yet_blamed_for_its_silence() -> None:
    link, clock = ScriptedLink(DIALOGUE), FakeClock()
    ahrs = AdvancedNavigationAhrs(AdvancedNavigationSettings(LINK, boot_time_s=0.0), link, clock)
    try:
        ahrs.start()
        link.send(sample(START_US, 0.25) + sample(START_US + 10_000, 0.25))
        read_until(ahrs, 2)
        link.heard.clear()
        clock.t_s += 0.79
        link.unplug()
        link.plugged = True
        end = time.monotonic() + 5.0
        while RESUME not in link.heard and time.monotonic() < end:
            ahrs.read()
            time.sleep(0.002)
        ahrs._end_recovery()
        clock.t_s += 0.1
        assert len(ahrs.read()) == 0
        clock.t_s += 0.8
        link.send(b"nonsense")
        with pytest.raises(InstrumentError, match="nothing of what it was set to"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()
