"""True increments against an independent construction: scipy's rotations, differentiated and integrated
numerically."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad_vec
from scipy.spatial.transform import Rotation

from ahrs_lab.recording.orientation import Orientation, all_orientations
from ahrs_lab.simulation.motion import Piece
from ahrs_lab.simulation.mounted_case import MountedCase
from ahrs_lab.simulation.settings import SiteSettings, TableSettings

Array = NDArray[np.float64]

_SITE = SiteSettings(latitude_deg=39.9042, altitude_m=0.0)
_EARTH_DPS = np.degrees(7.292115e-5) * np.array(
    [0.0, np.cos(np.radians(39.9042)), np.sin(np.radians(39.9042))]
)
_ARCSEC = np.pi / 648000.0
_FIXTURE = np.array([3e-4, -2e-4, 1e-4])
_BAD_TABLE = TableSettings(
    tilt_east_arcsec=200.0,
    tilt_north_arcsec=-300.0,
    wobble_arcsec=100.0,
    wobble_harmonic=2,
    wobble_phase_deg=35.0,
    north_misalignment_arcsec=400.0,
    north_deg=12.0,
)


def _attitude(angle_deg: float, table: TableSettings, orientation: Orientation) -> Array:
    """Case to east-north-up, written down anew."""
    tilt = Rotation.from_rotvec(np.array([table.tilt_east_arcsec, table.tilt_north_arcsec, 0.0]) * _ARCSEC)
    cone_towards = np.radians(table.wobble_harmonic * angle_deg + table.wobble_phase_deg)
    cone = Rotation.from_rotvec(
        table.wobble_arcsec * _ARCSEC * np.array([np.cos(cone_towards), np.sin(cone_towards), 0.0])
    )
    turned = Rotation.from_euler(
        "z", angle_deg - table.north_deg + table.north_misalignment_arcsec / 3600.0, degrees=True
    )
    matrix = (tilt * cone * turned * Rotation.from_rotvec(_FIXTURE)).as_matrix()
    return np.asarray(matrix @ orientation.matrix, dtype=np.float64)


def _turning(angle_deg: float, table: TableSettings, orientation: Orientation) -> Array:
    """Rate of the case per table rate: vee(Cᵀ dC/dθ), by an eighth-order difference."""
    step = 0.02
    slope = np.zeros((3, 3))
    for k, weight in enumerate((4 / 5, -1 / 5, 4 / 105, -1 / 280), start=1):
        for sign in (1, -1):
            slope += sign * weight * _attitude(angle_deg + sign * np.degrees(k * step), table, orientation)
    spin = _attitude(angle_deg, table, orientation).T @ slope / step
    return np.array([spin[2, 1], spin[0, 2], spin[1, 0]])


def _numerically(
    piece: Piece, start: float, stop: float, table: TableSettings, orientation: Orientation
) -> tuple[Array, Array]:
    gravity = np.array([0.0, 0.0, 9.8014])

    def rate(t: float) -> Array:
        angle = piece.angle_at(t)
        turn = _turning(angle, table, orientation) * piece.rate_at(t)
        earth = _attitude(angle, table, orientation).T @ _EARTH_DPS
        return np.asarray(np.concatenate([turn + earth, _attitude(angle, table, orientation).T @ gravity]))

    total = quad_vec(rate, start, stop, epsabs=1e-13, epsrel=1e-13)[0]
    return total[:3], total[3:] / 9.8014


@pytest.mark.parametrize("letters", ["UEN", "SDE"])
@pytest.mark.parametrize("harmonic", [1, 3])
@pytest.mark.parametrize(
    "piece",
    [
        Piece(0.0, 33.0),
        Piece(0.0, 33.0, 100.0),
        Piece(0.0, -20.0, -0.7),
        Piece(0.0, 5.0, 0.0, 500.0),
        Piece(0.0, 5.0, 300.0, -400.0),
    ],
)
def test_increments_of_a_badly_adjusted_table_are_the_integrals(
    letters: str, harmonic: int, piece: Piece
) -> None:
    orientation = Orientation(letters)
    table = replace(_BAD_TABLE, wobble_harmonic=harmonic)
    case = MountedCase(orientation.matrix, _FIXTURE, _SITE, table)
    gravity = float(np.linalg.norm(case.integrals(Piece(0.0, 0.0), np.array([0.0, 1.0])).velocity_mps))
    edges = np.array([0.1, 0.11, 0.35, 0.8])
    found = case.integrals(piece, edges)
    for index in range(3):
        angle, velocity = _numerically(piece, edges[index], edges[index + 1], table, orientation)
        column = 0 if found.angle_deg.shape[1] == 1 else index
        scale = max(1.0, float(np.abs(angle).max()))
        assert np.max(np.abs(found.angle_deg[:, column] - angle)) < 1e-12 * scale
        found_velocity = found.velocity_mps[:, min(index, found.velocity_mps.shape[1] - 1)]
        assert np.max(np.abs(found_velocity / gravity - velocity)) < 1e-12


def test_attitude_is_the_product_of_its_rotations() -> None:
    orientation = Orientation("NUE")
    case = MountedCase(orientation.matrix, _FIXTURE, _SITE, _BAD_TABLE)
    angles = np.array([0.0, 77.0, -1000.0])
    expected = [_attitude(angle, _BAD_TABLE, orientation) for angle in angles]
    np.testing.assert_allclose(case.attitude(angles), expected, atol=1e-14)


@pytest.mark.parametrize("orientation", all_orientations(), ids=str)
def test_at_rest_an_ideal_case_feels_earth_rate_and_gravity_where_they_point(
    orientation: Orientation,
) -> None:
    case = MountedCase(orientation.matrix, np.zeros(3), _SITE, TableSettings())
    felt = case.integrals(Piece(0.0, 0.0), np.array([0.0, 1.0]))
    for axis, letter in enumerate(orientation.letters):
        sign, component = {"E": (1, 0), "N": (1, 1), "U": (1, 2), "W": (-1, 0), "S": (-1, 1), "D": (-1, 2)}[
            letter
        ]
        assert felt.angle_deg[axis, 0] == pytest.approx(sign * _EARTH_DPS[component], abs=1e-17)
        # Somigliana at 39.9042°, by hand: 9.7803253359·(1 + 0.00193185265241 s²)/√(1 − 0.00669437999014 s²)
        assert felt.velocity_mps[axis, 0] == pytest.approx(sign * 9.80161166 * (component == 2), abs=5e-7)


def test_a_lever_arm_feels_centripetal_and_tangential_acceleration() -> None:
    """r = 0.1 m outward: −ω²r towards the axis, α·r along the circle (x east on the arm, z up)."""
    case = MountedCase(np.eye(3), np.zeros(3), _SITE, TableSettings(), (0.1, 0.0, 0.0))
    still = MountedCase(np.eye(3), np.zeros(3), _SITE, TableSettings())
    edges = np.array([0.0, 0.5])
    for piece in (Piece(0.0, 0.0, 100.0), Piece(0.0, 0.0, 100.0, 50.0)):
        extra = case.integrals(piece, edges).velocity_mps - still.integrals(piece, edges).velocity_mps
        a, b = np.radians(piece.rate_at(0.0)), np.radians(piece.rate_at(0.5))
        squares = (a * a + a * b + b * b) / 3.0 * 0.5
        np.testing.assert_allclose(extra[:, 0], [-0.1 * squares, 0.1 * (b - a), 0.0], atol=1e-15)
