"""The virtual bench as procedures see it, and the ways behind it for tests and demonstrations."""

from __future__ import annotations

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.segment import Site
from ahrs_lab.simulation.clock import SimulatedClock
from ahrs_lab.simulation.settings import SimulationSettings
from ahrs_lab.simulation.world import World


def build_bench(settings: SimulationSettings | None = None, *, speed: float | None = None) -> Bench:
    """A bench in a new virtual world. ``speed``: bench seconds per wall second; None: as fast as can be."""
    world = World(settings or SimulationSettings(), speed)
    site = world.settings.site
    return Bench(
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


def world_of(bench: Bench) -> World:
    """The world behind a bench of :func:`build_bench`: its faults, its speed, and ``place`` for a person at a
    screen who stands in for the operator."""
    if isinstance(bench.clock, SimulatedClock) and isinstance(bench.clock.world, World):
        return bench.clock.world
    raise TypeError("this bench is not simulated")
