"""Alignment of a unit against a reference inertial system on the same carrier."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import radians
from pathlib import Path
from typing import Final, cast

import numpy as np

from ahrs_lab.analysis.transfer_alignment import TransferSettings, transfer_align
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.transfer_alignment_model import (
    METHODS,
    NAMES,
    Assumptions,
    MethodName,
)
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import read_bundle

_METHODS = (
    ("velocity", Message("velocity (5 states)")),
    ("position", Message("position (10 states)")),
    ("velocity-azimuth", Message("velocity and azimuth (19 states)")),
    ("velocity-attitude", Message("velocity and attitude (16 states)")),
)

_DEGREE, _HOUR = radians(1.0), 3600.0
_LARGEST: Final = 1e6

# key, what is read, default, unit, SI per unit, field of Assumptions
_ASSUMED: Final = (
    ("velocity_noise_mps", Message("noise of the reference's velocity"), 0.05, "m/s", 1.0, "velocity_noise"),
    ("position_noise_m", Message("noise of the reference's position"), 2.0, "m", 1.0, "position_noise_m"),
    ("attitude_noise_deg", Message("noise of the reference's angles"), 0.02, "°", _DEGREE, "attitude_noise"),
    (
        "angle_random_walk_deg_per_sqrt_h",
        Message("the unit's angle random walk"),
        0.1,
        "°/√h",
        _DEGREE / _HOUR**0.5,
        "angle_random_walk",
    ),
    (
        "velocity_random_walk_mps_per_sqrt_h",
        Message("the unit's velocity random walk"),
        0.05,
        "m/s/√h",
        1.0 / _HOUR**0.5,
        "velocity_random_walk",
    ),
    ("level_deg", Message("misalignment at the start, level"), 1.0, "°", _DEGREE, "level"),
    ("azimuth_deg", Message("misalignment at the start, azimuth"), 3.0, "°", _DEGREE, "azimuth"),
    ("mounting_deg", Message("mounting of the unit's case"), 2.0, "°", _DEGREE, "mounting"),
    ("velocity_mps", Message("the unit's velocity at the start"), 0.5, "m/s", 1.0, "velocity"),
    ("position_m", Message("the unit's position at the start"), 10.0, "m", 1.0, "position_m"),
    ("gyro_bias_deg_per_h", Message("the unit's gyro bias"), 10.0, "°/h", _DEGREE / _HOUR, "gyro_bias"),
    ("accel_bias_mps2", Message("the unit's accelerometer bias"), 0.01, "m/s²", 1.0, "accel_bias"),
    ("gyro_scale_ppm", Message("scale error of the unit's gyros"), 500.0, "ppm", 1e-6, "gyro_scale"),
    (
        "accel_scale_ppm",
        Message("scale error of the unit's accelerometers"),
        500.0,
        "ppm",
        1e-6,
        "accel_scale",
    ),
    ("gyro_cross_mrad", Message("misalignment of the unit's gyros"), 0.5, "mrad", 1e-3, "gyro_cross"),
    (
        "accel_cross_mrad",
        Message("misalignment of the unit's accelerometers"),
        0.5,
        "mrad",
        1e-3,
        "accel_cross",
    ),
    (
        "level_limit_deg",
        Message("azimuth is compared below this roll and pitch"),
        5.0,
        "°",
        _DEGREE,
        "level_limit",
    ),
)


def _run(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    method = str(settings["method"])
    if method not in METHODS:
        raise InputError(
            "There is no method {method}; there are: {known}.", method=method, known=", ".join(METHODS)
        )
    chosen = TransferSettings(
        cast(MethodName, method),
        _assumptions(settings),
        float(settings["every_s"]),
        (float(settings["lever_x_m"]), float(settings["lever_y_m"]), float(settings["lever_z_m"])),
        str(settings["reference_segment"]) or None,
    )
    result = transfer_align(read_bundle(bundles[0]), read_bundle(bundles[1]), chosen)
    aligned = result.aligned
    series = {"t_s": aligned.t_s, "nis": aligned.nis[0]}
    for i, axis in enumerate("enu"):
        series[f"misalignment_{axis}_deg"] = np.degrees(aligned.misalignment[0, :, i])
        series[f"misalignment_{axis}_u_deg"] = np.degrees(aligned.misalignment_u[0, :, i])
    for state in aligned.method.estimated[3:]:
        series[f"{NAMES[state]}_u_si"] = aligned.estimate_u[0, :, state]
        if state >= 8:
            series[f"{NAMES[state]}_si"] = aligned.estimate[0, :, state]
    return Outcome(result.to_json(), result.report(), series)


def _assumptions(settings: Mapping[str, Value]) -> Assumptions:
    values = {}
    for key, label, _, _, unit, field in _ASSUMED:
        value = float(settings[key])
        # what is compared cannot be without noise; what is known may be known exactly
        if not 0 <= value <= _LARGEST or (value == 0 and field.endswith(_NOISES)):
            raise InputError(
                "{what} is {value}: it has to be above 0 and at most {most}.",
                what=label,
                value=value,
                most=f"{_LARGEST:.0f}",
            )
        values[field] = value * unit
    return Assumptions(**values)


_NOISES = ("velocity_noise", "position_noise_m", "attitude_noise")


def _settings() -> tuple[Setting, ...]:
    assumed = Message("assumed, standard deviation")
    return (
        Setting("method", Message("what is compared"), "choice", "velocity", choices=_METHODS),
        *(
            Setting(key, label, "number", default, unit, 0.0, hint=None if "limit" in key else assumed)
            for key, label, default, unit, _, _ in _ASSUMED
        ),
        Setting("every_s", Message("least time between comparisons"), "number", 1.0, "s", 0.01, 60.0),
        *(
            Setting(
                f"lever_{axis}_m",
                Message("unit's place from the reference's along the unit's {axis}", axis=axis),
                "number",
                0.0,
                "m",
            )
            for axis in "xyz"
        ),
        Setting("reference_segment", Message("segment of the reference"), "text", ""),
    )


KIND = AnalysisKind(
    key="transfer-align",
    name=Message("Alignment against a reference system"),
    explains=Message(
        "A reference inertial system and the unit on one carrier: from both recordings a Kalman filter "
        "estimates how the unit is misaligned, and its biases. The reference needs velocity, position and, "
        "for the angles, heading, pitch and roll; the unit its gyros and accelerometers. Both on one time "
        "base."
    ),
    inputs=(Message("recording of the reference"), Message("recording of the unit")),
    settings=_settings(),
    run=_run,
)
