"""The uncertainty that the reduction states is the scatter that repetition shows (references.md, statistical
limits)."""

from __future__ import annotations

import math
from dataclasses import fields
from functools import partial

import numpy as np
import pytest
from scipy.stats import binom, chi2

from ahrs_lab.metrology.capability import UsedFigure, with_figures
from ahrs_lab.metrology.conditions import BenchCapability
from ahrs_lab.metrology.figures_json import noted_capability, with_capability
from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.metrology.stated_figures import StatedFigure
from ahrs_lab.procedures import reduction
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.read import RecordedSegment
from tests.procedures.virtual_unit import RATES, VirtualUnit, changed

reduce_recording = partial(reduction.reduce_recording, trials=0)
"""Without the Monte Carlo check, which has tests of its own."""

DENSITY = 2.5e-3
"""0.15 °/√h in °/√s."""
RUNS = 300

PERFECT_BENCH = BenchCapability(
    rate_relative=(0.0, 0.0, 0.0),
    **{  # type: ignore[arg-type]
        entry.name: 0.0
        for entry in fields(BenchCapability)
        if entry.name not in ("rate_relative", "certified", "acquisition_bits")
    },
)


@pytest.fixture(scope="module")
def ensemble() -> dict[str, list[tuple[float, Uncertainty]]]:
    """Error and stated uncertainty of K_x, F0_x, B_x, L_yx over many runs of one unit on a perfect bench."""
    unit = VirtualUnit(
        K=(1.001, 1, 1), B=(1e-3, 0, 0), L={"yx": 1e-3}, density=DENSITY, rng=np.random.default_rng(2015)
    )
    found: dict[str, list[tuple[float, Uncertainty]]] = {"K": [], "F0": [], "B": [], "L": []}
    for _ in range(RUNS):
        recording = unit.recording([*unit.rates("x"), *unit.turns("x"), *unit.positions("x", 60.0)])
        result = reduce_recording(recording, capability=PERFECT_BENCH)
        K, B, L = result.scale_factor["x"], result.zero_offset["x"], result.misalignment["yx"]
        assert K.F0_uncertainty is not None
        found["K"].append((K.K - 1.001, K.uncertainty))
        found["F0"].append((K.F0, K.F0_uncertainty))
        found["B"].append((B.B - 1e-3, B.uncertainty))
        found["L"].append((L.L - 1e-3, L.uncertainty))
    return found


SPREAD = sum(rate**2 for rate in RATES)
LIMITS = {
    "K": DENSITY / math.sqrt(36.0 * SPREAD),
    "F0": DENSITY * math.sqrt(1.0 / (36.0 * len(RATES)) + 1.0 / (2.0 * 20.0)),
    "B": DENSITY / (2.0 * math.sqrt(60.0)),
    # 38 s are recorded for 36 s of motion
    "L": DENSITY / math.sqrt(720.0 * 10 * 100.0) * math.sqrt(38.0 / 36.0),
}
"""Least squares cannot do better; T = 36 s at each rate, 20 s at rest, 60 s a position, 10 turns at 100
°/s."""


@pytest.mark.parametrize("quantity", LIMITS)
def test_the_scatter_reaches_the_statistical_limit(
    quantity: str, ensemble: dict[str, list[tuple[float, Uncertainty]]]
) -> None:
    errors = np.array([error for error, _ in ensemble[quantity]])
    low, high = np.sqrt(chi2.ppf([0.0005, 0.9995], RUNS) / RUNS)
    assert low < math.sqrt(float(np.mean(errors**2))) / LIMITS[quantity] < high


@pytest.mark.parametrize("quantity", LIMITS)
def test_the_stated_uncertainty_is_the_limit_on_average(
    quantity: str, ensemble: dict[str, list[tuple[float, Uncertainty]]]
) -> None:
    noise = [
        math.sqrt(sum(row.contribution**2 for row in stated.rows if row.symbol[0] in "FN"))
        for _, stated in ensemble[quantity]
    ]
    assert float(np.mean(np.square(noise))) == pytest.approx(LIMITS[quantity] ** 2, rel=0.05)


@pytest.mark.parametrize("quantity", LIMITS)
def test_the_expanded_uncertainty_covers_95_percent(
    quantity: str, ensemble: dict[str, list[tuple[float, Uncertainty]]]
) -> None:
    covered = sum(abs(error) <= stated.expanded for error, stated in ensemble[quantity])
    # at least 95 %, and no more than the terms that are estimated beside the noise may add
    assert binom.ppf(0.0005, RUNS, 0.95) <= covered <= binom.ppf(0.9995, RUNS, 0.99)


def test_a_drifting_bias_enters_K_by_what_the_drift_is() -> None:
    """Random walk of the rate: K scatters beyond the white noise, and the budget says so."""
    walk, errors, stated = 2e-3, [], []
    rng = np.random.default_rng(7)
    unit = VirtualUnit(density=DENSITY, rng=rng, earth_dps=0.0)
    for _ in range(120):
        segments = [*unit.rates("x"), *unit.positions("x", 300.0)]
        level = 0.0
        drifting = []
        for recorded in segments:
            steps = rng.normal(0.0, walk * math.sqrt(0.1), len(recorded.samples))
            path = level + np.cumsum(steps)
            level = float(path[-1])
            columns = recorded.samples.with_columns({"gyro_x": recorded.samples["gyro_x"] + path})
            drifting.append(type(recorded)(recorded.segment, columns, (), recorded.lines, 0, 0.1))
        result = reduce_recording(unit.recording(drifting), capability=PERFECT_BENCH).scale_factor["x"]
        errors.append(result.K - 1.0)
        stated.append(next(row.contribution for row in result.uncertainty.rows if row.symbol == "D"))
    white = LIMITS["K"] ** 2
    drift = float(np.mean(np.square(errors))) - white
    assert drift > 20.0 * white
    low, high = (float(120 / chi2.ppf(p, 120)) for p in (0.9995, 0.0005))
    assert low < float(np.mean(np.square(stated))) / drift < high


def test_annex_a_adds_the_positions_linearly() -> None:
    unit = VirtualUnit(density=DENSITY)
    recording = unit.recording([*unit.rates("x"), *unit.turns("x"), *unit.positions("x", 60.0)])
    gum = reduce_recording(recording, capability=PERFECT_BENCH)
    annex = reduce_recording(recording, uncertainty="annex-a", capability=PERFECT_BENCH)
    rows = [row.contribution for row in gum.zero_offset["x"].uncertainty.rows if row.symbol.startswith("N_")]
    assert annex.zero_offset["x"].uncertainty.rows[-1].contribution == pytest.approx(sum(rows))
    assert annex.zero_offset["x"].uncertainty.coverage_factor == 2.0
    assert annex.scale_factor["x"].K == gum.scale_factor["x"].K


def test_figures_of_a_certificate_are_told_from_assumptions() -> None:
    unit = VirtualUnit(density=DENSITY)
    stated = (
        StatedFigure("rate_relative_below_1", 2e-2, "1", 2.0),
        StatedFigure("rate_relative_1_to_10", 2e-3, "1", 2.0),
        StatedFigure("rate_relative_from_10", 2e-4, "1", 2.0),
    )
    capability = with_figures(
        BenchCapability(), tuple(UsedFigure(one, "Table s/n 1", "C-1", valid=True) for one in stated)
    )
    result = reduce_recording(unit.recording(unit.rates("x")), capability=capability).scale_factor["x"]
    origins = {row.symbol: row.origin for row in result.uncertainty.rows}
    assert origins["Ω"] == "certificate"
    assert origins["ε"] == "assumption"
    assert origins["F̄"] == "data"


STEP = 0.02
"""°/s, far above what a filtered output scatters by."""


def filtered(recorded: RecordedSegment) -> RecordedSegment:
    """An output that shows one code throughout."""
    columns = {
        f"gyro_{axis}": np.full(
            len(recorded.samples), np.round(recorded.samples[f"gyro_{axis}"].mean() / STEP) * STEP
        )
        for axis in "xyz"
    }
    return changed(recorded, **columns)


def test_codes_that_never_change_at_rest_are_uncertain_by_the_step_between_them() -> None:
    """The true B lies within half a step of what such an output shows; U has to say so."""
    unit = VirtualUnit(B=(0.4 * STEP, -0.7 * STEP, 1.3 * STEP), density=DENSITY)
    made = [filtered(one) for axis in AXES for one in [*unit.rates(axis), *unit.positions(axis)]]
    result = reduce_recording(unit.recording(made), capability=PERFECT_BENCH)
    for axis, true in zip(AXES, unit.B, strict=True):
        found = result.zero_offset[axis]
        assert abs(found.B - true) <= found.uncertainty.expanded
        assert found.uncertainty.expanded > 0.2 * STEP
    assert not any("its resolution is not known" in one.what.text() for one in result.warnings)


def test_an_output_without_any_step_is_named() -> None:
    unit = VirtualUnit(earth_dps=0.0)
    result = reduce_recording(unit.recording(unit.positions("x")), capability=PERFECT_BENCH)
    (said,) = [one.what for one in result.warnings if "its resolution is not known" in one.what.text()]
    assert said.text().startswith("output X")
    assert said.text("zh").startswith("输出 X")


def test_a_figure_without_a_certificates_number_is_an_assumption() -> None:
    """Neither a name in a list nor a figure called valid makes it certified."""
    stated = StatedFigure("rate_relative_from_10", 2e-4, "1", 2.0)
    named = BenchCapability(certified=("rate_relative",))
    numberless = with_figures(BenchCapability(), (UsedFigure(stated, "Table s/n 1", " ", valid=True),))
    for capability in (named, numberless):
        figure = capability.figure("rate_relative", 2)
        assert (figure.origin, figure.certificate) == ("assumption", "")
    unit = VirtualUnit(density=DENSITY)
    notes = with_capability({}, named)
    recording = unit.recording(unit.rates("x"))
    result = reduce_recording(recording, capability=noted_capability(notes)).scale_factor["x"]
    assert {row.origin for row in result.uncertainty.rows if row.symbol == "Ω"} == {"assumption"}
