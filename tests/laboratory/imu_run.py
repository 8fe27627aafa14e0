"""A discrete IMU calibration of some minutes of bench time, of a unit whose 33 coefficients are entered."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from ahrs_lab.metrology.imu_calibration import AccelCoefficients, Coefficients, GyroCoefficients

PLAN: Final = """procedure = "imu-discrete"
[imu]
scheme = "12"
turns = 2
dwell_s = 20.0
[settling]
hold_s = 1.0
[power]
current_hold_s = 3.0
warm_up_s = 5.0
"""

BENCH: Final = """kind = "simulated"
seed = 2603
[site]
latitude_deg = 39.9042
altitude_m = 50.0
[table]
wobble_arcsec = 1.0
tilt_east_arcsec = 3.0
tilt_north_arcsec = -2.0
north_misalignment_arcsec = 20.0
[fixture]
perpendicularity_arcsec = 2.0
[sensor.gyro]
scale_factor = [1.0023, 0.99815, 1.00072]
bias_dps = [0.0031, -0.0024, 0.0018]
misalignment_rad = [[0.0, 6.0e-4, -4.3e-4], [-2.7e-4, 0.0, 8.8e-4], [3.9e-4, -7.2e-4, 0.0]]
g_sensitivity = [[1e-4, 2e-5, -3e-5], [1.5e-5, -8e-5, 2e-5], [-1e-5, 3e-5, 9e-5]]
[sensor.gyro_noise]
angle_random_walk_deg_per_sqrt_h = 0.02
[sensor.accel]
scale_factor = [1.0011, 0.9987, 1.0005]
bias_mps2 = [0.02, -0.01, 0.03]
misalignment_rad = [[0.0, 5e-4, -3e-4], [2e-4, 0.0, 6e-4], [-4e-4, 1e-4, 0.0]]
[sensor.accel_noise]
velocity_random_walk_mps_per_sqrt_s = 0.0005
[operator]
mount_time_s = 5.0
"""

TRUTH: Final = Coefficients(
    GyroCoefficients(
        E1=np.array([1.0023, 0.99815, 1.00072]),
        B0=np.array([0.0031, -0.0024, 0.0018]),
        Bf=np.array([[1e-4, 2e-5, -3e-5], [1.5e-5, -8e-5, 2e-5], [-1e-5, 3e-5, 9e-5]]),
        E=np.array([[0.0, 6.0e-4, -4.3e-4], [-2.7e-4, 0.0, 8.8e-4], [3.9e-4, -7.2e-4, 0.0]]),
    ),
    AccelCoefficients(
        K1=np.array([1.0011, 0.9987, 1.0005]),
        K0=np.array([0.02, -0.01, 0.03]),
        K=np.array([[0.0, 5e-4, -3e-4], [2e-4, 0.0, 6e-4], [-4e-4, 1e-4, 0.0]]),
    ),
)
"""What :data:`BENCH` enters."""


def write(folder: Path, *, plan: str = PLAN, bench: str = BENCH) -> list[str]:
    """Plan and bench in ``folder``; the words of ``ahrs-lab run`` into ``folder/out``."""
    (folder / "plan.toml").write_text(plan, encoding="utf-8")
    (folder / "bench.toml").write_text(bench, encoding="utf-8")
    files = {name: str(folder / name) for name in ("plan.toml", "bench.toml", "out")}
    return ["run", files["plan.toml"], "--bench", files["bench.toml"], "--out", files["out"]]
