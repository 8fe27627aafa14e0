"""The states of a run, in one table: what may happen in each, and what it leads to.

``pause``, ``resume`` and ``abort`` come from people at any moment, the rest from the runner. What the table
does not list cannot happen: :meth:`RunStates.fire` raises, :meth:`RunStates.offer` lets it go.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Literal

from ahrs_lab.procedures.events import RunState

RunTrigger = Literal["start", "pause", "hold", "resume", "ask", "answer", "abort", "finish", "fail"]

TRANSITIONS: Mapping[RunState, Mapping[RunTrigger, RunState]] = {
    "idle": {"start": "running", "abort": "aborting"},
    "running": {
        "pause": "pausing",
        "ask": "waiting",
        "abort": "aborting",
        "finish": "done",
        "fail": "failed",
    },
    "pausing": {
        "resume": "running",
        "hold": "paused",
        "ask": "waiting",
        "abort": "aborting",
        "finish": "done",
        "fail": "failed",
    },
    "paused": {"resume": "running", "abort": "aborting", "fail": "failed"},
    "waiting": {"answer": "running", "abort": "aborting", "fail": "failed"},
    # Nothing leads out of aborting but its end, whatever happens meanwhile.
    "aborting": {
        "start": "aborting",
        "hold": "aborting",
        "ask": "aborting",
        "answer": "aborting",
        "abort": "aborting",
        "finish": "aborted",
        "fail": "aborted",
    },
    "done": {},
    "aborted": {},
    "failed": {},
}


class RunStates:
    """The state of one run; every method may be called from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._state: RunState = "idle"

    @property
    def state(self) -> RunState:
        """The state now."""
        return self._state

    def is_in(self, state: RunState) -> bool:
        """Whether the run is in ``state`` now."""
        return self._state == state

    def fire(self, trigger: RunTrigger) -> RunState:
        """Follow the table; RuntimeError where it has no such way, which is a fault of the runner."""
        with self._lock:
            following = TRANSITIONS[self._state].get(trigger)
            if following is None:
                raise RuntimeError(f"a run that is {self._state} cannot {trigger}")
            self._state = following
            return following

    def offer(self, trigger: RunTrigger) -> bool:
        """Follow the table where it has such a way; True where the state is another one now."""
        with self._lock:
            following = TRANSITIONS[self._state].get(trigger)
            if following is None or following == self._state:
                return False
            self._state = following
            return True
