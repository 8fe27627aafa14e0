"""The IMU calibration against its statistical limit, scheme by scheme.

    python benchmarks/imu_calibration.py [--runs 1000] [--seed 1]

A unit with white noise of known density is calibrated over and over from turns and each scheme's positions.
For each kind of coefficient the table gives the limit (Cramér–Rao, from the closed forms for turns and
positions), the root mean square of the errors over it (1.00 is the limit), and how many of 100 intervals
value ± 1.96 u hold the truth. There is no peer to run beside it: what is published calibrates by hand motion,
without a table.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ahrs_lab.inertial.earth import earth_rate_enu_dps, normal_gravity_mps2  # noqa: E402
from ahrs_lab.metrology.imu_calibration import (  # noqa: E402
    SCHEMES,
    PositionData,
    RotationData,
    case_to_enu,
    position_matrix,
)
from ahrs_lab.metrology.imu_estimation import ReferenceVectors, calibrate  # noqa: E402

Array = NDArray[np.float64]

REFERENCE = ReferenceVectors(float(normal_gravity_mps2(39.9042)), earth_rate_enu_dps(39.9042))
GYRO_N_DPS = 3.5e-3
"""0.21 °/√h in °/√s."""
ACCEL_N_MPS2 = 1.4e-3
"""140 µg/√Hz in (m/s²)·√s."""
DWELL_S, TURNS, RATE_DPS = 60.0, 10, 100.0
KINDS = ("E1, E", "B0", "Bf", "K1, K", "K0")


def perfect_data(scheme: str) -> tuple[list[PositionData], list[RotationData]]:
    """What a perfect unit shows, with the standard errors of its noise."""
    ones = np.ones(3)
    positions = []
    for letters in SCHEMES[scheme]:
        matrix = case_to_enu(letters)
        positions.append(
            PositionData(
                case_to_enu=matrix,
                gyro=matrix.T @ REFERENCE.earth_rate_enu_dps,
                accel=matrix[2] * REFERENCE.gravity_mps2,
                duration_s=DWELL_S,
                gyro_error=ones * GYRO_N_DPS / math.sqrt(DWELL_S),
                accel_error=ones * ACCEL_N_MPS2 / math.sqrt(DWELL_S),
            )
        )
    rotations = []
    time_s = 360.0 * TURNS / RATE_DPS
    for letters in ("UWS", "SUW", "NWU"):
        matrix = case_to_enu(letters)
        for turned in (360.0 * TURNS, -360.0 * TURNS):
            up = turned + REFERENCE.earth_rate_enu_dps[2] * time_s
            rotations.append(
                RotationData(matrix, turned, time_s, matrix[2] * up, ones * GYRO_N_DPS * math.sqrt(time_s))
            )
    return positions, rotations


def limits(scheme: str) -> tuple[Array, Array]:
    """Of each coefficient of a channel, shape (3, 7) and (3, 4)."""
    matrix = position_matrix([case_to_enu(letters) for letters in SCHEMES[scheme]])
    factors = np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix))) / math.sqrt(DWELL_S)
    by_turns = GYRO_N_DPS / math.sqrt(720.0 * TURNS * RATE_DPS)
    per_g = factors[1:] / REFERENCE.gravity_mps2
    gyro = np.tile([by_turns, GYRO_N_DPS * factors[0], *(GYRO_N_DPS * per_g), by_turns, by_turns], (3, 1))
    others = [[j for j in range(3) if j != i] for i in range(3)]
    accel = ACCEL_N_MPS2 * np.array([[per_g[i], factors[0], *per_g[others[i]]] for i in range(3)])
    return gyro, accel


def measure(
    scheme: str, runs: int, rng: np.random.Generator
) -> tuple[list[Array], list[Array], float, float]:
    """Errors over the limit and errors over the stated uncertainty by kind; condition number; ms a
    calibration."""
    positions, rotations = perfect_data(scheme)
    limit = limits(scheme)
    gyro_true, accel_true = np.zeros((3, 7)), np.zeros((3, 4))
    gyro_true[:, 0] = accel_true[:, 0] = 1.0
    ratios: list[list[Array]] = [[] for _ in KINDS]
    pulls: list[list[Array]] = [[] for _ in KINDS]
    spent, condition = 0.0, 0.0
    for _ in range(runs):
        shown = [
            replace(
                p,
                gyro=p.gyro + p.gyro_error * rng.standard_normal(3),
                accel=p.accel + p.accel_error * rng.standard_normal(3),
            )
            for p in positions
        ]
        turned = [replace(r, angle=r.angle + r.angle_error * rng.standard_normal(3)) for r in rotations]
        started = time.perf_counter()
        found = calibrate(shown, turned, REFERENCE)
        spent += time.perf_counter() - started
        assert found.quality is not None
        condition = found.quality.accel_condition
        gyro, accel = found.coefficients.vectors()
        said = found.quality.standard_uncertainty.vectors()
        errors = gyro - gyro_true, accel - accel_true
        places = ((0, [0, 5, 6]), (0, [1]), (0, [2, 3, 4]), (1, [0, 2, 3]), (1, [1]))
        for kind, (part, columns) in enumerate(places):
            ratios[kind].append((errors[part] / limit[part])[:, columns].ravel())
            pulls[kind].append((errors[part] / said[part])[:, columns].ravel())
    return [np.array(r) for r in ratios], [np.array(p) for p in pulls], condition, 1e3 * spent / runs


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    print(f"{arguments.runs} calibrations each; ratio of error to limit, and hits of 100")
    print("scheme  condition  ms " + "".join(f"{kind:>16}" for kind in KINDS))
    worst = 0.0
    for scheme in SCHEMES:
        ratios, pulls, condition, spent_ms = measure(scheme, arguments.runs, rng)
        cells = []
        for ratio, pull in zip(ratios, pulls, strict=True):
            size = math.sqrt(float(np.mean(ratio**2)))
            worst = max(worst, size)
            cells.append(f"{size:9.3f} {100.0 * float(np.mean(np.abs(pull) <= 1.96)):6.1f}")
        print(f"{scheme:>6} {condition:10.3f} {spent_ms:4.1f}" + "".join(cells))
    print(f"largest ratio {worst:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
