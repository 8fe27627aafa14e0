"""The resolution that recordings show, against outputs rounded to a known step."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.misalignment import misalignment
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.gum_misalignment import misalignment_uncertainty
from ahrs_lab.metrology.uncertainty.gum_zero_offset import zero_offset_uncertainty
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from ahrs_lab.metrology.uncertainty.resolution import Resolution, find_resolution, smallest_step
from ahrs_lab.metrology.zero_offset import zero_offset
from tests.metrology.evidence import RATES, RateSource, budgets, four_positions, rates_evidence, turns

Array = NDArray[np.float64]
STEP = 0.02


def rounded(values: Array, step: float = STEP) -> Array:
    return np.asarray(np.round(values / step) * step)


def test_the_step_is_the_smallest_difference_of_values() -> None:
    assert smallest_step(np.array([0.5, 0.25, 0.5, 1.0])) == 0.25
    assert smallest_step(np.full(9, 0.5)) == 0.0


def test_codes_of_recordings_that_never_change_give_the_step_together() -> None:
    rest = [np.full(200, code * STEP) for code in (1.0, 1.0, 2.0, 1.0, -1.0)]
    rates = [np.full(200, rate + STEP) for rate in (-100.0, 100.0)]
    found = find_resolution(rest, rates)
    assert found.step == pytest.approx(STEP)
    assert not found.dithered


def test_one_recording_at_rest_that_never_changes_is_enough_to_be_undithered() -> None:
    rng = np.random.default_rng(1)
    noisy = rounded(rng.normal(0.0, 2.0 * STEP, 5000))
    assert find_resolution([noisy, noisy], []).dithered
    found = find_resolution([noisy, np.zeros(5000)], [])
    assert found.step == pytest.approx(STEP)
    assert not found.dithered


def test_one_code_at_rest_takes_the_step_from_the_rates() -> None:
    rng = np.random.default_rng(2)
    found = find_resolution([np.zeros(100)] * 3, [rounded(100.0 + rng.normal(0.0, 0.1, 500))])
    assert found.step == pytest.approx(STEP, rel=1e-9)
    assert not found.dithered


def test_one_code_at_rest_takes_the_step_from_turns_about_the_other_axes() -> None:
    across = [np.full(100, code * STEP) for code in (3.0, -2.0, 1.0)]
    found = find_resolution([np.zeros(100)] * 4, [np.full(100, 100.0 + STEP)], across)
    assert found.step == pytest.approx(STEP)
    assert not found.dithered


def test_the_difference_between_rates_is_no_step() -> None:
    rates = [np.full(100, rate) for rate in (-300.0, -10.0, 10.0, 300.0)]
    assert find_resolution([np.zeros(100)] * 2, rates).step == 0.0


def test_rounding_of_floats_is_no_step() -> None:
    rng = np.random.default_rng(3)
    codes = rounded(rng.normal(0.0, 0.1, 4000))
    blurred = codes + 1e-16 * rng.normal(size=4000)
    found = find_resolution([blurred], [300.0 + codes + 1e-13 * rng.normal(size=4000)])
    assert found.step == pytest.approx(STEP, rel=1e-6)
    assert found.dithered


# ── in the budgets: outputs rounded by numpy, against the rows ───────────────────────────────────────────

PERFECT = BenchCapability(
    rate_relative=(0.0, 0.0, 0.0),
    **{  # type: ignore[arg-type]
        entry.name: 0.0
        for entry in fields(BenchCapability)
        if entry.name not in ("rate_relative", "certified", "acquisition_bits")
    },
)
RUNS = 4000


def rms(errors: list[float] | Array) -> float:
    return float(np.sqrt(np.mean(np.square(errors))))


def test_positions_that_show_one_code_do_not_average_its_error() -> None:
    rng = np.random.default_rng(4)
    errors = []
    for true in rng.uniform(-3.0 * STEP, 3.0 * STEP, RUNS):
        errors.append(zero_offset(1800.0 * rounded(np.full(4, true)), np.full(4, 1800.0)) - true)
    evidence = replace(four_positions(), noise=NoiseModel(), resolution=Resolution(STEP, dithered=False))
    found = zero_offset_uncertainty(0.0, evidence, PERFECT)
    assert found.standard == pytest.approx(rms(errors), rel=0.03)


def undithered_K_and_F0() -> tuple[Array, Array]:
    """Error and u of K and F₀ of outputs that show one code in each recording; shape (runs, 2) each."""
    rng = np.random.default_rng(5)
    errors, stated = [], []
    evidence = replace(rates_evidence(0.0), resolution=Resolution(STEP, dithered=False))
    for _ in range(1500):
        K, offset = rng.uniform(0.9, 1.1), rng.uniform(-STEP, STEP)
        rest = float(rounded(np.array([offset]))[0])
        fit = fit_scale_factor(RATES, rounded(K * RATES + offset), rest, rest)
        found = budgets(fit, evidence, bench=PERFECT)
        errors.append([fit.K - K, fit.F0])
        stated.append([one.standard for one in found])
    return np.array(errors), np.array(stated)


def test_undithered_K_counts_its_resolution_once_and_F0_that_of_the_rest_too() -> None:
    errors, stated = undithered_K_and_F0()
    for index in range(2):
        assert rms(stated[:, index]) == pytest.approx(rms(errors[:, index]), rel=0.06)


def test_dithered_F0_has_the_resolution_of_both_rests() -> None:
    """Readings of independent errors, uniform over a step."""
    rng = np.random.default_rng(6)
    count = len(RATES)
    evidence = replace(
        rates_evidence(0.0),
        samples=np.full(count, 50.0),
        rest_samples=(20.0, 80.0),
        resolution=Resolution(STEP),
    )
    errors = []
    for _ in range(RUNS):
        means = [rng.uniform(-0.5, 0.5, 50).mean() * STEP for _ in RATES]
        rests = [rng.uniform(-0.5, 0.5, n).mean() * STEP for n in (20, 80)]
        errors.append(fit_scale_factor(RATES, RATES + means, *rests).F0)
    _, found = budgets(fit_scale_factor(RATES, RATES, 0.0, 0.0), evidence, bench=PERFECT)
    (row,) = [one for one in found.rows if one.symbol == "q"]
    assert row.contribution == pytest.approx(rms(errors), rel=0.04)


def test_an_angle_is_read_at_both_ends_of_each_recording() -> None:
    """Accumulated angles rounded to the step, recordings that begin anywhere."""
    rng = np.random.default_rng(7)
    resolution = Resolution(STEP, of_angle=True)

    def turned(by: Array) -> Array:
        start = rng.uniform(0.0, 1.0, by.shape)
        return rounded(start + by) - rounded(start)

    T = np.full(4, 60.0)
    B_errors = [zero_offset(turned(true * T), T) - true for true in rng.uniform(-1.0, 1.0, RUNS)]
    evidence = replace(four_positions(), durations_s=T, noise=NoiseModel(), resolution=resolution)
    found = zero_offset_uncertainty(0.0, evidence, PERFECT)
    assert found.standard == pytest.approx(rms(B_errors), rel=0.04)
    (row,) = [one for one in found.rows if one.symbol == "q"]
    assert row.unit == "deg"

    L_errors = []
    for angles in rng.uniform(-5.0, 5.0, (RUNS, 2)):
        positive, negative = turned(angles)
        L_errors.append(misalignment(positive, negative, 10) - misalignment(angles[0], angles[1], 10))
    in_turns = replace(turns(), noise=NoiseModel(), resolution=resolution)
    assert misalignment_uncertainty(0.0, in_turns, PERFECT).standard == pytest.approx(rms(L_errors), rel=0.04)

    rates = replace(rates_evidence(0.0), resolution=resolution)
    K_errors = []
    for true in rng.uniform(0.9, 1.1, RUNS):
        means = turned(true * RATES * rates.durations_s) / rates.durations_s
        K_errors.append(fit_scale_factor(RATES, means, 0.0, 0.0).K - true)
    K, _ = budgets(fit_scale_factor(RATES, RATES, 0.0, 0.0), rates, bench=PERFECT)
    assert K.standard == pytest.approx(rms(K_errors), rel=0.04)


def test_one_clock_on_both_sides_cancels_in_K() -> None:
    """Increments over the device's time against the table's angle over the same time."""
    durations = np.full(len(RATES), 30.0)
    wrong = durations * (1.0 + 1e-4)
    angle = RATES * durations
    assert pytest.approx(1.0, rel=1e-14) == fit_scale_factor(angle / wrong, angle / wrong, 0.0, 0.0).K
    assert pytest.approx(1.0 - 1e-4, abs=1e-7) == fit_scale_factor(RATES, angle / wrong, 0.0, 0.0).K
    fit = fit_scale_factor(RATES, RATES, 0.0, 0.0)
    sources: tuple[RateSource, ...] = ("demanded", "table")
    timed = {
        (source, scaled): "t"
        in {row.symbol for row in budgets(fit, rates_evidence(), source, scaled)[0].rows}
        for source in sources
        for scaled in (False, True)
    }
    assert timed == {
        ("demanded", False): False,
        ("demanded", True): True,
        ("table", False): True,
        ("table", True): False,
    }
