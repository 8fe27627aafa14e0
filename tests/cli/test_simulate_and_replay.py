"""The two commands of the wires, as a person calls them."""

from __future__ import annotations

import csv
import json
import os
import signal
import socket
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.cli import main
from ahrs_lab.cli.simulate import FIXED_PORTS
from ahrs_lab.instruments.drivers.ahrs.vectornav import VectorNavAhrs, VectorNavSettings
from ahrs_lab.instruments.links.link_settings import LinkSettings, make_link
from ahrs_lab.instruments.real_clock import RealClock
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.samples import Samples
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.servers.served_bench import serve_bench
from ahrs_lab.simulation.settings import SimulationSettings

CAPTURES = Path(os.environ.get("AHRS_LAB_CAPTURES", Path(__file__).parents[3] / "shared" / "captures"))
CAPTURE = CAPTURES / "vn100_F00294_mixed.bin"
captured = pytest.mark.skipif(not CAPTURE.exists(), reason="the captures are not here")


def replay(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, Any]:
    capsys.readouterr()
    assert main(["replay", *words, "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert isinstance(summary, dict)
    return summary


@captured
def test_the_capture_of_a_real_unit_gives_its_authors_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    summary = replay(capsys, str(CAPTURE), "--protocol", "vectornav")
    assert list(summary) == ["frames", "failed", "skipped_bytes", "samples", "first", "last"]
    assert (summary["frames"], summary["failed"], summary["samples"]) == (99, 0, 99)
    with (CAPTURE.parent / "vn100_F00294_expected.csv").open(encoding="utf-8") as file:
        rows = [{k.strip(): v for k, v in row.items() if k} for row in csv.DictReader(file)]
    for place, row in (("first", rows[0]), ("last", rows[-1])):
        for axis in "XYZ":
            ours = summary[place][f"gyro_{axis.lower()}"]
            assert ours == pytest.approx(float(row[f"Gyro{axis}"]), rel=1e-6)
        assert summary[place]["heading_deg"] == pytest.approx(float(row["Yaw"]), rel=1e-6)


@captured
def test_a_replay_becomes_a_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bundle = tmp_path / "bundle"
    replay(capsys, str(CAPTURE), "--protocol", "vectornav", "--rate", "10", "--out", str(bundle))
    (entry,) = read_bundle(bundle).segments
    assert len(entry.samples) == 99
    assert np.diff(entry.samples["t_s"]) == pytest.approx(0.1)


def test_raw_bytes_of_a_run_replay_to_the_samples_of_the_driver(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    blocks: list[Samples] = []
    with serve_bench(SimulationSettings.ideal()) as bench:
        bench.served.world.supply.set_output(12.0, 1.0)
        bench.served.world.supply.on()
        link = LinkSettings(device=bench.places["ahrs"].device, baud=921_600)
        clock = RealClock()
        ahrs = VectorNavAhrs(VectorNavSettings(link), make_link(link), clock)
        try:
            ahrs.configure()
            ahrs.keep_raw(tmp_path / "raw" / "ahrs.1")
            ahrs.start()
            while sum(len(block) for block in blocks) < 50:
                clock.wait(0.02)
                blocks.append(ahrs.read())
        finally:
            ahrs.close()
    seen = [block for block in blocks if len(block)]
    summary = replay(capsys, str(tmp_path / "raw" / "ahrs.1.bin"), "--protocol", "vectornav")
    assert summary["failed"] == 0
    assert summary["skipped_bytes"] < 44, "at most the frame that the end cut"
    assert summary["samples"] >= sum(len(block) for block in seen)
    for name, column in seen[0].columns.items():
        assert summary["first"][name] == column[0], name


def test_replay_of_nothing_sensible_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "raw.bin"
    path.write_bytes(b"nothing in here" * 20)
    assert replay(capsys, str(path), "--protocol", "xsens")["samples"] == 0
    assert main(["replay", str(path), "--protocol", "morse"]) == 2
    assert main(["replay", str(path), "--protocol", "xsens", "--out", str(tmp_path / "b")]) == 2
    assert main(["replay", str(tmp_path / "none"), "--protocol", "xsens"]) == 2


def test_simulate_says_where_everything_is_and_ends_on_request(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "ahrs_lab", "simulate", "--bench", str(resource_path("benches/demo.toml"))]
    words += ["--tcp", "--json", "--write-bench", str(tmp_path / "linked.toml")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        places = json.loads(process.stdout.readline())["instruments"]
        assert set(places) == {"ahrs", "table", "supply", "room", "fixture"}
        with socket.create_connection((places["table"]["host"], places["table"]["port"]), 5.0) as wire:
            wire.sendall(b"*IDN?\r\n")
            assert b"ACUTROL3000" in wire.recv(100)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=10.0)
        assert (process.returncode, out, err) == (0, "", "")
    linked = tomllib.loads((tmp_path / "linked.toml").read_text(encoding="utf-8"))
    assert linked["table"]["link"]["port"] == places["table"]["port"]


def test_the_preset_for_served_benches_names_the_fixed_ports() -> None:
    data = tomllib.loads(resource_path("benches/demo-linked.toml").read_text(encoding="utf-8"))
    ports = {name: data[name]["link"]["port"] for name in ("ahrs", "table")}
    ports |= {name: data[name]["connection"]["link"]["port"] for name in ("supply", "room")}
    assert ports | {"fixture": data["operator"]["port"]} == FIXED_PORTS


@pytest.mark.parametrize("faults", ["loose=1", "reboot_at_s=soon"])
def test_faults_that_are_none_are_refused(faults: str, capsys: pytest.CaptureFixture[str]) -> None:
    bench = str(resource_path("benches/demo.toml"))
    assert main(["simulate", "--bench", bench, "--faults", faults]) == 2
    assert capsys.readouterr().err.startswith("ahrs-lab: ")
