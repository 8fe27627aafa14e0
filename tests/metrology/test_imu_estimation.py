"""33 coefficients from turns and positions: exact without noise, at the statistical limit with it, refused
where the positions or turns do not tell them apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.errors import InputError
from ahrs_lab.inertial.sensor_noise import NoiseCoefficients, SlowDrift
from ahrs_lab.metrology.imu_calibration import (
    SCHEMES,
    Coefficients,
    ImuCalibration,
    PositionData,
    case_to_enu,
    position_matrix,
)
from ahrs_lab.metrology.imu_estimation import calibrate
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from tests.metrology.imu_unit import REFERENCE, UP, Shown, limits, random_unit

Array = NDArray[np.float64]


def off(found: Coefficients, true: Coefficients) -> float:
    """Largest error; scale factors relative."""
    one, other = found.vectors(), true.vectors()
    errors = [
        np.abs(a - b) / np.where(np.arange(a.shape[1]) == 0, np.abs(b), 1.0)
        for a, b in zip(one, other, strict=True)
    ]
    return max(float(e.max()) for e in errors)


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1), scheme=st.sampled_from(list(SCHEMES)))
def test_without_noise_every_coefficient_comes_back(seed: int, scheme: str) -> None:
    unit = random_unit(np.random.default_rng(seed))
    bench = Shown(unit)
    found = calibrate(bench.scheme(scheme), bench.all_turns(), REFERENCE)
    assert off(found.coefficients, unit) < 1e-9
    assert found.warnings == ()


def test_ramps_and_rests_of_the_turns_leave_no_trace() -> None:
    unit = random_unit(np.random.default_rng(5))
    bench = Shown(unit)
    assert (
        off(calibrate(bench.scheme("8"), bench.all_turns(1, ramp_s=0.7), REFERENCE).coefficients, unit) < 1e-9
    )


def test_turns_of_unequal_number_and_mountings_upside_down_are_taken_too() -> None:
    unit = random_unit(np.random.default_rng(6))
    bench = Shown(unit)
    turns = [bench.turns(up, n) for up in ("DWN", "SUW", "NWU", "SWD") for n in (3, -5)]
    assert off(calibrate(bench.scheme("12"), turns, REFERENCE).coefficients, unit) < 1e-9


def test_the_positions_of_the_schemes_are_what_they_say() -> None:
    for name, positions in SCHEMES.items():
        assert len(positions) == len(set(positions)) == int(name)
        assert all(np.linalg.det(case_to_enu(letters)) == pytest.approx(1.0) for letters in positions)
    azimuths = {
        name: {letters: Rotation.from_matrix(case_to_enu(letters)) for letters in positions}
        for name, positions in SCHEMES.items()
    }
    half = Rotation.from_euler("z", 180.0, degrees=True)
    for name in ("12", "16", "20", "24"):  # each with its opposite: the Earth's horizontal rate cancels
        for turn in azimuths[name].values():
            assert any(
                np.allclose((half * turn).as_matrix(), other.as_matrix()) for other in azimuths[name].values()
            )


@pytest.mark.parametrize(("scheme", "rank"), [("6", 4), ("8", 5), ("12", 6), ("16", 7), ("20", 7), ("24", 7)])
def test_what_the_positions_could_tell_of_the_gyros_scale_by_the_earths_rate(scheme: str, rank: int) -> None:
    matrices = [case_to_enu(letters) for letters in SCHEMES[scheme]]
    earth = np.array([m.T @ REFERENCE.earth_rate_enu_dps for m in matrices]) / 0.004
    assert np.linalg.matrix_rank(np.column_stack([position_matrix(matrices), earth])) == rank


FACES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
EDGES = ((1, 1, 0), (1, 0, 1), (0, 1, 1), (1, -1, 0), (0, 1, -1), (-1, 0, 1))


def standing(up: tuple[int, int, int]) -> Array:
    """Some case-to-ENU matrix with this case direction up."""
    direction = np.array(up) / np.linalg.norm(up)
    side = np.cross(direction, (0.3, 0.5, 0.9))
    side /= np.linalg.norm(side)
    return np.array([side, np.cross(direction, side), direction])


@pytest.mark.parametrize(
    ("matrices", "bias", "coefficient"),
    [
        ([case_to_enu(p) for p in SCHEMES["6"]], 0.408, 0.707),
        ([standing(up) for up in (*FACES, *EDGES)], 0.309, 0.512),
        ([case_to_enu(p) for p in SCHEMES["24"]], 0.204, 0.354),
        ([case_to_enu(p) for p in SCHEMES["12"]], 12**-0.5, 0.5),
    ],
    ids=["6", "12 with edges", "24", "12"],
)  # fmt: skip
def test_positions_reach_their_published_limits(
    matrices: list[Array], bias: float, coefficient: float
) -> None:
    """In σ/√T: of the bias, and of the coefficient of 1 g."""
    unit = Coefficients.from_vectors(
        np.tile([1.0, 0, 0, 0, 0, 0, 0], (3, 1)), np.tile([1.0, 0, 0, 0], (3, 1))
    )
    bench = Shown(unit, gyro_density=1e-6, accel_density=1e-4)
    found = calibrate([bench.position(m, 100.0) for m in matrices], bench.all_turns(), REFERENCE)
    assert found.quality is not None
    said = found.quality.standard_uncertainty
    per_root_s = 1e-6 / 10.0
    assert pytest.approx(np.full(3, bias * per_root_s), rel=2e-3) == said.gyro.B0
    assert said.gyro.Bf * REFERENCE.gravity_mps2 == pytest.approx(
        np.full((3, 3), coefficient * per_root_s), rel=2e-3
    )
    assert pytest.approx(np.full(3, bias * 1e-5), rel=2e-3) == said.accel.K0
    assert said.accel.K1 * REFERENCE.gravity_mps2 == pytest.approx(np.full(3, coefficient * 1e-5), rel=2e-3)


def test_turns_reach_their_published_limit() -> None:
    """Misalignment: N/√(720·n·Ω) rad, N in °/√s."""
    unit = Coefficients.from_vectors(
        np.tile([1.0, 0, 0, 0, 0, 0, 0], (3, 1)), np.tile([1.0, 0, 0, 0], (3, 1))
    )
    bench = Shown(unit, gyro_density=1e-3, accel_density=1e-4)
    found = calibrate(bench.scheme("6"), bench.all_turns(10), REFERENCE)
    assert found.quality is not None
    said = found.quality.standard_uncertainty.gyro
    limit = 1e-3 / np.sqrt(720.0 * 10 * 100.0)
    assert said.E[~np.eye(3, dtype=bool)] == pytest.approx(np.full(6, limit), rel=1e-6)
    assert pytest.approx(np.full(3, limit), rel=1e-6) == said.E1


@pytest.mark.parametrize("scheme", ["8", "12"])
def test_errors_stay_at_the_limit_and_the_standard_uncertainties_are_honest(scheme: str) -> None:
    unit = random_unit(np.random.default_rng(3))
    bench = Shown(unit, gyro_density=3e-3, accel_density=1e-3, rng=np.random.default_rng(9))
    positions, turns = bench.scheme(scheme), bench.all_turns()
    limit = limits(unit, positions, turns)
    true = unit.vectors()
    runs, inside, squares = 1000, [0.0, 0.0], [np.zeros((3, 7)), np.zeros((3, 4))]
    for _ in range(runs):
        found = calibrate(*bench.drawn(positions, turns), REFERENCE)
        assert found.quality is not None
        said = found.quality.standard_uncertainty.vectors()
        for part, (value, u) in enumerate(zip(found.coefficients.vectors(), said, strict=True)):
            error = value - true[part]
            inside[part] += float(np.mean(np.abs(error) <= 1.96 * u)) / runs
            squares[part] += error**2 / runs
    for part in range(2):
        assert 0.94 <= inside[part] <= 0.965
        ratio = np.sqrt(squares[part]) / limit[part]
        assert np.sqrt(np.mean(ratio**2)) < 1.05
        assert ratio.max() < 1.1  # 33 figures of 1000 runs scatter by 2 % each


def test_drift_between_the_dwells_is_in_the_standard_uncertainties() -> None:
    """A bias that walks: coefficients against the walk's mean over the positions."""
    unit = Coefficients.from_vectors(
        np.tile([1.0, 0, 0, 0, 0, 0, 0], (3, 1)), np.tile([1.0, 0, 0, 0], (3, 1))
    )
    rng = np.random.default_rng(11)
    bench = Shown(unit, gyro_density=1e-3, accel_density=1e-3, rng=rng)
    walk = 2e-4
    noise = [NoiseModel(white=1e-3, walk=walk)] * 3
    starts = np.arange(14) * 61.0
    exact = bench.scheme("8"), bench.all_turns()
    inside = []
    for _ in range(300):
        seconds = np.cumsum(rng.standard_normal((900, 3)) * walk, axis=0)
        drawn, turned = bench.drawn(*exact)
        turns = [
            replace(
                r,
                start_s=t,
                angle=r.angle + seconds[int(t) : int(t + r.duration_s)].mean(axis=0) * r.duration_s,
            )
            for r, t in zip(turned, starts, strict=False)
        ]
        drift = [seconds[int(t) : int(t) + 60].mean(axis=0) for t in starts[6:]]
        rests = [
            replace(p, start_s=t, gyro=p.gyro + d) for p, t, d in zip(drawn, starts[6:], drift, strict=True)
        ]
        found = calibrate(rests, turns, REFERENCE, gyro_noise=noise)
        assert found.quality is not None
        error = found.coefficients.vectors()[0]
        error[:, 0] -= 1.0
        error[:, 1] -= np.mean(drift, axis=0)
        inside.append(np.abs(error) <= 1.96 * found.quality.standard_uncertainty.vectors()[0])
    assert 0.93 <= np.mean(inside) <= 0.97
    assert np.mean(inside, axis=(0, 1)) == pytest.approx(np.full(7, 0.95), abs=0.035)


@pytest.mark.parametrize("scheme", ["6", "12"])
def test_drift_that_short_dwells_do_not_show_is_told_by_the_positions_scatter(scheme: str) -> None:
    """The bias instability of a MEMS unit, with dwells that show its white noise alone: two standard
    uncertainties hold 95 % of the truths, of what turns and what positions tell alike."""
    white, dwell_s, turn_s, runs = 3.5e-3, 20, 36, 200
    drifts = (NoiseCoefficients(bias_instability=6.0 / 3600.0),) * 3
    bench = Shown(random_unit(np.random.default_rng(1), counts=False), white, 1e-3)
    exact = bench.scheme(scheme, float(dwell_s)), bench.all_turns()
    truth = bench.unit.vectors()[0]
    turned_s = np.arange(6) * 110 + 60
    rested_s = 800 + np.arange(len(exact[0])) * 70
    inside, said = [], 0
    for run in range(runs):
        nodes = SlowDrift(drifts, np.random.SeedSequence((9, run))).nodes(0, 2500)
        moved = bench.unit.gyro.E1[:, np.newaxis] * nodes
        positions, turns = bench.drawn(*exact)
        drift = [moved[:, t : t + dwell_s].mean(axis=1) for t in rested_s]
        found = calibrate(
            [
                replace(p, start_s=float(t), gyro=p.gyro + d)
                for p, t, d in zip(positions, rested_s, drift, strict=True)
            ],
            [
                replace(
                    r, start_s=float(t), angle=r.angle + moved[:, t : t + turn_s].mean(axis=1) * r.duration_s
                )
                for r, t in zip(turns, turned_s, strict=True)
            ],
            REFERENCE,
            gyro_noise=[NoiseModel(white=white)] * 3,
        )
        assert found.quality is not None
        error = found.coefficients.vectors()[0] - truth
        error[:, 1] -= np.mean(drift, axis=0) / bench.unit.gyro.E1
        inside.append(np.abs(error) <= 2.0 * found.quality.standard_uncertainty.vectors()[0])
        said += any("gyros" in w.text() and "too short to show a drift" in w.text() for w in found.warnings)
    of_each = np.mean(inside, axis=(0, 1))
    assert np.all(of_each > 0.91)
    assert np.mean(of_each) == pytest.approx(0.95, abs=0.025)
    assert said > 0.8 * runs


def test_without_known_noise_the_scatter_of_the_positions_tells_it() -> None:
    unit = random_unit(np.random.default_rng(3), counts=False)
    bench = Shown(unit, gyro_density=3e-3, accel_density=1e-3)
    positions, turns = bench.drawn(bench.scheme("24"), bench.all_turns())
    known = calibrate(positions, turns, REFERENCE)
    blind = [replace(p, gyro_error=np.zeros(3), accel_error=np.zeros(3)) for p in positions]
    found = calibrate(blind, [replace(r, angle_error=np.zeros(3)) for r in turns], REFERENCE)
    assert found.quality is not None
    assert known.quality is not None
    for one, other in zip(
        found.quality.standard_uncertainty.vectors(),
        known.quality.standard_uncertainty.vectors(),
        strict=True,
    ):
        assert one == pytest.approx(other, rel=0.6)


def test_scatter_beyond_the_noise_widens_and_is_said() -> None:
    unit = random_unit(np.random.default_rng(3), counts=False)
    bench = Shown(unit, gyro_density=1e-3, accel_density=1e-4)
    rng = np.random.default_rng(4)
    leaning = [replace(p, accel=p.accel + 2e-3 * rng.standard_normal(3)) for p in bench.scheme("24")]
    found = calibrate(leaning, bench.all_turns(), REFERENCE)
    (warning,) = found.warnings
    assert "accelerometers scatter" in warning.text()
    assert found.quality is not None
    assert pytest.approx(np.full(3, 2e-3 / 24**0.5), rel=0.3) == found.quality.standard_uncertainty.accel.K0


def seat(*letters: str) -> list[PositionData]:
    bench = Shown(random_unit(np.random.default_rng(1)))
    return [bench.position(case_to_enu(p)) for p in letters]


@pytest.mark.parametrize(
    ("letters", "rank", "named"),
    [
        (("ENU", "NWU", "WSU", "SEU"), 1, "B0, K0, x, y, z"),
        (("NWU", "ENU", "UWS", "UEN"), 2, "B0, K0, x, y, z. Add"),
        (("NWU", "SWD", "UWS", "DWN"), 3, ": y. Add"),
        (("NWU",), 1, "B0, K0, x, y, z"),
    ],
)
def test_positions_that_lack_rank_are_refused_with_what_they_mix(
    letters: tuple[str, ...], rank: int, named: str
) -> None:
    turns = Shown(random_unit(np.random.default_rng(1))).all_turns()
    with pytest.raises(InputError, match=f"rank {rank} of 4") as refused:
        calibrate(seat(*letters), turns, REFERENCE)
    if rank > 1:
        assert named in str(refused.value)


def test_an_axis_without_turns_or_turned_one_way_is_named() -> None:
    bench = Shown(random_unit(np.random.default_rng(1)))
    turns = bench.all_turns()
    with pytest.raises(InputError, match="no turns about y"):
        calibrate(bench.scheme("6"), [t for t in turns if t.axis != 1], REFERENCE)
    with pytest.raises(InputError, match="About z the table turned in one sense only"):
        calibrate(bench.scheme("6"), turns[:5], REFERENCE)
    with pytest.raises(InputError, match="no turns about x"):
        calibrate(bench.scheme("6"), [], REFERENCE)


def test_a_dead_channel_is_named() -> None:
    bench = Shown(random_unit(np.random.default_rng(1)))
    dead = [replace(p, accel=p.accel * [1, 0, 1]) for p in bench.scheme("6")]
    with pytest.raises(InputError, match="Channel y does not follow its own axis"):
        calibrate(dead, bench.all_turns(), REFERENCE)


def test_few_and_ill_conditioned_positions_are_warned_of() -> None:
    bench = Shown(random_unit(np.random.default_rng(1)))
    found = calibrate(seat("UWS", "SUW", "NWU", "SWD"), bench.all_turns(), REFERENCE)
    assert "Four positions" in found.warnings[0].text()
    lean = Rotation.from_euler("xy", [3.0, 4.0], degrees=True).as_matrix()
    level = [
        bench.position(m) for p in ("ENU", "NWU", "SWD") for m in (case_to_enu(p), lean @ case_to_enu(p))
    ]
    found = calibrate(level, bench.all_turns(), REFERENCE)
    assert any("condition number" in w.text() for w in found.warnings)


def test_condition_numbers_do_not_depend_on_the_place() -> None:
    bench = Shown(random_unit(np.random.default_rng(1)))
    found: ImuCalibration = calibrate(bench.scheme("6"), bench.all_turns(), REFERENCE)
    assert found.quality is not None
    assert found.quality.gyro_condition == pytest.approx(3**0.5)
    assert found.quality.turns_condition == pytest.approx(1.0, abs=1e-3)
    assert np.linalg.matrix_rank(position_matrix([case_to_enu(p) for p in UP])) == 4
