"""The bench's share in a calibration set, against benches whose errors are drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.metrology.conditions import ARCSEC, BenchCapability
from ahrs_lab.metrology.imu_bench import bench_uncertainty
from ahrs_lab.metrology.imu_calibration import Coefficients, PositionData, RotationData
from ahrs_lab.metrology.imu_estimation import ReferenceVectors, estimate
from tests.metrology.imu_unit import REFERENCE, Shown, random_unit

Array = NDArray[np.float64]

PERFECT = BenchCapability(
    rate_relative=(0.0, 0.0, 0.0),
    position_arcsec=0.0,
    wobble_arcsec=0.0,
    axis_tilt_arcsec=0.0,
    azimuth_arcsec=0.0,
    level_arcsec=0.0,
    fixture_perpendicularity_arcsec=0.0,
    latitude_deg=0.0,
    timing_relative=0.0,
)


def face(matrix: Array) -> str:
    axis = int(np.argmax(np.abs(matrix[2])))
    return "xyz"[axis] + ("+" if matrix[2, axis] > 0 else "-")


def data(bench: Shown) -> tuple[list[PositionData], list[RotationData]]:
    """Every face one mounting."""
    return (
        [replace(p, mounting=face(p.case_to_enu)) for p in bench.scheme("12")],
        [replace(r, mounting=face(r.case_to_enu)) for r in bench.all_turns()],
    )


def test_a_perfect_bench_adds_nothing() -> None:
    bench = Shown(random_unit(np.random.default_rng(2), counts=False))
    found, figures = bench_uncertainty(*data(bench), REFERENCE, PERFECT, 0.0)
    assert all(np.abs(v).max() < 1e-12 for v in found.vectors())
    assert set(figures.values()) == {0.0}


def test_leans_of_each_mounting_spread_the_set_as_it_says() -> None:
    bench = Shown(random_unit(np.random.default_rng(2), counts=False))
    positions, rotations = data(bench)
    capability = replace(PERFECT, level_arcsec=40.0, wobble_arcsec=20.0, position_arcsec=30.0)
    said, _ = bench_uncertainty(positions, rotations, REFERENCE, capability, 0.0)
    rng = np.random.default_rng(5)
    errors = []
    for _ in range(400):
        wobble = np.array([*rng.normal(0.0, 10.0, 2), 0.0])
        leans = {
            name: np.array([*rng.normal(0.0, 20.0, 2), 0.0]) + wobble
            for name in ("x+", "x-", "y+", "y-", "z+", "z-")
        }
        both: list[RotationData | PositionData] = [*rotations, *positions]
        references = {name: next(d.case_to_enu for d in both if d.mounting == name) for name in leans}

        def stands(
            d: PositionData | RotationData,
            stop_arcsec: float,
            leans: dict[str, Array] = leans,
            references: dict[str, Array] = references,
        ) -> Array:
            lean = references[d.mounting].T @ leans[d.mounting]
            turned = Rotation.from_rotvec([0.0, 0.0, stop_arcsec * ARCSEC]).as_matrix()
            return np.asarray(turned @ d.case_to_enu @ Rotation.from_rotvec(lean * ARCSEC).as_matrix())

        # what the bench believes is the other way round than what it does: the same to first order
        believed = [replace(p, case_to_enu=stands(p, rng.normal(0.0, 15.0))) for p in positions]
        errors.append(
            [
                a - b
                for a, b in zip(
                    estimate(
                        believed, [replace(r, case_to_enu=stands(r, 0.0)) for r in rotations], REFERENCE
                    ).vectors(),
                    bench.unit.vectors(),
                    strict=True,
                )
            ]
        )
    for part, expected in enumerate(said.vectors()):
        spread = np.sqrt(np.mean([e[part] ** 2 for e in errors], axis=0))
        assert spread == pytest.approx(expected, rel=0.12, abs=1e-9)


@pytest.mark.parametrize(
    ("figure", "value", "check"),
    [
        # a seat's lean is a misalignment of the turns, rad for rad, and g·lean on a level accelerometer
        ("level_arcsec", 40.0, lambda c: c.gyro.E[0, 1] / (20.0 * ARCSEC)),
        # timing goes into the scale factor alone
        ("timing_relative", 2e-5, lambda c: c.gyro.E1[2] / 1e-5),
    ],
)
def test_the_simple_paths_are_what_they_are_by_hand(figure: str, value: float, check: object) -> None:
    unit = Coefficients.from_vectors(
        np.tile([1.0, 0, 0, 0, 0, 0, 0], (3, 1)), np.tile([1.0, 0, 0, 0], (3, 1))
    )
    said, _ = bench_uncertainty(*data(Shown(unit)), REFERENCE, replace(PERFECT, **{figure: value}), 0.0)  # type: ignore[arg-type]
    assert callable(check)
    assert check(said) == pytest.approx(1.0, rel=1e-3)


def test_gravity_goes_into_the_accelerometers_scale_and_latitude_into_no_accelerometer() -> None:
    unit = Coefficients.from_vectors(
        np.tile([1.0, 0, 0, 0, 0, 0, 0], (3, 1)), np.tile([1.0, 0, 0, 0], (3, 1))
    )
    by_gravity, _ = bench_uncertainty(*data(Shown(unit)), REFERENCE, PERFECT, 1e-3)
    assert pytest.approx(np.full(3, 1e-3 / REFERENCE.gravity_mps2), rel=1e-3) == by_gravity.accel.K1
    by_latitude, _ = bench_uncertainty(*data(Shown(unit)), REFERENCE, replace(PERFECT, latitude_deg=0.2), 0.0)
    assert np.abs(by_latitude.accel.K1).max() < 1e-12
    # scheme 12 has every axis up as often as down: a vertical rate goes into Bf, not into B0
    change = np.radians(0.1) * REFERENCE.earth_rate_enu_dps[1] / REFERENCE.gravity_mps2
    assert np.diag(by_latitude.gyro.Bf) == pytest.approx(np.full(3, change), rel=1e-2)
    assert isinstance(REFERENCE, ReferenceVectors)
