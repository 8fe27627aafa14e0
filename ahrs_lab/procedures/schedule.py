"""Which mountings a plan needs, in which order, and what is recorded in each (JJF 1536 7.1–7.3, table 2).

The case is *mounted* only when another face has to point up; everything else the table reaches by turning. A
whole standard calibration so needs six mountings, the combined zero offset alone two.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import groupby, product
from typing import Literal

import numpy as np

from ahrs_lab.procedures.plan_settings import Plan
from ahrs_lab.recording.orientation import AXES, Axis, Orientation

Kind = Literal["scale_factor", "misalignment", "rotation", "position"]

_TABLE_2 = ("ENU", "ESD", "WSU", "WND")
"""Where (X, Y, Z), for Y (Y, Z, X), for Z (Z, X, Y) point in positions 1 to 4."""

COMBINED_AXIS: Axis = "x"
"""The axis whose four positions serve all three in the combined schedule."""


@dataclass(frozen=True)
class Work:
    """Something to record within one mounting. ``azimuth_deg`` is the table's, from the mounting's
    orientation."""

    kind: Kind
    axis: Axis
    orientation: Orientation
    azimuth_deg: float = 0.0
    position: int | None = None
    repeat: int = 1


@dataclass(frozen=True)
class Mounting:
    """The case stands like ``orientation`` with the table at north; ``work`` in the order of recording."""

    orientation: Orientation
    work: tuple[Work, ...]


def rotation_reference(axis: Axis) -> Orientation:
    """How the case stands with ``axis`` up for 7.1 and 7.3: X up UEN, Y up NUE, Z up ENU."""
    return Orientation({"x": "UEN", "y": "NUE", "z": "ENU"}[axis])


def four_positions(axis: Axis) -> tuple[Orientation, ...]:
    """Table 2 for ``axis``, by cyclic exchange."""
    first = AXES.index(axis)
    found = []
    for letters in _TABLE_2:
        placed = {(first + step) % 3: letters[step] for step in range(3)}
        found.append(Orientation("".join(placed[i] for i in range(3))))
    return tuple(found)


def plan_mountings(plan: Plan) -> tuple[Mounting, ...]:
    """The mountings of ``plan`` in the order it asks for, each with its work."""
    return arranged(plan, _rotations(plan) + _positions(plan))


def arranged(plan: Plan, work: list[Work]) -> tuple[Mounting, ...]:
    """``work`` by mountings, in the order that ``plan`` asks for, with its repeats."""
    arrange = _in_the_order_of_the_standard if plan.mounting_order == "standard" else _shortest
    return tuple(_with_repeats(mounting, plan.repeats) for mounting in arrange(work))


def _rotations(plan: Plan) -> list[Work]:
    kinds: list[Kind] = []
    if "scale_factor" in plan.items:
        kinds.append("scale_factor")
    if "misalignment" in plan.items:
        kinds.append("misalignment")
    return [Work(kind, axis, rotation_reference(axis)) for axis in sorted(plan.axes) for kind in kinds]


def _positions(plan: Plan) -> list[Work]:
    if "zero_offset" not in plan.items:
        return []
    if plan.zero_offset.schedule == "multi-position":
        return _multi_positions(plan)
    axes = (COMBINED_AXIS,) if plan.zero_offset.schedule == "combined" else tuple(sorted(plan.axes))
    return [
        Work("position", axis, orientation, position=number)
        for axis in axes
        for number, orientation in enumerate(four_positions(axis), start=1)
    ]


def _multi_positions(plan: Plan) -> list[Work]:
    count = plan.zero_offset.positions
    found = []
    for axis, reference in _multi_position_mountings(plan).items():
        for index in range(count):
            azimuth = 360.0 * index / count
            nearest = reference.turned(round(azimuth / 90.0))
            found.append(Work("position", axis, nearest, azimuth, index + 1))
    return found


def _multi_position_mountings(plan: Plan) -> dict[Axis, Orientation]:
    """For each axis an up axis that makes it horizontal, so that the fewest mountings are added to those that
    the scale factor and the misalignment need; table 2's own (X: Z up …) where equal."""
    axes = sorted(plan.axes)
    needed = {work.axis for work in _rotations(plan)}
    choices = [[AXES[(AXES.index(axis) + 2) % 3], AXES[(AXES.index(axis) + 1) % 3]] for axis in axes]
    best = min(product(*choices), key=lambda ups: len(needed | set(ups)))
    return {axis: rotation_reference(up) for axis, up in zip(axes, best, strict=True)}


def _in_the_order_of_the_standard(work: list[Work]) -> list[Mounting]:
    """7.1 with 7.3 (they share a mounting) for X, Y, Z, then the positions as table 2 lists them. The case is
    re-mounted wherever the face changes, and nowhere else."""
    mountings = []
    for _, group in groupby(work, key=_mounting_key):
        together = list(group)
        mountings.append(_mounting(together[0].orientation, together))
    return mountings


def _mounting_key(work: Work) -> str:
    return work.orientation.face


def _mounting(reference: Orientation, work: list[Work]) -> Mounting:
    placed = [
        item if item.azimuth_deg else replace(item, azimuth_deg=item.orientation.azimuth_from(reference))
        for item in work
    ]
    rotations = [item for item in placed if item.kind != "position"]
    positions = sorted(
        (item for item in placed if item.kind == "position"), key=lambda item: item.azimuth_deg
    )
    return Mounting(reference, tuple(rotations + positions))


def _shortest(work: list[Work]) -> list[Mounting]:
    """One mounting a face, in the order with the least turning of the case; equal ones as the standard has
    them.

    Held–Karp over (faces done, how the case stands now): at most 2⁶ × 24 states.
    """
    faces: dict[str, list[Work]] = {}
    for item in work:
        faces.setdefault(item.orientation.face, []).append(item)
    rank = {name: number for number, name in enumerate(faces)}
    references = {name: _possible_references(faces[name]) for name in faces}
    best: _Reached = {}
    for name in faces:
        for start in references[name]:
            best[frozenset({name}), start] = (0.0, (rank[name],), (start,))
    for _ in range(len(faces) - 1):
        best = _one_more(best, references, rank)
    if not best:
        return []
    _, _, path = min(best.values(), key=lambda found: found[:2])
    return [_mounting(reference, faces[reference.face]) for reference in path]


_Reached = dict[tuple[frozenset[str], Orientation], tuple[float, tuple[int, ...], tuple[Orientation, ...]]]
"""Faces done and how the case stands → turning so far (deg), the faces' ranks (to settle ties), the path."""


def _one_more(best: _Reached, references: dict[str, list[Orientation]], rank: dict[str, int]) -> _Reached:
    reached: _Reached = {}
    for (done, last), (cost, ranks, path) in best.items():
        for name in rank.keys() - done:
            for following in references[name]:
                key = (done | {name}, following)
                total = round(cost + turning_deg(last, following), 6)
                candidate = (total, (*ranks, rank[name]), (*path, following))
                if key not in reached or candidate[:2] < reached[key][:2]:
                    reached[key] = candidate
    return reached


def _possible_references(work: list[Work]) -> list[Orientation]:
    """How the case may be put for this work: as 7.1 has it where a rate is run, else like one of the
    positions."""
    rotations = [item.orientation for item in work if item.kind != "position"]
    if rotations:
        return [rotations[0]]
    if any(item.azimuth_deg for item in work):  # multi-position: its azimuths are counted from the first
        return [work[0].orientation]
    return list(dict.fromkeys(item.orientation for item in work))


def turning_deg(before: Orientation, after: Orientation) -> float:
    """The angle, 0 to 180°, by which the case is turned from one mounting to the next."""
    trace = float(np.trace(after.matrix @ before.matrix.T))
    return float(np.degrees(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))))


def _with_repeats(mounting: Mounting, repeats: int) -> Mounting:
    """Positions and turns again; the scale factor is recorded once."""
    again = [
        replace(item, repeat=number)
        for number in range(2, repeats + 1)
        for item in mounting.work
        if item.kind != "scale_factor"
    ]
    return replace(mounting, work=(*mounting.work, *again))
