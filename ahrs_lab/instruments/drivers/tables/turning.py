"""How a table whose position wraps is brought to an unwrapped angle many turns away.

Such a table takes the shortest path to a position, so more than half a turn has to be run at a rate while the
position is unwrapped, and only the end is left to the position loop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

REACH_DEG = 130.0
"""From here on the position loop takes over: half a turn less what the table travels between two looks."""
DIRECT_REACH_DEG = 170.0
"""From rest nothing is travelled between deciding and obeying."""
BRAKING_REACH_DEG = 60.0
"""Braking distance with which the position loop may take over."""
LOST_DEG = 190.0
"""Farther than half a turn: the position loop goes the wrong way round."""
AT_REST_DPS = 1.0

Mode = Literal["rate", "position"]


@dataclass(frozen=True)
class Demand:
    """What the table is to do next: turn at ``rate_dps``, or go to the target."""

    mode: Mode
    rate_dps: float = 0.0


@dataclass(frozen=True)
class Move:
    """A move under way. ``delay_s``: between what is seen and what takes effect. ``prepare_s``: how long the
    table needs to be told where to go, before the position loop can take over."""

    target_deg: float
    rate_dps: float
    acceleration_dps2: float
    delay_s: float = 0.1
    prepare_s: float = 0.6

    @property
    def approach_dps(self) -> float:
        """Rate from which the braking distance is within the position loop's reach."""
        return min(self.rate_dps, math.sqrt(2.0 * self.acceleration_dps2 * BRAKING_REACH_DEG))

    def demand(self, angle_deg: float, rate_dps: float, current: Demand | None) -> Demand:
        """What to demand at an angle and a rate; ``current`` is what is demanded now, None at the begin."""
        remaining = self.target_deg - angle_deg
        distance = abs(remaining)
        braking = rate_dps**2 / (2.0 * self.acceleration_dps2)
        if current is not None and current.mode == "position" and distance < LOST_DEG:
            return current
        away = braking if rate_dps * remaining < 0.0 else 0.0
        at_rest = abs(rate_dps) < AT_REST_DPS
        if distance + away <= (DIRECT_REACH_DEG if at_rest else REACH_DEG):
            # Too fast for the position loop: slow down first, whatever that overshoots is come back for.
            return Demand("position") if braking <= 1.2 * BRAKING_REACH_DEG else Demand("rate", 0.0)
        return Demand("rate", math.copysign(self._turning_dps(distance, current), remaining))

    def _turning_dps(self, distance_deg: float, current: Demand | None) -> float:
        if current is None:
            # Slow enough that the table knows its target before it is there.
            room = max(distance_deg - REACH_DEG, 0.0) / self.prepare_s
            return min(self.rate_dps, max(room, AT_REST_DPS))
        slowing = (self.rate_dps**2 - self.approach_dps**2) / (2.0 * self.acceleration_dps2)
        if distance_deg <= REACH_DEG + slowing + self.rate_dps * self.delay_s:
            return min(self.approach_dps, self._kept(current))
        return self._kept(current)

    def _kept(self, current: Demand) -> float:
        """The rate of a move, once chosen, is not raised again."""
        held = abs(current.rate_dps) if current.mode == "rate" else 0.0
        return held if held > 0.0 else self.approach_dps
