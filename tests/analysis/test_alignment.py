"""Self-alignment of recordings: right, honest, and refused where it cannot be."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import chi2

from ahrs_lab.analysis.alignment import (
    METHODS,
    Alignment,
    AlignmentSettings,
    Method,
    align,
)
from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.recording.samples import Samples
from tests.analysis.unit_at_rest import ATTITUDE, Disturbance, record, record_of, samples

Array = NDArray[np.float64]


def errors(found: Alignment, truth: tuple[float, float, float] = ATTITUDE) -> Array:
    return np.asarray((found.attitude.angles_deg - np.array(truth) + 180.0) % 360.0 - 180.0)


def warned(found: Alignment, words: str) -> bool:
    return any(words in warning.text() for warning in found.warnings)


@pytest.mark.parametrize("method", METHODS)
def test_the_attitude_is_found_within_its_uncertainty(method: Method) -> None:
    gyro, accel = np.array([0.02, -0.03, 0.04]), np.array([8e-4, -5e-4, 6e-4])
    found = align(
        record(duration_s=300.0, gyro_bias_deg_per_h=gyro, accel_bias_mps2=accel), AlignmentSettings(method)
    )
    u = found.attitude.uncertainty_deg
    assert np.all(np.abs(errors(found)) < 2.5 * u)
    # (2-104) with the assumed biases; noise adds little
    assert u[1:] == pytest.approx(np.degrees([1e-3 / 9.802] * 2), rel=0.02)
    assert u[0] == pytest.approx(np.degrees(0.03 / (15.041 * np.cos(np.radians(40.0)))), rel=0.1)
    assert not found.warnings
    if found.biases is None:
        assert method in ("coarse", "fine")
    else:
        seen = found.biases
        for value, sigma, true in (
            (seen.gyro_deg_per_h, seen.gyro_uncertainty_deg_per_h, gyro),
            (seen.accel_mps2, seen.accel_uncertainty_mps2, accel),
        ):
            assert np.all(np.abs(value - true) < 2.5 * sigma)
        # up shows: the rate's and the force's excess; level accelerometers do not
        assert seen.gyro_uncertainty_deg_per_h[2] < 0.015
        assert seen.accel_mps2[2] == pytest.approx(6e-4 * 0.8, rel=0.15)
        assert seen.accel_uncertainty_mps2[:2] == pytest.approx([1e-3, 1e-3], rel=0.02)


def test_over_many_units_the_stated_uncertainty_is_the_error() -> None:
    """Noise estimated from each recording, biases drawn from the assumption: headings, pitches, rolls."""
    rng = np.random.default_rng(11)
    runs = 100
    scaled = []
    for run in range(runs):
        rows = samples(
            duration_s=64.0,
            gyro_bias_deg_per_h=0.03 * rng.standard_normal(3),
            accel_bias_mps2=1e-3 * rng.standard_normal(3),
            seed=run,
            rate_hz=2.0,
        )
        found = align(record_of(rows, rate_hz=2.0), AlignmentSettings("fine"))
        scaled.append(errors(found) / found.attitude.uncertainty_deg)
    low, high = (float(chi2.ppf(q, runs)) / runs for q in (0.0025, 0.9975))
    for mean_square in np.mean(np.square(scaled), axis=0):
        assert low < mean_square < high


@pytest.mark.parametrize("method", METHODS)
def test_json_has_the_keys_people_script_against(method: Method) -> None:
    data = align(record(), AlignmentSettings(method)).to_json()
    assert list(data) == [
        "heading_deg",
        "pitch_deg",
        "roll_deg",
        "standard_uncertainty_deg",
        "gyro_bias_deg_per_h",
        "accel_bias_mps2",
    ]
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    biases = data["gyro_bias_deg_per_h"] + data["accel_bias_mps2"]
    if method.startswith("kalman"):
        assert all(isinstance(bias, float) for bias in biases)
    else:
        assert biases == [None] * 6


@pytest.mark.parametrize("method", METHODS)
def test_the_report_speaks_both_languages_and_draws_the_course(method: Method) -> None:
    found = align(record(), AlignmentSettings(method))
    report = found.report()
    assert "Heading, °" in report_text(report)
    assert "自对准" in report_text(report, "zh")
    assert len(report.charts) == {"coarse": 0, "fine": 3}.get(method, 5)
    for chart in report.charts:
        for curve in chart.curves:
            assert curve.low is not None
            assert curve.high is not None
            assert np.all(np.isfinite([curve.low, curve.y, curve.high]))
            assert np.all(curve.low <= curve.high)
    if report.charts:
        heading = report.charts[0].curves[0]
        assert heading.y[-1] == pytest.approx(found.attitude.angles_deg[0], abs=0.02)
        lengths = {len(column) for column in found.series().values()}
        assert lengths == {len(heading.x)}


def test_uncertainty_shrinks_with_time_to_the_limit() -> None:
    found = align(record(duration_s=600.0), AlignmentSettings("kalman-open"))
    assert found.course is not None
    heading = found.course.uncertainty_deg[:, 0]
    assert heading[0] > 1.02 * heading[-1]
    assert heading[-1] > np.degrees(0.03 / (15.041 * np.cos(np.radians(40.0))))


def test_heading_near_north_is_charted_without_a_jump() -> None:
    found = align(record(attitude=(0.0, 0.0, 0.0)), AlignmentSettings("fine"))
    assert np.ptp(found.report().charts[0].curves[0].y) < 5.0


def test_angles_by_the_axes_of_the_standard() -> None:
    """x up, y east, z north is heading 0 where y is right and z forward."""
    rows = samples(attitude=(0.0, 0.0, 0.0))
    rate, force = (rows.matrix([f"{name}_{axis}" for axis in "xyz"]) for name in ("gyro", "accel"))
    columns = {"t_s": rows["t_s"]}
    for new, old in zip("yzx", range(3), strict=True):
        columns[f"gyro_{new}"], columns[f"accel_{new}"] = rate[:, old], force[:, old]
    found = align(record_of(Samples(columns)), AlignmentSettings("coarse", axes="yzx"))
    assert np.all(np.abs(errors(found, (0.0, 0.0, 0.0))) < 3.0 * found.attitude.uncertainty_deg)
    straight = align(record(attitude=(0.0, 0.0, 0.0)), AlignmentSettings("coarse"))
    assert found.attitude.angles_deg == pytest.approx(straight.attitude.angles_deg, abs=1e-9)


@pytest.mark.parametrize("latitude_deg", [90.0, -90.0, 89.999, 89.0])
@pytest.mark.parametrize("method", METHODS)
def test_near_the_poles_it_is_refused_with_the_latitude_from_which_on(
    latitude_deg: float, method: Method
) -> None:
    with pytest.raises(InputError, match=r"from latitude 88\.\d+° on .* more than 5°") as refused:
        align(record(latitude_deg), AlignmentSettings(method))
    assert "ω_ie·cos L" in str(refused.value)


def test_the_latitude_depends_on_the_gyros() -> None:
    better = AlignmentSettings("coarse", gyro_bias_deg_per_h=0.001)
    found = align(record(89.0, duration_s=600.0), better)
    assert found.attitude.uncertainty_deg[0] > 0.2
    with pytest.raises(InputError, match="the heading would be uncertain by"):
        align(record(89.0, duration_s=60.0), replace(better, heading_limit_deg=0.5))
    with pytest.raises(InputError, match=r"from latitude 89\.\d+° on"):
        align(record(90.0), replace(better, gyro_bias_deg_per_h=0.0, accel_bias_mps2=0.0))


@pytest.mark.parametrize("method", METHODS)
def test_a_short_record_is_refused(method: Method) -> None:
    with pytest.raises(InputError, match="too short to align"):
        align(record(duration_s=15.0), AlignmentSettings(method))
    with pytest.raises(InputError, match="no sample"):
        align(record_of(samples().rows(0, 0)), AlignmentSettings(method))


def turning(t_s: Array, rate: Array, force: Array) -> None:
    rate[:, 2] += 5.0


def swaying(t_s: Array, rate: Array, force: Array) -> None:
    rate[:, 0] += 0.4 * np.cos(2.0 * np.pi * t_s / 8.0)


def slow_swaying(t_s: Array, rate: Array, force: Array) -> None:
    force[:, 0] += 9.8 * np.radians(0.2) * np.sin(2.0 * np.pi * t_s / 60.0)


def pushed(t_s: Array, rate: Array, force: Array) -> None:
    rate[:, 2] += 0.5 * (np.abs(t_s - 70.0) < 1.0)


def tilted_once(t_s: Array, rate: Array, force: Array) -> None:
    force[:, 0] += 0.02 * (t_s > 80.0)


def accelerating(t_s: Array, rate: Array, force: Array) -> None:
    force[:, 2] += 0.5


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        (turning, "the unit turns at 5"),
        (swaying, "the unit sways"),
        (slow_swaying, "the unit moves.*specific force on axis x"),
        (pushed, "the unit moves: around (70|75) s the angular rate on axis z"),
        (tilted_once, "the unit moves.*specific force on axis x"),
        (accelerating, "the unit accelerates"),
    ],
)
def test_a_unit_that_moves_is_refused(motion: Disturbance, words: str) -> None:
    with pytest.raises(InputError, match=words):
        align(record(disturbance=motion), AlignmentSettings("coarse"))


@pytest.mark.parametrize("method", METHODS)
def test_vibration_of_an_engine_is_tolerated_and_widens_the_uncertainty(method: Method) -> None:
    def vibrating(t_s: Array, rate: Array, force: Array) -> None:
        rate += np.outer(0.2 * np.cos(2.0 * np.pi * 7.3 * t_s), [1.0, 0.5, 0.3])
        force += np.outer(1.0 * np.cos(2.0 * np.pi * 8.7 * t_s), [0.5, 0.3, 1.0])

    found = align(record(duration_s=300.0, disturbance=vibrating), AlignmentSettings(method))
    assert warned(found, "The base vibrates")
    assert np.all(np.abs(errors(found)) < 3.0 * found.attitude.uncertainty_deg)
    still = align(record(duration_s=300.0), AlignmentSettings(method))
    assert np.all(found.attitude.uncertainty_deg >= still.attitude.uncertainty_deg)


def test_short_gaps_are_bridged_and_long_ones_cut() -> None:
    rows = samples(duration_s=200.0)
    kept = np.ones(len(rows), dtype=bool)
    kept[[300, 301, 900]] = False
    kept[2600:2700] = False
    gappy = Samples({name: column[kept] for name, column in rows.columns.items()})
    found = align(record_of(gappy), AlignmentSettings("kalman-closed"))
    assert warned(found, "2 gaps of up to 1 s were bridged")
    assert warned(found, "1 longer gaps")
    assert found.duration_s == pytest.approx(130.0, abs=0.1)
    assert np.all(np.abs(errors(found)) < 3.0 * found.attitude.uncertainty_deg)


def test_a_record_in_pieces_is_too_short() -> None:
    rows = samples(duration_s=200.0)
    kept = (np.arange(len(rows)) % 800) < 740
    pieces = Samples({name: column[kept] for name, column in rows.columns.items()})
    with pytest.raises(InputError, match=r"37\.0 s at rest without a gap"):
        align(record_of(pieces), AlignmentSettings("fine"))


def test_rows_without_a_force_are_left_out() -> None:
    rows = samples()
    force = rows["accel_y"].copy()
    force[500:505] = np.nan
    found = align(record_of(rows.with_columns({"accel_y": force})), AlignmentSettings("fine"))
    assert warned(found, "5 rows have no number")
    assert np.all(np.abs(errors(found)) < 3.0 * found.attitude.uncertainty_deg)


def test_biases_that_contradict_the_assumption_widen_it() -> None:
    found = align(
        record(gyro_bias_deg_per_h=(0.3, -0.4, 0.3), accel_bias_mps2=(5e-3, -5e-3, 8e-3)),
        AlignmentSettings("kalman-closed"),
    )
    assert warned(found, "contradicts the assumed 0.03 °/h")
    assert warned(found, "contradicts the assumed accelerometer bias")
    assert found.attitude.uncertainty_deg[0] > 1.0
    assert np.all(np.abs(errors(found)) < 3.0 * found.attitude.uncertainty_deg)


def test_gyros_that_do_not_feel_the_earth_are_refused() -> None:
    with pytest.raises(InputError, match=r"the heading would be uncertain by .* calibrated gyros"):
        align(record(gyro_bias_deg_per_h=(8.0, -9.0, 7.0)), AlignmentSettings("coarse"))


def test_a_forward_axis_on_end_is_refused_for_its_angles() -> None:
    on_end = record(attitude=(0.0, 89.9, 0.0))
    with pytest.raises(InputError, match="forward axis y points along the vertical"):
        align(on_end, AlignmentSettings("coarse"))
    assert align(on_end, AlignmentSettings("coarse", axes="yzx")).attitude.uncertainty_deg[0] < 1.0


def test_an_unusual_attitude_keeps_its_uncertainty() -> None:
    steep = (200.0, 75.0, 160.0)
    found = align(record(attitude=steep, duration_s=300.0), AlignmentSettings("kalman-closed"))
    u = found.attitude.uncertainty_deg
    assert np.all(np.abs(errors(found, steep)) < 3.0 * u)
    assert u[2] > 3.0 * u[1]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("assumed", [(0.03, 1e-3), (0.0, 0.0)])
def test_readings_without_noise_give_the_attitude_to_the_last_figures(
    method: Method, assumed: tuple[float, float]
) -> None:
    rows = samples(noise=0.0, duration_s=90.0)
    found = align(record_of(rows), AlignmentSettings(method, *assumed))
    assert np.all(np.abs(errors(found)) < 1e-5)
    assert np.all(np.isfinite(found.attitude.uncertainty_deg))
    assert not found.warnings
    report_text(found.report())


def test_a_stuck_channel_is_named() -> None:
    rows = samples()
    found = align(record_of(rows.with_columns({"accel_y": np.zeros(len(rows))})), AlignmentSettings("fine"))
    assert warned(found, "accel_y shows the same value in every row")
