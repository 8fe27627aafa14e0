"""Angles that wrap, and the turns behind them."""

from __future__ import annotations

TURN_DEG = 360.0


def wrap_180(angle_deg: float) -> float:
    """The same direction in −180 … 180° (180 excluded). Exact for whole turns."""
    return (angle_deg + 180.0) % TURN_DEG - 180.0


class TurnCounter:
    """Unwraps a reported angle. The turn is the one nearest to where the rates say the table should be, so
    that a late reading of a fast table is not a turn off."""

    def __init__(self) -> None:
        self._t_s: float | None = None
        self._angle_deg = 0.0
        self._rate_dps = 0.0

    def unwrap(self, t_s: float, wrapped_deg: float, rate_dps: float) -> float:
        """The unwrapped angle, deg; the first one is taken as it is reported."""
        if self._t_s is None:
            angle = wrapped_deg
        else:
            expected = self.expected_deg(t_s, rate_dps)
            angle = wrapped_deg + TURN_DEG * round((expected - wrapped_deg) / TURN_DEG)
        self._t_s, self._angle_deg, self._rate_dps = t_s, angle, rate_dps
        return angle

    def expected_deg(self, t_s: float, rate_dps: float) -> float:
        """Where a table should be at ``t_s`` that turns at ``rate_dps`` by then."""
        if self._t_s is None:
            return 0.0
        return self._angle_deg + 0.5 * (self._rate_dps + rate_dps) * (t_s - self._t_s)

    def uncertain(self, t_s: float, acceleration_dps2: float) -> bool:
        """Whether, read again only at ``t_s``, the table may meanwhile have sped up or braked and come back
        by so much (triangle of the acceleration, a·t²/4) that the turn cannot be told."""
        if self._t_s is None:
            return False
        passed = t_s - self._t_s
        return acceleration_dps2 * passed * passed / 4.0 > TURN_DEG / 2.0
