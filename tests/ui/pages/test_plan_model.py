"""The plan's form: what it reads, what it refuses and where, what it says of the standard."""

from __future__ import annotations

import pytest

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.interfaces import TableLimits
from ahrs_lab.procedures.plan import Plan
from ahrs_lab.ui.pages.jobs.plan_model import EntryName, entries_of, plan_of_text, text_of_plan, view


def with_entry(name: EntryName, text: str) -> dict[EntryName, str]:
    return {**entries_of(Plan()), name: text}


def test_the_standard_plan_runs_and_deviates_in_nothing() -> None:
    found = view(entries_of(Plan()), Plan())
    assert found.runnable
    assert found.plan == Plan()
    assert found.deviations == ()


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("dwell", "twenty", "number"),
        ("dwell", "nan", "number"),
        ("turns", "10.5", "whole"),
        ("rates", "10, x, 30", "list"),
        ("rates", " ", "list"),
    ],
)
def test_what_cannot_be_read_is_named_at_its_entry(name: EntryName, text: str, fault: str) -> None:
    found = view(with_entry(name, text), Plan())
    assert found.plan is None
    assert not found.runnable
    assert found.faults == {name: fault}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("rates", "-100, -50, -10, 10, 50, 100"),
        ("rates", "-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6"),
        ("dwell", "12"),
        ("static", "5"),
        ("duration", "10"),
        ("turns", "0"),
    ],
)
def test_a_refusal_stands_at_the_entry_that_causes_it(name: EntryName, text: str) -> None:
    found = view(with_entry(name, text), Plan())
    assert not found.runnable
    assert list(found.refusals) == [name]


def test_a_rate_beyond_the_table_is_refused_at_the_rates() -> None:
    found = view(entries_of(Plan()), Plan(), TableLimits(max_rate_dps=250.0, max_acceleration_dps2=100.0))
    assert list(found.refusals) == ["rates"]


def test_shorter_positions_deviate_but_run() -> None:
    found = view(with_entry("duration", "600"), Plan())
    assert found.runnable
    assert len(found.deviations) == 1
    assert "600" in found.deviations[0].text()


def test_signs_and_separators_are_read_as_people_write_them() -> None:
    found = view(with_entry("rates", "−300；−200, −100，-50; 50, 100, 200, 300"), Plan())
    assert found.plan is not None
    assert found.plan.scale_factor.rates_dps == (-300.0, -200.0, -100.0, -50.0, 50.0, 100.0, 200.0, 300.0)


def test_settings_the_form_does_not_show_are_kept() -> None:
    base = plan_of_text("mounting_tolerance_deg = 1.5\n[settling]\nhold_s = 4.0\n")
    found = view(entries_of(base), base)
    assert found.plan is not None
    assert (found.plan.mounting_tolerance_deg, found.plan.settling.hold_s) == (1.5, 4.0)
    assert plan_of_text(text_of_plan(found.plan)) == found.plan


def test_a_text_that_is_no_plan_is_refused() -> None:
    with pytest.raises(InputError):
        plan_of_text("rates = [")
    with pytest.raises(InputError):
        plan_of_text("turnz = 3")
