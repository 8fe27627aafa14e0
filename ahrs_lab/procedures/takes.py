"""What is recorded of JJF 1536 7.1–7.3 within one mounting: segments, their commands, how long they take."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures.blocks import Block, Take, point_to, travel_s, turns_take
from ahrs_lab.procedures.commands import PointTo, Record, SettleRate, Spin, Step, Stop
from ahrs_lab.procedures.plan_settings import Plan
from ahrs_lab.procedures.schedule import Mounting, Work
from ahrs_lab.recording.segment import Segment

_BAND_EDGES_DPS = (1.0, 10.0)
_BAND_ANGLES_DEG = (1.0, 10.0, 360.0)


def averaging_angle_deg(rate_dps: float) -> float:
    """The angle over which clause 6.1 states the table's rate: 1°, 10° or 360° by band."""
    for edge, angle in zip(_BAND_EDGES_DPS, _BAND_ANGLES_DEG, strict=False):
        if abs(rate_dps) < edge:
            return angle
    return _BAND_ANGLES_DEG[-1]


def dwell_duration_s(rate_dps: float, least_s: float) -> float:
    """The shortest time from ``least_s`` on in which the table turns through whole averaging angles."""
    angle = averaging_angle_deg(rate_dps)
    whole = math.ceil(least_s * abs(rate_dps) / angle - 1e-9)
    return max(whole, 1) * angle / abs(rate_dps)


def in_order(plan: Plan) -> tuple[float, ...]:
    """The rates as they are run: by default in ± pairs of growing magnitude, which costs less drift."""
    rates = plan.scale_factor.rates_dps
    if plan.scale_factor.order == "as_listed":
        return rates
    if plan.scale_factor.order == "ascending":
        return tuple(sorted(rates))
    return tuple(sorted(rates, key=lambda rate: (abs(rate), -rate)))


def blocks(plan: Plan, mounting: Mounting, index: int, limits: TableLimits) -> tuple[Block, ...]:
    """All blocks of mounting number ``index`` in the order of recording."""
    found: list[Block] = []
    for work in mounting.work:
        maker = _Maker(plan, mounting, index, work, limits)
        if work.kind == "scale_factor":
            found += maker.scale_factor()
        elif work.kind == "misalignment":
            found.append(maker.turns())
        else:
            found.append(maker.position())
    return tuple(found)


@dataclass(frozen=True)
class _Maker:
    plan: Plan
    mounting: Mounting
    index: int
    work: Work
    limits: TableLimits

    def _segment(self, name: str, **fields: Any) -> Segment:
        extra: dict[str, Any] = {"mounting": self.mounting.orientation.letters}
        if self.work.repeat > 1:
            name, extra["repeat"] = f"{name}_r{self.work.repeat}", self.work.repeat
        return Segment(
            name=name, orientation=self.work.orientation, axis=self.work.axis, extra=extra, **fields
        )

    def _step(self, name: str, kind: str, estimate_s: float, detail: str) -> Step:
        suffix = f"_r{self.work.repeat}" if self.work.repeat > 1 else ""
        return Step(
            key=f"m{self.index}.{name}{suffix}",
            mounting=self.mounting.orientation.face,
            kind=kind,
            axis=self.work.axis,
            estimate_s=estimate_s,
            detail=detail,
        )

    def _point(self, azimuth_deg: float) -> PointTo:
        return point_to(self.plan, azimuth_deg, self.limits)

    def scale_factor(self) -> list[Block]:
        """7.1: rest, the rates, rest."""
        axis, static_s = self.work.axis, self.plan.scale_factor.static_s
        rest = self._rest(f"sf_{axis}_before", "static_before", static_s)
        again = self._rest(f"sf_{axis}_after", "static_after", static_s)
        return [rest, self._rates(), again]

    def _rest(self, name: str, role: str, duration_s: float) -> Block:
        segment = self._segment(name, item="scale_factor", role=role)
        take = Take(segment, (Record(segment, duration_s),), duration_s)
        estimate = duration_s + self._settling_s()
        step = self._step(name, "rest", estimate, f"{duration_s:g} s")
        return Block(step, (take,), before=(self._point(0.0),))

    def _rates(self) -> Block:
        takes, last = [], 0.0
        for rate in in_order(self.plan):
            takes.append(self._rate(rate, last))
            last = rate
        stop_s = abs(last) / self.limits.max_acceleration_dps2 + 1.0
        dwell = self.plan.scale_factor.dwell_s
        step = self._step(
            f"sf_{self.work.axis}_rates",
            "rates",
            sum(take.estimate_s for take in takes) + stop_s,
            f"{len(takes)} × {dwell:g} s",
        )
        stop = Stop(self.plan.settling.timeout_s)
        return Block(step, tuple(takes), after=(stop,), azimuth_deg=None, check=False)

    def _rate(self, rate: float, last: float) -> Take:
        settling = self.plan.settling
        number = self.plan.scale_factor.rates_dps.index(rate)
        segment = self._segment(
            f"sf_{self.work.axis}_{number:02d}", item="scale_factor", role="rate", rate_dps=rate
        )
        duration = dwell_duration_s(rate, self.plan.scale_factor.dwell_s)
        change = abs(rate - last) / self.limits.max_acceleration_dps2
        settle = SettleRate(
            rate, settling.rate_tolerance(rate), settling.hold_s, settling.timeout_s + 1.5 * change
        )
        estimate = duration + change + settling.hold_s
        return Take(segment, (Spin(rate), settle, Record(segment, duration)), estimate)

    def turns(self) -> Block:
        """7.3: n turns forward, n back, from rest to rest, both recorded for the same time."""
        plan, axis = self.plan.misalignment, self.work.axis
        takes = []
        for sense, sign in (("pos", 1), ("neg", -1)):
            segment = self._segment(
                f"ma_{axis}_{sense}",
                item="misalignment",
                role="turns",
                rate_dps=sign * plan.rate_dps,
                turns=sign * plan.turns,
            )
            takes.append(turns_take(segment, self.plan.settling, self.limits))
        estimate = sum(take.estimate_s for take in takes) + self._settling_s()
        step = self._step(f"ma_{axis}", "turns", estimate, f"±{plan.turns}")
        return Block(step, tuple(takes), before=(self._point(0.0),), repeat=self.work.repeat)

    def position(self) -> Block:
        """7.2: one position, table at rest at its azimuth."""
        plan, work = self.plan.zero_offset, self.work
        many = plan.schedule == "multi-position"
        number = f"{work.position:0{max(2, len(str(plan.positions)))}d}" if many else f"{work.position}"
        segment = self._segment(
            f"zo_{work.axis}_{number}",
            item="zero_offset",
            role="position",
            position=work.position,
            azimuth_deg=work.azimuth_deg,
        )
        take = Take(segment, (Record(segment, plan.duration_s),), plan.duration_s)
        step_deg = 360.0 / plan.positions if many else 180.0
        rate = self.plan.settling.pointing_rate_dps
        estimate = plan.duration_s + self._settling_s() + travel_s(step_deg, rate, self.limits)
        detail = f"{work.azimuth_deg:g}°" if many else work.orientation.letters
        step = self._step(f"zo_{work.axis}_{number}", "position", estimate, detail)
        before = (self._point(work.azimuth_deg),)
        return Block(step, (take,), before, azimuth_deg=work.azimuth_deg, repeat=work.repeat)

    def _settling_s(self) -> float:
        return self.plan.settling.hold_s + self.plan.mounting_check_s
