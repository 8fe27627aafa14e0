"""Segments of a recording as the IMU calibration takes them: dwells and turns with their standard errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import InertialRecord
from ahrs_lab.inertial.attitude import rotation_about
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import PositionData, RotationData
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, batch_means, fit_noise
from ahrs_lab.metrology.uncertainty.resolution import Resolution, find_resolution
from ahrs_lab.recording.samples import ACCEL, GYRO, interval_s
from ahrs_lab.recording.segment import Segment

Array = NDArray[np.float64]

LOST_OF_A_TURN = 0.01
"""Share of a turn's time that may be bridged."""
_WHOLE_TURNS_DEG = 10.0
_MOST_OFF_DEG = 180.0


def case_to_enu_of(segment: Segment) -> Array:
    """3×3: how the case stands, with what ``azimuth_deg`` adds to the letters."""
    between = 0.0
    if segment.azimuth_deg is not None:
        between = segment.azimuth_deg - 90.0 * round(segment.azimuth_deg / 90.0)
    return np.asarray(rotation_about(2, radians(between)) @ segment.orientation.matrix)


def at_rest(segment: Segment) -> bool:
    """Whether the table stands still and the case on it."""
    return (
        segment.role in ("position", "static_before", "static_after")
        and segment.item not in ("dynamic", "rotation")
        and not segment.rate_dps
    )


def starts_and_mountings(usable: Sequence[InertialRecord]) -> tuple[dict[str, float], dict[str, str]]:
    """By file: the start on one time scale (the device's clock where it runs on, else one after the other),
    and the mounting, which is a new one whenever another face is up."""
    starts, mountings = {}, {}
    end_s, clock_s, clamped, face = 0.0, 0.0, 0, ""
    for record in usable:
        first_s = float(record.t_s[0] - record.interval_s[0])
        if first_s <= 0.5 * record.interval_s[0] or first_s + clock_s < end_s:
            clock_s = end_s - first_s
        starts[record.segment.file] = first_s + clock_s
        end_s = float(record.t_s[-1]) + clock_s
        if record.segment.orientation.face != face:
            face, clamped = record.segment.orientation.face, clamped + 1
        mountings[record.segment.file] = f"{clamped} {face}"
    return starts, mountings


@dataclass(frozen=True)
class Channels:
    """Noise and resolution of one triad, in output units."""

    noise: tuple[NoiseModel, ...]
    resolution: tuple[Resolution, ...]

    @classmethod
    def of(
        cls, resting: Sequence[InertialRecord], turning: Sequence[InertialRecord], names: Sequence[str]
    ) -> Channels:
        noise, resolution = [], []
        for name in names:
            rest = [_finite(r.samples[name]) for r in resting]
            batches = [
                batch_means(column, 1.0 / r.header.device.sample_rate_hz)
                for column, r in zip(rest, resting, strict=True)
            ]
            longest = max(batch_s for _, batch_s in batches)
            noise.append(fit_noise([dwell for dwell, batch_s in batches if batch_s == longest], longest))
            resolution.append(find_resolution(rest, [_finite(r.samples[name]) for r in turning]))
        return cls(tuple(noise), tuple(resolution))

    def error_of_mean(self, duration_s: float, samples: int) -> Array:
        """Shape (3,): standard error of a mean by white noise and resolution; drift is not in it."""
        found = []
        for noise, resolution in zip(self.noise, self.resolution, strict=True):
            step = float(resolution.unseen_variances(np.array([duration_s]), np.array([samples]))[0])
            found.append(np.sqrt(noise.angle_variance(duration_s) / duration_s**2 + step))
        return np.array(found)


def _finite(column: Array) -> Array:
    return column[np.isfinite(column)]


def position_data(
    record: InertialRecord, gyro: Channels, accel: Channels, start_s: float, mounting: str
) -> PositionData:
    weights = interval_s(record.samples, record.header.device.sample_rate_hz, bridge_gaps=False)
    duration = float(weights.sum())
    return PositionData(
        case_to_enu=case_to_enu_of(record.segment),
        gyro=np.array([_mean(record.samples[name], weights) for name in GYRO]),
        accel=np.array([_mean(record.samples[name], weights) for name in ACCEL]),
        duration_s=duration,
        gyro_error=gyro.error_of_mean(duration, len(record)),
        accel_error=accel.error_of_mean(duration, len(record)),
        start_s=start_s,
        name=f"{record.segment.name} ({record.segment.orientation.letters})",
        mounting=mounting,
    )


def _mean(column: Array, weights: Array) -> float:
    seen = np.isfinite(column)
    if not seen.any():
        return float("nan")
    return float(np.average(column[seen], weights=weights[seen]))


def rotation_data(
    record: InertialRecord, gyro: Channels, start_s: float, mounting: str
) -> tuple[list[RotationData], list[Message]]:
    """The turns of one segment; none, and why, where they cannot be used."""
    segment = record.segment
    lost_s = float(np.sum(record.interval_s[record.gaps]))
    duration = float(record.interval_s.sum())
    if lost_s > LOST_OF_A_TURN * duration:
        return [], [
            Message(
                "{file} is left out: samples of {lost} s are missing while the table turned, so the angle is "
                "not known.",
                file=segment.file,
                lost=round(lost_s, 3),
            )
        ]
    outputs = record.samples.matrix(GYRO)
    angle = record.interval_s @ outputs
    matrix = case_to_enu_of(segment)
    theta, doubts = _table_angle(record, outputs, matrix)
    if theta is None:
        return [], doubts
    middle, step = np.radians(0.5 * (theta[1:] + theta[:-1])), np.diff(theta)
    share = record.interval_s * np.sinc(step / 360.0) / duration  # mean of a cosine over its interval
    found = RotationData(
        case_to_enu=matrix,
        turned_deg=float(theta[-1]),
        duration_s=duration,
        angle=angle,
        angle_error=gyro.error_of_mean(duration, len(record)) * duration,
        mean_cosine=float(share @ np.cos(middle)),
        mean_sine=float(share @ np.sin(middle)),
        start_s=start_s,
        name=f"{segment.name} ({segment.orientation.letters})",
        mounting=mounting,
    )
    return [found], doubts


def _table_angle(record: InertialRecord, outputs: Array, matrix: Array) -> tuple[Array | None, list[Message]]:
    """Shape (n + 1,): the table's angle at the edges of the intervals, 0 at the start: as recorded, else from
    the gyro that stands up, brought to the whole turns demanded."""
    segment, interval = record.segment, record.interval_s
    demanded = 360.0 * (segment.turns or 0)
    shown = record.samples.get("table_angle_deg")
    if shown is None or not np.all(np.isfinite(shown)) or len(shown) < 2:
        about = int(np.argmax(np.abs(matrix[2])))
        own = np.concatenate([[0.0], np.cumsum(outputs[:, about] * interval)])
        if own[-1] == 0.0:
            own = np.concatenate([[0.0], np.cumsum(interval)])
        return own / own[-1] * demanded, []
    ends = np.unwrap(shown, period=360.0)
    before = ends[0] - (ends[1] - ends[0]) * interval[0] / interval[1]
    theta = np.concatenate([[0.0], ends - before])
    off = float(theta[-1]) - demanded
    if abs(off) > _MOST_OFF_DEG:
        return None, [
            Message(
                "{file} is left out: the table turned {shown}°, the segment says {demanded}° (turns are "
                "positive anticlockwise seen from above).",
                file=segment.file,
                shown=round(float(theta[-1]), 2),
                demanded=demanded,
            )
        ]
    if abs(off) > _WHOLE_TURNS_DEG:
        what = Message(
            "{file}: the table turned {shown}°, not the {demanded}° of whole turns; the measured angle is "
            "used.",
            file=segment.file,
            shown=round(float(theta[-1]), 2),
            demanded=demanded,
        )
        return theta, [what]
    return theta, []
