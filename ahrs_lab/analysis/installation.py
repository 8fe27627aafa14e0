"""Installation angles on recorded data: the bracket from a recording on the level carrier (or from readings),
and the carrier's angles from the unit's. The mathematics is :mod:`ahrs_lab.inertial.installation`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite, isnan
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.report import Chart, Curve, Report, Table
from ahrs_lab.analysis.report_cells import paired
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.installation import (
    Calibrated,
    Compensated,
    Direction,
    InstallationAngles,
    LevelCarrier,
    calibrate,
    compensate,
    compensation_covariance_deg2,
)
from ahrs_lab.messages import Message
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import ATTITUDE, Samples

Array = NDArray[np.float64]
Names = Literal["heading", "pitch", "roll"]

LEVEL_LIMIT_DEG = 1.0
"""A carrier further from level than this was not levelled."""
MOVED_DEG = 0.05
BLOCKS = 10
NOTE = "installation"
"""The table of ``recording.toml`` that tells of a compensation."""
_NAMES: tuple[Names, ...] = ("heading", "pitch", "roll")
_LIMITS_DEG = {"heading": 360.0, "pitch": 90.0, "roll": 180.0}


@dataclass(frozen=True)
class BracketResult:
    """The bracket with what it was read from."""

    reading: LevelCarrier
    calibrated: Calibrated
    warnings: tuple[Message, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """``bracket_deg`` and ``standard_uncertainty_deg`` by name (null where an input's is not stated),
        ``covariance_deg2`` in the order heading, pitch, roll, ``direction``, and D as ``matrix``."""
        return {**bracket_to_json(self.calibrated), "warnings": [warning.text() for warning in self.warnings]}

    def report(self) -> Report:
        """A table of the angles, the formula and its direction."""
        u = self.calibrated.standard_uncertainty_deg
        rows = tuple(
            (name, *paired(value, float(u[i]), unstated=5))
            for i, (name, value) in enumerate(zip(_labels(), _values(self.calibrated.angles), strict=True))
        )
        head = (Message("angle"), Message("value, °"), Message("standard uncertainty, °"))
        notes = [_FORMULA]
        if np.any(np.isnan(u)):
            notes.append(
                Message(
                    "–: an uncertainty it rests on is not stated (the unit's pitch and roll, the carrier's "
                    "level, the survey of the heading error)."
                )
            )
        title = Message("Installation angles of the bracket")
        table = Table(Message("Attitude of the box relative to the carrier"), head, rows)
        return Report(title, (table,), notes=tuple(notes), warnings=self.warnings)


@dataclass(frozen=True)
class CarrierResult:
    """One corrected attitude; ``covariance_deg2`` (3, 3), what the bracket's uncertainty leaves in it, NaN
    where that is not known."""

    given_deg: tuple[float, float, float]
    corrected: Compensated
    covariance_deg2: Array

    @property
    def angles_deg(self) -> tuple[float, float, float]:
        """Heading, pitch and roll."""
        one = self.corrected
        return float(one.heading_deg), float(one.pitch_deg), float(one.roll_deg)

    def to_json(self) -> dict[str, Any]:
        """``heading_deg``, ``pitch_deg``, ``roll_deg``, ``gimbal_lock``, ``standard_uncertainty_deg``."""
        return {
            **dict(zip(ATTITUDE, self.angles_deg, strict=True)),
            "gimbal_lock": bool(self.corrected.gimbal_lock),
            "standard_uncertainty_deg": _by_name(np.sqrt(np.diag(self.covariance_deg2))),
        }

    def report(self) -> Report:
        """Given and corrected side by side."""
        u = np.sqrt(np.diag(self.covariance_deg2))
        rows = tuple(
            (name, f"{given:.5f}", *paired(angle, float(u[i]), unstated=5))
            for i, (name, given, angle) in enumerate(
                zip(_labels(), self.given_deg, self.angles_deg, strict=True)
            )
        )
        head = (
            Message("angle"),
            Message("unit, °"),
            Message("carrier, °"),
            Message("u from the bracket, °"),
        )
        title = Message("Attitude of the carrier")
        lock = (_LOCK,) if self.corrected.gimbal_lock else ()
        return Report(title, (Table(title, head, rows),), notes=(_FORMULA,), warnings=lock)


@dataclass(frozen=True)
class CarrierRecord:
    """A recording's angles corrected: ``t_s`` (n,) of all usable segments one after the other, ``given_deg``
    and ``corrected_deg`` (n, 3), ``locked`` rows in gimbal lock."""

    t_s: Array
    given_deg: Array
    corrected_deg: Array
    locked: int
    warnings: tuple[Message, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """``rows``, ``gimbal_lock_rows``, and the corrected angles of the first and the last row."""
        ends = {
            name: dict(zip(ATTITUDE, self.corrected_deg[row].tolist(), strict=True))
            for name, row in (("first", 0), ("last", -1))
        }
        return {"rows": len(self.t_s), "gimbal_lock_rows": self.locked, **ends}

    def report(self) -> Report:
        """The change of each angle over time."""
        change = (self.corrected_deg - self.given_deg + 180.0) % 360.0 - 180.0
        rows = tuple(
            (name, f"{np.min(one):.5f}", f"{np.mean(one):.5f}", f"{np.max(one):.5f}")
            for name, one in zip(_labels(), change.T, strict=True)
        )
        title = Message("Carrier minus unit")
        head = (Message("angle"), Message("least, °"), Message("mean, °"), Message("most, °"))
        curves = tuple(
            Curve(name, self.t_s, one, axis=axis)
            for name, one, axis in zip(_labels(), change.T, AXES, strict=True)
        )
        chart = Chart(title, Message("time, s"), Message("angle, °"), curves)
        locked = (
            (Message("{rows} rows are in gimbal lock. {what}", rows=self.locked, what=_LOCK),)
            if self.locked
            else ()
        )
        return Report(
            Message("Attitude of the carrier"),
            (Table(title, head, rows),),
            (chart,),
            notes=(_FORMULA, _AXES),
            warnings=(*locked, *self.warnings),
        )


_FORMULA = Message(
    "C(carrier) = C(unit)·D with C from body to east, north, up; D = C(δ)ᵀ where δ is the attitude of the "
    "box relative to the carrier, D = C(δ) where it is the carrier's relative to the box."
)
_AXES = Message(
    "Only heading, pitch and roll are the carrier's; rates and specific forces stay along the unit's own "
    "axes."
)
_LOCK = Message(
    "Gimbal lock: the corrected pitch is within 0.2″ of ±90°, where heading and roll turn about the same "
    "line. Together they describe the attitude, alone neither means anything."
)


def calibrate_bracket(reading: LevelCarrier, warnings: tuple[Message, ...] = ()) -> BracketResult:
    """The bracket's angles from what was read; raises InputError for what cannot be."""
    check_angle("pitch", reading.unit_pitch_deg, Message("the unit's pitch"))
    check_angle("roll", reading.unit_roll_deg, Message("the unit's roll"))
    check_angle("heading", reading.heading_error_deg, Message("the surveyed heading error"))
    for value in (reading.u_attitude_deg, reading.u_level_deg, reading.u_heading_error_deg):
        if value is not None and not (isfinite(value) and value >= 0):
            raise InputError("A standard uncertainty is {value}°: it has to be 0 or more.", value=value)
    for value in (reading.carrier_pitch_deg, reading.carrier_roll_deg):
        if not abs(value) <= LEVEL_LIMIT_DEG:
            raise InputError(
                "The carrier was {value}° from level: level it to within {limit}° and align the unit again; "
                "what then is left is taken into account.",
                value=value,
                limit=LEVEL_LIMIT_DEG,
            )
    calibrated = calibrate(reading)
    if abs(calibrated.angles.pitch_deg) > 89.0:
        raise InputError(
            "The bracket's pitch is {pitch}°: so near the vertical its axis has no heading to be surveyed. "
            "Name the unit's axes otherwise.",
            pitch=round(calibrated.angles.pitch_deg, 3),
        )
    return BracketResult(reading, calibrated, warnings)


def level_reading(recording: Recording, file: str | None, reading: LevelCarrier) -> BracketResult:
    """The bracket from the mean pitch and roll of a recording on the level carrier; ``reading`` has the rest.

    The scatter of ten block means adds to the unit's uncertainty, where that is stated.
    """
    recorded = _angles_segments(recording, file)[0]
    angles = recorded.samples.matrix(ATTITUDE[1:])
    angles = angles[np.all(np.isfinite(angles), axis=1)]
    if len(angles) < BLOCKS:
        raise InputError(
            "{file}: {rows} rows with pitch and roll are too few for a mean; at least {least}.",
            file=recorded.segment.file,
            rows=len(angles),
            least=BLOCKS,
        )
    blocks = np.array([np.mean(block, axis=0) for block in np.array_split(angles, BLOCKS)])
    pitch, roll = (float(angle) for angle in np.mean(angles, axis=0))
    scatter = float(np.max(np.std(blocks, axis=0, ddof=1))) / BLOCKS**0.5
    stated = reading.u_attitude_deg
    moved = float(np.max(np.ptp(blocks, axis=0)))
    warnings = [finding.placed for finding in recorded.findings]
    if moved > LEVEL_LIMIT_DEG:
        raise InputError(
            "{file}: pitch or roll moved by {moved}° while the level carrier was recorded: record it at "
            "rest.",
            file=recorded.segment.file,
            moved=f"{moved:.3f}",
        )
    if moved > MOVED_DEG:
        warnings.append(
            Message(
                "{file}: pitch or roll moved by {moved}° while the level carrier was recorded.",
                file=recorded.segment.file,
                moved=f"{moved:.3f}",
            )
        )
    full = replace(
        reading,
        unit_pitch_deg=pitch,
        unit_roll_deg=roll,
        u_attitude_deg=None if stated is None else float(np.hypot(stated, scatter)),
    )
    return calibrate_bracket(full, tuple(warnings))


def compensate_angles(
    heading_deg: float, pitch_deg: float, roll_deg: float, bracket: Calibrated
) -> CarrierResult:
    """One attitude; raises InputError for an angle that cannot be."""
    given = (heading_deg, pitch_deg, roll_deg)
    for name, value, label in zip(_NAMES, given, _labels(), strict=True):
        check_angle(name, value, label)
    return CarrierResult(
        given, compensate(*given, bracket.angles), compensation_covariance_deg2(*given, bracket)
    )


def compensate_recording(recording: Recording, bracket: Calibrated) -> CarrierRecord:
    """All usable segments that have the angles; raises InputError where it was done already."""
    if NOTE in recording.header.notes:
        raise InputError(
            "The recording's angles are the carrier's already: it has been compensated for installation "
            "angles. Take the original."
        )
    parts = _angles_segments(recording, None)
    rows = [one.samples.matrix(ATTITUDE) for one in parts]
    given, times = np.concatenate(rows), np.concatenate([one.samples["t_s"] for one in parts])
    finite = np.all(np.isfinite(given), axis=1)
    given, times = given[finite], times[finite]
    if not len(given):
        raise InputError("No row of the recording has all of heading_deg, pitch_deg and roll_deg.")
    if np.max(np.abs(given[:, 1])) > 90.0:
        raise InputError(
            "pitch_deg reaches {pitch}: pitch lies between −90° and 90°. Are the columns in degrees and in "
            "their order?",
            pitch=float(given[np.argmax(np.abs(given[:, 1])), 1]),
        )
    found = compensate(given[:, 0], given[:, 1], given[:, 2], bracket.angles)
    corrected = np.column_stack([found.heading_deg, found.pitch_deg, found.roll_deg])
    warnings = tuple(finding.placed for one in parts for finding in one.findings)
    return CarrierRecord(times, given, corrected, int(np.sum(found.gimbal_lock)), warnings)


def compensated_samples(recorded: RecordedSegment, bracket: InstallationAngles) -> Samples:
    """The segment's samples with the carrier's angles; unchanged where it has none."""
    samples = recorded.samples
    if any(name not in samples for name in ATTITUDE):
        return samples
    found = compensate(samples["heading_deg"], samples["pitch_deg"], samples["roll_deg"], bracket)
    return samples.with_columns(
        dict(zip(ATTITUDE, (found.heading_deg, found.pitch_deg, found.roll_deg), strict=True))
    )


def known_bracket(
    heading_deg: float, pitch_deg: float, roll_deg: float, direction: Direction = "box-in-aircraft"
) -> Calibrated:
    """A bracket whose angles are given without uncertainty; raises InputError for what cannot be."""
    for name, value, label in zip(_NAMES, (heading_deg, pitch_deg, roll_deg), _labels(), strict=True):
        check_angle(name, value, Message("the bracket's {angle}", angle=label))
    return Calibrated(
        InstallationAngles(heading_deg, pitch_deg, roll_deg, direction), np.full((3, 3), np.nan)
    )


def bracket_to_json(bracket: Calibrated) -> dict[str, Any]:
    """What ``--save`` writes and ``--set`` reads."""
    return {
        "bracket_deg": dict(zip(_NAMES, _values(bracket.angles), strict=True)),
        "standard_uncertainty_deg": _by_name(bracket.standard_uncertainty_deg),
        "covariance_deg2": [
            [None if isnan(value) else value for value in row] for row in bracket.covariance_deg2.tolist()
        ],
        "direction": bracket.angles.direction,
        "matrix": bracket.angles.compensation_matrix.tolist(),
    }


def bracket_from_json(data: Any, where: str) -> Calibrated:
    """The inverse of :func:`bracket_to_json`; raises InputError, which names the file ``where``."""
    try:
        angles = [float(data["bracket_deg"][name]) for name in _NAMES]
        direction = data["direction"]
        rows = data.get("covariance_deg2", [[None] * 3] * 3)
        covariance = np.array([[np.nan if v is None else float(v) for v in row] for row in rows])
        if direction not in ("box-in-aircraft", "aircraft-in-box") or covariance.shape != (3, 3):
            raise ValueError
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(
            "{where} is no set of installation angles: the calibration of the installation angles saves one.",
            where=where,
        ) from error
    checked = known_bracket(angles[0], angles[1], angles[2], direction)
    return replace(checked, covariance_deg2=covariance)


def check_angle(kind: Names, value: float, label: Message) -> None:
    """Raises InputError for an angle that is no number or beyond its range."""
    limit = _LIMITS_DEG[kind]
    if not (isfinite(value) and abs(value) <= limit):
        raise InputError(
            "{what} is {value}: it has to be an angle in degrees within ±{limit}°.",
            what=label,
            value=value,
            limit=limit,
        )


def _angles_segments(recording: Recording, file: str | None) -> list[RecordedSegment]:
    chosen = [
        one
        for one in recording.segments
        if one.usable
        and (file is None or file in (one.segment.file, one.segment.name))
        and all(name in one.samples for name in ATTITUDE)
    ]
    if not chosen:
        raise InputError(
            "No usable segment has the columns heading_deg, pitch_deg and roll_deg, which installation "
            "angles need."
        )
    return chosen


def _labels() -> tuple[Message, Message, Message]:
    return Message("heading"), Message("pitch"), Message("roll")


def _values(angles: InstallationAngles) -> tuple[float, float, float]:
    return angles.heading_deg, angles.pitch_deg, angles.roll_deg


def _by_name(values: Array) -> dict[str, float | None]:
    return {
        name: None if isnan(value) else value for name, value in zip(_NAMES, values.tolist(), strict=True)
    }
