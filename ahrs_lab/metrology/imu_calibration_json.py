"""A calibration set as JSON, as ``imu-calibrate --json`` prints it, and back.

The published keys are ``gyro``, ``accel``, ``standard_uncertainty``, ``condition_number``; the others make
the round trip complete. A set from outside is not trusted: every number is checked, and one that cannot be
inverted is refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import (
    AXES,
    AccelCoefficients,
    Coefficients,
    GyroCoefficients,
    ImuCalibration,
    Quality,
)
from ahrs_lab.metrology.json_reader import JsonReader, message_from_json

Array = NDArray[np.float64]

FORMAT = "ahrs-lab-calibration-set"
VERSION = 1
RATE_UNITS = ("", "deg/s", "rad/s", "LSB")
ACCEL_UNITS = ("", "m/s^2", "g", "LSB")
_LARGEST_CONDITION = 1e6
_MOST_POSITIONS = 10_000
_LARGEST = 1e6
"""Of a bias, an effect of the specific force or a misalignment, in the set's units: no unit comes near."""


def to_json(found: ImuCalibration) -> dict[str, Any]:
    """A dict of what JSON knows, full precision."""
    data: dict[str, Any] = {"format": FORMAT, "version": VERSION, **_coefficients(found.coefficients)}
    quality = found.quality
    if quality is not None:
        data["standard_uncertainty"] = _coefficients(quality.standard_uncertainty)
        data["condition_number"] = {
            "gyro": quality.gyro_condition,
            "accel": quality.accel_condition,
            "turns": quality.turns_condition,
        }
        data["covariance"] = {
            "gyro": quality.gyro_covariance.tolist(),
            "accel": quality.accel_covariance.tolist(),
            "order": {
                "gyro": ["E1", "B0", "Bf_x", "Bf_y", "Bf_z", "E_first_other", "E_second_other"],
                "accel": ["K1", "K0", "K_first_other", "K_second_other"],
            },
        }
        data["residuals"] = {
            "positions": list(quality.positions),
            "gyro_dps": quality.gyro_residuals.tolist(),
            "accel_mps2": quality.accel_residuals.tolist(),
        }
        if quality.bench is not None:
            data["bench_uncertainty"] = {
                **_coefficients(quality.bench),
                "figures": dict(quality.bench_figures),
            }
    data["rate_unit"], data["accel_unit"] = found.rate_unit, found.accel_unit
    data["provenance"] = dict(found.provenance)
    data["warnings"] = [{"what": m.text(), "message": m.to_json()} for m in found.warnings]
    return data


def from_json(data: object) -> ImuCalibration:
    """The inverse of :func:`to_json`; raises InputError naming the key that is wrong."""
    reader = JsonReader(data)
    if reader.text("format", FORMAT) != FORMAT or (
        "version" in reader.data and reader.whole("version") > VERSION
    ):
        raise InputError(
            "This is no calibration set that this software reads: “format” has to be {format}, “version” up "
            "to {version}.",
            format=FORMAT,
            version=VERSION,
        )
    coefficients = _read(reader)
    refuse_singular(coefficients)
    said = reader.object("provenance").data if reader.has("provenance") else {}
    provenance = {
        str(key): value
        for key, value in said.items()
        if isinstance(value, (str, float, int)) and value == value
    }
    return ImuCalibration(
        coefficients=coefficients,
        rate_unit=reader.choice("rate_unit", RATE_UNITS, ""),
        accel_unit=reader.choice("accel_unit", ACCEL_UNITS, ""),
        quality=_quality(reader) if reader.has("covariance") else None,
        warnings=tuple(
            message_from_json(entry.value("message"), entry.key("message"))
            for entry in reader.objects("warnings")
        ),
        provenance=provenance,
    )


def refuse_singular(coefficients: Coefficients) -> None:
    """Raises InputError where outputs cannot be turned back into rates and forces."""
    gyro, accel = coefficients.gyro, coefficients.accel
    for name, scale in (("gyro.E1", gyro.E1), ("accel.K1", accel.K1)):
        for axis, value in zip(AXES, scale, strict=True):
            if not 1e-12 <= abs(value) <= 1e12:
                raise InputError(
                    "The calibration set's {name} of channel {axis} is {value}: a scale factor is neither "
                    "zero nor without bounds. Calibrate the unit again.",
                    name=name,
                    axis=axis,
                    value=float(value),
                )
    for name, values in (("gyro.B0", gyro.B0), ("gyro.Bf", gyro.Bf), ("accel.K0", accel.K0)):
        if np.abs(values).max() > _LARGEST:
            raise InputError(
                "The calibration set's {name} goes up to {value}, which is not of a unit that works: "
                "calibrate the unit again.",
                name=name,
                value=f"{np.abs(values).max():.3g}",
            )
    for name, matrix in (("I + E", np.eye(3) + gyro.E), ("I + K", np.eye(3) + accel.K)):
        if np.linalg.cond(matrix) > _LARGEST_CONDITION:
            raise InputError(
                "The calibration set's matrix {name} is singular: two channels show the same axis, and their "
                "outputs cannot be turned back. Check the misalignments in the file.",
                name=name,
            )


def _coefficients(found: Coefficients) -> dict[str, Any]:
    gyro, accel = found.gyro, found.accel
    return {
        "gyro": {
            "E1": gyro.E1.tolist(),
            "B0": gyro.B0.tolist(),
            "Bf": gyro.Bf.tolist(),
            "E": gyro.E.tolist(),
        },
        "accel": {"K1": accel.K1.tolist(), "K0": accel.K0.tolist(), "K": accel.K.tolist()},
    }


def _read(reader: JsonReader) -> Coefficients:
    gyro, accel = reader.object("gyro"), reader.object("accel")
    found = Coefficients(
        GyroCoefficients(
            E1=_array(gyro, "E1", (3,)),
            B0=_array(gyro, "B0", (3,)),
            Bf=_array(gyro, "Bf", (3, 3)),
            E=_array(gyro, "E", (3, 3)),
        ),
        AccelCoefficients(
            K1=_array(accel, "K1", (3,)), K0=_array(accel, "K0", (3,)), K=_array(accel, "K", (3, 3))
        ),
    )
    for part, name, matrix in ((gyro, "E", found.gyro.E), (accel, "K", found.accel.K)):
        if np.diagonal(matrix).any():
            raise part.fault(name, Message("a matrix with zeros on its diagonal"))
    return found


def _quality(reader: JsonReader) -> Quality:
    covariance, condition = reader.object("covariance"), reader.object("condition_number")
    residuals = reader.object("residuals")
    positions = residuals.texts("positions")
    if len(positions) > _MOST_POSITIONS:
        raise residuals.fault("positions", Message("a list"))
    bench = reader.object("bench_uncertainty") if reader.has("bench_uncertainty") else None
    figures = bench.object("figures") if bench is not None else None
    return Quality(
        standard_uncertainty=_uncertainty(reader, "standard_uncertainty"),
        gyro_covariance=_array(covariance, "gyro", (3, 7, 7)),
        accel_covariance=_array(covariance, "accel", (3, 4, 4)),
        gyro_condition=condition.number("gyro"),
        accel_condition=condition.number("accel"),
        turns_condition=condition.number("turns"),
        gyro_residuals=_array(residuals, "gyro_dps", (len(positions), 3)),
        accel_residuals=_array(residuals, "accel_mps2", (len(positions), 3)),
        positions=positions,
        bench=None if bench is None else _uncertainty(reader, "bench_uncertainty"),
        bench_figures={} if figures is None else {key: figures.number(key) for key in figures.data},
    )


def _uncertainty(reader: JsonReader, name: str) -> Coefficients:
    """Coefficients' uncertainties: not below zero."""
    found = _read(reader.object(name))
    if min(float(part.min()) for part in found.vectors()) < 0.0:
        raise reader.fault(name, Message("numbers of zero or more"))
    return found


def _array(reader: JsonReader, name: str, shape: tuple[int, ...]) -> Array:
    """A nested list of finite numbers of this shape."""

    def checked(value: object, key: str, left: tuple[int, ...]) -> list[Any]:
        within = JsonReader({key: value})
        if not isinstance(value, list) or len(value) != left[0]:
            raise reader.fault(name, Message("numbers in the shape {shape}", shape="×".join(map(str, shape))))
        if len(left) == 1:
            return list(within.numbers(key))
        return [checked(entry, f"{key}[{i}]", left[1:]) for i, entry in enumerate(value)]

    return np.array(checked(reader.value(name), reader.key(name), shape), dtype=np.float64).reshape(shape)
