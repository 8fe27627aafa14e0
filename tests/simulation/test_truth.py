"""The formulas of JJF 1536, written out here, find on a noiseless bench what the truth says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.sensor_model import GyroModel, Vector
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import GYRO
from ahrs_lab.simulation.presets import demonstration
from ahrs_lab.simulation.settings import (
    DeviceSettings,
    GyroNoise,
    SensorSettings,
    SimulationSettings,
    Stability,
)
from ahrs_lab.simulation.truth import truth
from tests.simulation.bench_at_hand import after, ready

RATES = (10.0, -10.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0, 300.0, -300.0)
_UP = ("UEN", "NUE", "ENU")


def _mean(bench: Bench, seconds: float) -> NDArray[np.float64]:
    return np.asarray(after(bench, seconds).matrix(GYRO).mean(axis=0), dtype=np.float64)


def _scale_factor(bench: Bench, axis: int) -> float:
    rest = _mean(bench, 10.0)[axis]
    means = []
    for rate in RATES:
        bench.table.set_rate(rate)
        bench.clock.wait(2.0)
        # whole turns at every rate
        means.append(_mean(bench, 36.0)[axis] - rest)
    bench.table.stop()
    bench.clock.wait(2.0)
    rates = np.array(RATES)
    return float(np.polynomial.polynomial.polyfit(rates, np.array(means), 1)[1])


def _zero_offset(bench: Bench, axis: int, seconds: float) -> float:
    """(16): ENU, ESD, WSU, WND and cyclic."""
    total = 0.0
    for letters in ("ENU", "ESD", "WSU", "WND"):
        turned = letters[-axis:] + letters[:-axis] if axis else letters
        bench.operator.mount(Orientation(turned), None)
        total += float(_mean(bench, seconds)[axis])
    return total / 4.0


def _misalignments(bench: Bench) -> NDArray[np.float64]:
    """(17): (N⁺ − N⁻)/(2·360·n), n = 10."""
    start = bench.table.state().angle_deg
    sums = []
    for target in (start + 3600.0, start):
        bench.table.move_to(target, 100.0)
        sums.append(after(bench, 40.0).matrix(GYRO).sum(axis=0) / 100.0)
    return np.asarray((sums[0] - sums[1]) / 7200.0, dtype=np.float64)


def _vector(rng: np.random.Generator, size: float, centre: float = 0.0) -> Vector:
    x, y, z = (centre + float(value) for value in size * rng.uniform(-1, 1, 3))
    return (x, y, z)


@pytest.mark.parametrize("seed", range(4))
def test_a_noiseless_unit_is_recovered(seed: int) -> None:
    rng = np.random.default_rng(seed)
    gyro = GyroModel(
        scale_factor=_vector(rng, 0.01, 1.0),
        bias_dps=_vector(rng, 0.01),
        misalignment_rad=(_vector(rng, 1e-3), _vector(rng, 1e-3), _vector(rng, 1e-3)),
        g_sensitivity=(_vector(rng, 1e-4), _vector(rng, 1e-4), _vector(rng, 1e-4)),
        nonlinearity=_vector(rng, 1e-4),
    )
    bench = ready(SimulationSettings.ideal(sensor=SensorSettings(gyro=gyro)))
    expected = truth(bench)
    for axis, letters in enumerate(_UP):
        bench.operator.mount(Orientation(letters), None)
        assert _scale_factor(bench, axis) == pytest.approx(
            expected.fitted_scale_factor(RATES)[axis], rel=1e-9
        )
        found = _misalignments(bench)
        for other in {0, 1, 2} - {axis}:
            assert found[other] == pytest.approx(expected.L["xyz"[other] + "xyz"[axis]], abs=1e-9)
        assert _zero_offset(bench, axis, 5.0) == pytest.approx(expected.B_dps[axis], abs=1e-9)


def test_counts_are_scaled_by_their_own_scale_factor() -> None:
    gyro = GyroModel(scale_factor=(1.02, 1.0, 1.0), bias_dps=(0.01, 0.0, 0.0))
    device = DeviceSettings(rate_unit="LSB", gyro_lsb=1e-5, outputs=("increment",))
    bench = ready(SimulationSettings.ideal(sensor=SensorSettings(gyro=gyro), device=device))
    expected = truth(bench)
    assert expected.K[0] == pytest.approx(1.02e5)
    assert expected.B_dps[0] == 0.01
    assert _scale_factor(bench, 0) == pytest.approx(1.02e5, rel=1e-8)
    assert _zero_offset(bench, 0, 100.0) / expected.K[0] == pytest.approx(0.01, abs=1e-6)


def test_the_mean_offset_of_a_drifting_unit_is_what_its_samples_average_to() -> None:
    sensor = SensorSettings(
        gyro=GyroModel(scale_factor=(1.1, 0.9, 1.0), bias_dps=(0.01, 0.02, 0.03)),
        gyro_noise=GyroNoise(bias_instability_deg_per_h=30.0, rate_random_walk_deg_per_h_per_sqrt_h=100.0),
        gyro_stability=Stability(turn_on=0.01, start_up=(0.1, 0.2, 0.3), temperature=(1e-3,)),
    )
    settings = replace(demonstration(), sensor=sensor, room=SimulationSettings().room)
    bench = ready(replace(settings, device=replace(settings.device, latency_s=0.0)), "ENU")
    bench.clock.wait(20.5)
    start = bench.clock.now_s()
    means = _mean(bench, 600.0)
    drift = truth(bench).mean_offset_dps(start, start + 600.0)
    latitude = np.radians(39.9042)
    earth = np.degrees(7.292115e-5) * np.array([0.0, np.cos(latitude), np.sin(latitude)])
    # the table leans and stands off north by arc seconds; what of the bias instability is faster than the
    # drift's grid has no share at low frequency, but its ends over 600 s: 30 °/h for half a second in 600
    np.testing.assert_allclose(means, drift + np.array([1.1, 0.9, 1.0]) * earth, atol=2.5e-5)
