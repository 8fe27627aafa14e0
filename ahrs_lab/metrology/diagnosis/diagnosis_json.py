"""The diagnosis as JSON and back: the key ``diagnosis`` beside the result's. Infinite degrees of freedom are
null."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass
from typing import Any, get_args

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import (
    AllanDiagnosis,
    Change,
    Diagnosis,
    DiagnosisFinding,
    FloorVerdict,
    Harmonic,
    LackOfFit,
    MisalignmentDiagnosis,
    Residuals,
    ScaleFactorDiagnosis,
    State,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.json_reader import JsonReader, message_from_json

_AXES = ("x", "y", "z")


def diagnosis_json(found: Diagnosis) -> dict[str, Any]:
    """By group and key, every number as it is."""
    return {
        "scale_factor": {key: _plain(one) for key, one in found.scale_factor.items()},
        "zero_offset": {key: _plain(one) for key, one in found.zero_offset.items()},
        "misalignment": {key: _plain(one) for key, one in found.misalignment.items()},
    }


def _plain(value: object) -> Any:
    """Records become objects under the names of their fields."""
    if isinstance(value, DiagnosisFinding):
        return {
            "state": value.state,
            "what": value.what.text(),
            "message": value.what.to_json(),
            "p": value.p,
            "segment": value.segment,
        }
    if is_dataclass(value):
        return {entry.name: _plain(getattr(value, entry.name)) for entry in fields(value)}
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and math.isinf(value) else value


def read_diagnosis(reader: JsonReader, pairs: tuple[str, ...]) -> Diagnosis:
    """The inverse of :func:`diagnosis_json`; ``pairs`` are the keys of L. Raises InputError that names the
    key at fault."""
    return Diagnosis(
        {key: _scale_factor(one) for key, one in reader.members("scale_factor", _AXES).items()},
        {key: _zero_offset(one) for key, one in reader.members("zero_offset", _AXES).items()},
        {key: _misalignment(one) for key, one in reader.members("misalignment", pairs).items()},
    )


def _scale_factor(reader: JsonReader) -> ScaleFactorDiagnosis:
    residuals = _residuals(reader.object("residuals"))
    count = len(residuals.residuals)
    return ScaleFactorDiagnosis(
        rates_dps=_numbers(reader, "rates_dps", count),
        order=_places(reader, "order", count, 1),
        full_scale=reader.number("full_scale"),
        residuals=residuals,
        trend=_change(reader, "trend"),
        lack_of_fit=_lack_of_fit(reader.object("lack_of_fit")) if reader.has("lack_of_fit") else None,
        drift=_change(reader, "drift"),
        findings=_findings(reader),
    )


def _zero_offset(reader: JsonReader) -> ZeroOffsetDiagnosis:
    return ZeroOffsetDiagnosis(
        residuals=_residuals(reader.object("residuals")) if reader.has("residuals") else None,
        harmonic=_harmonic(reader.object("harmonic")) if reader.has("harmonic") else None,
        allan=_allan(reader.object("allan")) if reader.has("allan") else None,
        findings=_findings(reader),
    )


def _misalignment(reader: JsonReader) -> MisalignmentDiagnosis:
    return MisalignmentDiagnosis(
        reader.number("rest_rate_dps"), reader.number("duration_difference_s"), _findings(reader)
    )


def _residuals(reader: JsonReader) -> Residuals:
    residuals = reader.numbers("residuals")
    count = len(residuals)
    segments = reader.texts("segments")
    if len(segments) != count:
        raise reader.fault("segments", _as_many(count))
    outliers = _places(reader, "outliers", None, 0)
    if any(place >= count for place in outliers):
        raise reader.fault("outliers", Message("places from {first} on", first=0))
    return Residuals(
        segments=segments,
        starts_s=_numbers(reader, "starts_s", count),
        residuals=residuals,
        standard_errors=_numbers(reader, "standard_errors", count),
        studentised=_numbers(reader, "studentised", count),
        dof=reader.whole("dof"),
        limit=reader.number("limit"),
        outliers=outliers,
        outlier_p=reader.number("outlier_p"),
    )


def _lack_of_fit(reader: JsonReader) -> LackOfFit:
    return LackOfFit(
        F=reader.number("F"),
        dof_fit=reader.number("dof_fit"),
        dof_noise=reader.dof("dof_noise"),
        p=reader.number("p"),
        share=reader.number("share"),
    )


def _harmonic(reader: JsonReader) -> Harmonic:
    azimuths, curve = reader.numbers("azimuths_deg"), reader.numbers("curve_azimuths_deg")
    return Harmonic(
        amplitude_dps=reader.number("amplitude_dps"),
        expected_dps=reader.number("expected_dps"),
        amplitude=_needed_change(reader.object("amplitude")),
        phase=_needed_change(reader.object("phase")),
        azimuths_deg=azimuths,
        rates_dps=_numbers(reader, "rates_dps", len(azimuths)),
        standard_error_dps=reader.number("standard_error_dps"),
        curve_azimuths_deg=curve,
        fitted_dps=_numbers(reader, "fitted_dps", len(curve)),
        expected_curve_dps=_numbers(reader, "expected_curve_dps", len(curve)),
    )


def _allan(reader: JsonReader) -> AllanDiagnosis:
    taus, model = _positive(reader, "taus_s", None), _positive(reader, "model_taus_s", None)
    return AllanDiagnosis(
        taus_s=taus,
        deviations_dps=_positive(reader, "deviations_dps", len(taus)),
        low_dps=_positive(reader, "low_dps", len(taus)),
        high_dps=_positive(reader, "high_dps", len(taus)),
        model_taus_s=model,
        model_dps=_numbers(reader, "model_dps", len(model)),
        white=reader.number("white"),
        flicker_dps=reader.number("flicker_dps"),
        walk=reader.number("walk"),
        duration_s=reader.number("duration_s"),
        at_duration_dps=reader.number("at_duration_dps"),
        verdict=reader.choice("verdict", get_args(FloorVerdict)),
    )


def _findings(reader: JsonReader) -> tuple[DiagnosisFinding, ...]:
    return tuple(
        DiagnosisFinding(
            state=one.choice("state", get_args(State)),
            what=message_from_json(one.value("message"), one.key("message")),
            p=one.optional_number("p"),
            segment=one.text("segment", ""),
        )
        for one in reader.objects("findings")
    )


def _change(reader: JsonReader, name: str) -> Change | None:
    return _needed_change(reader.object(name)) if reader.has(name) else None


def _needed_change(reader: JsonReader) -> Change:
    return Change(reader.number("value"), reader.number("standard"), reader.dof("dof"), reader.number("p"))


def _numbers(reader: JsonReader, name: str, count: int | None) -> tuple[float, ...]:
    found = reader.numbers(name)
    if count is not None and len(found) != count:
        raise reader.fault(name, _as_many(count))
    return found


def _positive(reader: JsonReader, name: str, count: int | None) -> tuple[float, ...]:
    found = _numbers(reader, name, count)
    if any(value <= 0.0 for value in found):
        raise reader.fault(name, Message("numbers above zero"))
    return found


def _places(reader: JsonReader, name: str, count: int | None, first: int) -> tuple[int, ...]:
    found = _numbers(reader, name, count)
    if any(value != int(value) or value < first for value in found):
        raise reader.fault(name, Message("places from {first} on", first=first))
    return tuple(int(value) for value in found)


def _as_many(count: int) -> Message:
    return Message("a list of {count}", count=count)
