"""Thermometers and hygrometers: by SCPI, by Modbus, or read off a dial and typed in."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import Literal, Protocol

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.conversation import Conversation
from ahrs_lab.instruments.drivers.reading_loop import ReadingLoop
from ahrs_lab.instruments.drivers.scpi_talk import ScpiConnection, ScpiTalk
from ahrs_lab.instruments.interfaces import Clock, RoomReading
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.modbus import (
    EXCEPTIONS,
    Function,
    ModbusReply,
    RtuDecoder,
    TcpDecoder,
    ValueKind,
    WordOrder,
    encode_rtu_read,
    encode_tcp_read,
    register_count,
    value_of,
)
from ahrs_lab.instruments.protocols.scpi import parse_number
from ahrs_lab.instruments.settings import within

_COLDEST_C, _HOTTEST_C = -60.0, 100.0
_LAST_TRANSACTION = 0xFFFF
_PERIODS = (0.1, 600.0)


@dataclass(frozen=True)
class ScpiRoomSettings:
    """The two queries, and how often they are asked."""

    connection: ScpiConnection
    temperature: str = "MEAS:TEMP?"
    humidity: str = "MEAS:HUM?"
    period_s: float = 1.0

    def __post_init__(self) -> None:
        within("period_s", self.period_s, *_PERIODS)


@dataclass(frozen=True)
class ModbusValue:
    """Where a value stands and what it means: number × ``scale`` + ``offset``."""

    address: int
    kind: ValueKind = "int16"
    scale: float = 0.1
    offset: float = 0.0
    words: WordOrder = "big"

    def __post_init__(self) -> None:
        within("address", self.address, 0, 0xFFFF)


@dataclass(frozen=True)
class ModbusRoomSettings:
    """``function`` 3 reads holding registers, 4 input registers; addresses count from 0. The defaults are
    those of a common cheap sensor: humidity in register 0, temperature in 1, tenths."""

    link: LinkSettings
    protocol: Literal["rtu", "tcp"] = "rtu"
    unit: int = 1
    function: Function = 3
    temperature: ModbusValue = field(default_factory=lambda: ModbusValue(1))
    humidity: ModbusValue = field(default_factory=lambda: ModbusValue(0))
    period_s: float = 1.0
    timeout_s: float = 0.8

    def __post_init__(self) -> None:
        within("unit", self.unit, 0, 247)
        within("period_s", self.period_s, *_PERIODS)
        within("timeout_s", self.timeout_s, 0.05, 30.0)


class _Sensor(Protocol):
    """One that is asked."""

    @property
    def name(self) -> str: ...
    def open(self) -> str: ...
    def close(self) -> None: ...
    def measure(self) -> tuple[float, float]:
        """°C and %."""
        ...


class PolledRoom:
    """A :class:`~ahrs_lab.instruments.interfaces.Room` that reads its sensor in the background."""

    def __init__(self, sensor: _Sensor, clock: Clock, period_s: float = 1.0) -> None:
        self._sensor = sensor
        self._clock = clock
        self._identity = ""
        self._loop = ReadingLoop(f"room {sensor.name}", self._measure, self._reconnect, period_s)

    def open(self) -> str:
        """Connect, and read from now on; who answered."""
        with self._loop.lock:
            self._identity = self._sensor.open()
        self._loop.start()
        return self._identity

    def close(self) -> None:
        """End the thread and release the link."""
        self._loop.close()
        self._sensor.close()

    def identify(self) -> str:
        """Who answered when the link was opened last."""
        return self._identity

    def read(self) -> RoomReading:
        """The last reading. Raises what is wrong with the sensor."""
        return self._loop.latest()

    def _measure(self) -> RoomReading:
        temperature, humidity = self._sensor.measure()
        return _plausible(RoomReading(self._clock.now_s(), temperature, humidity))

    def _reconnect(self) -> None:
        self._sensor.close()
        self._sensor.open()


class ScpiSensor:
    """See :class:`_Sensor`."""

    def __init__(self, settings: ScpiRoomSettings, talk: ScpiTalk) -> None:
        self._settings = settings
        self._talk = talk

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.name

    def open(self) -> str:
        """Who answers ``*IDN?``."""
        self._talk.open()
        return self._talk.ask("*IDN?")

    def close(self) -> None:
        """Never raises."""
        self._talk.close()

    def measure(self) -> tuple[float, float]:
        """See :class:`_Sensor`."""
        return self._number(self._settings.temperature), self._number(self._settings.humidity)

    def _number(self, query: str) -> float:
        answer = self._talk.ask(query)
        value = parse_number(answer)
        if value is None:
            raise InstrumentError("The room sensor answers “{text}” to {query}.", text=answer, query=query)
        return value


class ModbusSensor:
    """See :class:`_Sensor`."""

    def __init__(self, settings: ModbusRoomSettings, link: Link) -> None:
        self._settings = settings
        self._transaction = 0
        decoder = RtuDecoder() if settings.protocol == "rtu" else TcpDecoder()
        self._talk: Conversation[ModbusReply] = Conversation(link, decoder, settings.timeout_s)

    @property
    def name(self) -> str:
        """Of the link."""
        return self._talk.link.name

    def open(self) -> str:
        """Modbus sensors have no name: link and unit stand in for it."""
        self._talk.open()
        return f"Modbus {self.name}, {self._settings.unit}"

    def close(self) -> None:
        """Never raises."""
        self._talk.close()

    def measure(self) -> tuple[float, float]:
        """See :class:`_Sensor`."""
        return self._value(self._settings.temperature), self._value(self._settings.humidity)

    def _value(self, value: ModbusValue) -> float:
        s = self._settings
        count = register_count(value.kind)
        self._transaction = self._transaction % _LAST_TRANSACTION + 1
        if s.protocol == "rtu":
            request = encode_rtu_read(s.unit, s.function, value.address, count)
        else:
            request = encode_tcp_read(self._transaction, s.unit, s.function, value.address, count)
        reply = self._talk.ask(request)
        if reply.exception:
            raise InstrumentError(
                "The room sensor refuses to read register {address}: {reason}.",
                address=value.address,
                reason=EXCEPTIONS.get(reply.exception, str(reply.exception)),
            )
        mine = s.protocol == "rtu" or reply.transaction == self._transaction
        if not mine or (reply.unit, reply.function, len(reply.registers)) != (s.unit, s.function, count):
            raise InstrumentError(
                "The room sensor's answer about register {address} does not belong to the question: "
                "check its unit number and that nobody else speaks on the line.",
                address=value.address,
            )
        return value_of(reply.registers, value.kind, value.words) * value.scale + value.offset


class TypedRoom:
    """A :class:`~ahrs_lab.instruments.interfaces.Room` whose values the operator reads off and types in."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._reading: RoomReading | None = None
        self._lock = threading.Lock()

    def open(self) -> str:
        """There is nothing to connect."""
        return self.identify()

    def identify(self) -> str:
        """Nobody answers."""
        return "typed in"

    def enter(self, temperature_c: float, humidity_percent: float) -> None:
        """The operator has read these now. Raises InputError for what no room can have."""
        reading = RoomReading(self._clock.now_s(), temperature_c, humidity_percent)
        try:
            _plausible(reading)
        except InstrumentError as error:
            raise InputError(error.message) from error
        with self._lock:
            self._reading = reading

    def read(self) -> RoomReading:
        """The values entered last, with the time of entering. Raises InstrumentError before the first."""
        with self._lock:
            if self._reading is None:
                raise InstrumentError("Temperature and humidity of the room have not been entered yet.")
            return self._reading

    def close(self) -> None:
        """Nothing to release."""


def _plausible(reading: RoomReading) -> RoomReading:
    if not _COLDEST_C <= reading.temperature_c <= _HOTTEST_C or not 0.0 <= reading.humidity_percent <= 100.0:
        raise InstrumentError(
            "The room would have {temperature} °C and {humidity} %: check the sensor, its registers and "
            "scales.",
            temperature=round(reading.temperature_c, 2),
            humidity=round(reading.humidity_percent, 2),
        )
    return reading
