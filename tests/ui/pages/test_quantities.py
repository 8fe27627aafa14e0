"""Units, rounding and order of the numbers on the results page."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.ui.pages.results.quantities import Quantity, quantities, show, units
from tests.ui.pages.sample_result import sample_result


def quantity(key: str) -> Quantity:
    return next(q for q in quantities(sample_result()) if q.key == key)


def test_quantities_stand_in_the_order_of_annex_c() -> None:
    keys = [q.key for q in quantities(sample_result())]
    assert keys == [
        "K.x", "K.y", "K.z", "B.x", "B.y", "B.z", "L.yx", "L.zx", "L.xy", "L.zy", "L.xz", "L.yz",
    ]  # fmt: skip


def test_what_was_not_measured_is_not_there() -> None:
    result = replace(sample_result(), zero_offset={}, misalignment={})
    assert [q.group for q in quantities(result)] == ["scale_factor"] * 3
    assert quantities(CalibrationResult("jjf1536-2015", "", "")) == ()


@pytest.mark.parametrize(
    ("key", "unit", "value", "expanded"),
    [
        ("K.x", "1", "1.002\u2009335", "0.000\u2009021"),
        ("K.x", "ppm", "2335", "21"),
        ("B.x", "dph", "11.11", "0.35"),
        ("B.y", "dph", "\u22128.46", "0.35"),
        ("B.x", "dps", "0.003\u2009087", "0.000\u2009097"),
        ("L.yx", "arcmin", "\u22120.924", "0.013"),
        ("L.yz", "arcsec", "181.27", "0.78"),
        ("L.yz", "deg", "0.050\u200935", "0.000\u200922"),
        ("L.yz", "rad", "0.000\u2009878\u20098", "0.000\u2009003\u20098"),
    ],
)
def test_a_value_is_rounded_with_its_uncertainty_in_each_unit(
    key: str, unit: str, value: str, expanded: str
) -> None:
    found = quantity(key)
    chosen = next(u for u in units(found) if u.key == unit)
    shown = show(found, chosen)
    assert (shown.value, shown.expanded) == (value, expanded)


def test_a_counting_device_has_no_ppm() -> None:
    found = replace(quantity("K.x"), unit="LSB/(deg/s)")
    assert [u.label for u in units(found)] == ["LSB/(°/s)"]


def test_a_value_without_uncertainty_shows_a_dash_for_it() -> None:
    found = quantity("K.x")
    bare = replace(found, uncertainty=replace(found.uncertainty, expanded=0.0))
    assert show(bare, units(bare)[0]).expanded == "–"
    lost = replace(found, value=math.nan)
    assert show(lost, units(lost)[0]).value == "–"
