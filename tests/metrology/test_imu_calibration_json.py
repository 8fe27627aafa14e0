"""A calibration set as JSON: the keys people rely on, the round trip, and files that nobody vouches for."""

from __future__ import annotations

import copy
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.imu_calibration import ImuCalibration
from ahrs_lab.metrology.imu_calibration_json import from_json, to_json
from ahrs_lab.metrology.imu_estimation import calibrate
from tests.metrology.imu_unit import REFERENCE, Shown, random_unit


def a_set(seed: int = 1) -> ImuCalibration:
    bench = Shown(random_unit(np.random.default_rng(seed)), gyro_density=1e-3, accel_density=1e-3)
    return calibrate(
        *bench.drawn(bench.scheme("8"), bench.all_turns()), REFERENCE, rate_unit="LSB", accel_unit="LSB"
    )


SET = to_json(a_set())


def test_the_published_keys_have_their_shapes() -> None:
    for part in (SET, SET["standard_uncertainty"]):
        assert {key: np.shape(value) for key, value in part["gyro"].items()} == {
            "E1": (3,), "B0": (3,), "Bf": (3, 3), "E": (3, 3),
        }  # fmt: skip
        assert {key: np.shape(value) for key, value in part["accel"].items()} == {
            "K1": (3,),
            "K0": (3,),
            "K": (3, 3),
        }
        assert not np.diagonal(part["gyro"]["E"]).any()
        assert not np.diagonal(part["accel"]["K"]).any()
    assert SET["condition_number"]["gyro"] == pytest.approx(SET["condition_number"]["accel"])


@settings(max_examples=30)
@given(st.integers(0, 1000))
def test_writing_and_reading_changes_no_bit(seed: int) -> None:
    data = to_json(a_set(seed))
    assert to_json(from_json(json.loads(json.dumps(data, allow_nan=False)))) == data


def test_the_published_keys_alone_are_a_set() -> None:
    found = from_json({"gyro": SET["gyro"], "accel": SET["accel"]})
    assert found.quality is None
    assert found.rate_unit == ""
    assert found.gyro.E1.tolist() == SET["gyro"]["E1"]


def without(key: str) -> dict[str, Any]:
    data = copy.deepcopy(SET)
    part, _, name = key.rpartition(".")
    del (data[part] if part else data)[name]
    return data


def replaced(key: str, value: object) -> dict[str, Any]:
    data = copy.deepcopy(SET)
    part, _, name = key.rpartition(".")
    (data[part] if part else data)[name] = value
    return data


@pytest.mark.parametrize(
    ("data", "named"),
    [
        ([], "an object"),
        ({}, "gyro"),
        (without("gyro.E"), r"gyro\.E"),
        (without("accel.K1"), r"accel\.K1"),
        (replaced("gyro.E1", [1.0, 1.0]), r"gyro\.E1 .*shape 3"),
        (replaced("gyro.E1", [1.0, float("nan"), 1.0]), "a finite number"),
        (replaced("gyro.E1", [1.0, "1", 1.0]), "a number"),
        (replaced("gyro.E1", [1.0, 0.0, 1.0]), r"gyro\.E1 of channel y is 0\.0"),
        (replaced("gyro.Bf", [1.0, 0.0, 1.0]), r"gyro\.Bf .*shape 3×3"),
        (replaced("gyro.E", [[1, 0, 0], [0, 1, 0], [0, 0, 1]]), "zeros on its diagonal"),
        (replaced("accel.K", [[0, 1, 0], [1, 0, 0], [0, 0, 0]]), r"I \+ K is singular"),
        (replaced("accel.K1", [1.0, 1e-30, 1.0]), r"accel\.K1"),
        (replaced("rate_unit", "rpm"), "deg/s"),
        (replaced("format", "ahrs-lab-recording"), "no calibration set"),
        (replaced("version", 2), "no calibration set"),
        (replaced("covariance.gyro", [[]]), r"covariance\.gyro"),
        (replaced("warnings", [{"message": {"template": "{a.b}", "params": {"a": 1}}}]), "fields in braces"),
        (replaced("gyro.B0", [0.0, 1e308, 0.0]), r"gyro\.B0 goes up to 1e\+308"),
        (replaced("gyro.Bf", [[1e7] * 3] * 3), r"gyro\.Bf goes up to 1e\+07"),
        (replaced("accel.K0", [-1e308, 1e308, 0.0]), r"accel\.K0 goes up to 1e\+308"),
        (
            replaced("standard_uncertainty", {"gyro": SET["gyro"], "accel": SET["accel"]}),
            "standard_uncertainty has to be numbers of zero or more",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_set_is_named(data: object, named: str) -> None:
    with pytest.raises(InputError, match=named):
        from_json(data)


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(max_size=3), lambda x: st.lists(x, max_size=4), max_leaves=12), st.sampled_from(["gyro.E1", "gyro.E", "accel.K", "accel.K0", "rate_unit", "residuals", "covariance", "condition_number", "provenance", "warnings"]))  # fmt: skip  # noqa: E501
def test_nothing_in_a_file_does_anything_but_a_message(value: object, key: str) -> None:
    try:
        found = from_json(replaced(key, value))
    except InputError:
        return
    json.dumps(to_json(found), allow_nan=False)
