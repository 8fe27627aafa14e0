"""One instrument at the desk: a thread of its own connects it, looks at it ten times a second, and does what
it is asked. Who looks at :attr:`Station.view` never waits."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Literal, TypeVar

from ahrs_lab.errors import AhrsLabError, InstrumentError
from ahrs_lab.instruments.links.link import LinkLostError
from ahrs_lab.instruments.registry import Kind
from ahrs_lab.instruments.settings import Difference
from ahrs_lab.messages import Message

StationState = Literal["off", "connecting", "ready", "lost", "failed"]
"""Not connected; being connected; answering; the wire is gone, being tried again; answering with an error."""

LOOK_S = 0.1
_CLOSE_LIMIT_S = 10.0

_T = TypeVar("_T")


@dataclass(frozen=True)
class StationView:
    """What is known of an instrument now. ``live``: its readings, of a kind of its own; None before the
    first. ``differences``: settings that it read back otherwise when it was configured last, None before
    that."""

    part: Kind
    state: StationState = "off"
    identity: str = ""
    problem: Message | None = None
    live: Any = None
    differences: tuple[Difference, ...] | None = None
    busy: bool = False
    connected: bool = False
    since_s: float = field(default_factory=time.monotonic)


class Station(Generic[_T]):
    """See the module. ``make`` makes the instrument, not yet open; ``look`` reads it, in the station's
    thread, and returns what is shown; ``let_go`` closes it."""

    def __init__(
        self,
        part: Kind,
        make: Callable[[], Any],
        look: Callable[[Any], _T],
        *,
        opened: Callable[[Any], None] = lambda _: None,
        let_go: Callable[[Any], None] = lambda instrument: instrument.close(),
        look_s: float = LOOK_S,
    ) -> None:
        self.part = part
        self._make, self._look, self._opened, self._let_go = make, look, opened, let_go
        self._look_s = look_s
        self._view = StationView(part)
        self._work: queue.Queue[tuple[Callable[[Any], Any], Future[Any]]] = queue.Queue()
        self._end = threading.Event()
        self._thread: threading.Thread | None = None
        self.instrument: Any = None
        """Open while the state is neither "off" nor "connecting"."""

    @property
    def view(self) -> StationView:
        """What is known now."""
        return self._view

    @property
    def connected(self) -> bool:
        """Whether there is an instrument to ask."""
        return self.instrument is not None

    def connect(self) -> None:
        """Begin to connect; how it went shows in :attr:`view`."""
        if self._thread is not None and self._thread.is_alive():
            return
        self._end.clear()
        self._set(state="connecting", problem=None, live=None, differences=None, identity="")
        self._thread = threading.Thread(target=self._run, name=f"desk {self.part}", daemon=True)
        self._thread.start()

    def disconnect(self) -> None:
        """Let the instrument go; waits for it, so not for the screen's thread where it may hang."""
        self._end.set()
        thread, self._thread = self._thread, None
        if thread is not None and thread is not threading.current_thread():
            thread.join(_CLOSE_LIMIT_S)

    def ask(self, call: Callable[[Any], Any]) -> Future[Any]:
        """Have ``call(instrument)`` done by the station's thread. The future fails with InstrumentError where
        the instrument is not connected."""
        future: Future[Any] = Future()
        if not self.connected:
            future.set_exception(InstrumentError("The instrument is not connected."))
        else:
            self._set(busy=True)
            self._work.put((call, future))
        return future

    def set_differences(self, differences: tuple[Difference, ...]) -> None:
        """What came of configuring."""
        self._set(differences=differences)

    # the thread ───────────────────────────────────────────────────────────────────────────────────────────

    def _run(self) -> None:
        instrument: Any = None
        try:
            instrument = self._make()
            opener = getattr(instrument, "open", None)
            if opener is not None:
                opener()
            identity = str(instrument.identify())
            self._opened(instrument)
            self.instrument = instrument
            self._set(state="ready", identity=identity, problem=None, connected=True)
            while not self._end.is_set():
                self._take_work(instrument)
                self._take_look(instrument)
        except AhrsLabError as error:
            self._set(state="failed", problem=error.message, live=None)
        else:
            self._set(state="off", problem=None, live=None)
        finally:
            self.instrument = None
            self._set(connected=False)
            self._refuse_rest()
            self._release(instrument)

    def _release(self, instrument: Any) -> None:
        if instrument is None:
            return
        try:
            self._let_go(instrument)
        except AhrsLabError as error:
            self._set(problem=error.message)

    def _take_work(self, instrument: Any) -> None:
        try:
            call, future = self._work.get(timeout=self._look_s)
        except queue.Empty:
            return
        try:
            future.set_result(call(instrument))
        except Exception as error:
            future.set_exception(error)
        self._set(busy=not self._work.empty())

    def _take_look(self, instrument: Any) -> None:
        try:
            live = self._look(instrument)
        except LinkLostError as error:
            self._set(state="lost", problem=error.message)
        except AhrsLabError as error:
            self._set(state="failed", problem=error.message)
        else:
            self._set(state="ready", problem=None, live=live)

    def _refuse_rest(self) -> None:
        while not self._work.empty():
            _, future = self._work.get()
            future.set_exception(InstrumentError("The instrument is not connected."))
        self._set(busy=False)

    def _set(self, **changes: Any) -> None:
        if changes.get("state", self._view.state) != self._view.state:
            changes["since_s"] = time.monotonic()
        self._view = replace(self._view, **changes)
