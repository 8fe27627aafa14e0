"""What the desk shows of each kind of instrument, and how it is read."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ahrs_lab.instruments.interfaces import RoomReading, SupplyReading, TableState
from ahrs_lab.messages import Message
from ahrs_lab.recording.samples import Samples

_BITS_OF_BYTE = 10.0
"""With start and stop bit."""
_WINDOW_S = 1.0
_DEGREES = {"deg/s": 1.0, "rad/s": float(np.degrees(1.0))}


@dataclass(frozen=True)
class AhrsLive:
    """Means over the last second. ``rates`` x, y, z in ``rate_unit`` (°/s where the unit says radians);
    ``angles_deg`` heading, pitch, roll; ``bits_per_second`` as they arrive; ``offset_s`` host minus device
    time; ``age_s`` since the last sample."""

    rates: tuple[float, ...] = ()
    rate_unit: str = "°/s"
    specific_force: tuple[float, ...] = ()
    force_unit: str = ""
    angles_deg: tuple[float, ...] = ()
    temperature_c: float | None = None
    samples: int = 0
    sample_rate_hz: float | None = None
    bits_per_second: float | None = None
    line_bits_per_second: int | None = None
    counts: dict[str, int] = field(default_factory=dict)
    offset_s: float | None = None
    rate_ppm: float | None = None
    jitter_s: float | None = None
    age_s: float = 0.0


class AhrsLook:
    """Reads an AHRS; keeps the last second."""

    def __init__(self) -> None:
        self._blocks: deque[tuple[float, Samples]] = deque()
        self._bytes: deque[tuple[float, int]] = deque()
        self._samples = 0
        self._last_s = time.monotonic()
        self.unplug = UnplugTest()

    def restart(self) -> None:
        """The stream begins anew."""
        self.__init__()  # type: ignore[misc]

    def __call__(self, ahrs: Any) -> AhrsLive:
        """Raises what the driver raises; what arrived before stays in the mean."""
        now = time.monotonic()
        try:
            samples = ahrs.read()
        except Exception:
            self.unplug.lost(now, self._last_s)
            raise
        if len(samples):
            self.unplug.arrived(now)
            self._blocks.append((now, samples))
            self._samples += len(samples)
            self._last_s = now
        while self._blocks and now - self._blocks[0][0] > _WINDOW_S:
            self._blocks.popleft()
        return self._live(ahrs, now)

    def _live(self, ahrs: Any, now: float) -> AhrsLive:
        description = ahrs.description
        factor = _DEGREES.get(description.rate_unit, 1.0)
        unit = "°/s" if description.rate_unit in _DEGREES else description.rate_unit
        counts = dict(getattr(ahrs, "link_counts", {}))
        relation = getattr(ahrs, "time_relation", None)
        temperature = self._mean("temperature_c")
        return AhrsLive(
            rates=tuple(factor * value for value in self._mean("gyro_x", "gyro_y", "gyro_z")),
            rate_unit=unit,
            specific_force=self._mean("accel_x", "accel_y", "accel_z"),
            force_unit=str(description.accel_unit),
            angles_deg=self._mean("heading_deg", "pitch_deg", "roll_deg"),
            temperature_c=temperature[0] if temperature else None,
            samples=self._samples,
            sample_rate_hz=self._sample_rate(),
            bits_per_second=self._bits(now, counts.get("received_bytes")),
            line_bits_per_second=getattr(getattr(ahrs, "_link", None), "bits_per_second", None),
            counts=counts,
            offset_s=None if relation is None else relation.offset_s,
            rate_ppm=None if relation is None else relation.rate_ppm,
            jitter_s=None if relation is None else relation.jitter_s,
            age_s=now - self._last_s,
        )

    def _mean(self, *names: str) -> tuple[float, ...]:
        if not self._blocks or any(name not in self._blocks[-1][1] for name in names):
            return ()
        return tuple(
            float(np.mean(np.concatenate([block[name] for _, block in self._blocks if name in block])))
            for name in names
        )

    def _sample_rate(self) -> float | None:
        """By the device's own time."""
        if not self._blocks:
            return None
        first, last = self._blocks[0][1]["t_s"], self._blocks[-1][1]["t_s"]
        count = sum(len(block) for _, block in self._blocks) - 1
        passed = float(last[-1] - first[0])
        return count / passed if passed > 0.0 and count > 0 else None

    def _bits(self, now: float, received: int | None) -> float | None:
        if received is None:
            return None
        self._bytes.append((now, received))
        while len(self._bytes) > 2 and now - self._bytes[1][0] > _WINDOW_S:
            self._bytes.popleft()
        (begin, before), (end, after) = self._bytes[0], self._bytes[-1]
        return (after - before) * _BITS_OF_BYTE / (end - begin) if end > begin and after >= before else None


UnplugPhase = Literal["idle", "pull", "plug", "done"]


class UnplugTest:
    """The data cable is pulled and plugged in again: was it noticed, and does the stream come back?"""

    def __init__(self) -> None:
        self.phase: UnplugPhase = "idle"
        self.noticed_s: float | None = None
        """From the last sample to the loss being told."""
        self.gap_s: float | None = None
        """From the last sample before to the first one after."""
        self._last_s = 0.0

    def begin(self) -> None:
        """The person is asked to pull the cable."""
        self.phase, self.noticed_s, self.gap_s = "pull", None, None

    def cancel(self) -> None:
        """The person has thought better of it."""
        self.phase = "idle"

    def lost(self, now: float, last_s: float) -> None:
        """The driver tells that nothing comes."""
        if self.phase == "pull":
            self.phase, self.noticed_s, self._last_s = "plug", now - last_s, last_s

    def arrived(self, now: float) -> None:
        """Samples."""
        if self.phase == "plug":
            self.phase, self.gap_s = "done", now - self._last_s

    @property
    def verdict(self) -> Message | None:
        """How it went; None before its end."""
        if self.phase != "done" or self.noticed_s is None or self.gap_s is None:
            return None
        return Message(
            "The loss was noticed {noticed} s after the last sample; the stream was back after {gap} s with "
            "its "
            "settings verified.",
            noticed=round(self.noticed_s, 1),
            gap=round(self.gap_s, 1),
        )


@dataclass(frozen=True)
class TableLive:
    """``held``: a jog button is held."""

    state: TableState
    held: bool = False


def read_supply(supply: Any) -> SupplyReading:
    """A look at the supply."""
    reading: SupplyReading = supply.read()
    return reading


def read_room(room: Any) -> RoomReading:
    """A look at the room."""
    reading: RoomReading = room.read()
    return reading
