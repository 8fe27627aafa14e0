"""The desk of the chosen bench as the screen uses it: answers of the instruments' threads are taken over by a
timer of the screen's own thread."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.instruments.registry import Kind
from ahrs_lab.laboratory.instrument_desk import InstrumentDesk
from ahrs_lab.messages import Message

POLL_MS = 120


class InstrumentSession(QObject):
    """``looked`` comes several times a second while an instrument is connected; ``told`` is what went wrong
    with something the person asked for."""

    looked = Signal()
    told = Signal(object)

    def __init__(
        self, make: Callable[[Mapping[str, Any]], InstrumentDesk], parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._make = make
        self._bench: dict[str, Any] = {}
        self._waiting: list[tuple[Future[Any], Callable[[Any], None]]] = []
        self._timer = QTimer(self)
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self._poll)
        self.desk: InstrumentDesk | None = None

    @property
    def bench(self) -> Mapping[str, Any]:
        """The TOML of the bench."""
        return self._bench

    def set_bench(self, bench: Mapping[str, Any]) -> None:
        """Another bench, or the same with other settings: everything is let go first."""
        self.close()
        self._bench = dict(bench)
        self.looked.emit()

    def close(self) -> None:
        """Stop what moves and let every instrument go; waits for it."""
        self._timer.stop()
        desk, self.desk = self.desk, None
        if desk is not None:
            desk.close()
        self._waiting.clear()

    @property
    def live(self) -> bool:
        """Whether any instrument is connected, or about to be."""
        return self.desk is not None and any(
            view.connected or view.state == "connecting" for view in self.desk.views.values()
        )

    def connect_part(self, part: Kind) -> None:
        """Begin to connect."""
        try:
            if self.desk is None:
                self.desk = self._make(self._bench)
            self.desk.connect(part)
        except AhrsLabError as error:
            self.told.emit(error.message)
            return
        self._timer.start()
        self.looked.emit()

    def disconnect_part(self, part: Kind) -> None:
        """Let it go."""
        if self.desk is not None:
            self.ask(self.desk.disconnect(part))

    def ask(self, future: Future[Any], done: Callable[[Any], None] = lambda _: None) -> None:
        """Take the answer over when it comes; an error is told."""
        self._waiting.append((future, done))
        self._timer.start()

    def attempt(
        self, call: Callable[[InstrumentDesk], Any], done: Callable[[Any], None] = lambda _: None
    ) -> None:
        """Ask the desk for something; what it refuses is told."""
        if self.desk is None:
            return
        try:
            answer = call(self.desk)
        except AhrsLabError as error:
            self.told.emit(error.message)
            return
        if isinstance(answer, Future):
            self.ask(answer, done)

    def stop(self) -> bool:
        """Stop the bench; False where nothing is connected."""
        if self.desk is None or not self.live:
            return False
        self.desk.stop()
        return True

    def _poll(self) -> None:
        waiting, self._waiting = self._waiting, []
        for future, done in waiting:
            if not future.done():
                self._waiting.append((future, done))
                continue
            error = future.exception()
            if error is None:
                done(future.result())
            elif isinstance(error, AhrsLabError):
                self.told.emit(error.message)
            else:
                self.told.emit(Message("{kind}: {text}", kind=type(error).__name__, text=str(error)))
        self.looked.emit()
