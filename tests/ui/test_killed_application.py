"""The real application is killed while a button on its screen turns the table: the supervisor stops it."""

from __future__ import annotations

import json
import os
import signal
import socket
import struct
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.laboratory.instrument_benches import InstrumentBenches
from tests.instruments.supervisor.process_end import wait_for_end
from tests.laboratory.house_drivers import house_drivers
from tests.ui.spinning_application import RATE_DPS

APPLICATION = Path(__file__).with_name("spinning_application.py")
STOPPED_WITHIN_S = 2.0
AT_REST_DPS = 0.1
PATIENCE_S = 60.0

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs POSIX signals")


@contextmanager
def served(bench: Path) -> Iterator[dict[str, Any]]:
    """The virtual bench in a process of its own: the places of its instruments; ``bench`` is written."""
    words = [sys.executable, "-m", "ahrs_lab", "simulate", "--bench", str(bench.with_name("virtual.toml"))]
    bench.with_name("virtual.toml").write_text("", encoding="utf-8")
    words += ["--tcp", "--json", "--write-bench", str(bench)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())["instruments"]
        finally:
            process.send_signal(signal.SIGINT)


class Onlooker:
    """Asks the served table by its own language, as a second client of its port."""

    def __init__(self, place: dict[str, Any]) -> None:
        self._socket = socket.create_connection((place["host"], place["port"]), timeout=10.0)

    def close(self) -> None:
        self._socket.close()

    def ask(self, request: bytes) -> str:
        self._socket.sendall(request + b"\r\n")
        error, length = struct.unpack("<ii", self._receive(8))
        assert error == 0, (request, error)
        return self._receive(length).decode("ascii").strip("\0 \r\n")

    def rate_dps(self) -> float:
        return float(self.ask(b":Read:Rate? 1"))

    def _receive(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            data += self._socket.recv(count - len(data))
        return data


@contextmanager
def spinning_application() -> Iterator[subprocess.Popen[str]]:
    """The application, once its screen shows that the table turns."""
    words = [sys.executable, str(APPLICATION)]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stderr is not None
    supervisor = 0
    try:
        told = process.stdout.readline().split()
        assert told[:1] == ["spinning"], process.stderr.read()
        supervisor = int(told[1])
        yield process
    finally:
        process.kill()
        process.wait()
        wait_for_end(supervisor)
        process.stdout.close()
        process.stderr.close()


@pytest.mark.slow
def test_a_killed_application_leaves_a_table_that_rests_within_two_seconds(
    tmp_path: Path, isolated_home: Path
) -> None:
    written = tmp_path / "bench.toml"
    with served(written) as places:
        bench = tomllib.loads(written.read_text(encoding="utf-8"))
        benches = InstrumentBenches(isolated_home / "benches", house_drivers())
        benches.save("Served", {key: value for key, value in bench.items() if key != "operator"})
        table = Onlooker(places["table"])
        try:
            with spinning_application() as application:
                assert table.rate_dps() == pytest.approx(RATE_DPS, rel=0.05)
                os.kill(application.pid, signal.SIGKILL)
                killed_s = time.monotonic()
                while abs(table.rate_dps()) > AT_REST_DPS:
                    assert time.monotonic() - killed_s < 10.0, "the table still turns"
                took_s = time.monotonic() - killed_s
            print(f"at rest {took_s:.3f} s after the kill")
            assert took_s < STOPPED_WITHIN_S
            told = reported(isolated_home / "supervisor.jsonl")
            assert told["problems"] == []
            assert table.ask(b":Interlock? 1") == "Open", "the drive is off"
        finally:
            table.close()


def reported(file: Path) -> dict[str, Any]:
    """What the supervisor wrote when it was done."""
    end = time.monotonic() + PATIENCE_S
    while not file.exists() and time.monotonic() < end:
        time.sleep(0.02)
    told: dict[str, Any] = json.loads(file.read_text(encoding="utf-8").splitlines()[-1])
    return told
