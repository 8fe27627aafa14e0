"""The result as JSON: the published keys, complete both ways, and nothing believed that is read."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from datetime import datetime
from typing import Any

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.json_reader import JsonReader
from ahrs_lab.metrology.result import (
    BudgetRow,
    CalibrationResult,
    Correlation,
    Environment,
    MisalignmentResult,
    MonteCarloCheck,
    ResultWarning,
    ScaleFactorResult,
    Uncertainty,
    ZeroOffsetResult,
)
from ahrs_lab.metrology.result_json import from_json, from_json_text, to_json, to_json_text
from ahrs_lab.metrology.uncertainty_json import read_uncertainty, uncertainty_json

ROWS = (
    BudgetRow(
        "Ω",
        Message("Table rate, {band}, common to the band", band="x"),
        "1",
        1e-4,
        -1.0,
        1e-4,
        "B",
        "normal",
        2.0,
        math.inf,
        "certificate",
        None,
        2e-4,
        certificate="C-1",
    ),
    BudgetRow("F̄", Message("Time base"), "deg/s", 1e-5, 0.3, 3e-6, "A", "t", 1.0, 19.5, "data", 0.1, None),
)
STATED = Uncertainty(
    1.1e-4,
    2.2e-4,
    1.96,
    math.inf,
    "gum",
    (ROWS[0], replace(ROWS[1], shared="noise x")),
    (Correlation(0, 1, -0.25),),
    MonteCarloCheck(
        trials=200_000,
        seed=7,
        mean=1.0,
        standard=1.1e-4,
        symmetric=(0.9998, 1.0002),
        shortest=(0.9998, 1.00021),
        digits=2,
        tolerance=5e-6,
        validated=True,
        bins=(0.9995, 1.0005),
        counts=(1, 20, 3),
    ),
)
OTHER = Uncertainty(0.1, 0.2, 2.0, 17.25, "annex-a")


def result() -> CalibrationResult:
    return CalibrationResult(
        procedure="jjf1536-2015",
        bundle_sha256="ab" * 32,
        software="ahrs-lab 0.1.0",
        scale_factor={
            "x": ScaleFactorResult(
                "x",
                1.0023354972170277,
                6e-4,
                "(deg/s)/(deg/s)",
                (-1.0, 1.0),
                (-1.0, 1.1),
                (-1.0, 1.0),
                (0.0, 1e-17),
                0.1,
                0.2,
                13.0,
                -0.5,
                STATED,
                "table",
                ("a", "b"),
                (1e-3, 2e-3),
                OTHER,
            )
        },
        zero_offset={
            "y": ZeroOffsetResult(
                "y",
                0.003,
                "deg/s",
                1800.0,
                (1.0, 2.0),
                STATED,
                "multi-position",
                ("ENU", "WSU"),
                (0.0, 180.0),
                (1800.0, 1800.0),
                1e-4,
                {"amplitude_dps": 0.1},
                ("c",),
            )
        },
        misalignment={
            "yx": MisalignmentResult("y", "x", -2.7e-4, 10, 1.5, -1.5, OTHER, "rad", 100.0, 38.0, ("d",))
        },
        warnings=(
            ResultWarning(Message("{count} of {what}", count=3, what=Message("Time base")), "s.csv", 7),
        ),
        deviations=(Message("T is {seconds} s", seconds=600.0),),
        environment=Environment(20.0, 0.5, 50.0, 2.0),
        device={"name": "航姿仪"},
        site={"latitude_deg": 39.9},
        notes={"plan": {"name": "n"}, "order_run": ["a"]},
        simulated=True,
    )


def test_it_comes_back_as_it_was() -> None:
    assert from_json_text(to_json_text(result())) == result()
    assert from_json(json.loads(json.dumps(to_json(result())))) == result()


def test_the_published_keys_are_there() -> None:
    data = to_json(result())
    assert {
        "procedure",
        "bundle_sha256",
        "software",
        "scale_factor",
        "zero_offset",
        "misalignment",
        "warnings",
    } <= set(data)
    common = {"standard_uncertainty", "expanded_uncertainty", "coverage_factor", "dof", "unit"}
    assert common | {
        "K", "F0", "rates_dps", "means", "residuals", "nonlinearity_ppm", "asymmetry_ppm",
    } <= set(data["scale_factor"]["x"])  # fmt: skip
    assert common | {"B", "duration_s", "angles_deg"} <= set(data["zero_offset"]["y"])
    assert common | {"L", "turns", "angle_positive_deg", "angle_negative_deg"} <= set(
        data["misalignment"]["yx"]
    )
    assert data["warnings"][0]["segment"] == "s.csv"
    assert data["warnings"][0]["line"] == 7
    assert data["warnings"][0]["what"] == "3 of Time base"


def test_infinite_degrees_of_freedom_are_null_and_full_precision_is_kept() -> None:
    data = json.loads(to_json_text(result()))
    assert data["scale_factor"]["x"]["dof"] is None
    assert data["misalignment"]["yx"]["dof"] == 17.25
    assert data["scale_factor"]["x"]["K"] == 1.0023354972170277


def test_dates_and_numbers_that_are_not_finite_do_not_break_the_notes() -> None:
    made = CalibrationResult(
        "p",
        "s",
        "w",
        notes={"at": datetime(2026, 3, 1), "x": math.nan, "y": [math.inf]},  # noqa: DTZ001
    )
    assert to_json(made)["notes"] == {"at": "2026-03-01T00:00:00", "x": None, "y": [None]}


def test_a_result_that_is_no_number_is_not_written() -> None:
    made = CalibrationResult(
        "p", "s", "w", misalignment={"yx": MisalignmentResult("y", "x", math.nan, 1, 0, 0, OTHER)}
    )
    with pytest.raises(ValueError, match="not JSON compliant"):
        to_json(made)


def published() -> dict[str, Any]:
    """What another program may have kept: the published keys alone."""
    common = {"standard_uncertainty": 1, "expanded_uncertainty": 2, "coverage_factor": 2.0, "dof": 9}
    return {
        "procedure": "jjf1536-2015", "bundle_sha256": "", "software": "ahrs-lab 1",
        "scale_factor": {"x": {"K": 1, "F0": 0, "unit": "u", "rates_dps": [1], "means": [1], "residuals": [0],
                               "nonlinearity_ppm": 0, "asymmetry_ppm": 0, **common}},
        "zero_offset": {"x": {"B": 0, "unit": "deg/s", "duration_s": 1, "angles_deg": [], **common}},
        "misalignment": {"yx": {"L": 0, "unit": "rad", "turns": 10, "angle_positive_deg": 0,
                                "angle_negative_deg": 0, **common}},
        "warnings": [{"segment": "a", "line": 2, "what": "braces {x} in it"}],
    }  # fmt: skip


def test_the_published_keys_alone_are_enough() -> None:
    found = from_json(published())
    assert found.scale_factor["x"].K == 1.0
    assert found.warnings[0].what.text("zh") == "braces {x} in it"
    assert found.environment is None


@pytest.mark.parametrize(
    ("path", "value", "named"),
    [
        ("procedure", 3, "procedure"),
        ("scale_factor", [], "scale_factor"),
        ("scale_factor.x.K", "1", "scale_factor.x.K"),
        ("scale_factor.x.K", True, "scale_factor.x.K"),
        ("scale_factor.x.K", math.nan, "scale_factor.x.K"),
        ("scale_factor.x.K", 10**400, "scale_factor.x.K"),
        ("scale_factor.x.means", [1, 2], "scale_factor.x.means"),
        ("scale_factor.x.rates_dps", [None], r"scale_factor.x.rates_dps\[0\]"),
        ("scale_factor.w", {}, "w"),
        ("scale_factor.x.method", "guess", "scale_factor.x.method"),
        ("scale_factor.x.budget", [{"symbol": "a"}], r"scale_factor.x.budget\[0\].message"),
        ("misalignment.xx", {}, "xx"),
        ("misalignment.yx.turns", 1.5, "misalignment.yx.turns"),
        ("zero_offset.x.duration_s", None, "zero_offset.x.duration_s"),
        ("zero_offset.x.schedule", "any", "zero_offset.x.schedule"),
        ("warnings", [{"segment": 1, "line": 1, "what": ""}], r"warnings\[0\].segment"),
        ("warnings", [{"segment": "", "line": 1}], r"warnings\[0\].what"),
        ("warnings", ["text"], r"warnings\[0\]"),
        ("environment", {"temperature_c": 1}, "environment.temperature_spread_c"),
    ],
)
def test_what_is_wrong_is_named_by_its_key(path: str, value: object, named: str) -> None:
    data = published()
    *parents, last = path.split(".")
    inside = data
    for key in parents:
        inside = inside[key]
    inside[last] = value
    with pytest.raises(InputError, match=named):
        from_json(data)


@pytest.mark.parametrize(
    "message",
    [
        {"template": "{a.__class__}", "params": {"a": 1}},
        {"template": "{a:>999999999}", "params": {"a": 1}},
        {"template": "{a!r}", "params": {"a": 1}},
        {"template": "{b}", "params": {"a": 1}},
        {"template": "{", "params": {"a": 1}},
        {"template": "{a}", "params": {"a": [1]}},
        {"template": 3, "params": {}},
        {"template": "{a}", "params": {"a": {"template": "{b.c}", "params": {"b": 1}}}},
    ],
)
def test_a_sentence_can_do_nothing_but_show_its_values(message: object) -> None:
    data = published()
    data["warnings"] = [{"segment": "", "line": 0, "what": "", "message": message}]
    with pytest.raises(InputError, match=r"warnings\[0\]\.message"):
        from_json(data)


@pytest.mark.parametrize("text", ["", "{", "[]", "3", '{"procedure": 1}', "[" * 100000])
def test_what_is_no_result_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        from_json_text(text)


def test_a_u_from_the_trials_and_one_without_variance_survive_json() -> None:
    assert STATED.monte_carlo is not None
    check = replace(STATED.monte_carlo, standard=None, gum_expanded=1.5e-4)
    found = replace(STATED, monte_carlo=check, from_monte_carlo=True)
    data = json.loads(json.dumps(uncertainty_json(found), allow_nan=False))
    assert data["monte_carlo"]["standard_uncertainty"] is None
    assert read_uncertainty(JsonReader(data)) == found
    del data["from_monte_carlo"], data["monte_carlo"]["gum_expanded_uncertainty"]  # of an earlier release
    before = read_uncertainty(JsonReader(data))
    assert (before.from_monte_carlo, before.gum_expanded) == (False, before.expanded)


def test_a_row_that_names_no_certificate_is_an_assumption() -> None:
    """Earlier releases wrote “certificate” for figures that no numbered certificate stands behind."""
    data = json.loads(json.dumps(uncertainty_json(STATED)))
    data["budget"][0]["certificate"] = " "
    assert read_uncertainty(JsonReader(data)).rows[0].origin == "assumption"
    data["budget"][0]["certificate"] = "C-1"
    assert read_uncertainty(JsonReader(data)).rows[0].origin == "certificate"
