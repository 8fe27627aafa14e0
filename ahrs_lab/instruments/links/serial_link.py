"""Serial ports, through pyserial."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from ahrs_lab.instruments.links.link import LinkLostError

if TYPE_CHECKING:
    import serial

_WRITE_TIMEOUT_S = 1.0
_LARGEST_READ = 65536
_BITS_OF_FRAME = 1
"""A start bit goes with the data, parity and stop bits."""


class SerialLink:
    """A :class:`~ahrs_lab.instruments.links.link.Link` on a serial port (``COM3``, ``/dev/ttyUSB0``).

    The port is taken for this program alone where the system allows it: two programs that read one port each
    get half of the bytes.
    """

    def __init__(
        self,
        port: str,
        baud: int = 9600,
        *,
        data_bits: int = 8,
        parity: str = "N",
        stop_bits: float = 1.0,
    ) -> None:
        self._port = port
        self._baud = baud
        self._frame = (data_bits, parity, stop_bits)
        self._serial: serial.Serial | None = None
        self._write_lock = threading.Lock()

    @property
    def name(self) -> str:
        """The port's name."""
        return self._port

    @property
    def bits_per_second(self) -> int | None:
        """The line rate."""
        return self._baud

    @property
    def bits_per_byte(self) -> float:
        """With start, parity and stop bits."""
        data_bits, parity, stop_bits = self._frame
        return _BITS_OF_FRAME + data_bits + (parity != "N") + stop_bits

    def open(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        import serial

        if self._serial is not None:
            return
        data_bits, parity, stop_bits = self._frame
        try:
            self._serial = serial.Serial(
                self._port,
                self._baud,
                bytesize=data_bits,
                parity=parity,
                stopbits=stop_bits,
                timeout=0.1,
                write_timeout=_WRITE_TIMEOUT_S,
                exclusive=True,
            )
        except (OSError, ValueError) as error:
            raise LinkLostError(
                "The serial port {port} cannot be opened ({reason}): check that the adapter is plugged "
                "in, that the name is right and that no other program uses the port.",
                port=self._port,
                reason=_reason(error),
            ) from error

    def close(self) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        port, self._serial = self._serial, None
        if port is not None:
            try:
                port.close()
            except OSError:
                # An unplugged adapter refuses even this; its descriptor is released all the same.
                return

    def read(self, timeout_s: float) -> bytes:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        port = self._opened()
        try:
            waiting = min(port.in_waiting, _LARGEST_READ)
            if not waiting and timeout_s <= 0.0:
                return b""
            if not waiting and port.timeout != timeout_s:
                port.timeout = timeout_s  # sets the whole port up again, so callers keep to one value
            return bytes(port.read(max(waiting, 1)))
        except (OSError, TypeError) as error:  # TypeError: pyserial, where another thread has closed the port
            raise self._lost(error) from error

    def write(self, data: bytes) -> None:
        """See :class:`~ahrs_lab.instruments.links.link.Link`."""
        import serial

        port = self._opened()
        try:
            with self._write_lock:
                port.write(data)
        except serial.SerialTimeoutException as error:
            raise LinkLostError(
                "The serial port {port} takes no more data: check the cable and the instrument's power.",
                port=self._port,
            ) from error
        except (OSError, TypeError) as error:
            raise self._lost(error) from error

    def _opened(self) -> serial.Serial:
        if self._serial is None:
            raise LinkLostError("The serial port {port} is not open.", port=self._port)
        return self._serial

    def _lost(self, error: Exception) -> LinkLostError:
        return LinkLostError(
            "The serial port {port} is gone ({reason}): plug its cable in again.",
            port=self._port,
            reason=_reason(error),
        )


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
