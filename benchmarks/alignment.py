"""Self-alignment of many units whose errors are known: against the limit (2-104), and whether the stated
covariance is true.

    python benchmarks/alignment.py [--runs 1000] [--duration 600] [--seed 2015]

For each method and latitude: RMS error of φ_E, φ_N, φ_U over that which (2-104) gives for the biases, and the
mean normalised error squared (NEES) of the attitude with its 95 % band; for the filters also that of all
eight states.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from ahrs_lab.inertial.alignment import (  # noqa: E402
    Orthogonalisation,
    Place,
    SensorNoise,
    UnitModel,
    attitude_limit_rad,
    coarse_alignment,
    limit_matrix,
    small_rotation,
)
from ahrs_lab.inertial.alignment_fine import fine_alignment  # noqa: E402
from ahrs_lab.inertial.alignment_kalman import kalman_alignment  # noqa: E402
from ahrs_lab.inertial.alignment_steps import Steps, steps_of  # noqa: E402
from ahrs_lab.inertial.attitude import attitude_matrix  # noqa: E402
from ahrs_lab.inertial.earth import normal_gravity_mps2  # noqa: E402

Array = NDArray[np.float64]

METHODS = ("coarse", "fine", "kalman-open", "kalman-closed")
FIRST_STEPS = 60
"""The filters' coarse alignment."""
DEGREE_PER_HOUR = np.radians(1.0) / 3600.0
MICRO_G = 9.80665e-6
NAVIGATION = UnitModel(
    0.01 * DEGREE_PER_HOUR,
    50.0 * MICRO_G,
    SensorNoise(white=0.0005 * np.radians(1.0) / 60.0, walk=2e-11),
    SensorNoise(white=10.0 * MICRO_G, walk=2e-7),
)


@dataclass(frozen=True)
class Fleet:
    """Units at rest, each with its own attitude, biases and noise; the biases are those at the end."""

    place: Place
    unit: UnitModel
    C_bn: Array
    gyro_bias: Array
    accel_bias: Array
    steps: Steps

    def biases(self) -> tuple[Array, Array]:
        """Of gyros and accelerometers in n, shape (runs, 3) each."""
        gyro, accel = (np.einsum("rij,rj->ri", self.C_bn, bias) for bias in (self.gyro_bias, self.accel_bias))
        return gyro, accel


def draw_fleet(latitude_deg: float, unit: UnitModel, runs: int, seconds: int, seed: int) -> Fleet:
    """``runs`` units, one row a second: biases from the unit's assumption, any heading, up to 20° of tilt."""
    rng = np.random.default_rng(seed)
    place = Place(float(np.radians(latitude_deg)), float(normal_gravity_mps2(latitude_deg)))
    C = attitude_matrix(
        rng.uniform(0.0, 360.0, runs), rng.uniform(-20.0, 20.0, runs), rng.uniform(-20.0, 20.0, runs)
    )
    shown, biases = [], []
    for true, bias, noise in (
        (place.earth_rate, unit.gyro_bias_radps, unit.gyro_noise),
        (np.array([0.0, 0.0, place.gravity_mps2]), unit.accel_bias_mps2, unit.accel_noise),
    ):
        white, walk, jitter = np.sqrt(noise.variances())
        biases.append(bias * rng.standard_normal((runs, 3)))
        drift = np.cumsum(walk * rng.standard_normal((runs, seconds, 3)), axis=1)
        ends = jitter * rng.standard_normal((runs, seconds + 1, 3))
        sample = white * rng.standard_normal((runs, seconds, 3)) + np.diff(ends, axis=1)
        shown.append((true @ C + biases[-1])[:, np.newaxis] + drift + sample)
        biases[-1] = biases[-1] + drift[:, -1]
    return Fleet(place, unit, C, biases[0], biases[1], steps_of(shown[0], shown[1], np.ones(seconds), 1))


@dataclass(frozen=True)
class Statistics:
    """``ratio`` (3,): RMS φ over that which (2-104) gives for the biases as drawn; ``nees``: mean over the
    runs, by number of states; ``band``: where 95 % of such means lie."""

    ratio: Array
    nees: dict[int, float]
    band: dict[int, tuple[float, float]]
    errors: Array
    covariance: Array

    @property
    def honest(self) -> bool:
        """Each NEES inside its band."""
        return all(low <= self.nees[n] <= high for n, (low, high) in self.band.items())


def statistics(fleet: Fleet, method: str, orthogonalisation: Orthogonalisation = "rows") -> Statistics:
    """Errors and their honesty of one method over the fleet."""
    place, unit, steps = fleet.place, fleet.unit, fleet.steps
    errors: list[Array] = []
    if method.startswith("kalman"):
        rate, force = steps.part(0, FIRST_STEPS).means()
        first = coarse_alignment(rate, force, float(FIRST_STEPS), place, unit)
        later = steps.part(FIRST_STEPS)
        run = kalman_alignment(
            later, first.C_bn, float(FIRST_STEPS), place, unit, closed=method == "kalman-closed"
        )
        C_bn, covariance = run.C_bn, run.covariance
        errors = [np.concatenate(fleet.biases(), axis=1)[:, :5] - run.bias]
    else:
        rate, force = steps.means()
        coarse = coarse_alignment(rate, force, float(len(steps)), place, unit, orthogonalisation)
        C_bn, covariance = coarse.C_bn, coarse.covariance
        if method == "fine":
            fine = fine_alignment(steps, C_bn, place, unit)
            C_bn, covariance = fine.C_bn, fine.covariance
    phi = small_rotation(fleet.C_bn, C_bn)
    return _statistics(fleet, np.concatenate([phi, *errors], axis=1), covariance)


def _statistics(fleet: Fleet, errors: Array, covariance: Array) -> Statistics:
    runs = len(errors)
    nees: dict[int, float] = {}
    band: dict[int, tuple[float, float]] = {}
    for n in sorted({3, int(errors.shape[1])}):
        scale = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))[:, :n]
        e, P = errors[:, :n] / scale, covariance[:, :n, :n] / (scale[:, :, None] * scale[:, None, :])
        nees[n] = float(np.mean(np.sum(e * np.linalg.solve(P, e[..., None])[..., 0], axis=1)))
        low, high = (float(chi2.ppf(q, n * runs)) / runs for q in (0.025, 0.975))
        band[n] = (low, high)
    limit = np.concatenate(fleet.biases(), axis=1) @ limit_matrix(fleet.place).T
    ratio = np.sqrt(np.mean(errors[:, :3] ** 2, axis=0) / np.mean(limit**2, axis=0))
    return Statistics(ratio, nees, band, errors, covariance)


def _line(fleet: Fleet, method: str, orthogonalisation: Orthogonalisation) -> str:
    started = time.perf_counter()
    found = statistics(fleet, method, orthogonalisation)
    seconds = time.perf_counter() - started
    shown = " ".join(f"{ratio:6.3f}" for ratio in found.ratio)
    nees = ", ".join(
        f"NEES {found.nees[n]:.3f} of {n} ({low:.3f} … {high:.3f})" for n, (low, high) in found.band.items()
    )
    name = f"{method} {orthogonalisation}" if method == "coarse" else method
    return f"  {name:14}  {shown}  {nees}  {seconds:.1f} s"


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--duration", type=int, default=600, help="seconds of record")
    parser.add_argument("--seed", type=int, default=2015)
    given = parser.parse_args()
    print(f"{given.runs} units of 0.01 °/h and 50 µg, {given.duration} s; RMS over the limit (2-104)")
    for latitude in (0.0, 39.9042, 70.0, -45.0):
        fleet = draw_fleet(latitude, NAVIGATION, given.runs, given.duration, given.seed)
        limit = np.degrees(attitude_limit_rad(fleet.place, fleet.unit)) * 3600.0
        print(
            f"latitude {latitude}°, limit of east, north, up: {limit[0]:.1f}″ {limit[1]:.1f}″ {limit[2]:.1f}″"
        )
        for method in METHODS:
            for orthogonalisation in ("rows", "columns", "svd") if method == "coarse" else ("rows",):
                print(_line(fleet, method, orthogonalisation), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
