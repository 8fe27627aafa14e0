"""A table that speaks ACL on a TCP port of its own process of tests, one client at a time, in real time."""

from __future__ import annotations

import selectors
import socket
import threading
import time

from ahrs_lab.instruments.interfaces import TableLimits, TableLog, TableState
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder

_STEP_S = 0.002


class SpinningTable:
    """A :class:`~ahrs_lab.instruments.interfaces.RateTable` that turns by the computer's clock."""

    def __init__(self, acceleration_dps2: float = 400.0) -> None:
        self.limits = TableLimits(400.0, acceleration_dps2)
        self._lock = threading.RLock()
        self._t_s = time.monotonic()
        self._angle_deg = self._rate_dps = self._wanted_dps = 0.0
        self._enabled = False

    def identify(self) -> str:
        return "spinning table"

    def enable(self) -> None:
        self._enabled = True

    def disable(self) -> None:
        self.stop()
        self._enabled = False

    def set_rate(self, rate_dps: float) -> None:
        with self._lock:
            self._advance()
            self._wanted_dps = rate_dps

    def move_to(self, angle_deg: float, rate_dps: float) -> None:
        raise AssertionError("nobody moves this table to an angle")

    def stop(self) -> None:
        self.set_rate(0.0)

    def state(self) -> TableState:
        with self._lock:
            self._advance()
            moving = self._rate_dps != 0.0 or self._wanted_dps != 0.0
            return TableState(
                self._t_s, self._angle_deg, self._rate_dps, self._wanted_dps, moving, self._enabled
            )

    def log(self) -> TableLog:
        raise AssertionError("nobody asks this table for its log")

    def _advance(self) -> None:
        now = time.monotonic()
        change = self.limits.max_acceleration_dps2 * (now - self._t_s)
        difference = self._wanted_dps - self._rate_dps
        self._rate_dps += max(-change, min(change, difference))
        self._angle_deg += self._rate_dps * (now - self._t_s)
        self._t_s = now


class AclWorld:
    """Serves a :class:`SpinningTable` to one client at a time, as the real controller does: a second one
    waits until the first has gone. ``said`` keeps the requests that change something, with their times."""

    def __init__(self) -> None:
        self.table = SpinningTable()
        self.responder = AclResponder(self.table)
        self.said: list[tuple[float, str]] = []
        self.clients = 0
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=4)
        self._listener.setblocking(False)
        self._end = threading.Event()
        self._cut = threading.Event()
        self._thread = threading.Thread(target=self._work, name="served table")
        self._thread.start()

    @property
    def port(self) -> int:
        return int(self._listener.getsockname()[1])

    def __enter__(self) -> AclWorld:
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()
        self._listener.close()

    def unplug(self) -> None:
        """Close the client's connection."""
        self._cut.set()

    def _work(self) -> None:
        selector = selectors.DefaultSelector()
        selector.register(self._listener, selectors.EVENT_READ)
        while not self._end.is_set():
            if not selector.select(0.02):
                continue
            client, _ = self._listener.accept()
            self.clients += 1
            with client:
                self._serve(client)
        selector.close()

    def _serve(self, client: socket.socket) -> None:
        client.settimeout(0.02)
        self._cut.clear()
        while not self._end.is_set() and not self._cut.is_set():
            try:
                data = client.recv(4096)
            except TimeoutError:
                continue
            except OSError:
                return
            if not data:
                return
            self.said += [
                (time.monotonic(), line) for line in data.decode().splitlines() if line and "?" not in line
            ]
            answer = self.responder.feed(data)
            time.sleep(0.002)
            try:
                client.sendall(answer)
            except OSError:
                return
