"""Bench files: what is known is taken, what is not is named."""

from __future__ import annotations

import tomllib
from dataclasses import fields, is_dataclass
from typing import Any

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.resource_files import resource_path
from ahrs_lab.simulation.bench import build_bench, world_of
from ahrs_lab.simulation.presets import GRADES, TABLES, demonstration, sensor_preset
from ahrs_lab.simulation.settings import SimulationSettings, simulation_from_toml

_BENCHES = [
    path
    for path in sorted(resource_path("benches").glob("*.toml"))
    if not path.stem.endswith("-linked")  # benches of drivers, which need somebody to serve them
]


def _read(text: str) -> SimulationSettings:
    return simulation_from_toml(tomllib.loads(text))


def test_nothing_given_is_a_bench_without_errors() -> None:
    assert _read("") == SimulationSettings()
    assert _error_terms(SimulationSettings.ideal()) == []


def _error_terms(settings: Any, path: str = "") -> list[str]:
    """Names of settings that put an error into the world."""
    harmless = {
        "seed", "latitude_deg", "longitude_deg", "altitude_m", "max_rate_dps", "max_acceleration_dps2",
        "position_error_harmonic", "wobble_harmonic", "log_rate_hz", "scale_factor", "nonlinearity_rate_dps",
        "range_dps", "range_mps2", "start_up_time_constant_s", "reference_temperature_c", "sample_rate_hz",
        "thermal_time_constant_s", "load_w", "min_voltage_v", "max_voltage_v", "max_current_a",
        "inrush_time_constant_s", "temperature_c", "humidity_percent", "swing_period_s",
    }  # fmt: skip
    found = []
    for field in fields(settings):
        value = getattr(settings, field.name)
        if is_dataclass(value):
            found += _error_terms(value, path + field.name + ".")
        elif field.name not in harmless and not isinstance(value, str) and any(_numbers(value)):
            found.append(path + field.name)
    return found


def _numbers(value: Any) -> list[float]:
    if isinstance(value, tuple):
        return [number for item in value for number in _numbers(item)]
    return [value] if isinstance(value, (int, float)) else []


def test_tables_within_tables_and_presets_with_changes() -> None:
    settings = _read(
        """
        seed = 9
        [site]
        latitude_deg = 30
        [table]
        preset = "standard"
        max_rate_dps = 300
        [sensor]
        preset = "tactical-mems"
        [sensor.gyro]
        scale_factor = [1.1, 1, 0.9]
        [device]
        outputs = ["increment", "accel"]
        [[fault]]
        name = "table_trips"
        at_s = 100
        """
    )
    assert settings.seed == 9
    assert settings.site.latitude_deg == 30.0
    assert settings.table.max_rate_dps == 300.0
    assert settings.table.wobble_arcsec == TABLES["standard"].wobble_arcsec
    assert settings.sensor.gyro.scale_factor == (1.1, 1.0, 0.9)
    assert settings.sensor.gyro_noise.angle_random_walk_deg_per_sqrt_h == 0.15
    assert settings.device.outputs == ("increment", "accel")
    assert settings.fault[0].name == "table_trips"
    fault = world_of(build_bench(settings)).faults.get("table_trips")
    assert fault is not None
    assert fault.at_s == 100.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[table]\nmax_rate = 5", "“table.max_rate” is not a setting.*did you mean “max_rate_dps”"),
        ("colour = 5", "“colour” is not a setting.*known here are: seed"),
        ("table = 5", "“table” .* has to be a table, not “5”"),
        ('seed = "x"', "“seed” .* has to be a whole number, not “x”"),
        ("seed = true", "“seed” .* has to be a whole number"),
        ("seed = 1.5", "“seed” .* has to be a whole number"),
        ("[site]\nlatitude_deg = 95", "“site.latitude_deg” .* between -90.0 and 90.0"),
        ("[site]\nlatitude_deg = nan", "“site.latitude_deg” .* finite"),
        ("[site]\nlatitude_deg = true", "has to be a number"),
        ("[sensor.gyro]\nscale_factor = [1, 2]", "“sensor.gyro.scale_factor” .* has 2 entries; it needs 3"),
        ("[sensor.gyro]\nscale_factor = 1", "“sensor.gyro.scale_factor” .* has to be a list"),
        ('[sensor.gyro]\nscale_factor = [1, 2, "a"]', r"scale_factor\[2\]” .* has to be a number"),
        ("[sensor.gyro]\nmisalignment_rad = [[0,1],[0,1],[0,1]]", r"misalignment_rad\[0\]” .* needs 3"),
        ('[sensor]\npreset = "gold"', "“gold” is not a preset.*sensor.*tactical-mems"),
        ('[table]\npreset = "gold"', "“gold” is not a preset.*table.*standard"),
        ('[device]\noutputs = ["speed"]', "“speed”; it has to be one of rate, increment"),
        ("[device]\noutputs = []", "is empty"),
        ('[device]\noutputs = ["rate", "increment"]', "keep one"),
        ('[device]\nrate_unit = "LSB"', "device.gyro_lsb"),
        ('[device]\nrate_unit = "rpm"', "has to be one of deg/s, rad/s, LSB"),
        ("[device]\nsample_rate_hz = 0", "“device.sample_rate_hz”"),
        ('[[fault]]\nname = "meteor"', "“meteor”; it has to be one of table_trips"),
        ("[[fault]]\nat_s = 3", "has no name"),
        ('[[fault]]\nname = "table_trips"\nwhen = 3', r"“fault\[0\].when” is not a setting"),
        ('[operator]\nfirst_orientation = "XYZ"', "not an orientation"),
        ('start_utc = "now"', "not a date"),
    ],
)
def test_what_is_wrong_is_named(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        _read(text)


@pytest.mark.parametrize("path", _BENCHES, ids=lambda path: path.stem)
def test_the_benches_that_come_along_can_be_built(path: Any) -> None:
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    if data.pop("kind") != "simulated":
        pytest.skip("a bench of instruments: built where links are tested")
    assert build_bench(simulation_from_toml(data)).simulated


def test_the_demonstration_is_one_of_them() -> None:
    assert "demo" in [path.stem for path in _BENCHES]
    assert demonstration().sensor.gyro.scale_factor == (1.0023, 0.99815, 1.00072)


@pytest.mark.parametrize("name", GRADES)
def test_a_grade_keeps_what_its_line_says(name: str) -> None:
    grade, sensor = GRADES[name], sensor_preset(name)
    assert max(abs(k - 1.0) for k in sensor.gyro.scale_factor) == pytest.approx(grade.scale)
    largest = max(abs(e) for row in sensor.gyro.misalignment_rad for e in row)
    assert largest == pytest.approx(grade.misalignment)
    assert sensor.gyro_noise.bias_instability_deg_per_h == grade.instability
    assert sensor.gyro_stability.turn_on == pytest.approx(grade.turn_on / 3600.0)
    assert sensor.accel_stability.turn_on == grade.accel_turn_on
    assert sensor.accel_noise.bias_instability_mps2 == grade.accel_instability


@pytest.mark.parametrize(
    ("name", "drift_deg_per_h", "nonlinearity", "range_dps"),
    [
        ("strategic", 0.0015, 1e-6, 100.0),
        ("navigation-rlg", 0.015, 1e-5, 400.0),
        ("vibratory", None, 1e-3, 50.0),
    ],
)
def test_grades_are_those_of_table_2_1(
    name: str, drift_deg_per_h: float | None, nonlinearity: float, range_dps: float
) -> None:
    grade = GRADES[name]
    assert grade.instability > 0.5 if drift_deg_per_h is None else grade.instability < drift_deg_per_h
    assert grade.nonlinearity < nonlinearity
    assert grade.range_dps >= range_dps
