"""The table's wire, owned by the supervisor and lent to the application over a local TCP connection.

So a table that accepts one client only can be stopped although the application still holds its end, and
an application that is killed leaves the wire open. The application's driver connects here as to the table
itself."""

from __future__ import annotations

import contextlib
import socket
import threading
import time

from ahrs_lab.instruments.links.link import Link, LinkLostError
from ahrs_lab.messages import Message

HOST = "127.0.0.1"
_SLICE_S = 0.05
_SEND_TIMEOUT_S = 0.5
_REOPEN_S = 0.25
_LINK_WAIT_S = 3.0
_QUIET_S = 0.05
_LONGEST_QUIET_S = 0.4
_LARGEST_READ = 65536


class Relay:
    """Carries bytes between ``link`` and at most one client."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._listener = _listener()
        self._client: socket.socket | None = None
        self._swap = threading.Lock()
        self._end = threading.Event()
        self._linked = threading.Event()
        self._last_data_s = 0.0
        self._threads = [
            threading.Thread(target=self._from_link, name="relay from table", daemon=True),
            threading.Thread(target=self._from_client, name="relay to table", daemon=True),
        ]
        self.lost: Message | None = None
        """Why there is no link at the moment."""
        self.used = False
        """Whether anybody has ever connected, so that the table may have been moved."""

    @property
    def port(self) -> int:
        """Where the client connects, on this computer only."""
        return int(self._listener.getsockname()[1])

    def start(self) -> None:
        """Open the link, raising LinkLostError where that fails, and begin to carry."""
        self._link.open()
        self._linked.set()
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """End; the link is closed."""
        self._end.set()
        self._drop(self._client)
        self._listener.close()
        for thread in self._threads:
            if thread.ident is not None:
                thread.join()
        self._link.close()

    def renew(self) -> int:
        """Drop the client and take the next one on another port, which is returned: whoever knew the old one
        is out."""
        with self._swap:
            old, self._listener = self._listener, _listener()
        old.close()
        self._drop(self._client)
        return self.port

    # threads ──────────────────────────────────────────────────────────────────────────────────────────────

    def _from_link(self) -> None:
        while not self._end.is_set():
            if not self._linked.is_set() and not self._reopen():
                self._end.wait(_REOPEN_S)
                continue
            try:
                data = self._link.read(_SLICE_S)
            except LinkLostError as error:
                self.lost = error.message
                self._linked.clear()
                self._link.close()
                self._drop(self._client)
                continue
            if data:
                self._last_data_s = time.monotonic()
                self._to_client(data)

    def _reopen(self) -> bool:
        try:
            self._link.open()
        except LinkLostError as error:
            self.lost = error.message
            return False
        self.lost = None
        self._linked.set()
        return True

    def _to_client(self, data: bytes) -> None:
        client = self._client
        if client is None:
            return
        try:
            client.sendall(data)
        except OSError:
            self._drop(client)

    def _from_client(self) -> None:
        while not self._end.is_set():
            with self._swap:
                listener = self._listener
            try:
                client, _ = listener.accept()
            except OSError:
                # Nobody for a slice, or another listener meanwhile.
                self._end.wait(0.001)
                continue
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            client.settimeout(_SEND_TIMEOUT_S)
            if not self._linked.wait(_LINK_WAIT_S):
                client.close()
                continue
            self._wait_for_quiet()
            with self._swap:
                if listener is not self._listener:
                    client.close()
                    continue
                self._client, self.used = client, True
            self._carry(client)
            self._drop(client)

    def _carry(self, client: socket.socket) -> None:
        while not self._end.is_set() and client is self._client:
            try:
                data = client.recv(_LARGEST_READ)
            except TimeoutError:
                continue
            except OSError:
                return
            if not data:
                return
            try:
                self._link.write(data)
            except LinkLostError:
                return

    def _wait_for_quiet(self) -> None:
        """An answer to what the client before has asked must not be taken for one to this client."""
        end = time.monotonic() + _LONGEST_QUIET_S
        while time.monotonic() < end:
            self._end.wait(_QUIET_S)
            if time.monotonic() - self._last_data_s >= _QUIET_S:
                return

    def _drop(self, client: socket.socket | None) -> None:
        with self._swap:
            if client is None:
                return
            if client is self._client:
                self._client = None
        with contextlib.suppress(OSError):
            client.shutdown(socket.SHUT_RDWR)
        client.close()


def _listener() -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    made.bind((HOST, 0))
    made.listen(1)
    made.settimeout(_SLICE_S)
    return made
