"""What a wire is to a driver: bytes in, bytes out, and the news that it was unplugged."""

from __future__ import annotations

from typing import Protocol

from ahrs_lab.errors import LinkLostError

__all__ = ["Link", "LinkLostError"]


class Link(Protocol):
    """One serial port or TCP connection. One thread reads, any thread writes."""

    @property
    def name(self) -> str:
        """What a person calls it: a port's name, or host:port."""
        ...

    @property
    def bits_per_second(self) -> int | None:
        """Line rate; None where the wire sets no limit worth minding."""
        ...

    def open(self) -> None:
        """Raises LinkLostError where there is nothing to open, in plain words. Opening what is open does
        nothing."""
        ...

    def close(self) -> None:
        """Never raises; closing what is closed does nothing."""
        ...

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, at once where there is something, else after the first bytes; b"" after
        ``timeout_s`` without any. Raises LinkLostError."""
        ...

    def write(self, data: bytes) -> None:
        """Hand ``data`` to the wire, all of it. Raises LinkLostError."""
        ...
