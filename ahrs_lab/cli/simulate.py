"""``ahrs-lab simulate``: the virtual bench on pseudo-terminals and TCP ports, until Ctrl-C."""

from __future__ import annotations

import argparse
import json
import sys
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

from ahrs_lab.cli.stop_signals import stop_signals
from ahrs_lab.errors import InputError, MachineError
from ahrs_lab.simulation.servers.served_bench import (
    ServedBench,
    ServeSettings,
    bench_from_toml,
    serve_bench,
    unit_faults_from_text,
)

_LOOK_S = 0.2
FIXED_PORTS = {"ahrs": 9880, "table": 9878, "supply": 5025, "room": 5026, "fixture": 9881}
"""Those of ``resources/benches/demo-linked.toml``."""


def run(arguments: argparse.Namespace) -> int:
    """Serve until the person or the system ends it."""
    bench = _served(arguments)
    with stop_signals(), bench:
        try:
            if arguments.write_bench is not None:
                _write(arguments.write_bench, bench)
            _tell(arguments, bench)
            _wait(bench)
        except KeyboardInterrupt:
            # The way this command ends.
            if not arguments.json:
                sys.stderr.write("\n")
    return 0


def _served(arguments: argparse.Namespace) -> ServedBench:
    import tomllib

    if not arguments.speed > 0.0:
        raise InputError("The bench's speed is {speed}; it has to be above 0.", speed=arguments.speed)
    try:
        data = tomllib.loads(arguments.bench.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(
            "The bench file {path} cannot be read ({reason}).",
            path=arguments.bench,
            reason=error.strerror or str(error),
        ) from error
    except ValueError as error:
        raise InputError(
            "{source} is not valid TOML: {reason}.", source=arguments.bench, reason=str(error)
        ) from error
    settings, serve = bench_from_toml(data)
    faults, settings = unit_faults_from_text(arguments.faults, settings)
    return serve_bench(settings, _with_options(serve, arguments), faults=faults, speed=arguments.speed)


def _with_options(serve: ServeSettings, arguments: argparse.Namespace) -> ServeSettings:
    if arguments.ahrs:
        serve = replace(serve, ahrs=arguments.ahrs)
    if arguments.fixed_ports:
        serve = _on_fixed_ports(serve)
    return replace(serve, ahrs_on="tcp") if arguments.tcp else serve


def _on_fixed_ports(serve: ServeSettings) -> ServeSettings:
    ports = FIXED_PORTS
    return replace(
        serve,
        ahrs_port=ports["ahrs"],
        table_port=ports["table"],
        supply_port=ports["supply"],
        room_port=ports["room"],
        fixture_port=ports["fixture"],
    )


def _write(path: Path, bench: ServedBench) -> None:
    import tomli_w

    from ahrs_lab.simulation.servers.linked_toml import linked_bench

    try:
        path.write_text(tomli_w.dumps(linked_bench(bench)), encoding="utf-8")
    except OSError as error:
        raise MachineError(
            "{path} cannot be written ({reason}): free space on the disk or choose another folder.",
            path=path,
            reason=error.strerror or str(error),
        ) from error


def _tell(arguments: argparse.Namespace, bench: ServedBench) -> None:
    if arguments.json:
        places: dict[str, Any] = {
            name: {key: value for key, value in vars(place).items() if value}
            for name, place in bench.places.items()
        }
        print(
            json.dumps({"speed": bench.served.speed, "instruments": places}, ensure_ascii=False), flush=True
        )
        return
    lines = [f"{name:8} {place.driver:16} {place.text}" for name, place in bench.places.items()]
    print("\n".join([*lines, "Ctrl-C ends."]), flush=True)


def _wait(bench: ServedBench) -> None:
    never = threading.Event()
    while not never.wait(_LOOK_S):
        if bench.server.failure is not None:
            raise MachineError("Serving the bench has failed: {reason}.", reason=repr(bench.server.failure))
