"""The 33 coefficients of a unit from whole turns and positions at rest, (2-175) … (2-189).

Gyros, channel i, with M = E1 ∘ (I + E), s = E1·(B0, Bf):

1. turns: ∫N dt = M·∫ω dt + b·T, one b for each axis that stands up. Of two senses this is half their
   difference over the angle, (2-175) … (2-183); b takes what both show alike (bias, Bf·f, the Earth about up,
   an asymmetry of the channel), so that no property of fast turns enters the bias.
2. positions: N − M·ω_ie = s₀ + s·f, (2-184) … (2-186)

then E1 = M_ii, E_ij = M_ij/M_ii (this division is missing in print), B0 = s₀/M_ii, Bf = s/M_ii.
Accelerometers: N_A = a₀ + A·f, (2-187) … (2-189), K1 = A_ii, K0 = a₀/A_ii, K_ij = A_ij/A_ii.

Least squares, weighted by the means' standard errors, reaches the statistical limit. All steps are linear in
the outputs up to the last one, so the covariance (:mod:`ahrs_lab.metrology.imu_covariance`) is that of one
linear map of all means.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.imu_calibration import (
    AXES,
    OTHERS,
    Coefficients,
    ImuCalibration,
    PositionData,
    Quality,
    RotationData,
    position_matrix,
)
from ahrs_lab.metrology.imu_covariance import (
    Covariances,
    Triad,
    after_division,
    covariance_of,
    deviations,
    errors_of_means,
)
from ahrs_lab.metrology.uncertainty.noise import NoiseModel

Array = NDArray[np.float64]

FEWEST_POSITIONS = 4
LARGEST_CONDITION = 1e4
"""Of the positions' matrix: beyond, rank is lost to the bench's own errors of angle (20″ = 10⁻⁴ rad)."""
POOR_CONDITION = 10.0


@dataclass(frozen=True)
class ReferenceVectors:
    """What the place gives: ``gravity_mps2``; ``earth_rate_enu_dps``, shape (3,), east, north, up."""

    gravity_mps2: float
    earth_rate_enu_dps: Array


def calibrate(
    positions: Sequence[PositionData],
    rotations: Sequence[RotationData],
    reference: ReferenceVectors,
    *,
    gyro_noise: Sequence[NoiseModel] | None = None,
    accel_noise: Sequence[NoiseModel] | None = None,
    rate_unit: str = "",
    accel_unit: str = "",
) -> ImuCalibration:
    """The calibration set with its quality.

    ``gyro_noise``, ``accel_noise``: of each channel, in output units; their flicker and random walk widen the
    covariance by the drift between the data (B0 and K0 are then the mean over the positions). Raises
    InputError where positions or turns do not separate the coefficients.
    """
    condition = check_positions(positions)
    check_rotations(rotations)
    gyro = _gyro(positions, rotations, reference)
    accel = _accel(positions, reference)
    coefficients = _coefficients(gyro.linear, accel.linear)
    data: list[RotationData | PositionData] = [*rotations, *positions]
    starts = np.array([d.start_s for d in data])
    durations = np.array([d.duration_s for d in data])
    turns = len(rotations)
    gyro_errors = errors_of_means(gyro, _gyro_errors(positions, rotations), durations, turns)
    accel_errors = errors_of_means(accel, np.array([p.accel_error for p in positions]), durations[turns:], 0)
    gyro_part = covariance_of(gyro, gyro_errors, starts, durations, turns, gyro_noise)
    accel_part = covariance_of(accel, accel_errors, starts[turns:], durations[turns:], 0, accel_noise)
    gyro_covariance = np.array([after_division(gyro.linear[i], i, gyro_part.linear[i]) for i in range(3)])
    accel_covariance = np.array([after_division(accel.linear[i], i, accel_part.linear[i]) for i in range(3)])
    quality = Quality(
        standard_uncertainty=Coefficients.from_vectors(
            deviations(gyro_covariance), deviations(accel_covariance)
        ),
        gyro_covariance=gyro_covariance,
        accel_covariance=accel_covariance,
        gyro_condition=condition,
        accel_condition=condition,
        turns_condition=float(np.linalg.cond(_unit_columns(_turns_matrix(rotations, reference)))),
        gyro_residuals=gyro.residuals / coefficients.gyro.E1,
        accel_residuals=accel.residuals / coefficients.accel.K1,
        positions=tuple(p.name for p in positions),
    )
    warnings = _warnings(len(positions), condition, gyro_part, accel_part)
    return ImuCalibration(coefficients, rate_unit, accel_unit, quality, warnings)


def estimate(
    positions: Sequence[PositionData], rotations: Sequence[RotationData], reference: ReferenceVectors
) -> Coefficients:
    """The coefficients alone, of data that :func:`calibrate` takes."""
    return _coefficients(_gyro(positions, rotations, reference).linear, _accel(positions, reference).linear)


def check_positions(positions: Sequence[PositionData]) -> float:
    """The condition number of [1, f/g]; raises InputError where the positions lack rank."""
    matrix = position_matrix([p.case_to_enu for p in positions])
    _, sizes, rows = np.linalg.svd(matrix, full_matrices=True)
    sizes = np.concatenate([sizes, np.zeros(4 - len(sizes))])
    rank = int(np.sum(sizes > max(sizes[0], 1.0) / LARGEST_CONDITION))
    if rank == FEWEST_POSITIONS:
        return float(sizes[0] / sizes[-1])
    mixed = np.max(np.abs(rows[rank:]), axis=0) > 1e-3
    names = [
        *(["B0, K0"] if mixed[0] else []),
        *(axis for axis, one in zip(AXES, mixed[1:], strict=True) if one),
    ]
    raise InputError(
        "The {count} positions have rank {rank} of 4 and leave open, alone or against each other: {names}. "
        "Add positions in which other axes point up and down, for example those of scheme 6 or 12.",
        count=len(positions),
        rank=rank,
        names=", ".join(names),
    )


def check_rotations(rotations: Sequence[RotationData]) -> None:
    """Raises InputError where an axis was not turned about in both senses of one mounting."""
    for axis, name in enumerate(AXES):
        about = [r for r in rotations if r.axis == axis]
        if not about:
            raise InputError(
                "There are no turns about {axis}: its scale factor and the misalignments to it need whole "
                "turns in both senses with {axis} vertical.",
                axis=name,
            )
        senses = {(r.case_to_enu[2, axis] > 0.0, r.turned_deg > 0.0) for r in about}
        if not any((up, True) in senses and (up, False) in senses for up in (True, False)):
            raise InputError(
                "About {axis} the table turned in one sense only: record the same turns in the other sense "
                "too, with the case mounted alike.",
                axis=name,
            )


def _turns_matrix(rotations: Sequence[RotationData], reference: ReferenceVectors) -> Array:
    """Shape (k, 3 + groups): ∫ω dt in case axes, degrees, and T under each (axis, up or down)."""
    groups = sorted({(r.axis, bool(r.case_to_enu[2, r.axis] > 0.0)) for r in rotations})
    matrix = np.zeros((len(rotations), 3 + len(groups)))
    for row, r in zip(matrix, rotations, strict=True):
        east, north, up = reference.earth_rate_enu_dps
        earth = np.array(
            [
                r.mean_cosine * east + r.mean_sine * north,
                r.mean_cosine * north - r.mean_sine * east,
                up,
            ]
        )
        row[:3] = r.case_to_enu.T @ (earth * r.duration_s + np.array([0.0, 0.0, r.turned_deg]))
        row[3 + groups.index((r.axis, bool(r.case_to_enu[2, r.axis] > 0.0)))] = r.duration_s
    return matrix


def _gyro(
    positions: Sequence[PositionData], rotations: Sequence[RotationData], reference: ReferenceVectors
) -> Triad:
    """Parameters (M x y z, s₀, s x y z) of each channel; means: turns' angles over their times, then
    positions."""
    turns = _turns_matrix(rotations, reference)
    times = np.array([r.duration_s for r in rotations])
    angles = np.array([r.angle for r in rotations])
    angle_weights = _weights(np.array([r.angle_error for r in rotations]), np.sqrt(times))
    rests = position_matrix([p.case_to_enu for p in positions])
    unit = np.array([1.0, *[reference.gravity_mps2] * 3])[:, np.newaxis]
    outputs = np.array([p.gyro for p in positions])
    weights = _weights(
        np.array([p.gyro_error for p in positions]), 1.0 / np.sqrt([p.duration_s for p in positions])
    )
    earth = np.array([p.case_to_enu.T @ reference.earth_rate_enu_dps for p in positions])
    linear, maps, residuals, keeps = [], [], [], []
    for i in range(3):
        to_M = _solver(turns, angle_weights[:, i])[:3]
        to_s = _solver(rests, weights[:, i]) / unit
        M = to_M @ angles[:, i]
        left = outputs[:, i] - earth @ M
        s = to_s @ left
        linear.append(np.concatenate([M, s]))
        upper = np.hstack([to_M * times, np.zeros((3, len(positions)))])
        maps.append(np.vstack([upper, np.hstack([-(to_s @ earth) @ (to_M * times), to_s])]))
        keeps.append(np.eye(len(rests)) - (rests * unit[:, 0]) @ to_s)
        residuals.append(keeps[-1] @ left)
    return Triad(np.array(linear), np.array(maps), np.array(residuals).T, np.array(keeps))


def _accel(positions: Sequence[PositionData], reference: ReferenceVectors) -> Triad:
    """Parameters (A x y z, a₀) of each channel."""
    rests = position_matrix([p.case_to_enu for p in positions])
    unit = np.array([1.0, *[reference.gravity_mps2] * 3])[:, np.newaxis]
    outputs = np.array([p.accel for p in positions])
    weights = _weights(
        np.array([p.accel_error for p in positions]), 1.0 / np.sqrt([p.duration_s for p in positions])
    )
    solved = np.array([_solver(rests, weights[:, i]) for i in range(3)])
    keeps = np.eye(len(rests)) - rests @ solved
    maps = np.roll(solved / unit, -1, axis=1)
    return Triad(
        linear=np.einsum("cpn,nc->cp", maps, outputs),
        maps=maps,
        residuals=np.einsum("cmn,nc->mc", keeps, outputs),
        keeps=keeps,
    )


def _weights(errors: Array, otherwise: Array) -> Array:
    """Shape (n, 3): 1/standard error; where a channel's are not all known, 1/``otherwise`` (n,)."""
    known = np.all(errors > 0.0, axis=0)
    return np.asarray(1.0 / np.where(known, np.where(errors > 0.0, errors, 1.0), otherwise[:, np.newaxis]))


def _solver(matrix: Array, weights: Array) -> Array:
    """Shape (p, n): the map of weighted least squares from outputs to parameters; columns are brought to one
    size first, so that units do not spoil the numbers."""
    weighted = matrix * weights[:, np.newaxis]
    size = np.linalg.norm(weighted, axis=0)
    return np.asarray(np.linalg.pinv(weighted / size) / size[:, np.newaxis] * weights)


def _unit_columns(matrix: Array) -> Array:
    return np.asarray(matrix / np.linalg.norm(matrix, axis=0))


def _coefficients(gyro: Array, accel: Array) -> Coefficients:
    return Coefficients.from_vectors(
        np.array([_divided(gyro[i], i) for i in range(3)]),
        np.array([_divided(accel[i], i) for i in range(3)]),
    )


def _divided(linear: Array, channel: int) -> Array:
    """(M x y z, s …) → (M_ii, s/M_ii …, M_ij/M_ii of the two others)."""
    scale = linear[channel]
    if not abs(scale) > 1e-12 * max(1e-300, float(np.abs(linear[:3]).max())):
        raise InputError(
            "Channel {axis} does not follow its own axis: its output stays the same whatever is put in. "
            "Check the order of the columns and the recording.",
            axis=AXES[channel],
        )
    return np.concatenate([[scale], linear[3:] / scale, linear[list(OTHERS[channel])] / scale])


def _gyro_errors(positions: Sequence[PositionData], rotations: Sequence[RotationData]) -> Array:
    """Shape (k + n, 3): standard errors of the mean rates."""
    return np.array([*(r.angle_error / r.duration_s for r in rotations), *(p.gyro_error for p in positions)])


def _warnings(count: int, condition: float, gyro: Covariances, accel: Covariances) -> tuple[Message, ...]:
    found = []
    if count == FEWEST_POSITIONS:
        found.append(
            Message(
                "Four positions give four equations for four coefficients: nothing shows an error of a "
                "position. Record six or more."
            )
        )
    if condition > POOR_CONDITION:
        found.append(
            Message(
                "The positions' condition number is {condition} (1.7 where every face is up and down): small "
                "errors of angle grow in the coefficients.",
                condition=f"{condition:.3g}",
            )
        )
    for name, part in ((Message("gyros"), gyro), (Message("accelerometers"), accel)):
        if part.scatter > 1.0:
            found.append(_scatter(name, part))
    return tuple(found)


def _scatter(sensors: Message, part: Covariances) -> Message:
    factor = f"{part.scatter:.2g}"
    if part.drift_seen:
        return Message(
            "The {sensors} scatter over the positions {factor} times more than their noise and drift "
            "explain; the standard uncertainties were widened by it. Check level, fixture and warm-up.",
            sensors=sensors,
            factor=factor,
        )
    return Message(
        "The {sensors} scatter over the positions {factor} times more than their noise explains, and the "
        "dwells are too short to show a drift; the standard uncertainties take it as drift. Record longer "
        "dwells, or check level, fixture and warm-up.",
        sensors=sensors,
        factor=factor,
    )
