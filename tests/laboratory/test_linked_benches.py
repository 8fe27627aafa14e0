"""A calibration through the wires gives what the bench in process gives; on a bad wire it gives that with
warnings, or it stops safely."""

from __future__ import annotations

import math
import re
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.errors import AhrsLabError, InputError, InstrumentError
from ahrs_lab.instruments.links.faulty import FaultyLink, LinkFaults
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.linked_benches import LinkedBench, linked_bench
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.simulation.servers.served_bench import ServedBench
from tests.laboratory.served import served, steady_bench
from tests.laboratory.short_run import values, write_plan

PER_RADIAN = 180.0 / math.pi


def calibrate(folder: Path, bench: Any, *, longer: bool = False) -> dict[str, Any]:
    """``longer``: recordings that can spare some samples of the twenty seconds that the standard asks for."""
    path = write_plan(folder)
    if longer:
        text = path.read_text(encoding="utf-8").replace("static_s = 20.0", "static_s = 21.0\ndwell_s = 21.0")
        path.write_text(text.replace("duration_s = 20.0", "duration_s = 21.0"), encoding="utf-8")
    return to_json(run_plan(load_plan(path), bench, folder / "out", on_event=lambda event: None).result)


def assert_same(result: dict[str, Any], reference: dict[str, Any]) -> None:
    """K, B and L within the noise of twenty seconds; K of a unit in rad/s counts per rad/s."""
    ours, theirs = values(result), values(reference)
    assert ours.keys() == theirs.keys()
    assert len(ours) == 4
    for name, (value, expanded) in theirs.items():
        scale = PER_RADIAN if name.startswith("K") else 1.0
        assert abs(scale * ours[name][0] - value) < 1.5 * expanded, name


def assert_safe(bench: ServedBench) -> None:
    """As it is in the world behind the wires."""
    assert not bench.served.world.table.turning()
    assert not bench.served.world.supply.read().output_on


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("in-process")
    return calibrate(folder, bench_from_text(steady_bench(folder), "bench"))


@pytest.mark.slow
@pytest.mark.parametrize("protocol", ["vectornav", "xsens", "microstrain"])
def test_through_the_wires_as_in_process(protocol: Any, tmp_path: Path, reference: dict[str, Any]) -> None:
    with served(steady_bench(tmp_path), protocol) as (bench, linked):
        result = calibrate(tmp_path, linked)
        assert_safe(bench)
        assert linked.simulated, "what is measured on a served bench may never become a certificate"
    assert_same(result, reference)
    assert result["warnings"] == []
    raw = tmp_path / "out" / "recording" / "raw" / "ahrs.1.bin"
    assert raw.stat().st_size > 100_000, "the raw bytes are kept with the record"


@pytest.mark.slow
def test_a_bad_wire_costs_samples_and_the_result_says_so(tmp_path: Path, reference: dict[str, Any]) -> None:
    text = steady_bench(tmp_path)
    faults = "lose=2e-6,flip=1e-5,double=2e-6,counter_start=65000,time_start_s=429490.0"
    with served(text, "xsens", faults) as (bench, linked):
        result = calibrate(tmp_path, linked, longer=True)
        assert_safe(bench)
    assert_same(result, reference)
    said = " ".join(warning["what"] for warning in result["warnings"])
    assert "On the wire to the device:" in said
    assert "damaged frames" in said
    assert re.search("samples? (is|are) missing", said)


def streaming(bench: ServedBench, linked: LinkedBench) -> None:
    linked.supply.set_output(12.0, 1.0)
    linked.supply.on()
    linked.clock.wait(2.0)
    linked.ahrs.start()


def read_for(linked: LinkedBench, seconds: float) -> int:
    count = 0
    end = linked.clock.now_s() + seconds
    while linked.clock.now_s() < end:
        linked.clock.wait(0.05)
        count += len(linked.ahrs.read())
    return count


@pytest.mark.parametrize("protocol", ["vectornav", "xsens", "microstrain"])
def test_a_device_that_restarts_in_the_stream_is_never_recorded_on(protocol: Any, tmp_path: Path) -> None:
    with served(steady_bench(tmp_path), protocol) as (bench, linked):
        streaming(bench, linked)
        read_for(linked, 3.0)
        bench.server.soon(bench.served.reboot)
        with pytest.raises(InstrumentError, match=r"restarted|nothing of what it was set to|no time"):
            assert read_for(linked, 4.0) < 400


def test_a_run_on_a_device_that_restarts_stops_safely(tmp_path: Path) -> None:
    with served(steady_bench(tmp_path), "xsens", "reboot_at_s=30") as (bench, linked):
        with pytest.raises(AhrsLabError, match=r"restarted|sent nothing|nothing of what it was set to"):
            calibrate(tmp_path, linked)
        assert_safe(bench)


def test_a_stall_of_the_wire_loses_nothing(tmp_path: Path) -> None:
    with served(steady_bench(tmp_path), "vectornav", "stall_after=20000,stall_s=0.5") as (bench, linked):
        streaming(bench, linked)
        count = read_for(linked, 12.0)
        assert linked.ahrs.link_counts["lost"] == 0  # type: ignore[attr-defined]
        assert count > 1150


def test_a_wire_that_is_pulled_and_put_back_is_recovered_with_the_gap_in_the_time(tmp_path: Path) -> None:
    wires: list[FaultyLink] = []

    def wrap(link: Any) -> FaultyLink:
        wires.append(FaultyLink(link, LinkFaults()))
        return wires[0]

    with served(steady_bench(tmp_path), "vectornav", link=wrap) as (bench, linked):
        streaming(bench, linked)
        samples = []
        for look in range(400):
            if look == 40:
                wires[0].disconnect(0.01)
            linked.clock.wait(0.05)
            try:
                samples.append(linked.ahrs.read())
            except InstrumentError:
                continue  # a run would have ended here; the page goes on
        times = np.concatenate([block["t_s"] for block in samples if len(block)])
        counts = linked.ahrs.link_counts  # type: ignore[attr-defined]
    assert counts["reconnections"] == 1
    assert counts["lost"] == round(np.diff(times).max() / 0.01) - 1 > 10
    assert np.all(np.diff(times) > 0.0)


def test_a_wrong_baud_rate_is_told(tmp_path: Path) -> None:
    with served(steady_bench(tmp_path), "vectornav", "baud=115200", boot_time_s=1.2) as (_, linked):
        linked.supply.set_output(12.0, 1.0)
        linked.supply.on()
        with pytest.raises(InstrumentError, match=r"made no frame: check the baud rate"):
            linked.ahrs.start()


def test_no_thread_is_left(tmp_path: Path) -> None:
    before = set(threading.enumerate())
    with served(steady_bench(tmp_path), "microstrain") as (bench, linked):
        streaming(bench, linked)
        assert read_for(linked, 1.0) > 50
    assert not [thread for thread in set(threading.enumerate()) - before if thread.is_alive()]


def test_real_instruments_keep_real_time() -> None:
    parts: dict[str, Any] = {part: {} for part in ("ahrs", "table", "supply", "room")}
    data = {"kind": "instruments", "site": {"latitude_deg": 40.0}, **parts}
    with pytest.raises(InputError, match="real instruments keep real time"):
        linked_bench(data, "bench.toml", speed=20.0)
    with pytest.raises(InputError, match="“speeds” is not a setting"):
        linked_bench(data | {"speeds": 2}, "bench.toml")
