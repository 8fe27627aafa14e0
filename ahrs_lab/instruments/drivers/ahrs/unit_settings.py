"""Settings that every AHRS driver has: what is asked of the unit, and how its recordings name it."""

from __future__ import annotations

from dataclasses import dataclass

from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.settings import within
from ahrs_lab.recording.segment import AccelUnit, DeviceDescription, RateUnit


@dataclass(frozen=True)
class UnitSettings:
    """``rate_hz``: samples per second. ``range_dps``: the unit's rate range; larger values are damage of the
    line. ``boot_time_s``: how long it may be deaf after power-on."""

    link: LinkSettings
    name: str = "AHRS"
    manufacturer: str = ""
    model: str = ""
    serial_number: str = ""
    rate_hz: float = 100.0
    range_dps: float = 2000.0
    boot_time_s: float = 5.0

    def __post_init__(self) -> None:
        within("rate_hz", self.rate_hz, 0.5, 10_000.0)
        within("range_dps", self.range_dps, 0.001, 1e6)
        within("boot_time_s", self.boot_time_s, 0.0, 120.0)

    def description(
        self, rate_unit: RateUnit, accel_unit: AccelUnit, manufacturer: str = ""
    ) -> DeviceDescription:
        """As recordings name the unit."""
        return DeviceDescription(
            name=self.name,
            manufacturer=self.manufacturer or manufacturer,
            model=self.model,
            serial_number=self.serial_number,
            rate_unit=rate_unit,
            accel_unit=accel_unit,
            sample_rate_hz=self.rate_hz,
        )
