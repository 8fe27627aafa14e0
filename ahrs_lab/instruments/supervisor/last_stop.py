"""What the supervisor does when the application is gone: rate to zero, mode off, supply off, in this order.

Each call has a time limit and is tried although the one before failed: an instrument that does not answer
must not keep the other one from being made safe.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.interfaces import Clock, RateTable, Supply
from ahrs_lab.instruments.patience import patient_s
from ahrs_lab.messages import Message

ANSWER_LIMIT_S = 4.0
_REST_MARGIN_S = 3.0
_LOOK_S = 0.1
_TRIES = 3

_T = TypeVar("_T")


def stop_bench(
    table: RateTable | None,
    supply: Supply | None,
    clock: Clock,
    *,
    rate_to_zero: Callable[[], None] | None = None,
) -> tuple[Message, ...]:
    """Make the bench safe; what did not work, empty when all did. Never raises an Exception.

    ``rate_to_zero``: how to demand rate zero of a table that this process has not enabled itself; by default
    ``table.set_rate(0.0)``.
    """
    problems: list[Message] = []
    if table is not None:
        first = rate_to_zero or (lambda: table.set_rate(0.0))
        # A table in another mode refuses or ignores a rate; the stop below works from any.
        _attempt(first, [])
        _come_to_rest(table, clock, [])
        if not any(_attempt(table.stop, problems) for _ in range(_TRIES)) or not _come_to_rest(
            table, clock, problems
        ):
            problems.append(Message("The table could not be stopped: use its own stop button."))
        _attempt(table.disable, problems)
    if supply is not None and not any(_attempt(supply.off, problems) for _ in range(_TRIES)):
        problems.append(Message("The supply could not be switched off: switch it off by hand."))
    return tuple(dict.fromkeys(problems))


def _come_to_rest(table: RateTable, clock: Clock, problems: list[Message]) -> bool:
    """Wait until the table rests, as long as it needs from its rate at its acceleration and a margin."""
    looked: list[float] = []

    def rate() -> None:
        looked.append(abs(table.state().rate_dps))

    if not _attempt(rate, problems):
        return False
    braking = looked[-1] / max(table.limits.max_acceleration_dps2, 1e-3)
    end = clock.now_s() + 1.5 * braking + patient_s(clock, _REST_MARGIN_S)
    while clock.now_s() < end:
        if looked[-1] <= _AT_REST_DPS:
            return True
        clock.wait(_LOOK_S)
        if not _attempt(rate, problems):
            return False
    return looked[-1] <= _AT_REST_DPS


_AT_REST_DPS = 0.1


def _attempt(call: Callable[[], object], problems: list[Message]) -> bool:
    try:
        within(ANSWER_LIMIT_S, call)
    except AhrsLabError as error:
        problems.append(error.message)
    except Exception as error:
        problems.append(Message("{kind}: {text}", kind=type(error).__name__, text=str(error)))
    else:
        return True
    return False


def within(limit_s: float, call: Callable[[], _T]) -> _T:
    """The result of ``call`` or its exception; InstrumentError where it takes longer. The call then goes on
    in a daemon thread: Python cannot end it."""
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
        raise InstrumentError("no answer within {limit} s", limit=limit_s)
    return results[0]
