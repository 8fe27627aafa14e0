"""Whether 95 % of the intervals on a certificate hold the truth: thousands of calibrations whose truth is
known.

    python benchmarks/coverage.py [--count 2000] [--seed 2015] [--keep FOLDER] [--report]

Each grade of unit is calibrated with the standard and the combined schedule on benches drawn from the figures
of clause 6; a quarter as many on a bench without errors (the noise alone) and without noise (the bench
alone). Prints, for each, how many of 100 intervals hold the truth. ``--keep`` keeps each run's numbers in a
folder and takes up what is there already; ``--report`` writes ``docs/coverage.md`` and its picture.
"""

from __future__ import annotations

import argparse
import itertools
import math
import pickle
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ahrs_lab.metrology.conditions import BenchCapability  # noqa: E402
from ahrs_lab.metrology.result import MISALIGNMENT_KEYS, CalibrationResult, Uncertainty  # noqa: E402
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, drift_variance  # noqa: E402
from ahrs_lab.procedures.plan_settings import Plan, Schedule, ZeroOffsetPlan  # noqa: E402
from ahrs_lab.procedures.reduction import reduce_recording  # noqa: E402
from ahrs_lab.recording.orientation import AXES  # noqa: E402
from ahrs_lab.simulation.presets import GRADES, Grade  # noqa: E402
from benchmarks.simulated_calibrations import (  # noqa: E402
    Course,
    Take,
    coefficients,
    course_of,
    draw_bench,
    draw_unit,
    noises,
    perfect,
    record,
    truth_of,
)

Array = NDArray[np.float64]
World = Literal["clause 6", "noise alone", "bench alone"]

QUANTITIES = (
    *(f"{symbol}_{axis}" for symbol in ("K", "F0", "B") for axis in AXES),
    *(f"L_{key}" for key in MISALIGNMENT_KEYS),
)
BLOCK = 250
DWELL_S: dict[Schedule, float] = {"standard": 600.0, "combined": 1800.0}
"""So that both schedules are at rest for two hours."""
_NOISE = "Sensor noise in the recordings"


@dataclass(frozen=True)
class Configuration:
    """A grade with a schedule in one world."""

    grade: str
    schedule: Schedule
    world: World = "clause 6"

    @property
    def plan(self) -> Plan:
        return Plan(zero_offset=ZeroOffsetPlan(self.schedule, DWELL_S[self.schedule]))

    @property
    def bench(self) -> BenchCapability:
        return perfect() if self.world == "noise alone" else BenchCapability()


GRADES_SHOWN = ("industrial-mems", "tactical-fog", "navigation-rlg")
CONFIGURATIONS = (
    *(Configuration(grade, "standard") for grade in GRADES_SHOWN),
    *(Configuration(grade, "combined") for grade in GRADES_SHOWN),
    *(Configuration(grade, "standard", "noise alone") for grade in GRADES_SHOWN),
    Configuration("tactical-fog", "standard", "bench alone"),
    Configuration("tactical-fog", "combined", "bench alone"),
)


@dataclass
class Tally:
    """Of one configuration. Arrays of shape (calibrations, quantities), in the order of ``QUANTITIES``;
    ``sources``: sum over the calibrations of the squared contributions of K, F0, B, L by row."""

    errors: Array
    standard: Array
    expanded: Array
    limits: Array
    sources: dict[str, dict[str, float]] = field(default_factory=dict)
    seconds: float = 0.0

    def with_more(self, other: Tally) -> Tally:
        """Both together, of the same configuration."""
        sources = {
            symbol: {
                name: rows.get(name, 0.0) + other.sources[symbol].get(name, 0.0)
                for name in rows | other.sources[symbol]
            }
            for symbol, rows in self.sources.items()
        }
        errors, standard, expanded = (
            np.concatenate([getattr(one, name) for one in (self, other)])
            for name in ("errors", "standard", "expanded")
        )
        return Tally(errors, standard, expanded, self.limits, sources, self.seconds + other.seconds)

    def add(self, index: int, result: CalibrationResult, truth: dict[str, float]) -> None:
        """Calibration number ``index``."""
        for place, quantity in enumerate(QUANTITIES):
            value, uncertainty = _found(result, quantity)
            self.errors[index, place] = value - truth[quantity]
            self.standard[index, place] = uncertainty.standard
            self.expanded[index, place] = uncertainty.expanded
            contributions = self.sources.setdefault(quantity.partition("_")[0], {})
            for row in uncertainty.rows:
                name = _NOISE if row.shared else row.source.text()
                contributions[name] = contributions.get(name, 0.0) + row.contribution**2

    @property
    def covered(self) -> NDArray[np.int64]:
        """Shape (quantities,): intervals that hold the truth."""
        return np.asarray(np.sum(np.abs(self.errors) <= self.expanded, axis=0), dtype=np.int64)


def run(configuration: Configuration, count: int, seed: int, keep: Path | None = None) -> Tally:
    """``count`` calibrations in blocks, every unit and bench drawn anew; the same ``seed`` gives the same
    numbers. Blocks that the folder ``keep`` holds are not made again."""
    blocks = [
        _block(configuration, min(BLOCK, count - first), (seed, first), keep)
        for first in range(0, count, BLOCK)
    ]
    merged = blocks[0]
    for block in blocks[1:]:
        merged = merged.with_more(block)
    return merged


def _block(configuration: Configuration, count: int, seed: tuple[int, int], keep: Path | None) -> Tally:
    name = f"{configuration.grade} {configuration.schedule} {configuration.world} {seed} {count}.pickle"
    kept = None if keep is None else keep / name
    if kept is not None and kept.exists():
        found = pickle.loads(kept.read_bytes())
        assert isinstance(found, Tally)
        return found
    made = _make(configuration, count, seed)
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_bytes(pickle.dumps(made))
    return made


def _make(configuration: Configuration, count: int, seed: tuple[int, int]) -> Tally:
    course, grade, stated = course_of(configuration.plan), GRADES[configuration.grade], configuration.bench
    number = CONFIGURATIONS.index(configuration)
    slow, drawn = np.random.SeedSequence([*seed, number]).spawn(2)
    rng = np.random.Generator(np.random.SFC64(drawn))
    noisy = configuration.world != "bench alone"
    noise = noises(course, grade, slow) if noisy else itertools.repeat(None)
    shape = (count, len(QUANTITIES))
    limits = np.array([statistical_limit(course, grade, quantity) for quantity in QUANTITIES])
    tally = Tally(np.empty(shape), np.empty(shape), np.empty(shape), limits)
    started = time.process_time()
    for index, shown in enumerate(itertools.islice(noise, count)):
        unit = draw_unit(grade, len(course.mountings), rng)
        recording = record(course, unit, draw_bench(course, stated, rng), shown)
        tally.add(
            index, reduce_recording(recording, capability=stated, trials=0), truth_of(course, unit, shown)
        )
    tally.seconds = time.process_time() - started
    return tally


def _found(result: CalibrationResult, quantity: str) -> tuple[float, Uncertainty]:
    symbol, _, key = quantity.partition("_")
    if symbol == "L":
        return result.misalignment[key].L, result.misalignment[key].uncertainty
    axis = next(axis for axis in AXES if axis == key)
    if symbol == "B":
        return result.zero_offset[axis].B, result.zero_offset[axis].uncertainty
    line = result.scale_factor[axis]
    if symbol == "K":
        return line.K, line.uncertainty
    assert line.F0_uncertainty is not None
    return line.F0, line.F0_uncertainty


def statistical_limit(course: Course, grade: Grade, quantity: str) -> float:
    """Standard deviation that the grade's noise alone leaves, with its true coefficients: white noise of rate
    and angle, and for K, F₀ and L the drift between their recordings (the D_k). In B drift belongs to the
    truth.
    """
    noise = coefficients(grade)
    symbol, _, key = quantity.partition("_")
    if symbol == "B":
        takes = [take for take in course.takes if take.segment.item == "zero_offset"][:4]
        weights = np.full(4, 0.25)
    elif symbol == "L":
        takes = course.of("misalignment", key[1])
        weights = np.array([1.0, -1.0]) * takes[0].duration_s / (720.0 * (takes[0].segment.turns or 0))
    else:
        takes = course.of("scale_factor", key)
        weights = _line_weights(takes, symbol)
    durations = np.array([take.duration_s for take in takes])
    angle = noise.white**2 * durations + 2.0 * noise.quantisation**2
    variance = float(np.sum((weights / durations) ** 2 * angle))
    if symbol != "B":
        starts = np.array([take.start_s for take in takes])
        model = NoiseModel(flicker=noise.bias_instability, walk=noise.random_walk)
        variance += drift_variance(weights, starts, durations, model)[0]
    return math.sqrt(variance)


def _line_weights(takes: list[Take], symbol: str) -> Array:
    """∂K/∂mean or ∂F₀/∂mean of the recordings of 7.1, those at rest among them."""
    rates = np.array([take.segment.rate_dps for take in takes])
    turning = np.array([take.segment.role == "rate" for take in takes])
    if symbol == "K":
        return rates / float(rates @ rates)  # ± pairs: their mean is 0
    return np.where(turning, 1.0 / turning.sum(), -0.5)


def main() -> int:
    """Print a line for each configuration and world."""
    from benchmarks.coverage_report import lines_of, write_report

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=2015)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--report", action="store_true")
    given = parser.parse_args()
    found: dict[Configuration, Tally] = {}
    # kept blocks are made in turns, so that an interrupted run leaves some of each
    steps = range(BLOCK, given.count, BLOCK) if given.keep else ()
    for upto in (*steps, given.count):
        for configuration in CONFIGURATIONS:
            count = given.count if configuration.world == "clause 6" else given.count // 4
            found[configuration] = run(configuration, min(upto, count), given.seed, given.keep)
    for configuration, tally in found.items():
        print("\n".join(lines_of(configuration, tally)), flush=True)
    if given.report:
        write_report(ROOT / "docs", found, given.count, given.seed)
    return 0


if __name__ == "__main__":
    from benchmarks.coverage import main as of_the_module  # what is kept names its classes by their module

    sys.exit(of_the_module())
