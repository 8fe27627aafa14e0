"""The settings of a calibration, with the standard's or the textbook's values as default."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from ahrs_lab.recording.orientation import AXES, Axis

ProcedureName = Literal["jjf1536-2015", "imu-discrete"]
ItemName = Literal["scale_factor", "zero_offset", "misalignment"]
RateOrder = Literal["pairs", "ascending", "as_listed"]
Schedule = Literal["standard", "combined", "multi-position"]
MountingOrder = Literal["shortest", "standard"]
PositionScheme = Literal["6", "8", "12", "16", "20", "24", "own"]


@dataclass(frozen=True)
class ScaleFactorPlan:
    """7.1. 7 to 11 rates over the device's range, both senses."""

    rates_dps: tuple[float, ...] = (-300.0, -200.0, -100.0, -50.0, -10.0, 10.0, 50.0, 100.0, 200.0, 300.0)
    order: RateOrder = "pairs"
    dwell_s: float = 20.0
    """At least; lengthened to whole averaging angles (1°, 10°, 360° by band)."""
    static_s: float = 60.0


@dataclass(frozen=True)
class ZeroOffsetPlan:
    """7.2."""

    schedule: Schedule = "standard"
    duration_s: float = 1800.0
    """T of each position; the default of the multi-position schedule is 1200."""
    positions: int = 12
    """multi-position: equal steps of azimuth."""


@dataclass(frozen=True)
class MisalignmentPlan:
    """7.3."""

    rate_dps: float = 100.0
    turns: int = 10


@dataclass(frozen=True)
class ImuPlan:
    """Discrete calibration of an inertial measurement unit (textbook 2.6.3): whole turns forward and back
    about x, y, z, and positions at rest."""

    rate_dps: float = 100.0
    turns: int = 10
    scheme: PositionScheme = "12"
    """By :data:`ahrs_lab.metrology.imu_calibration.SCHEMES`, or ``own``: those of ``positions``."""
    positions: tuple[str, ...] = ()
    """Where x, y, z of the case point (``UEN``), and where wished how far the table is turned on from there
    (``UEN@30``: 30°, anticlockwise seen from above)."""
    dwell_s: float = 300.0
    """At each position."""


@dataclass(frozen=True)
class SettlingPlan:
    """When the table counts as steady, by what it reports."""

    rate_tolerance_relative: float = 1e-4
    rate_tolerance_dps: float = 0.001
    position_tolerance_deg: float = 0.002
    hold_s: float = 2.0
    timeout_s: float = 120.0
    pointing_rate_dps: float = 20.0

    def rate_tolerance(self, rate_dps: float) -> float:
        """The wider of the absolute and the relative tolerance at ``rate_dps``, °/s."""
        return max(self.rate_tolerance_dps, self.rate_tolerance_relative * abs(rate_dps))


@dataclass(frozen=True)
class PowerPlan:
    """The unit's supply. 7.1 has it off while the case is flipped; for 7.2 it is a setting."""

    voltage_v: float = 12.0
    current_limit_a: float = 1.0
    off_between_mountings: bool = True
    current_tolerance: float = 0.01
    current_hold_s: float = 10.0
    current_timeout_s: float = 300.0
    warm_up_s: float = 60.0


@dataclass(frozen=True)
class Plan:
    """All of a calibration."""

    name: str = "JJF 1536-2015"
    items: tuple[ItemName, ...] = ("scale_factor", "zero_offset", "misalignment")
    axes: tuple[Axis, ...] = AXES
    mounting_order: MountingOrder = "shortest"
    mounting_tolerance_deg: float = 3.0
    mounting_check_s: float = 2.0
    repeats: int = 1
    """How often each position and each pair of turns is recorded; where power is off between
    mountings, each repeat is a power-on of its own, so that it tells the turn-on repeatability."""
    scale_factor: ScaleFactorPlan = field(default_factory=ScaleFactorPlan)
    zero_offset: ZeroOffsetPlan = field(default_factory=ZeroOffsetPlan)
    misalignment: MisalignmentPlan = field(default_factory=MisalignmentPlan)
    settling: SettlingPlan = field(default_factory=SettlingPlan)
    power: PowerPlan = field(default_factory=PowerPlan)
    procedure: ProcedureName = "jjf1536-2015"
    imu: ImuPlan = field(default_factory=ImuPlan)


IMU_NAME = "IMU, discrete calibration"
"""What a plan of that procedure is called that has no name of its own."""

STANDARD_DURATION_S: dict[Schedule, float] = {
    "standard": 1800.0,
    "combined": 1800.0,
    "multi-position": 1200.0,
}
"""T by 7.2.1 (30 min) and 7.2.2 (20 min)."""
