"""The result of a discrete IMU calibration on the bench: the calibration set, and what it was made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import Coefficients, ImuCalibration
from ahrs_lab.metrology.result import Environment, ResultWarning

PROCEDURE = "imu-discrete"


@dataclass(frozen=True)
class ImuDwell:
    """A position at rest: where x, y, z of the case pointed (nearest quarter turn), how far the table was
    turned on from there, for how long it was recorded, and the mean outputs in the unit's own units."""

    name: str
    orientation: str
    beyond_deg: float
    duration_s: float
    gyro: tuple[float, ...]
    accel: tuple[float, ...]


@dataclass(frozen=True)
class ImuTurns:
    """Whole turns, signed, of the table about up, with the case standing like ``orientation``: ``turned_deg``
    is the table's angle, ``angle`` the gyros' output summed over ``duration_s`` (rate unit times s)."""

    name: str
    orientation: str
    turns: int
    rate_dps: float
    duration_s: float
    turned_deg: float
    angle: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class ImuResult:
    """All of one calibration; see :class:`~ahrs_lab.metrology.result.CalibrationResult` for what both have.

    ``warnings`` are those of the recording and those of ``calibration``.
    """

    procedure: str
    bundle_sha256: str
    software: str
    calibration: ImuCalibration
    dwells: tuple[ImuDwell, ...] = ()
    turns: tuple[ImuTurns, ...] = ()
    warnings: tuple[ResultWarning, ...] = ()
    deviations: tuple[Message, ...] = ()
    environment: Environment | None = None
    device: Mapping[str, Any] = field(default_factory=dict)
    site: Mapping[str, Any] = field(default_factory=dict)
    notes: Mapping[str, Any] = field(default_factory=dict)
    simulated: bool = False

    @property
    def combined(self) -> Coefficients | None:
        """Combined standard uncertainties: of the recording's noise and drift, and of the bench where its
        figures were asked for; None for a set that comes without."""
        quality = self.calibration.quality
        if quality is None:
            return None
        gyro, accel = quality.standard_uncertainty.vectors()
        if quality.bench is not None:
            of_bench = quality.bench.vectors()
            gyro, accel = np.hypot(gyro, of_bench[0]), np.hypot(accel, of_bench[1])
        return Coefficients.from_vectors(gyro, accel)
