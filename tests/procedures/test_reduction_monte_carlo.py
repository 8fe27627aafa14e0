"""The Monte Carlo check of a reduction: on every GUM uncertainty, the same whenever it is made, and said
where it is not passed."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.result import CalibrationResult, Uncertainty
from ahrs_lab.metrology.result_json import from_json, to_json
from ahrs_lab.metrology.rounding import format_grouped, round_to_place
from ahrs_lab.procedures.reduction import reduce_recording
from ahrs_lab.procedures.reduction_validation import not_validated
from ahrs_lab.recording.read import Recording, read_bundle
from tests.procedures.virtual_unit import VirtualUnit

TRIALS = 20_000


def uncertainties(result: CalibrationResult) -> dict[str, Uncertainty]:
    found = {f"K_{axis}": K.uncertainty for axis, K in result.scale_factor.items()}
    found |= {f"B_{axis}": B.uncertainty for axis, B in result.zero_offset.items()}
    found |= {f"L_{key}": L.uncertainty for key, L in result.misalignment.items()}
    for axis, K in result.scale_factor.items():
        assert K.F0_uncertainty is not None
        found[f"F0_{axis}"] = K.F0_uncertainty
    return found


@pytest.fixture(scope="module")
def sample(shared: Path) -> Recording:
    return read_bundle(shared / "samples" / "mems-unit-a")


def short() -> Recording:
    unit = VirtualUnit(density=2.5e-3, L={"yx": 1e-3})
    return unit.recording([*unit.rates("x"), *unit.turns("x"), *unit.positions("x", 60.0)])


def test_every_uncertainty_of_the_sample_is_checked_and_agrees(sample: Recording) -> None:
    found = uncertainties(reduce_recording(sample))
    assert len(found) == 15
    assert len({stated.monte_carlo.seed for stated in found.values() if stated.monte_carlo}) == 15
    for symbol, stated in found.items():
        check = stated.monte_carlo
        assert check is not None, symbol
        assert check.trials <= 500_000
        if not symbol.startswith("F0"):  # their noise has few degrees of freedom, and a t is broad
            assert check.validated, symbol
            assert check.standard == pytest.approx(stated.standard, rel=0.03)
        off = np.abs(np.array(check.symmetric).mean() - check.mean)
        assert off <= 2.0 * check.tolerance, symbol


def test_a_recording_has_one_result_whenever_it_is_evaluated(sample: Recording) -> None:
    first, second = (reduce_recording(sample, trials=TRIALS) for _ in range(2))
    assert first == second
    assert from_json(to_json(first)) == first


def test_trials_can_be_left_out_or_fixed_and_leave_the_budget_as_it_is() -> None:
    recording = short()
    without, some = (uncertainties(reduce_recording(recording, trials=trials)) for trials in (0, TRIALS))
    for symbol, stated in some.items():
        assert without[symbol].monte_carlo is None
        assert stated.monte_carlo is not None
        assert stated.monte_carlo.trials == TRIALS
        assert (stated.standard, stated.gum_expanded) == (without[symbol].standard, without[symbol].expanded)
        assert (stated.expanded > stated.gum_expanded) == stated.from_monte_carlo


def test_u_covers_the_trials_where_the_budget_is_too_short_and_the_warning_says_so() -> None:
    """Drift known to little more than one degree of freedom: its tails reach further than k tells."""
    result = reduce_recording(short())
    angle = result.misalignment["yx"]
    stated, check = angle.uncertainty, angle.uncertainty.monte_carlo
    assert check is not None
    assert (check.validated, stated.from_monte_carlo) == (False, True)
    assert stated.expanded == max(angle.L - check.symmetric[0], check.symmetric[1] - angle.L)
    assert stated.coverage_factor == pytest.approx(stated.expanded / stated.standard) != 1.96
    (said,) = [w.what.text() for w in result.warnings if w.what.text().startswith("L_yx: the 95 %")]
    millionths = round(1e6 * stated.gum_expanded)
    assert f"U was raised to {round(1e6 * stated.expanded)}, which covers the trials' interval" in said
    assert f"value −{millionths} to +{millionths}, is not" in said
    assert "(all in 10⁻⁶ rad;" in said


def test_annex_a_is_not_checked() -> None:
    result = reduce_recording(short(), uncertainty="annex-a", trials=TRIALS)
    for stated in uncertainties(result).values():
        assert (stated.monte_carlo is None) == (stated.method == "annex-a")


def test_too_many_trials_are_refused_before_anything_is_reduced() -> None:
    with pytest.raises(InputError, match="kept in memory"):
        reduce_recording(short(), trials=10**9)


def test_what_is_not_validated_is_said_with_both_intervals() -> None:
    """A coarse output that no noise dithers: one rectangle, whose 95 % is not 1.96 u."""
    unit = VirtualUnit(earth_dps=0.0)
    segments = []
    for recorded in unit.positions("x", 60.0):
        gyro = recorded.samples["gyro_x"].copy()
        gyro[::2] += 0.5
        gyro = np.round(gyro / 0.5) * 0.5
        gyro[7:] = gyro[6]
        columns = recorded.samples.with_columns({"gyro_x": gyro})
        segments.append(type(recorded)(recorded.segment, columns, (), recorded.lines, 0, 0.1))
    result = reduce_recording(unit.recording(segments))
    stated = result.zero_offset["x"].uncertainty
    assert stated.monte_carlo is not None
    assert not stated.monte_carlo.validated
    (said,) = [w.what for w in result.warnings if "Monte Carlo" in w.what.text()]
    low, high = stated.monte_carlo.symmetric
    B = result.zero_offset["x"].B
    assert said.text().startswith("B_x: the 95 % interval of the GUM budget")
    decimals = -math.floor(math.log10(3600.0 * stated.monte_carlo.tolerance))
    for number in (stated.expanded, -stated.expanded, low - B, high - B):
        shown = format_grouped(round_to_place(3600.0 * number, decimals))
        assert f"{'+' if number > 0 else ''}{shown} " in said.text().replace(",", " ")
        assert shown in said.text("zh")
    assert "(all in °/h;" in said.text()
    assert said.text().endswith("U stays the larger one of the GUM and holds more than 95 %.")
    assert not stated.from_monte_carlo


def test_an_interval_of_the_fitted_zero_is_not_warned_of() -> None:
    result = reduce_recording(short(), trials=TRIALS)
    found = result.scale_factor["x"]
    assert found.F0_uncertainty is not None
    check = found.F0_uncertainty.monte_carlo
    assert check is not None
    failed = replace(
        found,
        uncertainty=replace(found.uncertainty, monte_carlo=None),
        F0_uncertainty=replace(found.F0_uncertainty, monte_carlo=replace(check, validated=False)),
    )
    assert not not_validated({"x": failed}, {}, {})
