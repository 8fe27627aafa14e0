"""The result of a discrete IMU calibration as JSON: a calibration set with what every result says."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.metrology import imu_calibration_json
from ahrs_lab.metrology.imu_result_json import from_json, to_json
from tests.certificates.imu_sample import COEFFICIENTS, sample_imu_result


@pytest.fixture
def data() -> dict[str, Any]:
    written: dict[str, Any] = json.loads(json.dumps(to_json(sample_imu_result()), allow_nan=False))
    return written


def test_it_survives_its_file(data: dict[str, Any]) -> None:
    assert to_json(from_json(data)) == data


def test_it_has_the_keys_of_imu_calibrate_and_is_a_calibration_set(data: dict[str, Any]) -> None:
    assert data["procedure"] == "imu-discrete"
    assert {"gyro", "accel", "standard_uncertainty", "condition_number"} <= data.keys()
    found = imu_calibration_json.from_json(data)
    for ours, entered in zip(found.coefficients.vectors(), COEFFICIENTS.vectors(), strict=True):
        assert np.array_equal(ours, entered)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"dwells": [{"name": "a"}]}, "orientation"),
        ({"dwells": 3}, "dwells"),
        ({"turns": [{"name": "a", "orientation": "UEN", "turns": 1.5}]}, "turns"),
        ({"bundle_sha256": 3}, "bundle_sha256"),
        ({"gyro": {}}, "gyro"),
    ],
)
def test_what_is_wrong_in_it_is_named(data: dict[str, Any], change: dict[str, Any], key: str) -> None:
    with pytest.raises(InputError, match=key):
        from_json({**data, **change})


def test_three_numbers_are_three(data: dict[str, Any]) -> None:
    data["dwells"][0]["gyro"] = [1.0, 2.0]
    with pytest.raises(InputError, match="gyro"):
        from_json(data)
