"""The bench's ends of the wires: a pseudo-terminal, or a TCP port and those who connect to it.

Everything is non-blocking and used by the serving thread alone. What nobody takes is lost, as on a wire.
"""

from __future__ import annotations

import errno
import os
import socket
from abc import ABC, abstractmethod
from typing import Protocol

from ahrs_lab.errors import MachineError

_LARGEST_READ = 65536
_MOST_WAITING = 1 << 20
"""Bytes that may wait for a listener; then the newest are lost."""
_BAUD_OF_SPEED_FIELD = 5
"""Place of the output speed in what tcgetattr gives."""


class Connection(Protocol):
    """One end that bytes come from and go to."""

    dropped_bytes: int
    sent_bytes: int

    def fileno(self) -> int: ...
    def receive(self) -> bytes | None:
        """What has come, b"" where there is nothing; None: the other side is gone for good."""
        ...

    def send(self, data: bytes) -> None:
        """Hand ``data`` on as far as it goes, keep the rest for :meth:`pump`."""
        ...

    def pump(self) -> bool:
        """Send what waits; False where the other side is gone."""
        ...

    def close(self) -> None: ...


class _Buffered(ABC):
    """Bytes that wait for the wire."""

    def __init__(self) -> None:
        self.dropped_bytes = self.sent_bytes = 0
        self._out = bytearray()

    def send(self, data: bytes) -> None:
        if len(self._out) + len(data) > _MOST_WAITING:
            self.dropped_bytes += len(data)
            return
        self._out += data
        self.pump()

    def pump(self) -> bool:
        while self._out:
            try:
                sent = self._write(bytes(self._out[:_LARGEST_READ]))
            except BlockingIOError:
                return True
            except OSError as error:
                # EIO: a pseudo-terminal nobody has open
                return error.errno in (errno.EAGAIN, errno.EIO)
            self.sent_bytes += sent
            del self._out[:sent]
        return True

    @abstractmethod
    def _write(self, data: bytes) -> int:
        """Bytes that the system has taken; BlockingIOError where it takes none now."""


class PtyConnection(_Buffered):
    """A pseudo-terminal; ``path`` is what the other side opens like a serial port."""

    def __init__(self) -> None:
        super().__init__()
        try:
            import pty
            import tty
        except ImportError as error:
            raise MachineError(
                "This system has no pseudo-terminals: serve the instruments on TCP ports instead."
            ) from error
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.path = os.ttyname(self._slave)

    def fileno(self) -> int:
        return self._master

    def receive(self) -> bytes | None:
        try:
            return os.read(self._master, _LARGEST_READ)
        except BlockingIOError:
            return b""
        except OSError as error:
            if error.errno == errno.EIO:
                return b""
            raise

    @property
    def baud(self) -> int:
        """The line rate that the other side has set; 0 where it is none that is known."""
        import termios

        code = termios.tcgetattr(self._slave)[_BAUD_OF_SPEED_FIELD]
        names = (name for name in dir(termios) if name.startswith("B") and name[1:].isdecimal())
        return next((int(name[1:]) for name in names if getattr(termios, name) == code), 0)

    def close(self) -> None:
        os.close(self._master)
        os.close(self._slave)

    def _write(self, data: bytes) -> int:
        return os.write(self._master, data)


class TcpConnection(_Buffered):
    """One who has connected."""

    def __init__(self, peer: socket.socket) -> None:
        super().__init__()
        peer.setblocking(False)
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._peer = peer

    def fileno(self) -> int:
        return self._peer.fileno()

    def receive(self) -> bytes | None:
        try:
            return self._peer.recv(_LARGEST_READ) or None
        except BlockingIOError:
            return b""
        except OSError:
            return None

    def close(self) -> None:
        self._peer.close()

    def _write(self, data: bytes) -> int:
        return self._peer.send(data)


class TcpListener:
    """A TCP port that instruments are served on; 0 takes a free one."""

    def __init__(self, port: int = 0, host: str = "127.0.0.1") -> None:
        try:
            self._socket = socket.create_server((host, port))
        except OSError as error:
            raise MachineError(
                "Port {port} cannot be opened ({reason}): another program may be using it.",
                port=port,
                reason=error.strerror or str(error),
            ) from error
        self._socket.setblocking(False)
        self.host, self.port = self._socket.getsockname()[:2]

    def fileno(self) -> int:
        return self._socket.fileno()

    def accept(self) -> TcpConnection | None:
        """Who has come, if anybody has."""
        try:
            peer, _ = self._socket.accept()
        except OSError:
            return None
        return TcpConnection(peer)

    def close(self) -> None:
        self._socket.close()
