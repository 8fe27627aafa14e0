"""Experimental and generic tables: their conversations; and the table that a person turns."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ahrs_lab.errors import InputError, InstrumentError
from ahrs_lab.instruments.drivers.tables.actidyn import ActidynSettings, ActidynTable
from ahrs_lab.instruments.drivers.tables.ascii_table import (
    AsciiTable,
    AsciiTableSettings,
    template_examples,
    template_from_text,
)
from ahrs_lab.instruments.drivers.tables.atl import AtlSettings, AtlTable
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


def test_every_polled_table_is_one() -> None:
    assert all(issubclass(kind, PolledTable) for kind in (AtlTable, ActidynTable, AsciiTable))
