"""Two significant digits of U and the value to the same place."""

from __future__ import annotations

import math
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.metrology.rounding import RoundedPair, format_grouped, round_to_place, round_to_uncertainty


@pytest.mark.parametrize(
    ("value", "expanded", "mode", "expected"),
    [
        # JCGM 100, 7.2.6: u_c = 27 mΩ: 10.05762 Ω becomes 10.058 Ω
        (10.05762, 0.027, "half-even", ("10.058", "0.027", 3)),
        (1.0023354972, 4.23e-4, "half-even", ("1.00234", "0.00042", 5)),
        # annex A prints 4.3 and 1.1: rounded up
        (1.0, 4.23e-4, "up", ("1.00000", "0.00043", 5)),
        (1.0, 1.005e-2, "up", ("1.000", "0.011", 3)),
        (0.5, 0.0995, "half-even", ("0.50", "0.10", 2)),
        (0.5, 0.0995, "up", ("0.50", "0.10", 2)),
        (0.5, 0.0991, "up", ("0.50", "0.10", 2)),
        (0.5, 0.0994, "half-even", ("0.500", "0.099", 3)),
        (9.95, 9.95, "half-even", ("10", "10", 0)),
        (12345.0, 123.0, "half-even", ("12340", "120", -1)),
        (12345.0, 121.0, "up", ("12340", "130", -1)),
        (12355.0, 995.0, "half-even", ("12400", "1000", -2)),
        (-0.0004, 0.12, "half-even", ("0.00", "0.12", 2)),
        (-2.5e-5, 1.25e-6, "half-even", ("-0.0000250", "0.0000012", 7)),
        (2.0, 1.35, "half-even", ("2.0", "1.4", 1)),
        (1e22, 1.0, "half-even", ("10000000000000000000000.0", "1.0", 1)),
        (1e-300, 1e-301, "half-even", (f"{1e-300:.302f}", f"{1e-301:.302f}", 302)),
    ],
)
def test_value_and_uncertainty_end_at_the_same_place(
    value: float, expanded: float, mode: str, expected: tuple[str, str, int]
) -> None:
    assert round_to_uncertainty(value, expanded, mode) == RoundedPair(*expected)  # type: ignore[arg-type]


FLOATS = st.floats(-1e9, 1e9)
UNCERTAINTIES = st.floats(1e-12, 1e9)


@given(FLOATS, UNCERTAINTIES, st.sampled_from(["half-even", "up"]))
def test_rounding_moves_by_no_more_than_it_may(value: float, expanded: float, mode: str) -> None:
    pair = round_to_uncertainty(value, expanded, mode)  # type: ignore[arg-type]
    place = Decimal(1).scaleb(-pair.decimals)
    exact, rounded = Decimal(repr(expanded)), Decimal(pair.expanded)
    assert 10 * place <= rounded < 100 * place
    assert abs(rounded - exact) <= (place if mode == "up" else place / 2)
    assert mode != "up" or rounded >= exact
    assert abs(Decimal(pair.value) - Decimal(repr(value))) <= place / 2
    assert "e" not in (pair.value + pair.expanded).lower()
    assert pair.value.partition(".")[2] == "" or len(pair.value.partition(".")[2]) == pair.decimals


def test_no_uncertainty_leaves_the_value() -> None:
    assert round_to_uncertainty(1.5, 0.0) == RoundedPair("1.500000000000", "0", 12)


@pytest.mark.parametrize(("value", "expanded"), [(math.nan, 1.0), (1.0, math.inf), (1.0, -1.0)])
def test_what_is_no_number_cannot_be_rounded(value: float, expanded: float) -> None:
    with pytest.raises(ValueError, match="cannot round"):
        round_to_uncertainty(value, expanded)


def test_one_number_to_a_place() -> None:
    assert round_to_place(2.675, 2) == "2.68"
    assert round_to_place(2.665, 2) == "2.66"
    assert round_to_place(1234.0, -2) == "1200"
    assert round_to_place(1201.0, -2, "up") == "1300"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1234567.1234567", "1 234 567.123 456 7"),
        ("123456", "123 456"),
        ("1234.1234", "1234.1234"),
        ("12345.12345", "12 345.123 45"),
        ("-0.00042", "−0.000 42"),
        ("0", "0"),
        ("100", "100"),
    ],
)
def test_groups_of_three_with_thin_spaces_and_a_true_minus(text: str, expected: str) -> None:
    assert format_grouped(text) == expected.replace(" ", "\u2009")


@given(FLOATS)
def test_grouping_loses_nothing(value: float) -> None:
    text = round_to_place(value, 7)
    assert format_grouped(text).replace("\u2009", "").replace("\u2212", "-") == text
