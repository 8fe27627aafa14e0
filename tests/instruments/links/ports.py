"""Real ends to talk to: a pseudo-terminal and a TCP socket on this machine."""

from __future__ import annotations

import os
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

needs_pty = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")


class PtyEnd:
    """The device's end of a pseudo-terminal; ``path`` is what the program opens."""

    def __init__(self) -> None:
        import tty

        self.master, slave = os.openpty()
        tty.setraw(self.master)
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        self._slave: int | None = slave

    def send(self, data: bytes) -> None:
        while data:
            data = data[os.write(self.master, data) :]

    def receive(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            data += os.read(self.master, count - len(data))
        return data

    def unplug(self) -> None:
        for end in (self.master, self._slave):
            if end is not None:
                os.close(end)
        self.master, self._slave = -1, None


@contextmanager
def pty_end() -> Iterator[PtyEnd]:
    end = PtyEnd()
    try:
        yield end
    finally:
        if end.master >= 0:
            end.unplug()


class TcpEnd:
    """A server for one connection at a time."""

    def __init__(self, port: int = 0) -> None:
        self.server = socket.create_server(("127.0.0.1", port))
        self.server.settimeout(5.0)
        self.port = self.server.getsockname()[1]
        self.connection: socket.socket | None = None

    def accept(self) -> socket.socket:
        self.connection, _ = self.server.accept()
        self.connection.settimeout(5.0)
        return self.connection

    def unplug(self) -> None:
        """Gone for good: connection and server."""
        if self.connection is not None:
            self.connection.close()
        self.server.close()


@contextmanager
def tcp_end() -> Iterator[TcpEnd]:
    end = TcpEnd()
    try:
        yield end
    finally:
        end.unplug()


@contextmanager
def answering(end: TcpEnd, answer: Callable[[bytes], bytes | None]) -> Iterator[None]:
    """A thread that serves every connection to ``end`` with ``answer``; None closes the connection."""
    stop = threading.Event()

    def serve() -> None:
        end.server.settimeout(0.05)
        while not stop.is_set():
            try:
                connection, _ = end.server.accept()
            except TimeoutError:
                continue
            except OSError:
                return
            with connection:
                connection.settimeout(0.05)
                while not stop.is_set():
                    try:
                        data = connection.recv(4096)
                    except TimeoutError:
                        continue
                    except OSError:
                        break
                    if not data:
                        break
                    reply = answer(data)
                    if reply is None:
                        break
                    connection.sendall(reply)

    thread = threading.Thread(target=serve, name="server")
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()
