"""Transfer alignment on recordings: a reference's velocity, position and attitude, and a unit's gyros and
accelerometers on the same carrier. The mathematics is :mod:`ahrs_lab.inertial.transfer_alignment`.

The unit is navigated here. Its recording's ``[initial]`` says where it begins; what that leaves out, and all
of it where there is none, is copied from the reference (one-shot transfer): then its misalignment at the
start is how its case stands against the reference's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from ahrs_lab.analysis.navigation_record import NavigationRecord, navigation_record
from ahrs_lab.analysis.transfer_alignment_result import TransferResult
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.attitude import attitude_matrix
from ahrs_lab.inertial.transfer_alignment import (
    Reference,
    Start,
    TransferAlignment,
    align,
    carried_over,
)
from ahrs_lab.inertial.transfer_alignment_model import (
    ACCEL_BIAS,
    EARTH_RADIUS_M,
    GYRO_BIAS,
    METHODS,
    MOUNTING,
    Assumptions,
    MethodName,
)
from ahrs_lab.inertial.transfer_alignment_motion import Increments, Motion
from ahrs_lab.messages import Message
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import ATTITUDE, POSITION, VELOCITY_ENU
from ahrs_lab.recording.segment import RecordingHeader

Array = NDArray[np.float64]

LEAST_COMPARISONS = 10
WIDENINGS = 2
FAR_BEYOND = 2.5
"""An estimate beyond this many assumed standard deviations contradicts the assumption."""
UNLIKE_NIS = 225.0
"""Differences of fifteen times their standard deviation are no matter of noise settings."""
POLAR_LATITUDE_DEG = 85.0


@dataclass(frozen=True)
class TransferSettings:
    """``every_s``: least time between two comparisons; ``lever_m``: the unit's place from the reference's
    along the unit's axes."""

    method: MethodName
    assumed: Assumptions
    every_s: float = 1.0
    lever_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    reference_segment: str | None = None


@dataclass(frozen=True)
class _Track:
    """The reference's m rows: ``state`` (m, 6) is velocity, latitude and longitude rad, altitude."""

    t_s: Array
    state: Array
    attitude: Slerp | None

    def at(self, t_s: Array) -> tuple[Array, Array | None]:
        """Interpolated; t_s (n,) within the record, to half a sample of the unit."""
        inside = np.clip(t_s, self.t_s[0], self.t_s[-1])
        state = np.column_stack([np.interp(inside, self.t_s, column) for column in self.state.T])
        return state, None if self.attitude is None else self.attitude(inside).as_matrix()


def transfer_align(reference: Recording, unit: Recording, settings: TransferSettings) -> TransferResult:
    """Align the unit of one recording against the reference of the other; raises InputError."""
    record = navigation_record(unit)
    track, found = _track(reference, unit.header, settings)
    warnings = [*record.warnings, *found]
    increments = Increments(
        record.t_s, record.interval_s, record.angle_rad.T[np.newaxis], record.velocity_mps.T[np.newaxis]
    )
    instants = _instants(record, track, settings.every_s)
    start = _start(record, unit.header, track, settings)
    state, attitude = track.at(instants)
    compared = Reference(
        instants,
        state[np.newaxis, :, :3],
        state[np.newaxis, :, 3],
        state[np.newaxis, :, 4],
        state[np.newaxis, :, 5],
        None if attitude is None else attitude[np.newaxis],
    )
    lever = np.array(settings.lever_m) if any(settings.lever_m) else None
    assumed = settings.assumed
    widened: dict[str, Message] = {}
    for attempt in range(WIDENINGS + 1):
        try:
            # what runs out of bounds is told below, not by numpy
            with np.errstate(all="ignore"):
                aligned = align(increments, compared, start, settings.method, assumed, lever)
        except (np.linalg.LinAlgError, ValueError) as error:
            raise _unlike() from error
        wider, told = _widened(aligned, assumed, start.copied)
        if not told or attempt == WIDENINGS:
            break
        assumed, widened = wider, widened | told
    result = TransferResult(aligned, assumed, start.copied, compared, (*warnings, *widened.values()))
    nis, expected, _, _ = result.nis
    if not nis < UNLIKE_NIS * expected:
        raise _unlike()
    return result


def _widened(
    aligned: TransferAlignment, assumed: Assumptions, copied: bool
) -> tuple[Assumptions, dict[str, Message]]:
    """What was found far beyond what was assumed of it becomes the assumption, and is told."""
    degree, per_hour = float(np.radians(1.0)), float(np.radians(1.0)) / 3600.0
    at_start = aligned.misalignment_at_start[0]
    found = aligned.estimate[0, -1]
    method = aligned.method
    own = not (copied and method.needs_attitude)
    candidates = (
        (GYRO_BIAS.start in method.estimated, "gyro_bias", found[GYRO_BIAS], per_hour, "°/h", _GYRO),
        (ACCEL_BIAS.start in method.estimated, "accel_bias", found[ACCEL_BIAS], 1e-3, "mm/s²", _ACCEL),
        (MOUNTING.start in method.estimated, "mounting", found[MOUNTING], degree, "°", _MOUNTING),
        (own, "level", at_start[:2], degree, "°", _LEVEL),
        (own, "azimuth", at_start[2:], degree, "°", _AZIMUTH),
    )
    changes: dict[str, float] = {}
    told: dict[str, Message] = {}
    for counts, field, values, unit, name, label in candidates:
        largest, known = float(np.max(np.abs(values))), float(getattr(assumed, field))
        if counts and np.isfinite(largest) and largest > FAR_BEYOND * known:
            changes[field] = largest
            told[field] = Message(
                "{what}: {found} {unit} was found, which the assumption does not allow; so much is assumed.",
                what=label,
                found=f"{largest / unit:.3g}",
                unit=name,
            )
    return replace(assumed, **changes), told


_GYRO = Message("the unit's gyro bias")
_ACCEL = Message("the unit's accelerometer bias")
_MOUNTING = Message("mounting of the unit's case")
_LEVEL = Message("misalignment at the start, level")
_AZIMUTH = Message("misalignment at the start, azimuth")


def _unlike() -> InputError:
    return InputError(
        "The recordings contradict each other by far more than their assumed noise: are both of the same "
        "carrier and on one time base, their columns in the units of recording.toml, and the unit's axes x "
        "right, y forward, z up?"
    )


def _track(
    reference: Recording, unit: RecordingHeader, settings: TransferSettings
) -> tuple[_Track, list[Message]]:
    """The reference's columns; what it lacks and the unit's ``[initial]`` or the site has, from there."""
    segment = _reference_segment(reference, settings)
    samples, warnings = segment.samples, [finding.placed for finding in segment.findings]
    needed = [*(POSITION if settings.method == "position" else VELOCITY_ENU)]
    if METHODS[settings.method].needs_attitude:
        needed += ATTITUDE
    missing = [name for name in needed if name not in samples]
    if missing:
        raise InputError(
            "{file} of the reference has no column {missing}, which the method {method} compares.",
            file=segment.segment.file,
            missing=", ".join(missing),
            method=settings.method,
        )
    used = list(needed)
    for group in (VELOCITY_ENU, POSITION, ATTITUDE):
        # what is not compared helps at the start, unless it is mostly not there
        there = group[0] not in needed and all(name in samples for name in group)
        if there and np.mean(np.all(np.isfinite(samples.matrix(group)), axis=1)) > 0.5:
            used += group
    good = np.all(np.isfinite(samples.matrix(used)), axis=1)
    if np.sum(good) < 2:
        raise InputError(
            "{file} of the reference has no two rows with all of {columns}.",
            file=segment.segment.file,
            columns=", ".join(used),
        )
    t_s = samples["t_s"][good]
    values = {name: samples[name][good] for name in used}
    _check_values(segment, values)
    if any(name not in values for name in POSITION):
        initial = unit.initial or {}
        site = reference.header.site
        place = (site.latitude_deg, site.longitude_deg or 0.0, site.altitude_m)
        warnings.append(
            Message("The reference has no position: the carrier's path is reckoned from its velocity.")
        )
        values |= _reckoned(
            t_s,
            values,
            [_number({n: p, **initial}, n) for n, p in zip(POSITION, place, strict=True)],
        )
    if any(name not in values for name in VELOCITY_ENU):
        warnings.append(
            Message("The reference has no velocity: the unit's at the start is the slope of the position.")
        )
        values |= _differentiated(t_s, values)
    state = np.column_stack(
        [
            *(values[name] for name in VELOCITY_ENU),
            np.radians(values["latitude_deg"]),
            np.unwrap(np.radians(values["longitude_deg"])),
            values["altitude_m"],
        ]
    )
    slerp = None
    if all(name in values for name in ATTITUDE):
        C = attitude_matrix(*(values[name] for name in ATTITUDE))
        slerp = Slerp(t_s, Rotation.from_matrix(C))
    return _Track(t_s, state, slerp), warnings


def _reference_segment(reference: Recording, settings: TransferSettings) -> RecordedSegment:
    name = settings.reference_segment
    chosen = [s for s in reference.segments if name is None or name in (s.segment.file, s.segment.name)]
    if not chosen:
        raise InputError(
            "The reference's recording has no segment {name}; there are: {known}.",
            name=name or "–",
            known=", ".join(one.segment.file for one in reference.segments),
        )
    usable = next((one for one in chosen if one.usable), None)
    if usable is None:
        found = (f.placed for s in chosen for f in s.findings)
        raise InputError(
            "No segment of the reference's recording can be used: {what}", what=next(found, Message("–"))
        )
    return usable


def _check_values(segment: RecordedSegment, values: Mapping[str, Array]) -> None:
    for name, limit in (("latitude_deg", 90.0), ("longitude_deg", 360.0), ("pitch_deg", 90.0)):
        if name in values and np.max(np.abs(values[name])) > limit:
            raise InputError(
                "{file} of the reference: {column} reaches {value}; it has to lie within ±{limit}°. Is the "
                "column in degrees?",
                file=segment.segment.file,
                column=name,
                value=float(values[name][np.argmax(np.abs(values[name]))]),
                limit=limit,
            )
    if "latitude_deg" in values and np.max(np.abs(values["latitude_deg"])) > POLAR_LATITUDE_DEG:
        raise InputError(
            "The carrier comes beyond {limit}° of latitude: so near a pole east and north are no frame to "
            "align in.",
            limit=POLAR_LATITUDE_DEG,
        )


def _reckoned(t_s: Array, values: Mapping[str, Array], place: list[float]) -> dict[str, Array]:
    step = np.diff(t_s, prepend=t_s[0])
    latitude = place[0] + np.degrees(np.cumsum(values["vn_mps"] * step)) / EARTH_RADIUS_M
    east = np.cumsum(values["ve_mps"] * step / np.cos(np.radians(latitude)))
    return {
        "latitude_deg": latitude,
        "longitude_deg": place[1] + np.degrees(east) / EARTH_RADIUS_M,
        "altitude_m": place[2] + np.cumsum(values["vu_mps"] * step),
    }


def _differentiated(t_s: Array, values: Mapping[str, Array]) -> dict[str, Array]:
    latitude = np.radians(values["latitude_deg"])
    longitude = np.unwrap(np.radians(values["longitude_deg"]))
    return {
        "ve_mps": EARTH_RADIUS_M * np.cos(latitude) * np.gradient(longitude, t_s),
        "vn_mps": EARTH_RADIUS_M * np.gradient(latitude, t_s),
        "vu_mps": np.gradient(values["altitude_m"], t_s),
    }


def _instants(record: NavigationRecord, track: _Track, every_s: float) -> Array:
    """Ends of the unit's intervals at which the reference shows something, at least ``every_s`` apart."""
    if not (isfinite(every_s) and every_s > 0):
        raise InputError("The time between comparisons is {every} s: it has to be above 0.", every=every_s)
    begin, end = float(record.t_s[0] - record.interval_s[0]), float(record.t_s[-1])
    if track.t_s[0] > end or track.t_s[-1] < begin:
        raise InputError(
            "The recordings do not overlap: the reference runs from {r0} s to {r1} s, the unit from {u0} s "
            "to {u1} s. Bring both on one time base.",
            r0=f"{track.t_s[0]:.3f}",
            r1=f"{track.t_s[-1]:.3f}",
            u0=f"{begin:.3f}",
            u1=f"{end:.3f}",
        )
    near = np.clip(np.searchsorted(record.t_s, track.t_s), 1, len(record.t_s) - 1)
    near -= track.t_s - record.t_s[near - 1] < record.t_s[near] - track.t_s
    close = np.abs(record.t_s[near] - track.t_s) <= 0.51 * float(np.median(record.interval_s))
    ends = record.t_s[np.unique(near[close])]
    chosen: list[float] = []
    for t_s in ends:
        if not chosen or t_s - chosen[-1] >= every_s - 1e-6:
            chosen.append(float(t_s))
    if len(chosen) <= LEAST_COMPARISONS:
        raise InputError(
            "The recordings have only {count} instants in common, every {every} s; at least {least} are "
            "needed. Record longer, or compare more often.",
            count=len(chosen),
            every=every_s,
            least=LEAST_COMPARISONS + 1,
        )
    return np.array(chosen)


def _start(
    record: NavigationRecord, unit: RecordingHeader, track: _Track, settings: TransferSettings
) -> Start:
    """The unit's state at its start, or where the reference begins if that is what it is copied from."""
    initial = unit.initial or {}
    own_attitude = all(name in initial for name in ATTITUDE)
    begin = float(record.t_s[0] - record.interval_s[0])
    whole = own_attitude and "velocity_enu_mps" in initial and all(name in initial for name in POSITION)
    if not whole and track.t_s[0] > begin:
        if initial:
            raise InputError(
                "[initial] of the unit's recording does not give its whole state, and the reference begins "
                "only at {time} s, after it: add heading, pitch, roll, velocity and position to [initial], "
                "or leave it out.",
                time=f"{track.t_s[0]:.3f}",
            )
        begin = float(record.t_s[np.searchsorted(record.t_s, track.t_s[0] - 1e-6)])
    state, attitude = track.at(np.array([begin]))
    if not own_attitude and attitude is None:
        raise InputError(
            "Nobody says how the unit stands at the start: give heading_deg, pitch_deg and roll_deg in "
            "[initial] of its recording, or as columns of the reference."
        )
    C = attitude if not own_attitude else attitude_matrix(*([_number(initial, name)] for name in ATTITUDE))
    copied = Motion(np.asarray(C), state[:, :3], state[:, 3], state[:, 4], state[:, 5])
    if any(settings.lever_m):
        row = int(np.searchsorted(record.t_s, begin + 1e-6))
        rate = record.angle_rad[:, row] / record.interval_s[row]
        copied = carried_over(copied, copied.C_bn, rate[np.newaxis], np.array(settings.lever_m))
    place = [np.array([_number(initial, name)]) if name in initial else None for name in POSITION]
    velocity = _velocity(initial)
    motion = Motion(
        copied.C_bn,
        copied.velocity if velocity is None else velocity,
        copied.latitude if place[0] is None else np.radians(place[0]),
        copied.longitude if place[1] is None else np.radians(place[1]),
        copied.altitude if place[2] is None else place[2],
    )
    return Start(begin, motion, copied=not own_attitude)


def _number(initial: Mapping[str, Any], name: str) -> float:
    value = initial[name]
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise InputError("[initial] of the unit's recording: {name} is no number.", name=name)
    return float(value)


def _velocity(initial: Mapping[str, Any]) -> Array | None:
    if "velocity_enu_mps" not in initial:
        return None
    try:
        velocity = np.array([float(value) for value in initial["velocity_enu_mps"]])
    except (TypeError, ValueError):
        velocity = np.empty(0)
    if velocity.shape != (3,) or not np.all(np.isfinite(velocity)):
        raise InputError(
            "[initial] of the unit's recording: velocity_enu_mps has to be three numbers, m/s to east, "
            "north and up."
        )
    return velocity[np.newaxis]
