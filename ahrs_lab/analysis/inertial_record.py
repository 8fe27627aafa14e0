"""A recording as the mathematics takes it: SI units, one row an interval, gaps known.

``InertialRecord`` is made from a segment of a bundle. Rates become rad/s, specific forces m/s²; a unit that
counts (``LSB``) is left in counts. :func:`unit_doubts` says when the header's unit cannot be true.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.rate_unit import agrees, gravity_ratio, shows_earth, table_ratio, turns_ratio
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.earth import STANDARD_GRAVITY_MPS2, normal_gravity_mps2
from ahrs_lab.messages import Message
from ahrs_lab.recording.finding import Kind
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import ACCEL, GAP_STEPS, GYRO, Samples, interval_s
from ahrs_lab.recording.segment import RecordingHeader, Segment

Array = NDArray[np.float64]

_NAMED = 6
TO_RADPS = {"deg/s": radians(1.0), "rad/s": 1.0, "LSB": 1.0}
LARGEST_OUTPUT = 1e15
"""In any unit: the square of what is larger could not be computed with."""
TO_MPS2 = {"m/s^2": 1.0, "g": STANDARD_GRAVITY_MPS2, "LSB": 1.0}


@dataclass(frozen=True)
class InertialRecord:
    """n rows of one segment.

    ``t_s`` (n,) end of each row's interval; ``interval_s`` (n,); ``rate`` (n, 3) mean angular rate, rad/s
    (counts where ``header.device.rate_unit`` is LSB); ``force`` (n, 3) mean specific force, m/s² or counts,
    None where the device gives none; ``gaps`` (m,) indices of rows before which samples are missing;
    ``samples`` holds every column as recorded.
    """

    header: RecordingHeader
    segment: Segment
    t_s: Array
    interval_s: Array
    rate: Array
    force: Array | None
    gaps: NDArray[np.int64]
    samples: Samples
    warnings: tuple[Message, ...] = ()

    def __len__(self) -> int:
        return len(self.t_s)

    @property
    def angle_increments_rad(self) -> Array:
        """Shape (n, 3): rate times interval."""
        return self.rate * self.interval_s[:, np.newaxis]

    def needed_force(self) -> Array:
        """``force``; raises InputError where there is none."""
        if self.force is None:
            raise InputError(
                "{file}: the recording has no accelerometer columns (accel_x, accel_y, accel_z), "
                "which this analysis needs.",
                file=self.segment.file,
            )
        return self.force

    def velocity_increments_mps(self) -> Array:
        """Shape (n, 3): specific force times interval."""
        return self.needed_force() * self.interval_s[:, np.newaxis]

    def needed_si(self) -> InertialRecord:
        """This record; raises InputError where it counts, or where its units cannot be true."""
        device = self.header.device
        if "LSB" in (device.rate_unit, device.accel_unit):
            raise InputError(
                "{file} is in counts (LSB): apply the unit's calibration set first with "
                "“ahrs-lab compensate”.",
                file=self.segment.file,
            )
        doubts = unit_doubts(self)
        if doubts:
            raise InputError("{file}: {what}", file=self.segment.file, what=doubts[0])
        return self


def records(
    recording: Recording, file: str | None = None, *, tolerated: tuple[Kind, ...] = ()
) -> tuple[InertialRecord, ...]:
    """The usable segments of ``recording`` in their order, or the one with this ``file`` (or name).

    ``tolerated`` kinds of findings do not make a segment unusable. Raises InputError where there is none.
    """
    chosen = [s for s in recording.segments if file is None or file in (s.segment.file, s.segment.name)]
    if file is not None and not chosen:
        raise InputError(
            "The recording has no segment {file}; there are: {known}.",
            file=file,
            known=some_of([s.segment.file for s in recording.segments]),
        )
    found = tuple(inertial_record(recording.header, one) for one in chosen if _usable(one, tolerated))
    if not found:
        what = next((f.placed for s in chosen for f in s.findings if f.severity == "unusable"), None)
        raise InputError(
            "No segment of the recording can be used: {what}",
            what=what if what is not None else Message("each was recorded again or interrupted."),
        )
    return found


def some_of(names: Sequence[str]) -> str:
    """A recording has up to a hundred segments: a sentence names the first of them."""
    return ", ".join([*names[:_NAMED], *(["…"] if len(names) > _NAMED else [])])


def _usable(recorded: RecordedSegment, tolerated: tuple[Kind, ...]) -> bool:
    bad = (f for f in recorded.findings if f.severity == "unusable" and f.kind not in tolerated)
    return recorded.counts and next(bad, None) is None


def inertial_record(header: RecordingHeader, recorded: RecordedSegment) -> InertialRecord:
    """One segment in SI units.

    Raises InputError where a gyro column is missing.
    """
    samples, device = recorded.samples, header.device
    missing = [name for name in GYRO if name not in samples]
    if missing:
        raise InputError(
            "{file} has no column {missing}: an inertial analysis needs the gyros.",
            file=recorded.segment.file,
            missing=", ".join(missing),
        )
    _refuse_huge(recorded)
    interval = interval_s(samples, device.sample_rate_hz)
    force = None
    if all(name in samples for name in ACCEL):
        force = samples.matrix(ACCEL) * TO_MPS2[device.accel_unit]
    return InertialRecord(
        header=header,
        segment=recorded.segment,
        t_s=samples["t_s"],
        interval_s=interval,
        rate=samples.matrix(GYRO) * TO_RADPS[device.rate_unit],
        force=force,
        gaps=np.flatnonzero(interval > GAP_STEPS / device.sample_rate_hz),
        samples=samples,
        warnings=tuple(finding.placed for finding in recorded.findings),
    )


def _refuse_huge(recorded: RecordedSegment) -> None:
    for name in (*GYRO, *ACCEL):
        column = recorded.samples.get(name)
        if column is None:
            continue
        largest = float(np.max(np.abs(column), initial=0.0, where=np.isfinite(column)))
        if largest > LARGEST_OUTPUT:
            raise InputError(
                "{file}: {column} goes up to {largest}, which no sensor puts out: check the file.",
                file=recorded.segment.file,
                column=name,
                largest=f"{largest:.3g}",
            )


def unit_doubts(record: InertialRecord) -> tuple[Message, ...]:
    """Sentences that say which unit a column seems to be in, instead of the header's; none where all fits.

    The median specific force has to lie within a factor 2 of gravity; for the rates see
    :mod:`ahrs_lab.analysis.rate_unit`.
    """
    return (*_force_doubts(record), *_rate_doubts(record)) if len(record) else ()


def _rate_doubts(record: InertialRecord) -> tuple[Message, ...]:
    unit = record.header.device.rate_unit
    if unit == "LSB":
        return ()
    other = "rad/s" if unit == "deg/s" else "deg/s"
    factor = TO_RADPS[other] / TO_RADPS[unit]
    segment, table = record.segment, record.samples.get("table_rate_dps")
    ratios = {
        Message("the table's rate"): table_ratio(record.rate, radians(segment.rate_dps))
        if segment.rate_dps
        else None,
        Message("the rate that the table reports"): table_ratio(record.rate, np.radians(table))
        if table is not None
        else None,
        Message("the turns of the table"): turns_ratio(record.angle_increments_rad, segment.turns or 0),
        Message("how gravity turns in the accelerometers"): gravity_ratio(
            record.angle_increments_rad, record.interval_s, record.force
        )
        if record.force is not None
        else None,
    }
    known = {against: ratio for against, ratio in ratios.items() if ratio is not None}
    if any(agrees(ratio) for ratio in known.values()):
        return ()
    against = next((a for a, ratio in known.items() if agrees(ratio * factor)), None)
    still = not known and segment.item not in ("dynamic", "rotation", "misalignment")
    if still and _shows_earth_times(record, factor):
        against = Message("the Earth's rate")
    if against is None:
        return ()
    return (
        Message(
            "the gyros’ rates in {unit} do not agree with {against}: these look like {likely}; correct "
            "rate_unit in recording.toml.",
            unit=unit,
            against=against,
            likely=other,
        ),
    )


def _shows_earth_times(record: InertialRecord, factor: float) -> bool:
    """Whether the mean rate at rest is the Earth's after the factor, and not before."""
    up = record.segment.orientation.matrix[2]
    if record.force is not None and np.all(np.isfinite(record.force)):
        mean = record.force.mean(axis=0)
        up = mean / max(float(np.linalg.norm(mean)), 1e-300)
    rate, latitude = record.rate.mean(axis=0), record.header.site.latitude_deg
    return shows_earth(factor * rate, up, latitude) and not shows_earth(rate, up, latitude)


def _force_doubts(record: InertialRecord) -> tuple[Message, ...]:
    header = record.header
    unit = header.device.accel_unit
    if record.force is None or unit == "LSB":
        return ()
    gravity = float(normal_gravity_mps2(header.site.latitude_deg, header.site.altitude_m))
    sizes = np.linalg.norm(record.force, axis=1)
    sizes = sizes[np.isfinite(sizes)]
    if not len(sizes):
        return ()
    shown = float(np.median(sizes)) / TO_MPS2[unit]
    like = [u for u, factor in TO_MPS2.items() if u != "LSB" and 0.5 <= shown * factor / gravity <= 2.0]
    if unit in like:
        return ()
    return (
        Message(
            "the accelerometers show {shown} {unit}, but gravity is {gravity} m/s²: these look like "
            "{likely}; correct accel_unit in recording.toml.",
            shown=f"{shown:.4g}",
            unit=unit,
            gravity=f"{gravity:.4f}",
            likely=like[0] if like else Message("counts (LSB)"),
        ),
    )
