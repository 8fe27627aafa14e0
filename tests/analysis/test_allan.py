"""The Allan deviation of recordings: good ones, short ones, gappy ones, wrong ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.analysis.allan import AllanResult, Taus, analyse_allan, longest_at_rest
from ahrs_lab.analysis.allan_report import allan_report, with_uncertainty
from ahrs_lab.analysis.inertial_record import InertialRecord, records
from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.recording.read import read_bundle
from tests.analysis.recorded import columns, write_bundle

Array = NDArray[np.float64]
STATIC = 'orientation = "ENU"\nitem = "static"'
WHITE = 0.2 / 60.0
"""0.2 °/√h in °/√s."""


def _noise(count: int, rate_hz: float = 10.0, seed: int = 1) -> tuple[Array, Array, Array]:
    """Times, rates in °/s, specific forces in m/s²."""
    rng = np.random.default_rng(seed)
    gyro = rng.normal(0.0, WHITE * np.sqrt(rate_hz), (count, 3))
    accel = rng.normal(0.0, 1e-3 * np.sqrt(rate_hz), (count, 3)) + np.array([0.0, 0.0, 9.8015])
    return np.arange(1, count + 1) / rate_hz, gyro, accel


def _record(
    folder: Path, t_s: Array, gyro: Array, accel: Array | None = None, **units: str
) -> InertialRecord:
    segments = {"a.csv": (columns(t_s, gyro, accel), STATIC)}
    (record,) = records(read_bundle(write_bundle(folder, segments, **units)))  # type: ignore[arg-type]
    return record


def test_coefficients_come_in_the_units_of_their_names(tmp_path: Path) -> None:
    result = analyse_allan(_record(tmp_path, *_noise(20_000)))
    data = result.to_json()
    assert list(data) == ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"]
    for axis in "xyz":
        gyro, accel = data[f"gyro_{axis}"], data[f"accel_{axis}"]
        assert gyro["angle_random_walk_deg_per_sqrt_h"] == pytest.approx(0.2, rel=0.02)
        assert accel["velocity_random_walk_mps_per_sqrt_s"] == pytest.approx(1e-3, rel=0.02)
        assert gyro["bias_instability_deg_per_h"] == gyro["quantisation_arcsec"] == 0.0
        assert gyro["rate_random_walk_deg_per_h_per_sqrt_h"] == 0.0
        assert gyro["upper_limit"]["angle_random_walk_deg_per_sqrt_h"] is None
        assert gyro["upper_limit"]["bias_instability_deg_per_h"] > 0.0
        assert gyro["standard_uncertainty"]["angle_random_walk_deg_per_sqrt_h"] < 0.004
        tau, deviation = np.array(gyro["tau_s"]), np.array(gyro["oadev"])
        np.testing.assert_allclose(tau, 0.1 * 2.0 ** np.arange(14))
        assert deviation[0] == pytest.approx(WHITE / np.sqrt(0.1), rel=0.02)
        assert np.all(np.array(gyro["oadev_low"]) < deviation)
        assert np.all(np.array(gyro["oadev_high"]) > deviation)


@pytest.mark.parametrize(("unit", "factor"), [("rad/s", np.pi / 180.0), ("LSB", 5000.0)])
def test_the_deviation_stays_in_the_channels_own_unit(tmp_path: Path, unit: str, factor: float) -> None:
    t_s, gyro, accel = _noise(4000)
    result = analyse_allan(_record(tmp_path, t_s, gyro * factor, accel, rate_unit=unit))
    found = result.to_json()["gyro_x"]
    assert found["unit"] == unit
    assert found["oadev"][0] == pytest.approx(WHITE / np.sqrt(0.1) * factor, rel=0.05)
    assert found["own_unit"]["white"] == pytest.approx(WHITE * factor, rel=0.05)
    if unit == "LSB":
        assert found["angle_random_walk_deg_per_sqrt_h"] is None
        assert "LSB·√s" in report_text(allan_report(result))
    else:
        assert found["angle_random_walk_deg_per_sqrt_h"] == pytest.approx(0.2, rel=0.05)


def test_each_coefficient_is_turned_into_its_unit(tmp_path: Path) -> None:
    """1 °/h/√h, 1″ and 1 °/h/h, by hand."""
    rng = np.random.default_rng(2)
    count, hour = 40_000, 3600.0
    walk = np.cumsum(rng.normal(0.0, 100.0 / hour / np.sqrt(hour) * np.sqrt(0.1), count))
    angle = np.diff(rng.normal(0.0, 1.0 / 3600.0, count + 1)) / 0.1
    ramp = 1000.0 / hour / hour * 0.1 * np.arange(count) + rng.normal(0.0, 1e-6, count)
    record = _record(tmp_path, np.arange(1, count + 1) / 10.0, np.column_stack([walk, angle, ramp]))
    found = analyse_allan(record).to_json()
    assert found["gyro_x"]["rate_random_walk_deg_per_h_per_sqrt_h"] == pytest.approx(100.0, rel=0.03)
    assert found["gyro_y"]["quantisation_arcsec"] == pytest.approx(1.0, rel=0.03)
    assert found["gyro_z"]["rate_ramp_deg_per_h_per_h"] == pytest.approx(1000.0, rel=0.01)


def test_own_averaging_times_are_shown_and_the_fit_does_not_depend_on_them(tmp_path: Path) -> None:
    record = _record(tmp_path, *_noise(5000))
    own, octaves = analyse_allan(record, [100.0, 1.0, 10.0, 1e6]), analyse_allan(record)
    np.testing.assert_allclose(own.channels[0].tau_s, [1.0, 10.0, 100.0])
    assert own.to_json()["gyro_y"]["own_unit"] == octaves.to_json()["gyro_y"]["own_unit"]
    assert any("1e+06 s" in str(warning) for warning in own.warnings)
    assert len(analyse_allan(record, "all").channels[0].tau_s) > 250


@pytest.mark.parametrize(
    ("taus", "says"), [([0.0], "above 0"), ([np.nan], "above 0"), ([1e4], "0.1 s to 250 s")]
)
def test_averaging_times_that_cannot_be_are_refused(tmp_path: Path, taus: Taus, says: str) -> None:
    with pytest.raises(InputError, match=says):
        analyse_allan(_record(tmp_path, *_noise(5000)), taus)


@pytest.mark.parametrize("count", range(2, 12))
def test_short_records_give_what_they_can(tmp_path: Path, count: int) -> None:
    result = analyse_allan(_record(tmp_path, *_noise(count, seed=count)))
    for channel in result.channels:
        assert len(channel.tau_s) == (count // 2).bit_length()
        assert np.all(channel.low < channel.deviation)
        assert np.all(channel.deviation < channel.high)
    assert "Noise of the gyros" in report_text(allan_report(result))


def test_one_sample_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a\.csv has 1 usable samples"):
        analyse_allan(_record(tmp_path, *_noise(1)))


def test_values_that_never_change_are_told(tmp_path: Path) -> None:
    t_s, gyro, _ = _noise(100)
    result = analyse_allan(_record(tmp_path, t_s, np.zeros_like(gyro)))
    assert [str(warning) for warning in result.warnings][-1].startswith("gyro_z: the values do not change")
    assert result.to_json()["gyro_x"]["oadev"] == [0.0] * 6
    assert "–" in report_text(allan_report(result))


def test_gaps_and_lost_samples_are_counted_and_bridged_where_they_are_small(tmp_path: Path) -> None:
    t_s, gyro, accel = _noise(30_000)
    kept = np.random.default_rng(3).random(30_000) > 0.002
    kept[12_000:13_000] = False
    result = analyse_allan(_record(tmp_path, t_s[kept], gyro[kept], accel[kept]))
    assert result.missing == np.count_nonzero(~kept[np.flatnonzero(kept)[0] : np.flatnonzero(kept)[-1] + 1])
    data = result.to_json()["gyro_x"]
    assert data["missing"] == result.missing
    assert data["tau_s"][-1] >= 400.0
    assert data["angle_random_walk_deg_per_sqrt_h"] == pytest.approx(0.2, rel=0.03)
    assert "samples are missing" in report_text(allan_report(result))


def test_the_device_clock_counts_not_the_header(tmp_path: Path) -> None:
    t_s, gyro, accel = _noise(3000)
    result = analyse_allan(_record(tmp_path, t_s * 1.004, gyro, accel))
    assert result.missing == 0
    assert result.channels[0].tau_s[0] == pytest.approx(0.1004)


def test_motion_is_told(tmp_path: Path) -> None:
    t_s, gyro, accel = _noise(1000)
    record = _record(tmp_path, t_s, gyro, accel)
    moved = replace(record, segment=replace(record.segment, item="dynamic"))
    assert any("not a recording at rest" in str(warning) for warning in analyse_allan(moved).warnings)


def test_a_disturbance_that_is_no_noise_is_told(tmp_path: Path) -> None:
    t_s, gyro, accel = _noise(20_000)
    gyro = gyro + 0.05 * np.sin(2.0 * np.pi * t_s / 200.0)[:, np.newaxis]
    result = analyse_allan(_record(tmp_path, t_s, gyro, accel))
    assert any("do not describe" in str(warning) for warning in result.warnings)


def test_the_longest_segment_at_rest_is_taken(tmp_path: Path) -> None:
    turning = 'orientation = "ENU"\nitem = "rotation"\naxis = "z"\nrole = "turns"\nturns = 2'
    segments = {
        "short.csv": (columns(*_noise(50)), STATIC),
        "long.csv": (columns(*_noise(200)), STATIC),
        "turns.csv": (columns(*_noise(400)), turning),
    }
    found = records(read_bundle(write_bundle(tmp_path, segments)))
    assert longest_at_rest(found).segment.file == "long.csv"
    with pytest.raises(InputError, match=r"no segment at rest.*turns\.csv"):
        longest_at_rest(found[2:])


def test_the_report_says_how_long_to_average(tmp_path: Path) -> None:
    """White noise of 0.2 °/√h and a random walk of 100 °/h/√h meet where N²/τ = K²τ/3."""
    t_s, gyro, accel = _noise(40_000)
    walk = np.random.default_rng(9).normal(0.0, 100.0 / 216_000.0 * np.sqrt(0.1), gyro.shape)
    result = analyse_allan(_record(tmp_path, t_s, gyro + np.cumsum(walk, axis=0), accel))
    text = report_text(allan_report(result))
    meet = np.sqrt(3.0) * WHITE / (100.0 / 216_000.0)
    assert meet == pytest.approx(12.5, abs=0.1)
    assert "gyro_x, gyro_y, gyro_z: averages beyond about 10 s gain nothing more" in text
    assert "accel_x, accel_y, accel_z: averaging still helps at 1640 s" in text


def test_the_chart_has_bands_and_fits_on_logarithmic_axes(tmp_path: Path) -> None:
    result: AllanResult = analyse_allan(_record(tmp_path, *_noise(4000)))
    report = allan_report(result)
    gyros, accels = report.charts
    assert (gyros.log_x, gyros.log_y) == (True, True)
    assert [curve.style for curve in gyros.curves] == ["line", "dashed"] * 3
    assert [curve.axis for curve in accels.curves] == ["x", "x", "y", "y", "z", "z"]
    # in °/h
    assert gyros.curves[0].y[0] == pytest.approx(3600.0 * result.channels[0].deviation[0])
    assert gyros.curves[0].low is not None
    for language in ("en", "zh"):
        assert "gyro_x" in report_text(report, language)


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (0.15042, 0.00137, "0.1504 ± 0.0014"),
        (1234.5, 67.8, "1234 ± 68"),
        (123.45, 1.26, "123.5 ± 1.3"),
        (6.39e-9, 5.9e-11, "(6.390 ± 0.059)e-09"),
        (0.5, np.nan, "0.5"),
    ],
)
def test_values_are_rounded_to_their_uncertainty(value: float, uncertainty: float, text: str) -> None:
    assert with_uncertainty(value, uncertainty) == text
