"""The result as JSON, as ``evaluate --json`` prints it, and back.

The published keys are never taken away; what is beyond them (budgets, device, notes …) makes the round trip
complete. Infinite degrees of freedom are null, because JSON has no infinity.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from datetime import date, datetime, time
from typing import Any, cast, get_args

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.diagnosis_json import diagnosis_json, read_diagnosis
from ahrs_lab.metrology.json_reader import JsonReader, message_from_json
from ahrs_lab.metrology.result import (
    MISALIGNMENT_KEYS,
    AxisName,
    CalibrationResult,
    Environment,
    MisalignmentResult,
    Reported,
    ResultWarning,
    ScaleFactorResult,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.uncertainty_json import read_uncertainty, uncertainty_json

_AXES: tuple[AxisName, ...] = get_args(AxisName)
_RATE_SOURCES = ("demanded", "table")
_SCHEDULES = ("standard", "combined", "multi-position")


def to_json(result: CalibrationResult) -> dict[str, Any]:
    """A dict of what JSON knows, full precision; ValueError for a number that is not finite."""
    data = {
        **head_json(result),
        "scale_factor": {axis: _scale_factor(found) for axis, found in result.scale_factor.items()},
        "zero_offset": {axis: _zero_offset(found) for axis, found in result.zero_offset.items()},
        "misalignment": {key: _misalignment(found) for key, found in result.misalignment.items()},
        **reported_json(result),
        "diagnosis": None if result.diagnosis is None else diagnosis_json(result.diagnosis),
    }
    json.dumps(data, allow_nan=False)
    return data


def head_json(result: Reported) -> dict[str, Any]:
    """What a result begins with."""
    return {
        "procedure": result.procedure,
        "bundle_sha256": result.bundle_sha256,
        "software": result.software,
    }


def reported_json(result: Reported) -> dict[str, Any]:
    """What a result of any procedure says beside its quantities."""
    return {
        "warnings": [
            {
                "segment": warning.segment,
                "line": warning.line,
                "what": warning.what.text(),
                "message": warning.what.to_json(),
            }
            for warning in result.warnings
        ],
        "deviations": [
            {"what": message.text(), "message": message.to_json()} for message in result.deviations
        ],
        "environment": _environment(result.environment),
        "device": _plain(result.device),
        "site": _plain(result.site),
        "notes": _plain(result.notes),
        "simulated": result.simulated,
    }


def read_reported(reader: JsonReader) -> dict[str, Any]:
    """The inverse of :func:`head_json` and :func:`reported_json`, by the names of the fields."""
    return {
        "procedure": reader.text("procedure"),
        "bundle_sha256": reader.text("bundle_sha256"),
        "software": reader.text("software"),
        "warnings": tuple(_read_warning(entry) for entry in reader.objects("warnings")),
        "deviations": tuple(_read_sentence(entry) for entry in reader.objects("deviations")),
        "environment": _read_environment(reader),
        "device": dict(reader.object("device").data) if reader.has("device") else {},
        "site": dict(reader.object("site").data) if reader.has("site") else {},
        "notes": dict(reader.object("notes").data) if reader.has("notes") else {},
        "simulated": reader.data.get("simulated") is True,
    }


def to_json_text(result: CalibrationResult) -> str:
    """One JSON object, UTF-8 characters as they are."""
    return json.dumps(to_json(result), allow_nan=False, ensure_ascii=False, indent=1)


def from_json_text(text: str) -> CalibrationResult:
    """The inverse of :func:`to_json_text`; raises InputError for what is no result."""
    try:
        return from_json(json.loads(text))
    except (ValueError, RecursionError) as error:
        raise InputError("The result is not valid JSON: {reason}", reason=str(error)) from error


def from_json(data: object) -> CalibrationResult:
    """The inverse of :func:`to_json`; raises InputError that names the key at fault."""
    reader = JsonReader(data)
    return CalibrationResult(
        **read_reported(reader),
        scale_factor={
            cast(AxisName, axis): _read_scale_factor(cast(AxisName, axis), member)
            for axis, member in reader.members("scale_factor", _AXES).items()
        },
        zero_offset={
            cast(AxisName, axis): _read_zero_offset(cast(AxisName, axis), member)
            for axis, member in reader.members("zero_offset", _AXES).items()
        },
        misalignment={
            key: _read_misalignment(key, member)
            for key, member in reader.members("misalignment", MISALIGNMENT_KEYS).items()
        },
        diagnosis=(
            read_diagnosis(reader.object("diagnosis"), MISALIGNMENT_KEYS) if reader.has("diagnosis") else None
        ),
    )


def _scale_factor(found: ScaleFactorResult) -> dict[str, Any]:
    return {
        "K": found.K,
        "F0": found.F0,
        "unit": found.unit,
        **uncertainty_json(found.uncertainty),
        "rates_dps": list(found.rates_dps),
        "means": list(found.means),
        "residuals": list(found.residuals),
        "nonlinearity_ppm": found.nonlinearity_ppm,
        "asymmetry_ppm": found.asymmetry_ppm,
        "demanded_rates_dps": list(found.demanded_rates_dps),
        "standard_errors": list(found.standard_errors),
        "static_before": found.static_before,
        "static_after": found.static_after,
        "rate_source": found.rate_source,
        "segments": list(found.segments),
        "F0_uncertainty": None if found.F0_uncertainty is None else uncertainty_json(found.F0_uncertainty),
    }


def _read_scale_factor(axis: AxisName, reader: JsonReader) -> ScaleFactorResult:
    rates = reader.numbers("rates_dps")
    return ScaleFactorResult(
        axis=axis,
        K=reader.number("K"),
        F0=reader.number("F0"),
        unit=reader.text("unit"),
        rates_dps=rates,
        demanded_rates_dps=reader.numbers("demanded_rates_dps", rates),
        means=_as_many(reader, "means", rates),
        residuals=_as_many(reader, "residuals", rates),
        static_before=reader.number("static_before", 0.0),
        static_after=reader.number("static_after", 0.0),
        nonlinearity_ppm=reader.number("nonlinearity_ppm"),
        asymmetry_ppm=reader.number("asymmetry_ppm"),
        uncertainty=read_uncertainty(reader),
        rate_source=reader.choice("rate_source", _RATE_SOURCES, "demanded"),
        segments=reader.texts("segments"),
        standard_errors=reader.numbers("standard_errors", ()),
        F0_uncertainty=read_uncertainty(reader.object("F0_uncertainty"))
        if reader.has("F0_uncertainty")
        else None,
    )


def _as_many(reader: JsonReader, name: str, rates: tuple[float, ...]) -> tuple[float, ...]:
    found = reader.numbers(name)
    if len(found) != len(rates):
        raise InputError(
            "In the result, {key} has {count} numbers, but there are {rates} rates.",
            key=reader.key(name),
            count=len(found),
            rates=len(rates),
        )
    return found


def _zero_offset(found: ZeroOffsetResult) -> dict[str, Any]:
    return {
        "B": found.B,
        "unit": found.unit,
        "duration_s": found.duration_s,
        "angles_deg": list(found.angles_deg),
        **uncertainty_json(found.uncertainty),
        "schedule": found.schedule,
        "orientations": list(found.orientations),
        "azimuths_deg": list(found.azimuths_deg),
        "durations_s": list(found.durations_s),
        "repeatability_dps": found.repeatability_dps,
        "repeatability_cycles": found.repeatability_cycles,
        "repeatability_included": found.repeatability_included,
        "earth_rate_check": None if found.earth_rate_check is None else dict(found.earth_rate_check),
        "segments": list(found.segments),
    }


def _read_zero_offset(axis: AxisName, reader: JsonReader) -> ZeroOffsetResult:
    check = reader.object("earth_rate_check") if reader.has("earth_rate_check") else None
    return ZeroOffsetResult(
        axis=axis,
        B=reader.number("B"),
        unit=reader.text("unit"),
        duration_s=reader.number("duration_s"),
        angles_deg=reader.numbers("angles_deg"),
        uncertainty=read_uncertainty(reader),
        schedule=reader.choice("schedule", _SCHEDULES, "standard"),
        orientations=reader.texts("orientations"),
        azimuths_deg=reader.numbers("azimuths_deg", ()),
        durations_s=reader.numbers("durations_s", ()),
        repeatability_dps=reader.optional_number("repeatability_dps"),
        repeatability_cycles=(
            reader.whole("repeatability_cycles") if reader.has("repeatability_cycles") else 0
        ),
        repeatability_included=reader.data.get("repeatability_included") is True,
        earth_rate_check=None if check is None else {name: check.number(name) for name in check.data},
        segments=reader.texts("segments"),
    )


def _misalignment(found: MisalignmentResult) -> dict[str, Any]:
    return {
        "L": found.L,
        "unit": found.unit,
        "turns": found.turns,
        "angle_positive_deg": found.angle_positive_deg,
        "angle_negative_deg": found.angle_negative_deg,
        **uncertainty_json(found.uncertainty),
        "rate_dps": found.rate_dps,
        "duration_s": found.duration_s,
        "segments": list(found.segments),
    }


def _read_misalignment(key: str, reader: JsonReader) -> MisalignmentResult:
    return MisalignmentResult(
        output_axis=cast(AxisName, key[0]),
        turned_axis=cast(AxisName, key[1]),
        L=reader.number("L"),
        turns=reader.whole("turns"),
        angle_positive_deg=reader.number("angle_positive_deg"),
        angle_negative_deg=reader.number("angle_negative_deg"),
        uncertainty=read_uncertainty(reader),
        unit=reader.text("unit"),
        rate_dps=reader.number("rate_dps", 0.0),
        duration_s=reader.number("duration_s", 0.0),
        segments=reader.texts("segments"),
    )


def _read_warning(reader: JsonReader) -> ResultWarning:
    return ResultWarning(_read_sentence(reader), reader.text("segment"), reader.whole("line"))


def _read_sentence(reader: JsonReader) -> Message:
    """``message`` where our own software wrote it, else the plain sentence."""
    name = "message" if reader.has("message") else "what"
    return message_from_json(reader.value(name), reader.key(name))


def _environment(found: Environment | None) -> dict[str, float] | None:
    if found is None:
        return None
    return {
        "temperature_c": found.temperature_c,
        "temperature_spread_c": found.temperature_spread_c,
        "humidity_percent": found.humidity_percent,
        "humidity_spread_percent": found.humidity_spread_percent,
    }


def _read_environment(reader: JsonReader) -> Environment | None:
    if not reader.has("environment"):
        return None
    inside = reader.object("environment")
    return Environment(
        temperature_c=inside.number("temperature_c"),
        temperature_spread_c=inside.number("temperature_spread_c"),
        humidity_percent=inside.number("humidity_percent"),
        humidity_spread_percent=inside.number("humidity_spread_percent"),
    )


def _plain(value: object) -> Any:
    """What JSON knows: dates of TOML become ISO 8601 text, numbers that are not finite null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, (datetime, date, time)):
        return value.isoformat()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    return str(value)
