"""The results that a laboratory keeps, one kind a procedure, and their JSON."""

from __future__ import annotations

import json
from typing import Any

from ahrs_lab.errors import InputError
from ahrs_lab.metrology import imu_result_json, result_json
from ahrs_lab.metrology.imu_result import PROCEDURE as IMU_PROCEDURE
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.result import CalibrationResult

AnyResult = CalibrationResult | ImuResult


def to_json(result: AnyResult) -> dict[str, Any]:
    """A dict of what JSON knows, full precision; ValueError for a number that is not finite."""
    return imu_result_json.to_json(result) if isinstance(result, ImuResult) else result_json.to_json(result)


def from_json(data: object) -> AnyResult:
    """The inverse of :func:`to_json`; raises InputError that names the key at fault."""
    if isinstance(data, dict) and data.get("procedure") == IMU_PROCEDURE:
        return imu_result_json.from_json(data)
    return result_json.from_json(data)


def from_json_text(text: str) -> AnyResult:
    """The inverse of :func:`to_json` as text; raises InputError for what is no result."""
    try:
        return from_json(json.loads(text))
    except (ValueError, RecursionError) as error:
        raise InputError("The result is not valid JSON: {reason}", reason=str(error)) from error
