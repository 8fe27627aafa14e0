"""The decoders of AHRS streams by name: what ``ahrs-lab replay RAW --protocol NAME`` and drivers choose
from. A name that ends in ``.toml`` is the description of a private format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.protocols.anpp import AnppStream
from ahrs_lab.instruments.protocols.description import BinaryDescription, load_description
from ahrs_lab.instruments.protocols.generic_binary import GenericBinaryStream
from ahrs_lab.instruments.protocols.generic_text import GenericTextStream
from ahrs_lab.instruments.protocols.microstrain import MicroStrainStream
from ahrs_lab.instruments.protocols.nmea import NmeaStream
from ahrs_lab.instruments.protocols.stream import StreamDecoder, joined
from ahrs_lab.instruments.protocols.vectornav import VectorNavStream
from ahrs_lab.instruments.protocols.xsens import XsensStream
from ahrs_lab.recording.samples import Samples

STREAMS: Final[dict[str, Callable[[float | None], StreamDecoder]]] = {
    "vectornav": VectorNavStream,
    "xsens": XsensStream,
    "mip": MicroStrainStream,
    "anpp": AnppStream,
    "nmea": NmeaStream,
}
"""Makers of decoders; their argument is the nominal rate, Hz, for streams without device time."""

_BLOCK: Final = 1 << 16


def stream_decoder(protocol: str, nominal_rate_hz: float | None = None) -> StreamDecoder:
    """The decoder of this name, or of the description in this file; raises InputError."""
    if protocol in STREAMS:
        return STREAMS[protocol](nominal_rate_hz)
    if not protocol.lower().endswith(".toml"):
        raise InputError(
            "The protocol “{protocol}” is not known: write one of {known}, "
            "or the .toml file that describes it.",
            protocol=protocol,
            known=", ".join(STREAMS),
        )
    description = load_description(Path(protocol))
    if isinstance(description.frame, BinaryDescription):
        return GenericBinaryStream(description, nominal_rate_hz)
    return GenericTextStream(description, nominal_rate_hz)


def replayed(data: bytes, decoder: StreamDecoder) -> Samples:
    """All samples in ``data``, as the live driver would have seen them."""
    blocks = [decoder.feed(data[at : at + _BLOCK]) for at in range(0, len(data), _BLOCK)]
    return joined([*blocks, decoder.flush()])


def replay_summary(samples: Samples, decoder: StreamDecoder) -> dict[str, Any]:
    """What ``ahrs-lab replay --json`` says. A value that is not a number is None."""
    counts = decoder.counts
    return {
        "frames": counts.frames,
        "failed": counts.failed,
        "skipped_bytes": counts.skipped_bytes,
        "samples": len(samples),
        "first": _row(samples, 0),
        "last": _row(samples, -1),
    }


def _row(samples: Samples, index: int) -> dict[str, float | None]:
    if not len(samples):
        return {}
    row = {name: float(column[index]) for name, column in samples.columns.items()}
    return {name: value if abs(value) < float("inf") else None for name, value in row.items()}
