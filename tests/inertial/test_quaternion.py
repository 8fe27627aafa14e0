"""Quaternions against scipy's rotations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ahrs_lab.inertial import quaternion
from ahrs_lab.inertial.attitude import attitude_angles_deg, attitude_matrix

ROTATIONS = Rotation.random(200, rng=np.random.default_rng(3))


def test_matrices_and_back() -> None:
    matrices = ROTATIONS.as_matrix()
    q = np.stack([quaternion.from_matrix(C) for C in matrices], axis=1)
    assert quaternion.to_matrix(q) == pytest.approx(matrices, abs=1e-14)
    assert np.all(q[0] >= 0)
    # about each axis by 180°, where the scalar vanishes
    for axis in np.eye(3):
        half = Rotation.from_rotvec(np.pi * axis).as_matrix()
        back = quaternion.to_matrix(quaternion.from_matrix(half)[:, np.newaxis])[0]
        assert back == pytest.approx(half, abs=1e-15)


def test_products_and_turned_vectors() -> None:
    q = np.stack([quaternion.from_matrix(C) for C in ROTATIONS.as_matrix()], axis=1)
    p, v = q[:, ::-1], np.random.default_rng(1).standard_normal((3, 200))
    both = quaternion.to_matrix(quaternion.product(q, p))
    assert both == pytest.approx((ROTATIONS * ROTATIONS[::-1]).as_matrix(), abs=1e-14)
    assert quaternion.rotate(q, v) == pytest.approx(ROTATIONS.apply(v.T).T, abs=1e-14)
    one = quaternion.product(q, quaternion.conjugate(q))
    assert one == pytest.approx(np.eye(4)[:, :1] * np.ones(200), abs=1e-15)


@pytest.mark.parametrize("count", [1, 2, 7, 100, 5001])
def test_the_running_product_is_the_product_one_after_the_other(count: int) -> None:
    rng = np.random.default_rng(count)
    vectors = rng.standard_normal((3, count)) * 0.3
    start = quaternion.from_matrix(ROTATIONS[0].as_matrix())
    quick = quaternion.running_product(start, quaternion.from_rotation_vector(vectors))
    slow = ROTATIONS[0]
    assert quick[:, 0] == pytest.approx(start)
    for i in range(count):
        slow = slow * Rotation.from_rotvec(vectors[:, i])
        if i % 50 == 0 or i == count - 1:
            shown = quaternion.to_matrix(quick[:, i + 1 : i + 2])[0]
            assert shown == pytest.approx(slow.as_matrix(), abs=1e-12)


ANGLE = st.floats(-180.0, 180.0)


@given(st.floats(0.0, 359.999), st.floats(-89.9, 89.9), ANGLE)
def test_angles_follow_the_quadrant_tables_of_the_textbook(heading: float, pitch: float, roll: float) -> None:
    """Tables 2-7 and 2-8 with the principal values of (2-67), and the angles of quaternion and matrix."""
    C_bn = attitude_matrix(heading, pitch, roll)
    C = C_bn.T
    main = np.degrees(np.arctan(C[1, 0] / C[1, 1])) if C[1, 1] != 0.0 else np.nan
    lean = np.degrees(np.arctan(-C[0, 2] / C[2, 2])) if C[2, 2] != 0.0 else np.nan
    shown = attitude_angles_deg(C_bn)
    if not np.isnan(main):
        by_table = main + (180.0 if C[1, 1] < 0 else 0.0 if main >= 0 else 360.0)
        assert (shown[0] - by_table + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-9)
    if not np.isnan(lean):
        # by the signs of C₃₃ and of the principal value
        by_table = lean + (0.0 if C[2, 2] > 0 else 180.0 if lean < 0 else -180.0)
        assert (shown[2] - by_table + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-9)
    assert shown[1] == pytest.approx(np.degrees(np.arcsin(np.clip(C[1, 2], -1, 1))), abs=1e-6)
    q = quaternion.from_angles_deg(heading, pitch, roll)[:, np.newaxis]
    for of_quaternion, of_matrix in zip(quaternion.angles_deg(q), shown, strict=True):
        assert (of_quaternion[0] - of_matrix + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-9)


def test_angles_at_both_sides_of_the_tables_edges() -> None:
    tiny = 1e-7
    for heading in (0.0, 90.0, 180.0, 270.0):
        for side in (-tiny, tiny):
            shown = attitude_angles_deg(attitude_matrix(heading + side, 10.0, 20.0))[0]
            assert shown == pytest.approx((heading + side) % 360.0, abs=1e-9)
    for roll in (-90.0, 0.0, 90.0):
        for side in (-tiny, tiny):
            assert attitude_angles_deg(attitude_matrix(30.0, 10.0, roll + side))[2] == pytest.approx(
                roll + side, abs=1e-9
            )
    assert attitude_angles_deg(attitude_matrix(0.0, 0.0, 180.0 - tiny))[2] == pytest.approx(180.0 - tiny)
    assert attitude_angles_deg(attitude_matrix(0.0, 0.0, 180.0 + tiny))[2] == pytest.approx(-180.0 + tiny)
