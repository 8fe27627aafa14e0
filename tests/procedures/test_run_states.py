"""The transition table of a run."""

from __future__ import annotations

from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.procedures.events import RunState
from ahrs_lab.procedures.run_states import TRANSITIONS, RunStates, RunTrigger

STATES: tuple[RunState, ...] = get_args(RunState)
TRIGGERS: tuple[RunTrigger, ...] = get_args(RunTrigger)
ENDS = {"done", "aborted", "failed"}


def test_every_state_has_its_row_and_every_state_can_be_reached() -> None:
    assert set(TRANSITIONS) == set(STATES)
    reached = {"idle"} | {state for row in TRANSITIONS.values() for state in row.values()}
    assert reached == set(STATES)


def test_only_the_ends_lead_nowhere() -> None:
    assert {state for state, row in TRANSITIONS.items() if not row} == ENDS


@pytest.mark.parametrize("state", [state for state in STATES if state not in ENDS])
def test_every_run_that_has_not_ended_can_be_aborted_and_fails_only_into_an_end(state: RunState) -> None:
    assert TRANSITIONS[state]["abort"] == "aborting"
    if state != "idle":
        assert TRANSITIONS[state]["fail"] in ENDS


def test_nothing_but_its_end_leads_out_of_aborting() -> None:
    assert {t for t, state in TRANSITIONS["aborting"].items() if state != "aborting"} == {"finish", "fail"}
    assert {TRANSITIONS["aborting"]["finish"], TRANSITIONS["aborting"]["fail"]} == {"aborted"}


@given(st.lists(st.sampled_from(TRIGGERS)))
def test_no_sequence_of_triggers_leaves_the_table(triggers: list[RunTrigger]) -> None:
    states = RunStates()
    for trigger in triggers:
        before = states.state
        following = TRANSITIONS[before].get(trigger)
        if following is None:
            with pytest.raises(RuntimeError, match=f"{before} cannot {trigger}"):
                states.fire(trigger)
            assert states.state == before
        else:
            assert states.fire(trigger) == following == states.state


@given(st.lists(st.sampled_from(TRIGGERS)))
def test_what_people_ask_for_out_of_place_is_let_go(triggers: list[RunTrigger]) -> None:
    states = RunStates()
    for trigger in triggers:
        before = states.state
        following = TRANSITIONS[before].get(trigger, before)
        assert states.offer(trigger) == (following != before)
        assert states.state == following
