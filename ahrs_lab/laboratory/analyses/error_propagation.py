"""How an error of an inertial system grows: a pure computation for the command line and the Analysis page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    if bundles:
        raise ValueError("no recording is asked for")
    from ahrs_lab.analysis.error_propagation import propagate_error

    result = propagate_error(
        str(settings["source"]),
        float(settings["size"]),
        float(settings["latitude_deg"]),
        float(settings["hours"]),
    )
    return Outcome(result.to_json(), result.report(), result.series())


KIND = AnalysisKind(
    key="error-propagation",
    name=Message("Error propagation"),
    explains=Message(
        "How one error of an inertial system at rest grows and swings over hours: the textbook's state model "
        "(2-90) and its matrix exponential. It needs no recording."
    ),
    inputs=(),
    settings=(
        Setting(
            key="source",
            label=Message("Source of error"),
            kind="choice",
            default="gyro_east",
            choices=(
                ("tilt_east", Message("initial tilt about east, ″")),
                ("tilt_north", Message("initial tilt about north, ″")),
                ("azimuth", Message("initial error of heading, ′")),
                ("velocity_east", Message("initial error of velocity east, m/s")),
                ("velocity_north", Message("initial error of velocity north, m/s")),
                ("latitude", Message("initial error of latitude, ″")),
                ("gyro_east", Message("gyro bias east, °/h")),
                ("gyro_north", Message("gyro bias north, °/h")),
                ("gyro_up", Message("gyro bias up, °/h")),
                ("accel_east", Message("accelerometer bias east, µg")),
                ("accel_north", Message("accelerometer bias north, µg")),
            ),
        ),
        Setting(
            key="size",
            label=Message("Size, in the source's unit"),
            kind="number",
            default=0.01,
        ),
        Setting(
            key="latitude_deg",
            label=Message("Latitude"),
            kind="number",
            default=39.9042,
            unit="°",
            low=-90.0,
            high=90.0,
        ),
        Setting(
            key="hours",
            label=Message("Time"),
            kind="number",
            default=48.0,
            unit="h",
            low=0.1,
            high=1000.0,
        ),
    ),
    run=_run,
    live=True,
)
