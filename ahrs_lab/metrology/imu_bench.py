"""What the bench's own errors make of a calibration set: level, fixture, north, stops, gravity, latitude.

Each error is put into the references, one standard uncertainty at a time, and the set is estimated again; the
changes add up in quadrature. The sensor's noise is not in it (that is
:attr:`~ahrs_lab.metrology.imu_calibration.Quality.standard_uncertainty`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import hypot, radians

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.metrology.conditions import ARCSEC, BenchCapability
from ahrs_lab.metrology.imu_calibration import (
    Coefficients,
    PositionData,
    RotationData,
)
from ahrs_lab.metrology.imu_estimation import ReferenceVectors, estimate

Array = NDArray[np.float64]

ANOMALY_MPS2 = 3e-4
"""How far true gravity lies from the normal formula (30 mGal), standard uncertainty; mountains have more."""
MEASURED_GRAVITY_MPS2 = 1e-5
"""Of a gravity that is given for the site (1 mGal)."""
_EAST, _NORTH, _UP = np.eye(3)


@dataclass(frozen=True)
class _Data:
    positions: Sequence[PositionData]
    rotations: Sequence[RotationData]
    reference: ReferenceVectors


def bench_uncertainty(
    positions: Sequence[PositionData],
    rotations: Sequence[RotationData],
    reference: ReferenceVectors,
    capability: BenchCapability,
    gravity_uncertainty_mps2: float = ANOMALY_MPS2,
) -> tuple[Coefficients, dict[str, float]]:
    """Standard uncertainty of each coefficient by the bench, and the figures that it was made from (standard
    uncertainties: angles in seconds of arc, latitude in degrees, gravity in m/s²)."""
    names = (
        "azimuth_arcsec", "axis_tilt_arcsec", "level_arcsec", "fixture_perpendicularity_arcsec",
        "wobble_arcsec", "position_arcsec", "latitude_deg", "timing_relative",
    )  # fmt: skip
    figures = {name: capability.figure(name).standard for name in names}
    figures["gravity_mps2"] = gravity_uncertainty_mps2
    data = _Data(positions, rotations, reference)
    gyro, accel = estimate(positions, rotations, reference).vectors()
    gyro_variance, accel_variance = np.zeros_like(gyro), np.zeros_like(accel)
    for changed in _changes(data, figures):
        gyro_off, accel_off = estimate(changed.positions, changed.rotations, changed.reference).vectors()
        gyro_variance += (gyro_off - gyro) ** 2
        accel_variance += (accel_off - accel) ** 2
    return Coefficients.from_vectors(np.sqrt(gyro_variance), np.sqrt(accel_variance)), figures


def _changes(data: _Data, figures: dict[str, float]) -> Iterator[_Data]:
    place = data.reference
    yield replace(data, reference=replace(place, gravity_mps2=place.gravity_mps2 + figures["gravity_mps2"]))
    # a latitude further north leans the Earth's axis towards up
    leaning = _rotation(_EAST * radians(figures["latitude_deg"]))
    yield replace(data, reference=replace(place, earth_rate_enu_dps=leaning @ place.earth_rate_enu_dps))
    slow = 1.0 + figures["timing_relative"]
    yield replace(
        data,
        rotations=[replace(r, angle=r.angle * slow, duration_s=r.duration_s * slow) for r in data.rotations],
    )
    yield _turned(data, lambda d: _rotation(_UP * figures["azimuth_arcsec"] * ARCSEC) @ d.case_to_enu)
    tilt, seat = (
        figures["axis_tilt_arcsec"],
        hypot(figures["level_arcsec"], figures["fixture_perpendicularity_arcsec"]),
    )
    mountings = _first_of_each(data)
    for direction in (_EAST, _NORTH):
        leans = _rotation(direction * tilt * ARCSEC)
        # the turning axis leans with the table: what the case sees of a turn stays the same
        yield replace(data, positions=[replace(p, case_to_enu=leans @ p.case_to_enu) for p in data.positions])
        wobble = {name: matrix.T @ direction * figures["wobble_arcsec"] for name, matrix in mountings.items()}
        yield _seated(data, wobble)
        for name, matrix in mountings.items():
            yield _seated(data, {name: matrix.T @ direction * seat})
    stop = _rotation(_UP * figures["position_arcsec"] * ARCSEC)
    for index, position in enumerate(data.positions):
        moved = list(data.positions)
        moved[index] = replace(position, case_to_enu=stop @ position.case_to_enu)
        yield replace(data, positions=moved)


def _rotation(vector_rad: Array) -> Array:
    return np.asarray(Rotation.from_rotvec(vector_rad).as_matrix())


def _turned(data: _Data, change: Callable[[PositionData | RotationData], Array]) -> _Data:
    return replace(
        data,
        positions=[replace(p, case_to_enu=change(p)) for p in data.positions],
        rotations=[replace(r, case_to_enu=change(r)) for r in data.rotations],
    )


def _seated(data: _Data, lean_arcsec: dict[str, Array]) -> _Data:
    """The case leaning in its seat by a rotation vector in case axes, which turns with the table."""
    still = np.zeros(3)
    return _turned(data, lambda d: d.case_to_enu @ _rotation(lean_arcsec.get(d.mounting, still) * ARCSEC))


def _first_of_each(data: _Data) -> dict[str, Array]:
    first: dict[str, Array] = {}
    both: list[RotationData | PositionData] = [*data.rotations, *data.positions]
    for one in both:
        first.setdefault(one.mounting, one.case_to_enu)
    return first
