"""Rotations and attitude angles.

``C_bn`` takes body components to east-north-up, ``C_nb`` is its transpose and the textbook's (2-66). Body: x
right, y forward, z up. Heading is counted clockwise from north, 0 to 360°; pitch nose up, ±90°; roll right
side down, ±180°.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_GIMBAL_LOCK_COSINE = 1e-13
"""Below this cosine of pitch, what is left of heading is rounding: roll is then called zero. Calling it zero
changes the attitude by no more than this times π, so the matrix still comes back."""
_STEEP_COSINE = 1e-2
"""Below it roll is taken so that heading and roll together give the matrix back to rounding."""


def rotation_about(axis: int, angle_rad: ArrayLike) -> Array:
    """Shape (..., 3, 3): the active rotation by ``angle_rad`` (shape (...)) about x, y or z (axis 0, 1,
    2)."""
    angle = np.asarray(angle_rad, dtype=np.float64)
    cosine, sine = np.cos(angle), np.sin(angle)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.zeros((*angle.shape, 3, 3))
    matrix[..., axis, axis] = 1.0
    matrix[..., first, first] = matrix[..., second, second] = cosine
    matrix[..., second, first] = sine
    matrix[..., first, second] = -sine
    return matrix


def rotation_from_vector(vector_rad: ArrayLike) -> Array:
    """Shape (..., 3, 3): the active rotation by |v| about v, for v of shape (..., 3), by Rodrigues'
    formula."""
    vector = np.asarray(vector_rad, dtype=np.float64)
    angle = np.linalg.norm(vector, axis=-1)[..., np.newaxis, np.newaxis]
    cross = skew(vector)
    # sin(a)/a and (1 − cos a)/a² = ½ (sin(a/2)/(a/2))², both regular at 0
    return np.asarray(
        np.eye(3)
        + np.sinc(angle / np.pi) * cross
        + 0.5 * np.sinc(angle / (2 * np.pi)) ** 2 * (cross @ cross),
        dtype=np.float64,
    )


def skew(vector: ArrayLike) -> Array:
    """Shape (..., 3, 3): the matrix of v×, for v of shape (..., 3)."""
    v = np.asarray(vector, dtype=np.float64)
    matrix = np.zeros((*v.shape, 3))
    for row, column, component, sign in ((2, 1, 0, 1), (0, 2, 1, 1), (1, 0, 2, 1)):
        matrix[..., row, column] = sign * v[..., component]
        matrix[..., column, row] = -sign * v[..., component]
    return matrix


def attitude_matrix(heading_deg: ArrayLike, pitch_deg: ArrayLike, roll_deg: ArrayLike) -> Array:
    """Shape (..., 3, 3): C_bn of heading, pitch and roll, the transpose of (2-66)."""
    return np.asarray(
        rotation_about(2, -np.radians(heading_deg))
        @ rotation_about(0, np.radians(pitch_deg))
        @ rotation_about(1, np.radians(roll_deg)),
        dtype=np.float64,
    )


def attitude_angles_deg(C_bn: Array) -> tuple[Array, Array, Array]:
    """Heading [0, 360), pitch and roll in degrees, each of shape (...), of C_bn with shape (..., 3, 3)
    (2-67).

    At pitch ±90° heading and roll cannot be told apart; roll is 0 there. Beside it heading and roll are each
    as uncertain as rounding over the cosine of pitch, but together they still give C_bn to rounding: roll is
    taken from the matrix turned back by that heading, which is R_x(pitch)·R_y(roll), whose first row is (cos
    roll, 0, sin roll).
    """
    forward, right = np.moveaxis(C_bn[..., :, 1], -1, 0), np.moveaxis(C_bn[..., :, 0], -1, 0)
    return angles_of_axes_deg(forward, right, C_bn[..., 2, 2])


def angles_of_axes_deg(forward: Array, right: Array, up_of_up: Array) -> tuple[Array, Array, Array]:
    """Heading, pitch and roll of the forward and right axes, shape (3, ...) east, north, up, and the up
    component of the up axis: (2-67) with the quadrants of tables 2-7 and 2-8, by atan2."""
    cosine = np.hypot(forward[0], forward[1])
    locked = cosine < _GIMBAL_LOCK_COSINE
    pitch = np.arctan2(forward[2], cosine)
    roll = np.arctan2(-right[2], up_of_up)
    heading = np.arctan2(forward[0], forward[1])
    if np.any(near := cosine < _STEEP_COSINE):
        heading = np.where(locked, np.arctan2(-right[1], right[0]), heading)
        east, north = np.cos(heading), -np.sin(heading)
        up_east = right[1] * forward[2] - right[2] * forward[1]
        up_north = right[2] * forward[0] - right[0] * forward[2]
        steep = np.arctan2(east * up_east + north * up_north, east * right[0] + north * right[1])
        roll = np.where(locked, 0.0, np.where(near, steep, roll))
    degrees = np.degrees(heading)
    degrees = np.where(degrees < 0.0, degrees + 360.0, degrees)
    # a tiny negative angle would round up to 360 itself
    return np.where(degrees >= 360.0, 0.0, degrees), np.degrees(pitch), np.degrees(roll)
