"""Discrete calibration of an inertial measurement unit on the rate table (textbook 2.6.3): what is recorded
in each mounting.

±n whole turns about x, y and z (2.6.3.1), and the positions at rest of a scheme (2.6.3.2). Positions that the
table reaches by turning share a mounting, and turns are made in a mounting that the positions need anyway:
six mountings for every named scheme.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.metrology.imu_calibration import SCHEMES
from ahrs_lab.procedures.blocks import Block, Session, Take, point_to, travel_s, turns_take
from ahrs_lab.procedures.commands import PointTo, Record, Step
from ahrs_lab.procedures.plan_settings import ImuPlan, Plan
from ahrs_lab.procedures.schedule import Mounting, Work, arranged, rotation_reference
from ahrs_lab.recording.orientation import AXES, Orientation
from ahrs_lab.recording.segment import Segment

_POSITION = re.compile(r"([ENUWSD]{3})(?:@(-?\d+(?:\.\d+)?))?")


@dataclass(frozen=True)
class Position:
    """The case stands like ``orientation``, then the table is turned on by ``beyond_deg`` (−45 … 45)."""

    orientation: Orientation
    beyond_deg: float = 0.0

    @property
    def case_to_enu(self) -> NDArray[np.float64]:
        """3×3, column i is where case axis i points."""
        c, s = np.cos(np.radians(self.beyond_deg)), np.sin(np.radians(self.beyond_deg))
        turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(turned @ self.orientation.matrix, dtype=np.float64)


def positions(plan: ImuPlan) -> tuple[Position, ...]:
    """The positions of the plan's scheme in its order; raises InputError for one that is none."""
    listed = plan.positions if plan.scheme == "own" else SCHEMES[plan.scheme]
    return tuple(_position(text) for text in listed)


def _position(text: str) -> Position:
    found = _POSITION.fullmatch(text)
    azimuth = float(found.group(2) or 0.0) if found else math.inf
    if found is None or abs(azimuth) > 360.0:
        raise InputError(
            "imu.positions contains “{text}”: write where x, y, z of the case point, as UEN, and where "
            "wished the degrees by which the table is turned on, −360 to 360, as UEN@30.",
            text=text,
        )
    quarters = round(azimuth / 90.0)
    return Position(Orientation(found.group(1)).turned(quarters), azimuth - 90.0 * quarters)


def sessions(plan: Plan, limits: TableLimits) -> tuple[Session, ...]:
    """The mountings of ``plan`` in their order, each with its turns and positions."""
    wanted = positions(plan.imu)
    work = _rotations(wanted) + [
        Work("position", one.orientation.up_axis, one.orientation, position=number)
        for number, one in enumerate(wanted, start=1)
    ]
    return tuple(
        Session(index, mounting.orientation, _blocks(plan, mounting, index, wanted, limits))
        for index, mounting in enumerate(arranged(plan, work), start=1)
    )


def _rotations(wanted: tuple[Position, ...]) -> list[Work]:
    """Each axis is turned about where it points up; down, where only that spares a mounting."""
    found = []
    for axis in AXES:
        up = rotation_reference(axis)
        same_axis = [one.orientation for one in wanted if one.orientation.up_axis == axis]
        only_down = same_axis and all(one.up_sign < 0 for one in same_axis)
        found.append(Work("rotation", axis, same_axis[0] if only_down else up))
    return found


def _blocks(
    plan: Plan, mounting: Mounting, index: int, wanted: tuple[Position, ...], limits: TableLimits
) -> tuple[Block, ...]:
    """Turns first, then the positions in the order of their azimuths, repeat by repeat."""
    placed = [
        work
        if work.position is None
        else replace(work, azimuth_deg=_azimuth(work, wanted[work.position - 1]))
        for work in mounting.work
    ]
    placed.sort(key=lambda work: (work.repeat, work.position is not None, work.azimuth_deg))
    makers = [_Maker(plan, mounting.orientation, index, work, limits) for work in placed]
    return tuple(maker.turns() if maker.work.position is None else maker.position() for maker in makers)


def _azimuth(work: Work, position: Position) -> float:
    return (work.azimuth_deg + position.beyond_deg) % 360.0


@dataclass(frozen=True)
class _Maker:
    plan: Plan
    mounted: Orientation
    index: int
    work: Work
    limits: TableLimits

    @property
    def _again(self) -> str:
        return f"_r{self.work.repeat}" if self.work.repeat > 1 else ""

    def _segment(self, name: str, **fields: Any) -> Segment:
        extra: dict[str, Any] = {"mounting": self.mounted.letters}
        if self.work.repeat > 1:
            extra["repeat"] = self.work.repeat
        return Segment(
            name=name + self._again,
            orientation=self.work.orientation,
            axis=self.work.axis,
            extra=extra,
            **fields,
        )

    def _block(self, name: str, kind: str, detail: str, takes: tuple[Take, ...], point: PointTo) -> Block:
        settling_s = self.plan.settling.hold_s + self.plan.mounting_check_s
        travel = travel_s(90.0 if point.azimuth_deg else 0.0, point.rate_dps, self.limits)
        step = Step(
            key=f"m{self.index}.{name}{self._again}",
            mounting=self.mounted.face,
            kind=kind,
            axis=self.work.axis,
            estimate_s=sum(take.estimate_s for take in takes) + settling_s + travel,
            detail=detail,
        )
        return Block(step, takes, (point,), azimuth_deg=point.azimuth_deg, repeat=self.work.repeat)

    def turns(self) -> Block:
        """2.6.3.1: n turns forward, n back, from rest to rest, both recorded for the same time."""
        imu, axis = self.plan.imu, self.work.axis
        takes = []
        for sense, sign in (("pos", 1), ("neg", -1)):
            segment = self._segment(
                f"rot_{axis}_{sense}",
                item="rotation",
                role="turns",
                rate_dps=sign * imu.rate_dps,
                turns=sign * imu.turns,
                azimuth_deg=0.0,
            )
            takes.append(turns_take(segment, self.plan.settling, self.limits))
        point = point_to(self.plan, 0.0, self.limits)
        return self._block(f"rot_{axis}", "turns", f"±{imu.turns}", tuple(takes), point)

    def position(self) -> Block:
        """2.6.3.2: one position, table at rest at its azimuth."""
        work, dwell_s = self.work, self.plan.imu.dwell_s
        name = f"pos_{work.position:02d}"
        segment = self._segment(
            name, item="static", role="position", position=work.position, azimuth_deg=work.azimuth_deg
        )
        take = Take(segment, (Record(segment, dwell_s),), dwell_s)
        point = point_to(self.plan, work.azimuth_deg, self.limits)
        straight = work.azimuth_deg % 90.0 == 0.0
        detail = work.orientation.letters if straight else f"{work.azimuth_deg:g}°"
        return self._block(name, "static", detail, (take,), point)
