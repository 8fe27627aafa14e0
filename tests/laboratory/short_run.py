"""A calibration of one axis in some minutes of bench time, and the demonstration's bench with faults."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.bench import world_of

PLAN = """name = "Short"
axes = ["x"]
[scale_factor]
rates_dps = [-200.0, -100.0, -50.0, 25.0, 50.0, 100.0, 200.0]
static_s = 20.0
[zero_offset]
duration_s = 20.0
[misalignment]
turns = 2
[settling]
hold_s = 1.0
[power]
current_hold_s = 3.0
warm_up_s = 5.0
"""
SEGMENTS = frozenset(
    ["sf_x_before", *(f"sf_x_0{i}" for i in range(7)), "sf_x_after", "ma_x_pos", "ma_x_neg"]
    + [f"zo_x_{position}" for position in range(1, 5)]
)


def write_plan(folder: Path, old: str = "", new: str = "") -> Path:
    """The short plan, with one line replaced."""
    assert old in PLAN
    path = folder / "plan.toml"
    path.write_text(PLAN.replace(old, new) if old else PLAN, encoding="utf-8")
    return path


def write_bench(folder: Path, *faults: str, old: str = "", new: str = "") -> Path:
    """The demonstration's bench; each of ``faults`` is the body of a ``[[fault]]``.

    Its unit starts up without drift, which twenty seconds of zero offset could not average.
    """
    text = resource_path("benches/demo.toml").read_text(encoding="utf-8")
    for drift, none in (
        ("turn_on = 0.0005", "turn_on = 0.0"),
        ("start_up = [0.002, -0.001, 0.0015]", "start_up = [0.0, 0.0, 0.0]"),
    ):
        assert drift in text
        text = text.replace(drift, none)
    assert old in text
    path = folder / "bench.toml"
    body = "".join(f"\n[[fault]]\n{fault}\n" for fault in faults)
    path.write_text((text.replace(old, new) if old else text) + body, encoding="utf-8")
    return path


def call(folder: Path, *more: str) -> list[str]:
    """The words of ``ahrs-lab run`` into ``folder/out``."""
    out = folder / "out"
    return ["run", str(folder / "plan.toml"), "--bench", str(folder / "bench.toml"), "--out", str(out), *more]


def counted(bundle: Path) -> frozenset[str]:
    """Names of the recording's segments that are evaluated."""
    entries = [entry.segment for entry in read_bundle(bundle).segments]
    names = [entry.name for entry in entries if not entry.superseded and not entry.interrupted]
    assert len(names) == len(set(names))
    return frozenset(names)


def values(result: dict[str, Any]) -> dict[str, tuple[float, float]]:
    """Each value of a result with its expanded uncertainty."""
    found: dict[str, tuple[float, float]] = {}
    for item, symbol in (("scale_factor", "K"), ("zero_offset", "B"), ("misalignment", "L")):
        for key, entry in result[item].items():
            found[f"{symbol}_{key}"] = (entry[symbol], entry["expanded_uncertainty"])
    return found


def assert_same_results(result: dict[str, Any], reference: dict[str, Any]) -> None:
    """The same quantities, and values that agree within their uncertainties."""
    ours, theirs = values(result), values(reference)
    assert ours.keys() == theirs.keys()
    for name, (value, expanded) in ours.items():
        other, other_expanded = theirs[name]
        assert abs(value - other) < 2.0 * (expanded**2 + other_expanded**2) ** 0.5, name


def assert_safe(bench: Bench) -> None:
    """Table at rest, supply off: as the instruments say, and as it is in the world behind them."""
    assert not bench.table.state().moving
    assert not world_of(bench).table.turning()
    assert not bench.supply.read().output_on
    assert abs(bench.supply.read().current_a) < 0.01


def wait_until(condition: Callable[[], bool], limit_s: float = 30.0) -> None:
    """Wait for something another thread or process does."""
    end = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)


def only_json(text: str) -> dict[str, Any]:
    """The one object on standard output, by the strict rules of JSON."""

    def refuse(constant: str) -> float:
        raise AssertionError(f"{constant} is not JSON")

    data = json.loads(text, parse_constant=refuse)
    assert isinstance(data, dict)
    return data
