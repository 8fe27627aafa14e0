"""Sensitivities of the budgets against the analytic results of references.md and against rotated Earth
rates."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.messages import Message
from ahrs_lab.metrology.conditions import ARCSEC
from ahrs_lab.metrology.result import BudgetRow, Uncertainty
from ahrs_lab.metrology.scale_factor import fit_scale_factor
from ahrs_lab.metrology.uncertainty.bench_figure import BenchFigure, from_figure
from ahrs_lab.metrology.uncertainty.budget import combine
from ahrs_lab.metrology.uncertainty.fitted_scale import FittedScale
from ahrs_lab.metrology.uncertainty.gum_misalignment import misalignment_uncertainty
from ahrs_lab.metrology.uncertainty.gum_scale_factor import scale_factor_uncertainty
from ahrs_lab.metrology.uncertainty.gum_zero_offset import zero_offset_uncertainty
from ahrs_lab.metrology.uncertainty.noise import NoiseModel
from tests.metrology.evidence import (
    BENCH,
    EARTH_DPS,
    LATITUDE,
    RATES,
    E,
    N,
    U,
    four_positions,
    rates_evidence,
    scale_factor,
    turns,
)


def row(found: Uncertainty, symbol: str) -> BudgetRow:
    return next(entry for entry in found.rows if entry.symbol == symbol)


def test_an_azimuth_error_of_the_stops_leaves_the_horizontal_rate_over_root_eight() -> None:
    found = row(zero_offset_uncertainty(0.0, four_positions(), BENCH), "α")
    assert found.sensitivity == pytest.approx(EARTH_DPS * math.cos(math.radians(LATITUDE)) / math.sqrt(8.0))
    assert found.standard_uncertainty == pytest.approx(5.0 * ARCSEC)


def test_a_tilt_that_every_mounting_has_leaves_the_vertical_rate() -> None:
    """The platform's lean is common to the mountings; seat and face are each mounting's own."""
    found = zero_offset_uncertainty(0.0, four_positions(), BENCH)
    vertical = EARTH_DPS * math.sin(math.radians(LATITUDE))
    assert row(found, "w").sensitivity == pytest.approx(vertical)
    assert row(found, "β").sensitivity == pytest.approx(vertical / math.sqrt(2.0))
    assert row(found, "γ").sensitivity == pytest.approx(vertical / math.sqrt(2.0))


def test_a_lean_of_the_platform_counts_by_where_the_table_stood() -> None:
    """Had the other mounting's positions been turned to from the other side, the lean would cancel."""
    turned = np.array([0.0, 180.0, 180.0, 0.0])
    found = zero_offset_uncertainty(0.0, replace(four_positions(), turned_deg=turned), BENCH)
    assert row(found, "w").contribution == 0.0
    assert row(found, "β").contribution > 0.0


@pytest.mark.parametrize("directions", [(E, E, -E, -E), (N, -N, -N, N), (U, -U, U, -U)])
def test_reversal_cancels_north_plumb_and_latitude(directions: tuple[np.ndarray, ...]) -> None:
    found = zero_offset_uncertainty(0.0, four_positions(directions), BENCH)
    assert [row(found, symbol).contribution for symbol in "ψτφ"] == [0.0, 0.0, 0.0]


def test_the_noise_of_four_positions_is_half_the_density_over_root_T() -> None:
    found = zero_offset_uncertainty(0.0, four_positions(), replace(BENCH, level_arcsec=0.0))
    noise = [row(found, f"N_{i}") for i in range(1, 5)]
    assert math.sqrt(sum(entry.contribution**2 for entry in noise)) == pytest.approx(
        2.5e-3 / (2.0 * math.sqrt(1800.0))
    )
    assert {entry.sensitivity for entry in noise} == {1.0 / 7200.0}
    # four positions, but one estimate of the density: its degrees of freedom count once
    assert found.dof == pytest.approx(100.0, rel=0.05)


def test_counts_bring_the_uncertainty_of_their_scale_factor() -> None:
    found = zero_offset_uncertainty(0.02, replace(four_positions(), scale=FittedScale(1e-4)), BENCH)
    assert row(found, "K").contribution == pytest.approx(2e-6)


def test_a_fitted_scale_factor_hands_on_what_it_rests_on() -> None:
    """u(K) by the table's rate is an assumption or a certificate, and type B; by noise it is data."""
    by_rate, by_noise = FittedScale.of(1.01, scale_factor(1e-6)), FittedScale.of(1.01, scale_factor(2.0))
    assert (by_rate.kind, by_rate.origin, by_rate.certificate) == ("B", "assumption", "")
    assert (by_noise.kind, by_noise.origin) == ("A", "data")
    assert by_noise.dof == scale_factor(2.0).dof < 200.0
    figure = BenchFigure(2e-4, dof=8.0, distribution="t", origin="certificate", certificate="R-1")
    rows = [from_figure("Ω", Message("Time base"), "1", figure, 1.0)]
    certified = FittedScale.of(1.0, combine(rows))
    assert (certified.kind, certified.origin, certified.certificate) == ("B", "certificate", "R-1")
    handed_on = row(zero_offset_uncertainty(0.02, replace(four_positions(), scale=certified), BENCH), "K")
    assert (handed_on.dof, handed_on.kind, handed_on.certificate) == (8.0, "B", "R-1")
    assert handed_on.contribution == pytest.approx(2e-6)


def test_the_sensitivities_are_those_of_a_tilted_case() -> None:
    """Rotate the case by hand by a large-ish error that turns with the table and look at what B becomes."""
    evidence = four_positions()
    tilt = 1e-4
    omega = EARTH_DPS * np.array([0.0, math.cos(math.radians(LATITUDE)), math.sin(math.radians(LATITUDE))])
    felt = []
    for direction, turned in zip(evidence.directions, evidence.turned_deg, strict=True):
        # a seat tilted about the table's own "north" axis
        axis = np.array([-math.sin(math.radians(turned)), math.cos(math.radians(turned)), 0.0])
        felt.append((direction + tilt * np.cross(axis, direction)) @ omega)
    found = row(zero_offset_uncertainty(0.0, evidence, BENCH), "w")
    assert abs(float(np.mean(felt))) / tilt == pytest.approx(found.sensitivity, rel=1e-9)


def test_the_noise_of_K_is_that_of_the_regression() -> None:
    spread = float(((RATES - RATES.mean()) ** 2).sum())
    assert row(scale_factor(), "F̄").contribution == pytest.approx(1e-3 / math.sqrt(spread))


def test_a_rate_error_common_to_a_band_moves_K_as_refitting_does() -> None:
    rows = [entry for entry in scale_factor().rows if entry.symbol == "Ω"]
    bands = [np.abs(RATES) < 1, (np.abs(RATES) >= 1) & (np.abs(RATES) < 10), np.abs(RATES) >= 10]
    assert [entry.standard_uncertainty for entry in rows] == pytest.approx([1e-2, 1e-3, 1e-4])
    for entry, band in zip(rows, bands, strict=True):
        # the table turns faster than demanded by 1e-3 in this band: F grows, the Ω of the fit do not
        faster = np.where(band, 1.0 + 1e-3, 1.0)
        change = fit_scale_factor(RATES, 1.01 * RATES * faster, 0.0, 0.0).K - 1.01
        assert abs(entry.sensitivity) == pytest.approx(abs(change) / 1e-3, rel=1e-9)
    assert sum(entry.sensitivity for entry in rows) == pytest.approx(-1.01)


def test_measured_rates_replace_the_tables_rate_by_its_angle_and_time() -> None:
    found = scale_factor(rate_source="table")
    symbols = {entry.symbol for entry in found.rows}
    assert {"θ", "t"} <= symbols
    assert "Ω" not in symbols
    # two readings of 5″ standard uncertainty over 30 s at each rate
    spread = float(((RATES - RATES.mean()) ** 2).sum())
    each = math.sqrt(2.0) * 5.0 / 3600.0 / 30.0
    assert row(found, "θ").contribution == pytest.approx(1.01 * each / math.sqrt(spread))


def scatter_beyond(extra: np.ndarray, noise: NoiseModel | None = None) -> float:
    """u of the row v, where the means lie off the line by ``extra``."""
    evidence = replace(rates_evidence(1e-5), noise=noise or NoiseModel())
    fit = fit_scale_factor(RATES, RATES + extra, 0.0, 0.0)
    found, _ = scale_factor_uncertainty(fit, evidence, BENCH, device_unit="deg/s", rate_source="demanded")
    return row(found, "v").standard_uncertainty


def test_a_smooth_nonlinearity_is_no_scatter_of_K() -> None:
    """K is the slope through the response at the rates run: what bends is stated in ppm, not in U."""
    relative = RATES / 300.0
    assert scatter_beyond(0.01 * relative**3 - 0.02 * relative**2 + 0.005 * np.abs(relative)) == 0.0


def test_scatter_about_the_curve_is_found() -> None:
    rng = np.random.default_rng(8)
    squares = [scatter_beyond(rng.normal(0.0, 1e-3, len(RATES))) ** 2 for _ in range(400)]
    assert float(np.mean(squares)) == pytest.approx(1e-6, rel=0.2)


def test_noise_and_drift_are_not_counted_again_as_scatter() -> None:
    rng = np.random.default_rng(9)
    assert np.mean([scatter_beyond(rng.normal(0.0, 1e-5, len(RATES))) > 0.0 for _ in range(400)]) < 0.1
    walk = 1e-3
    steps = [np.cumsum(rng.normal(0.0, walk * math.sqrt(30.0), len(RATES))) for _ in range(400)]
    found = [scatter_beyond(path, NoiseModel(walk=walk)) > 0.0 for path in steps]
    # means of a walk, not its values at single times, are what the drift's formula is of
    assert np.mean(found) < 0.15


def test_a_leaning_case_feels_the_horizontal_rate_at_rest_but_not_at_the_rates() -> None:
    fit = fit_scale_factor(RATES, 1.01 * RATES, 0.0, 0.0)
    _, found = scale_factor_uncertainty(
        fit, rates_evidence(), BENCH, device_unit="deg/s", rate_source="demanded"
    )
    lean = 0.5 * math.sqrt(20.0**2 + 5.0**2 + 2.0**2) * ARCSEC
    horizontal = EARTH_DPS * math.cos(math.radians(LATITUDE))
    assert row(found, "β").contribution == pytest.approx(1.01 * lean * horizontal)


def test_the_cosine_of_a_lean_in_two_directions_has_its_root_mean_square() -> None:
    lean = 0.5 * math.sqrt(20.0**2 + 5.0**2 + 2.0**2) * ARCSEC
    drawn = np.random.default_rng(10).normal(0.0, lean, (2, 200_000))
    lost = 0.5 * (drawn**2).sum(axis=0)
    stated = row(scale_factor(), "ε").contribution
    assert stated == pytest.approx(1.01 * math.sqrt(float(np.mean(lost**2))), rel=0.02)


def test_the_noise_of_L_is_the_density_over_root_720_n_rate() -> None:
    found = misalignment_uncertainty(1e-3, turns(), BENCH)
    noise = math.hypot(row(found, "N⁺").contribution, row(found, "N⁻").contribution)
    assert noise == pytest.approx(2.5e-3 / math.sqrt(720.0 * 10 * 100.0))
    assert row(found, "N⁺").sensitivity == -row(found, "N⁻").sensitivity == 1.0 / 7200.0


def test_wobble_and_seat_enter_L_directly() -> None:
    found = misalignment_uncertainty(1e-3, turns(), BENCH)
    assert row(found, "w").contribution == pytest.approx(1.0 * ARCSEC)
    assert row(found, "β").contribution == pytest.approx(10.0 * ARCSEC)
    assert row(found, "γ").contribution == pytest.approx(2.5 * ARCSEC)


def test_pairs_of_turns_that_are_repeated_average_the_noise() -> None:
    once, twice = (
        misalignment_uncertainty(1e-3, replace(turns(), repeats=repeats), BENCH) for repeats in (1, 2)
    )
    assert row(twice, "N⁺").contribution == pytest.approx(row(once, "N⁺").contribution / math.sqrt(2.0))
