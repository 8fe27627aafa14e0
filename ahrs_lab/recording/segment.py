"""What a recording is made of: who and where (header), and segments in the order they were recorded."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from ahrs_lab.recording.orientation import Axis, Orientation

Item = Literal["scale_factor", "zero_offset", "misalignment", "static", "rotation", "dynamic"]
Role = Literal["static_before", "rate", "static_after", "position", "turns"]
RateUnit = Literal["deg/s", "rad/s", "LSB"]
AccelUnit = Literal["m/s^2", "g", "LSB"]


@dataclass(frozen=True)
class Site:
    """Where the bench stands."""

    latitude_deg: float
    altitude_m: float = 0.0
    longitude_deg: float | None = None


@dataclass(frozen=True)
class DeviceDescription:
    """The unit under calibration as its recordings name it."""

    name: str = "AHRS"
    manufacturer: str = ""
    model: str = ""
    serial_number: str = ""
    rate_unit: RateUnit = "deg/s"
    accel_unit: AccelUnit = "m/s^2"
    sample_rate_hz: float = 100.0


@dataclass(frozen=True)
class Segment:
    """One recording: a file of samples and what was asked of the bench while it was made.

    ``rate_dps`` is the demanded table rate (0 at rest), ``turns`` signed, ``position`` counts from 1.
    ``superseded`` and ``reason`` tell of a repeated segment: both are kept, the last one counts.
    ``interrupted`` marks what a kill or an abort left: kept, never evaluated.
    ``extra`` carries keys this version does not know.
    """

    name: str
    orientation: Orientation
    item: Item
    axis: Axis
    role: Role
    rate_dps: float = 0.0
    position: int | None = None
    turns: int | None = None
    file: str = ""
    superseded: bool = False
    reason: str = ""
    interrupted: bool = False
    azimuth_deg: float | None = None
    started_utc: str = ""
    extra: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class RecordingHeader:
    """``recording.toml`` without its segments. ``notes`` holds what the run adds: plan, bench, order run,
    environment, people, deviations from the standard; unknown tables are carried there too."""

    procedure: str
    site: Site
    device: DeviceDescription
    initial: dict[str, Any] | None = None
    notes: dict[str, Any] = field(default_factory=dict)
