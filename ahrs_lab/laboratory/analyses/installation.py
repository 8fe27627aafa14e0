"""Installation angles: the bracket from a recording on the level carrier; a recording's angles corrected."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ahrs_lab.analysis.installation import (
    NOTE,
    bracket_from_json,
    bracket_to_json,
    calibrate_bracket,
    compensate_recording,
    compensated_samples,
    known_bracket,
    level_reading,
)
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.installation import Calibrated, LevelCarrier
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.laboratory.evaluation import SOFTWARE, write_json
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import Recording, read_bundle
from ahrs_lab.recording.write_whole import write_bundle

_DIRECTIONS = (
    ("box-in-aircraft", Message("of the box relative to the carrier")),
    ("aircraft-in-box", Message("of the carrier relative to the box")),
)
_MAXIMAL_SET_BYTES = 2**20


def read_bracket(path: Path) -> Calibrated:
    """The set of installation angles that a calibration saved; raises InputError for anything else."""
    try:
        with path.open("rb") as file:
            data = json.loads(file.read(_MAXIMAL_SET_BYTES))
    except (OSError, ValueError) as error:
        raise InputError("{path} cannot be read as JSON: {error}", path=path, error=error) from error
    return bracket_from_json(data, str(path))


def write_compensated(recording: Recording, bracket: Calibrated, target: Path) -> None:
    """A copy of ``recording`` with the carrier's angles, in a new folder or as an ``.ahrsrec``; the bracket,
    the software and the original's sha256 stand in its notes."""
    what = {
        "source_sha256": recording.sha256,
        "software": SOFTWARE,
        **_without_null(bracket_to_json(bracket)),
    }
    write_bundle(
        target,
        replace(recording.header, notes={**recording.header.notes, NOTE: what}),
        [
            (one.segment, compensated_samples(one, bracket.angles))
            for one in recording.segments
            if len(one.samples)
        ],
    )


def stated(value: Value) -> float | None:
    """A setting's uncertainty; below 0 stands for “not stated”."""
    return float(value) if float(value) >= 0 else None


def _calibrate(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    """Without a recording the unit's pitch and roll are settings too."""
    reading = LevelCarrier(
        unit_pitch_deg=float(settings.get("unit_pitch_deg", 0.0)),
        unit_roll_deg=float(settings.get("unit_roll_deg", 0.0)),
        heading_error_deg=float(settings["heading_error_deg"]),
        carrier_pitch_deg=float(settings["carrier_pitch_deg"]),
        carrier_roll_deg=float(settings["carrier_roll_deg"]),
        u_attitude_deg=stated(settings["u_attitude_deg"]),
        u_level_deg=stated(settings["u_level_deg"]),
        u_heading_error_deg=stated(settings["u_heading_error_deg"]),
    )
    if bundles:
        result = level_reading(read_bundle(bundles[0]), str(settings["segment"]) or None, reading)
    else:
        result = calibrate_bracket(reading)
    data = bracket_to_json(result.calibrated)
    return Outcome(
        result.to_json(), result.report(), saves={"installation.json": lambda path: write_json(data, path)}
    )


def _compensate(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    bracket = (
        read_bracket(Path(str(settings["set"])))
        if settings["set"]
        else known_bracket(
            float(settings["bracket_heading_deg"]),
            float(settings["bracket_pitch_deg"]),
            float(settings["bracket_roll_deg"]),
            "aircraft-in-box" if settings["direction"] == "aircraft-in-box" else "box-in-aircraft",
        )
    )
    recording = read_bundle(bundles[0])
    result = compensate_recording(recording, bracket)
    heading, pitch, roll = result.corrected_deg.T
    return Outcome(
        result.to_json(),
        result.report(),
        series={"t_s": result.t_s, "heading_deg": heading, "pitch_deg": pitch, "roll_deg": roll},
        saves={"corrected": lambda folder: write_compensated(recording, bracket, folder)},
    )


def _without_null(data: dict[str, Any]) -> dict[str, Any]:
    """TOML knows no null; an unknown uncertainty is left out."""
    unknown = [key for key, value in data.items() if "None" in str(value)]
    return {key: value for key, value in data.items() if key not in unknown}


def _angle(key: str, label: Message, limit: float = 180.0) -> Setting:
    return Setting(key, label, "number", 0.0, "°", -limit, limit)


def _uncertainty(key: str, label: Message) -> Setting:
    return Setting(key, label, "number", -1.0, "°", 0.0, 10.0, hint=Message("empty: not stated"), blank=-1.0)


CALIBRATE = AnalysisKind(
    key="installation-calibrate",
    name=Message("Installation angles: calibrate"),
    explains=Message(
        "The bracket's installation angles from a recording of the aligned unit on the level carrier and the "
        "surveyed heading error. It needs the columns heading_deg, pitch_deg and roll_deg."
    ),
    inputs=(Message("recording on the level carrier"),),
    settings=(
        _angle("heading_error_deg", Message("surveyed heading, bracket minus carrier")),
        _angle("carrier_pitch_deg", Message("the carrier's pitch that levelling left"), 1.0),
        _angle("carrier_roll_deg", Message("the carrier's roll that levelling left"), 1.0),
        _uncertainty("u_attitude_deg", Message("standard uncertainty of the unit's pitch and roll")),
        _uncertainty("u_level_deg", Message("standard uncertainty of the carrier's level")),
        _uncertainty("u_heading_error_deg", Message("standard uncertainty of the survey")),
        Setting("segment", Message("segment"), "text", "", hint=Message("empty: the first that can be used")),
    ),
    run=_calibrate,
)

COMPENSATE = AnalysisKind(
    key="installation-compensate",
    name=Message("Installation angles: compensate"),
    explains=Message(
        "The carrier's heading, pitch and roll from the unit's in a recording, with the bracket's "
        "installation angles; saves a corrected copy of the recording."
    ),
    inputs=(Message("recording of the unit"),),
    settings=(
        Setting("set", Message("saved installation angles"), "file", "", hint=Message("or the angles below")),
        _angle("bracket_heading_deg", Message("installation angle of heading δψ")),
        _angle("bracket_pitch_deg", Message("installation angle of pitch δθ"), 90.0),
        _angle("bracket_roll_deg", Message("installation angle of roll δγ")),
        Setting(
            "direction",
            Message("the angles are the attitude"),
            "choice",
            "box-in-aircraft",
            choices=_DIRECTIONS,
        ),
    ),
    run=_compensate,
)
