"""Clause 6: what the laboratory declares of its table's place."""

from __future__ import annotations

import math

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.metrology.declared_place import (
    DeclaredPlace,
    noted_place,
    place_from_json,
    place_note,
    place_to_json,
    place_violations,
)


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (DeclaredPlace(3.9, True), ()),
        (DeclaredPlace(0.0, True), ()),
        (DeclaredPlace(4.0, True), ("declared as 4.0 Ω; it has to be below 4.0 Ω",)),
        (DeclaredPlace(1.0, False), ("not standing on an isolated foundation",)),
        (DeclaredPlace(12.0, False), ("12.0 Ω", "not standing on")),
    ],
)
@pytest.mark.parametrize("needed", [True, False])
def test_what_is_declared_is_held_against_the_clause(
    place: DeclaredPlace, said: tuple[str, ...], needed: bool
) -> None:
    found = place_violations(place, needed=needed)
    assert len(found) == len(said)
    for message, words in zip(found, said, strict=True):
        assert words in message.text()
        assert message.text("zh") != message.text()


def test_what_is_not_declared_violates_only_where_it_is_needed() -> None:
    assert place_violations(DeclaredPlace(), needed=False) == ()
    assert len(place_violations(DeclaredPlace(), needed=True)) == 2
    (found,) = place_violations(DeclaredPlace(1.0), needed=True)
    assert "not declared whether the table stands on an isolated foundation" in found.text()
    (found,) = place_violations(DeclaredPlace(isolated_foundation=True), needed=True)
    assert "earth resistance is not declared" in found.text()


@pytest.mark.parametrize(
    "place", [DeclaredPlace(), DeclaredPlace(1.2), DeclaredPlace(None, False), DeclaredPlace(0.0, True)]
)
def test_it_is_kept_in_records_and_notes(place: DeclaredPlace) -> None:
    assert place_from_json(place_to_json(place)) == place
    assert (noted_place(place_note(place)) or DeclaredPlace()) == place
    assert place.complete is (place == DeclaredPlace(0.0, True))


def test_nothing_declared_leaves_no_trace() -> None:
    assert place_to_json(DeclaredPlace()) == ""
    assert place_note(DeclaredPlace()) == {}
    assert noted_place({}) is None


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '{"earth_resistance_ohm": "low"}',
        '{"earth_resistance_ohm": -1}',
        '{"earth_resistance_ohm": 1e999}',
        '{"isolated_foundation": 1}',
    ],
)
def test_what_is_no_declaration_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        place_from_json(text)


@pytest.mark.parametrize("ohm", [-0.1, math.nan, math.inf])
def test_an_earth_resistance_is_a_number_of_ohms(ohm: float) -> None:
    with pytest.raises(InputError, match="earth resistance"):
        DeclaredPlace(ohm)
