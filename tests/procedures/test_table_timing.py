"""A table that is asked over a late wire: no rate is blamed that was held, none passed that was not."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ahrs_lab.instruments.drivers.tables.acutrol import AcutrolSettings, AcutrolTable
from ahrs_lab.instruments.drivers.tables.polled_table import Polling
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.interfaces import TableState
from ahrs_lab.instruments.links.link_settings import LinkSettings
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder
from ahrs_lab.procedures.table_trace import TableTrace
from ahrs_lab.recording.clean_rows import CleanRows
from ahrs_lab.recording.finding import Finding
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import Samples
from ahrs_lab.recording.segment import Segment
from ahrs_lab.recording.table_check import check_table
from tests.instruments.fake_clock import FakeClock
from tests.instruments.fake_link import FakeLink
from tests.instruments.tables.plant import Plant

SAMPLE_HZ = 100.0
DURATION_S = 36.0


class OffPlant(Plant):
    """Turns at ``factor`` times its demand until ``until_s``."""

    factor = 1.0
    until_s = math.inf
    honest = True
    """Whether it reports its own rate, and not the demand's."""

    def _step(self, step: float) -> None:
        before = self.angle_deg
        super()._step(step)
        if self._t_s < self.until_s:
            self.angle_deg += (self.factor - 1.0) * (self.angle_deg - before)

    def state(self) -> TableState:
        seen = super().state()
        factor = self.factor if self.honest and self._t_s < self.until_s else 1.0
        return replace(seen, rate_dps=factor * seen.rate_dps)


class LateWire:
    """A table behind a wire and a computer that delay: each request and each answer takes its time, some tens
    of milliseconds now and then, always the same ones."""

    def __init__(self, typical_s: float, worst_s: float, plant: Callable[[FakeClock], Plant]) -> None:
        self.clock = FakeClock()
        self.plant = plant(self.clock)
        self._rng = np.random.default_rng(5)
        self._typical_s, self._worst_s = typical_s, worst_s
        self.samples = Samples()
        responder = AclResponder(self.plant)

        def answer(request: bytes) -> bytes:
            self._delay()
            said = responder.feed(request)
            self._delay()
            return said

        settings = AcutrolSettings(
            LinkSettings(host="table"), limits=SoftLimits(400.0, 200.0), polling=Polling(poll_hz=40.0)
        )
        self.table = AcutrolTable(settings, FakeLink(answer), self.clock)
        self.table.connect()
        self.table.enable()

    def _delay(self) -> None:
        busy = self._rng.random() < 0.5
        late_s = self._rng.uniform(0.0, self._worst_s) if busy else 0.0
        self.clock.t_s += self._rng.exponential(self._typical_s) + late_s

    def recorded(self, rate_dps: float) -> tuple[Finding, ...]:
        """What the check of a segment at ``rate_dps`` finds, with the columns that a run would record."""
        self.table.set_rate(rate_dps)
        begin = self.clock.now_s() + abs(rate_dps) / 200.0 + 1.0
        trace = TableTrace()
        trace.keep(10.0 * DURATION_S)
        while self.clock.now_s() < begin + DURATION_S + 1.0:
            self.clock.t_s += 0.025
            self.table.poll()
            trace.add(self.table.log(), self.table.state())
        t_s = np.arange(1, round(DURATION_S * SAMPLE_HZ) + 1) / SAMPLE_HZ
        self.samples = Samples({"t_s": t_s, **trace.columns(begin + t_s)})
        return checked(rate_dps, self.samples)


def checked(rate_dps: float, samples: Samples) -> tuple[Finding, ...]:
    """What the check of a segment at ``rate_dps`` finds."""
    rows = CleanRows(samples, np.arange(len(samples)) + 2, 0, 1.0 / SAMPLE_HZ)
    segment = Segment("sf", Orientation("UEN"), "scale_factor", "x", "rate", rate_dps)
    found = FindingList(segment)
    check_table(segment, rows, "deg/s", found)
    return found.finished()


def late(plant: Callable[[FakeClock], Plant]) -> LateWire:
    """A busy computer: every other message is late by up to 40 ms."""
    return LateWire(0.002, 0.04, plant)


def off(factor: float, *, honest: bool = True, until_s: float = math.inf) -> Callable[[FakeClock], Plant]:
    def make(clock: FakeClock) -> Plant:
        plant = OffPlant(clock, acceleration=200.0)
        plant.factor, plant.honest, plant.until_s = factor, honest, until_s
        return plant

    return make


@pytest.mark.parametrize("rate_dps", [0.5, 5.0, 25.0, -100.0, 200.0])
def test_a_rate_that_was_held_is_not_blamed_on_a_late_wire(rate_dps: float) -> None:
    wire = late(off(1.0))
    assert wire.recorded(rate_dps) == ()
    assert wire.samples["table_doubt_s"].max() > 0.02, "or the wire was not late"


def test_the_same_readings_taken_for_exact_would_be_blamed() -> None:
    wire = late(off(1.0))
    assert wire.recorded(200.0) == ()
    columns = {name: column for name, column in wire.samples.columns.items() if name != "table_doubt_s"}
    assert [found.kind for found in checked(200.0, Samples(columns))] == ["rate"]


@pytest.mark.parametrize("rate_dps", [25.0, -100.0, 200.0])
def test_a_rate_that_is_off_by_a_thousandth_is_found_on_a_late_wire(rate_dps: float) -> None:
    (found,) = late(off(1.001)).recorded(rate_dps)
    assert (found.kind, found.severity) == ("rate", "unusable")
    assert found.what.params["mean"] == pytest.approx(1.001 * rate_dps, rel=2e-4)


def test_a_rate_that_is_lost_for_a_while_is_found_on_a_late_wire() -> None:
    (found,) = late(off(1.002, until_s=5.0)).recorded(200.0)
    assert (found.kind, found.severity) == ("rate", "note")
    assert found.what.params["worst"] == pytest.approx(200.4, abs=0.1)


def test_a_table_that_reports_its_demand_is_found_out_by_its_angle() -> None:
    (found,) = late(off(1.004, honest=False)).recorded(100.0)
    assert (found.kind, found.severity) == ("rate", "unusable")


def test_on_a_quick_wire_the_angles_tell_what_the_clause_asks_for() -> None:
    (found,) = LateWire(2e-5, 0.0, off(1.0006, honest=False)).recorded(100.0)
    assert (found.kind, found.severity) == ("rate", "unusable")
    assert LateWire(2e-5, 0.0, off(1.0)).recorded(100.0) == ()


def test_what_cannot_be_told_is_said() -> None:
    rows = np.arange(1, 2001)
    samples = Samples(
        {
            "t_s": rows / SAMPLE_HZ,
            "table_angle_deg": rows / SAMPLE_HZ * 100.0,
            "table_doubt_s": np.full(len(rows), 0.02),
        }
    )
    (found,) = checked(100.0, samples)
    assert found.severity == "note"
    assert "cannot be told closer than 0.24 %" in str(found.what)
