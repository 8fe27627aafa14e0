"""The desk of instruments against a served bench: the real drivers on real sockets."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ahrs_lab.errors import AhrsLabError, InputError
from ahrs_lab.instruments.drivers import catalogue
from ahrs_lab.instruments.registry import Driver, Drivers
from ahrs_lab.laboratory.instrument_benches import (
    InstrumentBenches,
    setting,
    setting_fields,
    table_languages,
    with_setting,
)
from ahrs_lab.laboratory.instrument_desk import InstrumentDesk, JogLimits
from ahrs_lab.laboratory.instrument_live import AhrsLive, TableLive, UnplugTest
from ahrs_lab.simulation.servers.linked_toml import linked_bench
from ahrs_lab.simulation.servers.served_bench import ServedBench, ServeSettings, serve_bench
from ahrs_lab.simulation.settings import simulation_from_toml
from tests.laboratory.house_drivers import house_drivers

PATIENCE_S = 10.0


def until(there: Callable[[], Any], what: str = "") -> None:
    """Fails after ten seconds."""
    end = time.monotonic() + PATIENCE_S
    while not there():
        assert time.monotonic() < end, what or "it never came to that"
        time.sleep(0.01)


@pytest.fixture
def drivers() -> Drivers:
    return house_drivers()


@pytest.fixture
def served() -> Iterator[ServedBench]:
    with serve_bench(simulation_from_toml({}), ServeSettings(ahrs_on="tcp")) as bench:
        yield bench


@pytest.fixture
def desk(served: ServedBench, drivers: Drivers) -> Iterator[InstrumentDesk]:
    toml = linked_bench(served)
    for part in ("supply", "room"):
        if "link" in toml[part]:
            toml[part]["connection"] = {"link": toml[part].pop("link")}
    made = InstrumentDesk(toml, drivers=drivers, supervised=False)
    yield made
    made.close()


def connected(desk: InstrumentDesk, *parts: Any) -> InstrumentDesk:
    for part in parts:
        desk.connect(part)
    until(lambda: all(desk.views[part].state == "ready" for part in parts), str(desk.views))
    return desk


def rate_of(served: ServedBench) -> float:
    return abs(served.served.world.table.state().rate_dps)


def table_live(desk: InstrumentDesk) -> TableLive:
    live = desk.views["table"].live
    assert isinstance(live, TableLive)
    return live


def holding(desk: InstrumentDesk, rate_dps: float, there: Callable[[], bool]) -> None:
    """Keep a button pressed until ``there``."""
    end = time.monotonic() + PATIENCE_S
    while not there():
        assert time.monotonic() < end
        desk.hold(rate_dps)
        time.sleep(0.05)


def test_every_instrument_says_who_it_is_and_what_it_reads(desk: InstrumentDesk) -> None:
    connected(desk, "table", "supply", "room")
    desk.power_on(12.0, 1.0).result(PATIENCE_S)
    until(lambda: desk.views["supply"].live.output_on)
    connected(desk, "ahrs")
    until(lambda: (desk.views["ahrs"].live or AhrsLive()).bits_per_second)
    until(lambda: desk.views["ahrs"].live.samples > 100)
    live = desk.views["ahrs"].live
    assert isinstance(live, AhrsLive)
    assert live.sample_rate_hz == pytest.approx(100.0, rel=0.05)
    assert sum(f * f for f in live.specific_force) ** 0.5 == pytest.approx(9.8, abs=0.1)
    assert live.rate_unit == "°/s"
    assert max(abs(rate) for rate in live.rates) < 1.0
    assert live.counts["lost"] == 0
    assert live.offset_s is not None
    assert desk.views["room"].live.temperature_c == pytest.approx(20.0, abs=5.0)
    assert "simulated" in desk.views["table"].identity


def test_configuring_the_device_shows_what_it_reads_back(desk: InstrumentDesk) -> None:
    connected(desk, "supply")
    desk.power_on(12.0, 1.0).result(PATIENCE_S)
    connected(desk, "ahrs")
    assert desk.configure("ahrs").result(PATIENCE_S) == ()
    assert desk.views["ahrs"].differences == ()
    before = desk.views["ahrs"].live.samples
    until(lambda: desk.views["ahrs"].live.samples != before)


def test_the_table_turns_while_a_button_is_held_and_stops_when_it_is_released(
    desk: InstrumentDesk, served: ServedBench
) -> None:
    connected(desk, "table")
    desk.drive_on().result(PATIENCE_S)
    holding(desk, 20.0, lambda: rate_of(served) > 19.5)
    assert table_live(desk).held
    desk.release()
    until(lambda: rate_of(served) < 0.05)


def test_a_button_that_nobody_hears_of_any_more_is_released(
    desk: InstrumentDesk, served: ServedBench
) -> None:
    connected(desk, "table")
    desk.drive_on().result(PATIENCE_S)
    holding(desk, -20.0, lambda: rate_of(served) > 19.5)
    # The screen hangs: no release, only silence.
    until(lambda: rate_of(served) < 0.05)
    assert not table_live(desk).held


def test_the_table_is_not_turned_faster_than_the_hand_may(desk: InstrumentDesk, served: ServedBench) -> None:
    connected(desk, "table")
    desk.drive_on().result(PATIENCE_S)
    with pytest.raises(InputError, match="31"):
        desk.hold(31.0)
    desk.set_jog_limits(JogLimits(50.0))
    desk.hold(50.0)
    desk.release()
    with pytest.raises(InputError, match="rate table goes up to"):
        desk.set_jog_limits(JogLimits(1e4))
    assert desk.jog_limits.max_rate_dps == 50.0


def test_the_table_stops_at_the_end_of_its_range(desk: InstrumentDesk, served: ServedBench) -> None:
    connected(desk, "table")
    desk.drive_on().result(PATIENCE_S)
    start = table_live(desk).state.angle_deg
    desk.set_jog_limits(JogLimits(30.0, start - 5.0, start + 30.0))
    largest = start

    def ended() -> bool:
        nonlocal largest
        largest = max(largest, served.served.world.table.state().angle_deg)
        return largest > start + 5.0 and rate_of(served) < 0.05

    holding(desk, 30.0, ended)
    assert start + 5.0 < largest < start + 30.0
    with pytest.raises(AhrsLabError, match="range"):
        desk.move_to(start + 31.0, 10.0).result(PATIENCE_S)


def test_stop_ends_a_jog_and_switches_the_supply_off_behind_the_table(
    desk: InstrumentDesk, served: ServedBench
) -> None:
    connected(desk, "table", "supply")
    desk.power_on(12.0, 1.0).result(PATIENCE_S)
    desk.drive_on().result(PATIENCE_S)
    holding(desk, 30.0, lambda: rate_of(served) > 29.0)
    supply = served.served.world.supply
    turning_when_off = 0.0
    desk.stop()
    end = time.monotonic() + PATIENCE_S
    while supply.read().output_on:
        turning_when_off = rate_of(served)
        desk.hold(30.0)  # the finger is still on the button: that must not start it again
        assert time.monotonic() < end
        time.sleep(0.02)
    assert turning_when_off < 0.2
    until(lambda: desk.stop_problems is not None)
    assert desk.stop_problems == ()
    assert rate_of(served) < 0.05


def test_a_move_ends_where_it_was_asked_to(desk: InstrumentDesk, served: ServedBench) -> None:
    connected(desk, "table")
    desk.drive_on().result(PATIENCE_S)
    target = table_live(desk).state.angle_deg + 12.0
    desk.move_to(target, 20.0).result(PATIENCE_S)
    until(lambda: not table_live(desk).state.moving)
    assert table_live(desk).state.angle_deg == pytest.approx(target, abs=0.05)


def test_what_does_not_answer_says_so_and_can_be_tried_again(drivers: Drivers) -> None:
    bench = {"table": {"driver": "acutrol", "link": {"host": "127.0.0.1", "port": 9}}}
    desk = InstrumentDesk(bench, drivers=drivers, supervised=False)
    try:
        for _ in range(2):
            desk.connect("table")
            until(lambda: desk.views["table"].state == "failed")
            problem = desk.views["table"].problem
            assert problem is not None
            assert "127.0.0.1:9" in problem.text()
            desk.disconnect("table").result(PATIENCE_S)
        with pytest.raises(AhrsLabError, match="not connected"):
            desk.identify("table").result(PATIENCE_S)
        with pytest.raises(InputError, match="no supply"):
            desk.power_on(12.0, 1.0)
    finally:
        desk.close()


def test_a_table_set_by_hand_asks_and_waits_for_the_answer(drivers: Drivers) -> None:
    bench = {
        "table": {
            "driver": "manual",
            "limits": {"max_rate_dps": 100.0, "max_acceleration_dps2": 50.0},
        }
    }
    desk = InstrumentDesk(bench, drivers=drivers)
    try:
        connected(desk, "table")
        desk.set_rate(10.0).result(PATIENCE_S)
        pending = desk.hand_request
        assert pending is not None
        assert "+10 °/s" in pending.message.text()
        finding = desk.confirm_set().result(PATIENCE_S)
        assert finding is not None
        assert not finding.felt
        assert desk.hand_request is None
        assert table_live_when_read(desk) == 10.0
    finally:
        desk.close()


def table_live_when_read(desk: InstrumentDesk) -> float:
    until(lambda: table_live(desk).state.demanded_rate_dps != 0.0)
    return table_live(desk).state.demanded_rate_dps


def test_bench_files_are_kept_and_changed(tmp_path: Path, drivers: Drivers) -> None:
    benches = InstrumentBenches(tmp_path / "benches", drivers)
    assert benches.names() == ()
    bench = benches.with_instrument({}, "table", "acutrol", {"link": {"host": "10.0.0.7"}})
    benches.save("Table room 2", bench)
    assert benches.names() == ("Table room 2",)
    assert benches.load("Table room 2")["table"]["link"] == {"host": "10.0.0.7"}
    driver = benches.driver_of(bench, "table")
    assert driver is catalogue.ACUTROL
    assert benches.driver_of(bench, "supply") is None
    benches.save("Table room 2", benches.without_instrument(bench, "table"))
    assert "table" not in benches.load("Table room 2")
    benches.remove("Table room 2")
    assert benches.names() == ()
    for name in ("../outside", "", ".hidden", "a/b"):
        with pytest.raises(InputError):
            benches.save(name, {})


def test_settings_that_the_driver_does_not_take_are_refused(tmp_path: Path, drivers: Drivers) -> None:
    benches = InstrumentBenches(tmp_path, drivers)
    with pytest.raises(InputError, match="lin"):
        benches.with_instrument({}, "table", "acutrol", {"lin": {"host": "10.0.0.7"}})
    with pytest.raises(InputError, match="did you mean “acutrol”"):
        benches.with_instrument({}, "table", "acutrl", {})


@pytest.mark.parametrize(
    "driver", [pytest.param(one, id=f"{one.kind} {one.name}") for one in house_drivers().found.values()]
)
def test_every_setting_of_every_driver_survives_the_form(driver: Driver) -> None:
    for field in setting_fields(driver):
        text = field.default if field.default not in ("", "inf", "-inf") else _some(field.kind)
        table = with_setting({"driver": driver.name}, field, text)
        assert setting(table, field) == text
        assert with_setting(table, field, "") == {"driver": driver.name}


def _some(kind: str) -> str:
    return {"number": "1.5", "whole": "3", "text": "words", "switch": "true", "toml": "[1, 2]"}[kind]


def test_a_number_that_is_none_is_refused() -> None:
    field = next(f for f in setting_fields(catalogue.ACUTROL) if f.path == "limits.max_rate_dps")
    with pytest.raises(InputError, match="max_rate_dps"):
        with_setting({}, field, "fast")


def test_languages_of_tables_come_along(drivers: Drivers, tmp_path: Path) -> None:
    benches = InstrumentBenches(tmp_path, drivers)
    languages = table_languages()
    assert languages
    for template in languages.values():
        benches.with_instrument(
            {}, "table", "ascii", {"link": {"host": "h", "port": 1}, "template": template}
        )


def test_pulling_the_plug_is_timed_from_sample_to_sample() -> None:
    test = UnplugTest()
    test.lost(5.0, 4.0)  # nobody has begun
    test.begin()
    test.arrived(10.0)  # not pulled yet
    test.lost(11.3, 10.5)
    test.lost(12.0, 10.5)
    test.arrived(14.5)
    verdict = test.verdict
    assert verdict is not None
    assert "0.8 s" in verdict.text()
    assert "4.0 s" in verdict.text()
