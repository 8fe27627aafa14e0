"""Experimental and generic tables: their conversations; and the table that a person turns."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.typing import NDArray

from ahrs_lab.errors import AbortedError, InputError, InstrumentError
from ahrs_lab.instruments.drivers.tables.actidyn import ActidynSettings, ActidynTable
from ahrs_lab.instruments.drivers.tables.ascii_table import (
    AsciiTable,
    AsciiTableSettings,
    template_examples,
    template_from_text,
)
from ahrs_lab.instruments.drivers.tables.atl import AtlSettings, AtlTable
from ahrs_lab.instruments.drivers.tables.manual import ManualRequest, ManualSettings, ManualTable
from ahrs_lab.instruments.drivers.tables.polled_table import PolledTable
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.link_settings import LinkSettings
from tests.instruments.fake_clock import FakeClock
from tests.instruments.fake_link import FakeLink, expected_conversation
from tests.instruments.tables.plant import Plant

LINK = LinkSettings(device="COM1")
LIMITS = SoftLimits(100.0, 50.0)


def test_atl_conversation() -> None:
    prompt = b">\r\n"
    talk = [
        (b"PPO\r\n", b"350.5\r\n" + prompt),
        (b"PVE\r\n", b"0.0\r\n" + prompt),
        (b"STO\r\n", prompt),
        (b"ACL 50\r\n", prompt),
        (b"JOG 0\r\n", b""),
        (b"PPO\r\n", prompt + b"350.5\r\n" + prompt),  # the prompt that JOG owed comes first
        (b"PVE\r\n", b"0.0\r\n" + prompt),
        (b"JOG 25.5\r\n", b""),
        (b"STO\r\n", prompt),
    ]
    with expected_conversation(talk) as link:
        clock = FakeClock()
        table = AtlTable(AtlSettings(LINK, LIMITS, reply_timeout_s=0.05), link, clock)
        assert "experimental" in table.connect()
        table.enable()
        assert table.state().angle_deg == 350.5
        table.set_rate(25.5)
        table.stop()


def test_actidyn_conversation() -> None:
    talk = [
        (b"RMT 0\n", b""),
        (b"USR 0,1,secret\n", b""),
        (b"PRV 1,?\n", b"PRV1 2,10.0,0.0\n"),
        (b"ALC 0\n", b""),
        (b"MOD 1,1\n", b""),
        (b"RAT 1,0.000000,50.000000\n", b""),
        (b"MOD 1,RAT\n", b""),
        (b"PRV 1,?\n", b"PRV1 2,10.0,0.0\n"),
        (b"ALC 0\n", b""),
        (b"POS 1,30.000000,20.000000\n", b"OK\n"),
        (b"MOD 1,POS\n", b""),
        (b"MOD 1,STP\n", b""),
        (b"MOD 1,OFF\n", b""),
    ]
    with expected_conversation(talk) as link:
        clock = FakeClock()
        settings = ActidynSettings(LINK, code="secret", limits=LIMITS, reply_timeout_s=0.05)
        table = ActidynTable(settings, link, clock)
        assert "experimental" in table.connect()
        table.enable()
        table.move_to(30.0, 20.0)
        table.disable()


def test_the_actidyn_drive_hears_from_us_before_it_drops_out() -> None:
    heard: list[float] = []
    clock = FakeClock()

    def answer(request: bytes) -> bytes:
        if request == b"ALC 0\n":
            heard.append(clock.now_s())
        return b"PRV1 2,0.0,0.0\n" if request.startswith(b"PRV") else b""

    table = ActidynTable(ActidynSettings(LINK, limits=LIMITS), FakeLink(answer), clock)
    table.connect()
    table.enable()
    clock.on_step = table.poll
    clock.wait(120.0)
    assert max(np.diff([*heard, clock.now_s()])) < 11.0


class AsciiPlant:
    """Speaks the example language "example-servo" for a plant."""

    def __init__(self, clock: FakeClock) -> None:
        self.plant = Plant(clock, acceleration=50.0)
        self.speed = 10.0
        self.fault = "0"

    def __call__(self, request: bytes) -> bytes:
        text = request.decode().removesuffix("\r\n")
        word, _, number = text.partition(" ")
        if text == "VER?":
            return b"V1.2\r\n"
        if text == "POS?":
            state = self.plant.state()
            return f"{state.angle_deg % 360.0:.4f},{state.rate_dps:.4f},{self.fault}\r\n".encode()
        if word == "JOG":
            self.plant.set_rate(float(number))
        elif word == "SPEED":
            self.speed = float(number)
        elif word == "MOVE":
            here = self.plant.state().angle_deg
            self.plant.move_to(here + (float(number) - here + 180.0) % 360.0 - 180.0, self.speed)
        elif word == "STOP":
            self.plant.stop()
        elif not re.fullmatch("REMOTE|RESET|SERVO ON|SERVO OFF", text):
            return b"ERR 5\r\n"
        return b"OK\r\n"


def ascii_table(clock: FakeClock, link: Link, example: str = "example-servo") -> AsciiTable:
    template = template_from_text(template_examples()[example], example)
    return AsciiTable(AsciiTableSettings(LINK, template, LIMITS), link, clock)


def test_a_table_of_a_template_makes_its_turns() -> None:
    clock = FakeClock()
    device = AsciiPlant(clock)
    table = ascii_table(clock, FakeLink(device))
    assert table.connect() == "Example servo table V1.2"
    table.enable()
    clock.on_step = table.poll
    for target in (3600.0, 0.0):
        table.move_to(target, 90.0)
        clock.wait(50.0)
        assert not table.state().moving
        assert device.plant.angle_deg == pytest.approx(target, abs=1e-4)
    device.fault = "E7"
    clock.wait(0.5)
    assert table.state().fault == "E7"


def test_a_table_that_does_not_wrap_is_told_the_whole_angle_in_its_own_counts() -> None:
    talk = [
        (b"TP\r", b"0\r"),
        (b"EN1\r", b""),
        (b"VM0\r", b""),
        (b"TP\r", b"0\r"),
        (b"WD\r", b""),
        (b"VP5000\r", b""),
        (b"PA-360000\r", b""),
        (b"ST\r", b""),
    ]
    with expected_conversation(talk) as link:
        table = ascii_table(FakeClock(), link, "example-counts")
        table.connect()
        table.enable()
        table.move_to(3600.0, 50.0)
        table.stop()


def test_a_refusal_shows_the_answer() -> None:
    clock = FakeClock()
    table = ascii_table(clock, FakeLink(lambda request: b"ERR 9\r\n"))
    with pytest.raises(InstrumentError, match="“ERR 9” to “REMOTE”"):
        table.connect()


def test_each_text_of_a_template_can_be_tried_and_shows_its_reply() -> None:
    clock = FakeClock()
    table = ascii_table(clock, FakeLink(AsciiPlant(clock)))
    (trial,) = table.try_template("query")
    assert trial.good
    assert trial.reply == "0.0000,0.0000,0"
    assert trial.reading is not None
    assert [t.sent for t in table.try_template("enable")] == ["RESET", "SERVO ON"]
    with pytest.raises(InputError):
        table.try_template("rate", rate_dps=101.0)
    with pytest.raises(InputError, match="no text for"):
        table.try_template("keep_alive")


def test_a_text_that_is_not_answered_shows_that() -> None:
    clock = FakeClock()
    text = template_examples()["example-servo"].replace("reply_timeout_s = 0.4", "reply_timeout_s = 0.02")
    settings = AsciiTableSettings(LINK, template_from_text(text, "x"), LIMITS)
    table = AsciiTable(settings, FakeLink(lambda request: b""), clock)
    (trial,) = table.try_template("query")
    assert (trial.reply, trial.good) == (None, False)


class Hand:
    """An operator who does what is asked, and a unit on the table that sees it with a scale error."""

    def __init__(self) -> None:
        self.clock = FakeClock()
        self.rate = 0.0
        self.scale = 1.01
        self.asked: list[ManualRequest] = []
        self.obeys = True
        self._fresh: list[tuple[float, float]] = []
        self.table = ManualTable(ManualSettings(LIMITS), self.clock, self.ask, self.rates)

    def ask(self, request: ManualRequest) -> None:
        self.asked.append(request)
        if request.kind == "position" and self.obeys:
            self.run(
                request.rate_dps * np.sign(request.travel_deg), abs(request.travel_deg) / request.rate_dps
            )
            self.run(0.0, 1.0)
        if request.kind in ("rate", "stop") and self.obeys:
            self.run(request.rate_dps, 1.0)

    def run(self, rate: float, seconds: float) -> None:
        """The table turns at ``rate``; the unit sends a sample every hundredth of a second."""
        self.rate = rate
        for _ in range(round(seconds * 100)):
            self.clock.t_s += 0.01
            self._fresh.append((self.clock.t_s, self.rate * self.scale))

    def rates(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rows = np.array(self._fresh).reshape(-1, 2)
        self._fresh.clear()
        return rows[:, 0], rows[:, 1]


def test_a_manual_table_asks_and_believes_what_the_unit_roughly_confirms() -> None:
    hand = Hand()
    hand.table.enable()
    hand.table.set_rate(40.0)
    hand.run(40.0, 2.0)
    state = hand.table.state()
    assert state.rate_dps == 40.0  # not 40.4: the unit's scale factor is not the table's
    assert state.moving
    assert "+40 °/s" in str(hand.asked[-1].message)
    hand.table.stop()
    assert hand.asked[-1].kind == "stop"
    hand.run(0.0, 1.0)
    assert not hand.table.state().moving
    asked = len(hand.asked)
    hand.table.stop()
    assert len(hand.asked) == asked


def test_a_manual_table_shows_what_the_unit_sees_where_it_disagrees() -> None:
    hand = Hand()
    hand.obeys = False
    hand.table.set_rate(40.0)
    hand.run(-40.0, 1.0)
    assert hand.table.state().rate_dps == pytest.approx(-40.4)
    log = hand.table.log()
    assert len(log.t_s) == 100
    assert np.ptp(log.angle_deg) == pytest.approx(40.4, rel=0.02)


def test_turns_made_by_hand_end_at_the_angle_asked_for() -> None:
    hand = Hand()
    hand.run(0.0, 1.0)
    hand.table.move_to(3600.0, 50.0)
    assert hand.table.state().angle_deg == 3600.0
    assert "+10 turns" in str(hand.asked[-1].message)
    hand.table.move_to(0.0, 50.0)
    assert hand.table.state().angle_deg == 0.0
    assert not hand.table.state().moving


def test_turns_that_the_unit_has_not_seen_are_refused() -> None:
    hand = Hand()
    hand.run(0.0, 1.0)
    hand.obeys = False
    with pytest.raises(InstrumentError, match="not by 3600"):
        hand.table.move_to(3600.0, 50.0)


def test_an_operator_who_gives_up_ends_it() -> None:
    hand = Hand()

    def give_up(request: ManualRequest) -> None:
        raise AbortedError("enough")

    table = ManualTable(ManualSettings(LIMITS), hand.clock, give_up, hand.rates)
    with pytest.raises(AbortedError):
        table.set_rate(10.0)
    with pytest.raises(InputError):
        table.set_rate(1000.0)


def test_every_polled_table_is_one() -> None:
    assert all(issubclass(kind, PolledTable) for kind in (AtlTable, ActidynTable, AsciiTable))
