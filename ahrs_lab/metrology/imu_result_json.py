"""The result of a discrete IMU calibration as JSON: the calibration set's own keys, as ``imu-calibrate``
prints them, and beside them what every result says. So a result file is a calibration set too."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from ahrs_lab.messages import Message
from ahrs_lab.metrology import imu_calibration_json
from ahrs_lab.metrology.imu_result import ImuDwell, ImuResult, ImuTurns
from ahrs_lab.metrology.json_reader import JsonReader
from ahrs_lab.metrology.result_json import head_json, read_reported, reported_json


def to_json(result: ImuResult) -> dict[str, Any]:
    """A dict of what JSON knows, full precision; ValueError for a number that is not finite."""
    data = {
        **head_json(result),
        **imu_calibration_json.to_json(result.calibration),
        "dwells": [_listed(dwell) for dwell in result.dwells],
        "turns": [_listed(turns) for turns in result.turns],
        **reported_json(result),
    }
    json.dumps(data, allow_nan=False)
    return data


def _listed(entry: ImuDwell | ImuTurns) -> dict[str, Any]:
    return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(entry).items()}


def from_json(data: object) -> ImuResult:
    """The inverse of :func:`to_json`; raises InputError that names the key at fault."""
    reader = JsonReader(data)
    return ImuResult(
        **read_reported(reader),
        calibration=imu_calibration_json.from_json(data),
        dwells=tuple(
            ImuDwell(
                name=one.text("name"),
                orientation=one.text("orientation"),
                beyond_deg=one.number("beyond_deg", 0.0),
                duration_s=one.number("duration_s"),
                gyro=_three(one, "gyro"),
                accel=_three(one, "accel"),
            )
            for one in reader.objects("dwells")
        ),
        turns=tuple(
            ImuTurns(
                name=one.text("name"),
                orientation=one.text("orientation"),
                turns=one.whole("turns"),
                rate_dps=one.number("rate_dps"),
                duration_s=one.number("duration_s"),
                turned_deg=one.number("turned_deg"),
                angle=_three(one, "angle"),
            )
            for one in reader.objects("turns")
        ),
    )


def _three(reader: JsonReader, name: str) -> tuple[float, ...]:
    numbers = reader.numbers(name)
    if len(numbers) != 3:
        raise reader.fault(name, Message("numbers in the shape {shape}", shape="3"))
    return numbers
