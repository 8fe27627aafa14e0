"""The diagnosis as JSON: complete both ways, absent in older results, and nothing believed that is read."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import (
    AllanDiagnosis,
    Change,
    Diagnosis,
    DiagnosisFinding,
    Harmonic,
    LackOfFit,
    MisalignmentDiagnosis,
    Residuals,
    ScaleFactorDiagnosis,
    ZeroOffsetDiagnosis,
)
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.result_json import from_json_text, to_json_text

FINDING = DiagnosisFinding("warn", Message("At {rate} °/s", rate="−200"), 2e-5, "sf_x_1")
RESIDUALS = Residuals(
    ("sf_x_1", "sf_x_2"), (0.0, 30.0), (1e-4, -1e-4), (5e-5, 5e-5), (9.1, -0.3), 8, 5.2, (0,), 2e-5
)
DIAGNOSIS = Diagnosis(
    {
        "x": ScaleFactorDiagnosis(
            (-200.0, 200.0), (2, 1), 200.3, RESIDUALS, Change(1e-7, 2e-8, 7.0, 0.001),
            LackOfFit(3.2, 8.0, 110.5, 0.002, 0.01), Change(1e-3, 2e-4, math.inf, 1e-6), (FINDING,),
        ),
        "y": ScaleFactorDiagnosis((-200.0, 200.0), (1, 2), 200.3, RESIDUALS, None, None, None),
    },
    {
        "x": ZeroOffsetDiagnosis(
            RESIDUALS,
            Harmonic(
                3e-3, 3.2e-3, Change(-2e-4, 1e-5, 9.0, 1e-7), Change(0.1, 0.2, math.inf, 0.6),
                (0.0, 120.0, 240.0), (1e-3, 2e-3, 3e-3), 1e-5, (0.0, 10.0), (1e-3, 1e-3), (1e-3, 2e-3),
            ),
            AllanDiagnosis(
                (1.0, 2.0), (1e-3, 7e-4), (9e-4, 6e-4), (1.1e-3, 8e-4), (1.0, 1800.0), (1e-3, 1e-4), 1e-3,
                1e-4, 1e-6, 1800.0, 1e-4, "past",
            ),
        ),
        "z": ZeroOffsetDiagnosis(None, None, None),
    },
    {"yx": MisalignmentDiagnosis(1e-3, 0.1, (FINDING,))},
)  # fmt: skip


def result(diagnosis: Diagnosis | None = DIAGNOSIS) -> CalibrationResult:
    return CalibrationResult("jjf1536-2015", "00" * 32, "ahrs-lab", diagnosis=diagnosis)


def test_it_survives_both_ways() -> None:
    assert from_json_text(to_json_text(result())) == result()
    assert from_json_text(to_json_text(result(None))) == result(None)


def test_an_older_result_has_none() -> None:
    data = json.loads(to_json_text(result()))
    del data["diagnosis"]
    assert from_json_text(json.dumps(data)).diagnosis is None


def test_a_finding_says_its_sentence_for_readers_of_the_json() -> None:
    data = json.loads(to_json_text(result()))
    assert data["diagnosis"]["scale_factor"]["x"]["findings"][0]["what"] == "At −200 °/s"
    assert data["diagnosis"]["scale_factor"]["x"]["drift"]["dof"] is None


@pytest.mark.parametrize(
    ("damage", "key"),
    [
        (lambda d: d["scale_factor"]["x"].update(rates_dps=[1.0]), "rates_dps"),
        (lambda d: d["scale_factor"]["x"]["residuals"].update(outliers=[2]), "outliers"),
        (lambda d: d["scale_factor"]["x"]["residuals"].update(segments=["a"]), "segments"),
        (lambda d: d["scale_factor"]["x"].update(order=[0, 1]), "order"),
        (lambda d: d["zero_offset"]["x"]["allan"].update(taus_s=[0.0, 1.0]), "taus_s"),
        (lambda d: d["zero_offset"]["x"]["allan"].update(verdict="nowhere"), "verdict"),
        (lambda d: d["misalignment"].update(yy={}), "misalignment"),
        (lambda d: d["misalignment"]["yx"]["findings"][0].update(state="bad"), "state"),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(damage: Callable[[dict[str, Any]], None], key: str) -> None:
    data = json.loads(to_json_text(result()))
    damage(data["diagnosis"])
    with pytest.raises(InputError, match=key):
        from_json_text(json.dumps(data))
