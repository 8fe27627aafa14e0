"""The end of every run, whatever happened: table stopped, then supply off, each with a time limit.

An instrument may throw or never answer; the other one is made safe all the same, and what failed is told.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TypeVar

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.by_hand import SetByHand
from ahrs_lab.instruments.interfaces import Bench, TableState
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.messages import Message
from ahrs_lab.procedures.figures import figure

ANSWER_LIMIT_S = 3.0
"""Wall time that one call to an instrument may take here."""
_REST_MARGIN_S = 5.0
_LOOKS = 400

_T = TypeVar("_T")


def make_safe(
    bench: Bench, answer_limit_s: float = ANSWER_LIMIT_S, look: Callable[[], None] = lambda: None
) -> tuple[Message, ...]:
    """Stop the table, wait until it rests, switch the supply off; ``look`` is called before each look at the
    table. Returns what did not work, never raises an Exception."""
    problems: list[Message] = []
    stopped = _attempt(bench.table.stop, answer_limit_s, problems, _TABLE_NOT_STOPPED)
    if not (stopped and _comes_to_rest(bench, answer_limit_s, problems, look)):
        # The brake is what is left where the drive does not obey.
        _attempt(bench.table.disable, answer_limit_s, problems, _TABLE_NOT_DISABLED)
        _attempt(bench.table.stop, answer_limit_s, problems, _TABLE_NOT_STOPPED)
    if not _attempt(bench.supply.off, answer_limit_s, problems, _SUPPLY_NOT_OFF):
        _attempt(bench.supply.off, answer_limit_s, problems, _SUPPLY_NOT_OFF)
    return tuple(dict.fromkeys(problems))


def _table_not_stopped(reason: str | Message) -> Message:
    return Message("The table could not be stopped ({reason}): use its own stop button.", reason=reason)


def _table_not_disabled(reason: str | Message) -> Message:
    return Message("The table could not be braked ({reason}): use the emergency stop.", reason=reason)


def _supply_not_off(reason: str | Message) -> Message:
    return Message("The supply could not be switched off ({reason}): switch it off by hand.", reason=reason)


_Telling = Callable[[str | Message], Message]
_TABLE_NOT_STOPPED: _Telling = _table_not_stopped
_TABLE_NOT_DISABLED: _Telling = _table_not_disabled
_SUPPLY_NOT_OFF: _Telling = _supply_not_off


def _attempt(call: Callable[[], object], limit_s: float, problems: list[Message], telling: _Telling) -> bool:
    try:
        within(limit_s, call)
    except AhrsLabError as error:
        problems.append(telling(error.message))
    except Exception as error:
        problems.append(telling(f"{type(error).__name__}: {error}"))
    else:
        return True
    return False


def _comes_to_rest(bench: Bench, limit_s: float, problems: list[Message], look: Callable[[], None]) -> bool:
    """Wait for standstill, as long as the table needs from its present rate and a margin."""
    try:
        within(limit_s, look)
        state: TableState = within(limit_s, bench.table.state)
        acceleration = max(bench.table.limits.max_acceleration_dps2, 1e-3)
        allowed = 1.5 * abs(state.rate_dps) / acceleration + patient_s(bench.clock, _REST_MARGIN_S)
        end, wall_end = bench.clock.now_s() + allowed, time.monotonic() + allowed + _REST_MARGIN_S
        for _ in range(_LOOKS):
            if not state.moving:
                return True
            if bench.clock.now_s() >= end or time.monotonic() >= wall_end:
                break
            bench.clock.wait(allowed / 100.0)
            within(limit_s, look)
            state = within(limit_s, bench.table.state)
    except Exception as error:
        problems.append(_table_not_stopped(f"{type(error).__name__}: {error}"))
        return False
    if isinstance(bench.table, SetByHand):
        problems.append(_still_turns_by_hand(state))
    else:
        problems.append(_table_not_stopped(Message("it is still turning")))
    return False


def _still_turns_by_hand(state: TableState) -> Message:
    return Message(
        "The rate table is set by hand and was still turning at {rate} °/s when the run ended: bring it to "
        "rest by hand.",
        rate=round(state.rate_dps, 1),
    )


def within(limit_s: float, call: Callable[[], _T]) -> _T:
    """The result of ``call``, or its exception; InstrumentError where it takes longer than ``limit_s`` of
    wall time. The call then goes on in a daemon thread: Python cannot end it."""
    results: list[_T] = []
    failures: list[BaseException] = []

    def work() -> None:
        try:
            results.append(call())
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=work, name="instrument-call", daemon=True)
    thread.start()
    thread.join(limit_s)
    if failures:
        raise failures[0]
    if not results:
        raise InstrumentError("no answer within {limit} s", limit=figure(limit_s))
    return results[0]
