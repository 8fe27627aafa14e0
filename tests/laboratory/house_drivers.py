"""The house's drivers, also in a checkout that was installed before they had entry points."""

from __future__ import annotations

from importlib.metadata import entry_points

from ahrs_lab.instruments.drivers import catalogue
from ahrs_lab.instruments.drivers.ahrs import entries
from ahrs_lab.instruments.registry import GROUP, Driver, Drivers, find_drivers


def house_drivers() -> Drivers:
    """Those that are installed, else those of the catalogues."""
    if entry_points(group=GROUP):
        return find_drivers()
    all_names = [*vars(catalogue).values(), *vars(entries).values()]
    return Drivers({(one.kind, one.name): one for one in all_names if isinstance(one, Driver)})
