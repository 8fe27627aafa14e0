"""Cells as they are set, and which columns hold numbers."""

from __future__ import annotations

import pytest

from ahrs_lab.analysis.report import Table
from ahrs_lab.analysis.report_cells import number_columns, readable
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
