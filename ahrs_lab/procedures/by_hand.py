"""Instruments that a person sets: asked for, felt meanwhile, checked once the person says that it is done.

Time passes on the bench while somebody is asked, so that samples are taken in, a silent unit is noticed, and
a stop ends the question at once.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.errors import InstrumentError
from ahrs_lab.instruments.by_hand import HandFinding, SetByHand, Setter
from ahrs_lab.instruments.interfaces import Bench
from ahrs_lab.messages import Message
from ahrs_lab.procedures.events import Event, HandChecked, HandFelt, HandRequested, Warned
from ahrs_lab.procedures.recorder import Recorded
from ahrs_lab.procedures.watch import Watch
from ahrs_lab.recording.orientation import Orientation
from ahrs_lab.recording.samples import GYRO, Samples

Array = NDArray[np.float64]

ATTEMPTS = 3
"""How often a recording that a person's motion spoilt is made before the run gives up."""
_LOOK_S = 0.1
_CHECK_STEP_S = 0.25
_PER_DPS = {"deg/s": 1.0, "rad/s": 180.0 / np.pi}
_UP = {"U": 1.0, "D": -1.0}


class WrongByHandError(InstrumentError):
    """A recording does not count, because of what the person at the table did."""


class ByHand:
    """Has a person set what has no wire. ``waiting`` follows while somebody is asked. Where the bench's table
    has a wire, every method returns at once."""

    def __init__(
        self, bench: Bench, watch: Watch, emit: Callable[[Event], None], waiting: Callable[[bool], None]
    ) -> None:
        self._bench = bench
        self._watch = watch
        self._emit = emit
        self._waiting = waiting
        self._table = bench.table if isinstance(bench.table, SetByHand) else None
        self._orientation: Orientation | None = None
        self._because: Message | None = None
        self._can_feel = False
        if self._table is not None:
            watch.feel = self._feel

    @property
    def table(self) -> SetByHand | None:
        """The table, where a person sets it."""
        return self._table

    def mounted(self, orientation: Orientation) -> None:
        """How the case stands: which of its axes feels the table."""
        self._orientation = orientation

    def have_set(self) -> None:
        """Ask for what the table was told, until it does that. Raises AbortedError where the person gives up
        or the run is stopped, :class:`WrongByHandError` where what was done has to begin again."""
        table = self._table
        if table is None or table.request is None:
            return
        setter = self._bench.operator
        if not isinstance(setter, Setter):
            raise InstrumentError(
                "The rate table is set by hand, and there is nobody on this bench to ask: “{request}”",
                request=table.request.message,
            )
        self._watch.tell()
        because, self._because = self._because, None
        setter.ask(table.request, because)
        self._emit(HandRequested(table.request, because))
        self._emit(HandFelt(table.felt()))
        self._waiting(True)
        try:
            self._until_it_holds(table, setter)
        finally:
            self._waiting(False)

    def _until_it_holds(self, table: SetByHand, setter: Setter) -> None:
        while (request := table.request) is not None:
            if not setter.has_set(_LOOK_S):
                # A fast virtual bench keeps its pace while somebody is asked.
                self._watch.let_pass(max(_LOOK_S, self._bench.clock.step_s or 0.0))
                self._emit(HandFelt(table.felt()))
                continue
            finding = self._checked(table)
            if not finding.accepted and not finding.begin_again:
                setter.ask(request, finding.message)
            self._emit(HandChecked(request, finding))
            if not finding.felt and self._watch.powered:
                self._emit(Warned(finding.message))
            if finding.begin_again:
                raise WrongByHandError(finding.message)

    def _checked(self, table: SetByHand) -> HandFinding:
        said_s = self._bench.clock.now_s()
        blind = not (self._watch.streaming and self._can_feel)
        while True:
            self._watch.let_pass(_CHECK_STEP_S)
            self._emit(HandFelt(table.felt()))
            finding = table.check(said_s, blind=blind)
            if finding is not None:
                return finding

    def recorded(
        self, record: Callable[[Callable[[], None]], Recorded], again: Callable[[], None]
    ) -> Recorded:
        """``record`` (which calls what it is given to be sure that the recording counts); where the person's
        motion spoilt it, ``again`` demands the motion anew and it is recorded once more."""
        table = self._table
        if table is None:
            return record(lambda: None)

        def sure() -> None:
            if (strayed := table.strayed()) is not None:
                raise WrongByHandError(strayed.message)

        for attempt in range(1, ATTEMPTS + 1):
            try:
                table.strayed()
                return record(sure)
            except WrongByHandError as wrong:
                if attempt == ATTEMPTS:
                    raise
                self._emit(Warned(wrong.message))
                self._because = wrong.message
                again()
                self.have_set()
        raise AssertionError("the last attempt returns or raises")

    def _feel(self, samples: Samples) -> None:
        scale = _PER_DPS.get(self._bench.ahrs.description.rate_unit)
        orientation, offset = self._orientation, self._watch.offset_s
        if self._table is None or orientation is None or scale is None or offset is None:
            return
        self._can_feel = all(name in samples for name in GYRO)
        if not self._can_feel:
            return
        up = np.array([_UP.get(letter, 0.0) for letter in orientation.letters])
        self._table.feel(samples["t_s"] + offset, samples.matrix(GYRO) @ up * scale)
