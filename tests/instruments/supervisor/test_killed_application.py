"""The heart of the application stops while the table turns: the supervisor stops the table."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.instruments.supervisor.acl_world import AclWorld

SPINNER = Path(__file__).with_name("spinner.py")
STOPPED_WITHIN_S = 2.0

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs POSIX signals")


@contextmanager
def spinning(world: AclWorld, report: Path) -> Iterator[subprocess.Popen[str]]:
    """An application that spins the table."""
    process = subprocess.Popen(
        [sys.executable, str(SPINNER), str(world.port), str(report)], stdout=subprocess.PIPE, text=True
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
        _wait_for_end(supervisor)


def _wait_for_end(process_id: int) -> None:
    """The supervisor is nobody's child any more once its application is gone."""
    end = time.monotonic() + 10.0
    while process_id and time.monotonic() < end:
        try:
            state = Path(f"/proc/{process_id}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
        except OSError:
            return
        if state == "Z":
            return
        time.sleep(0.02)


def seconds_until(world: AclWorld, at_rest_dps: float = 0.1) -> float:
    """Until the served table is at rest; fails after ten."""
    begin = time.monotonic()
    while abs(world.table.state().rate_dps) > at_rest_dps:
        assert time.monotonic() - begin < 10.0, "the table still turns"
        time.sleep(0.005)
    return time.monotonic() - begin


def test_a_killed_application_leaves_a_table_that_is_stopped(tmp_path: Path) -> None:
    report = tmp_path / "supervisor.jsonl"
    with AclWorld() as world, spinning(world, report) as application:
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
    with AclWorld() as world, spinning(world, report) as application:
        os.kill(application.pid, signal.SIGSTOP)
        try:
            took = seconds_until(world)
            print(f"stopped {took:.3f} s after the application froze")
            assert took < STOPPED_WITHIN_S + 0.5
        finally:
            os.kill(application.pid, signal.SIGCONT)
