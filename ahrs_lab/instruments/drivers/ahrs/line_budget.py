"""What a stream asks of its line, before it is started: a line that is too slow loses samples without a
word."""

from __future__ import annotations

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.links.link import Link

BITS_PER_BYTE = 10.0
"""Start bit, eight data bits, stop bit; a link that knows better says so."""
USABLE_SHARE = 0.95
"""Devices pause between frames, and answers to commands share the line."""


def needed_bits_per_second(frame_bytes: float, rate_hz: float, bits_per_byte: float = BITS_PER_BYTE) -> float:
    """Bits per second of frames sent ``rate_hz`` times a second."""
    return frame_bytes * rate_hz * bits_per_byte


def check_line(link: Link, frame_bytes: float, rate_hz: float) -> None:
    """Raises InputError, with the numbers, where the frames do not fit the line."""
    available = link.bits_per_second
    if available is None:
        return
    needed = needed_bits_per_second(
        frame_bytes, rate_hz, float(getattr(link, "bits_per_byte", BITS_PER_BYTE))
    )
    if needed > USABLE_SHARE * available:
        raise InputError(
            "{frame} bytes {rate} times a second need {needed} bit/s, but {port} carries {available} bit/s: "
            "raise the baud rate of the device and of the link, or ask for fewer samples or outputs.",
            frame=round(frame_bytes, 1),
            rate=round(rate_hz, 3),
            needed=round(needed),
            port=link.name,
            available=available,
        )
