"""The heart of the application stops while the table turns: the supervisor stops the table."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.instruments.registry import Surroundings, create_instrument
from ahrs_lab.instruments.supervisor.client import Supervisor
from ahrs_lab.instruments.supervisor.heart import Heart
from ahrs_lab.simulation.servers.linked_toml import linked_bench
from ahrs_lab.simulation.servers.served_bench import ServeSettings, serve_bench
from ahrs_lab.simulation.settings import simulation_from_toml
from tests.instruments.supervisor.acl_world import AclWorld
from tests.instruments.supervisor.process_end import wait_for_end

SPINNER = Path(__file__).with_name("spinner.py")
STOPPED_WITHIN_S = 2.0

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs POSIX signals")


@contextmanager
def spinning(bench: dict[str, Any], report: Path) -> Iterator[subprocess.Popen[str]]:
    """An application that spins the table."""
    process = subprocess.Popen(
        [sys.executable, str(SPINNER), json.dumps(bench), str(report)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    supervisor = 0
    try:
        words = process.stdout.readline().split()
        assert words[:1] == ["spinning"], words
        supervisor = int(words[1])
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        wait_for_end(supervisor)


def table_of(world: AclWorld) -> dict[str, Any]:
    """A bench of the served table alone."""
    return {
        "table": {
            "driver": "acutrol",
            "link": {"host": "127.0.0.1", "port": world.port},
            "limits": {"max_rate_dps": 300.0, "max_acceleration_dps2": 400.0},
        }
    }


def seconds_until(world: AclWorld, at_rest_dps: float = 0.1) -> float:
    """Until the served table is at rest; fails after ten."""
    begin = time.monotonic()
    while abs(world.table.state().rate_dps) > at_rest_dps:
        assert time.monotonic() - begin < 10.0, "the table still turns"
        time.sleep(0.005)
    return time.monotonic() - begin


def test_a_killed_application_leaves_a_table_that_is_stopped(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with AclWorld() as world, spinning(table_of(world), report) as application:
        assert world.table.state().rate_dps == pytest.approx(100.0, abs=1.0)
        before = len(world.said)
        os.kill(application.pid, signal.SIGKILL)
        took = seconds_until(world)
        print(f"stopped {took:.3f} s after the kill")
        assert took < STOPPED_WITHIN_S
        end = time.monotonic() + 10.0
        while not report.exists() and time.monotonic() < end:
            time.sleep(0.02)
        last = [text for _, text in world.said[before:] if "100" not in text]
        # Rate to zero, mode off, servo off: in this order.
        order = [last.index(text) for text in (":Demand:Rate 1,0", ":Mode:Off 1", ":Interlock:Open 1")]
        assert order == sorted(order)
        assert world.clients == 1  # the table never saw another client
    told = json.loads(report.read_text(encoding="utf-8").splitlines()[-1])
    assert told["problems"] == []


def test_an_application_that_hangs_is_as_good_as_dead(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with AclWorld() as world, spinning(table_of(world), report) as application:
        os.kill(application.pid, signal.SIGSTOP)
        try:
            took = seconds_until(world)
            print(f"stopped {took:.3f} s after the application froze")
            assert took < STOPPED_WITHIN_S + 0.5
        finally:
            os.kill(application.pid, signal.SIGCONT)


def test_the_supply_goes_off_once_the_table_rests(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp")) as served:
        world = served.served.world
        world.supply.set_output(12.0, 1.0)
        world.supply.on()
        toml = linked_bench(served)
        supply = toml["supply"]
        if "link" in supply:
            supply = {"driver": "scpi", "connection": {"link": supply["link"]}}
        with spinning({"table": toml["table"], "supply": supply}, report) as application:
            os.kill(application.pid, signal.SIGKILL)
            begin, rate = time.monotonic(), 100.0
            while world.supply.read().output_on:
                rate = abs(world.table.state().rate_dps)
                assert time.monotonic() - begin < 10.0, "the supply is still on"
                time.sleep(0.005)
            assert rate < 0.2  # so it was while the supply was last seen on
            end = time.monotonic() + 10.0
            while not report.exists() and time.monotonic() < end:
                time.sleep(0.02)
    told = json.loads(report.read_text(encoding="utf-8").splitlines()[-1])
    assert told["problems"] == []


def test_an_application_that_takes_leave_finds_the_bench_as_it_left_it(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with AclWorld() as world:
        supervisor = Supervisor(table_of(world)["table"], report=report)
        supervisor.start()
        table = create_instrument(
            "table", table_of(world)["table"], Surroundings(RealClock(), supervisor.table_links)
        )
        table.open()
        table.enable()
        table.set_rate(5.0)
        end = time.monotonic() + 10.0
        while world.table.state().rate_dps < 4.9 and time.monotonic() < end:
            time.sleep(0.01)
        supervisor.close()
        assert world.table.state().rate_dps == pytest.approx(5.0, abs=0.1)  # nobody stopped it
        assert supervisor.stopped is None
        table.close()
    assert not report.exists()


def test_a_table_that_is_not_there_is_told_at_the_start() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    supervisor = Supervisor({"driver": "acutrol", "link": {"host": "127.0.0.1", "port": port}})
    with pytest.raises(InstrumentError, match=str(port)):
        supervisor.start()
    assert not supervisor.running


def test_a_heart_stands_still_with_any_of_its_parts() -> None:
    beats: list[float] = []
    now = [0.0]
    heart = Heart(lambda: beats.append(now[0]), lambda: now[0])
    pulse = heart.needs("screen", 1.0)
    now[0] = 1.5
    heart.start()
    time.sleep(0.05)
    assert beats == []
    pulse.beat()
    end = time.monotonic() + 5.0
    while not beats and time.monotonic() < end:
        time.sleep(0.01)
    heart.stop()
    assert beats
