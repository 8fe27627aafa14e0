"""What a case on the table feels: the Earth's rate, the table's rate and gravity in case axes.

The case's attitude depends on the table's angle θ alone and repeats with each turn, ``C(θ) = tilt · cone(θ) ·
R_z(θ + north) · fixture · orientation`` (case to east-north-up). So Earth rate and gravity in case axes, and
the direction of the axis it turns about, are short Fourier series in θ, exact to rounding. A sample's
increments are integrals over its interval: closed forms at rest and at constant rate, Gauss–Legendre on
panels where the rate changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import rotation_about, rotation_from_vector, skew
from ahrs_lab.inertial.earth import earth_rate_enu_dps, normal_gravity_mps2
from ahrs_lab.inertial.sensor_model import Vector
from ahrs_lab.simulation.motion import Piece
from ahrs_lab.simulation.settings import SiteSettings, TableSettings

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_ARCSEC: Final = np.pi / 648000.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_PANEL_RAD: Final = 0.5
"""Largest phase turned within a panel: eight nodes then err by less than rounding."""


@dataclass(frozen=True)
class Integrals:
    """Over each of n intervals: ``angle`` ∫ω dt in degrees and ``velocity`` ∫f dt in m/s, case axes, shape
    (3, n); (3, 1) where all intervals are alike."""

    angle_deg: Array
    velocity_mps: Array


class MountedCase:
    """A case as it is clamped, on this table, at this place."""

    def __init__(
        self,
        orientation: Array,
        fixture_rad: Array,
        site: SiteSettings,
        table: TableSettings,
        lever_arm_m: Vector = (0.0, 0.0, 0.0),
    ) -> None:
        """``orientation``: 3×3, case to table at its north angle; ``fixture_rad``: rotation vector of the
        fixture's error, table axes."""
        self._case_to_platform = rotation_from_vector(fixture_rad) @ orientation
        self._tilt = rotation_from_vector(
            np.array([table.tilt_east_arcsec, table.tilt_north_arcsec, 0.0]) * _ARCSEC
        )
        self._cone_rad = table.wobble_arcsec * _ARCSEC
        self._cone_harmonic = table.wobble_harmonic
        self._cone_phase_rad = np.radians(table.wobble_phase_deg)
        self._north_rad = table.north_misalignment_arcsec * _ARCSEC - np.radians(table.north_deg)
        earth = earth_rate_enu_dps(site.latitude_deg)
        gravity = np.array([0.0, 0.0, float(normal_gravity_mps2(site.latitude_deg, site.altitude_m))])
        degree = 2 * self._cone_harmonic + 1 if self._cone_rad else 1
        angles = 2.0 * np.pi * np.arange(4 * degree + 2) / (4 * degree + 2)
        matrices = self.attitude(np.degrees(angles))
        self._earth = _series(np.einsum("nji,j->ni", matrices, earth), degree)
        self._gravity = _series(np.einsum("nji,j->ni", matrices, gravity), degree)
        self._axis = _series(self._turning_direction(angles), degree)
        direction = self._axis.constant
        self._tangential = skew(direction) @ np.array(lever_arm_m)
        self._centripetal = skew(direction) @ self._tangential
        self._has_arm = any(lever_arm_m)

    def attitude(self, angle_deg: Array) -> Array:
        """Shape (n, 3, 3): C_bn, case to east-north-up, at table angles of shape (n,)."""
        angle = np.radians(angle_deg)
        turned = rotation_about(2, angle + self._north_rad) @ self._case_to_platform
        if self._cone_rad:
            phase = self._cone_harmonic * angle + self._cone_phase_rad
            towards = rotation_about(2, phase)
            cone = towards @ rotation_about(0, self._cone_rad) @ towards.swapaxes(-1, -2)
            turned = cone @ turned
        return np.asarray(self._tilt @ turned, dtype=np.float64)

    def _turning_direction(self, angle: Array) -> Array:
        """Shape (n, 3): rate of the case in its own axes per unit table rate: the table's own, and that of
        the cone R_z(α)·R_x(a)·R_z(−α), α = hθ + φ, which is h·R_z(α)·(0, sin a, cos a − 1) in axes that do
        not turn with it."""
        h, a = self._cone_harmonic, self._cone_rad
        phase = h * angle + self._cone_phase_rad
        in_cone = np.array([0.0, h * np.sin(a), h * (np.cos(a) - 1.0) + 1.0])
        fixed = rotation_about(2, phase) @ in_cone
        platform = np.einsum("nji,nj->ni", rotation_about(2, angle + self._north_rad), fixed)
        return np.asarray(platform @ self._case_to_platform, dtype=np.float64)

    def integrals(self, piece: Piece, edges_s: Array, interval_s: float | None = None) -> Integrals:
        """Over the intervals between ``edges_s`` (shape (n + 1,)), which all lie within ``piece``;
        ``interval_s`` is their common length where they have one, free of the rounding of differences."""
        length = np.diff(edges_s) if interval_s is None else np.array([interval_s])
        if piece.at_rest:
            angle = np.array([piece.angle])
            return Integrals(self._earth.at(angle) * length, self._gravity.at(angle) * length)
        if piece.acceleration == 0.0:
            return self._steady(piece, edges_s, length)
        return self._accelerated(piece, edges_s)

    def _steady(self, piece: Piece, edges_s: Array, length: Array) -> Integrals:
        middle = piece.angles(0.5 * (edges_s[1:] + edges_s[:-1]))
        turned = piece.rate * length
        axis, earth, gravity = (
            series.mean_about(middle, turned) for series in (self._axis, self._earth, self._gravity)
        )
        angle = axis * turned + earth * length
        velocity = gravity * length
        if self._has_arm:
            velocity = velocity + self._centripetal[:, np.newaxis] * (np.radians(piece.rate) ** 2 * length)
        return Integrals(angle, velocity)

    def _accelerated(self, piece: Piece, edges_s: Array) -> Integrals:
        degree = max(series.degree for series in (self._axis, self._earth, self._gravity))
        length = np.diff(edges_s)
        rates = piece.rates(edges_s)
        phase = np.radians(np.max(np.abs(rates)) * np.max(length)) * max(degree, 1)
        panels = int(phase / _PANEL_RAD) + 1
        starts = edges_s[:-1, np.newaxis, np.newaxis] + (length / panels)[:, np.newaxis, np.newaxis] * (
            np.arange(panels)[:, np.newaxis] + 0.5 * (_NODES + 1.0)
        )
        weight = (0.5 * _WEIGHTS) * np.ones((panels, 1))
        times = starts.reshape(-1)
        angles, speeds = piece.angles(times), piece.rates(times)

        def integral(values: Array) -> Array:
            shaped = np.broadcast_to(values, (3, len(times))).reshape(3, len(length), panels, len(_NODES))
            return np.asarray(np.einsum("inpk,pk->in", shaped, weight) * (length / panels), dtype=np.float64)

        angle = integral(self._axis.at(angles) * speeds + self._earth.at(angles))
        velocity = integral(self._gravity.at(angles))
        if self._has_arm:
            squares = integral(np.radians(speeds)[np.newaxis, :] ** 2)
            velocity = velocity + self._centripetal[:, np.newaxis] * squares
            velocity = velocity + self._tangential[:, np.newaxis] * np.radians(np.diff(rates))
        return Integrals(angle, velocity)


@dataclass(frozen=True)
class _Series:
    """constant + Σ 2·Re(cₘ e^{imθ}): real vectors of three components; ``coefficients`` m → shape (3,)."""

    constant: Array
    coefficients: tuple[tuple[int, Complex], ...]

    @property
    def degree(self) -> int:
        return max((m for m, _ in self.coefficients), default=0)

    def at(self, angle_deg: Array) -> Array:
        """Shape (3, n) for angles of shape (n,)."""
        return self.mean_about(angle_deg, None)

    def mean_about(self, angle_deg: Array, turned_deg: Array | None) -> Array:
        """Shape (3, n): the mean over ``turned_deg`` (shape (n,) or (1,)) around each angle; (3, 1) for a
        constant."""
        total = self.constant[:, np.newaxis]
        for m, coefficient in self.coefficients:
            phase = np.radians(angle_deg) * m
            cosine, sine = np.cos(phase), np.sin(phase)
            if turned_deg is not None:
                shrink = np.sinc(m * turned_deg / 360.0)
                cosine, sine = cosine * shrink, sine * shrink
            total = total + (
                (2.0 * coefficient.real)[:, np.newaxis] * cosine
                - (2.0 * coefficient.imag)[:, np.newaxis] * sine
            )
        return total


def _series(values: Array, degree: int) -> _Series:
    """From ``values`` (n, 3) at n equal steps of a turn; what is smaller than rounding is left out."""
    spectrum = np.fft.rfft(values, axis=0) / len(values)
    smallest = 1e-16 * np.max(np.abs(spectrum))
    harmonics = tuple(
        (m, spectrum[m]) for m in range(1, degree + 1) if np.max(np.abs(spectrum[m])) > smallest
    )
    return _Series(spectrum[0].real.copy(), harmonics)
