"""What the virtual bench is made of: every error has its number here, zero or a preset's.

All classes are frozen; :func:`simulation_from_toml` builds them from a bench file,
:meth:`SimulationSettings.ideal` has no error at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, cast

from ahrs_lab.errors import InputError
from ahrs_lab.inertial.sensor_model import ZERO, AccelModel, GyroModel, Vector
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.segment import AccelUnit, RateUnit
from ahrs_lab.simulation.faults import TRIP_ABOVE_DPS, FaultName

OutputGroup = Literal["rate", "increment", "angle", "attitude", "accel", "temperature"]


@dataclass(frozen=True)
class SiteSettings:
    """Where the bench stands: gives the Earth rate and gravity."""

    latitude_deg: float = 39.9042
    longitude_deg: float | None = 116.4074
    altitude_m: float = 50.0

    def __post_init__(self) -> None:
        _within("site.latitude_deg", self.latitude_deg, -90.0, 90.0)
        _within("site.altitude_m", self.altitude_m, -500.0, 9000.0)


@dataclass(frozen=True)
class TableSettings:
    """The single-axis rate table.

    ``rate_error`` relative, of the table's time base, for |Ω| below 1, below 10, from 10 °/s: the platform
    turns faster by it than the table reports. The encoder reads the true angle plus ``position_error_arcsec``
    × sin(harmonic·angle + phase), in steps of ``encoder_resolution_deg``. The axis leans from the vertical by
    a fixed tilt (about east and north) and by a cone of ``wobble_arcsec`` half-angle, run through
    ``wobble_harmonic`` times a turn. ``north_misalignment_arcsec`` is how far the platform really stands
    anticlockwise of north at ``north_deg``.
    """

    name: str = "single-axis rate table"
    max_rate_dps: float = 1000.0
    max_acceleration_dps2: float = 500.0
    rate_error: Vector = ZERO
    rate_noise_dps: float = 0.0
    position_error_arcsec: float = 0.0
    position_error_harmonic: int = 1
    position_error_phase_deg: float = 0.0
    encoder_resolution_deg: float = 0.0
    wobble_arcsec: float = 0.0
    wobble_harmonic: int = 1
    wobble_phase_deg: float = 0.0
    tilt_east_arcsec: float = 0.0
    tilt_north_arcsec: float = 0.0
    north_misalignment_arcsec: float = 0.0
    north_deg: float = 0.0
    log_rate_hz: float = 100.0

    def __post_init__(self) -> None:
        _within("table.max_rate_dps", self.max_rate_dps, 0.001, 10000.0)
        _within("table.max_acceleration_dps2", self.max_acceleration_dps2, 0.01, 1e6)
        _within("table.wobble_harmonic", self.wobble_harmonic, 1, 6)
        _within("table.position_error_harmonic", self.position_error_harmonic, 1, 720)
        _within("table.position_error_arcsec", self.position_error_arcsec, 0.0, 36000.0)
        _within("table.wobble_arcsec", self.wobble_arcsec, 0.0, 36000.0)
        _within("table.encoder_resolution_deg", self.encoder_resolution_deg, 0.0, 10.0)
        _within("table.rate_noise_dps", self.rate_noise_dps, 0.0, 10.0)
        _within("table.log_rate_hz", self.log_rate_hz, 1.0, 1000.0)
        for error in self.rate_error:
            _within("table.rate_error", error, -0.1, 0.1)


@dataclass(frozen=True)
class FixtureSettings:
    """The mounting cube. ``perpendicularity_arcsec``: standard deviation of the small angles, about each
    axis, by which each of its six faces is off, drawn once from the seed; ``repeatability_arcsec``: the same,
    drawn anew at each mounting. ``lever_arm_m``: where the accelerometers sit from the table's axis, in case
    axes."""

    perpendicularity_arcsec: float = 0.0
    repeatability_arcsec: float = 0.0
    lever_arm_m: Vector = ZERO

    def __post_init__(self) -> None:
        _within("fixture.perpendicularity_arcsec", self.perpendicularity_arcsec, 0.0, 36000.0)
        _within("fixture.repeatability_arcsec", self.repeatability_arcsec, 0.0, 36000.0)


@dataclass(frozen=True)
class GyroNoise:
    """IEEE 952 coefficients in the units of data sheets."""

    angle_random_walk_deg_per_sqrt_h: float = 0.0
    bias_instability_deg_per_h: float = 0.0
    rate_random_walk_deg_per_h_per_sqrt_h: float = 0.0
    quantisation_arcsec: float = 0.0


@dataclass(frozen=True)
class AccelNoise:
    """IEEE 952 coefficients in SI units (1 µg/√Hz = 9.80665×10⁻⁶ (m/s²)·√s)."""

    velocity_random_walk_mps_per_sqrt_s: float = 0.0
    bias_instability_mps2: float = 0.0
    acceleration_random_walk_mps2_per_sqrt_s: float = 0.0
    quantisation_mps: float = 0.0


@dataclass(frozen=True)
class Stability:
    """What changes from one power-on to the next, with time since, and with temperature, of one triad in its
    unit u (°/s or m/s²).

    ``turn_on``: standard deviation of the bias drawn at each power-on, u; ``start_up``: bias at power-on that
    decays with ``start_up_time_constant_s``, u; ``temperature``: polynomial without constant term, u/°C,
    u/°C² …, the same for each axis; ``scale_ppm_per_c``: scale factor; both count from
    ``reference_temperature_c``.
    """

    turn_on: float = 0.0
    start_up: Vector = ZERO
    start_up_time_constant_s: float = 300.0
    temperature: tuple[float, ...] = ()
    scale_ppm_per_c: Vector = ZERO
    reference_temperature_c: float = 25.0

    def __post_init__(self) -> None:
        _within("start_up_time_constant_s", self.start_up_time_constant_s, 1.0, 1e6)


@dataclass(frozen=True)
class AttitudeErrors:
    """Of an attitude output: constant offsets, noise of each sample, heading drift since power-on."""

    heading_offset_deg: float = 0.0
    pitch_offset_deg: float = 0.0
    roll_offset_deg: float = 0.0
    noise_deg: float = 0.0
    heading_drift_deg_per_h: float = 0.0


@dataclass(frozen=True)
class SensorSettings:
    """The inertial sensors inside the unit."""

    gyro: GyroModel = field(default_factory=GyroModel)
    gyro_noise: GyroNoise = field(default_factory=GyroNoise)
    gyro_stability: Stability = field(default_factory=Stability)
    accel: AccelModel = field(default_factory=AccelModel)
    accel_noise: AccelNoise = field(default_factory=AccelNoise)
    accel_stability: Stability = field(default_factory=Stability)
    attitude: AttitudeErrors = field(default_factory=AttitudeErrors)

    def __post_init__(self) -> None:
        _within("sensor.gyro.range_dps", self.gyro.range_dps, 0.001, 1e6)
        _within("sensor.accel.range_mps2", self.accel.range_mps2, 0.001, 1e6)
        for part, noise in (("gyro_noise", self.gyro_noise), ("accel_noise", self.accel_noise)):
            for key, value in vars(noise).items():
                _within(f"sensor.{part}.{key}", value, 0.0, 1e9)


@dataclass(frozen=True)
class DeviceSettings:
    """How the unit talks and what it is called.

    ``outputs``: "rate" (each sample rounded to ``gyro_lsb``, °/s) or "increment" (angle rounded to
    ``gyro_lsb``, degrees, what is left over carried on; written as mean rates), "angle" (accumulated),
    "attitude", "accel", "temperature". A step of 0 rounds nothing; units of "LSB" need one. ``latency_s``
    from the end of a sample's interval to its arrival; ``bunching_s``: the link hands samples over only at
    multiples of it.
    """

    name: str = "AHRS"
    manufacturer: str = "ahrs_lab"
    model: str = "virtual unit"
    serial_number: str = "SIM-0001"
    outputs: tuple[OutputGroup, ...] = ("rate", "accel", "temperature")
    rate_unit: RateUnit = "deg/s"
    accel_unit: AccelUnit = "m/s^2"
    sample_rate_hz: float = 100.0
    gyro_lsb: float = 0.0
    accel_lsb: float = 0.0
    latency_s: float = 0.0
    bunching_s: float = 0.0
    dropout_probability: float = 0.0
    boot_time_s: float = 0.0
    self_heating_c: float = 0.0
    thermal_time_constant_s: float = 600.0
    load_w: float = 1.8
    min_voltage_v: float = 9.0

    def __post_init__(self) -> None:
        _within("device.sample_rate_hz", self.sample_rate_hz, 1.0, 10000.0)
        _within("device.latency_s", self.latency_s, 0.0, 10.0)
        _within("device.bunching_s", self.bunching_s, 0.0, 10.0)
        _within("device.dropout_probability", self.dropout_probability, 0.0, 0.99)
        _within("device.boot_time_s", self.boot_time_s, 0.0, 600.0)
        _within("device.gyro_lsb", self.gyro_lsb, 0.0, 1e6)
        _within("device.accel_lsb", self.accel_lsb, 0.0, 1e6)
        _within("device.load_w", self.load_w, 0.0, 1000.0)
        _within("device.thermal_time_constant_s", self.thermal_time_constant_s, 1.0, 1e6)
        if not self.outputs:
            raise InputError("Setting “device.outputs” is empty: name at least one output of the unit.")
        if "rate" in self.outputs and "increment" in self.outputs:
            raise InputError("Setting “device.outputs” names both rate and increment: keep one of them.")
        for key, unit, step in (
            ("gyro_lsb", self.rate_unit, self.gyro_lsb),
            ("accel_lsb", self.accel_unit, self.accel_lsb),
        ):
            if unit == "LSB" and not step:
                raise InputError(
                    "A unit that shows counts needs a step: set “device.{key}” above 0.", key=key
                )


@dataclass(frozen=True)
class SupplySettings:
    """The DC supply. At switch-on the current is ``1 + inrush`` times its steady value and decays."""

    max_voltage_v: float = 30.0
    max_current_a: float = 5.0
    inrush: float = 0.0
    inrush_time_constant_s: float = 2.0
    voltage_noise_v: float = 0.0
    current_noise_a: float = 0.0

    def __post_init__(self) -> None:
        _within("supply.inrush_time_constant_s", self.inrush_time_constant_s, 0.001, 1000.0)
        _within("supply.inrush", self.inrush, 0.0, 100.0)


@dataclass(frozen=True)
class RoomSettings:
    """Room air: a mean, a slow swing of the air conditioning, noise of the reading."""

    temperature_c: float = 20.0
    temperature_swing_c: float = 0.0
    humidity_percent: float = 50.0
    humidity_swing_percent: float = 0.0
    swing_period_s: float = 2400.0
    temperature_noise_c: float = 0.0
    humidity_noise_percent: float = 0.0

    def __post_init__(self) -> None:
        _within("room.swing_period_s", self.swing_period_s, 1.0, 1e6)
        _within("room.humidity_percent", self.humidity_percent, 0.0, 100.0)


@dataclass(frozen=True)
class OperatorSettings:
    """The virtual person at the bench. ``first_orientation`` is how the case stands before anybody is
    asked. ``sets_table``: the table has no wire, this person sets it by hand."""

    mount_time_s: float = 30.0
    first_orientation: str = "ENU"
    sets_table: bool = False

    def __post_init__(self) -> None:
        Orientation(self.first_orientation)
        _within("operator.mount_time_s", self.mount_time_s, 0.0, 86400.0)


@dataclass(frozen=True)
class FaultSettings:
    """A fault that is set from the start: active from ``at_s`` to ``until_s`` of bench time."""

    name: FaultName
    at_s: float = 0.0
    until_s: float | None = None
    once: bool = False
    orientation: str = ""
    above_dps: float = TRIP_ABOVE_DPS

    def __post_init__(self) -> None:
        if self.orientation:
            Orientation(self.orientation)


@dataclass(frozen=True)
class SimulationSettings:
    """All of the virtual bench. ``start_utc`` is an ISO 8601 time with offset; empty: the computer's
    clock."""

    seed: int = 1
    start_utc: str = ""
    site: SiteSettings = field(default_factory=SiteSettings)
    table: TableSettings = field(default_factory=TableSettings)
    fixture: FixtureSettings = field(default_factory=FixtureSettings)
    sensor: SensorSettings = field(default_factory=SensorSettings)
    device: DeviceSettings = field(default_factory=DeviceSettings)
    supply: SupplySettings = field(default_factory=SupplySettings)
    room: RoomSettings = field(default_factory=RoomSettings)
    operator: OperatorSettings = field(default_factory=OperatorSettings)
    fault: tuple[FaultSettings, ...] = ()

    def __post_init__(self) -> None:
        _within("seed", self.seed, 0, 2**63)
        if self.start_utc:
            from ahrs_lab.simulation.clock import parse_utc

            parse_utc(self.start_utc)

    @classmethod
    def ideal(cls, **parts: Any) -> SimulationSettings:
        """No error anywhere (the operator still takes no time); ``parts`` replace whole parts or the seed."""
        return replace(cls(operator=OperatorSettings(mount_time_s=0.0)), **parts)


def simulation_from_toml(data: Mapping[str, Any]) -> SimulationSettings:
    """The settings of a bench file's tables.

    ``preset`` in ``[sensor]`` and ``[table]`` names where the numbers start from (see
    :mod:`ahrs_lab.simulation.presets`). Raises :class:`InputError` with the key for anything unknown or of
    the wrong type.
    """
    from ahrs_lab.simulation.presets import sensor_preset, table_preset
    from ahrs_lab.simulation.settings_toml import from_table

    tables = {key: dict(value) if isinstance(value, Mapping) else value for key, value in data.items()}
    bases: dict[str, Any] = {}
    for key, preset in (("sensor", sensor_preset), ("table", table_preset)):
        table = tables.get(key)
        if isinstance(table, dict) and "preset" in table:
            bases[key] = preset(table.pop("preset"))
    start = replace(SimulationSettings(), **bases)
    return cast(SimulationSettings, from_table(start, tables))


def _within(key: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(
            "Setting “{key}” of the virtual bench is {value}; it has to lie between {low} and {high}.",
            key=key,
            value=value,
            low=low,
            high=high,
        )
