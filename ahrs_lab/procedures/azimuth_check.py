"""Does the case point as the table says? Felt by the Earth's rate, where the gyro is good enough for it.

Two positions of one mounting, half a turn apart, under one power-on: the constant part of the rate cancels in
their difference, and twice the horizontal Earth rate remains. Its direction in the case tells the azimuth.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sqrt

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.messages import Message
from ahrs_lab.procedures.recorder import Recorded
from ahrs_lab.recording.samples import GYRO
from ahrs_lab.recording.segment import DeviceDescription

EARTH_RATE_DPS = 7.292115e-5 * 180.0 / np.pi
SHARP_DEG = 1.0
"""The azimuth is judged where the noise leaves it uncertain by less than this (one sigma)."""
TOLERANCE_DEG = 3.0
_SIGMAS = 4.0
_MAGNITUDE_RATIO = (0.8, 1.25)


@dataclass(frozen=True)
class _Position:
    orientation: str
    matrix: NDArray[np.float64]
    mean_dps: NDArray[np.float64]
    error_dps: float


class AzimuthCheck:
    """Takes each recorded segment; compares positions of one power-on that are half a turn apart."""

    def __init__(self, latitude_deg: float, device: DeviceDescription) -> None:
        self._horizontal_dps = EARTH_RATE_DPS * cos(radians(latitude_deg))
        self._per_dps = {"deg/s": 1.0, "rad/s": radians(1.0)}.get(device.rate_unit)
        self._seen: dict[tuple[str, int, str], _Position] = {}

    def add(self, recorded: Recorded) -> Message | None:
        """A warning where the felt azimuth disagrees with the asked one beyond noise."""
        segment = recorded.segment
        if segment.role != "position" or self._per_dps is None or not set(GYRO) <= recorded.means.keys():
            return None
        if (segment.azimuth_deg or 0.0) % 90.0:
            return None  # between two quarter turns: the orientation names only the nearest (7.2.2)
        mounting = str(segment.extra.get("mounting", ""))
        cycle = int(segment.extra.get("power_cycle", 0))
        here = _Position(
            segment.orientation.letters,
            segment.orientation.matrix,
            np.array([recorded.means[name] for name in GYRO]) / self._per_dps,
            max(recorded.scatter[name] for name in GYRO) / self._per_dps / sqrt(recorded.samples),
        )
        self._seen[mounting, cycle, here.orientation] = here
        opposite = self._seen.get((mounting, cycle, segment.orientation.turned(2).letters))
        return None if opposite is None else self._judge(here, opposite)

    def _judge(self, here: _Position, opposite: _Position) -> Message | None:
        """East and north of the Earth rate as felt: (0, ω cos φ) where the case points as asked."""
        felt = here.matrix @ (here.mean_dps - opposite.mean_dps) / 2.0
        noise = sqrt(here.error_dps**2 + opposite.error_dps**2) / 2.0
        if self._horizontal_dps <= 0.0 or degrees(noise / self._horizontal_dps) > SHARP_DEG:
            return None
        size = hypot(felt[0], felt[1]) / self._horizontal_dps
        if not _MAGNITUDE_RATIO[0] < size < _MAGNITUDE_RATIO[1]:
            return None  # a drift between the two, which says nothing of azimuth
        # North felt east of where it should be: the case is turned anticlockwise by that angle.
        azimuth = -degrees(atan2(felt[0], felt[1]))
        sigma = degrees(noise / self._horizontal_dps)
        if abs(azimuth) <= max(TOLERANCE_DEG, _SIGMAS * sigma):
            return None
        return Message(
            "By the Earth's rate the case is turned clockwise by {azimuth}° from where it should point: "
            "check the table's north reference and the direction in which the case is mounted.",
            azimuth=round(azimuth, 1),
        )
