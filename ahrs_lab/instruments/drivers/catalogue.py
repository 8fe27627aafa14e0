"""The tables, supplies and rooms of the house, as the entry points name them."""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.instruments.drivers.rooms.sensors import (
    ModbusRoomSettings,
    ModbusSensor,
    PolledRoom,
    ScpiRoomSettings,
    ScpiSensor,
    TypedRoom,
)
from ahrs_lab.instruments.drivers.scpi_talk import DEFAULT_PORT as SCPI_PORT
from ahrs_lab.instruments.drivers.scpi_talk import ScpiConnection, ScpiTalk, make_talk
from ahrs_lab.instruments.drivers.supplies.scpi import ScpiSupply, ScpiSupplySettings
from ahrs_lab.instruments.drivers.tables.actidyn import ActidynSettings, ActidynTable
from ahrs_lab.instruments.drivers.tables.acutrol import AcutrolSettings, AcutrolTable
from ahrs_lab.instruments.drivers.tables.ascii_table import AsciiTable, AsciiTableSettings
from ahrs_lab.instruments.drivers.tables.atl import AtlSettings, AtlTable
from ahrs_lab.instruments.drivers.tables.felt_motion import ManualSettings
from ahrs_lab.instruments.drivers.tables.manual import ManualTable
from ahrs_lab.instruments.protocols import actidyn, acutrol, modbus
from ahrs_lab.instruments.registry import Driver, Surroundings
from ahrs_lab.messages import Message


def _acutrol(settings: AcutrolSettings, around: Surroundings) -> AcutrolTable:
    return AcutrolTable(settings, around.link(settings.link, default_port=acutrol.DEFAULT_PORT), around.clock)


def _atl(settings: AtlSettings, around: Surroundings) -> AtlTable:
    return AtlTable(settings, around.link(settings.link), around.clock)


def _actidyn(settings: ActidynSettings, around: Surroundings) -> ActidynTable:
    return ActidynTable(settings, around.link(settings.link, default_port=actidyn.DEFAULT_PORT), around.clock)


def _ascii(settings: AsciiTableSettings, around: Surroundings) -> AsciiTable:
    return AsciiTable(settings, around.link(settings.link), around.clock)


def _manual(settings: ManualSettings, around: Surroundings) -> ManualTable:
    return ManualTable(settings, around.clock)


def _talk(connection: ScpiConnection, around: Surroundings) -> ScpiTalk:
    if connection.link is None:
        return make_talk(connection)
    return make_talk(connection, around.link(connection.link, default_port=SCPI_PORT))


def _scpi_supply(settings: ScpiSupplySettings, around: Surroundings) -> ScpiSupply:
    return ScpiSupply(settings, _talk(settings.connection, around), around.clock)


def _scpi_room(settings: ScpiRoomSettings, around: Surroundings) -> PolledRoom:
    sensor = ScpiSensor(settings, _talk(settings.connection, around))
    return PolledRoom(sensor, around.clock, settings.period_s)


def _modbus_room(settings: ModbusRoomSettings, around: Surroundings) -> PolledRoom:
    link = around.link(settings.link, default_port=modbus.DEFAULT_PORT)
    return PolledRoom(ModbusSensor(settings, link), around.clock, settings.period_s)


@dataclass(frozen=True)
class TypedRoomSettings:
    """There is nothing to set."""


def _typed_room(_: TypedRoomSettings, around: Surroundings) -> TypedRoom:
    return TypedRoom(around.clock)


ACUTROL = Driver("table", "acutrol", Message("Acutronic ACUTROL 3000 (ACL)"), AcutrolSettings, _acutrol)
ATL = Driver(
    "table", "atl", Message("Ideal Aerosmith ATL (experimental)"), AtlSettings, _atl, experimental=True
)
ACTIDYN = Driver(
    "table", "actidyn", Message("Actidyn (experimental)"), ActidynSettings, _actidyn, experimental=True
)
ASCII = Driver("table", "ascii", Message("Table with an ASCII language"), AsciiTableSettings, _ascii)
MANUAL = Driver("table", "manual", Message("Table set by hand"), ManualSettings, _manual)
SCPI_SUPPLY = Driver("supply", "scpi", Message("DC supply (SCPI)"), ScpiSupplySettings, _scpi_supply)
SCPI_ROOM = Driver("room", "scpi", Message("Room sensor (SCPI)"), ScpiRoomSettings, _scpi_room)
MODBUS_ROOM = Driver("room", "modbus", Message("Room sensor (Modbus)"), ModbusRoomSettings, _modbus_room)
TYPED_ROOM = Driver("room", "typed", Message("Room values typed in"), TypedRoomSettings, _typed_room)
