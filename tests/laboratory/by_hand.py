"""A virtual bench whose table has no wire, with a test as the hand that turns it."""

from __future__ import annotations

from dataclasses import replace

from ahrs_lab.instruments.by_hand import HandRequest
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.simulation.bench import table_without_wire, world_of
from ahrs_lab.simulation.table import SimulatedTable


def bench_without_wire(text: str, speed: float | None) -> tuple[Bench, SimulatedTable]:
    """The bench, and the table behind it that only a hand can turn, switched on."""
    bench = bench_from_text(text, "bench.toml", speed=speed)
    table = world_of(bench).table
    table.enable()
    return replace(bench, table=table_without_wire(bench)), table


def obey(table: SimulatedTable, request: HandRequest) -> None:
    """Begin to do what is asked."""
    if request.kind == "rate":
        table.set_rate(request.rate_dps)
    elif request.kind == "turns":
        table.move_to(table.state().angle_deg + request.travel_deg, request.rate_dps)
    elif request.kind == "angle":
        angle = table.state().angle_deg
        table.move_to(angle + (request.angle_deg - angle + 180.0) % 360.0 - 180.0, 60.0)
    else:
        table.stop()
