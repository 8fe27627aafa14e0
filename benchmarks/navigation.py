"""How fast and how true strapdown navigation is, beside others: ``python benchmarks/navigation.py``.

Speeds are by CPU time, best of three, of the same increments in the same run; a peer that is not installed is
named and left out. The drift of attitude is that of a cone of 1° at 10 Hz, sampled at 500 Hz. The error of
the path is that of a flight of six minutes with all manoeuvres at 100 Hz.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import attitude_angles_deg
from ahrs_lab.inertial.increments import Samples, rotation_vectors
from ahrs_lab.inertial.quaternion import (
    conjugate,
    from_matrix,
    from_rotation_vector,
    product,
    running_product,
)
from ahrs_lab.inertial.strapdown import NavigationState, attitude_in_inertial_space, navigate
from ahrs_lab.simulation.manoeuvres import Accelerate, Climb, Coning, Manoeuvre, Rocking, Steady, STurns, Turn
from ahrs_lab.simulation.trajectory import Flight, Start, fly

Array = NDArray[np.float64]

START = Start(heading_deg=30.0, pitch_deg=1.0, roll_deg=2.0)
FLIGHT: tuple[Manoeuvre, ...] = (
    Steady(10.0),
    Accelerate(30.0, 120.0),
    Turn(60.0, 180.0),
    STurns(60.0, 20.0, 2),
    Climb(60.0, 5.0),
    Rocking(60.0, (2.0, 3.0, 5.0)),
    Coning(20.0, 1.0, 5.0),
    Accelerate(60.0, -120.0),
)
HALF_ANGLE_RAD, CONE_HZ, CONE_STEP_S, CONE_S = np.radians(1.0), 10.0, 0.002, 60.0


def _peer(name: str) -> ModuleType | None:
    # beside this file lies a coverage.py, which numba would take for the package
    here = Path(__file__).parent
    sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != here]
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"{name} is not installed: left out")
        return None


def _seconds(work: Callable[[], object]) -> float:
    best = np.inf
    for _ in range(3):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return float(best)


def _start(flight: Flight) -> NavigationState:
    return NavigationState(
        from_matrix(flight.C_bn[0]),
        flight.velocity_enu_mps[0],
        float(flight.latitude_rad[0]),
        float(flight.longitude_rad[0]),
        float(flight.altitude_m[0]),
    )


class Pyins:
    """pyins' integrator on our increments: its body axes are forward, right, down, its path north, east,
    down."""

    def __init__(self, strapdown: ModuleType, flight: Flight) -> None:
        pd = importlib.import_module("pandas")
        self._strapdown = strapdown
        swap = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
        heading, pitch, roll = (float(angle) for angle in attitude_angles_deg(flight.C_bn[0]))
        place = (
            np.degrees(flight.latitude_rad[0]),
            np.degrees(flight.longitude_rad[0]),
            flight.altitude_m[0],
        )
        self._pva = pd.Series(
            [*place, *(swap @ flight.velocity_enu_mps[0]), roll, pitch, heading],
            index=["lat", "lon", "alt", "VN", "VE", "VD", "roll", "pitch", "heading"],
        )
        first = np.zeros((1, 3))  # the row before the record, which pyins asks for
        gyro = np.concatenate((first, flight.angle_rad @ swap))
        accel = np.concatenate((first, flight.velocity_mps @ swap))
        names = [f"{kind}_{axis}" for kind in ("gyro", "accel") for axis in "xyz"]
        self._imu = pd.DataFrame(np.hstack((gyro, accel)), index=flight.t_s, columns=names)
        self.increments = self.prepare()

    def prepare(self) -> object:
        """Coning and sculling."""
        return self._strapdown.compute_increments_from_imu(self._imu, "increment")

    def integrate(self) -> Array:
        """Latitude, longitude (°) and height, (n + 1, 3)."""
        path = self._strapdown.Integrator(self._pva).integrate(self.increments)
        return np.asarray(path[["lat", "lon", "alt"]])


def speed(samples: int, pyins: ModuleType | None) -> None:
    """Samples a second."""
    once = fly(START, FLIGHT[1:4], 500.0)
    times = -(-samples // len(once.angle_rad))
    angle = np.tile(once.angle_rad, (times, 1))[:samples]
    velocity = np.tile(once.velocity_mps, (times, 1))[:samples]
    t_s = np.arange(samples + 1) / 500.0
    flight = Flight(t_s, angle, velocity, once.C_bn[:1], once.velocity_enu_mps[:1], *once_place(once))
    interval = np.diff(t_s)
    rows = np.ascontiguousarray(angle.T), np.ascontiguousarray(velocity.T), interval
    start = _start(flight)

    def whole() -> object:
        return navigate(start, *rows).angles_deg()

    figures = {
        "attitude, coning corrected": _seconds(
            lambda: attitude_in_inertial_space(start.attitude, rows[0], interval)
        ),
        "navigation with angles": _seconds(whole),
    }
    if pyins is not None:
        peer = Pyins(pyins, flight)
        peer.integrate()  # compiles
        figures["pyins Integrator.integrate"] = _seconds(peer.integrate)
        figures["pyins with its increments"] = _seconds(lambda: (peer.prepare(), peer.integrate()))
    own = figures["navigation with angles"]
    for name, seconds in figures.items():
        print(
            f"  {name:32} {samples / seconds / 1e6:7.2f} M samples/s   {own / seconds:5.2f} of our navigation"
        )


def once_place(flight: Flight) -> tuple[Array, Array, Array]:
    """Where it begins."""
    return flight.latitude_rad[:1], flight.longitude_rad[:1], flight.altitude_m[:1]


def cone() -> tuple[Array, Array]:
    """Exact increments (3, n) and quaternions (4, n + 1)."""
    a, rate = HALF_ANGLE_RAD, 2 * np.pi * CONE_HZ
    t = np.arange(round(CONE_S / CONE_STEP_S) + 1) * CONE_STEP_S
    about_z = np.full(len(t) - 1, -2 * np.sin(a / 2) ** 2 * rate * CONE_STEP_S)
    d = np.stack([np.sin(a) * np.diff(np.cos(rate * t)), np.sin(a) * np.diff(np.sin(rate * t)), about_z])
    s = np.sin(a / 2)
    return d, np.stack([np.full(len(t), np.cos(a / 2)), s * np.cos(rate * t), s * np.sin(rate * t), 0 * t])


def drift(pyins: ModuleType | None) -> None:
    """Of the attitude, °/h."""
    d, truth = cone()
    interval = np.full(d.shape[1], CONE_STEP_S)

    def of(end: Array) -> float:
        error = product(end, conjugate(truth[:, -1]))
        return float(np.degrees(2 * error[3]) / CONE_S * 3600.0)

    counts: tuple[Samples, ...] = (1, 2, 3)
    for samples in counts:
        steps = from_rotation_vector(rotation_vectors(d, interval, samples))
        print(f"  {f'ours, {samples} samples':32} {of(running_product(truth[:, 0], steps)[:, -1]):11.3g} °/h")
    if pyins is not None:
        theta = np.vstack((d[:, :1].T, d[:, 1:].T + np.cross(d[:, :-1].T, d[:, 1:].T) / 12))
        end = running_product(truth[:, 0], from_rotation_vector(theta.T))[:, -1]
        print(f"  {'the formula of pyins':32} {of(end):11.3g} °/h")
    rates = d.T / CONE_STEP_S
    ahrs = _peer("ahrs")
    if ahrs is not None:
        filtered = ahrs.filters.AngularRate(gyr=rates, q0=truth[:, 0], frequency=1 / CONE_STEP_S)
        print(f"  {'ahrs AngularRate':32} {of(np.asarray(filtered.Q[-1])):11.3g} °/h")
    kinematics = _peer("skinematics.quat")
    if kinematics is not None:
        end = kinematics.calc_quat(rates, truth[:, 0], 1 / CONE_STEP_S, "bf")[-1]
        print(f"  {'scikit-kinematics calc_quat':32} {of(np.asarray(end)):11.3g} °/h")


def path_error(pyins: ModuleType | None) -> None:
    """Largest error of the place, m."""
    flight = fly(START, FLIGHT, 100.0)

    def largest(latitude: Array, longitude: Array, altitude: Array) -> float:
        east = (longitude - flight.longitude_rad) * np.cos(flight.latitude_rad) * 6.4e6
        north = (latitude - flight.latitude_rad) * 6.4e6
        return float(np.max(np.sqrt(east**2 + north**2 + (altitude - flight.altitude_m) ** 2)))

    path = navigate(_start(flight), flight.angle_rad.T, flight.velocity_mps.T, np.diff(flight.t_s))
    own = largest(path.latitude_rad, path.longitude_rad, path.altitude_m)
    print(f"  {'ours':32} {own:11.3g} m")
    if pyins is not None:
        place = Pyins(pyins, flight).integrate()
        latitude, longitude = np.radians(place[:, 0]), np.radians(place[:, 1])
        print(f"  {'pyins':32} {largest(latitude, longitude, place[:, 2]):11.3g} m")


def main() -> None:
    """All three."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=1_000_000)
    arguments = parser.parse_args()
    pyins = _peer("pyins.strapdown")
    print(f"Speed, {arguments.samples} samples")
    speed(arguments.samples, pyins)
    print("Drift of attitude, cone of 1° at 10 Hz, 500 samples/s")
    drift(pyins)
    print("Largest error of a flight of six minutes, 100 samples/s")
    path_error(pyins)


if __name__ == "__main__":
    main()
