"""Benches of real instruments, from a file of kind "instruments"::

    kind = "instruments"
    north_deg = 0.0
    [site]
    latitude_deg = 39.9
    [table]
    driver = "acutrol"
    limits = { max_rate_dps = 400.0, max_acceleration_dps2 = 200.0 }
    link = { host = "192.168.0.10", port = 9878 }
    [ahrs]
    driver = "vectornav"
    rate_hz = 100.0
    link = { device = "/dev/ttyUSB0", baud = 921600 }
    [supply]
    driver = "scpi"
    connection = { link = { host = "192.168.0.11", port = 5025 } }
    [room]
    driver = "typed"
    [operator]
    kind = "terminal"

Table, supply and room are connected at once; the AHRS when it first has to stream, because it gets its power
from the supply. ``kind = "simulated-hands"`` (with ``host`` and ``port``) is for the bench that ``ahrs-lab
simulate`` serves: its fixture moves by itself, and what is measured there counts as simulated.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

from ahrs_lab.errors import AhrsLabError, InputError
from ahrs_lab.instruments.interfaces import Ahrs, Bench, Clock, Operator
from ahrs_lab.instruments.links.link_settings import make_link
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.registry import Drivers, Kind, LinkMaker, Surroundings, create_instrument
from ahrs_lab.instruments.settings import settings_from_toml, within
from ahrs_lab.laboratory.bench_speed import bench_speed, check_said_speed
from ahrs_lab.laboratory.hands import SimulatedHands, TerminalOperator
from ahrs_lab.recording.segment import Site

_TABLES: Final = ("site", "table", "ahrs", "supply", "room", "operator")


@dataclass(frozen=True)
class SiteSettings:
    """Where the bench stands."""

    latitude_deg: float
    longitude_deg: float | None = None
    altitude_m: float = 0.0

    def __post_init__(self) -> None:
        within("site.latitude_deg", self.latitude_deg, -90.0, 90.0)
        within("site.altitude_m", self.altitude_m, -500.0, 9000.0)


@dataclass(frozen=True)
class OperatorSettings:
    """Who mounts the case."""

    kind: Literal["terminal", "simulated-hands"] = "terminal"
    host: str = "127.0.0.1"
    port: int = 0


@dataclass(frozen=True)
class LinkedBench(Bench):
    """A bench of drivers. ``keep_raw`` (a folder, or None to end it) keeps what arrives from the AHRS."""

    keep_raw: Callable[[Path | None], None] = field(default=lambda _: None)


def linked_bench(
    data: Mapping[str, Any],
    source: str,
    *,
    speed: float | None = None,
    drivers: Drivers | None = None,
    link: LinkMaker = make_link,
    clock: Clock | None = None,
) -> LinkedBench:
    """Connect the instruments of a bench file; raises InputError for its settings, InstrumentError where one
    does not answer. ``speed`` other than 1 is refused unless table and supply say that they are simulated and
    run at that speed; a ``clock`` that is given is another matter."""
    unknown = [key for key in data if key not in (*_TABLES, "kind", "north_deg", "speed")]
    if unknown:
        raise InputError(
            "{source}: “{key}” is not a setting of a bench of instruments.", source=source, key=unknown[0]
        )
    site = settings_from_toml(SiteSettings, _table(data, "site", source), "site")
    operator_settings = settings_from_toml(OperatorSettings, data.get("operator", {}), "operator")
    simulated = operator_settings.kind == "simulated-hands"
    checked_speed = None if clock is not None else bench_speed(data, speed, source)
    clock = clock or RealClock(checked_speed or 1.0)
    operator: Operator = TerminalOperator()
    if simulated:
        operator = SimulatedHands(operator_settings.host, operator_settings.port)
    opened: list[Any] = []
    try:
        around = Surroundings(clock, link)
        ahrs = _create("ahrs", data, source, around, drivers)
        opened.append(ahrs)
        made: dict[str, Any] = {}
        kinds: tuple[Kind, ...] = ("supply", "room", "table")
        for kind in kinds:
            made[kind] = _create(kind, data, source, around, drivers)
            opened.append(made[kind])
            if hasattr(made[kind], "open"):
                made[kind].open()
            if checked_speed is not None and kind != "room":
                check_said_speed(checked_speed, kind, str(made[kind].identify()), source)
    except BaseException:
        _close(opened)
        raise
    return LinkedBench(
        clock=clock,
        table=made["table"],
        ahrs=ahrs,
        supply=made["supply"],
        room=made["room"],
        operator=operator,
        site=Site(site.latitude_deg, site.altitude_m, site.longitude_deg),
        north_deg=_number(data, "north_deg", 0.0, source),
        simulated=simulated,
        close=lambda: _close(opened),
        keep_raw=lambda folder: _keep_raw(ahrs, folder),
    )


def _create(
    kind: Kind, data: Mapping[str, Any], source: str, around: Surroundings, drivers: Drivers | None
) -> Any:
    return create_instrument(kind, _table(data, kind, source), around, drivers)


def _table(data: Mapping[str, Any], key: str, source: str) -> Mapping[str, Any]:
    table = data.get(key)
    if not isinstance(table, Mapping):
        raise InputError("{source}: a bench of instruments needs a table [{key}].", source=source, key=key)
    return table


def _number(data: Mapping[str, Any], key: str, default: float, source: str) -> float:
    value = data.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < 1e6:
        raise InputError("{source}: “{key}” has to be a number.", source=source, key=key)
    return float(value)


def _close(opened: list[Any]) -> None:
    """Everything that was opened, the table first; what fails does not keep the others open."""
    failures: list[AhrsLabError] = []
    while opened:
        try:
            opened.pop().close()
        except AhrsLabError as error:
            failures.append(error)
    if failures:
        raise failures[0]


def _keep_raw(ahrs: Ahrs, folder: Path | None) -> None:
    """Raw bytes of each start of a run in a file of its own."""
    keep = getattr(ahrs, "keep_raw", None)
    if keep is None:
        return
    if folder is None:
        keep(None)
        return
    number = 1
    while (folder / f"ahrs.{number}.bin").exists():
        number += 1
    keep(folder / f"ahrs.{number}")
