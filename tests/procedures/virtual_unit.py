"""A unit on an ideal bench, written from the standard's model (1) alone: the truth that the reduction has to
find.

Rows are exact means over their interval, also while the table turns under the Earth's rate, so what is wrong
in a result is the reduction's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.orientation import AXES, Axis, Orientation
from ahrs_lab.recording.read import RecordedSegment, Recording
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import DeviceDescription, RecordingHeader, Segment, Site

Array = NDArray[np.float64]

EARTH_DPS = math.degrees(7.292115e-5)
TABLE_2 = ("ENU", "ESD", "WSU", "WND")
RATES = (-300.0, -200.0, -100.0, -10.0, 10.0, 100.0, 200.0, 300.0)


def table_2(axis: Axis) -> tuple[str, ...]:
    """Table 2, Y and Z by cyclic exchange: (Y, Z, X), (Z, X, Y) take the columns X, Y, Z."""
    shift = AXES.index(axis)
    return tuple("".join(letters[(i - shift) % 3] for i in range(3)) for letters in TABLE_2)


@dataclass
class VirtualUnit:
    """``F = (diag(K) + L)·ω + B`` in deg/s, shown times ``shown_per_dps`` in ``rate_unit``, plus noise.

    ``noise`` makes white noise of N in °/√s per axis from a shape; none by default.
    """

    K: Sequence[float] = (1.0, 1.0, 1.0)
    B: Sequence[float] = (0.0, 0.0, 0.0)
    L: dict[str, float] = field(default_factory=dict)
    latitude_deg: float = 39.9042
    rate_unit: str = "deg/s"
    shown_per_dps: Sequence[float] = (1.0, 1.0, 1.0)
    sample_rate_hz: float = 10.0
    earth_dps: float = EARTH_DPS
    density: float = 0.0
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(1))
    table_error: float = 0.0

    def matrix(self) -> Array:
        made = np.diag(np.asarray(self.K, dtype=np.float64))
        for key, value in self.L.items():
            made[AXES.index(key[0]), AXES.index(key[1])] = value
        return made

    def header(self, **notes: object) -> RecordingHeader:
        device = DeviceDescription(rate_unit=self.rate_unit, sample_rate_hz=self.sample_rate_hz)  # type: ignore[arg-type]
        return RecordingHeader("jjf1536-2015", Site(self.latitude_deg), device, notes=dict(notes))

    def record(
        self, segment: Segment, duration_s: float, angle_deg: Callable[[Array], Array]
    ) -> RecordedSegment:
        """``angle_deg`` gives the table's angle at the edges of the intervals, linear inside each."""
        count = round(duration_s * self.sample_rate_hz)
        edges = np.arange(count + 1) / self.sample_rate_hz
        theta = np.radians(angle_deg(edges))
        step = np.diff(theta)
        case = self._mean_rate_in_case(segment.orientation, theta, step)
        output = case @ self.matrix().T + np.asarray(self.B)
        if self.density:
            output = output + self.rng.normal(
                0.0, self.density * math.sqrt(self.sample_rate_hz), output.shape
            )
        output = output * np.asarray(self.shown_per_dps)
        columns = {"t_s": edges[1:], **{f"gyro_{axis}": output[:, i] for i, axis in enumerate(AXES)}}
        columns["table_angle_deg"] = np.degrees(theta[1:]) % 360.0
        return RecordedSegment(
            segment, Samples(columns), (), np.arange(2, count + 2), 0, 1.0 / self.sample_rate_hz
        )

    def _mean_rate_in_case(self, orientation: Orientation, theta: Array, step: Array) -> Array:
        """Mean over each interval of table rate and Earth's rate, shape (n, 3), in the turned case's axes."""
        latitude = math.radians(self.latitude_deg)
        still = np.abs(step) < 1e-12
        safe = np.where(still, 1.0, step)
        middle = 0.5 * (theta[:-1] + theta[1:])
        shrink = np.where(still, 1.0, 2.0 * np.sin(0.5 * safe) / safe)  # mean of a cosine over the interval
        horizontal = self.earth_dps * math.cos(latitude) * shrink
        # the Earth's north vector seen from the turned table
        seen = np.column_stack(
            [
                horizontal * np.sin(middle),
                horizontal * np.cos(middle),
                np.degrees(step) * self.sample_rate_hz + self.earth_dps * math.sin(latitude),
            ]
        )
        return np.asarray(seen @ orientation.matrix)

    def rest(self, axis: Axis, role: str, duration_s: float = 20.0) -> RecordedSegment:
        segment = _segment(f"sf_{axis}_{role}", UP_FIRST[axis], "scale_factor", axis, role)
        return self.record(segment, duration_s, np.zeros_like)

    def rates(
        self, axis: Axis, rates: Sequence[float] = RATES, duration_s: float = 36.0
    ) -> list[RecordedSegment]:
        """Whole turns: every rate is a multiple of 10 °/s. ``table_error``: the table is that much faster."""
        made = [self.rest(axis, "static_before")]
        for index, rate in enumerate(rates):
            segment = _segment(
                f"sf_{axis}_{index:02}", UP_FIRST[axis], "scale_factor", axis, "rate", rate_dps=rate
            )
            actual = rate * (1.0 + self.table_error)
            made.append(self.record(segment, duration_s, partial(np.multiply, actual)))
        return [*made, self.rest(axis, "static_after")]

    def turns(self, axis: Axis, turns: int = 10, rate_dps: float = 100.0) -> list[RecordedSegment]:
        """One second at rest, the turns, one second at rest."""
        made = []
        for sign in (1, -1):
            segment = _segment(
                f"ma_{axis}_{'pos' if sign > 0 else 'neg'}",
                UP_FIRST[axis],
                "misalignment",
                axis,
                "turns",
                rate_dps=sign * rate_dps,
                turns=sign * turns,
            )
            spin_s = 360.0 * turns / rate_dps

            def angle(t: Array, sign: int = sign, spin_s: float = spin_s) -> Array:
                return sign * rate_dps * np.clip(t - 1.0, 0.0, spin_s)

            made.append(self.record(segment, spin_s + 2.0, angle))
        return made

    def positions(self, axis: Axis, duration_s: float = 20.0) -> list[RecordedSegment]:
        return [
            self.record(
                _segment(f"zo_{axis}_{i}", letters, "zero_offset", axis, "position", position=i),
                duration_s,
                np.zeros_like,
            )
            for i, letters in enumerate(table_2(axis), start=1)
        ]

    def azimuths(self, axis: Axis, count: int = 12, duration_s: float = 20.0) -> list[RecordedSegment]:
        """Multi-position, from table 2's first position on."""
        reference = Orientation(table_2(axis)[0])
        made = []
        for index in range(count):
            azimuth = 360.0 * index / count
            nearest = reference.turned(round(azimuth / 90.0))
            segment = _segment(
                f"zo_{axis}_{index + 1:02}",
                nearest.letters,
                "zero_offset",
                axis,
                "position",
                position=index + 1,
            )
            stand = replace(segment, orientation=reference)
            recorded = self.record(stand, duration_s, partial(np.full_like, fill_value=azimuth))
            made.append(replace(recorded, segment=replace(segment, azimuth_deg=azimuth)))
        return made

    def recording(self, segments: Sequence[RecordedSegment], **notes: object) -> Recording:
        return Recording(self.header(**notes), tuple(segments), "00" * 32)

    def standard(self) -> Recording:
        """All of 7.1, 7.2.1, 7.3."""
        made: list[RecordedSegment] = []
        for axis in AXES:
            made += [*self.rates(axis), *self.turns(axis), *self.positions(axis)]
        return self.recording(made)


UP_FIRST: dict[Axis, str] = {"x": "UEN", "y": "NUE", "z": "ENU"}


def _segment(name: str, letters: str, item: str, axis: Axis, role: str, **more: object) -> Segment:
    return Segment(
        name=name,
        orientation=Orientation(letters),
        item=item,  # type: ignore[arg-type]
        axis=axis,
        role=role,  # type: ignore[arg-type]
        file=f"segments/{name}.csv",
        **more,  # type: ignore[arg-type]
    )


def changed(recorded: RecordedSegment, **columns: Array) -> RecordedSegment:
    """With columns replaced or added."""
    return replace(recorded, samples=recorded.samples.with_columns(columns))


def without(recorded: RecordedSegment, *names: str) -> RecordedSegment:
    """Without these columns."""
    kept = {name: column for name, column in recorded.samples.columns.items() if name not in names}
    return replace(recorded, samples=Samples(kept))
