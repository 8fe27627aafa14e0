"""Units that are only listened to: NMEA and private formats. Nothing is ever said to them."""

from __future__ import annotations

import time
from functools import reduce
from operator import xor

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.ahrs.listening import GenericAhrs, GenericSettings, NmeaAhrs, NmeaSettings
from ahrs_lab.instruments.drivers.ahrs.streaming import StreamingAhrs
from ahrs_lab.instruments.interfaces import Clock
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.recording.samples import Samples
from ahrs_lab.resource_files import resource_path
from tests.instruments.ahrs.reading import read_until
from tests.instruments.ahrs.scripted_unit import ScriptedLink
from tests.instruments.fake_clock import FakeClock

LINK = LinkSettings(device="scripted")


def sentence(body: str) -> bytes:
    return f"${body}*{reduce(xor, body.encode()):02X}\r\n".encode()


def attitude(tenths: int, heading: float = 224.19) -> bytes:
    clock = f"0853{35 + tenths // 10:02d}.{tenths % 10}00"
    return sentence(f"PASHR,{clock},{heading:.2f},T,-01.26,+00.83,+00.10,0.101,0.113,0.267,1,0")


def heading(degrees: float) -> bytes:
    return sentence(f"HEHDT,{degrees:.2f},T")


def nmea(link: ScriptedLink, clock: Clock | None = None, **settings: object) -> NmeaAhrs:
    chosen = NmeaSettings(LINK, boot_time_s=0.0, **settings)  # type: ignore[arg-type]
    return NmeaAhrs(chosen, link, clock or RealClock())


def generic(link: ScriptedLink, kind: str, **settings: object) -> GenericAhrs:
    described = str(resource_path(f"devices/generic-{kind}.toml"))
    chosen = GenericSettings(LINK, format=described, boot_time_s=0.0, **settings)  # type: ignore[arg-type]
    return GenericAhrs(chosen, link, RealClock())


def wait_for_bytes(ahrs: StreamingAhrs) -> None:
    """Until the port's thread has some."""
    end = time.monotonic() + 5.0
    while not ahrs._reader.received_bytes and time.monotonic() < end:
        time.sleep(0.002)


def read_at(ahrs: StreamingAhrs, link: ScriptedLink, clock: FakeClock, t_s: float, data: bytes) -> Samples:
    """What comes of ``data`` that arrives at ``t_s``."""
    clock.t_s = t_s
    link.send(data)
    return read_until(ahrs, 1)


def test_it_is_named_by_its_settings_and_nothing_is_said_to_it() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link, manufacturer="Maker", model="GC 1", serial_number="77")
    try:
        assert ahrs.identify() == "Maker GC 1 77"
        assert ahrs.configure() == ()
        link.send(attitude(0, 1.0))
        wait_for_bytes(ahrs)
        ahrs.start()
        for tenths in range(1, 6):
            link.send(attitude(tenths))
        samples = read_until(ahrs, 4)
        ahrs.stop()
        link.send(attitude(6))
        assert len(ahrs.read()) == 0, "a stopped unit goes on sending, and nobody hears it"
    finally:
        ahrs.close()
    assert link.heard == []
    assert samples["t_s"][:3] == pytest.approx(8 * 3600 + 53 * 60 + 35 + np.array([0.1, 0.2, 0.3]))
    assert np.all(samples["heading_deg"] == 224.19), "what was sent before the start is dropped"
    assert (samples["pitch_deg"][0], samples["roll_deg"][0]) == (0.83, -1.26)
    assert "host_t_s" in samples
    assert (ahrs.counts.frames, ahrs.counts.lost, ahrs.counts.failed) == (5, 0, 0)


def test_a_sentence_that_is_cut_or_broken_is_counted_and_its_time_missed() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link)
    try:
        ahrs.start()
        link.send(attitude(0)[20:] + attitude(1) + attitude(2))
        link.send(attitude(3).replace(b"224", b"225") + attitude(4))
        assert len(read_until(ahrs, 3)) == 3
    finally:
        ahrs.close()
    assert (ahrs.counts.frames, ahrs.counts.failed, ahrs.counts.lost) == (3, 1, 1)


def test_headings_without_a_time_are_counted_at_the_nominal_rate() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link)
    try:
        ahrs.start()
        link.send(b"".join(heading(n) for n in range(4)))
        samples = read_until(ahrs, 4)
    finally:
        ahrs.close()
    assert samples["t_s"] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert samples["heading_deg"].tolist() == [0.0, 1.0, 2.0, 3.0]


def test_a_damaged_sentence_among_counted_ones_ends_the_run() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link)
    try:
        ahrs.start()
        link.send(heading(1) + heading(2))
        read_until(ahrs, 2)
        link.send(heading(3).replace(b"3.", b"4.") + heading(4))
        with pytest.raises(InstrumentError, match=r"were lost \(1 damaged frames"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()


def test_a_count_that_falls_behind_the_clock_ends_the_run() -> None:
    link, clock = ScriptedLink([]), FakeClock()
    ahrs = nmea(link, clock)
    try:
        ahrs.start()
        assert len(read_at(ahrs, link, clock, 0.1, heading(1) + heading(1))) == 2
        for n in range(3, 8):
            assert len(read_at(ahrs, link, clock, 0.1 * n, heading(n))) == 1
        with pytest.raises(InstrumentError, match=r"0 damaged frames, 1.* s behind the clock"):
            read_at(ahrs, link, clock, 2.0, heading(9))
    finally:
        ahrs.close()


def unplugged_for_a_moment(ahrs: StreamingAhrs, link: ScriptedLink, last: bytes = b"") -> None:
    """Pull the cable behind ``last`` and put it back; the driver has noticed both."""
    connections = ahrs.counts.reconnections
    link.send(last)
    link.unplug()
    link.plugged = True
    end = time.monotonic() + 5.0
    while ahrs.counts.reconnections == connections and time.monotonic() < end:
        assert len(ahrs.read()) == 0
        time.sleep(0.002)


def test_a_gap_of_the_link_stays_in_the_time_and_no_sentence_is_made_of_two_halves() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link)
    try:
        ahrs.start()
        link.send(attitude(0) + attitude(1))
        before = read_until(ahrs, 2)
        unplugged_for_a_moment(ahrs, link, attitude(2)[:30])
        link.send(attitude(2)[30:])
        link.send(attitude(4) + attitude(5))
        after = read_until(ahrs, 2)
    finally:
        ahrs.close()
    assert after["t_s"] - before["t_s"][-1] == pytest.approx([0.3, 0.4])
    assert (ahrs.counts.reconnections, ahrs.counts.lost) == (1, 2)
    assert ahrs.counts.skipped_bytes == len(attitude(2))
    assert link.heard == []


def test_a_gap_among_counted_samples_ends_the_run() -> None:
    link, clock = ScriptedLink([]), FakeClock()
    ahrs = nmea(link, clock)
    try:
        ahrs.start()
        read_at(ahrs, link, clock, 0.2, heading(1) + heading(2))
        unplugged_for_a_moment(ahrs, link)
        with pytest.raises(InstrumentError, match="behind the clock"):
            read_at(ahrs, link, clock, 1.5, heading(3))
    finally:
        ahrs.close()


def test_a_cable_that_stays_out_ends_the_run_with_its_own_reason() -> None:
    link = ScriptedLink([])
    ahrs = nmea(link)
    try:
        ahrs.start()
        link.unplug()
        with pytest.raises(LinkLostError, match=r"not plugged in|pulled out"):
            read_until(ahrs, 1)
    finally:
        ahrs.close()


def test_a_wrong_baud_rate_is_told_and_silence_is_left_to_the_run() -> None:
    link, clock = ScriptedLink([]), FakeClock()
    wrong, silent = nmea(link, clock), nmea(ScriptedLink([]), clock)
    try:
        wrong.start()
        silent.start()
        clock.t_s = 1.0
        link.send(b"\xb1\x9c\x07\xe0" * 20)
        with pytest.raises(InstrumentError, match="80 bytes made none"):
            read_until(wrong, 1)
        assert len(silent.read()) == 0
    finally:
        wrong.close()
        silent.close()


def test_a_line_is_refused_only_where_no_sentence_would_fit() -> None:
    ten, hundred = (
        nmea(ScriptedLink([], bits_per_second=4800), rate_hz=rate_hz) for rate_hz in (10.0, 100.0)
    )
    try:
        assert ten.configure() == ()
        with pytest.raises(InputError, match=r"carries 4800 bit/s"):
            hundred.configure()
    finally:
        ten.close()
        hundred.close()


def test_a_described_line_is_read_in_its_units() -> None:
    link = ScriptedLink([])
    ahrs = generic(link, "text", name="Private unit", frame_bytes=80.0)
    try:
        assert ahrs.identify() == "Private unit"
        assert ahrs.configure() == ()
        ahrs.start()
        for n in range(1, 4):
            link.send(sentence(f"AHRS,{n / 100},10,20,30,0.5,0,0,0,0,-1"))
        samples = read_until(ahrs, 3)
        unplugged_for_a_moment(ahrs, link)
        link.send(sentence("AHRS,0.08,10,20,30,0.5,0,0,0,0,-1"))
        assert read_until(ahrs, 1)["t_s"].tolist() == [0.08]
    finally:
        ahrs.close()
    assert (ahrs.description.rate_unit, ahrs.description.accel_unit) == ("deg/s", "m/s^2")
    assert samples["t_s"] == pytest.approx([0.01, 0.02, 0.03])
    assert samples["accel_z"] == pytest.approx(-9.80665)
    assert (ahrs.counts.lost, ahrs.counts.reconnections) == (4, 1)
    assert link.heard == []


def test_described_counts_have_no_range_and_their_counter_tells_what_is_lost() -> None:
    link = ScriptedLink([])
    ahrs = generic(link, "counts")

    def frame(n: int) -> bytes:
        payload = bytes((n % 256,)) + (2_000_000).to_bytes(4, "big") + bytes(20) + b"\x01\x02"
        return b"\x80\x7f" + payload + bytes((sum(payload) & 0xFF,))

    try:
        ahrs.start()
        link.send(b"".join(frame(n) for n in (254, 255, 256, 259)))
        samples = read_until(ahrs, 4)
    finally:
        ahrs.close()
    assert ahrs.description.rate_unit == "LSB"
    assert samples["counter"].tolist() == [254.0, 255.0, 256.0, 259.0]
    assert samples["gyro_x"][0] == 2_000_000
    assert (ahrs.counts.lost, ahrs.counts.implausible) == (2, 0)


def test_a_format_that_is_missing_or_no_file_is_refused() -> None:
    with pytest.raises(InputError, match="“format” is missing"):
        GenericSettings(LINK)
    with pytest.raises(InputError, match="“nmea” is no description"):
        GenericAhrs(GenericSettings(LINK, format="nmea"), ScriptedLink([]), RealClock())
