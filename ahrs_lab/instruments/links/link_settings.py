"""Which wire an instrument hangs on, as its settings say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.link import Link
from ahrs_lab.instruments.links.serial_link import SerialLink
from ahrs_lab.instruments.links.tcp_link import TcpLink
from ahrs_lab.instruments.settings import within

_LARGEST_PORT = 65535
_LARGEST_BAUD = 12_000_000


@dataclass(frozen=True)
class LinkSettings:
    """``device`` (a serial port) or ``host`` and ``port``; 8 data bits, no parity, 1 stop bit unless said."""

    device: str = ""
    baud: int = 9600
    data_bits: int = 8
    parity: Literal["none", "even", "odd"] = "none"
    stop_bits: float = 1.0
    host: str = ""
    port: int = 0

    def __post_init__(self) -> None:
        if bool(self.device) == bool(self.host):
            raise InputError(
                "A link needs either “device” (a serial port) or “host” and “port” (a network address), "
                "not both and not none."
            )
        if self.host:
            within("link.port", self.port, 0, _LARGEST_PORT)
        within("link.baud", self.baud, 50, _LARGEST_BAUD)
        within("link.data_bits", self.data_bits, 5, 8)
        within("link.stop_bits", self.stop_bits, 1, 2)


def make_link(settings: LinkSettings, *, default_port: int = 0) -> Link:
    """The link, not yet open. ``default_port``: the TCP port where the settings name none."""
    if settings.device:
        return SerialLink(
            settings.device,
            settings.baud,
            data_bits=settings.data_bits,
            parity={"none": "N", "even": "E", "odd": "O"}[settings.parity],
            stop_bits=settings.stop_bits,
        )
    port = settings.port or default_port
    if not port:
        raise InputError("Setting “port” of the link to {host} is missing.", host=settings.host)
    return TcpLink(settings.host, port)
