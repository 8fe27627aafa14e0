"""The case on the rate table as shapes in space: which polygons a viewer sees, back to front. No Qt.

World axes are east, north, up; the table's top is the plane up = 0 and its radius 1. A viewer stands
south-east of the table and looks down on it, without perspective.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import cos, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.recording.orientation import AXES, Axis, Orientation

Array = NDArray[np.float64]

_AZIMUTH = radians(33.0)
_ELEVATION = radians(25.0)
TOWARD = np.array([cos(_ELEVATION) * sin(_AZIMUTH), -cos(_ELEVATION) * cos(_AZIMUTH), sin(_ELEVATION)])
_RIGHT = np.array([cos(_AZIMUTH), sin(_AZIMUTH), 0.0])
_UP = np.cross(TOWARD, _RIGHT)
_SUN = np.array([0.25, -0.55, 0.8]) / np.linalg.norm([0.25, -0.55, 0.8])

CASE = np.array([0.66, 0.56, 0.36])
"""Edges along the case's x, y, z."""
_PLATE = np.array([0.98, 0.86, 0.07])
_WALL = np.array([0.98, 0.07, 0.66])
_WALL_NORTH = 0.395
RIM_DEPTH = 0.13
_ARROW = 0.40


def project(points: Array) -> Array:
    """Shape (n, 3) in the world to (n, 2) on the screen, x right, y down, in table radii."""
    return np.column_stack([points @ _RIGHT, -(points @ _UP)])


def turn_about_up(angle_deg: float) -> Array:
    """3×3 rotation about up by the right hand."""
    a = radians(angle_deg)
    return np.array([[cos(a), -sin(a), 0.0], [sin(a), cos(a), 0.0], [0.0, 0.0, 1.0]])


def between(start: Array, end: Array, part: float) -> Array:
    """The rotation ``part`` (0…1) of the way from one to the other, about one fixed axis."""
    step = end @ start.T
    angle = float(np.arccos(np.clip((np.trace(step) - 1.0) / 2.0, -1.0, 1.0)))
    if angle < 1e-9:
        return end
    axis = np.array([step[2, 1] - step[1, 2], step[0, 2] - step[2, 0], step[1, 0] - step[0, 1]])
    if np.linalg.norm(axis) < 1e-6:
        # Half a turn: the axis is the eigenvector of 1, here the largest column of step + 1.
        columns = step + np.eye(3)
        axis = columns[:, int(np.argmax(np.linalg.norm(columns, axis=0)))]
    axis = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    a = angle * part
    rotation = np.eye(3) + sin(a) * cross + (1.0 - cos(a)) * (cross @ cross)
    return np.asarray(rotation @ start)


@dataclass(frozen=True)
class Facet:
    """A flat piece: outline on the screen (n, 2), how bright the light makes it 0…1, and what it is made
    of."""

    outline: Array
    light: float
    material: str


@dataclass(frozen=True)
class Arrow:
    """A case axis from its face outward: start, tip on the screen; whether it points away from the viewer."""

    axis: Axis
    start: Array
    tip: Array
    behind: bool


@dataclass(frozen=True)
class Scene:
    """Facets to paint in this order, then the arrows over them."""

    facets: tuple[Facet, ...]
    arrows: tuple[Arrow, ...]


def scene(attitude: Array, lift: float, table_deg: float) -> Scene:
    """The fixture and the case. ``attitude`` 3×3 takes case axes to the world while the table is at 0;
    ``lift`` raises the case over its seat; ``table_deg`` turns all of it."""
    table = turn_about_up(table_deg)
    turned = table @ attitude
    plate = _box(_PLATE, table, table @ np.array([0.0, 0.0, _PLATE[2] / 2]), "fixture")
    wall = _box(_WALL, table, table @ np.array([0.0, _WALL_NORTH, _PLATE[2] + _WALL[2] / 2]), "fixture")
    half_height = float((np.abs(turned[2]) * CASE).sum() / 2)
    centre = np.array([0.0, 0.0, _PLATE[2] + half_height + lift])
    centre[:2] = (table @ np.array([0.0, -0.04, 0.0]))[:2]
    body = _case(turned, centre)
    wall_is_behind = float((table @ np.array([0.0, 1.0, 0.0])) @ TOWARD) < 0.0
    inner = [*wall, *body] if wall_is_behind else [*body, *wall]
    return Scene((*plate, *inner), tuple(_arrow(axis, turned, centre) for axis in AXES))


def seat(orientation: Orientation) -> Array:
    """The attitude of an orientation, for :func:`scene`."""
    return orientation.matrix


def _case(turned: Array, centre: Array) -> list[Facet]:
    body = _box(CASE, turned, centre, "case")
    shift = turned @ np.array([-CASE[0] / 2 - 0.045, 0.0, -0.02])
    connector = _box(np.array([0.09, 0.26, 0.16]), turned, centre + shift, "connector")
    lid = _lid(turned, centre)
    connector_in_front = float(-turned[:, 0] @ TOWARD) > 0.0
    return [*body, *lid, *connector] if connector_in_front else [*connector, *body, *lid]


def _lid(turned: Array, centre: Array) -> list[Facet]:
    """The name plate and four screws on the +z face, so that the case itself tells how it stands."""
    normal = turned[:, 2]
    if float(normal @ TOWARD) <= 0.02:
        return []
    top = centre + normal * CASE[2] / 2
    light = _light(normal)
    x, y = turned[:, 0], turned[:, 1]
    label = np.array([top + sx * 0.17 * x + sy * 0.1 * y for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    facets = [Facet(project(label), light, "label")]
    ring = np.linspace(0.0, 2 * pi, 9)[:-1]
    for sx, sy in product((-1, 1), repeat=2):
        middle = top + sx * (CASE[0] / 2 - 0.06) * x + sy * (CASE[1] / 2 - 0.06) * y
        round_ = np.array([middle + 0.024 * (cos(a) * x + sin(a) * y) for a in ring])
        facets.append(Facet(project(round_), light, "screw"))
    return facets


def _arrow(axis: Axis, turned: Array, centre: Array) -> Arrow:
    i = AXES.index(axis)
    direction = turned[:, i]
    start = centre + direction * CASE[i] / 2
    ends = project(np.array([start, start + direction * _ARROW]))
    return Arrow(axis, ends[0], ends[1], bool(direction @ TOWARD < -0.05))


def _box(edges: Array, rotation: Array, centre: Array, material: str) -> list[Facet]:
    """The faces of a box that the viewer sees."""
    facets = []
    for i in range(3):
        for sign in (-1.0, 1.0):
            normal = rotation[:, i] * sign
            if float(normal @ TOWARD) <= 1e-9:
                continue
            u = rotation[:, (i + 1) % 3] * edges[(i + 1) % 3] / 2
            v = rotation[:, (i + 2) % 3] * edges[(i + 2) % 3] / 2
            middle = centre + normal * edges[i] / 2
            corners = np.array([middle - u - v, middle + u - v, middle + u + v, middle - u + v])
            facets.append(Facet(project(corners), _light(normal), material))
    return facets


def _light(normal: Array) -> float:
    return 0.35 + 0.65 * max(0.0, float(normal @ _SUN))


def rim_ticks(table_deg: float) -> tuple[tuple[Array, bool], ...]:
    """Graduation of the rim every 10°: the two ends of each line on the screen (2, 2), and whether it is a
    long one."""
    ticks = []
    for degrees in range(0, 360, 10):
        long = degrees % 30 == 0
        a = radians(degrees + table_deg)
        direction = np.array([sin(a), cos(a), 0.0])
        ends = project(np.array([direction * (0.88 if long else 0.92), direction * 0.97]))
        ticks.append((ends, long))
    return tuple(ticks)


def compass() -> dict[str, Array]:
    """East, north and up as directions on the screen, of true projected length."""
    ends = project(np.eye(3))
    return {"east": ends[0], "north": ends[1], "up": ends[2]}


FLATTENING = sin(_ELEVATION)
"""Height over width of a level circle on the screen."""
EDGE = cos(_ELEVATION)
"""Screen length of a vertical unit."""
