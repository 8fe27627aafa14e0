"""Clause 6: what keeps a job from starting."""

from __future__ import annotations

from dataclasses import replace
from datetime import date

import pytest

from ahrs_lab.metrology.conditions import (
    BenchCapability,
    Standard,
    StandardKind,
    clause6_violations,
    rate_band,
)
from ahrs_lab.metrology.declared_place import DeclaredPlace
from ahrs_lab.metrology.result import Environment

TODAY = date(2026, 3, 1)


def standard(kind: StandardKind) -> Standard:
    return Standard(kind, kind, kind, "maker", "M", "7", "U", "U", "CNAS-1", date(2026, 3, 1))


GOOD = [standard("table"), standard("supply"), standard("fixture")]
ROOM = Environment(20.5, 0.5, 50.0, 5.0)


def test_a_bench_as_it_has_to_be_passes() -> None:
    assert not clause6_violations(GOOD, environment=ROOM, on_date=TODAY, capability=BenchCapability())
    assert not clause6_violations(GOOD, on_date=TODAY)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"due": date(2026, 2, 28)}, "ran out on 2026-02-28"),
        ({"due": None}, "no due date"),
        ({"certificate_number": " "}, "no certificate number"),
    ],
)
def test_each_standard_needs_a_certificate_in_date(changes: dict[str, object], said: str) -> None:
    standards = [replace(GOOD[0], **changes), *GOOD[1:]]  # type: ignore[arg-type]
    found = clause6_violations(standards, on_date=TODAY)
    assert len(found) == 1
    assert said in found[0].text()


def test_a_kind_that_is_missing_is_named_in_the_readers_language() -> None:
    (found,) = clause6_violations(GOOD[:2], on_date=TODAY)
    assert "fixture" in found.text("en")
    assert "夹具" in found.text("zh")


@pytest.mark.parametrize(
    ("room", "count"),
    [
        (Environment(22.8, 0.3, 50.0, 1.0), 1),
        (Environment(17.0, 0.0, 30.0, 0.0), 0),
        (Environment(16.9, 0.0, 29.0, 0.0), 2),
        (Environment(20.0, 0.0, 84.0, 2.0), 1),
    ],
)
def test_the_room_stays_inside_with_its_spread(room: Environment, count: int) -> None:
    assert len(clause6_violations(GOOD, environment=room, on_date=TODAY)) == count


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"rate_relative": (2e-2, 2e-3, 3e-4)}, "3.0e-04"),
        ({"position_arcsec": 20.0}, "20.0″"),
        ({"fixture_perpendicularity_arcsec": 6.0}, "6.0″"),
    ],
)
def test_a_bench_worse_than_table_1_is_named(changes: dict[str, object], said: str) -> None:
    capability = replace(BenchCapability(), **changes)  # type: ignore[arg-type]
    (found,) = clause6_violations(GOOD, on_date=TODAY, capability=capability)
    assert said in found.text()


def test_the_declared_place_is_looked_at() -> None:
    assert not clause6_violations(GOOD, on_date=TODAY, place=DeclaredPlace(1.0, True), place_needed=True)
    (found,) = clause6_violations(GOOD, on_date=TODAY, place=DeclaredPlace(5.0, True))
    assert "5.0 Ω" in found.text()
    assert len(clause6_violations(GOOD, on_date=TODAY, place_needed=True)) == 2


def test_the_bands_of_the_table() -> None:
    assert [rate_band(rate) for rate in (0.001, -0.999, 1.0, -9.9, 10.0, -1000.0)] == [0, 0, 1, 1, 2, 2]
