"""A calibration set from recordings: every coefficient comes back, and what is wrong with a recording is
named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ahrs_lab.analysis.imu_calibration import RecordedCalibration, calibrate_recording
from ahrs_lab.analysis.report import report_text
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.imu_calibration import AccelCoefficients, Coefficients, GyroCoefficients
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.simulation.presets import sensor_preset, table_preset
from ahrs_lab.simulation.settings import DeviceSettings, SensorSettings, SimulationSettings, Stability
from tests.analysis.imu_bundle import GRAVITY_MPS2, ONE_G, TURNED_UP, Made, Recorder, altered, changed, unit
from tests.simulation.bench_at_hand import after, ready

Change = Callable[[list[Made]], list[Made]]


def found(folder: Path, recorder: Recorder, made: list[Made], **more: Any) -> RecordedCalibration:
    return calibrate_recording(read_bundle(recorder.write(folder / "bundle", made)), **more)


def off(one: Coefficients, other: Coefficients) -> float:
    """Largest error, that of scale factors relative."""
    pairs = zip(one.vectors(), other.vectors(), strict=True)
    return max(
        float(np.max(np.abs(a - b) / np.where(np.arange(a.shape[1]) == 0, np.abs(b), 1.0))) for a, b in pairs
    )


@pytest.mark.parametrize("table_angle", [True, False], ids=["with the table's angle", "by the gyro"])
@pytest.mark.parametrize(
    ("rate_unit", "rate_scale", "accel_unit", "accel_scale"),
    [("deg/s", 1.0, "m/s^2", 1.0), ("rad/s", radians(1.0), "g", ONE_G), ("LSB", -16384.0, "LSB", 4096.0)],
)
def test_every_coefficient_comes_back_in_the_units_own_units(
    tmp_path: Path, rate_unit: str, rate_scale: float, accel_unit: str, accel_scale: float, table_angle: bool
) -> None:
    true = unit(2, rate_scale, accel_scale)
    recorder = Recorder(true, rate_unit, accel_unit, table_angle=table_angle)
    made = recorder.everything()
    result = calibrate_recording(read_bundle(recorder.write(tmp_path / "b", made)))
    # without the table's angle it comes from the gyro: second order in the bias while it stands
    assert off(result.calibration.coefficients, true) < (1e-9 if table_angle else 1e-8)
    assert result.calibration.rate_unit == rate_unit
    assert result.calibration.provenance["scheme"] == "12"
    assert result.calibration.warnings == ()


def test_azimuths_between_the_quarter_turns_are_taken_as_they_are(tmp_path: Path) -> None:
    true = unit(3)
    recorder = Recorder(true)
    made = [recorder.turns(up, sign * 3) for up in TURNED_UP for sign in (1, -1)]
    stands = [
        ("UWS", 30.0),
        ("USE", 100.0),
        ("DWN", 45.0),
        ("SUW", 135.0),
        ("NDW", 200.0),
        ("NWU", 300.0),
        ("SWD", 405.0),
    ]
    made += [recorder.position(letters, i, azimuth_deg=a) for i, (letters, a) in enumerate(stands, 1)]
    result = found(tmp_path, recorder, made)
    assert off(result.calibration.coefficients, true) < 1e-9
    assert result.calibration.provenance["scheme"] == "own"


def test_turns_of_the_table_are_turns_of_a_case_that_stands_on_its_head(tmp_path: Path) -> None:
    true = unit(4)
    recorder = Recorder(true)
    made = [recorder.turns(down, sign * 4) for down in ("DWN", "NDW", "SWD") for sign in (1, -1)]
    made += recorder.everything("8")[6:]
    assert off(found(tmp_path, recorder, made).calibration.coefficients, true) < 1e-9


def test_standard_uncertainties_of_a_noisy_recording_cover_the_truth(tmp_path: Path) -> None:
    true = unit(5)
    pulls = []
    for seed in range(6):
        recorder = Recorder(true, gyro_density=3e-3, accel_density=1e-3, rng=np.random.default_rng(seed))
        result = found(tmp_path / str(seed), recorder, recorder.everything("12", duration_s=40.0))
        quality = result.calibration.quality
        assert quality is not None
        for value, truth, u in zip(
            result.calibration.coefficients.vectors(),
            true.vectors(),
            quality.standard_uncertainty.vectors(),
            strict=True,
        ):
            pulls.append(((value - truth) / u).ravel())
    all_pulls = np.concatenate(pulls)
    assert 0.8 < np.std(all_pulls) < 1.15
    assert np.max(np.abs(all_pulls)) < 4.0


def on_the_virtual_bench(folder: Path, sensor: SensorSettings, seed: int) -> RecordedCalibration:
    """Turns and positions as a bench does them, the unit not switched off between."""
    settings = replace(
        SimulationSettings.ideal(),
        seed=seed,
        sensor=sensor,
        table=replace(table_preset("ideal"), max_acceleration_dps2=100.0),
        device=DeviceSettings(sample_rate_hz=20.0),
    )
    bench = ready(settings, "UWS")
    recorder = Recorder(unit())
    made: list[Made] = []
    for up in TURNED_UP:
        bench.operator.mount(recorder.turns(up, 1)[0].orientation, None)
        for turns in (5, -5):
            segment, _ = recorder.turns(up, turns, 100.0)
            start = bench.table.state().angle_deg
            bench.ahrs.read()
            bench.clock.wait(1.0)
            bench.table.move_to(start + 360.0 * turns, 100.0)
            bench.clock.wait(21.0)
            assert not bench.table.state().moving
            made.append((segment, bench.ahrs.read()))
    for segment, _ in recorder.everything("12")[6:]:
        bench.operator.mount(segment.orientation, None)
        made.append((segment, after(bench, 240.0)))
    return found(folder, recorder, made)


def test_the_virtual_bench_gives_its_units_constants_back(tmp_path: Path) -> None:
    """With the noise and drift of a tactical fibre-optic unit: errors as large as the uncertainties say."""
    sensor = sensor_preset("tactical-fog")
    # the set has one scale factor: what a turn at one rate shows of a cubic belongs to it
    linear = replace(sensor.gyro, nonlinearity=(0.0, 0.0, 0.0))
    sensor = replace(sensor, gyro=linear, gyro_stability=Stability())
    truth = Coefficients(
        GyroCoefficients(
            np.array(linear.scale_factor),
            np.array(linear.bias_dps),
            np.array(linear.g_sensitivity),
            np.array(linear.misalignment_rad),
        ),
        AccelCoefficients(
            np.array(sensor.accel.scale_factor),
            np.array(sensor.accel.bias_mps2),
            np.array(sensor.accel.misalignment_rad),
        ),
    )
    pulls = []
    for seed in (2, 3, 4):
        calibration = on_the_virtual_bench(tmp_path / str(seed), sensor, seed).calibration
        assert calibration.quality is not None
        said = calibration.quality.standard_uncertainty.vectors()
        for value, true, u in zip(calibration.coefficients.vectors(), truth.vectors(), said, strict=True):
            pulls.append(np.delete((value - true) / u, 1, axis=1).ravel())
        # the bias has drifted from its value at switching on: B0 is its mean over the positions
        assert np.all(np.abs(calibration.gyro.B0 - linear.bias_dps) < 3.0 / 3600.0)
    together = np.concatenate(pulls)
    assert np.max(np.abs(together)) < 4.0
    assert np.mean(np.abs(together) < 3.0) > 0.98
    assert 0.8 < np.sqrt(np.mean(together**2)) < 1.25


def test_the_report_and_the_json_say_the_same(tmp_path: Path) -> None:
    recorder = Recorder(unit(6), gyro_density=3e-3, accel_density=1e-3)
    result = found(tmp_path, recorder, recorder.everything("8"))
    text = report_text(result.report())
    assert "ω = (I + E)⁻¹·(N/E1 − B0 − Bf·f)" in text
    assert f"{3600 * result.calibration.gyro.B0[0]:.1f}"[:4] in text
    data = result.to_json()
    assert set(data["gyro"]) == {"E1", "B0", "Bf", "E"}
    assert data["provenance"]["bundle_sha256"]
    assert len(data["residuals"]["positions"]) == 8
    assert "bench_uncertainty" in data


def test_gravity_as_measured_is_taken_and_scales_the_accelerometers(tmp_path: Path) -> None:
    true = unit(6)
    recorder = Recorder(true)
    made = recorder.everything("6")
    bundle = recorder.write(tmp_path / "a", made, site={"gravity_mps2": GRAVITY_MPS2 * 1.001})
    noted = calibrate_recording(read_bundle(bundle)).calibration
    assert pytest.approx(true.accel.K1, rel=1e-9) == noted.accel.K1 * 1.001
    given = calibrate_recording(read_bundle(bundle), gravity_mps2=GRAVITY_MPS2).calibration
    assert pytest.approx(true.accel.K1, rel=1e-9) == given.accel.K1
    assert given.quality is not None
    assert given.quality.bench_figures["gravity_mps2"] == 1e-5
    with pytest.raises(InputError, match=r"9\.7 to 9\.9"):
        calibrate_recording(read_bundle(bundle), gravity_mps2=980.0)
    other = recorder.write(tmp_path / "b", made, site={"gravity_mps2": "9.8"})
    with pytest.raises(InputError, match=r"gravity_mps2 is 9\.8"):
        calibrate_recording(read_bundle(other))


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (lambda m: m[6:], "no usable turns"),
        (lambda m: m[:6], "no usable position at rest"),
        (lambda m: [m[0], *m[2:]], "About x the table turned in one sense only"),
        (lambda m: [*m[:4], *m[6:]], "no turns about z"),
        (
            lambda m: [
                s for s in m if not s[0].name.startswith("position") or s[0].orientation.letters[2] == "U"
            ],
            "rank 1 of 4",
        ),
        (lambda m: altered(altered(m, 2, turns=-5), 3, turns=5), "no turns about y"),
        (lambda m: changed(m, 7, accel_z=None), "no accelerometer columns"),
    ],
)
def test_what_is_missing_is_named(tmp_path: Path, change: Change, named: str) -> None:
    recorder = Recorder(unit(1))
    with pytest.raises(InputError, match=named):
        found(tmp_path, recorder, change(recorder.everything("6", turns=5)))


def test_what_was_left_out_before_is_said_with_what_is_missing(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = altered(recorder.everything("6", turns=5), 1, turns=-6)
    with pytest.raises(
        InputError, match=r"x the table turned in one sense only.*first finding: .*turned -1800"
    ):
        found(tmp_path, recorder, made)


def test_a_sense_written_wrongly_is_seen_without_the_tables_angle(tmp_path: Path) -> None:
    recorder = Recorder(unit(1), table_angle=False)
    made = recorder.everything("6")
    swapped = altered(altered(made, 2, turns=-5), 3, turns=5)
    with pytest.raises(InputError, match="Gyro y shows turns about y with the opposite sign"):
        found(tmp_path, recorder, swapped)


def test_a_wrong_unit_is_seen(tmp_path: Path) -> None:
    recorder = Recorder(unit(1, radians(1.0)), "deg/s")
    with pytest.raises(InputError, match="rate_unit or turns"):
        found(tmp_path, recorder, recorder.everything("6"))
    recorder = Recorder(unit(1, 1.0, ONE_G))
    with pytest.raises(InputError, match="these look like g"):
        found(tmp_path / "2", recorder, recorder.everything("6"))


def test_samples_lost_in_a_turn_leave_it_out_with_its_reason(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = recorder.everything("6")
    segment, samples = made[0]
    kept = np.r_[0:50, 80 : len(samples)]
    lossy = [(segment, type(samples)({n: c[kept] for n, c in samples.columns.items()})), *made[1:]]
    with pytest.raises(InputError, match="About x the table turned in one sense only"):
        found(tmp_path, recorder, lossy)
    again = [*lossy, (replace(segment, name="again", file="segments/again.csv"), samples)]
    result = found(tmp_path / "2", recorder, again)
    assert off(result.calibration.coefficients, recorder.unit) < 1e-9
    assert any("is left out: samples of 1.5" in w.text() for w in result.calibration.warnings)


def test_rows_without_numbers_of_an_accelerometer_do_not_spoil_its_mean(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = recorder.everything("6")
    holes = made[8][1]["accel_x"].copy()
    holes[10:20] = np.nan
    result = found(tmp_path, recorder, changed(made, 8, accel_x=holes))
    assert off(result.calibration.coefficients, recorder.unit) < 1e-9


def test_a_dwell_of_a_second_is_enough_to_calculate_with(tmp_path: Path) -> None:
    recorder = Recorder(unit(1), gyro_density=1e-3, accel_density=1e-3)
    result = found(tmp_path, recorder, recorder.everything("12", duration_s=1.0))
    quality = result.calibration.quality
    assert quality is not None
    assert np.all(quality.standard_uncertainty.gyro.B0 > 1e-5)


def test_counts_that_stand_still_carry_their_resolution(tmp_path: Path) -> None:
    recorder = Recorder(unit(1, 100.0, 100.0), "LSB", "LSB")
    made = [
        (s, type(x)({n: c if n in ("t_s", "table_angle_deg") else np.round(c) for n, c in x.columns.items()}))
        for s, x in recorder.everything("12")
    ]
    result = found(tmp_path, recorder, made)
    quality = result.calibration.quality
    assert quality is not None
    assert np.all(quality.standard_uncertainty.gyro.B0 > 0.2 * 0.01 / 12)
    error = np.abs(result.calibration.gyro.B0 - recorder.unit.gyro.B0)
    assert np.all(error < 3.5 * quality.standard_uncertainty.gyro.B0)


def test_a_position_that_cannot_be_used_is_left_out_and_said(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    result = found(tmp_path, recorder, changed(recorder.everything("6"), 6, gyro_y=None))
    assert len(result.positions) == 5
    assert any("position_01.csv" in w.text() and "gyro_y" in w.text() for w in result.calibration.warnings)


def test_outputs_of_no_sensor_are_named(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = recorder.everything("6")
    huge = made[1][1]["gyro_z"].copy()
    huge[3] = 1e300
    with pytest.raises(InputError, match=r"gyro_z goes up to 1e\+300"):
        found(tmp_path, recorder, changed(made, 1, gyro_z=huge))


def test_a_rotation_needs_no_role_to_be_turns(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = altered(recorder.everything("6"), 0, role="position")
    assert off(found(tmp_path, recorder, made).calibration.coefficients, recorder.unit) < 1e-9


def test_a_column_without_a_number_is_named(tmp_path: Path) -> None:
    recorder = Recorder(unit(1))
    made = recorder.everything("6")
    empty = np.full(len(made[7][1]), np.nan)
    with pytest.raises(InputError, match=r"position_02\.csv has no number in the column accel_y"):
        found(tmp_path, recorder, changed(made, 7, accel_y=empty))
