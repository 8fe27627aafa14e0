"""Words of the instruments' page."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from ahrs_lab.instruments.registry import Kind
from ahrs_lab.laboratory.instrument_station import StationState
from ahrs_lab.ui.widgets import State

ICONS: dict[Kind, str] = {"table": "bench", "ahrs": "device", "supply": "supply", "room": "thermometer"}


def part_names() -> dict[Kind, str]:
    """The four instruments of a bench."""
    translate = QCoreApplication.translate
    return {
        "table": translate("InstrumentWords", "Rate table"),
        "ahrs": translate("InstrumentWords", "AHRS"),
        "supply": translate("InstrumentWords", "Power supply"),
        "room": translate("InstrumentWords", "Room sensor"),
    }


def state_words() -> dict[StationState, tuple[State, str]]:
    """How far the connection is."""
    translate = QCoreApplication.translate
    return {
        "off": ("unknown", translate("InstrumentWords", "not connected")),
        "connecting": ("unknown", translate("InstrumentWords", "connecting …")),
        "ready": ("good", translate("InstrumentWords", "connected")),
        "lost": ("bad", translate("InstrumentWords", "link lost")),
        "failed": ("bad", translate("InstrumentWords", "fault")),
    }


def setting_names() -> dict[str, str]:
    """What the settings that every bench needs are called; the others keep the names they have in the
    file."""
    translate = QCoreApplication.translate
    return {
        "link.device": translate("InstrumentWords", "Serial port"),
        "link.baud": translate("InstrumentWords", "Baud rate"),
        "link.host": translate("InstrumentWords", "Network address"),
        "link.port": translate("InstrumentWords", "TCP port"),
        "limits.max_rate_dps": translate("InstrumentWords", "Highest rate, °/s"),
        "limits.max_acceleration_dps2": translate("InstrumentWords", "Highest acceleration, °/s²"),
        "limits.min_angle_deg": translate("InstrumentWords", "Smallest angle, °"),
        "limits.max_angle_deg": translate("InstrumentWords", "Largest angle, °"),
        "rate_hz": translate("InstrumentWords", "Samples per second"),
        "range_dps": translate("InstrumentWords", "Range of the device, °/s"),
        "manufacturer": translate("InstrumentWords", "Manufacturer"),
        "model": translate("InstrumentWords", "Model"),
        "serial_number": translate("InstrumentWords", "Serial number"),
        "name": translate("InstrumentWords", "Name"),
        "axis": translate("InstrumentWords", "Axis number"),
        "max_voltage_v": translate("InstrumentWords", "Highest voltage, V"),
        "max_current_a": translate("InstrumentWords", "Highest current, A"),
        "period_s": translate("InstrumentWords", "Read every, s"),
    }


def setting_name(path: str) -> str:
    """Of a setting by its dotted path; a link inside a connection is called like a link."""
    names = setting_names()
    return names.get(path) or names.get(path.removeprefix("connection.")) or path


def count_names() -> dict[str, str]:
    """What a driver counts."""
    translate = QCoreApplication.translate
    return {
        "frames": translate("InstrumentWords", "Frames"),
        "lost": translate("InstrumentWords", "Lost"),
        "failed": translate("InstrumentWords", "Checksum wrong"),
        "skipped_bytes": translate("InstrumentWords", "Bytes skipped"),
        "repeated": translate("InstrumentWords", "Repeated"),
        "implausible": translate("InstrumentWords", "Implausible"),
        "reconnections": translate("InstrumentWords", "Reconnected"),
    }


def command_names() -> dict[str, str]:
    """The commands of an ASCII table's language."""
    translate = QCoreApplication.translate
    return {
        "connect": translate("InstrumentWords", "Connect"),
        "identify": translate("InstrumentWords", "Identify"),
        "query": translate("InstrumentWords", "Query"),
        "enable": translate("InstrumentWords", "Drive on"),
        "rate": translate("InstrumentWords", "Turn at a rate"),
        "position": translate("InstrumentWords", "Go to an angle"),
        "stop": translate("InstrumentWords", "Stop"),
        "off": translate("InstrumentWords", "Drive off"),
        "keep_alive": translate("InstrumentWords", "Keep alive"),
    }
