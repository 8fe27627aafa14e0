"""Transfer alignment: are the errors as large as the filters say, and how fast are they.

    python benchmarks/transfer_alignment.py [--units 300] [--seed 1] [--json]

For each method so many units fly one S-turn, a change of speed and a turn, each with errors of its own drawn
from what the filter assumes. Printed: the mean NEES per state and NIS per number compared (both 1 where the
filter knows what it does) with the band that holds 95 % of such means, and of how many units the true
misalignment lies within 2σ. An error that is considered and not estimated keeps a unit's innovations
together, so that its NIS scatters more than the band, which takes them as independent. Speed: comparisons a
second of the whole alignment (navigation and filter, units side by side), and the ratio to filterpy's
predict and update alone, of the same size, one unit after the other on the same machine in the same run;
left out, with the reason, where it is not installed."""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import time
from typing import Any

import numpy as np
from scipy.stats import chi2

from ahrs_lab.inertial.transfer_alignment import align
from ahrs_lab.inertial.transfer_alignment_model import (
    METHODS,
    Assumptions,
    MethodName,
)
from ahrs_lab.simulation.manoeuvres import Accelerate, Steady, STurns, Turn
from ahrs_lab.simulation.trajectory import Flight, Start, fly
from ahrs_lab.simulation.transfer_pair import transfer_pairs

DEGREE = np.pi / 180
ASSUMED = Assumptions(
    velocity_noise=0.05,
    position_noise_m=2.0,
    attitude_noise=0.02 * DEGREE,
    angle_random_walk=0.1 * DEGREE / 60,
    velocity_random_walk=0.05 / 60,
    level=1 * DEGREE,
    azimuth=2 * DEGREE,
    velocity=0.5,
    position_m=10.0,
    gyro_bias=10 * DEGREE / 3600,
    accel_bias=0.01,
    gyro_scale=3e-4,
    accel_scale=3e-4,
    gyro_cross=3e-4,
    accel_cross=3e-4,
    mounting=1 * DEGREE,
    level_limit=5 * DEGREE,
)
# what is measured of each method: a start of its own, or one copied from the reference
RUNS: tuple[tuple[MethodName, bool], ...] = (
    ("velocity", False),
    ("position", False),
    ("velocity-azimuth", False),
    ("velocity-attitude", False),
    ("velocity-attitude", True),
)
RATE_HZ, EVERY = 20.0, 20


def flight() -> Flight:
    way = (Steady(20), STurns(120, 40, 2), Accelerate(30, 20), Turn(40, 90), Steady(90))
    return fly(Start(speed_mps=60.0, heading_deg=30.0), way, RATE_HZ)


def measured(way: Flight, method: MethodName, copied: bool, units: int, seed: int) -> dict[str, Any]:
    pairs = transfer_pairs(way, method, ASSUMED, units, seed, every=EVERY, copied=copied)
    begin = time.perf_counter()
    found = align(pairs.unit, pairs.reference, pairs.start, method, ASSUMED)
    seconds = time.perf_counter() - begin
    size = len(found.method.estimated)
    left, P = pairs.remaining(found)[:, :size], found.covariance[:, :size, :size]
    nees = np.einsum("bi,bi->b", left, np.linalg.solve(P, left[..., np.newaxis])[..., 0])
    numbers = int(np.sum(found.compared))
    within = np.abs(left[:, :3]) < 2 * found.misalignment_u[:, -1]
    return {
        "method": method,
        "copied": copied,
        "nees": float(np.mean(nees)) / size,
        "nees_band": band(size, units),
        "nis": float(np.mean(np.sum(found.nis, axis=1))) / numbers,
        "nis_band": band(numbers, units),
        "within_2_sigma": float(np.mean(within)),
        "comparisons_per_s": units * len(found.t_s) / seconds,
    }


def band(numbers: int, units: int) -> list[float]:
    return [float(chi2.ppf(p, numbers * units)) / (numbers * units) for p in (0.025, 0.975)]


def peer_per_s(method: MethodName) -> float:
    """filterpy's predict and update a second, of the method's size."""
    kalman = importlib.import_module("filterpy.kalman")
    states, compared = len(METHODS[method].states), len(METHODS[method].compares)
    one = kalman.KalmanFilter(dim_x=states, dim_z=compared)
    one.F, one.P, one.Q = np.eye(states), np.eye(states), 1e-6 * np.eye(states)
    one.H, one.R = np.eye(compared, states), np.eye(compared)
    count, z = 2000, np.zeros(compared)
    begin = time.perf_counter()
    for _ in range(count):
        one.predict()
        one.update(z)
    return count / (time.perf_counter() - begin)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--units", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    way = flight()
    rows = [measured(way, method, copied, arguments.units, arguments.seed) for method, copied in RUNS]
    try:
        for row in rows:
            row["ratio_to_filterpy"] = row["comparisons_per_s"] / peer_per_s(row["method"])
        missing = ""
    except ImportError as error:
        missing = f"filterpy left out: {error}"
    if arguments.json:
        print(
            json.dumps({"units": arguments.units, "seed": arguments.seed, "rows": rows, "missing": missing})
        )
        return 0
    print(f"{arguments.units} units, {way.t_s[-1]:.0f} s, compared every {EVERY / RATE_HZ:.0f} s")
    for row in rows:
        start = "copied" if row["copied"] else "own"
        ratio = row.get("ratio_to_filterpy")
        print(
            f"{row['method']:18} {start:6}  NEES {row['nees']:.3f} ({row['nees_band'][0]:.3f} … "
            f"{row['nees_band'][1]:.3f})  NIS {row['nis']:.4f} ({row['nis_band'][0]:.4f} … "
            f"{row['nis_band'][1]:.4f})  within 2σ {row['within_2_sigma']:.1%}  "
            f"{row['comparisons_per_s']:.0f}/s" + ("" if ratio is None else f" ({ratio:.2f} × filterpy)")
        )
    if missing:
        print(missing)
    return 0


if __name__ == "__main__":
    sys.exit(main())
