"""The whole virtual bench on its wires: which instrument is served where, and how it is switched on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Literal, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.faulty import LinkFaults, faults_from_text
from ahrs_lab.instruments.settings import settings_from_toml, within
from ahrs_lab.recording.segment import AccelUnit
from ahrs_lab.simulation.faults import FAULT_NAMES
from ahrs_lab.simulation.servers.ahrs_service import AhrsService, Speech, UnitFaults
from ahrs_lab.simulation.servers.bench_services import AclTableService, FixtureService, ScpiRoom, ScpiSupply
from ahrs_lab.simulation.servers.microstrain_speech import MicroStrainSpeech
from ahrs_lab.simulation.servers.served_world import ServedClock, ServedWorld, in_units
from ahrs_lab.simulation.servers.serving import Server
from ahrs_lab.simulation.servers.vectornav_speech import VectorNavSpeech
from ahrs_lab.simulation.servers.xsens_speech import XsensSpeech
from ahrs_lab.simulation.settings import SimulationSettings, simulation_from_toml

AhrsProtocol = Literal["vectornav", "xsens", "microstrain"]
AHRS_PROTOCOLS: tuple[AhrsProtocol, ...] = get_args(AhrsProtocol)

_ACCEL_UNITS: Final[dict[AhrsProtocol, AccelUnit]] = {
    "vectornav": "m/s^2",
    "xsens": "m/s^2",
    "microstrain": "g",
}
_FAULT_KEYS: Final = ("counter_start", "time_start_s", "reboot_at_s", "baud", "seed")


@dataclass(frozen=True)
class ServeSettings:
    """The ``[serve]`` table of a bench file. Ports of 0 are free ones; with ``ahrs_on`` "tcp" or an
    ``ahrs_port`` the unit is served on TCP, like a serial server does."""

    ahrs: AhrsProtocol = "vectornav"
    ahrs_on: Literal["pty", "tcp"] = "pty"
    ahrs_port: int = 0
    table_port: int = 0
    supply_port: int = 0
    room_port: int = 0
    fixture_port: int = 0

    def __post_init__(self) -> None:
        for key in ("ahrs_port", "table_port", "supply_port", "room_port", "fixture_port"):
            within(f"serve.{key}", getattr(self, key), 0, 65535)


@dataclass(frozen=True)
class Place:
    """Where an instrument is: a serial device, or host and port; and which driver speaks to it."""

    driver: str
    device: str = ""
    host: str = ""
    port: int = 0

    @property
    def text(self) -> str:
        """As a person says it."""
        return self.device or f"{self.host}:{self.port}"


@dataclass
class ServedBench:
    """A running bench; :meth:`close` ends it."""

    settings: SimulationSettings
    served: ServedWorld
    server: Server
    ahrs: AhrsService
    table: AclTableService
    places: dict[str, Place] = field(default_factory=dict)

    @property
    def clock(self) -> ServedClock:
        """For a bench of drivers in the same process."""
        return ServedClock(self.served)

    def close(self) -> None:
        """End the serving thread and close all wires."""
        self.server.close()

    def __enter__(self) -> ServedBench:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def serve_bench(
    settings: SimulationSettings,
    serve: ServeSettings | None = None,
    *,
    faults: UnitFaults | None = None,
    speed: float = 1.0,
    stepped: bool = False,
) -> ServedBench:
    """Serve a virtual bench until closed. Raises MachineError where a port cannot be had."""
    serve = serve or ServeSettings()
    settings = in_units(settings, "rad/s", _ACCEL_UNITS[serve.ahrs])
    served = ServedWorld(settings, speed, stepped=stepped)
    server = Server(served)
    try:
        ahrs = AhrsService(served, _speech(serve.ahrs, settings), faults)
        table = AclTableService(served)
        bench = ServedBench(settings, served, server, ahrs, table)
        bench.places["ahrs"] = _serve_ahrs(server, ahrs, serve)
        for name, service, port, driver in (
            ("table", table, serve.table_port, "acutrol"),
            ("supply", ScpiSupply(served), serve.supply_port, "scpi"),
            ("room", ScpiRoom(served), serve.room_port, "scpi"),
            ("fixture", FixtureService(served), serve.fixture_port, "simulated-hands"),
        ):
            listener = server.on_tcp(service, port)
            bench.places[name] = Place(driver, host=listener.host, port=listener.port)
    except BaseException:
        server.close()
        raise
    server.start()
    return bench


def _serve_ahrs(server: Server, ahrs: AhrsService, serve: ServeSettings) -> Place:
    if serve.ahrs_on == "tcp" or serve.ahrs_port:
        listener = server.on_tcp(ahrs, serve.ahrs_port)
        return Place(serve.ahrs, host=listener.host, port=listener.port)
    return Place(serve.ahrs, device=server.on_pty(ahrs).path)


def _speech(protocol: AhrsProtocol, settings: SimulationSettings) -> Speech:
    device = settings.device
    makers: dict[AhrsProtocol, type[VectorNavSpeech] | type[XsensSpeech] | type[MicroStrainSpeech]] = {
        "vectornav": VectorNavSpeech,
        "xsens": XsensSpeech,
        "microstrain": MicroStrainSpeech,
    }
    return makers[protocol](device.sample_rate_hz, device.model, device.serial_number)


def bench_from_toml(data: Mapping[str, Any]) -> tuple[SimulationSettings, ServeSettings]:
    """A bench file of kind "simulated", with or without a ``[serve]`` table. Raises InputError."""
    kind = data.get("kind", "simulated")
    if kind != "simulated":
        raise InputError("Only benches of kind “simulated” can be served, not “{kind}”.", kind=kind)
    table = data.get("serve", {})
    if not isinstance(table, Mapping):
        raise InputError("Setting “{path}” has to be a table.", path="serve")
    rest = {key: value for key, value in data.items() if key not in ("kind", "serve")}
    return simulation_from_toml(rest), settings_from_toml(ServeSettings, table, "serve")


def unit_faults_from_text(text: str, settings: SimulationSettings) -> tuple[UnitFaults, SimulationSettings]:
    """From ``"lose=1e-5,merge_s=0.016,reboot_at_s=30,table_trips=100"``: faults of the line and the unit, and
    the bench's own faults with the bench time they begin at. Raises InputError."""
    from ahrs_lab.simulation.settings import FaultSettings

    line: list[str] = []
    unit: dict[str, Any] = {}
    own: list[FaultSettings] = []
    for part in filter(None, (piece.strip() for piece in text.split(","))):
        key, _, value = (word.strip() for word in part.partition("="))
        if key in _FAULT_KEYS:
            unit[key] = _number(key, value)
        elif key in FAULT_NAMES:
            own.append(FaultSettings(key, at_s=_number(key, value or "0")))
        else:
            line.append(part)
    for key in ("counter_start", "baud", "seed"):
        if key in unit:
            unit[key] = int(unit[key])
    link = faults_from_text(",".join(line)) if line else LinkFaults()
    return UnitFaults(link, **unit), replace(settings, fault=(*settings.fault, *own))


def _number(key: str, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise InputError("Fault “{key}” needs a number, not “{text}”.", key=key, text=text) from error
