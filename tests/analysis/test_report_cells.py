"""Cells as they are set, and which columns hold numbers."""

from __future__ import annotations

import pytest

from ahrs_lab.analysis.report import Table
from ahrs_lab.analysis.report_cells import column, digits, number_columns, paired, readable
from ahrs_lab.messages import Message


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("-1.25", "−1.25"),
        ("1.2e-05", "1.2×10^{−5}"),
        ("-3E+08 m", "−3×10^{8} m"),
        ("0.5 ± 2e-10", "0.5 ± 2×10^{−10}"),
        ("φ_E, rad", "φ_{E}, rad"),
        ("(1.2 ± 0.3)e-05", "(1.2 ± 0.3)×10^{−5}"),
        ("Bf_xyz", "Bf_xyz"),
        ("+0.76 ∇_x, −0.5 δv_E", "+0.76 ∇_{x}, −0.5 δv_{E}"),
        ("segments/zo_x_1.csv and a_1.csv of x_2.", "segments/zo_x_1.csv and a_1.csv of x_{2}."),
        ("mems-unit-1 of 2026-11-28", "mems-unit-1 of 2026-11-28"),
        ("a_longer_name", "a_longer_name"),
        ("(-5 … -.5)", "(−5 … −.5)"),
        ("0x1e5 and file1e5", "0x1e5 and file1e5"),
    ],
)
def test_text_is_set_as_a_person_writes_it(text: str, shown: str) -> None:
    assert readable(text) == shown


def test_columns_of_numbers_are_found() -> None:
    table = Table(
        Message("Bias"),
        ("", "value", "U", "unit", "note", "none"),
        (
            ("x", "-1.2e-05", "± 3", "°/h", "2", ""),
            ("y", "−", "", "°/h", "3", "–"),
            ("z", "0.5 °/h", "≤ 0.1", "°/h", Message("operator"), ""),
        ),
    )
    assert number_columns(table) == (False, True, True, False, False, False)


def test_a_table_without_rows_has_no_numbers() -> None:
    assert number_columns(Table(Message("Bias"), ("a", "b"), ())) == (False, False)


@pytest.mark.parametrize(
    ("value", "count", "text"),
    [
        (5646.7213, 4, "5647"),
        (0.61, 4, "0.6100"),
        (-188.6534, 4, "-188.7"),
        (99.96, 3, "100"),
        (0.09996, 3, "0.100"),
        (1.23456e-9, 3, "1.23e-09"),
        (8.0, 2, "8.0"),
        (0.0, 4, "0"),
        (float("nan"), 4, "nan"),
    ],
)
def test_a_number_has_its_meaningful_digits(value: float, count: int, text: str) -> None:
    assert digits(value, count) == text


@pytest.mark.parametrize(
    ("value", "uncertainty", "texts"),
    [
        (29.9512, 0.1, ("29.95", "0.10")),
        (-0.47037, 0.02022, ("-0.470", "0.020")),
        (3.6, 0.0996, ("3.60", "0.10")),
        (1234.5, 87.0, ("1234", "87")),
        (1234.5, 870.0, ("1230", "870")),
        (-0.001, 0.5, ("0.00", "0.50")),
        (0.4, float("nan"), ("0.4000", "–")),
        (0.4, 0.0, ("0.4000", "–")),
    ],
)
def test_a_value_ends_where_its_uncertainty_ends(
    value: float, uncertainty: float, texts: tuple[str, str]
) -> None:
    assert paired(value, uncertainty) == texts


def test_a_column_of_one_unit_has_one_number_of_decimals() -> None:
    assert column([64.91, 57.5, 8.8]) == ("64.9", "57.5", "8.8")
    assert column([-0.561, 0.02], sign="+") == ("-0.561", "+0.020")
    assert column([2.2e-9, -1e-9]) == ("2.20e-09", "-1.00e-09")
    assert column([float("nan"), 0.0]) == ("–", "0")
    assert column([]) == ()


def test_a_column_of_unknown_numbers_stands_right_like_known_ones() -> None:
    table = Table(Message("Bias"), ("u", "note"), (("–", ""), ("–", "")))
    assert number_columns(table) == (True, False)
