"""What a table is allowed to do, refused before it is sent. No replacement for the table's own limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.instruments.settings import within

_LARGEST_RATE_DPS = 10_000.0
_LARGEST_ACCELERATION_DPS2 = 1e6


@dataclass(frozen=True)
class SoftLimits:
    """Largest rate and acceleration; range of the unwrapped angle, infinite for a continuous axis."""

    max_rate_dps: float
    max_acceleration_dps2: float
    min_angle_deg: float = -math.inf
    max_angle_deg: float = math.inf

    def __post_init__(self) -> None:
        within("limits.max_rate_dps", self.max_rate_dps, 1e-6, _LARGEST_RATE_DPS)
        within("limits.max_acceleration_dps2", self.max_acceleration_dps2, 1e-3, _LARGEST_ACCELERATION_DPS2)
        if not self.min_angle_deg < self.max_angle_deg:
            raise InputError(
                "The table's angle may go from {low}° to {high}°: the first has to be the smaller one.",
                low=self.min_angle_deg,
                high=self.max_angle_deg,
            )

    @property
    def table_limits(self) -> TableLimits:
        """As procedures know them."""
        return TableLimits(self.max_rate_dps, self.max_acceleration_dps2)

    @property
    def continuous(self) -> bool:
        """Whether the axis may turn without end."""
        return math.isinf(self.min_angle_deg) and math.isinf(self.max_angle_deg)

    def check_rate(self, rate_dps: float) -> None:
        """Raises InputError; also for what is not a number."""
        if not abs(rate_dps) <= self.max_rate_dps:
            raise InputError(
                "The rate table may not turn at {rate_dps} °/s: its limit is set to {limit_dps} °/s.",
                rate_dps=rate_dps,
                limit_dps=self.max_rate_dps,
            )

    def check_acceleration(self, acceleration_dps2: float) -> None:
        """Raises InputError."""
        if not 0.0 < acceleration_dps2 <= self.max_acceleration_dps2:
            raise InputError(
                "The rate table may not accelerate with {acceleration_dps2} °/s²: its limit is set to "
                "{limit_dps2} °/s².",
                acceleration_dps2=acceleration_dps2,
                limit_dps2=self.max_acceleration_dps2,
            )

    def check_angle(self, angle_deg: float) -> None:
        """Raises InputError; also for what is not a finite number."""
        if not math.isfinite(angle_deg) or not self.min_angle_deg <= angle_deg <= self.max_angle_deg:
            raise InputError(
                "The rate table may not go to {angle_deg}°: its range is set to {low}° … {high}°.",
                angle_deg=angle_deg,
                low=self.min_angle_deg,
                high=self.max_angle_deg,
            )

    def check_move(self, angle_deg: float, rate_dps: float) -> None:
        """Raises InputError for a move to an angle with a rate above 0."""
        self.check_angle(angle_deg)
        if not rate_dps > 0.0:
            raise InputError(
                "The table cannot move at {rate_dps} °/s: give a rate above 0.", rate_dps=rate_dps
            )
        self.check_rate(rate_dps)

    def must_stop(self, angle_deg: float, rate_dps: float, delay_s: float) -> bool:
        """Whether a table at this angle and rate, told to stop ``delay_s`` from now, would leave its
        range."""
        if self.continuous:
            return False
        distance = abs(rate_dps) * delay_s + rate_dps**2 / (2.0 * self.max_acceleration_dps2)
        if rate_dps > 0.0:
            return angle_deg + distance > self.max_angle_deg
        return rate_dps < 0.0 and angle_deg - distance < self.min_angle_deg
