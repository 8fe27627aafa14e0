"""``ahrs-lab run`` through the wires of a bench that runs faster than time gives what the bench in process
gives, and real instruments are never run so."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.cli import main
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.benches import bench_from_text
from ahrs_lab.laboratory.headless import run_plan
from ahrs_lab.laboratory.linked_benches import linked_bench
from ahrs_lab.laboratory.results import to_json
from ahrs_lab.procedures.plan import load_plan
from ahrs_lab.simulation.servers.linked_toml import linked_bench as linked_toml
from ahrs_lab.simulation.servers.served_bench import ServeSettings, serve_bench
from ahrs_lab.simulation.settings import simulation_from_toml
from tests.laboratory.served import steady_bench
from tests.laboratory.short_run import only_json, values, write_plan

SPEED = 20.0
RATES_DPS = (-200.0, -100.0, -50.0, 25.0, 50.0, 100.0, 200.0)
WHITE_DPS = 0.15 / 60.0
"""Of the bench's unit, °/s/√Hz: an angle random walk of 0.15 °/√h."""
DWELL_S = 20.0
TURNS = 2
TURN_S = 12.0
SIGMAS = 4.5
LATE_S = 3.0
"""Wall time that the wires may be late by, and still the turns lie in their recording."""


def tolerances() -> dict[str, float]:
    """What two runs may differ by from white noise alone, 4.5 standard deviations of a difference.

    K: the means of the dwells, and of the two rests that are taken off, over the lever of the rates. B: four
    means. L: the angle that the noise gathers while the turns are recorded, once each way. Both ends stamp in
    bench time and the samples carry the device's, so that late wires only lengthen the recording of turns.
    """
    lever = math.sqrt(sum(rate**2 for rate in RATES_DPS))
    mean = WHITE_DPS / math.sqrt(DWELL_S)
    angle_rad = math.radians(WHITE_DPS * math.sqrt(TURN_S + LATE_S * SPEED))
    several = SIGMAS * math.sqrt(2.0)
    return {
        "K": several * mean / lever * math.sqrt(1.5),
        "B": several * mean / math.sqrt(4.0),
        "L": several * angle_rad * math.sqrt(2.0) / (2.0 * TURNS * 2.0 * math.pi),
    }


@contextmanager
def simulated(bench: Path, protocol: str, linked: Path) -> Iterator[None]:
    """``ahrs-lab simulate`` as a person starts it."""
    words = [sys.executable, "-m", "ahrs_lab", "simulate", "--bench", str(bench), "--ahrs", protocol]
    words += ["--speed", str(SPEED), "--json", "--write-bench", str(linked)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert json.loads(process.stdout.readline())["speed"] == SPEED
            yield
        finally:
            process.terminate()
            process.wait(10.0)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("in-process")
    bench = bench_from_text(steady_bench(folder), "bench")
    plan = load_plan(write_plan(folder))
    return to_json(run_plan(plan, bench, folder / "out", on_event=lambda event: None).result)


@pytest.mark.slow
@pytest.mark.parametrize("protocol", ["vectornav", "xsens", "microstrain"])
def test_twenty_times_as_fast_as_time_the_wires_give_the_same(
    protocol: str,
    tmp_path: Path,
    reference: dict[str, Any],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("AHRS_LAB_HOME", str(tmp_path / "home"))
    (tmp_path / "bench.toml").write_text(steady_bench(tmp_path), encoding="utf-8")
    plan, linked, out = write_plan(tmp_path), tmp_path / "linked.toml", tmp_path / "out"
    with simulated(tmp_path / "bench.toml", protocol, linked):
        assert main(["run", str(plan), "--bench", str(linked), "--out", str(out), "--json"]) == 0
    result = only_json(capsys.readouterr().out)
    ours, theirs, allowed = values(result), values(reference), tolerances()
    assert ours.keys() == theirs.keys() == {"K_x", "B_x", "L_yx", "L_zx"}
    for name, (value, _) in theirs.items():
        scale = math.radians(1.0) ** -1 if name == "K_x" else 1.0
        difference = scale * ours[name][0] - value
        assert abs(difference) < allowed[name[0]], (name, difference, allowed[name[0]])
    assert result["warnings"] == []
    assert not (tmp_path / "home" / "supervisor.jsonl").exists(), "nothing had to be stopped"


def served_toml(speed: float) -> Any:
    return serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp"), speed=speed)


@pytest.mark.parametrize("part", ["table", "supply"])
def test_a_speed_is_refused_where_an_instrument_does_not_say_that_it_is_simulated(part: str) -> None:
    with served_toml(5.0) as bench:
        data = linked_toml(bench)
        bench.table.responder.name = "ACUTROL3000" if part == "table" else bench.table.responder.name
        if part == "supply":
            next(
                s for s in bench.server._services if getattr(s, "name", "").startswith("AHRS LAB,DC")
            ).name = "PS,1"
        with pytest.raises(InputError, match=rf"\[{part}\] is “.*”, which does not say that it is simulated"):
            linked_bench(data, "bench.toml")
        assert not bench.served.world.table.turning()


@pytest.mark.parametrize(("served", "written"), [(5.0, 1.0), (1.0, 5.0), (5.0, 4.0)])
def test_both_ends_have_to_run_at_the_same_speed(served: float, written: float) -> None:
    said = f"served at {served} times real time, the bench file says {written}"
    with served_toml(served) as bench, pytest.raises(InputError, match=said):
        linked_bench(linked_toml(bench) | {"speed": written}, "bench.toml")


def test_the_speed_of_the_file_is_that_of_the_bench_whoever_runs_it() -> None:
    with served_toml(5.0) as bench:
        linked = linked_bench(linked_toml(bench), "bench.toml", speed=1.0)
        try:
            assert linked.clock.speed == 5.0  # type: ignore[attr-defined]
        finally:
            linked.close()
