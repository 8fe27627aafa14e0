"""The diagnosis against published tables, deletion by hand, and its own promise of false alarms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import binom, chi2

from ahrs_lab.metrology.diagnosis.allan import (
    confidence_limits,
    diagnose_allan,
    equivalent_dof,
    floor_verdict,
    pooled_overlapping,
    running_sum,
)
from ahrs_lab.metrology.diagnosis.model import Harmonic, ScaleFactorDiagnosis
from ahrs_lab.metrology.diagnosis.scale_factor import diagnose_scale_factor
from ahrs_lab.metrology.diagnosis.statistics import f_tail, outlier_limit, studentised, trend, two_sided
from ahrs_lab.metrology.diagnosis.words import figures
from ahrs_lab.metrology.diagnosis.zero_offset import (
    PositionEvidence,
    diagnose_harmonic,
    diagnose_positions,
    harmonic_findings,
    position_findings,
)
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.gum_scale_factor import ScaleFactorEvidence
from ahrs_lab.metrology.uncertainty.noise import NoiseModel, standard_error
from ahrs_lab.metrology.uncertainty.resolution import Resolution
from ahrs_lab.metrology.zero_offset import EARTH_RATE_DPS

Array = NDArray[np.float64]
TRIALS = 2000
RATES = np.array([10.0, -10.0, 50.0, -50.0, 100.0, -100.0, 200.0, -200.0, 300.0, -300.0])


def is_one_percent(alarms: int, trials: int = TRIALS) -> bool:
    return bool(binom.ppf(5e-4, trials, 0.01) <= alarms <= binom.ppf(1.0 - 5e-4, trials, 0.01))


# ── tables ───────────────────────────────────────────────────────────────────────────────────────────────


@pytest.mark.parametrize(
    ("count", "published"),
    [(4, 1.496), (5, 1.764), (6, 1.973), (8, 2.274), (10, 2.482), (12, 2.636), (15, 2.806), (20, 3.001)],
)
def test_the_limit_for_a_mean_is_grubbs_of_iso_5725(count: int, published: float) -> None:
    """ISO 5725-2, table 5, 1 %."""
    t = outlier_limit(count, count - 2, 0.01)
    grubbs = (count - 1.0) / math.sqrt(count) * math.sqrt(t**2 / (count - 2.0 + t**2))
    assert grubbs == pytest.approx(published, abs=1.1e-3)


def test_f_and_t_are_those_of_the_tables() -> None:
    assert f_tail(5.636, 5, 10) == pytest.approx(0.01, rel=1e-3)
    assert f_tail(3.478, 4, 10) == pytest.approx(0.05, rel=1e-3)
    assert f_tail(2.407, 9, math.inf) == pytest.approx(0.01, rel=2e-3)
    assert two_sided(2.228, 10) == pytest.approx(0.05, rel=1e-3)
    assert two_sided(1.95996, math.inf) == pytest.approx(0.05, rel=1e-4)


def test_a_studentised_residual_is_the_misfit_of_a_point_that_was_left_out() -> None:
    rng = np.random.default_rng(1)
    design = np.column_stack([np.ones(9), rng.normal(size=9)])
    values, spread = rng.normal(size=9), rng.uniform(0.5, 2.0, 9)
    found, dof = studentised(design, values, spread)
    assert dof == 6
    for place in range(9):
        kept = np.arange(9) != place
        A, y = (design / spread[:, None])[kept], (values / spread)[kept]
        best, square = np.linalg.lstsq(A, y, rcond=None)[:2]
        row = design[place] / spread[place]
        variance = float(square[0]) / 6.0 * (1.0 + row @ np.linalg.inv(A.T @ A) @ row)
        misfit = values[place] / spread[place] - row @ best
        assert found[place] == pytest.approx(misfit / math.sqrt(variance), rel=1e-9)


def test_the_trend_is_the_coefficient_of_the_fit_with_time_in_it() -> None:
    rng = np.random.default_rng(2)
    design = np.column_stack([np.ones(10), RATES])
    values, times = rng.normal(size=10), np.arange(10.0)
    whole = np.column_stack([design, times])
    best = np.linalg.lstsq(whole, values, rcond=None)[0]
    left = values - whole @ best
    standard = math.sqrt(left @ left / 7.0 * np.linalg.inv(whole.T @ whole)[2, 2])
    found = trend(design, values, times)
    assert found is not None
    assert (found.value, found.standard) == pytest.approx((best[2], standard))


# ── K ────────────────────────────────────────────────────────────────────────────────────────────────────


def scale_factor(
    rng: np.random.Generator,
    *,
    sigma: float = 1e-3,
    off: Array | float = 0.0,
    drift: float = 0.0,
    scatter_share: float = 0.0,
) -> ScaleFactorDiagnosis:
    """Ten rates of twenty one-second means, rests of sixty; ``off`` is added to the means of the rates."""
    recordings = rng.normal(0.0, sigma, (10, 20))
    rests = rng.normal(0.0, sigma, (2, 60))
    means = RATES * 1.001 + recordings.mean(axis=1) + off
    statics = (float(rests[0].mean()), float(rests[1].mean()) + drift)
    errors = [standard_error(one) for one in recordings]
    rest_errors = [standard_error(one) for one in rests]
    fit = fit_scale_factor(RATES, means, *statics)
    evidence = ScaleFactorEvidence(
        standard_errors=np.array([error for error, _ in errors]),
        dofs=np.array([dof for _, dof in errors]),
        durations_s=np.full(10, 20.0),
        starts_s=100.0 + 30.0 * np.arange(10.0),
        rest_standard_errors=(rest_errors[0][0], rest_errors[1][0]),
        rest_dofs=(rest_errors[0][1], rest_errors[1][1]),
        rest_durations_s=(60.0, 60.0),
        rest_starts_s=(0.0, 500.0),
        rest_samples=(6000.0, 6000.0),
        samples=np.full(10, 2000.0),
        resolution=Resolution(1e-5),
        noise=NoiseModel(white=sigma),
        latitude_deg=40.0,
    )
    return diagnose_scale_factor(
        fit,
        evidence,
        segments=tuple(f"sf_x_{place}" for place in range(10)),
        statics=statics,
        unit="deg/s",
        scatter_share=scatter_share,
    )


def test_a_unit_with_nothing_but_noise_alarms_once_in_a_hundred() -> None:
    rng = np.random.default_rng(2015)
    found = [scale_factor(rng) for _ in range(TRIALS)]
    assert is_one_percent(sum(bool(one.residuals.outliers) for one in found))
    assert is_one_percent(sum(one.trend is not None and one.trend.p < 0.01 for one in found))
    assert is_one_percent(sum(one.lack_of_fit is not None and one.lack_of_fit.p < 0.01 for one in found))
    assert is_one_percent(sum(one.drift is not None and one.drift.p < 0.01 for one in found))


def test_an_outlier_is_named_and_stays_in_the_fit() -> None:
    off = np.zeros(10)
    off[6] = 0.02
    found = scale_factor(np.random.default_rng(3), off=off)
    assert found.residuals.outliers == (6,)
    finding = next(one for one in found.findings if one.segment)
    assert (finding.state, finding.segment) == ("warn", "sf_x_6")
    assert "At 200 °/s" in finding.what.text()
    # the line is drawn toward it: 0.02·(1 − h) is what is left, h = 1/10 + Ω²/S
    left = 0.02 * (0.9 - 200.0**2 / float(RATES @ RATES))
    assert found.residuals.residuals[6] == pytest.approx(left, abs=1e-3)


def test_a_bent_line_and_a_drift_are_told() -> None:
    bent = scale_factor(np.random.default_rng(4), off=2e-10 * RATES**3)
    assert bent.lack_of_fit is not None
    assert bent.lack_of_fit.p < 1e-6
    assert [one.state for one in bent.findings if "not quite linear" in one.what.text()] == ["look"]
    drifting = scale_factor(np.random.default_rng(5), drift=2e-3)
    assert drifting.drift is not None
    assert drifting.drift.value == pytest.approx(2e-3, abs=4e-4)
    assert any(one.state == "warn" and "°/h" in one.what.text() for one in drifting.findings)


def test_a_zero_that_creeps_is_a_trend() -> None:
    found = scale_factor(np.random.default_rng(6), off=1e-4 * 30.0 * np.arange(10.0))
    assert found.trend is not None
    assert found.trend.value == pytest.approx(1e-4, rel=0.05)
    assert found.order == tuple(range(1, 11))


def test_without_noise_nothing_is_found() -> None:
    found = scale_factor(np.random.default_rng(7), sigma=0.0)
    assert found.lack_of_fit is None
    assert {one.state for one in found.findings} == {"fine"}


# ── B ────────────────────────────────────────────────────────────────────────────────────────────────────


def positions(rng: np.random.Generator, off: float = 0.0) -> PositionEvidence:
    rates = 3e-3 + rng.normal(0.0, 1e-5, 12)
    rates[4] += off
    return PositionEvidence(
        rates, np.zeros(12), np.full(12, 1e-5), np.arange(12.0), np.full(12, 600.0),
        tuple(f"zo_x_{n}" for n in range(12)),
    )  # fmt: skip


def test_positions_alarm_once_in_a_hundred_and_name_the_one_that_was_moved() -> None:
    rng = np.random.default_rng(8)
    assert is_one_percent(sum(bool(diagnose_positions(positions(rng)).outliers) for _ in range(TRIALS)))
    assert diagnose_positions(positions(rng, 2e-4)).outliers == (4,)


def test_positions_that_scatter_beyond_their_noise_are_said_so_once_in_a_hundred_by_chance() -> None:
    rng = np.random.default_rng(722)

    def state(turn_on_dps: float) -> str:
        found = positions(rng)
        moved = replace(found, rates_dps=found.rates_dps + rng.normal(0.0, turn_on_dps, 12))
        return position_findings(diagnose_positions(moved))[-1].state

    assert is_one_percent(sum(state(0.0) == "look" for _ in range(TRIALS)))
    assert state(5e-5) == "look"


AZIMUTHS = np.arange(0.0, 360.0, 30.0)


def harmonic(rng: np.random.Generator, latitude_deg: float = 39.9, north_deg: float = 0.0) -> Harmonic:
    """Twelve azimuths of an axis that points north at 0, at latitude 39.9°."""
    true = EARTH_RATE_DPS * math.cos(math.radians(39.9))
    rates = 1e-3 + true * np.cos(np.radians(-AZIMUTHS - north_deg)) + rng.normal(0.0, 2e-5, 12)
    found = diagnose_harmonic(
        AZIMUTHS, -AZIMUTHS, rates, latitude_deg=latitude_deg, gain=1.0, noise_dps=2e-5,
        latitude_standard_deg=5e-4, azimuth_standard_deg=0.0,
    )  # fmt: skip
    assert found is not None
    return found


def test_the_earths_rate_is_found_with_the_uncertainty_it_has() -> None:
    rng = np.random.default_rng(9)
    found = [harmonic(rng) for _ in range(TRIALS)]
    assert is_one_percent(sum(one.amplitude.p < 0.01 for one in found))
    assert is_one_percent(sum(one.phase.p < 0.01 for one in found))
    errors = np.array([one.amplitude.value for one in found])
    assert float(np.std(errors)) == pytest.approx(2e-5 * math.sqrt(2.0 / 12.0), rel=0.06)


def test_a_wrong_latitude_and_a_wrong_north_are_told_apart() -> None:
    wrong_place = harmonic_findings(harmonic(np.random.default_rng(10), latitude_deg=30.0))
    assert [one.state for one in wrong_place] == ["warn", "fine"]
    wrong_north = harmonic(np.random.default_rng(11), north_deg=3.0)
    assert wrong_north.phase.value == pytest.approx(3.0, abs=0.6)
    assert [one.state for one in harmonic_findings(wrong_north)] == ["fine", "warn"]


# ── Allan deviation ──────────────────────────────────────────────────────────────────────────────────────


def thousand_points() -> Array:
    state, values = 1234567890, []
    for _ in range(1000):
        values.append(state / 2147483647)
        state = 16807 * state % 2147483647
    return np.array(values)


def test_the_overlapping_deviation_is_that_of_nist_sp_1065() -> None:
    ten = running_sum(np.array([892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0]))
    assert [math.sqrt(pooled_overlapping([ten], m)) for m in (1, 2)] == pytest.approx(
        [91.22945, 85.95287], rel=1e-7
    )
    thousand = running_sum(thousand_points())
    found = [math.sqrt(pooled_overlapping([thousand], m)) for m in (1, 10, 100)]
    assert found == pytest.approx([0.2922319, 0.09159953, 0.03241343], rel=2e-7)


def test_recordings_are_pooled_by_what_each_contributes() -> None:
    ten = running_sum(np.array([892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0]))
    assert math.sqrt(pooled_overlapping([ten, ten + 7.0, ten[:2]], 2)) == pytest.approx(85.95287, rel=1e-7)
    assert pooled_overlapping([ten], 5) == 0.0


@pytest.mark.parametrize("factor", [1, 8, 64])
def test_the_limits_hold_95_percent_of_white_noise(factor: int) -> None:
    rng = np.random.default_rng(12)
    dof = equivalent_dof(512, factor, "white")
    inside = 0
    for _ in range(TRIALS):
        low, high = confidence_limits(pooled_overlapping([running_sum(rng.normal(size=512))], factor), dof)
        inside += low < 1.0 / math.sqrt(factor) < high
    # χ² with these degrees of freedom is an approximation: within 1.5 %
    assert 0.935 < inside / TRIALS < 0.965
    assert confidence_limits(1.0, 10.0)[0] == pytest.approx(math.sqrt(10.0 / chi2.ppf(0.975, 10)))


def test_T_is_told_from_the_floor() -> None:
    assert floor_verdict(NoiseModel(white=1e-3, flicker=1e-6), 1800.0) == "before"
    assert floor_verdict(NoiseModel(white=1e-3, flicker=1e-3), 1800.0) == "past"
    assert floor_verdict(NoiseModel(white=1e-3, flicker=1e-3 / math.sqrt(1800 * 0.4413)), 1800.0) == "at"
    assert floor_verdict(NoiseModel(white=1e-3, walk=1e-3), 1800.0) == "past"
    assert floor_verdict(NoiseModel(white=1e-3, flicker=1e-3), 60.0) == "short"


def test_the_octaves_end_where_two_averages_no_longer_fit() -> None:
    rng = np.random.default_rng(13)
    found = diagnose_allan([rng.normal(0.0, 1e-3, 1800) for _ in range(4)], 1.0, NoiseModel(1e-3), 1800.0)
    assert found is not None
    assert found.taus_s[-1] == 512.0
    assert found.model_taus_s[-1] == 1800.0
    inside = [
        low < 1e-3 / math.sqrt(tau) < high
        for tau, low, high in zip(found.taus_s, found.low_dps, found.high_dps, strict=True)
    ]
    assert sum(inside) >= 9
    assert diagnose_allan([np.zeros(100)], 1.0, NoiseModel(), 100.0) is None


def test_numbers_in_sentences_have_no_exponent() -> None:
    assert [figures(v) for v in (0.00213, -12.3, 123456.0, 0.0)] == ["0.0021", "−12", "123456", "0"]
    assert figures(3.14159, 4, plus=True) == "+3.142"
