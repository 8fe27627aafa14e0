"""The full models: the reported value without deviations, the budgets' sensitivities as their slopes, and the
real rotation and the real fit behind them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ahrs_lab.metrology.misalignment import misalignment
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.budget import combine, from_expanded, from_half_width, type_a
from ahrs_lab.metrology.uncertainty.fitted_scale import FittedScale
from ahrs_lab.metrology.uncertainty.full_misalignment import misalignment_model
from ahrs_lab.metrology.uncertainty.full_model import (
    LINEAR,
    FullModel,
    MonteCarloSettings,
    check_by_monte_carlo,
    linear_part,
    meaningful_digits,
)
from ahrs_lab.metrology.uncertainty.full_scale_factor import BandSums, offset_model, scale_factor_model
from ahrs_lab.metrology.uncertainty.full_zero_offset import rotated, zero_offset_model
from ahrs_lab.metrology.uncertainty.gum_misalignment import misalignment_uncertainty
from ahrs_lab.metrology.uncertainty.gum_zero_offset import ZeroOffsetEvidence, zero_offset_uncertainty
from ahrs_lab.metrology.uncertainty.monte_carlo import propagate
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from ahrs_lab.metrology.uncertainty.resolution import Resolution
from ahrs_lab.metrology.zero_offset import zero_offset
from tests.metrology.evidence import (
    BENCH,
    EARTH_DPS,
    KNOWN_TO_6_DOF,
    LATITUDE,
    RATES,
    E,
    N,
    RateSource,
    U,
    budgets,
    four_positions,
    rates_evidence,
    turns,
)

Array = NDArray[np.float64]
MEANS = 1.01 * RATES + 0.02 + 1e-3 * np.sin(7.0 * RATES)
"""Off a line by 1e-3 °/s."""
DRIFTING = NoiseModel(white=2.5e-3, white_dof=100.0, flicker=1e-3, covariance=KNOWN_TO_6_DOF)


def slopes(model: FullModel, step: float) -> list[tuple[str, float]]:
    """Central differences in each input."""
    size = len(model.inputs)
    drawn = np.concatenate([step * np.eye(size), -step * np.eye(size)], axis=1)
    with np.errstate(all="raise"):
        found = model.evaluate(drawn)
    return list(zip(model.symbols, ((found[:size] - found[size:]) / (2.0 * step)).tolist(), strict=True))


def assert_slopes_are_sensitivities(
    model: FullModel, budget: Uncertainty, value: float, step: float, but: str = ""
) -> None:
    """Of each symbol the squares add to those of its rows: components of one error are independent."""
    assert model.evaluate(np.zeros((len(model.inputs), 1)))[0] == pytest.approx(value, rel=1e-13, abs=1e-18)
    of_model: dict[str, float] = {}
    for symbol, slope in slopes(model, step):
        of_model[symbol] = of_model.get(symbol, 0.0) + slope**2
    for symbol in set(of_model) - {LINEAR, but}:
        rows = [row for row in budget.rows if row.symbol == symbol]
        expected = sum(row.sensitivity**2 for row in rows)
        assert math.sqrt(of_model[symbol]) == pytest.approx(math.sqrt(expected), rel=1e-6, abs=1e-12), symbol


def assert_everything_is_drawn(model: FullModel, budget: Uncertainty) -> None:
    """The rows of the linear part and the single inputs are together the budget's variance."""
    single = sum(row.contribution**2 for row in budget.rows if row.symbol in set(model.symbols) - {LINEAR})
    linear = [entry for entry, symbol in zip(model.inputs, model.symbols, strict=True) if symbol == LINEAR]
    scales = [
        getattr(entry, "standard", 0.0)
        or getattr(entry, "scale", 0.0)
        or getattr(entry, "half_width", 0.0) / math.sqrt(3.0)
        for entry in linear
    ]
    assert math.sqrt(single + sum(s**2 for s in scales)) == pytest.approx(budget.standard, rel=1e-12)


POSITIONS = {
    "E": four_positions(),
    "N": four_positions((N, -N, -N, N)),
    "U": four_positions((U, -U, U, -U)),
    "three on one mounting": replace(
        four_positions((E, N, -E, E)),
        turned_deg=np.array([0.0, 90.0, 180.0, 0.0]),
        mountings=("z+", "z+", "z+", "z-"),
    ),
}


@pytest.mark.parametrize("positions", POSITIONS)
def test_the_slopes_of_B_are_the_sensitivities_of_its_budget(positions: str) -> None:
    evidence = replace(
        POSITIONS[positions],
        scale=FittedScale(1e-3, 12.0),
        time_scaled=True,
        resolution=Resolution(1e-4),
        leans=1e-3,
    )
    budget = zero_offset_uncertainty(0.02, evidence, BENCH)
    model = zero_offset_model(0.02, evidence, budget)
    assert_slopes_are_sensitivities(model, budget, 0.02, 1e-4)
    assert {"α", "ψ", "τ", "w", "β", "γ", "φ", "t", "K"} == set(model.symbols) - {LINEAR}
    assert_everything_is_drawn(model, budget)


@pytest.mark.parametrize("rate_source", ["demanded", "table"])
def test_the_slopes_of_K_and_F0_are_the_sensitivities_of_their_budgets(rate_source: RateSource) -> None:
    fit = fit_scale_factor(RATES, MEANS, 0.001, 0.002)
    evidence = replace(rates_evidence(), noise=DRIFTING, resolution=Resolution(1e-3))
    budget, budget_F0 = budgets(fit, evidence, rate_source, time_scaled=True)
    K, F0 = scale_factor_model(fit, budget), offset_model(fit, budget_F0)
    # ε acts by its cosine, whose slope at 0 is 0; its row takes the secant
    assert_slopes_are_sensitivities(K, budget, fit.K, 1e-6, but="ε")
    assert_slopes_are_sensitivities(F0, budget_F0, fit.F0, 1e-6)
    assert_everything_is_drawn(K, budget)
    assert_everything_is_drawn(F0, budget_F0)


def test_the_slopes_of_L_are_the_sensitivities_of_its_budget() -> None:
    evidence = replace(
        turns(), scale=FittedScale(1e-3), rest_rate_dps=0.01, duration_negative_s=36.1, noise=DRIFTING
    )
    budget = misalignment_uncertainty(0.01, evidence, BENCH)
    model = misalignment_model(0.01, evidence, budget)
    assert_slopes_are_sensitivities(model, budget, 0.01, 1e-4)
    assert_everything_is_drawn(model, budget)


def test_the_slopes_of_the_noise_are_those_of_the_standards_equations() -> None:
    """(16), (17) and the fit themselves, by differences."""
    evidence = four_positions()
    N_i = 3.0 * np.eye(4)
    for index, row in enumerate(zero_offset_uncertainty(0.0, evidence, BENCH).rows[:4]):
        assert zero_offset(N_i[index], evidence.durations_s) / 3.0 == pytest.approx(
            row.sensitivity, rel=1e-12
        )
    rows = misalignment_uncertainty(0.0, turns(), BENCH).rows
    assert misalignment(1.0, 0.0, 10) == pytest.approx(rows[0].sensitivity, rel=1e-12)
    assert misalignment(0.0, 1.0, 10) == pytest.approx(rows[1].sensitivity, rel=1e-12)
    fit = fit_scale_factor(RATES, MEANS, 0.0, 0.0)
    for index, direction in enumerate(np.eye(len(RATES))):
        moved = fit_scale_factor(RATES, MEANS + direction, 0.0, 0.0)
        assert pytest.approx(fit.K_weights[index], rel=1e-9) == moved.K - fit.K
        assert pytest.approx(fit.F0_weights[index], rel=1e-9) == moved.F0 - fit.F0


def test_the_sums_over_bands_fit_the_line_that_all_rates_give() -> None:
    """With errors of percents, where a first-order sum is wrong by 1e-3."""
    sums = BandSums(fit_scale_factor(RATES, MEANS, 0.0, 0.0))
    errors = np.array([[0.05, 0.0], [-0.03, 0.0], [0.02, 0.0]])
    found = sums.fit(list(errors), 2)
    band = np.digitize(np.abs(RATES), [1.0, 10.0])
    for trial in range(2):
        expected = fit_scale_factor(RATES * (1.0 + errors[band, trial]), MEANS, 0.0, 0.0)
        assert found.K[trial] == pytest.approx(expected.K, rel=1e-13)
        assert found.F0[trial] == pytest.approx(expected.F0, rel=1e-10)
        assert found.spread[trial] == pytest.approx(expected.spread, rel=1e-13)


def test_K_is_distributed_as_lines_refitted_one_by_one() -> None:
    """Every mean and every band drawn by itself and fitted again, against the model's few draws."""
    bench = replace(BENCH, rate_relative=(0.05, 0.02, 5e-6))
    fit = fit_scale_factor(RATES, 1.01 * RATES, 0.0, 0.0)
    evidence = rates_evidence(2e-3)
    K = scale_factor_model(fit, budgets(fit, evidence, bench=bench)[0])
    found = propagate(K.inputs, K.evaluate, seed=1, trials=100_000)
    rng = np.random.default_rng(3)
    band = np.digitize(np.abs(RATES), [1.0, 10.0])
    refitted = []
    for _ in range(4000):
        errors = 0.5 * np.array(bench.rate_relative) * rng.normal(size=3)
        means = 1.01 * RATES + 2e-3 * rng.standard_t(19.0, len(RATES))
        refitted.append(fit_scale_factor(RATES * (1.0 + errors[band]), means, 0.0, 0.0).K)
    # each mean is a t of 19, whose deviation is √(19/17) of its scale; the pooled one is nearly normal
    assert np.std(refitted) == pytest.approx(found.standard, rel=0.08)
    assert np.mean(refitted) == pytest.approx(found.mean, abs=5.0 * found.standard / math.sqrt(4000.0))


def test_a_vector_is_rotated_as_scipy_rotates_it() -> None:
    rng = np.random.default_rng(1)
    by, vector = 1e-3 * rng.normal(size=(3, 50)), rng.normal(size=3)
    expected = Rotation.from_rotvec(by.T).apply(vector)
    found = np.array(rotated((vector[0], vector[1], vector[2]), (by[0], by[1], by[2]))).T
    assert found == pytest.approx(expected, abs=1e-8)
    assert np.linalg.norm(found, axis=1) == pytest.approx(float(np.linalg.norm(vector)), rel=1e-14)


def test_B_is_what_a_case_shows_that_is_rotated_by_hand() -> None:
    """All errors at once and large, against scipy's rotations of the case on the leaning, turned table."""
    evidence: ZeroOffsetEvidence = replace(four_positions(), noise=NoiseModel())
    budget = zero_offset_uncertainty(0.02, evidence, BENCH)
    model = zero_offset_model(0.02, evidence, budget)
    rng = np.random.default_rng(5)
    drawn = 2e-3 * rng.normal(size=(len(model.inputs), 1))
    value = dict[str, list[float]]()
    for symbol, deviate in zip(model.symbols, drawn[:, 0], strict=True):
        value.setdefault(symbol, []).append(float(deviate))
    latitude = math.radians(LATITUDE) + value["φ"][0]
    omega = EARTH_DPS * np.array([0.0, math.cos(latitude), math.sin(latitude)])
    table = Rotation.from_rotvec([*value["τ"], value["ψ"][0]])
    alpha = iter(value["α"])
    # by mounting: seat and face of its own on the platform that all stand on
    own = {"z+": slice(2), "z-": slice(2, 4)}
    felt = []
    for index, (direction, turned) in enumerate(zip(evidence.directions, evidence.turned_deg, strict=True)):
        mounting = evidence.mountings[index]
        tilt = np.sum([value["w"], value["β"][own[mounting]], value["γ"][own[mounting]]], axis=0)
        about_up = Rotation.from_euler("z", turned, degrees=True)
        seat = about_up * Rotation.from_rotvec([*tilt, 0.0]) * about_up.inv()
        stop = Rotation.from_euler("z", 0.0 if index < 2 else next(alpha))
        felt.append((table * stop * seat).apply(direction) @ omega)
    assert model.evaluate(drawn)[0] == pytest.approx(0.02 - float(np.mean(felt)), abs=1e-10)


def test_the_linear_part_draws_a_shared_estimate_once() -> None:
    source = four_positions()
    rows = zero_offset_uncertainty(0.0, source, BENCH).rows[:4]
    (noise,) = linear_part(rows)
    assert (noise.scale, noise.dof) == pytest.approx((2.5e-3 / (2.0 * math.sqrt(1800.0)), 100.0))  # type: ignore[attr-defined]


def test_digits_are_such_that_the_tolerance_is_a_few_percent_of_u() -> None:
    assert [meaningful_digits(u) for u in (1.0, 0.0294, 3.0e-5, 9.94, 9.96, 0.2999)] == [2, 2, 1, 1, 1, 2]


def linear_check(*rows: BudgetRow) -> Uncertainty:
    budget = combine(rows)
    model = FullModel(tuple(linear_part(budget.rows)), (), lambda x: np.asarray(x.sum(axis=0)))
    return check_by_monte_carlo(budget, 0.0, lambda: model, MonteCarloSettings("bundle"), "K_x")


def test_a_normal_budget_is_validated_and_one_broad_rectangle_is_not() -> None:
    message = zero_offset_uncertainty(0.0, four_positions(), BENCH).rows[0].source
    normal = from_expanded("a", message, "1", 2.0, 1.0, "certificate")
    rectangle = from_half_width("q", message, "1", 10.0, 1.0, "data")
    good, bad = linear_check(normal), linear_check(normal, rectangle)
    assert good.monte_carlo is not None
    assert bad.monte_carlo is not None
    assert (good.monte_carlo.validated, bad.monte_carlo.validated) == (True, False)
    # the first-order U is longer than the trials' interval and stays the reported one
    assert bad.expanded == bad.gum_expanded == combine([normal, rectangle]).expanded
    assert not bad.from_monte_carlo


def test_a_gum_interval_that_is_too_short_gives_way_to_the_trials() -> None:
    """Two t of 3 degrees of freedom and one of 1.5: Welch–Satterthwaite's k is too small for their sum."""
    message = zero_offset_uncertainty(0.0, four_positions(), BENCH).rows[0].source
    rows = [type_a(name, message, "1", 1.0, 1.0, dof) for name, dof in (("a", 3.0), ("b", 3.0), ("c", 1.5))]
    gum, found = combine(rows), linear_check(*rows)
    check = found.monte_carlo
    assert check is not None
    assert (check.validated, check.standard, found.from_monte_carlo) == (False, None, True)
    assert found.expanded == max(-check.symmetric[0], check.symmetric[1]) > gum.expanded
    assert (found.standard, found.dof) == (gum.standard, gum.dof)
    assert found.coverage_factor * found.standard == pytest.approx(found.expanded, rel=1e-12)
    assert found.gum_expanded == check.gum_expanded == gum.expanded


def test_a_seed_belongs_to_a_recording_and_a_quantity() -> None:
    settings = MonteCarloSettings("a" * 64)
    seeds = {settings.seed("K_x"), settings.seed("K_y"), MonteCarloSettings("b" * 64).seed("K_x")}
    assert len(seeds) == 3
    assert max(seeds) < 2**53
    assert settings.seed("K_x") == MonteCarloSettings("a" * 64, 20_000).seed("K_x")


def test_nothing_to_propagate_is_not_checked() -> None:
    message = zero_offset_uncertainty(0.0, four_positions(), BENCH).rows[0].source
    assert linear_check(type_a("a", message, "1", 0.0, 1.0, math.inf)).monte_carlo is None
