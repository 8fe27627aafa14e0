"""Room sensors: SCPI, Modbus on a serial line and over TCP, typed in."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.rooms.sensors import (
    ModbusRoomSettings,
    ModbusSensor,
    ModbusValue,
    PolledRoom,
    ScpiRoomSettings,
    ScpiSensor,
    TypedRoom,
)
from ahrs_lab.instruments.drivers.scpi_talk import LinkTalk, ScpiConnection
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.checksums import crc16_modbus
from ahrs_lab.instruments.protocols.modbus import (
    ModbusReply,
    RtuDecoder,
    TcpDecoder,
    encode_rtu_read,
    encode_rtu_reply,
    encode_tcp_read,
    encode_tcp_reply,
    value_of,
    with_crc,
)
from tests.instruments.fake_clock import FakeClock
from tests.instruments.fake_link import FakeLink, expected_conversation
from tests.instruments.supplies.scpi_device import ScpiDevice

LINK = LinkSettings(device="COM7")


def test_frames_are_those_of_the_modbus_specification() -> None:
    # the check value of CRC-16/MODBUS, and the example that every manual prints
    assert crc16_modbus(b"123456789") == 0x4B37
    assert encode_rtu_read(1, 3, 0, 10) == bytes.fromhex("01 03 00 00 00 0a c5 cd")
    # Modbus application protocol 1.1b3, 6.3: read registers 108 to 110
    assert encode_tcp_read(1, 17, 3, 107, 3) == bytes.fromhex("0001 0000 0006 11 03 006b 0003")
    assert TcpDecoder().feed(bytes.fromhex("0001 0000 0009 11 03 06 022b 0000 0064")) == [
        ModbusReply(17, 3, (555, 0, 100), 0, 1)
    ]


@pytest.mark.parametrize("decoder", [RtuDecoder, TcpDecoder])
@given(
    pieces=st.lists(
        st.one_of(
            st.binary(max_size=10),
            st.lists(st.integers(0, 65535), min_size=1, max_size=4).map(lambda r: encode_rtu_reply(1, 3, r)),
            st.lists(st.integers(0, 65535), min_size=1, max_size=4).map(
                lambda r: encode_tcp_reply(5, 1, 4, r)
            ),
            st.just(with_crc(b"\x01\x83\x02")),
        ),
        max_size=6,
    ),
    cuts=st.lists(st.integers(0, 100), max_size=8),
)
def test_any_bytes_in_any_split_give_the_same(
    decoder: type[RtuDecoder] | type[TcpDecoder], pieces: list[bytes], cuts: list[int]
) -> None:
    data = b"".join(pieces)
    whole, split = decoder(), decoder()
    wanted = whole.feed(data)
    edges = sorted({min(cut, len(data)) for cut in cuts} | {0, len(data)})
    got = []
    for start, stop in pairwise(edges):
        got += split.feed(data[start:stop])
    assert got == wanted
    assert split.counts == whole.counts


@given(st.binary(max_size=3), st.lists(st.integers(0, 65535), min_size=1, max_size=125))
def test_an_rtu_answer_survives_the_wire_behind_noise(noise: bytes, registers: list[int]) -> None:
    decoder = RtuDecoder()
    found = decoder.feed(noise + encode_rtu_reply(9, 4, registers) + bytes(300))
    assert ModbusReply(9, 4, tuple(registers)) in found


@pytest.mark.parametrize(
    ("registers", "kind", "words", "value"),
    [
        ((0xFFF6,), "int16", "big", -10.0),
        ((0xFFF6,), "uint16", "big", 65526.0),
        ((0x41B0, 0x0000), "float32", "big", 22.0),
        ((0x0000, 0x41B0), "float32", "little", 22.0),
        ((0xFFFF, 0xFFFE), "int32", "big", -2.0),
        ((0x0001, 0x0000), "uint32", "big", 65536.0),
    ],
)
def test_registers_hold_numbers(
    registers: tuple[int, ...],
    kind: Literal["int16", "uint16", "int32", "uint32", "float32"],
    words: Literal["big", "little"],
    value: float,
) -> None:
    assert value_of(registers, kind, words) == value


def test_conversation_with_a_modbus_sensor_on_a_serial_line() -> None:
    talk = [
        (bytes.fromhex("01 03 0001 0001 d5ca"), encode_rtu_reply(1, 3, [0xFF9C])),
        (bytes.fromhex("01 03 0000 0001 840a"), encode_rtu_reply(1, 3, [512])),
    ]
    with expected_conversation(talk) as link:
        link.open()
        sensor = ModbusSensor(ModbusRoomSettings(LINK), link)
        assert sensor.measure() == pytest.approx((-10.0, 51.2))


def test_conversation_with_a_modbus_sensor_over_tcp() -> None:
    settings = ModbusRoomSettings(
        LinkSettings(host="sensor"),
        protocol="tcp",
        unit=2,
        function=4,
        temperature=ModbusValue(10, "float32", 1.0),
        humidity=ModbusValue(12, "uint16", 0.01, 5.0),
    )
    talk = [
        (encode_tcp_read(1, 2, 4, 10, 2), encode_tcp_reply(1, 2, 4, [0x41B0, 0])),
        (encode_tcp_read(2, 2, 4, 12, 1), encode_tcp_reply(2, 2, 4, [4000])),
    ]
    with expected_conversation(talk) as link:
        link.open()
        assert ModbusSensor(settings, link).measure() == pytest.approx((22.0, 45.0))


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (with_crc(b"\x01\x83\x02"), "illegal data address"),
        (encode_rtu_reply(2, 3, [200]), "does not belong"),
        (encode_rtu_reply(1, 3, [1, 2]), "does not belong"),
        (encode_rtu_reply(1, 3, [9999]), "check the sensor"),
        (b"", "has not answered"),
        (encode_rtu_reply(1, 3, [200])[:-1] + b"\x00", "has not answered"),
    ],
)
def test_what_is_wrong_with_a_sensor_is_told(answer: bytes, says: str) -> None:
    sensor = ModbusSensor(ModbusRoomSettings(LINK, timeout_s=0.05), FakeLink(lambda request: answer))
    room = PolledRoom(sensor, FakeClock())
    with pytest.raises(InstrumentError, match=says):
        room.open()
    room.close()


def test_a_scpi_sensor_is_read_in_the_background() -> None:
    settings = ScpiRoomSettings(ScpiConnection(link=LinkSettings(host="x")))
    room = PolledRoom(ScpiSensor(settings, LinkTalk(FakeLink(ScpiDevice()), timeout_s=0.2)), FakeClock())
    assert room.open() == room.identify() == "ACME,PS1,7,1.0"
    reading = room.read()
    room.close()
    assert (reading.temperature_c, reading.humidity_percent) == (21.35, 48.2)


def test_typed_values_carry_the_time_they_were_entered() -> None:
    clock = FakeClock()
    room = TypedRoom(clock)
    with pytest.raises(InstrumentError, match="not been entered"):
        room.read()
    clock.wait(5.0)
    room.enter(21.5, 48.0)
    clock.wait(60.0)
    assert room.read().t_s == pytest.approx(5.0)
    assert room.read().temperature_c == 21.5
    for wrong in ((21.0, 101.0), (400.0, 50.0), (float("nan"), 50.0)):
        with pytest.raises(InputError):
            room.enter(*wrong)
    assert room.read().humidity_percent == 48.0
