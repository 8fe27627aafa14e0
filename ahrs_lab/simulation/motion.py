"""The table's motion: pieces of constant acceleration, so that angle and rate are known exactly at any
time."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import copysign, inf, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_HUNT_PERIOD_S = 2.0
_HUNT_FOR_S = 3600.0


@dataclass(frozen=True)
class Piece:
    """Angle ``angle + rate·s + ½·acceleration·s²`` with s the time since ``start_s``; degrees and seconds."""

    start_s: float
    angle: float
    rate: float = 0.0
    acceleration: float = 0.0

    @property
    def at_rest(self) -> bool:
        return self.rate == 0.0 and self.acceleration == 0.0

    def angle_at(self, t_s: float) -> float:
        s = t_s - self.start_s
        return self.angle + (self.rate + 0.5 * self.acceleration * s) * s

    def rate_at(self, t_s: float) -> float:
        return self.rate + self.acceleration * (t_s - self.start_s)

    def angles(self, t_s: Array) -> Array:
        """Shape (n,), like ``t_s``."""
        if self.at_rest:
            return np.full(len(t_s), self.angle)
        s = t_s - self.start_s
        return np.asarray(self.angle + (self.rate + 0.5 * self.acceleration * s) * s, dtype=np.float64)

    def rates(self, t_s: Array) -> Array:
        """Shape (n,), like ``t_s``."""
        return np.asarray(self.rate + self.acceleration * (t_s - self.start_s), dtype=np.float64)


class Motion:
    """Pieces in order of time; the last one holds for ever. A new command replaces what lies after its
    moment."""

    def __init__(self, angle_deg: float = 0.0) -> None:
        self._pieces = [Piece(-inf, angle_deg)]
        self._starts = [-inf]

    def piece_at(self, t_s: float) -> Piece:
        """The piece that holds from ``t_s`` on."""
        return self._pieces[bisect_right(self._starts, t_s) - 1]

    def angle_at(self, t_s: float) -> float:
        """True angle, degrees."""
        piece = self.piece_at(t_s)
        return piece.angle if piece.at_rest else piece.angle_at(t_s)

    def rate_at(self, t_s: float) -> float:
        """True rate, °/s."""
        piece = self.piece_at(t_s)
        return 0.0 if piece.at_rest else piece.rate_at(t_s)

    def moving_at(self, t_s: float) -> bool:
        """Whether the platform moves at ``t_s``."""
        return not self.piece_at(t_s).at_rest

    def arrives_s(self) -> float:
        """When the last piece begins."""
        return self._starts[-1]

    def spans(self, start_s: float, stop_s: float) -> list[tuple[float, float, Piece]]:
        """The pieces that meet [start, stop), each with the part of that time it holds."""
        found = []
        index = bisect_right(self._starts, start_s) - 1
        while index < len(self._pieces) and self._starts[index] < stop_s:
            end = self._starts[index + 1] if index + 1 < len(self._starts) else inf
            found.append((max(start_s, self._starts[index]), min(stop_s, end), self._pieces[index]))
            index += 1
        return found

    def forget_before(self, t_s: float) -> None:
        """Drop the pieces that ended before ``t_s``."""
        keep = bisect_right(self._starts, t_s) - 1
        if keep > 0:
            del self._pieces[:keep], self._starts[:keep]

    def go_at(self, t_s: float, rate: float, acceleration: float) -> None:
        """From ``t_s`` on change to ``rate`` and hold it."""
        angle, present = self._cut(t_s)
        self._ramp(t_s, angle, present, rate, acceleration)

    def go_to(self, t_s: float, target: float, rate: float, acceleration: float) -> None:
        """From ``t_s`` on go to the angle ``target`` with at most ``rate`` > 0, and rest there exactly."""
        angle, present = self._cut(t_s)
        if present != 0.0:
            t_s, angle = self._ramp(t_s, angle, present, 0.0, acceleration)
            self._drop_last()
        distance = abs(target - angle)
        if distance == 0.0:
            self._add(Piece(t_s, target))
            return
        peak = min(rate, sqrt(distance * acceleration))
        ramp_s = peak / acceleration
        flat_s = max(distance - peak * ramp_s, 0.0) / peak
        sign = copysign(1.0, target - angle)
        ramp = sign * 0.5 * peak * ramp_s
        self._add(Piece(t_s, angle, 0.0, sign * acceleration))
        if flat_s > 0.0:
            self._add(Piece(t_s + ramp_s, angle + ramp, sign * peak))
        self._add(Piece(t_s + ramp_s + flat_s, target - ramp, sign * peak, -sign * acceleration))
        self._add(Piece(t_s + 2.0 * ramp_s + flat_s, target))

    def hunt(self, amplitude: float) -> None:
        """From the end of the present motion on let the rate swing about its final value, for an hour."""
        last = self._pieces[-1]
        start = last.start_s
        self._drop_last()
        quarter = _HUNT_PERIOD_S / 4.0
        angle, rate = last.angle, last.rate
        slopes = (1.0, -1.0, -1.0, 1.0)
        for index in range(int(_HUNT_FOR_S / quarter)):
            piece = Piece(start + index * quarter, angle, rate, slopes[index % 4] * amplitude / quarter)
            self._add(piece)
            angle, rate = (
                piece.angle_at(start + (index + 1) * quarter),
                piece.rate_at(start + (index + 1) * quarter),
            )
        self._add(Piece(start + _HUNT_FOR_S, angle, last.rate))

    def _cut(self, t_s: float) -> tuple[float, float]:
        """Drop what lies at or after ``t_s``; the angle and rate there."""
        angle, rate = self.angle_at(t_s), self.rate_at(t_s)
        while self._starts[-1] >= t_s:
            self._drop_last()
        return angle, rate

    def _drop_last(self) -> None:
        self._pieces.pop()
        self._starts.pop()

    def _ramp(
        self, t_s: float, angle: float, rate: float, to: float, acceleration: float
    ) -> tuple[float, float]:
        """Add the change of rate and the steady piece after it; when and where it begins."""
        if to != rate:
            slope = copysign(acceleration, to - rate)
            duration = (to - rate) / slope
            self._add(Piece(t_s, angle, rate, slope))
            angle += 0.5 * (rate + to) * duration
            t_s += duration
        self._add(Piece(t_s, angle, to))
        return t_s, angle

    def _add(self, piece: Piece) -> None:
        self._pieces.append(piece)
        self._starts.append(piece.start_s)
