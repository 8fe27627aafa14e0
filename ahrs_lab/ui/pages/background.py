"""Work that takes longer than a blink, out of the GUI thread: one worker, results delivered back in order.

Evaluation, laying out a PDF, drawing its pages and signing each take a tenth of a second to many seconds.
A page hands the work over with what is to happen afterwards and stays alive to the mouse meanwhile.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from PySide6.QtCore import QObject, Qt, Signal, Slot
from shiboken6 import Shiboken

from ahrs_lab.errors import AhrsLabError

T = TypeVar("T")
_Delivery = tuple[QObject, str, int, Callable[[], None]]


class Background(QObject):
    """One worker thread for all pages; :meth:`close` waits for its end, so that none is left behind.

    ``busy_changed(owner, bool)`` tells when an owner's work begins and when its last one has ended.
    """

    busy_changed = Signal(object, bool)
    _delivered = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool: ThreadPoolExecutor | None = None
        self._newest: dict[tuple[int, str], int] = {}
        self._open: dict[int, int] = {}
        self._count = 0
        self._closed = False
        self._delivered.connect(self._deliver, Qt.ConnectionType.QueuedConnection)

    def run(
        self,
        owner: QObject,
        work: Callable[[], T],
        done: Callable[[T], None],
        failed: Callable[[AhrsLabError], None],
        *,
        topic: str = "",
    ) -> None:
        """Do ``work`` in the worker, then ``done(result)`` or ``failed(error)`` in the GUI thread.

        Nothing is called when ``owner`` is gone by then, or when newer work of the same owner and ``topic``
        was handed over meanwhile (an empty topic never supersedes). An exception that is no AhrsLabError is
        a defect of ours: it goes to ``sys.excepthook``, in the GUI thread.
        """
        if self._closed:
            return
        self._count += 1
        ticket = self._count
        if topic:
            self._newest[(id(owner), topic)] = ticket
        self._open[id(owner)] = self._open.get(id(owner), 0) + 1
        if self._open[id(owner)] == 1:
            self.busy_changed.emit(owner, True)
        if self._pool is None:
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="ahrs-lab-pages")
        future = self._pool.submit(work)

        def ended(result: Future[T]) -> None:
            if not result.cancelled():
                self._delivered.emit((owner, topic, ticket, lambda: _hand_over(result, done, failed)))

        future.add_done_callback(ended)

    def is_busy(self, owner: QObject) -> bool:
        """Whether work of ``owner`` is going on or waiting."""
        return id(owner) in self._open

    @property
    def busy(self) -> bool:
        """Whether any work is going on or waiting."""
        return bool(self._open)

    @Slot(object)
    def _deliver(self, delivery: _Delivery) -> None:
        owner, topic, ticket, hand_over = delivery
        left = self._open.pop(id(owner), 1) - 1
        if left > 0:
            self._open[id(owner)] = left
        if self._closed or not Shiboken.isValid(owner):
            return
        if left == 0:
            self.busy_changed.emit(owner, False)
        if not topic or self._newest.get((id(owner), topic)) == ticket:
            hand_over()

    def close(self) -> None:
        """Drop what has not begun, wait for what has; nothing is delivered any more."""
        self._closed = True
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
            self._pool = None


def _hand_over(
    result: Future[Any], done: Callable[[Any], None], failed: Callable[[AhrsLabError], None]
) -> None:
    error = result.exception()
    if error is None:
        done(result.result())
    elif isinstance(error, AhrsLabError):
        failed(error)
    else:
        sys.excepthook(type(error), error, error.__traceback__)
