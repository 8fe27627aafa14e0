"""Drivers are found by entry points, settings come from TOML, and both say what is wrong."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Literal

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.by_hand import SetByHand
from ahrs_lab.instruments.drivers.catalogue import ACUTROL
from ahrs_lab.instruments.drivers.rooms.sensors import PolledRoom, TypedRoom
from ahrs_lab.instruments.drivers.supplies.scpi import ScpiSupply
from ahrs_lab.instruments.drivers.tables.acutrol import AcutrolSettings, AcutrolTable
from ahrs_lab.instruments.drivers.tables.ascii_table import AsciiTable, template_examples
from ahrs_lab.instruments.registry import GROUP, Drivers, Surroundings, create_instrument, find_drivers
from ahrs_lab.instruments.settings import settings_from_toml, settings_to_toml
from tests.instruments.fake_clock import FakeClock

HOUSE = "ahrs_lab.instruments.drivers.catalogue"
NAMES = {
    "table-acutrol": "ACUTROL",
    "table-atl": "ATL",
    "table-actidyn": "ACTIDYN",
    "table-ascii": "ASCII",
    "table-manual": "MANUAL",
    "supply-scpi": "SCPI_SUPPLY",
    "room-scpi": "SCPI_ROOM",
    "room-modbus": "MODBUS_ROOM",
    "room-typed": "TYPED_ROOM",
}


def house() -> Drivers:
    return find_drivers(
        [EntryPoint(name, f"{HOUSE}:{attribute}", GROUP) for name, attribute in NAMES.items()]
    )


def test_every_driver_of_the_house_loads_under_its_name() -> None:
    drivers = house()
    assert drivers.broken == ()
    assert {f"{kind}-{name}" for kind, name in drivers.found} == set(NAMES)
    assert {driver.name for driver in drivers.of("table") if driver.experimental} == {"atl", "actidyn"}


def test_the_project_names_its_drivers_as_entry_points() -> None:
    text = (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    points = tomllib.loads(text)["project"]["entry-points"][GROUP]
    assert {name: f"{HOUSE}:{attribute}" for name, attribute in NAMES.items()}.items() <= points.items()


@pytest.mark.parametrize(
    ("kind", "text", "driver"),
    [
        ("table", 'driver = "acutrol"\nlink = {host = "10.0.0.2"}\nlimits.max_rate_dps = 150', AcutrolTable),
        ("supply", 'driver = "scpi"\nconnection = {resource = "ASRL1::INSTR"}', ScpiSupply),
        ("supply", 'driver = "scpi"\nconnection.link = {device = "COM3"}', ScpiSupply),
        ("room", 'driver = "modbus"\nlink = {device = "COM3"}\ntemperature = {address = 4}', PolledRoom),
        ("room", 'driver = "typed"', TypedRoom),
    ],
)
def test_a_bench_file_makes_instruments(
    kind: Literal["table", "supply", "room"], text: str, driver: type[object]
) -> None:
    if kind == "table":
        text += "\nlimits.max_acceleration_dps2 = 80"
    made = create_instrument(kind, tomllib.loads(text), Surroundings(FakeClock()), house())
    assert isinstance(made, driver)


@pytest.mark.parametrize("example", sorted(template_examples()))
def test_each_example_language_makes_a_table(example: str) -> None:
    table = {
        "driver": "ascii",
        "link": {"device": "COM1"},
        "template": tomllib.loads(template_examples()[example]),
    }
    assert isinstance(create_instrument("table", table, Surroundings(FakeClock()), house()), AsciiTable)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ({}, "does not say which"),
        ({"driver": "acutroll"}, "did you mean “acutrol”"),
        ({"driver": "zzz"}, "there are: acutrol, actidyn|there are: actidyn"),
        ({"driver": "acutrol"}, "“table.link” is missing"),
        ({"driver": "acutrol", "link": "x"}, "has to be a table"),
        ({"driver": "acutrol", "link": {"host": "x", "prot": 5}}, "did you mean “port”"),
        ({"driver": "acutrol", "link": {"host": "x"}, "axis": 1.5}, "a whole number"),
        ({"driver": "acutrol", "link": {"host": "x"}, "axis": True}, "a whole number"),
        ({"driver": "acutrol", "link": {"host": "x"}, "axis": 0}, "between 1 and 9"),
        ({"driver": "acutrol", "link": {"host": "x"}, "pause_s": float("nan")}, "a finite number"),
        ({"driver": "acutrol", "link": {"device": "x", "parity": "no"}}, "one of none, even, odd"),
    ],
)
def test_what_is_wrong_with_a_bench_file_is_told(table: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        create_instrument("table", table, Surroundings(FakeClock()), house())


def test_a_table_set_by_hand_is_made_without_a_wire_and_says_what_to_do() -> None:
    limits = {"max_rate_dps": 50.0, "max_acceleration_dps2": 10.0}
    table = create_instrument(
        "table", {"driver": "manual", "limits": limits}, Surroundings(FakeClock()), house()
    )
    table.enable()
    assert isinstance(table, SetByHand)
    assert table.request is not None
    assert table.request.kind == "switch_on"


def test_a_driver_that_does_not_load_is_told_and_keeps_nobody_away() -> None:
    points = [
        EntryPoint("table-gone", "no_such_package:X", GROUP),
        EntryPoint("table-odd", "math:pi", GROUP),
        EntryPoint("table-acutrol", f"{HOUSE}:ACUTROL", GROUP),
    ]
    drivers = find_drivers(points)
    assert drivers.get("table", "acutrol") is ACUTROL
    assert ["no_such_package" in str(drivers.broken[0]), "math:pi" in str(drivers.broken[1])] == [True, True]
    with pytest.raises(InputError, match="no_such_package"):
        drivers.get("table", "gone")


@dataclass(frozen=True)
class Inner:
    size: float = 1.0


@dataclass(frozen=True)
class Outer:
    name: str
    inner: Inner = field(default_factory=Inner)
    maybe: Inner | None = None
    many: tuple[float, ...] = ()
    words: dict[str, str] = field(default_factory=dict)


def test_settings_survive_toml() -> None:
    for settings in (
        Outer("x"),
        Outer("y", Inner(2.0), Inner(3.0), (1.0, 2.5), {"a": "b"}),
    ):
        assert settings_from_toml(Outer, settings_to_toml(settings)) == settings
    acutrol = settings_from_toml(AcutrolSettings, {"link": {"host": "h"}})
    assert settings_from_toml(AcutrolSettings, settings_to_toml(acutrol)) == acutrol


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ({}, "“x.name” is missing"),
        ({"name": "n", "many": 1.0}, "“x.many” has to be a list"),
        ({"name": "n", "many": [1, "a"]}, r"“x.many\[1\]” has to be a number"),
        ({"name": "n", "inner": {"sise": 1}}, "“x.inner.sise” is not a setting; did you mean “size”"),
        ({"name": "n", "words": {"a": 1}}, "“x.words.a” has to be text"),
        ({"name": "n", "qqq": 1}, "known here are: name, inner"),
    ],
)
def test_settings_are_refused_by_their_full_name(table: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        settings_from_toml(Outer, table, "x")
