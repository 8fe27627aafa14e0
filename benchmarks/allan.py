"""How fast the overlapping Allan deviation is: ``python benchmarks/allan.py``.

Ten million points, at octaves and at 92 averaging times from 1 to a quarter of the record, against allantools
in the same run where that is installed: best of a few, process time (the time of this process on all cores)
and wall time, their ratio, and how far the deviations differ.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.allan import octave_factors, overlapping_allan_variance

Array = NDArray[np.float64]


def _best(work: Callable[[], Array], repeats: int) -> tuple[Array, float, float]:
    """What it gives, and the least process and wall time, s."""
    process, wall = [], []
    for _ in range(repeats):
        began, clock = time.process_time(), time.perf_counter()
        found = work()
        process.append(time.process_time() - began)
        wall.append(time.perf_counter() - clock)
    return found, min(process), min(wall)


def _ninety_two(count: int) -> NDArray[np.int64]:
    for asked in range(92, 200):
        factors = np.unique(np.rint(np.geomspace(1.0, count // 4, asked)).astype(np.int64))
        if len(factors) >= 92:
            return factors
    raise ValueError(f"{count} values have no 92 averaging times")


def _peer() -> Any:
    try:
        import allantools
    except ImportError:
        return None
    return allantools


def _ours(rate: Array, factors: NDArray[np.int64]) -> Array:
    return overlapping_allan_variance(rate, factors).deviation


def _theirs(peer: Any, rate: Array, factors: NDArray[np.int64]) -> Array:
    return np.asarray(peer.oadev(rate, rate=1.0, data_type="freq", taus=factors.astype(np.float64))[1])


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=10_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    # white noise, a drift and an offset
    rng = np.random.default_rng(1)
    rate = rng.normal(2.0, 1.0, options.points) + np.cumsum(rng.normal(0.0, 1e-4, options.points))
    peer = _peer()
    if peer is None:
        print("allantools is not installed: no comparison")
    for name, factors in (("octaves", octave_factors(options.points)), ("taus", _ninety_two(options.points))):
        own, cpu, wall = _best(partial(_ours, rate, factors), options.repeats)
        print(f"{options.points} points, {len(factors)} {name}: {cpu:.2f} s process time, {wall:.2f} s wall")
        if peer is None:
            continue

        other, peer_cpu, peer_wall = _best(partial(_theirs, peer, rate, factors), options.repeats)
        same = len(other) == len(own)
        apart = float(np.max(np.abs(other / own[: len(other)] - 1.0)))
        print(
            f"  allantools: {peer_cpu:.2f} s, {peer_wall:.2f} s wall; ratio {peer_cpu / cpu:.1f} "
            f"(wall {peer_wall / wall:.1f}); deviations apart {apart:.1e} relative"
            + ("" if same else f"; it leaves out {len(own) - len(other)} of the averaging times")
        )


if __name__ == "__main__":
    main()
