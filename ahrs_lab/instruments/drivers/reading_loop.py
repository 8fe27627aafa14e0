"""Readings of a slow instrument, taken in the background, so that who wants one never waits for the wire."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.links.port_reader import FIRST_BACK_OFF_S, LONGEST_BACK_OFF_S

_T = TypeVar("_T")


class ReadingLoop(Generic[_T]):
    """Calls ``look`` every ``period_s`` in one thread; after a lost link calls ``reconnect`` until it works.

    :meth:`latest` gives the last reading, or raises what is wrong now."""

    def __init__(
        self, name: str, look: Callable[[], _T], reconnect: Callable[[], object], period_s: float
    ) -> None:
        self._name = name
        self._look = look
        self._reconnect = reconnect
        self._period_s = period_s
        self._lock = threading.RLock()
        self._latest: _T | None = None
        self._error: AhrsLabError | None = None
        self._end = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def lock(self) -> threading.RLock:
        """Held around each look; whoever says something to the instrument holds it too."""
        return self._lock

    def start(self) -> None:
        """Look once, raising what is wrong, and go on in the background."""
        self.refresh()
        if self._thread is None:
            self._end.clear()
            self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
            self._thread.start()

    def close(self) -> None:
        """End the thread. May be called again."""
        self._end.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join()

    def refresh(self) -> _T:
        """Look now. Raises what is wrong."""
        with self._lock:
            try:
                self._latest = self._look()
            except AhrsLabError as error:
                self._error = error
                raise
            self._error = None
            return self._latest

    def latest(self) -> _T:
        """The last reading. Raises what went wrong since."""
        if self._error is not None:
            raise self._error
        if self._latest is None:
            raise InstrumentError("{name} has not been read yet.", name=self._name)
        return self._latest

    def _work(self) -> None:
        back_off = FIRST_BACK_OFF_S
        while True:
            lost = isinstance(self._error, LinkLostError)
            if self._end.wait(back_off if lost else self._period_s):
                return
            back_off = min(2.0 * back_off, LONGEST_BACK_OFF_S) if lost else FIRST_BACK_OFF_S
            try:
                with self._lock:
                    if lost:
                        self._reconnect()
                    self.refresh()
            except AhrsLabError as error:
                self._error = error
