"""Gravity tells how the case stands: every way to mount it, tilted, shaken, in the wrong unit, without any
sensor."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ahrs_lab.procedures.mounting_check import MountingFinding, judge_mounting, up_from_attitude
from ahrs_lab.recording.orientation import Orientation, all_orientations
from ahrs_lab.recording.samples import ACCEL, GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription

G = 9.80665


def felt(up: np.ndarray, size: float = G, count: int = 40) -> Samples:
    return Samples({name: np.full(count, size * up[i]) for i, name in enumerate(ACCEL)})


def judge(samples: Samples, asked: str, **device: object) -> MountingFinding:
    return judge_mounting(samples, DeviceDescription(**device), Orientation(asked), 3.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("real", "asked"), list(itertools.product(all_orientations(), ["UEN", "ESD", "NUE"]))
)
def test_a_mounting_is_accepted_where_the_asked_axis_points_up(real: Orientation, asked: str) -> None:
    finding = judge(felt(real.gravity_unit()), asked)
    assert finding.feels == real.face
    assert finding.accepted == (real.face == Orientation(asked).face)
    same_axis = real.up_axis == Orientation(asked).up_axis
    opposite = same_axis and real.up_sign != Orientation(asked).up_sign
    expected = 0.0 if finding.accepted else 180.0 if opposite else 90.0
    assert finding.tilt_deg == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("tilt", "accepted"), [(0.5, True), (2.9, True), (3.1, False), (40.0, False)])
def test_the_tilt_is_measured_and_beyond_the_tolerance_refused(tilt: float, accepted: bool) -> None:
    up = Rotation.from_euler("x", tilt, degrees=True).apply([0.0, 0.0, 1.0])
    finding = judge(felt(up), "ENU")
    assert finding.tilt_deg == pytest.approx(tilt, abs=1e-9)
    assert finding.accepted == accepted
    assert f"{round(tilt, 1)}" in str(finding.message)


def test_the_message_says_what_is_felt_and_what_to_do_in_both_languages() -> None:
    up = Rotation.from_euler("x", 0.1, degrees=True).apply([0.0, 0.0, 1.0])
    message = judge(felt(up), "NUE").message
    assert str(message) == (
        "Asked: Y up. The sensor feels Z up (tilt 90.1°). Turn the case so that Y points up."
    )
    assert message.text("zh") == "要求：Y 轴朝天。传感器感受到 Z 轴朝天（倾斜 90.1°）。请翻转，使 Y 轴朝天。"


@given(st.floats(-180, 180), st.floats(-89, 89), st.floats(-180, 180))
def test_up_follows_from_pitch_and_roll_as_annex_b_defines_them(
    heading: float, pitch: float, roll: float
) -> None:
    # (B.1) with heading clockwise: intrinsic Z, X, Y by (−ψ, θ, γ), from case to east-north-up
    to_enu = Rotation.from_euler("ZXY", [-heading, pitch, roll], degrees=True)
    right, forward, upward = to_enu.inv().apply([0.0, 0.0, 1.0])
    expected = [upward, right, forward]  # X heading, Y pitch, Z roll
    assert up_from_attitude(np.array([pitch]), np.array([roll]))[0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("pitch", "roll", "face"), [(0, 0, "x+"), (0, 180, "x-"), (90, 0, "z+"), (0, 90, "y-"), (0, -90, "y+")]
)
def test_without_accelerometers_the_attitude_output_tells(pitch: float, roll: float, face: str) -> None:
    samples = Samples({"pitch_deg": np.full(9, float(pitch)), "roll_deg": np.full(9, float(roll))})
    finding = judge(samples, "UEN")
    assert (finding.feels, finding.by) == (face, "attitude")
    assert finding.accepted == (face == "x+")


def test_where_nothing_can_be_felt_the_operators_word_is_taken_and_said_so() -> None:
    finding = judge(Samples({"t_s": np.arange(5.0)}), "ESD")
    assert finding.accepted
    assert finding.by == "operator"
    assert finding.warnings == (finding.message,)
    assert "Z points down is the operator's word" in str(finding.message)


@pytest.mark.parametrize(
    ("unit", "size", "fragment"),
    [
        ("m/s^2", 1.0, "look like g, not m/s^2"),
        ("g", G, "look like m/s^2, not g"),
        ("m/s^2", 5.0, "instead of 9.80665"),
    ],
)
def test_a_wrong_unit_of_acceleration_is_noticed_and_the_direction_still_counts(
    unit: str, size: float, fragment: str
) -> None:
    finding = judge(felt(np.array([0.0, 0.0, 1.0]), size), "ENU", accel_unit=unit)
    assert finding.accepted
    [warning] = finding.warnings
    assert fragment in str(warning)


@pytest.mark.parametrize(("unit", "size"), [("m/s^2", G), ("g", 1.0), ("LSB", 16384.0)])
def test_the_right_unit_and_counts_of_any_size_pass(unit: str, size: float) -> None:
    finding = judge(felt(np.array([0.0, 0.0, 1.0]), size), "ENU", accel_unit=unit)
    assert finding.accepted
    assert finding.warnings == ()


def test_a_swinging_case_is_not_still() -> None:
    angle = np.linspace(-2.0, 2.0, 200)
    up = np.column_stack([np.zeros(200), np.sin(np.radians(angle)), np.cos(np.radians(angle))])
    samples = Samples({name: G * up[:, i] for i, name in enumerate(ACCEL)})
    finding = judge(samples, "ENU")
    assert not finding.still
    assert not finding.accepted
    assert "not still" in str(finding.message)


@pytest.mark.parametrize(("unit", "per_dps"), [("deg/s", 1.0), ("rad/s", np.pi / 180.0)])
def test_a_turning_case_is_not_still_but_a_constant_bias_is(unit: str, per_dps: float) -> None:
    samples = felt(np.array([0.0, 0.0, 1.0]), count=400)
    for rate, still in ((np.full(400, 5.0), True), (np.linspace(0.0, 5.0, 400), False)):
        moving = samples.with_columns(dict.fromkeys(GYRO, rate * per_dps))
        assert judge(moving, "ENU", rate_unit=unit).still == still


def test_noise_of_a_poor_sensor_does_not_count_as_motion() -> None:
    rng = np.random.default_rng(1)
    samples = felt(np.array([0.0, 0.0, 1.0]), count=200)
    noisy = samples.with_columns(
        {name: samples[name] + 0.05 * rng.standard_normal(200) for name in ACCEL}
        | {name: 0.5 * rng.standard_normal(200) for name in GYRO}
    )
    assert judge(noisy, "ENU").accepted


@pytest.mark.parametrize("value", [0.0, float("nan")])
def test_dead_accelerometers_are_refused(value: float) -> None:
    finding = judge(Samples({name: np.full(9, value) for name in ACCEL}), "ENU")
    assert not finding.accepted
    assert "nothing that can be gravity" in str(finding.message)
