"""How fast the virtual bench makes a complete standard calibration's samples: ``python
benchmarks/simulation.py``.

Prints samples a second and the ratio to merely drawing the normal deviates of the six channels.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np

from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.simulation.bench import build_bench
from ahrs_lab.simulation.presets import demonstration

_FACES = ("UEN", "NUE", "ENU", "DNE", "EDN", "NED")
_RATES = (10.0, -10.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0, 300.0, -300.0)


def _timed(work: Callable[[], int]) -> tuple[int, float]:
    start = time.perf_counter()
    count = work()
    return count, time.perf_counter() - start


def _take(bench: Bench, seconds: float) -> int:
    bench.clock.wait(seconds)
    bench.table.log()
    return len(bench.ahrs.read())


def calibration() -> int:
    """Twelve positions of half an hour, ten rates and two times ten turns an axis; how many samples came."""
    bench = build_bench(demonstration())
    bench.supply.set_output(12.0, 1.0)
    bench.table.enable()
    bench.ahrs.start()
    count = 0
    for face, letters in enumerate(_FACES):
        bench.supply.off()
        bench.operator.mount(Orientation(letters), None)
        bench.supply.on()
        count += _take(bench, 90.0)
        for azimuth in (0.0, 180.0):
            bench.table.move_to(azimuth, 20.0)
            count += _take(bench, 15.0) + _take(bench, 1800.0)
        if face < 3:
            for rate in _RATES:
                bench.table.set_rate(rate)
                count += _take(bench, 5.0) + _take(bench, 36.0)
            for target in (3600.0, 0.0):
                bench.table.move_to(target, 100.0)
                count += _take(bench, 60.0)
    return count


def normals(count: int) -> int:
    """Draw them, nothing else, in blocks that stay in the cache."""
    rng = np.random.Generator(np.random.SFC64(1))
    block = np.empty(16384)
    for _ in range(6 * count // len(block)):
        rng.standard_normal(out=block)
    return count


def main() -> None:
    """Best of a few, because the machine has other things to do."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=3)
    repeats = parser.parse_args().repeats
    made = [_timed(calibration) for _ in range(repeats)]
    count = made[0][0]
    best = min(seconds for _, seconds in made)
    drawn = min(_timed(lambda: normals(count))[1] for _ in range(repeats))
    print(
        f"{count} samples of six channels with all terms: {best:.2f} s, {count / best / 1e6:.2f} M samples/s"
    )
    print(f"drawing their normals alone: {drawn:.2f} s; ratio {best / drawn:.1f}")


if __name__ == "__main__":
    main()
