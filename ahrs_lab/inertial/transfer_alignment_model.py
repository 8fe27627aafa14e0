"""Error models of transfer alignment (2.5.3.3): which states a method has, how they grow, what is compared.

The unit's computed frame is turned by φ against the reference's east, north, up: Ĉ = (I − φ×)C (2-142). An
error is always the unit's minus the true: δv, δL, δλ; ε, ∇ are what a sensor shows too much, δK_g, δK_a its
relative scale errors. Then, with δω_in = δω_ie + δω_en,

    φ̇ = −ω_in×φ + δω_in − C(ε + diag(ω)δK_g)
    δv̇ = f×φ − (2ω_ie + ω_en)×δv − (2δω_ie + δω_en)×v + δg + C(∇ + diag(f)δK_a)

Differences from the printed text, found when deriving it:

- (2-143), (2-154): the gyros' term has to be −C·δω with (2-142) and an error counted as measured minus true,
  as (2-144) counts the accelerometers'; printed is +. Below (2-143) δω is called an accelerometer error.
- (2-147): the fourth and fifth rows of the noise matrix are (0 0 0 c₁₁ c₁₂ c₁₃) and (0 0 0 c₂₁ c₂₂ c₂₃);
  printed is one row; the noises are those of the case's axes. f is specific force, not acceleration. It
  drops δω_in and Coriolis; the unit here navigates with its own velocity, so they stay.
- (2-158): the element F₁₁(1,2) is 2ω_ie sin L + v_x tan L/(R_N + h); printed is v_y.
- (2-157): C_b^n is the transpose of C_n^b.
- (2-160): H's last row lacks the azimuth error that φ itself makes: (−tan θ sin ψ, −tan θ cos ψ, 1), the
  first row of H₁ in (2-174). Without it the azimuth compared would tell nothing of φ.
- (2-160): a constant difference of azimuth belongs to a level carrier. For a unit turned about its own z
  axis it is AMB·cos γ/cos θ, and a unit not mounted level shows its mounting in azimuth when the carrier
  banks. So azimuth is compared only while the carrier flies nearly level, as the text says in words (“in
  flight without manoeuvre”).
- (2-169): tan γ_s has T₃₃ − T₁₃Δφ_y + T₂₃Δφ_x below the line; printed is T₃₃Δφ_y.
- (2-174): the third row of H₁ has the sign of (2-173), but belongs to −φ: both its elements change sign; and
  the last block is −H₁T_b, not +H₁T_b, as Δφ = T_bλ − φ.

The angles of (2-174) are compared as the rotation vector of Ĉ·(T_a·C_b^a)ᵀ = I + (T_bλ − φ)×, which to first
order is the same and has no singular pitch. An error of the sensors that a method has no state for (a bias,
a scale error, always their misalignments) is *considered* (Schmidt): it is not estimated, but its uncertainty
is carried along, so that the stated one is true of a unit with such errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.inertial.attitude import skew
from ahrs_lab.inertial.earth import (
    EARTH_RATE_RADPS,
    meridian_radius_m,
    normal_gravity_mps2,
    transverse_radius_m,
)
from ahrs_lab.inertial.transfer_alignment_motion import Motion, Window, frame_rates

Array = NDArray[np.float64]
MethodName = Literal["velocity", "position", "velocity-azimuth", "velocity-attitude"]

EARTH_RADIUS_M = 6.371e6
"""Good enough for how large an uncertainty in metres is in radians."""

PHI, VELOCITY = slice(0, 3), slice(3, 6)
LATITUDE, LONGITUDE = 6, 7
GYRO_BIAS, ACCEL_BIAS = slice(8, 11), slice(11, 14)
GYRO_SCALE, ACCEL_SCALE = slice(14, 17), slice(17, 20)
MOUNTING = slice(20, 23)
AZIMUTH = 23
AT_START = slice(24, 27)
GYRO_CROSS, ACCEL_CROSS = slice(27, 33), slice(33, 39)
SIZE: Final = 39
CROSS: Final = ((0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1))
"""Output channel and input axis of the sensors' six misalignments, each of gyros and accelerometers."""

NAMES: Final = (
    *("φ_E", "φ_N", "φ_U", "δv_E", "δv_N", "δv_U", "δL", "δλ"),
    *("ε_x", "ε_y", "ε_z", "∇_x", "∇_y", "∇_z"),
    *("δK_gx", "δK_gy", "δK_gz", "δK_ax", "δK_ay", "δK_az"),
    *("λ_x", "λ_y", "λ_z", "AMB"),
    *("φ_E(0)", "φ_N(0)", "φ_U(0)"),
    *(f"E_{'xyz'[i]}{'xyz'[j]}" for i, j in CROSS),
    *(f"K_{'xyz'[i]}{'xyz'[j]}" for i, j in CROSS),
)
"""φ(0) is φ as it was at the start: it never changes, and every comparison tells of it too. E and K are the
misalignments of gyros and accelerometers in the unit's case; no method estimates them."""


@dataclass(frozen=True)
class Method:
    """``estimated`` and ``considered``: indices of states among :data:`NAMES`; ``compares``: what is
    measured, in this order: v_E, v_N, v_U (0, 1, 2), latitude, longitude (3, 4), azimuth (5), the three
    angles (6, 7, 8)."""

    name: MethodName
    estimated: tuple[int, ...]
    considered: tuple[int, ...]
    compares: tuple[int, ...]

    @property
    def states(self) -> tuple[int, ...]:
        """Estimated, then considered, then φ at the start."""
        return (*self.estimated, *self.considered, *range(AT_START.start, AT_START.stop))

    @property
    def needs_attitude(self) -> bool:
        """Whether the reference's attitude is compared."""
        return any(one >= 5 for one in self.compares)


_PHI, _GYRO, _ACCEL = (0, 1, 2), (8, 9, 10), (11, 12, 13)
_SCALE, _CROSS = tuple(range(14, 20)), tuple(range(27, 39))
METHODS: Final[dict[str, Method]] = {
    "velocity": Method("velocity", (*_PHI, 3, 4), _GYRO + _ACCEL + _SCALE + _CROSS, (0, 1)),
    "position": Method("position", (*_PHI, 3, 4, 6, 7, *_GYRO), _ACCEL + _SCALE + _CROSS, (3, 4)),
    "velocity-azimuth": Method("velocity-azimuth", (*range(6), *range(8, 20), 23), _CROSS, (0, 1, 2, 5)),
    "velocity-attitude": Method(
        "velocity-attitude", (*range(7), *_GYRO, *_ACCEL, 20, 21, 22), _SCALE + _CROSS, (0, 1, 2, 6, 7, 8)
    ),
}


@dataclass(frozen=True)
class Assumptions:
    """Standard deviations before and during the alignment, SI units and radians.

    ``*_noise``: of one comparison; ``angle_random_walk`` rad/√s, ``velocity_random_walk`` (m/s)/√s; the
    others what is known at the start. ``level_limit``: azimuth is compared while roll and pitch are below
    it."""

    velocity_noise: float
    position_noise_m: float
    attitude_noise: float
    angle_random_walk: float
    velocity_random_walk: float
    level: float
    azimuth: float
    velocity: float
    position_m: float
    gyro_bias: float
    accel_bias: float
    gyro_scale: float
    accel_scale: float
    gyro_cross: float
    accel_cross: float
    mounting: float
    level_limit: float


def error_matrix(window: Window, latitude: Array, altitude: Array) -> Array:
    """F of all states, shape (b, 39, 39), 1/s, from the means over a window."""
    b = len(latitude)
    degrees = np.degrees(latitude)
    along_east = transverse_radius_m(degrees) + altitude
    along_north = meridian_radius_m(degrees) + altitude
    v = window.velocity
    tangent, cosine = np.tan(latitude), np.cos(latitude)
    earth, over = frame_rates(latitude, altitude, v)

    over_by_velocity = np.zeros((b, 3, 3))
    over_by_velocity[:, 0, 1] = -1 / along_north
    over_by_velocity[:, 1, 0] = 1 / along_east
    over_by_velocity[:, 2, 0] = tangent / along_east
    zero = np.zeros(b)
    earth_by_latitude = EARTH_RATE_RADPS * np.stack([zero, -np.sin(latitude), cosine], axis=-1)
    over_by_latitude = np.stack([zero, zero, v[:, 0] / cosine**2 / along_east], axis=-1)

    F = np.zeros((b, SIZE, SIZE))
    F[:, PHI, PHI] = -skew(earth + over)
    F[:, PHI, VELOCITY] = over_by_velocity
    F[:, PHI, LATITUDE] = earth_by_latitude + over_by_latitude
    F[:, PHI, GYRO_BIAS] = -window.C
    axes, (outputs, inputs) = np.arange(3), np.array(CROSS).T
    F[:, PHI, GYRO_SCALE] = -window.C_rate[:, :, axes, axes]
    F[:, PHI, GYRO_CROSS] = -window.C_rate[:, :, outputs, inputs]
    F[:, VELOCITY, PHI] = skew(window.force)
    F[:, VELOCITY, VELOCITY] = skew(v) @ over_by_velocity - skew(2 * earth + over)
    F[:, VELOCITY, LATITUDE] = np.cross(v, 2 * earth_by_latitude + over_by_latitude)
    by_latitude = normal_gravity_mps2(degrees + 0.01, altitude) - normal_gravity_mps2(
        degrees - 0.01, altitude
    )
    F[:, 5, LATITUDE] -= by_latitude / np.radians(0.02)
    F[:, VELOCITY, ACCEL_BIAS] = window.C
    F[:, VELOCITY, ACCEL_SCALE] = window.C_force[:, :, axes, axes]
    F[:, VELOCITY, ACCEL_CROSS] = window.C_force[:, :, outputs, inputs]
    F[:, LATITUDE, 4] = 1 / along_north
    F[:, LONGITUDE, 3] = 1 / (along_east * cosine)
    F[:, LONGITUDE, LATITUDE] = v[:, 0] * tangent / (along_east * cosine)
    return F


def discrete(F: Array, noise: Array, duration_s: float) -> tuple[Array, Array]:
    """Φ and Q over a window, shapes (b, n, n), for ``noise`` (n,): spectral densities of white noises that
    enter the states one by one (rotated isotropic noise is isotropic). Q by Simpson's rule, exact for the
    double integral."""

    def transition(step_s: float) -> Array:
        A = F * step_s
        A2 = A @ A
        return np.asarray(np.eye(F.shape[-1]) + A + A2 / 2 + A2 @ A / 6)

    half, whole = transition(duration_s / 2), transition(duration_s)
    q = np.diag(noise)
    Q = duration_s / 6 * (q + 4 * half @ q @ half.mT + whole @ q @ whole.mT)
    return whole, Q


def comparison_matrix(C_bn: Array) -> Array:
    """H of all states for all that can be compared, shape (b, 9, 39), for the unit's attitude (b, 3, 3)."""
    H = np.zeros((len(C_bn), 9, SIZE))
    for row, state in ((0, 3), (1, 4), (2, 5), (3, LATITUDE), (4, LONGITUDE)):
        H[:, row, state] = 1.0
    forward = C_bn[:, :, 1]
    level = forward[:, 0] ** 2 + forward[:, 1] ** 2
    H[:, 5, 0] = -forward[:, 2] * forward[:, 0] / level
    H[:, 5, 1] = -forward[:, 2] * forward[:, 1] / level
    H[:, 5, 2] = 1.0
    # the mounting about x is read from both attitudes, so the unit's misalignment is in it
    H[:, 5, PHI] += tilt_share(C_bn)[:, np.newaxis] * C_bn[:, :, 0]
    H[:, 5, AZIMUTH] = azimuth_share(C_bn)
    H[:, 6:9, PHI] = -np.eye(3)
    H[:, 6:9, MOUNTING] = C_bn
    return H


def azimuth_share(C_bn: Array) -> Array:
    """cos γ/cos θ, shape (b,): how far a turn about the case's z axis shows in azimuth."""
    forward = C_bn[:, :, 1]
    return np.asarray(C_bn[:, 2, 2] / (forward[:, 0] ** 2 + forward[:, 1] ** 2))


def tilt_share(C_bn: Array) -> Array:
    """sin γ/cos θ, shape (b,): how far a turn about the case's x axis shows in azimuth, in a bank."""
    up, forward = C_bn[:, :, 2], C_bn[:, :, 1]
    across = up[:, 0] * forward[:, 1] - up[:, 1] * forward[:, 0]
    return np.asarray(across / (forward[:, 0] ** 2 + forward[:, 1] ** 2))


def prior_covariance(motion: Motion, assumed: Assumptions, copied: bool, method: Method) -> Array:
    """Covariance of all states at the start, shape (b, 39, 39).

    With the attitude copied from the reference, φ = C·λ: misalignment and mounting are one unknown, not two.
    """
    C_bn = motion.C_bn
    b = len(C_bn)
    metre = 1 / EARTH_RADIUS_M
    sigma = np.zeros(SIZE)
    sigma[PHI] = (assumed.level, assumed.level, assumed.azimuth)
    sigma[VELOCITY] = assumed.velocity
    sigma[LATITUDE] = assumed.position_m * metre
    sigma[LONGITUDE] = assumed.position_m * metre / np.cos(motion.latitude[0])
    sigma[GYRO_BIAS], sigma[ACCEL_BIAS] = assumed.gyro_bias, assumed.accel_bias
    sigma[GYRO_SCALE], sigma[ACCEL_SCALE] = assumed.gyro_scale, assumed.accel_scale
    sigma[GYRO_CROSS], sigma[ACCEL_CROSS] = assumed.gyro_cross, assumed.accel_cross
    sigma[MOUNTING], sigma[AZIMUTH] = assumed.mounting, assumed.mounting
    P = np.repeat(np.diag(sigma**2)[np.newaxis], b, axis=0)
    noise = assumed.attitude_noise**2
    if copied and AZIMUTH in method.estimated:
        P[:, 2, 2] = assumed.mounting**2 + noise
        share = 1 / azimuth_share(C_bn)
        P[:, AZIMUTH, AZIMUTH] = share**2 * assumed.mounting**2
        P[:, 2, AZIMUTH] = P[:, AZIMUTH, 2] = -share * assumed.mounting**2
    elif copied and method.needs_attitude:
        P[:, PHI, PHI] = (assumed.mounting**2 + noise) * np.eye(3)
        P[:, PHI, MOUNTING] = assumed.mounting**2 * C_bn
        P[:, MOUNTING, PHI] = assumed.mounting**2 * C_bn.mT
    # the start is its own misalignment
    P[:, AT_START] = P[:, PHI]
    P[:, :, AT_START] = P[:, :, PHI]
    return P
