"""Limits on the screen: entered in the job's form, judged on the page Results, capability in Set-up."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from ahrs_lab.messages import Message
from ahrs_lab.metrology.best_capability import BestCapability, capability_from_json, capability_to_json
from ahrs_lab.metrology.conformity import DecisionRule, judge
from ahrs_lab.metrology.limits import LIMIT_UNITS, Limit, Measured
from ahrs_lab.metrology.requirements import (
    Requirements,
    ResultUnits,
    requirements_from_json,
    requirements_to_json,
)
from ahrs_lab.metrology.result import Uncertainty
from ahrs_lab.ui.pages.jobs.editor import draft_of
from ahrs_lab.ui.pages.jobs.limits_model import LimitTexts, limit_of_texts, texts_of
from ahrs_lab.ui.pages.results.limit_bar import limit_bar
from ahrs_lab.ui.widgets import Label
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.pages.conftest import Screens

LIMITS = (
    Limit("K", -2350.0, 2350.0, "ppm", nominal=1.0),
    Limit("B", None, 11.0, "deg/h"),
    Limit("L", -2.48, 3.025, "arcmin"),
)
NON_BINARY = DecisionRule("non-binary", 1.0, probability=True)


def ask(screens: Screens, asked: Requirements) -> str:
    """Give the measured job these requirements."""
    number = screens.number("measured")
    draft = replace(draft_of(screens.laboratory.job(number)), limits_json=requirements_to_json(asked))
    assert screens.desk.actor is not None
    screens.laboratory.update_job(number, draft, screens.desk.actor)
    return number


def judged(screens: Screens, qtbot: QtBot, asked: Requirements) -> None:
    screens.desk.open(ask(screens, asked), "results")
    screens.settle(qtbot)


def words(screens: Screens) -> dict[str, str]:
    return {k: row.verdict_word() for card in screens.results.cards.values() for k, row in card.rows.items()}


# results


def test_the_banner_says_verdict_and_rule(screens: Screens, qtbot: QtBot) -> None:
    judged(screens, qtbot, Requirements(LIMITS, NON_BINARY))
    assert screens.results.verdict.title() == "Conditional fail"
    assert "8 of 12 pass" in screens.results.verdict.text()
    assert "non-binary with guard band w = U (ILAC-G8)" in screens.results.verdict.text()
    found = words(screens)
    assert (found["K.x"], found["B.x"], found["L.zy"]) == (
        "Conditional pass",
        "Conditional fail",
        "Cond. pass",
    )
    assert found["K.y"] == "Pass"
    row = screens.results.cards["zero_offset"].rows["B.x"]
    assert row.accessibleName().endswith("Conditional fail")
    assert row.toolTip() == "Conditional fail"


@pytest.mark.parametrize(
    ("high", "kind", "title"),
    [
        (20.0, "guard-band", "Pass: all values within their limits"),
        (11.2, "guard-band", "Fail: not all values conform"),
        (11.2, "simple", "Pass: all values within their limits"),
        (11.2, "non-binary", "Conditional pass"),
    ],
)
def test_each_verdict_has_its_title(
    screens: Screens, qtbot: QtBot, high: float, kind: str, title: str
) -> None:
    rule = DecisionRule(kind)  # type: ignore[arg-type]
    judged(screens, qtbot, Requirements((Limit("B", None, high, "deg/h"),), rule))
    assert screens.results.verdict.title() == title
    assert words(screens)["K.x"] == ""


def test_limits_that_cannot_be_judged_are_said(screens: Screens, qtbot: QtBot) -> None:
    narrow = Requirements((Limit("B", -0.3, 0.3, "deg/h"),), DecisionRule("guard-band"))
    judged(screens, qtbot, narrow)
    assert screens.results.verdict.title() == "Conformity cannot be stated"
    assert "no value can pass" in screens.results.verdict.text()


def test_units_begin_as_the_job_asks(screens: Screens, qtbot: QtBot) -> None:
    judged(screens, qtbot, Requirements(units=ResultUnits("ppm", "deg/s", "arcsec")))
    units = [card.unit() for card in screens.results.cards.values()]
    assert [unit.key for unit in units if unit is not None] == ["ppm", "dps", "arcsec"]


def test_a_raised_u_is_shown_and_said(screens: Screens, qtbot: QtBot) -> None:
    profile = replace(
        screens.laboratory.profile(), capability_json=capability_to_json(BestCapability(K_relative=3e-5))
    )
    assert screens.desk.actor is not None
    screens.laboratory.set_profile(profile, screens.desk.actor)
    judged(screens, qtbot, Requirements())
    assert screens.results.cards["scale_factor"].rows["K.x"].texts().expanded == "0.000\u2009030"
    assert "U raised to the CMC: 3" in screens.results.verdict.text()
    assert any("Kx, Ky, Kz" in text for text in screens.results.findings.texts)
    screens.results.choose("K.x")
    assert "0.000\u2009021" in screens.results.budget._sum.text()
    assert "reported: U = 0.000\u2009030 (CMC)" in screens.results.budget._sum.text()


@pytest.mark.parametrize("language", ["en", "zh"])
def test_nothing_is_cut_with_limits(screens: Screens, qtbot: QtBot, language: Literal["en", "zh"]) -> None:
    screens.look.language.set_language(language)
    judged(screens, qtbot, Requirements(LIMITS, NON_BINARY))
    assert clipped_texts(screens.window) == []
    assert outside(screens.window) == []
    screens.desk.open(screens.number("measured"), "jobs")
    screens.jobs.editor.tabs.setCurrentIndex(1)
    screens.settle(qtbot)
    assert clipped_texts(screens.window) == []


def test_a_bar_has_its_limits_near_the_ends_and_the_guard_band_inside() -> None:
    bar = limit_bar(
        judge(
            Measured("B_x", 0.0, "deg/s", Uncertainty(0.5, 1.0, 2.0, math.inf, "gum")),
            Limit("B", -10.0, 10.0, "deg/s"),
            DecisionRule("guard-band"),
        )
    )
    assert bar.value == pytest.approx(0.5)
    assert bar.low is not None
    assert bar.accept_low is not None
    assert bar.high is not None
    assert bar.accept_high is not None
    assert 0.0 < bar.low < bar.accept_low < bar.value_low < bar.value < bar.value_high < bar.accept_high
    assert bar.accept_high < bar.high < 1.0


@pytest.mark.parametrize("value", [-1e9, 0.0, 3.0, 1e9])
@pytest.mark.parametrize(("low", "high"), [(None, 3.0), (3.0, None), (-5.0, 3.0)])
def test_whatever_the_value_it_stays_on_the_bar(value: float, low: float | None, high: float | None) -> None:
    quantity = Measured("B_x", value, "deg/s", Uncertainty(0.5, 1.0, 2.0, math.inf, "gum"))
    bar = limit_bar(judge(quantity, Limit("B", low, high, "deg/s"), DecisionRule()))
    assert 0.0 <= bar.value_low <= bar.value <= bar.value_high <= 1.0
    assert (bar.low is None, bar.high is None) == (low is None, high is None)


# the job's form


def test_limits_are_typed_and_saved(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("measured"), "jobs")
    editor = screens.jobs.editor
    editor.tabs.setCurrentIndex(1)
    form = editor.limits
    form.add_button.click()
    assert form.refusal() is not None  # no bound yet
    QTest.keyClicks(form.lines[0].low.line, "-2000")
    form.lines[0].high.line.setText("\N{MINUS SIGN}500.5")
    form.rule.set_key("guard-band")
    form.rule.edited.emit()
    assert form.r.editor.isEnabled()
    form.r.line.clear()
    QTest.keyClicks(form.r.line, "0.5")
    form.repeatability.click()
    assert form.refusal() is None
    assert editor.save(), screens.notices
    kept = requirements_from_json(screens.laboratory.job(editor.number()).limits_json)
    assert kept.limits == (Limit("K", -2000.0, -500.5, "ppm", nominal=1.0),)
    assert kept.rule == DecisionRule("guard-band", 0.5)
    assert kept.repeatability
    form.repeatability.click()
    form.lines[0].remove.click()
    assert form.text() == requirements_to_json(Requirements(rule=DecisionRule("guard-band", 0.5)))


def test_a_limit_that_is_none_is_said_and_not_saved(screens: Screens, qtbot: QtBot) -> None:
    number = ask(screens, Requirements(LIMITS, NON_BINARY))
    screens.desk.open(number, "jobs")
    editor = screens.jobs.editor
    editor.limits.lines[1].high.line.clear()
    QTest.keyClicks(editor.limits.lines[1].high.line, "ten")
    assert not editor.save()
    assert "“ten” is not a number." in [label.text() for label in editor.limits.findChildren(Label)]
    assert screens.notices == []
    qtbot.waitUntil(lambda: "A limit is not right: see the tab Limits." in editor.before_run.texts())
    assert not editor.start_button.isEnabled()
    assert requirements_from_json(screens.laboratory.job(number).limits_json).limits == LIMITS


def test_another_quantity_takes_a_unit_of_its_own(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(ask(screens, Requirements(LIMITS[:1])), "jobs")
    one = screens.jobs.editor.limits.lines[0]
    assert one.nominal.editor.isEnabled()
    one.quantity.set_key("L_yx")
    one.quantity.edited.emit()
    assert one.unit.key() == "arcmin"
    assert not one.nominal.editor.isEnabled()
    assert one.limit() == Limit("L_yx", -2350.0, 2350.0, "arcmin")


def test_a_signed_job_s_limits_only_show(screens: Screens, qtbot: QtBot) -> None:
    screens.desk.open(screens.number("checked"), "jobs")
    form = screens.jobs.editor.limits
    assert not form.rule.editor.isEnabled()
    assert not form.add_button.isVisibleTo(form)


def test_a_text_of_the_records_that_cannot_be_read_is_said_and_kept(screens: Screens, qtbot: QtBot) -> None:
    form = screens.jobs.editor.limits
    form.set_text('{"limits": 3}')
    assert form.text() == '{"limits": 3}'
    assert form._refusal.isVisibleTo(form)
    form.set_text("")
    assert not form._refusal.isVisibleTo(form)


@pytest.mark.parametrize(
    ("texts", "says"),
    [
        (LimitTexts("B", "x", "1", "deg/h"), "not a number"),
        (LimitTexts("B", "nan", "1", "deg/h"), "not a number"),
        (LimitTexts("B", "", "", "deg/h"), "neither"),
        (LimitTexts("K", "1", "2", "ppm", ""), "nominal"),
    ],
)
def test_what_is_typed_wrong_is_named(texts: LimitTexts, says: str) -> None:
    found = limit_of_texts(texts)
    assert isinstance(found, Message)
    assert says in found.text()


def test_a_limit_s_texts_are_that_limit() -> None:
    for letter, units in LIMIT_UNITS.items():
        for unit, kind in units.items():
            limit = Limit(letter, -12345.678, 1e-7, unit, 131.072 if kind.relative else None)
            assert limit_of_texts(texts_of(limit)) == limit


# set-up


def test_the_capability_is_kept_with_the_laboratory(screens: Screens, qtbot: QtBot) -> None:
    panel = screens.setup.profile
    panel.B.set_text("2.5e-6")
    panel.save()
    stated = capability_from_json(screens.laboratory.profile().capability_json)
    assert stated == BestCapability(B_dps=2.5e-6)
    panel.refresh()
    assert panel.B.text() == "2.5e-06"
    panel.K.set_text("-1")
    panel.save()
    assert "not negative" in screens.notices[-1][1]
    assert capability_from_json(screens.laboratory.profile().capability_json) == stated
