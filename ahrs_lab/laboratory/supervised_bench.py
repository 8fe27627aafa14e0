"""A bench of real instruments for a run: its table on the supervisor's wire and held to its limits.

The supervisor is taken leave of when the bench is closed; until then a run whose process dies leaves it to
stop the table and to switch the supply off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.by_hand import SetByHand
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.motion_limits import LimitedTable
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.registry import Drivers, Kind, Surroundings, create_instrument, find_drivers
from ahrs_lab.instruments.settings import settings_from_toml
from ahrs_lab.instruments.supervisor.client import Supervisor
from ahrs_lab.instruments.supervisor.making import table_wire
from ahrs_lab.laboratory.bench_speed import bench_speed
from ahrs_lab.laboratory.linked_benches import LinkedBench, SiteSettings, linked_bench
from ahrs_lab.messages import Message
from ahrs_lab.recording.segment import DeviceDescription, Site


def supervised_bench(
    data: Mapping[str, Any],
    source: str,
    *,
    speed: float | None = None,
    drivers: Drivers | None = None,
    report: Path | None = None,
) -> LinkedBench:
    """See :func:`~ahrs_lab.laboratory.linked_benches.linked_bench`; ``report``: where the supervisor writes
    that it had to stop the bench."""
    table = data.get("table")
    if not isinstance(table, Mapping):
        raise InputError(
            "{source}: a bench of instruments needs a table [{key}].", source=source, key="table"
        )
    if table_wire(table, RealClock(), drivers) is None:
        return _limited(linked_bench(data, source, speed=speed, drivers=drivers), table)
    known = bench_speed(data, speed, source)
    supervisor = Supervisor(table, data.get("supply"), speed=known, report=report)
    supervisor.start()
    try:
        bench = _limited(_through(supervisor, data, source, speed, drivers), table)
    except BaseException:
        supervisor.close()
        raise

    def close() -> None:
        try:
            bench.close()
        finally:
            supervisor.close()

    return replace(bench, close=close)


def _through(
    supervisor: Supervisor,
    data: Mapping[str, Any],
    source: str,
    speed: float | None,
    drivers: Drivers | None,
) -> LinkedBench:
    own = settings_from_toml(LinkSettings, data["table"].get("link", {}), "table.link")

    def link(settings: LinkSettings, *, default_port: int = 0) -> Link:
        make = supervisor.table_links if settings == own else make_link
        return make(settings, default_port=default_port)

    return linked_bench(data, source, speed=speed, drivers=drivers, link=link)


def _limited(bench: LinkedBench, table: Mapping[str, Any]) -> LinkedBench:
    """The driver refuses what is beyond its settings; here the table is stopped that does more all the
    same, unless only a person can stop it."""
    if isinstance(bench.table, SetByHand):
        return bench
    given = table.get("limits", {})
    limits = bench.table.limits
    soft = SoftLimits(
        limits.max_rate_dps,
        limits.max_acceleration_dps2,
        float(given.get("min_angle_deg", "-inf")),
        float(given.get("max_angle_deg", "inf")),
    )
    return replace(bench, table=LimitedTable(bench.table, soft))


@dataclass(frozen=True)
class DescribedBench:
    """What a bench file of instruments says of itself, nothing being connected."""

    names: dict[Kind, Message]
    limits: TableLimits
    device: DeviceDescription
    site: Site
    north_deg: float
    simulated: bool


def described_bench(data: Mapping[str, Any], source: str, drivers: Drivers | None = None) -> DescribedBench:
    """Read the settings without opening any wire. Raises InputError."""
    found = find_drivers() if drivers is None else drivers
    around = Surroundings(RealClock())
    names: dict[Kind, Message] = {}
    made: dict[Kind, Any] = {}
    for part in _PARTS:
        table = data.get(part)
        if not isinstance(table, Mapping):
            raise InputError(
                "{source}: a bench of instruments needs a table [{key}].", source=source, key=part
            )
        made[part] = create_instrument(part, table, around, found)
        names[part] = found.get(part, str(table["driver"])).title
    site = settings_from_toml(SiteSettings, data.get("site", {}), "site")
    return DescribedBench(
        names,
        made["table"].limits,
        made["ahrs"].description,
        Site(site.latitude_deg, site.altitude_m, site.longitude_deg),
        float(data.get("north_deg", 0.0)),
        data.get("operator", {}).get("kind") == "simulated-hands",
    )


_PARTS: tuple[Kind, ...] = ("table", "ahrs", "supply", "room")
