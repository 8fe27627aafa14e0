"""Against scipy's rotations and the printed matrix (2-66)."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial.attitude import (
    attitude_angles_deg,
    attitude_matrix,
    rotation_about,
    rotation_from_vector,
    skew,
)

_RNG = np.random.default_rng(3)


def _printed(heading: float, pitch: float, roll: float) -> NDArray[np.float64]:
    """C_nb as the textbook prints it."""
    sy, cy, sp, cp, sr, cr = (f(np.radians(a)) for a in (heading, pitch, roll) for f in (np.sin, np.cos))
    return np.array(
        [
            [cy * cr + sy * sp * sr, -sy * cr + cy * sp * sr, -cp * sr],
            [sy * cp, cy * cp, sp],
            [cy * sr - sy * sp * cr, -sy * sr - cy * sp * cr, cp * cr],
        ]
    )


@pytest.mark.parametrize(
    "angles", [(0.0, 0.0, 0.0), (30.0, 1.0, 2.0), (271.0, -75.0, 140.0), (90.0, 45.0, -90.0)]
)
def test_attitude_matrix_is_the_printed_one(angles: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(attitude_matrix(*angles), _printed(*angles).T, atol=1e-15)


def test_attitude_matrix_is_the_zxy_rotation_with_heading_reversed() -> None:
    heading, pitch, roll = _RNG.uniform(-90, 90, (3, 50))
    reference = Rotation.from_euler("ZXY", np.column_stack([-heading, pitch, roll]), degrees=True)
    np.testing.assert_allclose(attitude_matrix(heading, pitch, roll), reference.as_matrix(), atol=1e-14)


def test_angles_come_back_all_over_the_sphere() -> None:
    heading = _RNG.uniform(0, 360, 2000)
    pitch = np.degrees(np.arcsin(_RNG.uniform(-1, 1, 2000)))
    roll = _RNG.uniform(-180, 180, 2000)
    back = attitude_angles_deg(attitude_matrix(heading, pitch, roll))
    # near ±90° of pitch heading and roll are as uncertain as rounding over the cosine of pitch
    tolerance = 1e-13 / np.cos(np.radians(pitch)) + 1e-12
    assert np.all(np.abs((back[0] - heading + 180) % 360 - 180) < tolerance)
    assert np.all(np.abs(back[1] - pitch) < tolerance)
    assert np.all(np.abs((back[2] - roll + 180) % 360 - 180) < tolerance)


@pytest.mark.parametrize("pitch", [90.0, -90.0])
def test_at_gimbal_lock_roll_is_zero_and_the_matrix_still_comes_back(pitch: float) -> None:
    matrix = attitude_matrix(30.0, pitch, 50.0)
    heading, found, roll = attitude_angles_deg(matrix)
    assert float(found) == pytest.approx(pitch)
    assert float(roll) == 0.0
    np.testing.assert_allclose(attitude_matrix(heading, found, roll), matrix, atol=1e-12)


def test_heading_is_never_360() -> None:
    heading, _, _ = attitude_angles_deg(attitude_matrix(-1e-15, 0.0, 0.0))
    assert 0.0 <= float(heading) < 360.0


def test_rotation_vectors_as_scipy_has_them() -> None:
    vectors = np.concatenate([_RNG.normal(size=(40, 3)), 1e-9 * _RNG.normal(size=(5, 3)), np.zeros((1, 3))])
    np.testing.assert_allclose(
        rotation_from_vector(vectors), Rotation.from_rotvec(vectors).as_matrix(), atol=3e-16 * 8
    )


def test_rotations_about_axes_as_scipy_has_them() -> None:
    angles = _RNG.uniform(-4, 4, 20)
    for axis, letter in enumerate("xyz"):
        reference = Rotation.from_euler(letter, angles[:, np.newaxis]).as_matrix()
        np.testing.assert_allclose(rotation_about(axis, angles), reference, atol=1e-15)


def test_skew_is_the_cross_product() -> None:
    a, b = _RNG.normal(size=(2, 10, 3))
    np.testing.assert_allclose(np.einsum("nij,nj->ni", skew(a), b), np.cross(a, b), atol=1e-15)
