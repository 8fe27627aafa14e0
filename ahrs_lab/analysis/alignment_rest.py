"""Is the recording one of a unit at rest, and which part of it can be used?

Means over a few seconds have to stay where they are; what a running engine adds above some hertz averages out
and is tolerated (the noise estimated from the recording carries it), slow swaying, turning and tilting are
not.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.alignment import Place
from ahrs_lab.inertial.earth import EARTH_RATE_RADPS
from ahrs_lab.messages import Message
from ahrs_lab.recording.samples import GAP_STEPS, Samples, interval_s

Array = NDArray[np.float64]

BRIDGED_S = 1.0
"""The unit being at rest, a gap this long is bridged by the next row's mean; at longer ones the record is
cut."""

_WINDOW_S = 5.0
_FEWEST_WINDOWS = 4
_TURNING_RADPS = 10.0 * EARTH_RATE_RADPS
_STRANGE_FORCE_MPS2 = 0.2
"""20 mg off gravity: no accelerometer that is worth aligning with."""
_SWAY = (float(np.radians(0.05)), 0.1)
"""rad/s, m/s²: scatter of means over a second."""
_MOVED = (float(np.radians(0.003)), 0.005)
"""rad/s, m/s² (0.03° of tilt): what the mean of a window may change by beside its noise."""
_SIGMAS = 6.0
_VIBRATION_MPS2 = 0.5


@dataclass(frozen=True)
class Rest:
    """The longest stretch of the record that is at rest without a long gap; its rows and what has to be said
    about it."""

    record: InertialRecord
    warnings: tuple[Message, ...]

    @property
    def duration_s(self) -> float:
        """Of the stretch."""
        return float(self.record.interval_s.sum())


def rest_of(record: InertialRecord, place: Place, shortest_s: float) -> Rest:
    """Raises InputError where the stretch is shorter than ``shortest_s`` or the unit moves."""
    record, left_out = _with_force(record)
    start, stop, warnings = _longest(record)
    warnings = (*left_out, *warnings)
    part = replace(
        record,
        t_s=record.t_s[start:stop],
        interval_s=_first_nominal(record, start, stop),
        rate=record.rate[start:stop],
        force=record.needed_force()[start:stop],
        samples=record.samples.rows(start, stop),
        gaps=record.gaps[(record.gaps > start) & (record.gaps < stop)] - start,
    )
    rest = Rest(part, warnings)
    if rest.duration_s < shortest_s * (1.0 - 1e-6):
        raise InputError(
            "{file}: {seconds} s at rest without a gap are too short to align; this method needs {shortest} "
            "s.",
            file=record.segment.file,
            seconds=f"{rest.duration_s:.1f}",
            shortest=f"{shortest_s:g}",
        )
    _refuse_turning(part, place)
    _refuse_motion(part)
    rest = Rest(part, (*warnings, *_stuck(part)))
    spread = float(np.linalg.norm(part.needed_force().std(axis=0)))
    if spread > _VIBRATION_MPS2:
        vibration = Message(
            "The base vibrates ({spread} m/s² rms). That averages out, and the scatter is in the stated "
            "uncertainty; what vibration shifts in the sensors themselves (rectification) is not.",
            spread=f"{spread:.2g}",
        )
        return Rest(part, (*rest.warnings, vibration))
    return rest


def _with_force(record: InertialRecord) -> tuple[InertialRecord, tuple[Message, ...]]:
    """The rows that have a specific force; the others become gaps."""
    kept = np.flatnonzero(np.all(np.isfinite(record.needed_force()), axis=1))
    missing = len(record) - len(kept)
    if not missing:
        return record, ()
    samples = Samples({name: column[kept] for name, column in record.samples.columns.items()})
    rate_hz = record.header.device.sample_rate_hz
    interval = interval_s(samples, rate_hz)
    warning = Message("{count} rows have no number for the specific force and were left out.", count=missing)
    return replace(
        record,
        t_s=record.t_s[kept],
        interval_s=interval,
        rate=record.rate[kept],
        force=record.needed_force()[kept],
        gaps=np.flatnonzero(interval > GAP_STEPS / rate_hz),
        samples=samples,
    ), (warning,)


def _longest(record: InertialRecord) -> tuple[int, int, tuple[Message, ...]]:
    if not len(record):
        raise InputError("{file} holds no sample.", file=record.segment.file)
    long = [int(row) for row in record.gaps if record.interval_s[row] > BRIDGED_S]
    edges = [0, *long, len(record)]
    start, stop = max(itertools.pairwise(edges), key=lambda piece: piece[1] - piece[0])
    warnings = []
    bridged = len(record.gaps) - len(long)
    if bridged:
        warnings.append(
            Message(
                "{count} gaps of up to {longest} s were bridged: the unit is taken to be at rest in them "
                "too.",
                count=bridged,
                longest=f"{BRIDGED_S:g}",
            )
        )
    if long:
        warnings.append(
            Message(
                "The record has {count} longer gaps; its longest uninterrupted stretch is used, from {start} "
                "s to {stop} s.",
                count=len(long),
                start=f"{record.t_s[start]:.1f}",
                stop=f"{record.t_s[stop - 1]:.1f}",
            )
        )
    return start, stop, tuple(warnings)


def _first_nominal(record: InertialRecord, start: int, stop: int) -> Array:
    interval = record.interval_s[start:stop].copy()
    if start:
        interval[0] = 1.0 / record.header.device.sample_rate_hz
    return interval


def _refuse_turning(record: InertialRecord, place: Place) -> None:
    weight = record.interval_s / record.interval_s.sum()
    turning = float(np.linalg.norm(weight @ record.rate))
    if turning > _TURNING_RADPS:
        raise InputError(
            "{file}: the unit turns at {rate} °/s (or its gyros are off by that): self-alignment needs it at "
            "rest, and gyros that resolve the Earth's 0.0042 °/s.",
            file=record.segment.file,
            rate=f"{np.degrees(turning):.3g}",
        )
    force = float(np.linalg.norm(weight @ record.needed_force()))
    if abs(force - place.gravity_mps2) > _STRANGE_FORCE_MPS2:
        raise InputError(
            "{file}: the mean specific force is {force} m/s², gravity {gravity} m/s²: the unit accelerates, "
            "or its accelerometers have to be calibrated first.",
            file=record.segment.file,
            force=f"{force:.4f}",
            gravity=f"{place.gravity_mps2:.4f}",
        )


def _refuse_motion(record: InertialRecord) -> None:
    """Means over seconds differ by noise alone where the unit is at rest."""
    for what, unit, scale, values, sway, moved in (
        (Message("angular rate"), "°/s", np.degrees(1.0), record.rate, _SWAY[0], _MOVED[0]),
        (Message("specific force"), "m/s²", 1.0, record.needed_force(), _SWAY[1], _MOVED[1]),
    ):
        ends, second = _means(record, values, 1.0)
        noise = _robust_scatter(second)
        if float(noise.max()) > sway:
            raise InputError(
                "{file}: the unit sways: means of its {what} over one second scatter by {scatter} {unit}. "
                "Self-alignment needs it at rest; vibration above some hertz is tolerated.",
                file=record.segment.file,
                what=what,
                scatter=f"{float(noise.max()) * scale:.2g}",
                unit=unit,
            )
        ends, window = _means(record, values, _WINDOW_S)
        if len(window) < _FEWEST_WINDOWS:
            continue
        off = np.abs(window - np.median(window, axis=0))
        excess = off - (_SIGMAS * noise / np.sqrt(_WINDOW_S) + moved)
        if float(excess.max()) > 0.0:
            row, axis = np.unravel_index(int(np.argmax(excess)), excess.shape)
            raise InputError(
                "{file}: the unit moves: around {t_s} s the {what} on axis {axis} is {change} {unit} off its "
                "usual value. Use a recording, or a segment, in which it is at rest.",
                file=record.segment.file,
                t_s=f"{ends[row]:.0f}",
                what=what,
                axis="xyz"[int(axis)],
                change=f"{off[row, axis] * scale:.2g}",
                unit=unit,
            )


def _stuck(record: InertialRecord) -> Iterator[Message]:
    """A channel without noise beside others that have some."""
    for name, values in (("gyro", record.rate), ("accel", record.needed_force())):
        still = np.ptp(values, axis=0) == 0.0
        if still.any() and not still.all():
            yield Message(
                "{channels} shows the same value in every row: it is stuck, or its steps are coarse; the "
                "stated uncertainty knows nothing of it.",
                channels=", ".join(f"{name}_{axis}" for axis, one in zip("xyz", still, strict=True) if one),
            )


def _means(record: InertialRecord, values: Array, seconds: float) -> tuple[Array, Array]:
    """Ends (k,) and means (k, 3) over about ``seconds``; the rest of the rows is left out."""
    rows = max(1, round(seconds * record.header.device.sample_rate_hz))
    count = len(values) // rows
    used = count * rows
    return record.t_s[:used].reshape(count, rows)[:, -1], values[:used].reshape(count, rows, 3).mean(axis=1)


def _robust_scatter(means: Array) -> Array:
    """Shape (3,): standard deviation from the median size of neighbours' differences, so that a push or two
    does not enter."""
    if len(means) < 3:
        return np.zeros(3)
    return np.asarray(1.4826 * np.median(np.abs(np.diff(means, axis=0)), axis=0) / np.sqrt(2.0))
