"""TCP connections: instruments with an Ethernet socket, and serial servers."""

from __future__ import annotations

import selectors
import socket
import threading

from ahrs_lab.instruments.links.link import LinkLostError

_CONNECT_TIMEOUT_S = 2.0
_WRITE_TIMEOUT_S = 1.0
_LARGEST_READ = 65536
_KEEP_ALIVE_S = 1


class TcpLink:
    """A :class:`~ahrs_lab.instruments.links.link.Link` to ``host:port``.

    A connection that the other side closes is noticed at once. A network cable that is pulled is noticed when
    an answer stays out, or when the system's keep-alive gives up (3 s where the system lets us ask for it).
    """

    def __init__(self, host: str, port: int) -> None:
        self._host, self._port = host, port
        self._socket: socket.socket | None = None
        self._selector: selectors.BaseSelector | None = None
        self._write_lock = threading.Lock()

    @property
    def name(self) -> str:
        """host:port."""
        return f"{self._host}:{self._port}"

    @property
    def bits_per_second(self) -> int | None:
        """None: a network is faster than any of these instruments."""
        return None

    def open(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        if self._socket is not None:
            return
        try:
            connection = socket.create_connection((self._host, self._port), _CONNECT_TIMEOUT_S)
        except OSError as error:
            raise LinkLostError(
                "{name} does not answer ({reason}): check the network cable, the address and that the "
                "instrument is switched on.",
                name=self.name,
                reason=error.strerror or str(error),
            ) from error
        connection.settimeout(_WRITE_TIMEOUT_S)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        _ask_for_keep_alive(connection)
        self._selector = selectors.DefaultSelector()
        self._selector.register(connection, selectors.EVENT_READ)
        self._socket = connection

    def close(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        connection, self._socket = self._socket, None
        selector, self._selector = self._selector, None
        if selector is not None:
            selector.close()
        if connection is not None:
            connection.close()

    def read(self, timeout_s: float) -> bytes:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        connection, selector = self._socket, self._selector
        if connection is None or selector is None:
            raise LinkLostError("The connection to {name} is not open.", name=self.name)
        try:
            if not selector.select(timeout_s):
                return b""
            data = connection.recv(_LARGEST_READ)
        except (OSError, ValueError, KeyError, RuntimeError) as error:  # all but OSError: closed meanwhile
            raise self._lost(error) from error
        if not data:
            raise LinkLostError(
                "{name} has closed the connection: check whether the instrument was switched off or "
                "another program has taken it over.",
                name=self.name,
            )
        return data

    def write(self, data: bytes) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        connection = self._socket
        if connection is None:
            raise LinkLostError("The connection to {name} is not open.", name=self.name)
        try:
            with self._write_lock:
                connection.sendall(data)
        except OSError as error:
            raise self._lost(error) from error

    def _lost(self, error: Exception) -> LinkLostError:
        return LinkLostError(
            "The connection to {name} is gone ({reason}): check the network cable and the instrument's "
            "power.",
            name=self.name,
            reason=getattr(error, "strerror", None) or str(error),
        )


def _ask_for_keep_alive(connection: socket.socket) -> None:
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    wishes = {"TCP_KEEPIDLE": _KEEP_ALIVE_S, "TCP_KEEPINTVL": _KEEP_ALIVE_S, "TCP_KEEPCNT": 2}
    for name, value in wishes.items():
        option = getattr(socket, name, None)  # not every system has them
        if option is not None:
            connection.setsockopt(socket.IPPROTO_TCP, option, value)
