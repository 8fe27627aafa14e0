"""What the customer asks of a calibration's result: limits, the rule by which they are judged, units; and how
that is kept as JSON text.

The text may be older or have been edited: it is read with the checks of a file from outside.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, Literal

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conformity import RULES, DecisionRule
from ahrs_lab.metrology.json_reader import JsonReader
from ahrs_lab.metrology.limits import Limit, check_distinct

ScaleFactorUnit = Literal["", "ppm"]
ZeroOffsetUnit = Literal["", "deg/s", "deg/h"]
MisalignmentUnit = Literal["", "rad", "arcmin", "arcsec", "deg"]
SCALE_FACTOR_UNITS: tuple[ScaleFactorUnit, ...] = ("", "ppm")
ZERO_OFFSET_UNITS: tuple[ZeroOffsetUnit, ...] = ("", "deg/s", "deg/h")
MISALIGNMENT_UNITS: tuple[MisalignmentUnit, ...] = ("", "rad", "arcmin", "arcsec", "deg")


@dataclass(frozen=True)
class ResultUnits:
    """In which unit each group is reported; "": all the usual ones side by side.

    ``scale_factor`` "ppm" adds the deviation from 1 to K, which a dimensionless K alone has.
    """

    scale_factor: ScaleFactorUnit = ""
    zero_offset: ZeroOffsetUnit = ""
    misalignment: MisalignmentUnit = ""


@dataclass(frozen=True)
class Requirements:
    """Empty: no statement of conformity, the usual units. ``repeatability``: U of B shall include what B may
    be another day."""

    limits: tuple[Limit, ...] = ()
    rule: DecisionRule = field(default_factory=DecisionRule)
    units: ResultUnits = field(default_factory=ResultUnits)
    repeatability: bool = False

    def __post_init__(self) -> None:
        check_distinct(self.limits)


def requirements_to_json(requirements: Requirements) -> str:
    """As the records keep them; "" where nothing is asked."""
    if requirements == Requirements():
        return ""
    rule, units = requirements.rule, requirements.units
    data: dict[str, Any] = {
        "limits": [
            {
                "quantity": one.quantity,
                "low": one.low,
                "high": one.high,
                "unit": one.unit,
                "nominal": one.nominal,
            }
            for one in requirements.limits
        ],
        "rule": {"kind": rule.kind, "r": rule.r, "probability": rule.probability},
        "units": {
            "scale_factor": units.scale_factor,
            "zero_offset": units.zero_offset,
            "misalignment": units.misalignment,
        },
        "repeatability_in_U": requirements.repeatability,
    }
    return json.dumps(data, ensure_ascii=False, allow_nan=False)


def requirements_from_json(text: str) -> Requirements:
    """The inverse of :func:`requirements_to_json`; raises InputError for what it did not write."""
    if not text.strip():
        return Requirements()
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError("The limits of the job are not valid JSON: {reason}", reason=str(error)) from error
    reader = JsonReader(data, "limits")
    limits = tuple(
        Limit(
            one.text("quantity"),
            one.optional_number("low"),
            one.optional_number("high"),
            one.text("unit"),
            one.optional_number("nominal"),
        )
        for one in reader.objects("limits")
    )
    return Requirements(limits, _rule(reader), _units(reader), _flag(reader, "repeatability_in_U"))


def _rule(reader: JsonReader) -> DecisionRule:
    if not reader.has("rule"):
        return DecisionRule()
    rule = reader.object("rule")
    return DecisionRule(rule.choice("kind", RULES), rule.number("r", 1.0), _flag(rule, "probability"))


def _flag(reader: JsonReader, key: str) -> bool:
    value = reader.data.get(key, False)
    if not isinstance(value, bool):
        raise reader.fault(key, Message("true or false"))
    return value


def _units(reader: JsonReader) -> ResultUnits:
    if not reader.has("units"):
        return ResultUnits()
    units = reader.object("units")
    return ResultUnits(
        units.choice("scale_factor", SCALE_FACTOR_UNITS, ""),
        units.choice("zero_offset", ZERO_OFFSET_UNITS, ""),
        units.choice("misalignment", MISALIGNMENT_UNITS, ""),
    )
