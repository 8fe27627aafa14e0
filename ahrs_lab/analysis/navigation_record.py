"""The rows that a recording is navigated by: its segments in order, as one record with known gaps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord, records
from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.recording.clean_rows import WRONG_RATE
from ahrs_lab.recording.read import Recording
from ahrs_lab.recording.samples import GAP_STEPS, Samples

Array = NDArray[np.float64]

LONGEST_GAP_S: Final = 1.0
"""A gap is bridged with the mean of the row after it; over a longer one that would be invention."""


@dataclass(frozen=True)
class NavigationRecord:
    """n rows of the segments ``files``: ``t_s`` (n,), ``interval_s`` (n,), increments ``angle_rad`` and
    ``velocity_mps`` (3, n); ``columns``: what else was recorded in every segment."""

    files: tuple[str, ...]
    t_s: Array
    interval_s: Array
    angle_rad: Array
    velocity_mps: Array
    columns: dict[str, Array]
    warnings: tuple[Message, ...]


def navigation_record(recording: Recording) -> NavigationRecord:
    """The segments that follow each other without a break, from the first of the recording.

    Raises InputError where the first cannot be used, or a gap is too long to bridge.
    """
    counting = [s for s in recording.segments if s.counts]
    usable = records(recording)
    if counting and usable[0].segment != counting[0].segment:
        raise InputError(
            "{file}: the first segment of the recording cannot be used, and [initial] is the state at its "
            "start.",
            file=counting[0].segment.file,
        )
    step_s = _step_s(usable[0], 1.0 / recording.header.device.sample_rate_hz)
    warnings: list[Message] = []
    parts: list[InertialRecord] = []
    for one in usable:
        record = _whole_rows(one, warnings).needed_si()
        if parts:
            pause = float(record.t_s[0] - step_s - parts[-1].t_s[-1])
            if not -0.5 * step_s <= pause <= LONGEST_GAP_S:
                warnings.append(
                    Message(
                        "{file} does not go on where {before} ends ({pause} s between them): navigation ends "
                        "there, for what happened between is not known.",
                        file=record.segment.file,
                        before=parts[-1].segment.file,
                        pause=f"{pause:.6g}",
                    )
                )
                break
        parts.append(record)
        warnings += record.warnings
    return _joined(parts, step_s, warnings)


def _step_s(record: InertialRecord, nominal_s: float) -> float:
    """The sample interval: the header's, unless the times contradict it (which the reader has said)."""
    typical = float(np.median(np.diff(record.t_s))) if len(record) > 2 else nominal_s
    return nominal_s if abs(typical / nominal_s - 1.0) <= WRONG_RATE else typical


def _joined(parts: list[InertialRecord], step_s: float, warnings: list[Message]) -> NavigationRecord:
    t_s = np.concatenate([part.t_s for part in parts])
    interval = np.diff(t_s, prepend=t_s[0] - step_s)
    gaps = np.flatnonzero(interval > GAP_STEPS * step_s)
    _judge_gaps(t_s, interval, gaps, step_s, parts, warnings)
    shared = set.intersection(*(set(part.samples.columns) for part in parts))
    return NavigationRecord(
        files=tuple(part.segment.file for part in parts),
        t_s=t_s,
        interval_s=interval,
        angle_rad=np.concatenate([part.rate for part in parts]).T * interval,
        velocity_mps=np.concatenate([part.needed_force() for part in parts]).T * interval,
        columns={name: np.concatenate([part.samples[name] for part in parts]) for name in shared},
        warnings=tuple(warnings),
    )


def _judge_gaps(
    t_s: Array,
    interval: Array,
    gaps: NDArray[np.int64],
    step_s: float,
    parts: list[InertialRecord],
    warnings: list[Message],
) -> None:
    if not len(gaps):
        return
    longest = int(gaps[np.argmax(interval[gaps])])
    if interval[longest] > LONGEST_GAP_S + step_s:
        starts = np.cumsum([len(part) for part in parts])
        raise InputError(
            "{file}: a gap of {gap} s after {time} s is too long to navigate over: the motion in it is not "
            "known. Up to {limit} s are bridged; cut the recording there, and give [initial] for the rest.",
            file=parts[int(np.searchsorted(starts, longest, "right"))].segment.file,
            gap=f"{interval[longest] - step_s:.6g}",
            time=f"{t_s[longest] - interval[longest]:.9g}",
            limit=LONGEST_GAP_S,
        )
    warnings.append(
        Message(
            "{count} gaps, {total} s together, are bridged: rate and specific force of the row after a gap "
            "are taken for all of it, without coning correction.",
            count=len(gaps),
            total=f"{float(np.sum(interval[gaps] - step_s)):.6g}",
        )
    )


def _whole_rows(record: InertialRecord, warnings: list[Message]) -> InertialRecord:
    """Without the rows whose accelerometers show no number: they become a gap."""
    force = record.needed_force()
    good = np.all(np.isfinite(force), axis=1)
    if np.all(good):
        return record
    if not np.any(good):
        raise InputError(
            "{file}: not one row has numbers of all three accelerometers.", file=record.segment.file
        )
    warnings.append(
        Message(
            "{file}: {count} rows without numbers of all accelerometers are left out.",
            file=record.segment.file,
            count=int(np.sum(~good)),
        )
    )
    return replace(
        record,
        t_s=record.t_s[good],
        interval_s=np.diff(record.t_s[good], prepend=record.t_s[0] - record.interval_s[0]),
        rate=record.rate[good],
        force=force[good],
        samples=Samples({name: column[good] for name, column in record.samples.columns.items()}),
    )
