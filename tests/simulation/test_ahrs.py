"""The unit on the bench: what it feels, what it sends, and what the link does to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.inertial.allan import overlapping_allan_deviation
from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.sensor_model import GyroModel
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.recording.orientation import Orientation, all_orientations
from ahrs_lab.recording.samples import ACCEL, ANGLE, ATTITUDE, GYRO, Samples
from ahrs_lab.simulation.bench import world_of
from ahrs_lab.simulation.presets import demonstration
from ahrs_lab.simulation.settings import (
    AttitudeErrors,
    DeviceSettings,
    FixtureSettings,
    GyroNoise,
    OutputGroup,
    SensorSettings,
    SimulationSettings,
    Stability,
    TableSettings,
)
from tests.simulation.bench_at_hand import after, ready

EARTH_NORTH_DPS = 11.5382751 / 3600.0
EARTH_UP_DPS = 9.6489326 / 3600.0


def _device(**keys: object) -> SimulationSettings:
    return SimulationSettings.ideal(device=replace(DeviceSettings(), **keys))  # type: ignore[arg-type]


def _turned(bench: Bench, rate_dps: float, seconds: float) -> tuple[Samples, float]:
    """Samples from rest to steady turning, and how far the platform turned meanwhile."""
    motion = world_of(bench).table.motion
    bench.ahrs.read()
    start = motion.angle_at(bench.clock.now_s())
    bench.table.set_rate(rate_dps)
    bench.clock.wait(seconds)
    return bench.ahrs.read(), motion.angle_at(bench.clock.now_s()) - start


@pytest.mark.parametrize("orientation", all_orientations(), ids=str)
def test_an_ideal_unit_at_rest_senses_the_earths_rate_and_gravity(orientation: Orientation) -> None:
    samples = after(ready(letters=orientation.letters), 1.0)
    earth = {"E": 0.0, "W": 0.0, "N": EARTH_NORTH_DPS, "S": -EARTH_NORTH_DPS}
    earth |= {"U": EARTH_UP_DPS, "D": -EARTH_UP_DPS}
    for axis, letter in enumerate(orientation.letters):
        np.testing.assert_allclose(samples[GYRO[axis]], earth[letter], atol=2e-11)
        gravity = {"U": 1.0, "D": -1.0}.get(letter, 0.0)
        np.testing.assert_allclose(samples[ACCEL[axis]], 9.8014573 * gravity, atol=5e-7)


def test_increments_of_a_turn_add_up_to_the_turn() -> None:
    """Sums over the sample rate are integrals, whatever the interval and wherever motion begins in it."""
    for rate_hz in (1.0, 7.0, 100.0):
        bench = ready(_device(sample_rate_hz=rate_hz), "NUE")
        bench.clock.wait(0.3457 if rate_hz > 1.0 else 3.0)
        samples, turned = _turned(bench, 250.0, 30.0)
        sums = samples.matrix(GYRO).sum(axis=0) / rate_hz
        seconds = len(samples) / rate_hz
        missing = (bench.clock.now_s() - samples["host_t_s"][-1]) * 250.0
        assert sums[1] == pytest.approx(turned - missing + EARTH_UP_DPS * seconds, abs=3e-9)


def test_turning_to_an_azimuth_shows_the_new_direction_of_north() -> None:
    bench = ready(letters="UEN")
    bench.table.move_to(90.0, 50.0)
    samples = after(bench, 5.0).rows(-10)
    turned = Orientation("UEN").turned(1)
    assert turned.letters == "UNW"
    np.testing.assert_allclose(samples["gyro_y"], EARTH_NORTH_DPS, atol=2e-11)
    np.testing.assert_allclose(samples["gyro_z"], 0.0, atol=1e-15)


def test_same_seed_same_commands_same_bits() -> None:
    runs = []
    for _ in range(2):
        bench = ready(demonstration())
        bench.table.set_rate(123.0)
        samples = after(bench, 400.0)
        runs.append((samples, bench.table.log(), bench.supply.read(), bench.room.read()))
    first, second = runs
    for name in first[0].columns:
        np.testing.assert_array_equal(first[0][name], second[0][name], strict=True)
    np.testing.assert_array_equal(first[1].angle_deg, second[1].angle_deg)
    np.testing.assert_array_equal(first[1].rate_dps, second[1].rate_dps)
    assert first[2:] == second[2:]
    other = ready(replace(demonstration(), seed=2))
    assert not np.array_equal(after(other, 400.0)["gyro_x"], first[0]["gyro_x"])


@pytest.mark.parametrize("output", ["rate", "increment"])
def test_numbers_do_not_depend_on_how_time_is_cut_into_waits(output: OutputGroup) -> None:
    base = demonstration()
    device = replace(base.device, outputs=(output, "accel", "angle", "temperature"), gyro_lsb=1e-4)
    sensor = replace(base.sensor, gyro_noise=replace(base.sensor.gyro_noise, quantisation_arcsec=0.3))
    settings = replace(base, device=device, sensor=sensor)
    whole, cut = ready(settings), ready(settings)
    columns: list[Samples] = []
    for bench in (whole, cut):
        bench.ahrs.read()
        bench.table.set_rate(33.0)
    whole.clock.wait(200.0)
    expected = whole.ahrs.read()
    for wait in (0.001, 0.5, 12.3456, 0.0003, 100.0, 87.1531):
        cut.clock.wait(wait)
        columns.append(cut.ahrs.read())
    # waits that add up to the same time up to rounding
    assert cut.clock.now_s() == pytest.approx(whole.clock.now_s(), abs=1e-9)
    for name in expected.columns:
        parts = np.concatenate([block[name] for block in columns if len(block)])
        np.testing.assert_array_equal(parts, expected[name], err_msg=name)


def test_allan_deviation_of_a_long_record_gives_all_coefficients_back() -> None:
    """Through the whole bench: 0.3 °/√h, 20 °/h, 40 °/h/√h, 2″, at two sampling rates."""
    noise = GyroNoise(0.3, 20.0, 40.0, 2.0)
    for rate_hz in (10.0, 50.0):
        settings = _device(sample_rate_hz=rate_hz, outputs=("rate",))
        settings = replace(settings, sensor=SensorSettings(gyro_noise=noise))
        samples = after(ready(settings), 15_000.0)
        for tau_s in (0.2, 1.0, 10.0, 300.0):
            m = round(tau_s * rate_hz)
            squares = [overlapping_allan_deviation(samples[name], (m,))[0] ** 2 for name in GYRO]
            found = np.sqrt(np.mean(squares)) * 3600.0
            # in °/h and s: Q = 2, as 1″/s is 1 °/h; N = 0.3·60; K = 40/60
            angle = 3.0 * (2.0 / tau_s) ** 2
            walk, floor = (0.3 * 60.0) ** 2 / tau_s, (0.664282 * 20.0) ** 2
            expected = np.sqrt(angle + walk + floor + (40.0 / 60.0) ** 2 * tau_s / 3.0)
            error = 1.0 / np.sqrt(2.0 * 3.0 * (15_000.0 / tau_s - 1.0))
            assert found == pytest.approx(expected, rel=4.0 * error + 0.02), (rate_hz, tau_s)


@pytest.mark.parametrize(
    ("unit", "lsb", "factor"), [("deg/s", 0.0, 1.0), ("rad/s", 0.0, np.pi / 180.0), ("LSB", 0.01, 100.0)]
)
def test_rate_units(unit: str, lsb: float, factor: float) -> None:
    samples = after(ready(_device(rate_unit=unit, gyro_lsb=lsb)), 1.0)
    expected = EARTH_UP_DPS * factor if not lsb else round(EARTH_UP_DPS * factor)
    np.testing.assert_allclose(samples["gyro_x"], expected, atol=1e-9)


@pytest.mark.parametrize(("unit", "factor"), [("m/s^2", 1.0), ("g", 1.0 / 9.80665), ("LSB", 1000.0)])
def test_acceleration_units(unit: str, factor: float) -> None:
    samples = after(ready(_device(accel_unit=unit, accel_lsb=0.001 if unit == "LSB" else 0.0)), 1.0)
    np.testing.assert_allclose(samples["accel_x"], 9.8014573 * factor, atol=0.5 if unit == "LSB" else 1e-6)


def test_counts_of_increments_lose_nothing() -> None:
    """One count is 0.001°: the Earth's rate is far below a count a sample, but it all comes out in time."""
    bench = ready(_device(outputs=("increment",), rate_unit="LSB", gyro_lsb=0.001))
    samples = after(bench, 1000.0)
    counts = samples["gyro_x"] / 100.0
    assert set(np.unique(np.rint(counts))) == {0.0, 1.0}
    np.testing.assert_allclose(counts, np.rint(counts), atol=1e-12)
    assert abs(np.sum(counts) - EARTH_UP_DPS * 1000.0 / 0.001) <= 1.0
    bench.table.set_rate(100.0)
    assert after(bench, 10.0)["gyro_x"][-1] == pytest.approx(100.0 / 0.001, rel=2e-3)


def test_rounded_rates_lose_what_is_below_half_a_step() -> None:
    samples = after(ready(_device(gyro_lsb=0.01)), 10.0)
    assert not samples["gyro_x"].any()


def test_accumulated_angle_is_the_integral_since_start() -> None:
    bench = ready(_device(outputs=("angle",)))
    samples, turned = _turned(bench, -100.0, 37.0)
    assert GYRO[0] not in samples
    assert samples[ANGLE[0]][-1] == pytest.approx(turned + EARTH_UP_DPS * 37.0, abs=1e-8)


@pytest.mark.parametrize("letters", ["UEN", "UWS", "UNW"])
def test_attitude_output_is_the_attitude(letters: str) -> None:
    bench = ready(_device(outputs=("attitude",)), letters)
    bench.table.move_to(30.0, 50.0)
    samples = after(bench, 5.0).rows(-1)
    assert GYRO[0] not in samples
    heading, pitch, roll = (float(samples[name][0]) for name in ATTITUDE)
    expected = {"UEN": 330.0, "UWS": 150.0, "UNW": 240.0}[letters]
    assert heading == pytest.approx(expected, abs=1e-9)
    assert pitch == pytest.approx(0.0, abs=1e-9)
    assert roll == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("orientation", all_orientations(), ids=str)
def test_attitude_output_tells_every_orientation(orientation: Orientation) -> None:
    samples = after(ready(_device(outputs=("attitude",)), orientation.letters), 0.1)
    angles = [float(samples[name][-1]) for name in ATTITUDE]
    right_forward_up = orientation.matrix[:, [1, 2, 0]]  # Y pitch, Z roll, X heading
    np.testing.assert_allclose(attitude_matrix(*angles), right_forward_up, atol=1e-12)


def test_attitude_errors_stay_in_range() -> None:
    errors = AttitudeErrors(heading_offset_deg=359.5, roll_offset_deg=179.9, noise_deg=1.0)
    settings = replace(_device(outputs=("attitude",)), sensor=SensorSettings(attitude=errors))
    samples = after(ready(settings, "ENU"), 10.0)
    assert samples["heading_deg"].min() >= 0.0
    assert samples["heading_deg"].max() < 360.0
    assert np.std(samples["pitch_deg"]) == pytest.approx(1.0, rel=0.1)
    assert -180.0 < samples["roll_deg"].min() < -170.0 < 170.0 < samples["roll_deg"].max() <= 180.0


def test_the_fixtures_faces_are_off_the_same_each_time() -> None:
    fixture = FixtureSettings(perpendicularity_arcsec=3600.0)
    settings = replace(_device(), fixture=fixture, seed=3)
    bench = ready(settings, "UEN")
    tilts = []
    for letters in ("UEN", "DNE", "UEN", "UNW"):
        bench.operator.mount(Orientation(letters), None)
        samples = after(bench, 0.1)
        tilts.append((samples["accel_y"][-1], samples["accel_z"][-1]))
    assert tilts[0] == tilts[2]
    assert tilts[0] != tilts[1]
    assert 0.0 < np.hypot(*tilts[0]) < 9.8 * np.radians(5.0)


def test_a_wobble_once_a_turn_enters_the_misalignment_directly() -> None:
    table = TableSettings(wobble_arcsec=20.0, wobble_harmonic=1, wobble_phase_deg=0.0)
    bench = ready(SimulationSettings.ideal(table=table), "UEN")
    sums = []
    for target in (3600.0, 0.0):
        bench.table.move_to(target, 100.0)
        sums.append(after(bench, 40.0).matrix(GYRO).sum(axis=0) / 100.0)
    leak = (sums[0] - sums[1])[1:] / 7200.0
    assert np.hypot(*leak) == pytest.approx(np.sin(20.0 * np.pi / 648000.0), rel=1e-6)


def test_device_time_counter_and_arrival() -> None:
    bench = ready(_device(latency_s=0.25, boot_time_s=2.0))
    bench.clock.wait(2.0)
    assert len(bench.ahrs.read()) == 0
    bench.clock.wait(1.0)
    samples = bench.ahrs.read()
    np.testing.assert_array_equal(samples["counter"], np.arange(1, 76))
    np.testing.assert_allclose(samples["t_s"], np.arange(1, 76) / 100.0, atol=1e-12)
    np.testing.assert_allclose(samples["host_t_s"] - samples["t_s"], 2.25, atol=1e-12)
    bench.clock.wait(0.1)
    assert bench.ahrs.read()["counter"][0] == 76


def test_a_bunching_link_delivers_at_its_own_times() -> None:
    bench = ready(_device(bunching_s=0.016))
    samples = after(bench, 10.0)
    late = samples["host_t_s"] - samples["t_s"]
    assert late.min() >= -1e-9
    assert 0.008 < late.max() < 0.016
    multiples = samples["host_t_s"] / 0.016
    np.testing.assert_allclose(multiples, np.rint(multiples), atol=1e-9)


def test_lost_samples_leave_holes_in_the_counter() -> None:
    samples = after(ready(_device(dropout_probability=0.02)), 100.0)
    lost = 10_000 - len(samples)
    assert lost == pytest.approx(200, abs=5 * np.sqrt(200))
    assert np.sum(np.diff(samples["counter"]) - 1) == pytest.approx(lost, abs=3)


def test_start_drops_what_was_made_before() -> None:
    bench = ready()
    bench.clock.wait(5.0)
    bench.ahrs.start()
    bench.clock.wait(1.0)
    assert len(bench.ahrs.read()) == 100
    bench.ahrs.stop()
    bench.clock.wait(1.0)
    assert len(bench.ahrs.read()) == 0


def test_a_silent_unit_and_one_that_loses_packets() -> None:
    bench = ready()
    faults = world_of(bench).faults
    bench.clock.wait(1.0)
    faults.trigger("ahrs_silent")
    bench.clock.wait(2.0)
    assert len(bench.ahrs.read()) == 99
    faults.clear("ahrs_silent")
    faults.trigger("ahrs_dropouts", at_s=bench.clock.now_s() + 50.0)
    bench.clock.wait(150.0)
    counters = bench.ahrs.read()["counter"]
    assert counters[0] == 301
    early = np.diff(counters[counters < 5300])
    late = np.diff(counters[counters >= 5300])
    assert np.all(early == 1)
    assert np.mean(late) == pytest.approx(1.0 / 0.9, rel=0.01)


def test_the_range_saturates_the_output() -> None:
    settings = SimulationSettings.ideal(sensor=SensorSettings(gyro=GyroModel(range_dps=100.0)))
    bench = ready(settings)
    bench.table.set_rate(150.0)
    assert after(bench, 2.0)["gyro_x"][-1] == 100.0


def test_each_power_on_draws_its_own_bias_and_starts_the_clock_of_the_unit_anew() -> None:
    settings = SimulationSettings.ideal(
        sensor=SensorSettings(
            gyro_stability=Stability(turn_on=0.01, start_up=(0.0, 0.5, 0.0)),
            accel_stability=Stability(turn_on=0.02),
        )
    )
    bench = ready(settings)
    biases, accel_biases = [], []
    for _ in range(40):
        bench.supply.off()
        bench.clock.wait(5.0)
        bench.supply.on()
        bench.clock.wait(1.0)
        samples = bench.ahrs.read()
        assert samples["counter"][0] == 1
        biases.append(float(samples["gyro_x"][-1]) - EARTH_UP_DPS)
        accel_biases.append(float(samples["accel_y"][-1]))
    assert np.std(accel_biases) == pytest.approx(0.02, rel=0.4)
    assert np.std(biases) == pytest.approx(0.01, rel=0.4)
    assert len(set(biases)) == 40
    start_up = after(bench, 600.0)["gyro_y"]
    shape: NDArray[np.float64] = (start_up - start_up[-1]) / (start_up[0] - start_up[-1])
    age = np.arange(len(shape)) / 100.0
    expected = (np.exp(-age / 300.0) - np.exp(-599.99 / 300.0)) / (1.0 - np.exp(-599.99 / 300.0))
    np.testing.assert_allclose(shape, expected, atol=1e-4)


def test_temperature_moves_bias_and_scale_factor() -> None:
    stability = Stability(temperature=(1e-3, 1e-5), scale_ppm_per_c=(100.0, 0.0, 0.0))
    settings = SimulationSettings.ideal(sensor=SensorSettings(gyro_stability=stability))
    settings = replace(settings, device=DeviceSettings(self_heating_c=30.0, thermal_time_constant_s=10.0))
    bench = ready(settings)
    bench.clock.wait(1000.0)
    samples = after(bench, 1.0)
    # 20 °C room + 30 °C, reference 25 °C
    np.testing.assert_allclose(samples["temperature_c"], 50.0, atol=1e-9)
    bias = 1e-3 * 25.0 + 1e-5 * 25.0**2
    np.testing.assert_allclose(samples["gyro_y"], bias, atol=1e-12)
    np.testing.assert_allclose(samples["gyro_x"], (bias + EARTH_UP_DPS) * (1.0 + 100e-6 * 25.0), atol=1e-11)
