"""How fast six channels get all their errors: ``python benchmarks/imu_simulation.py``.

True rates and specific forces in, what the unit shows out: misalignment, g-sensitivity, bias, nonlinearity,
white noise, bias instability, random walk, quantisation, scale factor, saturation. Prints samples a second
(all six channels) by process and by wall time, the ratio to merely drawing six normal deviates a sample, and
to imu-error-model, sample by sample, where that is installed.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.sensor_noise import Interpolation, NoiseCoefficients, SlowDrift, WhiteNoise
from ahrs_lab.simulation.presets import sensor_preset

Array = NDArray[np.float64]
HZ = 100.0
_BLOCK = 16384


def _timed(work: Callable[[], int], repeats: int) -> tuple[float, float]:
    """Best process and wall time of one sample, s."""
    process, wall = [], []
    for _ in range(repeats):
        began, clock = time.process_time(), time.perf_counter()
        count = work()
        process.append((time.process_time() - began) / count)
        wall.append((time.perf_counter() - clock) / count)
    return min(process), min(wall)


def _coefficients() -> tuple[NoiseCoefficients, ...]:
    """Of a tactical ring-laser unit, with a random walk and a quantisation of the accelerometers added."""
    noise = sensor_preset("tactical-rlg")
    gyro, accel = noise.gyro_noise, noise.accel_noise
    rates = NoiseCoefficients(
        gyro.angle_random_walk_deg_per_sqrt_h / 60.0,
        gyro.bias_instability_deg_per_h / 3600.0,
        gyro.rate_random_walk_deg_per_h_per_sqrt_h / 216_000.0,
        gyro.quantisation_arcsec / 3600.0,
    )
    forces = NoiseCoefficients(
        accel.velocity_random_walk_mps_per_sqrt_s, accel.bias_instability_mps2, 1e-6, 1e-5
    )
    return (rates,) * 3 + (forces,) * 3


def _simulated(rate_dps: Array, force_mps2: Array) -> Iterator[Array]:
    """Blocks of shape (6, n)."""
    settings, coefficients = sensor_preset("tactical-rlg"), _coefficients()
    slow, *seeds = np.random.SeedSequence(1).spawn(7)
    drift = SlowDrift(coefficients, slow)
    white = [WhiteNoise(c, 1.0 / HZ, seed) for c, seed in zip(coefficients, seeds, strict=True)]
    scale = (*settings.gyro.scale_factor, *settings.accel.scale_factor)
    limits = (settings.gyro.range_dps,) * 3 + (settings.accel.range_mps2,) * 3
    for start in range(0, rate_dps.shape[1], _BLOCK):
        rate, force = rate_dps[:, start : start + _BLOCK], force_mps2[:, start : start + _BLOCK]
        shown = np.empty((6, rate.shape[1]))
        shown[:3] = settings.gyro.indicated_dps(rate, force)
        shown[3:] = settings.accel.indicated_mps2(force)
        between = Interpolation(np.arange(start + 0.5, start + shown.shape[1]) / HZ)
        nodes, scratch = drift.nodes(between.first, between.last), np.empty(shown.shape[1])
        for row, values in enumerate(shown):
            np.add(values, between(nodes[row], scratch), out=values)
            white[row].add_to(values, scratch)
            np.clip(values, -limits[row], limits[row], out=values)
            np.multiply(values, scale[row], out=values)
        yield shown


def _normals(count: int) -> int:
    rng = np.random.Generator(np.random.SFC64(1))
    block = np.empty(_BLOCK)
    for _ in range(6 * count // _BLOCK):
        rng.standard_normal(out=block)
    return count


def _peer() -> Any:
    try:
        import imu_error_model
    except ImportError:
        return None
    return imu_error_model


def _by_peer(peer: Any, count: int) -> int:
    """The same kinds of error; the unit stands still, which costs no less."""
    keys: dict[str, Any] = {
        "white_noise_density": 1e-4,
        "bias_std": 1e-5,
        "bias_correlation_time": 1e5,
        "flicker_bias_std": 1e-5,
        "flicker_min_correlation_time": 1.0,
        "flicker_max_correlation_time": 1e4,
        "flicker_components": 8,
        "scale_factor": 1e-4,
        "nonlinear_factor": 1e-5,
        "misalignment_std": 1e-4,
        "quantization_step": 1e-7,
    }
    config = peer.ImuConfig(accelerometer=peer.AxisConfig(**keys), gyroscope=peer.AxisConfig(**keys))
    model = peer.ImuModel(config, np.random.default_rng(1))
    velocity, attitude = np.zeros(3), np.eye(3)
    for index in range(count):
        model.measure(index / HZ, velocity, attitude)
    return count


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    t_s = np.arange(options.samples) / HZ
    rate = 100.0 * np.sin(0.3 * t_s + np.arange(3)[:, np.newaxis])
    force = 9.8 * np.cos(0.2 * t_s + np.arange(3)[:, np.newaxis])

    cpu, wall = _timed(lambda: sum(block.shape[1] for block in _simulated(rate, force)), options.repeats)
    drawn, drawn_wall = _timed(lambda: _normals(options.samples), options.repeats)
    print(
        f"six channels, all errors: {1e-6 / cpu:.2f} M samples/s of process time, {1e-6 / wall:.2f} M/s wall"
    )
    print(
        f"drawing their normals alone: {1e-6 / drawn:.1f} M samples/s; ratio 1/{cpu / drawn:.1f} "
        f"(wall 1/{wall / drawn_wall:.1f})"
    )
    peer = _peer()
    if peer is None:
        print("imu-error-model is not installed: no comparison")
        return
    other, other_wall = _timed(lambda: _by_peer(peer, 5000), 1)
    print(
        f"imu-error-model: {1e-3 / other:.1f} k samples/s; ratio {other / cpu:.0f} "
        f"(wall {other_wall / wall:.0f})"
    )


if __name__ == "__main__":
    main()
