"""The virtual bench as procedures see it, and the ways behind it for tests and demonstrations."""

from __future__ import annotations

from dataclasses import replace

from ahrs_lab.instruments.drivers.tables.felt_motion import ManualSettings
from ahrs_lab.instruments.drivers.tables.manual import ManualTable
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.segment import Site
from ahrs_lab.simulation.clock import SimulatedClock
from ahrs_lab.simulation.setter import SimulatedSetter
from ahrs_lab.simulation.settings import SimulationSettings
from ahrs_lab.simulation.world import World


def build_bench(settings: SimulationSettings | None = None, *, speed: float | None = None) -> Bench:
    """A bench in a new virtual world. ``speed``: bench seconds per wall second; None: as fast as can be."""
    world = World(settings or SimulationSettings(), speed)
    site = world.settings.site
    bench = Bench(
        clock=world.clock,
        table=world.table,
        ahrs=world.ahrs,
        supply=world.supply,
        room=world.room,
        operator=world.operator,
        site=Site(site.latitude_deg, site.altitude_m, site.longitude_deg),
        north_deg=world.settings.table.north_deg,
        simulated=True,
    )
    if not world.settings.operator.sets_table:
        return bench
    hands = SimulatedSetter(world.operator, world.table, world.clock, world.faults)
    return replace(bench, table=table_without_wire(bench), operator=hands)


def table_without_wire(bench: Bench) -> ManualTable:
    """A table that nobody but a person can set, in front of the bench's own."""
    limits = bench.table.limits
    soft = SoftLimits(limits.max_rate_dps, limits.max_acceleration_dps2)
    return ManualTable(ManualSettings(soft, f"{bench.table.identify()}, set by hand"), bench.clock)


def world_of(bench: Bench) -> World:
    """The world behind a bench of :func:`build_bench`: its faults, its speed, and ``place`` for a person at a
    screen who stands in for the operator."""
    if isinstance(bench.clock, SimulatedClock) and isinstance(bench.clock.world, World):
        return bench.clock.world
    raise TypeError("this bench is not simulated")
