"""A run that the system ends (closed terminal, shutdown) leaves a safe bench, as one that a person ends."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_NAMES = ("SIGTERM", "SIGHUP", "SIGBREAK")


@contextmanager
def stop_signals() -> Iterator[None]:
    """Within, the system's requests to end come as KeyboardInterrupt, like Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    present = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
    # One that is ignored (nohup) stays so.
    taken = [number for number in present if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, signal.default_int_handler) for number in taken}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
