"""One thread that serves all the bench's wires: takes requests, answers after the instrument's own latency,
lets the world's time go on, and sends what it brings."""

from __future__ import annotations

import heapq
import selectors
import threading
from collections.abc import Callable
from typing import Any, Protocol

from ahrs_lab.simulation.servers.connections import Connection, PtyConnection, TcpListener
from ahrs_lab.simulation.servers.served_world import ServedWorld

TICK_S = 0.001
"""Wall time after which the world is looked at again."""
_STEPPED_TICK_S = 0.0001


class Service(Protocol):
    """An instrument behind one wire."""

    latency_s: float

    def answer(self, connection: Connection, data: bytes) -> bytes:
        """What to say to ``data``, which may be any part of a request."""
        ...

    def connected(self, connection: Connection) -> None: ...
    def gone(self, connection: Connection) -> None: ...
    def tick(self, now_s: float) -> None:
        """Bench time has come to ``now_s``: send what is due."""
        ...


class Server:
    """Serves until closed. Services are added before :meth:`start`."""

    def __init__(self, served: ServedWorld) -> None:
        self.served = served
        self._selector = selectors.DefaultSelector()
        self._services: list[Service] = []
        self._listeners: list[tuple[TcpListener, Service]] = []
        self._connections: list[tuple[Connection, Service]] = []
        self._due: list[tuple[float, int, Connection, bytes]] = []
        self._last_due: dict[int, float] = {}
        self._order = 0
        self._calls: list[Callable[[], None]] = []
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._work, name="served-bench", daemon=True)
        self.failure: BaseException | None = None

    def on_tcp(self, service: Service, port: int = 0) -> TcpListener:
        """Serve on a TCP port of this computer; 0 takes a free one."""
        listener = TcpListener(port)
        self._add(service)
        self._listeners.append((listener, service))
        self._selector.register(listener, selectors.EVENT_READ, ("accept", listener, service))
        return listener

    def on_pty(self, service: Service) -> PtyConnection:
        """Serve on a pseudo-terminal."""
        connection = PtyConnection()
        self._add(service)
        self._take(connection, service)
        return connection

    def start(self) -> None:
        """Begin to serve."""
        self._thread.start()

    def close(self) -> None:
        """End the thread, close all wires."""
        self._end.set()
        if self._thread.ident is not None:
            self._thread.join()
        for connection, _ in self._connections:
            connection.close()
        for listener, _ in self._listeners:
            listener.close()
        self._selector.close()

    def soon(self, call: Callable[[], None]) -> None:
        """From any thread: have ``call`` done by the serving thread."""
        self._calls.append(call)

    def _add(self, service: Service) -> None:
        if service not in self._services:
            self._services.append(service)

    def _take(self, connection: Connection, service: Service) -> None:
        self._connections.append((connection, service))
        self._selector.register(connection, selectors.EVENT_READ, ("read", connection, service))
        service.connected(connection)

    # the serving thread ───────────────────────────────────────────────────────────────────────────────────

    def _work(self) -> None:
        try:
            while not self._end.is_set():
                events = self._selector.select(_STEPPED_TICK_S if self.served.stepped else TICK_S)
                now = self.served.catch_up()
                for key, _ in events:
                    self._serve(key.data, now)
                while self._calls:
                    self._calls.pop(0)()
                for service in self._services:
                    service.tick(now)
                self._send_due(now)
                for connection, service in list(self._connections):
                    if not connection.pump():
                        self._lose(connection, service)
        except BaseException as error:
            self.failure = error
            raise

    def _serve(self, what: tuple[str, Any, Service], now_s: float) -> None:
        kind, end, service = what
        if kind == "accept":
            taken = end.accept()
            if taken is not None:
                self._take(taken, service)
            return
        data = end.receive()
        if data is None:
            self._lose(end, service)
        elif data:
            answer = service.answer(end, data)
            if answer:
                self._later(end, answer, now_s, service.latency_s)

    def _later(self, connection: Connection, data: bytes, now_s: float, latency_s: float) -> None:
        due = max(now_s, self._last_due.get(id(connection), now_s)) + latency_s
        self._last_due[id(connection)] = due
        self._order += 1
        heapq.heappush(self._due, (due, self._order, connection, data))

    def _send_due(self, now_s: float) -> None:
        while self._due and (self.served.stepped or self._due[0][0] <= now_s):
            connection, data = heapq.heappop(self._due)[2:]
            if any(connection is known for known, _ in self._connections):
                connection.send(data)

    def _lose(self, connection: Connection, service: Service) -> None:
        self._connections = [(c, s) for c, s in self._connections if c is not connection]
        self._last_due.pop(id(connection), None)
        self._selector.unregister(connection)
        service.gone(connection)
        connection.close()


class Answering:
    """What services that only answer have in common."""

    latency_s = 0.0

    def __init__(self, served: ServedWorld) -> None:
        self.served = served

    def connected(self, connection: Connection) -> None:
        """Nothing is remembered of a client."""

    def gone(self, connection: Connection) -> None:
        """Nothing is remembered of a client."""

    def tick(self, now_s: float) -> None:
        """Nothing is sent unasked."""
