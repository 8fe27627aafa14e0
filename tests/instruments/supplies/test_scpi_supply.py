"""The SCPI supply: its conversation, its limits, PyVISA and our own links, being unplugged."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.scpi_talk import LinkTalk, ScpiConnection, VisaTalk, make_talk
from ahrs_lab.instruments.drivers.supplies.scpi import ScpiSupply, ScpiSupplySettings
from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.links.tcp_link import TcpLink
from ahrs_lab.instruments.protocols.scpi import number_text, parse_error, parse_number, parse_switch
from ahrs_lab.instruments.real_clock import RealClock
from tests.instruments.fake_clock import FakeClock
from tests.instruments.fake_link import FakeLink, expected_conversation
from tests.instruments.links.ports import TcpEnd, answering, needs_pty, pty_end, tcp_end
from tests.instruments.supplies.scpi_device import ScpiDevice

CONNECTION = ScpiConnection(link=LinkSettings(host="supply"))
SETTINGS = ScpiSupplySettings(CONNECTION, max_voltage_v=28.0, max_current_a=2.0, period_s=0.02)


def supply_on(link: Link) -> ScpiSupply:
    return ScpiSupply(SETTINGS, LinkTalk(link, timeout_s=0.3), FakeClock())


def test_the_conversation_sets_the_limit_before_the_voltage_and_reads_both_back() -> None:
    talk = [
        (b"*IDN?\n", b"ACME,PS1\n"),
        (b"CURR 1.5\n", b""),
        (b"VOLT 12\n", b""),
        (b"VOLT?\n", b"1.2000E+01\r\n"),
        (b"CURR?\n", b"1.500\n"),
        (b"OUTP ON\n", b""),
        (b"MEAS:VOLT?\n", b"11.98\n"),
        (b"MEAS:CURR?\n", b"0.251\n"),
        (b"OUTP?\n", b"1\n"),
        (b"OUTP OFF\n", b""),
        (b"MEAS:VOLT?\n", b"0.01\n"),
        (b"MEAS:CURR?\n", b"0\n"),
        (b"OUTP?\n", b"OFF\n"),
    ]
    with expected_conversation(talk) as link:
        supply = supply_on(link)
        assert supply.connect() == supply.identify() == "ACME,PS1"
        supply.set_output(12.0, 1.5)
        supply.on()
        reading = supply.read()
        assert (reading.voltage_v, reading.current_a, reading.output_on) == (11.98, 0.251, True)
        supply.off()
        assert not supply.read().output_on


def test_more_than_the_limits_is_refused_unsaid() -> None:
    device = ScpiDevice()
    supply = supply_on(FakeLink(device))
    supply.connect()
    device.said.clear()
    for volt, ampere in ((28.1, 1.0), (-1.0, 1.0), (float("nan"), 1.0), (12.0, 2.1), (12.0, 0.0)):
        with pytest.raises(InputError):
            supply.set_output(volt, ampere)
    assert device.said == []


def test_a_supply_that_sets_something_else_is_told() -> None:
    device = ScpiDevice()
    device.highest_volt = 10.0
    supply = supply_on(FakeLink(device))
    supply.connect()
    (difference,) = supply.configure(12.0, 1.0)
    assert (difference.setting, difference.wanted, difference.found) == ("VOLT", "12", "10")
    with pytest.raises(InstrumentError, match="VOLT was set to 12"):
        supply.set_output(12.0, 1.0)


def test_an_output_that_does_not_switch_is_told() -> None:
    device = ScpiDevice()

    def tripped(data: bytes) -> bytes:
        answer = device(data)
        device.output = False
        return answer

    supply = supply_on(FakeLink(tripped))
    supply.connect()
    with pytest.raises(InstrumentError, match="output is OFF"):
        supply.on()


def until(condition: Callable[[], bool], limit_s: float = 5.0) -> float:
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < limit_s
        time.sleep(0.005)
    return time.monotonic() - begin


def is_lost(supply: ScpiSupply) -> bool:
    try:
        supply.read()
    except LinkLostError:
        return True
    return False


def test_an_unplugged_supply_is_noticed_within_a_second_and_verified_when_it_is_back() -> None:
    device = ScpiDevice()
    clock = RealClock()
    with tcp_end() as end:
        port = end.port
        supply = ScpiSupply(SETTINGS, LinkTalk(TcpLink("127.0.0.1", port), timeout_s=0.3), clock)
        with answering(end, device):
            supply.open()
            supply.set_output(12.0, 1.0)
            supply.on()
            assert supply.read().current_a == pytest.approx(0.5)
        end.unplug()
        assert until(lambda: is_lost(supply)) < 1.0
        again = TcpEnd(port)
        device.said.clear()
        with answering(again, device):
            until(lambda: not is_lost(supply))
            assert device.said[:3] == ["*IDN?", "VOLT?", "CURR?"]
            assert supply.read().output_on
            supply.close()
        again.unplug()


def test_pyvisa_speaks_to_a_socket() -> None:
    device = ScpiDevice()
    with tcp_end() as end, answering(end, device):
        talk = make_talk(ScpiConnection(resource=f"TCPIP::127.0.0.1::{end.port}::SOCKET", timeout_s=0.3))
        assert isinstance(talk, VisaTalk)
        supply = ScpiSupply(SETTINGS, talk, RealClock())
        assert supply.open() == "ACME,PS1,7,1.0"
        supply.set_output(24.0, 2.0)
        supply.on()
        assert supply.read().current_a == pytest.approx(1.0)
        supply.off()
        supply.close()


@needs_pty
def test_pyvisa_speaks_to_a_serial_port_and_notices_that_it_is_gone() -> None:
    device = ScpiDevice()
    with pty_end() as end:

        def serve() -> None:
            while True:
                try:
                    data = os.read(end.master, 1024)
                except OSError:
                    return
                os.write(end.master, device(data))
                if b"BYE" in data:
                    return

        thread = threading.Thread(target=serve)
        thread.start()
        talk = VisaTalk(ScpiConnection(resource=f"ASRL{end.path}::INSTR", timeout_s=0.3))
        talk.open()
        assert talk.ask("*IDN?") == "ACME,PS1,7,1.0"
        talk.say("BYE")
        thread.join()
        with pytest.raises(LinkLostError, match="has not answered"):
            talk.ask("*IDN?")
        with pytest.raises(LinkLostError, match="not open"):
            talk.say("x")
        talk.close()


def test_a_resource_that_is_none_is_told() -> None:
    talk = VisaTalk(ScpiConnection(resource="ASRL/dev/no-such-port::INSTR"))
    with pytest.raises(LinkLostError, match="cannot be opened"):
        talk.open()
    talk.close()
    for wrong in ({}, {"resource": "x", "link": LinkSettings(host="y")}):
        with pytest.raises(InputError):
            ScpiConnection(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("+1.200000E+01", 12.0),
        ("12.5 V", 12.5),
        (".5", 0.5),
        ("5.,1", 5.0),
        ("48.2 %", 48.2),
        ("9.91E37", None),
        ("-9.9E37", None),
        ("1e999", None),
        ("nan", None),
        ("", None),
        ("12 34", None),
    ],
)
def test_numbers_of_scpi(text: str, value: float | None) -> None:
    assert parse_number(text) == value


@given(st.text(max_size=20))
def test_no_answer_upsets_the_reading(text: str) -> None:
    parse_number(text), parse_switch(text), parse_error(text)


@given(st.floats(-1000, 1000))
def test_numbers_are_said_plainly(value: float) -> None:
    text = number_text(value)
    assert "e" not in text.lower()
    assert float(text) == pytest.approx(value, abs=1e-6)


def test_errors_and_switches_of_scpi() -> None:
    assert parse_error('-113,"Undefined header"') == (-113, "Undefined header")
    assert parse_error("0,No error") == (0, "No error")
    assert parse_error("what") is None
    assert [parse_switch(t) for t in ("on", "0", "2")] == [True, False, None]
