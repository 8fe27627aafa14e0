"""Strapdown navigation as a textbook writes it, one sample after the other: slow, plain, the truth for the
fast one. Shares no code with it but the Earth's figure and gravity."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.earth import meridian_radius_m, normal_gravity_mps2, transverse_radius_m

Array = NDArray[np.float64]
EARTH = 7.292115e-5


def rotation_vector(d: Array, k: int) -> Array:
    """Of the interval k from the increments d (n, 3), by three of them."""
    k = min(max(k, 1), len(d) - 2)
    before, after = d[k - 1], d[k + 1]
    return -np.cross(before, after) / 60 + 7 / 120 * np.cross(d[k], after - before)


def sculling(d: Array, v: Array, k: int) -> Array:
    """The same weights for the velocity changes."""
    k = min(max(k, 1), len(d) - 2)
    outer = np.cross(d[k - 1], v[k + 1]) + np.cross(v[k - 1], d[k + 1])
    inner = np.cross(d[k], v[k + 1] - v[k - 1]) + np.cross(v[k], d[k + 1] - d[k - 1])
    return -outer / 60 + 7 / 120 * inner


def turned_within(d: Array, v: Array) -> Array:
    """∫ exp(t d×) v dt over 0 … 1."""
    a = float(np.linalg.norm(d))
    if a == 0.0:
        return v
    cross = np.cross(d, v)
    return np.asarray(v + (1 - np.cos(a)) / a**2 * cross + (a - np.sin(a)) / a**3 * np.cross(d, cross))


def rates(v: Array, L: float, h: float) -> tuple[Array, Array]:
    """ω_ie and ω_en in east, north, up (2-43)."""
    east = float(transverse_radius_m(np.degrees(L))) + h
    north = float(meridian_radius_m(np.degrees(L))) + h
    earth = EARTH * np.array([0.0, np.cos(L), np.sin(L)])
    return earth, np.array([-v[1] / north, v[0] / east, v[0] / east * np.tan(L)])


def navigate_stepwise(
    C: Array,
    v: Array,
    place: Array,
    d: Array,
    f: Array,
    interval: Array,
    reference: Array | None = None,
    k1: float = 0.06666,
    k2: float = 0.00111,
) -> tuple[Array, Array, Array]:
    """C_bn (n + 1, 3, 3), velocity (n + 1, 3), latitude, longitude, height (n + 1, 3)."""
    result = [(C, v, place)]
    for k, t in enumerate(interval):
        push = turned_within(d[k], f[k]) + sculling(d, f, k)
        body = Rotation.from_rotvec(d[k] + rotation_vector(d, k)).as_matrix()
        new_v, new_place = v, place
        for _ in range(50):
            v_mid, (L, _, h) = 0.5 * (v + new_v), 0.5 * (place + new_place)
            earth, over = rates(v_mid, L, h)
            half_turn = Rotation.from_rotvec(-0.5 * t * (earth + over)).as_matrix()
            g = np.array([0.0, 0.0, float(normal_gravity_mps2(np.degrees(L), h))])
            loop = 0.0 if reference is None else h - 0.5 * (reference[k] + reference[k + 1])
            last = new_v, new_place
            new_v = v + half_turn @ C @ push - t * (np.cross(2 * earth + over, v_mid) + g)
            new_v = new_v - t * k2 * loop * np.array([0.0, 0.0, 1.0])
            moving = np.array([-over[0], over[1] / np.cos(L), 0.5 * (v[2] + new_v[2]) - k1 * loop])
            new_place = place + t * moving
            if np.allclose(new_v, last[0], rtol=0, atol=1e-14) and np.array_equal(new_place, last[1]):
                break
        earth, over = rates(0.5 * (v + new_v), *(0.5 * (place + new_place))[[0, 2]])
        C = Rotation.from_rotvec(-t * (earth + over)).as_matrix() @ C @ body
        v, place = new_v, new_place
        result.append((C, v, place))
    Cs, vs, places = zip(*result, strict=True)
    return np.array(Cs), np.array(vs), np.array(places)
