"""Figures of the standards' certificates: what is one, and what the bench's capability makes of them."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import date
from typing import Any

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.capability import StatedCapability, capability_of, figure_conflicts
from ahrs_lab.metrology.conditions import BenchCapability, Standard, StandardKind, clause6_violations
from ahrs_lab.metrology.figures_json import (
    capability_from_json,
    capability_to_json,
    figures_from_text,
    figures_text,
    noted_capability,
    with_capability,
)
from ahrs_lab.metrology.stated_figures import FIGURES, StatedFigure, figures_of_kind
from ahrs_lab.metrology.uncertainty.bench_figure import BenchFigure, from_figure, root_sum
from ahrs_lab.metrology.uncertainty.budget import combine

DAY = date(2026, 3, 1)
POSITION = StatedFigure("position_arcsec", 3.0, "arcsec", 2.26, dof=9.0)
FAST = StatedFigure("rate_relative_from_10", 1e-4, "1", 2.0)
SQUARE = StatedFigure("fixture_perpendicularity_arcsec", 5.0, "arcsec", distribution="rectangular")


def standard(
    kind: StandardKind, *figures: StatedFigure, number: str = "C-1", due: date | None = DAY
) -> Standard:
    return Standard(kind, kind, kind, "maker", "M", "7", "U", "U", number, due, figures=figures)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"value": math.nan}, "has no uncertainty"),
        ({"value": math.inf}, "has no uncertainty"),
        ({"value": 0.0}, "has no uncertainty"),
        ({"value": -1.0}, "has no uncertainty"),
        ({"coverage_factor": None}, "has no coverage factor"),
        ({"coverage_factor": 0.0}, "has no coverage factor"),
        ({"coverage_factor": -2.0}, "has no coverage factor"),
        ({"coverage_factor": math.nan}, "has no coverage factor"),
        ({"dof": 0.5}, "less than one degree of freedom"),
        ({"dof": math.nan}, "less than one degree of freedom"),
        ({"unit": "kg"}, "cannot be in “kg”"),
        ({"figure": "speed"}, "is no figure of the bench"),
        ({"distribution": "round"}, "no distribution that is known"),
        ({"distribution": "rectangular"}, "neither k nor degrees of freedom"),
    ],
)
def test_what_states_nothing_is_refused_in_both_languages(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as refused:
        replace(POSITION, **changes)
    assert said in str(refused.value)
    assert refused.value.message.text("zh") != str(refused.value)


@pytest.mark.parametrize(
    ("stated", "standard_uncertainty"),
    [
        (StatedFigure("wobble_arcsec", 1.0, "arcmin", 2.0), 30.0),
        (StatedFigure("wobble_arcsec", 10.0, "urad", 2.0), math.degrees(5e-6) * 3600.0),
        (StatedFigure("latitude_deg", 3.6, "arcsec", 2.0), 5e-4),
        (StatedFigure("timing_relative", 2.0, "ppm", 2.0), 1e-6),
        (StatedFigure("rate_relative_from_10", 0.02, "%", 2.0), 1e-4),
        (SQUARE, 5.0 / math.sqrt(3.0)),
        (replace(SQUARE, distribution="arcsine"), 5.0 / math.sqrt(2.0)),
    ],
)
def test_units_and_distributions(stated: StatedFigure, standard_uncertainty: float) -> None:
    kind: StandardKind = "other"
    capability = capability_of([standard(kind, stated)])
    assert isinstance(capability, StatedCapability)
    assert capability.stated[0].bench.standard == pytest.approx(standard_uncertainty, rel=1e-12)


def test_a_row_shows_the_certificates_own_k_dof_and_number() -> None:
    capability = capability_of([standard("table", POSITION, number="GFJGJL-7")], DAY)
    row = from_figure("α", Message("x"), "arcsec", capability.figure("position_arcsec"), -2.0)
    assert (row.half_width, row.divisor, row.dof, row.distribution) == (3.0, 2.26, 9.0, "t")
    assert row.standard_uncertainty == pytest.approx(3.0 / 2.26)
    assert row.contribution == pytest.approx(6.0 / 2.26)
    assert (row.origin, row.certificate) == ("certificate", "GFJGJL-7")
    # U of the one row is then k·u with the k of 9 degrees of freedom: what the certificate states.
    assert combine([row]).expanded == pytest.approx(6.0, rel=2e-3)


def test_what_no_certificate_states_stays_an_assumption() -> None:
    capability = capability_of([standard("table", POSITION, FAST)], DAY)
    assert capability.figure("wobble_arcsec") == BenchFigure(2.0)
    origins = [capability.origin("rate_relative", band) for band in range(3)]
    assert origins == ["assumption", "assumption", "certificate"]
    assert capability.rate_relative == (2e-2, 2e-3, 1e-4)
    assert capability.position_arcsec == pytest.approx(2.0 * 3.0 / 2.26)
    assert capability_of([standard("table")], DAY) == BenchCapability()


@pytest.mark.parametrize(
    ("number", "due"), [("", DAY), (" ", DAY), ("C-1", None), ("C-1", date(2026, 2, 28))]
)
def test_a_certificate_that_is_none_makes_no_budget_better(number: str, due: date | None) -> None:
    better = standard("table", POSITION, number=number, due=due)
    assert capability_of([better], DAY) == BenchCapability()
    worse = replace(better, figures=(replace(POSITION, value=30.0, coverage_factor=2.0),))
    figure = capability_of([worse], DAY).figure("position_arcsec")
    assert (figure.double, figure.origin, figure.certificate) == (30.0, "assumption", "")


def test_a_figure_stated_twice_is_refused_with_both_names() -> None:
    first, second = standard("table", POSITION), replace(standard("other", POSITION), serial_number="8")
    with pytest.raises(
        InputError, match=r"table s/n 7 and other s/n 8 both state the figure “table position”"
    ):
        capability_of([first, second])
    with pytest.raises(InputError, match="twice"):
        capability_of([standard("table", FAST, FAST)])


def test_a_supply_cannot_state_a_position() -> None:
    (found,) = figure_conflicts([standard("supply", POSITION)])
    assert "cannot state the figure “table position”" in found.text()
    assert figures_of_kind("supply") == ("supply_relative", "supply_ripple_mv")
    assert set(figures_of_kind("other")) == set(FIGURES)


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        (StatedFigure("rate_relative_from_10", 3e-4, "1", 2.0), "3.0e-04"),
        (StatedFigure("position_arcsec", 18.0, "arcsec", 3.0), "12.0″"),
        (replace(SQUARE, value=6.0), "6.0″"),
        (FAST, ""),
        (SQUARE, ""),
        (StatedFigure("position_arcsec", 15.0, "arcsec", 3.0), ""),
    ],
)
def test_clause_6_looks_at_the_stated_figures(stated: StatedFigure, said: str) -> None:
    used = [standard("table"), standard("supply"), standard("fixture"), standard("other", stated)]
    found = clause6_violations(used, on_date=DAY, capability=capability_of(used, DAY))
    assert [said in message.text() for message in found] == ([True] if said else [])


def test_figures_in_quadrature_are_as_certain_as_the_least_known() -> None:
    known = BenchFigure(3.0, 3.0, "t", 4.0, "certificate", "C-1")
    together = root_sum([known, BenchFigure(2.0, origin="certificate", certificate="C-2")])
    assert together.standard == pytest.approx(math.sqrt(2.0))
    assert together.dof == pytest.approx(4.0 * 4.0)  # (1 + 1)² / (1/4 + 0)
    assert (together.origin, together.certificate) == ("certificate", "C-1, C-2")
    assert root_sum([known, BenchFigure(2.0)]).origin == "assumption"


def test_figures_survive_the_records_and_a_results_notes() -> None:
    figures = (POSITION, FAST, SQUARE)
    assert figures_from_text(figures_text(figures), "Table") == figures
    assert figures_text(()) == ""
    assert figures_from_text("", "Table") == ()
    capability = capability_of([standard("table", POSITION, FAST), standard("fixture", SQUARE)], DAY)
    assert capability_from_json(capability_to_json(capability)) == capability
    notes = with_capability({"plan": 1}, capability)
    assert noted_capability(notes) == capability
    assert with_capability(notes, BenchCapability()) == {"plan": 1}
    legacy = BenchCapability(position_arcsec=4.0, acquisition_bits=12.0, certified=("position_arcsec",))
    assert noted_capability(with_capability({}, legacy)) == legacy


@pytest.mark.parametrize(
    "text", ["{", "7", '["x"]', '[{"figure": "speed", "value": 1, "unit": "1", "k": 2}]', "[" * 100_000,
             '[{"figure": "wobble_arcsec", "value": 1, "unit": "arcsec"}]']
)  # fmt: skip
def test_damaged_figures_in_the_records_are_named(text: str) -> None:
    with pytest.raises(InputError, match=r"The figures of Table in the records cannot be used"):
        figures_from_text(text, "Table")


@pytest.mark.parametrize(
    "data",
    [[], {"rate_relative": [1.0]}, {"rate_relative": [1.0, -1.0, 1.0]}, {"wobble_arcsec": "2"},
     {"stated": [{"figure": "wobble_arcsec"}]}, {"position_arcsec": -1.0}, {"certified": [1]}],
)  # fmt: skip
def test_notes_that_hold_something_else_are_refused(data: object) -> None:
    with pytest.raises(InputError, match="capability"):
        noted_capability({"capability": data})


@pytest.mark.parametrize(
    ("kind", "good", "bad", "said"),
    [
        (
            "fixture",
            StatedFigure("fixture_flatness_mm", 10.0, "um", distribution="rectangular"),
            StatedFigure("fixture_flatness_mm", 11.0, "um", distribution="rectangular"),
            "states 0.011 for “flatness of the fixture”; clause 6 asks for 0.01.",
        ),
        (
            "supply",
            StatedFigure("supply_relative", 0.3, "%", 3.0),
            StatedFigure("supply_relative", 0.3, "%", 2.0),
            "states 0.003 for “supply voltage, relative”; clause 6 asks for 0.002.",
        ),
        (
            "supply",
            StatedFigure("supply_ripple_mv", 300.0, "uV", distribution="rectangular"),
            StatedFigure("supply_ripple_mv", 0.4, "mV", 2.0),
            "states 0.4 for “ripple and noise of the supply”; clause 6 asks for 0.3.",
        ),
    ],
)
def test_figures_that_only_clause_6_asks_for(
    kind: StandardKind, good: StatedFigure, bad: StatedFigure, said: str
) -> None:
    others = [standard(one) for one in ("table", "supply", "fixture") if one != kind]
    assert clause6_violations([*others, standard(kind, good)], on_date=DAY) == ()
    (found,) = clause6_violations([*others, standard(kind, bad)], on_date=DAY)
    assert said in found.text()
    assert capability_of([standard(kind, bad)], DAY) == BenchCapability()  # no budget takes it
    twice = figure_conflicts([standard(kind, good), standard("other", bad)])
    assert len(twice) == 1
