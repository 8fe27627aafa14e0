"""A table set by hand: what it asks, and what it believes of a person's word, a unit with a scale error
looking on."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.by_hand import HandFinding, SetByHand
from ahrs_lab.instruments.drivers.tables.felt_motion import ManualSettings
from ahrs_lab.instruments.drivers.tables.manual import ManualTable
from ahrs_lab.instruments.drivers.tables.soft_limits import SoftLimits
from tests.instruments.fake_clock import FakeClock

LIMITS = SoftLimits(400.0, 100.0)


class Hand:
    """Turns the table, and the unit on it feels 1 % too much."""

    def __init__(self) -> None:
        self.clock = FakeClock()
        self.table = ManualTable(ManualSettings(LIMITS), self.clock)

    def turns(self, rate_dps: float, seconds: float) -> None:
        """At that rate for so long; a sample every hundredth of a second."""
        t = self.clock.t_s + 0.01 * np.arange(1, round(seconds * 100) + 1)
        self.clock.t_s = float(t[-1])
        self.table.feel(np.asarray(t, dtype=np.float64), np.full(len(t), 1.01 * rate_dps))

    def says_done(self, rate_dps: float) -> HandFinding:
        """… with the table at that rate while it is checked."""
        since = self.clock.t_s
        assert self.table.check(since, blind=False) is None
        self.turns(rate_dps, 2.0)
        finding = self.table.check(since, blind=False)
        assert finding is not None
        return finding


@pytest.fixture
def hand() -> Hand:
    made = Hand()
    made.table.enable()
    made.table.check(0.0, blind=True)
    made.turns(0.0, 1.0)
    return made


def test_a_demand_returns_at_once_and_says_what_to_do(hand: Hand) -> None:
    assert isinstance(hand.table, SetByHand)
    hand.table.set_rate(40.0)
    assert hand.table.request is not None
    assert hand.table.request.kind == "rate"
    assert "+40 °/s (anticlockwise" in str(hand.table.request.message)
    hand.table.set_rate(-40.0)
    assert "\N{MINUS SIGN}40 °/s (clockwise" in str(hand.table.request.message)
    with pytest.raises(InputError):
        hand.table.set_rate(1000.0)


def test_what_the_unit_roughly_confirms_is_the_rate_that_was_asked_for(hand: Hand) -> None:
    hand.table.set_rate(40.0)
    assert hand.says_done(40.0).accepted
    assert hand.table.request is None
    hand.turns(40.0, 2.0)
    state = hand.table.state()
    assert state.rate_dps == 40.0  # not 40.4: the unit's scale factor is not the table's
    assert state.moving
    assert hand.table.strayed() is None


@pytest.mark.parametrize(
    ("felt", "says"),
    [
        (
            -40.0,
            "feels \N{MINUS SIGN}40.40 °/s: the table turns the wrong way. Set it to \\+40 °/s",
        ),
        (0.0, "at rest. Set it to \\+40 °/s"),
        (44.0, "feels \\+44.44 °/s, not \\+40 °/s; up to 2 °/s off"),
    ],
)
def test_a_wrong_rate_is_refused_with_what_is_felt_and_what_to_do(hand: Hand, felt: float, says: str) -> None:
    hand.table.set_rate(40.0)
    hand.turns(felt, 1.0)
    finding = hand.says_done(felt)
    assert not finding.accepted
    assert finding.felt
    assert hand.table.request is not None
    assert hand.table.state().rate_dps == pytest.approx(1.01 * felt)
    assert re.search(says, str(finding.message))
    assert hand.says_done(40.0).accepted


def test_a_rate_that_still_changes_is_refused(hand: Hand) -> None:
    hand.table.set_rate(100.0)
    since = hand.clock.t_s
    for rate in (90.0, 97.0, 101.0, 104.0):
        hand.turns(rate, 0.5)
    finding = hand.table.check(since, blind=False)
    assert finding is not None
    assert not finding.accepted
    assert "still changes" in str(finding.message)


def test_a_table_that_stands_still_is_not_asked_to_rest(hand: Hand) -> None:
    hand.table.stop()
    assert hand.table.request is None


def test_a_table_that_turns_is_brought_to_rest_by_hand(hand: Hand) -> None:
    hand.table.set_rate(20.0)
    hand.says_done(20.0)
    hand.table.stop()
    assert hand.table.request is not None
    assert hand.table.request.kind == "rest"
    assert "Bring it to rest" in str(hand.says_done(20.0).message)
    assert hand.says_done(0.0).accepted
    assert not hand.table.state().moving


def test_a_stop_takes_a_question_back_that_nobody_has_begun_to_obey(hand: Hand) -> None:
    hand.table.set_rate(20.0)
    hand.turns(0.0, 1.0)
    hand.table.stop()
    assert hand.table.request is None


def test_turns_end_at_the_angle_asked_for_and_are_counted_with_their_sense(hand: Hand) -> None:
    hand.table.move_to(720.0, 50.0)
    assert hand.table.request is not None
    assert hand.table.request.kind == "turns"
    hand.turns(50.0, 14.4)
    assert hand.says_done(0.0).accepted
    assert hand.table.state().angle_deg == 720.0
    hand.table.move_to(0.0, 50.0)
    hand.turns(-50.0, 7.2)
    finding = hand.says_done(0.0)
    assert not finding.accepted
    assert finding.begin_again
    assert "by \N{MINUS SIGN}364°, not by \N{MINUS SIGN}720°" in str(finding.message)


def test_to_an_angle_any_way_is_good(hand: Hand) -> None:
    hand.table.move_to(90.0, 50.0)
    hand.turns(-90.0, 3.0)
    assert hand.says_done(0.0).accepted
    assert hand.table.state().angle_deg == 90.0
    hand.table.move_to(90.0, 50.0)
    assert hand.table.request is None
    hand.table.move_to(180.0, 50.0)
    hand.turns(45.0, 1.0)
    finding = hand.says_done(0.0)
    assert not finding.accepted
    assert "Turn it to 180° on its scale" in str(finding.message)


def test_after_spinning_the_angle_is_the_operators_word_and_rest_is_felt(hand: Hand) -> None:
    hand.table.set_rate(100.0)
    hand.says_done(100.0)
    hand.turns(100.0, 30.0)
    hand.table.stop()
    hand.says_done(0.0)
    hand.table.move_to(hand.table.state().angle_deg + 57.0, 50.0)
    assert not hand.says_done(10.0).accepted
    assert hand.says_done(0.0).accepted


def test_a_rate_that_is_not_kept_is_told_once(hand: Hand) -> None:
    hand.table.set_rate(40.0)
    hand.says_done(40.0)
    hand.turns(40.0, 5.0)
    hand.turns(30.0, 2.5)
    strayed = hand.table.strayed()
    assert strayed is not None
    assert "has not kept +40 °/s" in str(strayed.message)
    assert hand.table.strayed() is None


def test_without_a_unit_that_feels_it_the_word_is_taken(hand: Hand) -> None:
    hand.clock.t_s += 100.0
    hand.table.set_rate(40.0)
    finding = hand.table.check(hand.clock.t_s, blind=True)
    assert finding is not None
    assert finding.accepted
    assert not finding.felt
    assert hand.table.state().moving


def test_the_angle_is_the_integral_of_what_is_felt_until_it_is_confirmed(hand: Hand) -> None:
    hand.table.log()
    hand.table.set_rate(40.0)
    hand.turns(-40.0, 1.0)
    log = hand.table.log()
    assert len(log.t_s) == 100
    assert np.ptp(log.angle_deg) == pytest.approx(40.4, rel=0.02)
