"""A result of a discrete IMU calibration with coefficients and uncertainties chosen by hand."""

from __future__ import annotations

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import (
    SCHEMES,
    AccelCoefficients,
    Coefficients,
    GyroCoefficients,
    ImuCalibration,
    Quality,
)
from ahrs_lab.metrology.imu_result import ImuDwell, ImuResult, ImuTurns
from ahrs_lab.metrology.result import Environment, ResultWarning
from tests.certificates.conftest import BUNDLE_SHA256

COEFFICIENTS = Coefficients(
    GyroCoefficients(
        E1=np.array([1.0023354972, 0.9981303779, 1.0007446458]),
        B0=np.array([3.087392e-3, -2.350023e-3, 1.805527e-3]),
        Bf=np.array([[1.234e-4, 2.01e-5, -3.3e-5], [1.5e-5, -8.76e-5, 2e-5], [-1e-5, 3e-5, 9.1e-5]]),
        E=np.array([[0.0, 6.02e-4, -4.28e-4], [-2.68e-4, 0.0, 8.78e-4], [3.91e-4, -7.19e-4, 0.0]]),
    ),
    AccelCoefficients(
        K1=np.array([1.00112, 0.99871, 1.00053]),
        K0=np.array([0.0197, -0.0103, 0.0301]),
        K=np.array([[0.0, 5.01e-4, -3.02e-4], [2.03e-4, 0.0, 6.04e-4], [-4.05e-4, 1.06e-4, 0.0]]),
    ),
)


def _spread(gyro: tuple[float, ...], accel: tuple[float, ...]) -> Coefficients:
    off = np.ones((3, 3)) - np.eye(3)
    return Coefficients(
        GyroCoefficients(np.full(3, gyro[0]), np.full(3, gyro[1]), np.full((3, 3), gyro[2]), off * gyro[3]),
        AccelCoefficients(np.full(3, accel[0]), np.full(3, accel[1]), off * accel[2]),
    )


def sample_imu_result() -> ImuResult:
    """Twelve positions; u of the noise 3 and of the bench 4 units each, so that u_c is 5."""
    letters = SCHEMES["12"]
    names = tuple(f"pos_{n:02d} ({one})" for n, one in enumerate(letters, 1))
    swing = np.sin(np.arange(36.0)).reshape(12, 3)
    quality = Quality(
        standard_uncertainty=_spread((3e-5, 3e-4, 3e-6, 3e-6), (3e-5, 3e-4, 3e-5)),
        gyro_covariance=np.tile(np.eye(7) * 9e-10, (3, 1, 1)),
        accel_covariance=np.tile(np.eye(4) * 9e-10, (3, 1, 1)),
        gyro_condition=3.0**0.5,
        accel_condition=3.0**0.5,
        turns_condition=1.0,
        gyro_residuals=swing * 1e-4,
        accel_residuals=swing[::-1] * 1e-3,
        positions=names,
        bench=_spread((4e-5, 4e-4, 4e-6, 4e-6), (4e-5, 4e-4, 4e-5)),
        bench_figures={"azimuth_arcsec": 30.0, "level_arcsec": 10.0, "timing_relative": 5e-7},
    )
    return ImuResult(
        procedure="imu-discrete",
        bundle_sha256=BUNDLE_SHA256,
        software="ahrs-lab 0.1.0",
        calibration=ImuCalibration(
            COEFFICIENTS, "deg/s", "m/s^2", quality, (), {"gravity_mps2": 9.80146, "scheme": "12"}
        ),
        dwells=tuple(
            ImuDwell(name, one, 0.0, 300.0, (0.0115, -0.0021, 0.003), (9.81, -0.01, 0.02))
            for name, one in zip(names, letters, strict=True)
        ),
        turns=tuple(
            ImuTurns(f"rot_{a}_{s}", o, t, 10.0 * t, 41.0, 360.0 * t, (360.8 * t, 0.2, -0.1))
            for a, o in (("x", "UEN"), ("y", "NUE"), ("z", "ENU"))
            for s, t in (("pos", 10), ("neg", -10))
        ),
        warnings=(ResultWarning(Message("The unit was warm"), "pos_03", 3),),
        deviations=(Message("The dwell is shorter"),),
        environment=Environment(20.3, 0.37, 47.0, 2.6),
        device={"serial_number": "0100012345", "sample_rate_hz": 100.0, "model": "VN-100"},
        site={"latitude_deg": 39.9042, "altitude_m": 50.0},
        notes={
            "order_run": ["rot_x_pos", "pos_09"],
            "plan": {"procedure": "imu-discrete", "imu": {"turns": 10}},
        },
    )
