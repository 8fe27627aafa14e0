"""What a segment's samples say about the case's rotation, whichever output the device gives (7.2, 7.3).

The rate output, where there is one; else the increments of the accumulated angles; else the increments of
the attitude output, as rotations about the case axes (X up when level: heading, Y right: pitch, Z forward:
roll).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.recording.orientation import AXES, Axis
from ahrs_lab.recording.samples import ANGLE, ATTITUDE, GYRO, Samples
from ahrs_lab.recording.segment import DeviceDescription

Array = NDArray[np.float64]
Source = Literal["rate", "angle", "attitude"]

_GAP = 1.5
"""Intervals longer than this many sample intervals hold lost samples."""


@dataclass(frozen=True)
class DeviceOutput:
    """Rates about the case axes of one segment, each of shape (n,), in ``unit`` (for increments: deg/s).

    ``readings`` are what the device gives, whose steps are its resolution: the rates, or the angles in deg
    that they were made of. ``intervals_s``, shape (n,), are the times the rows stand for;
    ``lost_s`` is the time before each row for which there is none, or None where nothing is missing.
    """

    rates: Mapping[Axis, Array]
    intervals_s: Array
    lost_s: Array | None
    step_s: float
    unit: str
    source: Source
    readings: Mapping[Axis, Array]

    @property
    def samples(self) -> int:
        return len(self.intervals_s)

    @property
    def duration_s(self) -> float:
        """T: from the start of the first row's interval to the end of the last."""
        lost = 0.0 if self.lost_s is None else float(self.lost_s.sum())
        return float(self.intervals_s.sum()) + lost

    def mean(self, axis: Axis) -> float:
        """Mean of the output (10), in ``unit``."""
        return float(self.rates[axis].mean())

    def dwell_angle(self, axis: Axis) -> float:
        """N of a position, unit·s: the mean rate stands for what was lost."""
        turned = float(np.sum(self.rates[axis] * self.intervals_s))
        if self.lost_s is None:
            return turned
        return turned * self.duration_s / float(self.intervals_s.sum())

    def turned_angle(self, axis: Axis) -> float:
        """N of a motion, unit·s: lost time is bridged by the mean of the rates beside it."""
        rate = self.rates[axis]
        turned = float(np.sum(rate * self.intervals_s))
        if self.lost_s is None:
            return turned
        before = np.concatenate([rate[:1], rate[:-1]])
        return turned + float(np.sum(0.5 * (before + rate) * self.lost_s))


def output_unit(samples: Samples, device: DeviceDescription) -> str:
    """Unit of :func:`device_output`'s rates."""
    return device.rate_unit if all(name in samples for name in GYRO) else "deg/s"


def device_output(samples: Samples, device: DeviceDescription) -> DeviceOutput:
    """The device's output in ``samples``. Raises InputError where there is neither rate nor angle nor
    attitude."""
    t_s = samples["t_s"]
    step = _step(t_s, 1.0 / device.sample_rate_hz)
    gyro = [samples.get(name) for name in GYRO]
    if all(column is not None for column in gyro):
        rates = {axis: column for axis, column in zip(AXES, gyro, strict=True) if column is not None}
        intervals, lost = _intervals(t_s, step, first=step)
        return DeviceOutput(rates, intervals, lost, step, device.rate_unit, "rate", rates)
    increments, source = _increments(samples)
    between = np.diff(t_s)
    rates = {axis: column / between for axis, column in zip(AXES, increments, strict=True)}
    # increments span a gap: nothing of the angle is lost with the samples
    return DeviceOutput(rates, between, None, step, "deg/s", source, _angles(samples, source))


def _step(t_s: Array, nominal: float) -> float:
    """The sample interval: what the header says, unless the times disagree by more than 1 %."""
    if len(t_s) < 2:
        return nominal
    mean = float(t_s[-1] - t_s[0]) / (len(t_s) - 1)
    return nominal if abs(mean / nominal - 1.0) < 0.01 else float(np.median(np.diff(t_s)))


def _intervals(t_s: Array, step: float, first: float) -> tuple[Array, Array | None]:
    intervals = np.diff(t_s, prepend=t_s[0] - first)
    gaps = intervals > _GAP * step
    if not gaps.any():
        return intervals, None
    lost = np.where(gaps, intervals - step, 0.0)
    return np.where(gaps, step, intervals), lost


def _increments(samples: Samples) -> tuple[list[Array], Source]:
    """Angles turned between the rows about x, y, z, each of shape (n − 1,), deg."""
    if all(name in samples for name in ANGLE):
        return [np.diff(_unwrapped(samples[name])) for name in ANGLE], "angle"
    if all(name in samples for name in ATTITUDE):
        return _attitude_increments(samples), "attitude"
    raise InputError(
        "The device gives neither rates (gyro_x …) nor angles (angle_x …) nor attitude (heading_deg …): "
        "one of them has to be recorded."
    )


def _angles(samples: Samples, source: Source) -> dict[Axis, Array]:
    """The angles as the device gives them; each of attitude's three enters every axis, so all stand for
    it."""
    if source == "angle":
        return {axis: samples[name] for axis, name in zip(AXES, ANGLE, strict=True)}
    return {axis: samples[name] for axis, name in zip(AXES, ATTITUDE, strict=True)}


def _unwrapped(angle_deg: Array) -> Array:
    """An accumulated angle; one that the device keeps within a turn is unwrapped."""
    return np.unwrap(angle_deg, period=360.0) if np.ptp(angle_deg) <= 360.0 else angle_deg


def _attitude_increments(samples: Samples) -> list[Array]:
    """Rotation vectors from row to row in the case's axes, by annex B (heading clockwise from north).

    Body right, forward, up are the case's Y, Z, X.
    """
    from scipy.spatial.transform import Rotation

    heading, pitch, roll = (samples[name] for name in ATTITUDE)
    attitude = Rotation.from_euler("ZXY", np.column_stack([-heading, pitch, roll]), degrees=True)
    turned = (attitude[:-1].inv() * attitude[1:]).as_rotvec(degrees=True)
    return [turned[:, 2], turned[:, 0], turned[:, 1]]


def table_rate(samples: Samples, demanded_dps: float) -> float | None:
    """Ω as the table measured it, °/s: angle turned over time, unwrapped about the demanded rate.

    None where the table's angle was not recorded.
    """
    angle = samples.get("table_angle_deg")
    if angle is None:
        return None
    known = np.isfinite(angle)
    if int(known.sum()) < 2:
        return None
    angle, t_s = angle[known], samples["t_s"][known]
    beside = np.diff(angle) - demanded_dps * np.diff(t_s)
    beside -= 360.0 * np.round(beside / 360.0)
    return demanded_dps + float(beside.sum()) / float(t_s[-1] - t_s[0])


def degrees_factor(unit: str) -> float | None:
    """What makes °/s of ``unit``; None for counts, which the fitted K scales."""
    return {"deg/s": 1.0, "rad/s": math.degrees(1.0)}.get(unit)
