"""The demonstration's bench served on real wires, and a bench of drivers on it, in one process: time goes on
as fast as both sides can follow, so that a loaded computer changes nothing."""

from __future__ import annotations

import threading
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.laboratory.linked_benches import LinkedBench, linked_bench
from ahrs_lab.simulation.servers.linked_toml import linked_bench as linked_toml
from ahrs_lab.simulation.servers.served_bench import (
    AhrsProtocol,
    ServedBench,
    bench_from_toml,
    serve_bench,
    unit_faults_from_text,
)
from tests.laboratory.short_run import write_bench

_SPEED = 20.0
_LOOK_S = 2e-4
_DELIVERY_S = 0.2
_STEP_S = 0.06
"""Bench time between two looks at the table."""


def steady_bench(folder: Path) -> str:
    """The demonstration's bench without what changes with time: the runs that are compared do not last
    equally long."""
    text = write_bench(folder, old="self_heating_c = 6.0", new="self_heating_c = 0.0").read_text(
        encoding="utf-8"
    )
    text = text.replace("mount_time_s = 60.0", "mount_time_s = 0.0")
    noise = "bias_instability_deg_per_h = 0.0\nrate_random_walk_deg_per_h_per_sqrt_h = 0.0\n"
    return f"{text}\n[sensor.gyro_noise]\n{noise}"


@contextmanager
def served(
    text: str,
    ahrs: AhrsProtocol = "vectornav",
    faults: str = "",
    *,
    boot_time_s: float = 5.0,
    link: Callable[[Link], Link] = lambda link: link,
) -> Iterator[tuple[ServedBench, LinkedBench]]:
    """``faults`` as for ``ahrs-lab simulate``; ``link`` wraps the wire of the AHRS on the driver's side."""
    settings, serve = bench_from_toml(tomllib.loads(text))
    unit, settings = unit_faults_from_text(faults, settings)
    with serve_bench(settings, replace(serve, ahrs=ahrs), faults=unit, speed=_SPEED, stepped=True) as bench:
        yield from _linked(bench, link, boot_time_s)


def _linked(
    bench: ServedBench, wrap: Callable[[Link], Link], boot_time_s: float
) -> Iterator[tuple[ServedBench, LinkedBench]]:
    def make(settings: LinkSettings, *, default_port: int = 0) -> Link:
        made = make_link(settings, default_port=default_port)
        return wrap(made) if settings.device else made

    data = linked_toml(bench)
    data["ahrs"]["boot_time_s"] = boot_time_s
    linked = linked_bench(data, "served", link=make, clock=bench.clock)
    end = threading.Event()
    pacer = threading.Thread(target=_pace, args=(bench, linked, end), name="pacer", daemon=True)
    pacer.start()
    try:
        yield bench, linked
    finally:
        end.set()
        pacer.join()
        linked.close()


class _Delivery:
    """Whether the unit's bytes have reached the driver. What the system drops when a port is opened is not
    known, so the least difference since then counts as nothing under way; after a while, any."""

    def __init__(self, bench: ServedBench, ahrs: Any) -> None:
        self._unit = bench.ahrs
        self._served = bench.served
        self._reader = ahrs._reader
        self._connections = 0
        self._least = 0
        self._since = time.monotonic()

    def complete(self) -> bool:
        if self._unit.ticked_s < self._served.now_s:
            return False
        under_way = self._unit.sent_bytes - self._reader.received_bytes
        now = time.monotonic()
        opened = self._reader.connections != self._connections or self._reader.lost is not None
        if under_way <= self._least or opened or not self._connections or now - self._since > _DELIVERY_S:
            self._connections = self._reader.connections
            self._least, self._since = under_way, now
            return True
        return False


def _pace(bench: ServedBench, linked: LinkedBench, end: threading.Event) -> None:
    """Time goes on while the run waits for it and the unit's bytes have arrived; the table is looked at after
    each step, and no step falls between a question and its answer."""
    delivery, table = _Delivery(bench, linked.ahrs), cast(Any, linked.table)
    while not end.is_set():
        if not (bench.served.waiting and delivery.complete()):
            end.wait(_LOOK_S)
            continue
        with table._talk:
            bench.served.step(_STEP_S)
        table.poll()
