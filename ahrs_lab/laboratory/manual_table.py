"""A table that is set by hand: what the operator is asked, and the answer, on a screen."""

from __future__ import annotations

import threading
from collections.abc import Callable

from ahrs_lab.errors import AbortedError
from ahrs_lab.instruments.drivers.tables.manual import ManualRequest

_LOOK_S = 0.1


class OperatorsAnswer:
    """:meth:`ask` waits, in the thread of whoever moves the table, until :meth:`confirm` is called. A screen
    shows :attr:`pending`."""

    def __init__(self, changed: Callable[[ManualRequest | None], None] = lambda _: None) -> None:
        self._changed = changed
        self._answered = threading.Event()
        self._given_up = False
        self.pending: ManualRequest | None = None

    def ask(self, request: ManualRequest) -> None:
        """Raises AbortedError where the person gives up."""
        self._answered.clear()
        if self._given_up and request.kind not in ("stop", "disable"):
            raise AbortedError("The run was stopped while the table was being set by hand.")
        self.pending = request
        self._changed(request)
        try:
            while not self._answered.wait(_LOOK_S):
                if self._given_up:
                    raise AbortedError("The run was stopped while the table was being set by hand.")
        finally:
            self.pending = None
            self._changed(None)

    def confirm(self) -> None:
        """The person says that the table does what was asked."""
        self._answered.set()

    def give_up(self) -> None:
        """Nobody will answer any more."""
        self._given_up = True
        self._answered.set()
