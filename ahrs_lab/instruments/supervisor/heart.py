"""The application's heart: it beats as long as everything that has to be alive is."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

BEAT_S = 0.2


class Pulse:
    """One part of the application that has to be alive, the screen's event loop for instance: it calls
    :meth:`beat` more often than every ``limit_s``."""

    def __init__(self, name: str, limit_s: float, now_s: Callable[[], float]) -> None:
        self.name = name
        self.limit_s = limit_s
        self._now_s = now_s
        self._last_s = now_s()

    def beat(self) -> None:
        """Alive."""
        self._last_s = self._now_s()

    @property
    def alive(self) -> bool:
        """Has beaten within its limit."""
        return self._now_s() - self._last_s <= self.limit_s


class Heart:
    """A thread that calls ``beat`` five times a second, as long as every :class:`Pulse` is alive."""

    def __init__(self, beat: Callable[[], None], now_s: Callable[[], float] = time.monotonic) -> None:
        self._beat = beat
        self._now_s = now_s
        self._pulses: list[Pulse] = []
        self._end = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to beat."""
        if self._thread is None:
            self._end.clear()
            self._thread = threading.Thread(target=self._work, name="heart", daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End the thread."""
        self._end.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join()

    def needs(self, name: str, limit_s: float) -> Pulse:
        """From now on the heart stands still where the returned pulse is not beaten for ``limit_s``."""
        pulse = Pulse(name, limit_s, self._now_s)
        self._pulses = [*self._pulses, pulse]
        return pulse

    def release(self, pulse: Pulse) -> None:
        """That part may end."""
        self._pulses = [one for one in self._pulses if one is not pulse]

    def _work(self) -> None:
        while not self._end.is_set():
            if all(pulse.alive for pulse in self._pulses):
                self._beat()
            self._end.wait(BEAT_S)
